//! Standard errors from the derivatives at the minimum.

use super::problem::{Deviation, Problem, Unknown};
use crate::drop::Coordinate;
use crate::flight::of_one_camera;
use coinmc_core::{Philox4x64, inverse_normal_cdf, unit_interval};
use nalgebra_lm::DMatrix;

/// Eigenvalues of a correlation-like matrix below this are rounding errors of central differences.
const SINGULAR: f64 = 1e-9;

/// Linear theory at a minimum.
#[derive(Debug, Clone)]
pub(crate) struct Spread {
    /// Standard error of each unknown, in its own unit; `None` if the film does not determine it.
    pub(crate) errors: Vec<Option<f64>>,
    /// Degrees of freedom that fitting takes from the residuals of each coordinate.
    pub(crate) taken: [f64; 3],
    /// Residuals of each coordinate.
    points: [f64; 3],
    /// Factor by which squared errors of a robust fit differ from those of least squares: Huber,
    /// *Robust Statistics* (1981), eq. 7.6.5, without the correction for few residuals.
    pub(crate) factor: f64,
    /// Factor by which the variance of each unknown exceeds that of linear theory, because the
    /// weights of the coordinates are themselves estimated.
    pub(crate) inflation: Vec<f64>,
    /// How the unknowns change with each shared parameter (these come first) along the valley of
    /// the cost; all in units of the search.
    pub(crate) valleys: Vec<Vec<f64>>,
    /// Directions, one per column, with independent unit variances; in units of the search.
    directions: DMatrix<f64>,
}

impl Spread {
    /// Degrees of freedom of the noise: the fewest of any coordinate that is weighted by its own noise.
    pub(crate) fn degrees(&self) -> f64 {
        let left = (0..3).map(|c| self.points[c] - self.taken[c]);
        let own = left.filter(|degrees| *degrees >= LEAST_DEGREES);
        own.min_by(f64::total_cmp).unwrap_or(LEAST_DEGREES)
    }

    /// A random step, distributed like the errors; the same number gives the same step.
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

    /// The same with the j-th unknown, a shared parameter, held: what is left of the step when its part along
    /// the valley is taken away. For normal errors that is their distribution given the parameter.
    pub(crate) fn draw_with_held(&self, j: usize, number: u64) -> Vec<f64> {
        let mut step = self.draw(number);
        let drift = step[j];
        for (part, valley) in step.iter_mut().zip(&self.valleys[j]) {
            *part -= drift * valley;
        }
        step
    }
}

/// Second word of the key of random steps.
const HOPS: u64 = 0x686f_7073;

/// Linear theory at the problem's point; `None` if the frames determine no unknown at all.
pub(crate) fn spread(problem: &Problem) -> Option<Spread> {
    let deviations = problem.deviations()?;
    let matrix = problem.derivatives()?;
    let normal = matrix.tr_mul(&matrix);
    let mut kept: Vec<usize> = (0..problem.unknowns.len())
        .filter(|&j| is_determined(problem, j, normal[(j, j)]))
        .collect();
    let root = loop {
        // as for a film in wrong units, whose coin is through the floor all along
        if kept.is_empty() {
            return None;
        }
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
        points: Coordinate::ALL.map(|c| of(&deviations, c).len() as f64),
        factor: 1.0,
        inflation: vec![1.0; problem.unknowns.len()],
        valleys: Vec::new(),
    };
    let degrees = (deviations.len() as f64 - kept.len() as f64).max(1.0);
    spread.factor = factor(problem, &deviations, degrees);
    spread.valleys = valleys(problem, &kept, &inverse);
    let rows = matrix.select_columns(&kept);
    let leverages = (&rows * &inverse).component_mul(&rows).column_sum();
    for (deviation, leverage) in deviations.iter().zip(&leverages) {
        spread.taken[deviation.coordinate.index()] += leverage;
    }
    let excess = excess(&rows, &deviations, &inverse, &spread);
    for (i, &j) in kept.iter().enumerate() {
        spread.inflation[j] = 1.0 + excess[i] / inverse[(i, i)];
        let variance = spread.factor * inverse[(i, i)] * spread.inflation[j];
        spread.errors[j] = Some(variance.max(0.0).sqrt() * problem.scale(problem.unknowns[j]));
    }
    Some(spread)
}

/// Variance in addition to linear theory's V because each coordinate is weighted by its own noise,
/// which is estimated with ν degrees of freedom: Kenward & Roger, Biometrics 53 (1997) 983,
/// 2 V Σ (2/ν)(N − N V N) V over the coordinates, with N the normal matrix of one. (For the mean of
/// two series it is Meier's formula.)
fn excess(
    rows: &DMatrix<f64>,
    deviations: &[Deviation],
    inverse: &DMatrix<f64>,
    spread: &Spread,
) -> Vec<f64> {
    let mut excess = vec![0.0; inverse.nrows()];
    for coordinate in Coordinate::ALL {
        let c = coordinate.index();
        let degrees = (spread.points[c] - spread.taken[c]).max(1.0);
        let of_it = (0..deviations.len()).filter(|i| deviations[*i].coordinate == coordinate);
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

/// Whether an unknown would be determined within its range if all others were known.
pub(super) fn is_determined(problem: &Problem, j: usize, square: f64) -> bool {
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

/// A root M of the inverse, M Mᵀ, of the kept rows and columns; or the one that is closest to
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

fn factor(problem: &Problem, deviations: &[Deviation], degrees: f64) -> f64 {
    let loss = problem.task.loss;
    if loss == super::Loss::Square {
        return 1.0;
    }
    let (mut squares, mut inner) = (0.0, 0.0);
    for deviation in deviations {
        let r = problem.weighted(deviation);
        squares += loss.psi(r) * loss.psi(r);
        inner += f64::from(u8::from(loss.is_inner(r)));
    }
    let share = inner / deviations.len() as f64;
    squares / degrees / (share * share)
}

/// σ of each coordinate from its residuals, minus the degrees of freedom used by fitting; of a length that is
/// marked too seldom that of the other one.
pub(crate) fn scales(problem: &Problem, taken: &[f64; 3]) -> Option<[f64; 3]> {
    let deviations = problem.deviations()?;
    let found = Coordinate::ALL.map(|coordinate| {
        let of_it: Vec<f64> = of(&deviations, coordinate);
        let degrees = of_it.len() as f64 - taken[coordinate.index()];
        let scale = || problem.task.loss.scale(&of_it, degrees).max(MIN_SIGMA);
        (degrees >= LEAST_DEGREES).then(scale)
    });
    Some(of_one_camera(found, problem.weighing.sigma))
}

/// Degrees of freedom from which a coordinate's noise is told by its own residuals.
const LEAST_DEGREES: f64 = 1.0;

/// Smallest σ, m and rad, which prevents a division by zero for exact data.
const MIN_SIGMA: f64 = 1e-9;

/// The residuals of one coordinate.
pub(crate) fn of(deviations: &[Deviation], coordinate: Coordinate) -> Vec<f64> {
    deviations
        .iter()
        .filter(|deviation| deviation.coordinate == coordinate)
        .map(|deviation| deviation.by)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two errors of unit variance and correlation 0.8: where the first is held, the second keeps the variance
    /// 1 − 0.8² = 0.36. Over 20,000 draws a variance V is known to V sqrt(2/20,000) = 1 %; 4 % are four of that.
    #[test]
    fn a_step_with_a_held_unknown_is_that_of_the_others_given_it() {
        let spread = Spread {
            errors: vec![Some(1.0); 2],
            taken: [0.0; 3],
            points: [0.0; 3],
            factor: 1.0,
            inflation: vec![1.0; 2],
            valleys: vec![vec![1.0, 0.8], vec![0.8, 1.0]],
            directions: DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.8, 0.6]),
        };
        let count = 20_000;
        let (mut free, mut held) = ([0.0; 2], 0.0);
        for number in 0..count {
            let step = spread.draw(number);
            free = [0, 1].map(|i: usize| free[i] + step[i] * step[i] / count as f64);
            let step = spread.draw_with_held(0, number);
            assert!(step[0].abs() < 1e-15, "{step:?}");
            held += step[1] * step[1] / count as f64;
        }
        for (found, expected) in [(free[0], 1.0), (free[1], 1.0), (held, 0.36)] {
            assert!((found / expected - 1.0).abs() < 0.04, "{found} {expected}");
        }
    }

    fn nothing(unknowns: usize) -> Spread {
        Spread {
            errors: vec![None; unknowns],
            taken: [0.0; 3],
            points: [0.0; 3],
            factor: 1.0,
            inflation: vec![1.0; unknowns],
            valleys: Vec::new(),
            directions: DMatrix::zeros(unknowns, 0),
        }
    }

    /// The weighted mean of several series has the variance V (1 + 4 Σ wᵢ (1 − wᵢ)/νᵢ) if the weights come from the series: Meier,
    /// Biometrics 9 (1953) 59.
    #[test]
    fn estimated_weights_add_what_meier_says() {
        let (counts, sigmas) = ([5, 8, 30], [0.5, 0.25, 2.0]);
        let (mut slopes, mut deviations) = (Vec::new(), Vec::new());
        for (i, coordinate) in Coordinate::ALL.into_iter().enumerate() {
            for frame in 0..counts[i] {
                slopes.push(1.0 / sigmas[i]);
                deviations.push(Deviation {
                    drop: 0,
                    frame,
                    coordinate,
                    by: 0.0,
                });
            }
        }
        let rows = DMatrix::from_column_slice(slopes.len(), 1, &slopes);
        let of_series = [0, 1, 2].map(|i: usize| counts[i] as f64 / (sigmas[i] * sigmas[i]));
        let variance = 1.0 / of_series.iter().sum::<f64>();
        let weights = of_series.map(|one| one * variance);
        let points = counts.map(|count| count as f64);
        let spread = Spread {
            taken: weights,
            points,
            ..nothing(1)
        };
        let inverse = DMatrix::from_element(1, 1, variance);
        let found = excess(&rows, &deviations, &inverse, &spread)[0];
        let terms = (0..3).map(|i| weights[i] * (1.0 - weights[i]) / (points[i] - weights[i]));
        let expected = 4.0 * variance * terms.sum::<f64>();
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    }

    /// The fewest of those coordinates whose own residuals tell their noise, and never none.
    #[test]
    fn degrees_are_those_of_the_coordinate_with_fewest() {
        let of = |points, taken| {
            Spread {
                taken,
                points,
                ..nothing(0)
            }
            .degrees()
        };
        assert_eq!(of([20.0, 15.0, 30.0], [2.0, 3.0, 25.0]), 5.0);
        assert_eq!(of([0.0, 15.0, 30.0], [0.0, 3.0, 2.5]), 12.0);
        assert_eq!(of([4.0, 15.0, 30.0], [3.0, 3.0, 2.5]), 1.0);
        // the noise of the first is that of another one
        assert_eq!(of([4.0, 15.0, 30.0], [3.1, 3.0, 2.5]), 12.0);
        assert_eq!(of([2.0, 2.0, 2.0], [2.0; 3]), 1.0);
    }

    /// M Mᵀ times the kept rows and columns is 1, whatever their units.
    #[test]
    fn the_root_is_that_of_the_inverse() {
        let slopes = DMatrix::from_row_slice(
            4,
            3,
            &[1.0, 9.0, 2e6, 3.0, 9.0, -1e6, 0.0, 9.0, 4e6, -2.0, 9.0, 1e6],
        );
        let normal = slopes.tr_mul(&slopes);
        for kept in [vec![0, 1, 2], vec![0, 2], vec![1]] {
            let root = root_of_inverse(&normal, &kept).unwrap();
            let part = DMatrix::from_fn(kept.len(), kept.len(), |i, j| normal[(kept[i], kept[j])]);
            let units = DMatrix::from_fn(kept.len(), kept.len(), |i, j| {
                (part[(j, j)] / part[(i, i)]).sqrt()
            });
            let product = (&root * root.transpose() * part).component_div(&units);
            assert!((product - DMatrix::identity(kept.len(), kept.len())).amax() < 1e-12);
        }
    }

    /// The third is the sum of the first two, of which the second weighs more in it.
    #[test]
    fn what_depends_on_others_is_named() {
        let slopes = DMatrix::from_row_slice(3, 3, &[1.0, 2.0, 3.0, 1.0, -1.0, 0.0, 1.0, 0.5, 1.5]);
        let normal = slopes.tr_mul(&slopes);
        assert_eq!(root_of_inverse(&normal, &[0, 1, 2]).unwrap_err(), 2);
        assert!(root_of_inverse(&normal, &[0, 1]).is_ok());
    }
}
