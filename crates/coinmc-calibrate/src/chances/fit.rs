//! Multinomial logits by maximum likelihood, with a weak pull to 0.

use nalgebra::{DMatrix, DVector};

/// Strength of the pull of every coefficient but the constants to 0, in tosses: only where a face was never
/// seen does it matter.
const RIDGE: f64 = 0.1;
/// Newton steps, and the step that ends them.
const STEPS: usize = 50;
const CONVERGED: f64 = 1e-9;

/// Coefficients of ln(P(heads)/P(side)) and ln(P(tails)/P(side)).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Coefficients {
    heads: Vec<f64>,
    tails: Vec<f64>,
}

/// Values of the terms at all points, and the faces counted there.
pub(super) struct Sample {
    /// A row a point.
    pub(super) terms: DMatrix<f64>,
    pub(super) faces: Vec<[f64; 3]>,
}

impl Coefficients {
    fn zero(terms: usize) -> Self {
        Self {
            heads: vec![0.0; terms],
            tails: vec![0.0; terms],
        }
    }

    /// The probabilities of heads, tails and side where the terms have these values.
    pub(super) fn faces(&self, terms: &[f64]) -> [f64; 3] {
        let sum = |coefficients: &[f64]| -> f64 {
            coefficients
                .iter()
                .zip(terms)
                .map(|(c, term)| c * term)
                .sum()
        };
        shares([sum(&self.heads), sum(&self.tails)])
    }

    fn moved(&self, step: &DVector<f64>, by: f64) -> Self {
        let n = self.heads.len();
        let moved = |from: &[f64], offset: usize| {
            let values = from.iter().enumerate();
            values
                .map(|(i, value)| value + by * step[offset + i])
                .collect()
        };
        Self {
            heads: moved(&self.heads, 0),
            tails: moved(&self.tails, n),
        }
    }
}

/// Probabilities from logits against the side.
fn shares([heads, tails]: [f64; 2]) -> [f64; 3] {
    let most = heads.max(tails).max(0.0);
    let weights = [heads, tails, 0.0].map(|logit| libm::exp(logit - most));
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

impl Sample {
    fn probabilities(&self, coefficients: &Coefficients) -> Vec<[f64; 3]> {
        let logits = [&coefficients.heads, &coefficients.tails]
            .map(|of| &self.terms * DVector::from_column_slice(of));
        let rows = logits[0].iter().zip(logits[1].iter());
        rows.map(|(heads, tails)| shares([*heads, *tails]))
            .collect()
    }

    /// ln of the likelihood at probabilities, of which none counts as less than 1e-12.
    pub(super) fn log_likelihood(&self, probabilities: &[[f64; 3]]) -> f64 {
        let rows = self.faces.iter().zip(probabilities);
        rows.flat_map(|(faces, p)| faces.iter().zip(p))
            .filter(|(count, _)| **count > 0.0)
            .map(|(count, p)| count * libm::log(p.max(1e-12)))
            .sum()
    }

    fn penalised(&self, coefficients: &Coefficients, probabilities: &[[f64; 3]]) -> f64 {
        let pulled = coefficients.heads.iter().skip(1);
        let pulled = pulled.chain(coefficients.tails.iter().skip(1));
        let squares: f64 = pulled.map(|value| value * value).sum();
        self.log_likelihood(probabilities) - 0.5 * RIDGE * squares
    }

    /// The step of Newton's method.
    fn step(&self, at: &Coefficients, probabilities: &[[f64; 3]]) -> Option<DVector<f64>> {
        let n = at.heads.len();
        let totals: Vec<f64> = self.faces.iter().map(|faces| faces.iter().sum()).collect();
        let mut gradient = DVector::zeros(2 * n);
        let mut curvature = DMatrix::zeros(2 * n, 2 * n);
        for (f, coefficients) in [&at.heads, &at.tails].into_iter().enumerate() {
            let rows = self.faces.iter().zip(probabilities).zip(&totals);
            let off = rows.map(|((faces, p), total)| faces[f] - total * p[f]);
            let off = DVector::from_iterator(self.faces.len(), off);
            let mut part = self.terms.tr_mul(&off);
            for (i, value) in coefficients.iter().enumerate().skip(1) {
                part[i] -= RIDGE * value;
            }
            gradient.rows_mut(f * n, n).copy_from(&part);
        }
        for (f, g) in [(0, 0), (0, 1), (1, 1)] {
            let mut weighed = self.terms.clone();
            for (k, (p, total)) in probabilities.iter().zip(&totals).enumerate() {
                let own = if f == g { p[f] } else { 0.0 };
                weighed.row_mut(k).scale_mut(total * (own - p[f] * p[g]));
            }
            let mut block = self.terms.tr_mul(&weighed);
            if f == g {
                for i in 1..n {
                    block[(i, i)] += RIDGE;
                }
                // a face that is never seen leaves its constant free
                block[(0, 0)] += 1e-9;
            }
            curvature.view_mut((f * n, g * n), (n, n)).copy_from(&block);
            if f != g {
                curvature
                    .view_mut((g * n, f * n), (n, n))
                    .copy_from(&block.transpose());
            }
        }
        Some(curvature.cholesky()?.solve(&gradient))
    }

    /// The coefficients that maximise the likelihood; `None` if that fails.
    pub(super) fn fit(&self, start: Option<&Coefficients>) -> Option<Coefficients> {
        let terms = self.terms.ncols();
        let mut best = start.cloned().unwrap_or_else(|| Coefficients::zero(terms));
        let mut probabilities = self.probabilities(&best);
        let mut value = self.penalised(&best, &probabilities);
        for _ in 0..STEPS {
            let step = self.step(&best, &probabilities)?;
            let mut by = 1.0;
            loop {
                let moved = best.moved(&step, by);
                let there = self.probabilities(&moved);
                let reached = self.penalised(&moved, &there);
                if reached >= value - 1e-9 * value.abs() {
                    (best, probabilities, value) = (moved, there, reached);
                    break;
                }
                by *= 0.5;
                if by < 1e-6 {
                    return Some(best);
                }
            }
            if by * step.amax() < CONVERGED {
                return Some(best);
            }
        }
        Some(best)
    }
}
