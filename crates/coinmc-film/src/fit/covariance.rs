//! Standard errors from the derivatives at the minimum.

use super::problem::{Miss, Problem, Unknown};
use crate::drop::Coordinate;
use coinmc_core::{Philox4x64, inverse_normal_cdf, unit_interval};
use nalgebra_lm::DMatrix;

/// Smallest eigenvalue of a correlation-like matrix that is not a rounding error of central
/// differences.
const SINGULAR: f64 = 1e-9;

/// What the derivatives at a minimum tell.
#[derive(Debug, Clone)]
pub(crate) struct Spread {
    /// Standard error of each unknown, in its own unit; `None` where the film says nothing of it.
    pub(crate) errors: Vec<Option<f64>>,
    /// Degrees of freedom that fitting takes from the residuals of each coordinate.
    pub(crate) taken: [f64; 3],
    /// Residuals of each coordinate.
    points: [f64; 3],
    /// By what the squared errors of a robust fit differ from those of squares: Huber, *Robust
    /// Statistics* (1981), eq. 7.6.5, without the correction for few residuals.
    pub(crate) factor: f64,
    /// By what the variance of each unknown exceeds that of linear theory, as the weights of the
    /// coordinates are themselves estimated.
    pub(crate) inflation: Vec<f64>,
    /// How the unknowns move with each shared parameter, which come first, along the valley of the
    /// cost; all in units of the search.
    pub(crate) valleys: Vec<Vec<f64>>,
    /// Directions, one a column, that have independent unit variances; in units of the search.
    directions: DMatrix<f64>,
}

impl Spread {
    /// Degrees of freedom of the scatter: of the coordinate that has the fewest, as each is weighed
    /// by its own.
    pub(crate) fn degrees(&self) -> f64 {
        let left = (0..3).filter(|c| self.points[*c] > 0.0);
        let left = left.map(|c| self.points[c] - self.taken[c]);
        left.fold(f64::INFINITY, f64::min).max(1.0)
    }

    /// A step of random direction, as far as the spread reaches: the same for the same number.
    pub(crate) fn draw(&self, number: u64) -> Vec<f64> {
        let philox = Philox4x64::new([number, HOPS]);
        let normal = |i: u64| inverse_normal_cdf(unit_interval(philox.block([i, 0, 0, 0])[0]));
        let mut step = vec![0.0; self.errors.len()];
        for (i, direction) in self.directions.column_iter().enumerate() {
            let size = normal(i as u64);
            for (sum, part) in step.iter_mut().zip(direction.iter()) {
                *sum += size * part;
            }
        }
        step
    }
}

/// Second word of the key of random steps.
const HOPS: u64 = 0x686f_7073;

/// Linear theory at the problem's point.
pub(crate) fn spread(problem: &Problem) -> Option<Spread> {
    let misses = problem.misses()?;
    let matrix = problem.derivatives()?;
    let normal = matrix.tr_mul(&matrix);
    let mut kept: Vec<usize> = (0..problem.unknowns.len())
        .filter(|&j| tells(problem, j, normal[(j, j)]))
        .collect();
    let root = loop {
        match root_of_inverse(&normal, &kept) {
            Ok(root) => break root,
            Err(weakest) => {
                kept.remove(weakest);
            }
        }
    };
    let inverse = &root * root.transpose();
    let mut directions = DMatrix::zeros(problem.unknowns.len(), kept.len());
    for (i, &j) in kept.iter().enumerate() {
        directions.row_mut(j).copy_from(&root.row(i));
    }
    let mut spread = Spread {
        directions,
        errors: vec![None; problem.unknowns.len()],
        taken: [0.0; 3],
        points: Coordinate::ALL.map(|c| of(&misses, c).len() as f64),
        factor: 1.0,
        inflation: vec![1.0; problem.unknowns.len()],
        valleys: Vec::new(),
    };
    let degrees = (misses.len() as f64 - kept.len() as f64).max(1.0);
    spread.factor = factor(problem, &misses, degrees);
    spread.valleys = valleys(problem, &kept, &inverse);
    let rows = matrix.select_columns(&kept);
    let leverages = (&rows * &inverse).component_mul(&rows).column_sum();
    for (miss, leverage) in misses.iter().zip(&leverages) {
        spread.taken[miss.coordinate.index()] += leverage;
    }
    let excess = excess(&rows, &misses, &inverse, &spread);
    for (i, &j) in kept.iter().enumerate() {
        spread.inflation[j] = 1.0 + excess[i] / inverse[(i, i)];
        let variance = spread.factor * inverse[(i, i)] * spread.inflation[j];
        spread.errors[j] = Some(variance.max(0.0).sqrt() * problem.scale(problem.unknowns[j]));
    }
    Some(spread)
}

/// Variance beyond linear theory's V because each coordinate is weighed by its own scatter, which is
/// estimated with ν degrees of freedom: Kenward & Roger, Biometrics 53 (1997) 983,
/// 2 V Σ (2/ν)(N − N V N) V over the coordinates, N the normal matrix of one. (Of a mean of two
/// series it is Meier's formula.)
fn excess(
    rows: &DMatrix<f64>,
    misses: &[Miss],
    inverse: &DMatrix<f64>,
    spread: &Spread,
) -> Vec<f64> {
    let mut excess = vec![0.0; inverse.nrows()];
    for coordinate in Coordinate::ALL {
        let c = coordinate.index();
        let degrees = (spread.points[c] - spread.taken[c]).max(1.0);
        let of_it = (0..misses.len()).filter(|i| misses[*i].coordinate == coordinate);
        let rows = rows.select_rows(&of_it.collect::<Vec<_>>());
        // N V, and V N V = (N V)ᵀ V
        let weighed = rows.tr_mul(&(&rows * inverse));
        let single = weighed.tr_mul(inverse);
        let double = single.clone() * &weighed;
        for (i, sum) in excess.iter_mut().enumerate() {
            *sum += 4.0 / degrees * (single[(i, i)] - double[(i, i)]).max(0.0);
        }
    }
    excess
}

/// The columns of the covariance of the shared parameters, each divided by its variance.
fn valleys(problem: &Problem, kept: &[usize], inverse: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let shared = |unknown: &&Unknown| matches!(unknown, Unknown::Shared(_));
    (0..problem.unknowns.iter().filter(shared).count())
        .map(|j| {
            let mut valley = vec![0.0; problem.unknowns.len()];
            if let Some(column) = kept.iter().position(|k| *k == j) {
                for (row, k) in kept.iter().enumerate() {
                    valley[*k] = inverse[(row, column)] / inverse[(column, column)];
                }
            }
            valley
        })
        .collect()
}

/// Whether an unknown, were all others known, would be found within its range.
fn tells(problem: &Problem, j: usize, square: f64) -> bool {
    let unknown = problem.unknowns[j];
    let width = match unknown {
        Unknown::Shared(parameter) => {
            let (low, high) = parameter.range();
            let value = problem.value(unknown);
            if value <= low || value >= high {
                return false;
            }
            ((high - low) / problem.scale(unknown)).min(1e3)
        }
        Unknown::Start(..) => 1e3,
    };
    square > 1.0 / (width * width)
}

/// A root M of the inverse, M Mᵀ, of the kept rows and columns; or which of them is nearest to
/// depending on the others.
fn root_of_inverse(normal: &DMatrix<f64>, kept: &[usize]) -> Result<DMatrix<f64>, usize> {
    let n = kept.len();
    let root = |i: usize| normal[(kept[i], kept[i])].sqrt();
    let unit = DMatrix::from_fn(n, n, |i, j| {
        normal[(kept[i], kept[j])] / (root(i) * root(j))
    });
    let eigen = unit.symmetric_eigen();
    let weak = (0..n).find(|&k| eigen.eigenvalues[k] < SINGULAR);
    if let Some(weak) = weak {
        return Err(eigen.eigenvectors.column(weak).iamax());
    }
    Ok(DMatrix::from_fn(n, n, |i, k| {
        eigen.eigenvectors[(i, k)] / (eigen.eigenvalues[k].sqrt() * root(i))
    }))
}

fn factor(problem: &Problem, misses: &[Miss], degrees: f64) -> f64 {
    let loss = problem.task.loss;
    if loss == super::Loss::Square {
        return 1.0;
    }
    let (mut squares, mut inner) = (0.0, 0.0);
    for miss in misses {
        let r = problem.weighed(miss);
        squares += loss.psi(r) * loss.psi(r);
        inner += f64::from(u8::from(loss.is_inner(r)));
    }
    let share = inner / misses.len() as f64;
    squares / degrees / (share * share)
}

/// σ of each coordinate from its residuals, with the degrees of freedom that fitting took.
pub(crate) fn scales(problem: &Problem, taken: &[f64; 3]) -> Option<[f64; 3]> {
    let misses = problem.misses()?;
    let mut sigma = problem.weighing.sigma;
    for coordinate in Coordinate::ALL {
        let c = coordinate.index();
        let of_it: Vec<f64> = of(&misses, coordinate);
        let degrees = of_it.len() as f64 - taken[c];
        if degrees >= 1.0 {
            sigma[c] = problem.task.loss.scale(&of_it, degrees).max(LEAST_SIGMA);
        }
    }
    Some(sigma)
}

/// No film is better than this, m and rad; keeps exact data from dividing by zero.
const LEAST_SIGMA: f64 = 1e-9;

/// The residuals of one coordinate.
pub(crate) fn of(misses: &[Miss], coordinate: Coordinate) -> Vec<f64> {
    misses
        .iter()
        .filter(|miss| miss.coordinate == coordinate)
        .map(|miss| miss.by)
        .collect()
}
