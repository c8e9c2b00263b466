//! The degree of the polynomials and the error of the fit, by cross-validation.

use super::basis::Basis;
use super::fit::{Coefficients, Sample};
use super::{Tossed, jackknife};
use nalgebra::DMatrix;

/// Parts of the design, each of which is left out once. Points of a Sobol sequence whose numbers differ by
/// a multiple of a power of two lie side by side, so parts take every so many points, by a number that is none.
const PARTS: usize = 11;
/// The highest degree that is tried.
const HIGHEST: usize = 4;
/// Points of the design that a term needs at least.
const POINTS_PER_TERM: usize = 4;

/// The best fit.
pub(super) struct Validated {
    pub(super) basis: Basis,
    pub(super) coefficients: Coefficients,
    /// Fits without a part each.
    pub(super) partial: Vec<Coefficients>,
    /// What a polynomial of this degree lacks.
    pub(super) lack: Lack,
}

/// The error of the shape.
#[derive(Default)]
pub(super) struct Lack {
    /// Mean square, summed over the faces.
    pub(super) square: f64,
    /// How much of it each face has.
    shares: [f64; 3],
}

impl Lack {
    /// The error of each face: where heads and tails err alike, the side errs by both. None errs less than all do on
    /// average, as in what a rare face lacks the noise of tosses hides the most.
    pub(super) fn by_face(&self) -> [f64; 3] {
        self.shares
            .map(|share| (self.square * share.max(1.0 / 3.0)).sqrt())
    }
}

/// Fits every degree, and takes the one that predicts best what was left out.
pub(super) fn best(tossed: &Tossed) -> Option<Validated> {
    let dimensions = tossed.points.first()?.len();
    let degrees = (1..=HIGHEST).map(|degree| Basis::new(dimensions, degree));
    let affordable = degrees.filter(|basis| {
        basis.degree() == 1 || basis.len() * POINTS_PER_TERM <= tossed.points.len()
    });
    let tried: Vec<Fitted> = affordable
        .filter_map(|basis| fitted(tossed, basis))
        .collect();
    let places = 0..tried.len();
    let best = places.max_by(|a, b| tried[*a].score.total_cmp(&tried[*b].score))?;
    // the next degree shows what this one lacks; what the highest one lacks is bounded by its difference to the one below
    let other = tried
        .get(best + 1)
        .or_else(|| tried.get(best.checked_sub(1)?));
    let lack = other.map_or_else(Lack::default, |other| tried[best].lack(other, tossed));
    let Fitted {
        basis,
        coefficients,
        partial,
        ..
    } = tried.into_iter().nth(best)?;
    Some(Validated {
        basis,
        coefficients,
        partial,
        lack,
    })
}

/// A fit of one degree.
struct Fitted {
    basis: Basis,
    coefficients: Coefficients,
    partial: Vec<Coefficients>,
    /// ln of the probability that it gave to what was left out.
    score: f64,
}

impl Fitted {
    /// Mean square difference to a fit of another degree over the design, less what tosses explain of it.
    fn lack(&self, other: &Self, tossed: &Tossed) -> Lack {
        let (mut sum, mut faces) = (0.0, [0.0; 3]);
        for point in &tossed.points {
            let [whole, parts] = self.differences(other, point);
            for (face, of_face) in faces.iter_mut().enumerate() {
                let noise = jackknife(parts.iter().map(|part| part[face]));
                let square = whole[0][face] * whole[0][face] - noise * noise;
                sum += square;
                *of_face += square;
            }
        }
        // where tosses explain more than all of a face's, the others share what is left
        let faces = faces.map(|face| face.max(0.0));
        let all = faces.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        Lack {
            square: (sum / tossed.points.len() as f64).max(0.0),
            shares: faces.map(|face| face / all),
        }
    }

    /// The difference of the probabilities of the whole fits, and of each pair of partial ones.
    fn differences(&self, other: &Self, point: &[f64]) -> [Vec<[f64; 3]>; 2] {
        let faces = |fit: &Self| {
            fit.basis.evaluate(point, |terms| {
                let of = |one: &Coefficients| one.faces(terms);
                let partial: Vec<_> = fit.partial.iter().map(of).collect();
                [vec![of(&fit.coefficients)], partial]
            })
        };
        let (own, others) = (faces(self), faces(other));
        let less = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|face| a[face] - b[face]);
        [0, 1].map(|k| own[k].iter().zip(&others[k]).map(less).collect())
    }
}

fn fitted(tossed: &Tossed, basis: Basis) -> Option<Fitted> {
    let all: Vec<usize> = (0..tossed.points.len()).collect();
    let coefficients = sample(tossed, &basis, &all).fit(None)?;
    let mut partial = vec![];
    let mut score = 0.0;
    for part in 0..PARTS {
        let (left, kept): (Vec<usize>, Vec<usize>) = all.iter().partition(|k| *k % PARTS == part);
        let fitted = sample(tossed, &basis, &kept).fit(Some(&coefficients))?;
        let predicted = left
            .iter()
            .map(|k| basis.evaluate(&tossed.points[*k], |terms| fitted.faces(terms)));
        let predicted: Vec<_> = predicted.collect();
        score += sample(tossed, &basis, &left).log_likelihood(&predicted);
        partial.push(fitted);
    }
    Some(Fitted {
        basis,
        coefficients,
        partial,
        score,
    })
}

fn sample(tossed: &Tossed, basis: &Basis, chosen: &[usize]) -> Sample {
    let mut terms = DMatrix::zeros(chosen.len(), basis.len());
    for (row, k) in chosen.iter().enumerate() {
        basis.evaluate(&tossed.points[*k], |values| {
            for (column, value) in values.iter().enumerate() {
                terms[(row, column)] = *value;
            }
        });
    }
    let faces = chosen
        .iter()
        .map(|k| tossed.faces[*k].map(|count| count as f64));
    Sample {
        terms,
        faces: faces.collect(),
    }
}
