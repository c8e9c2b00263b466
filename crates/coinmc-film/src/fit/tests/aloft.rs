//! Drops that stay aloft, in which every coordinate is a straight line but for gravity, so that linear theory is
//! exact and its results are those of textbooks.

use super::{SIGMA, aloft, at_the_truth, model};
use crate::drop::Coordinate;
use crate::fit::covariance::spread;
use crate::fit::problem::{Task, Unknown};
use crate::fit::{Loss, Options, Remark, converge_noise, fit};
use crate::parameter::Parameter;
use levenberg_marquardt::LeastSquaresProblem;

/// Errors of a line's value at the first time and of its slope, for unit noise.
fn errors_of_a_line(times: &[f64]) -> [f64; 2] {
    let n = times.len() as f64;
    let mean = times.iter().sum::<f64>() / n;
    let squares: f64 = times.iter().map(|t| (t - mean) * (t - mean)).sum();
    [
        (1.0 / n + mean * mean / squares).sqrt(),
        1.0 / squares.sqrt(),
    ]
}

/// A state changes what is seen at t by itself or, if it is a velocity, by t; the floor lifts z. No drop's state changes
/// what is seen of the other. Differences over 1e-5 of values of 5 are exact to 1e-10.
#[test]
fn derivatives_in_flight_are_one_and_the_time() {
    let drops = [aloft(1, 0.1), aloft(2, 0.05)];
    let task = Task::new(model(), &drops, Loss::Square);
    let problem = at_the_truth(&task, &[Parameter::Floor, Parameter::Restitution]);
    let (matrix, rows) = (
        problem.derivatives().unwrap(),
        problem.deviations().unwrap(),
    );
    assert_eq!(matrix.shape(), (3 * (25 + 13), 2 + 12));
    for (i, row) in rows.iter().enumerate() {
        let c = row.coordinate.index();
        for (j, unknown) in problem.unknowns.iter().enumerate() {
            let moves = match *unknown {
                Unknown::Shared(Parameter::Floor) if row.coordinate == Coordinate::Z => 1.0,
                Unknown::Start(drop, place) if drop == row.drop && place / 2 == c => {
                    [1.0, task.times[drop][row.frame]][place % 2]
                }
                _ => 0.0,
            };
            let expected = -moves * problem.scale(*unknown) / SIGMA[c];
            let error = (matrix[(i, j)] - expected).abs();
            assert!(
                error < 1e-6 * (1.0 + expected.abs()),
                "{unknown:?} {row:?}: {}",
                matrix[(i, j)]
            );
        }
    }
}

/// Three straight lines: two numbers of each are fitted, and nothing adds to their errors.
#[test]
fn errors_in_flight_are_those_of_straight_lines() {
    let drops = [aloft(1, 0.1)];
    let task = Task::new(model(), &drops, Loss::Square);
    let spread = spread(&at_the_truth(&task, &[])).unwrap();
    let line = errors_of_a_line(&task.times[0]);
    for place in 0..6 {
        let expected = SIGMA[place / 2] * line[place % 2];
        let error = spread.errors[place].unwrap();
        assert!(
            (error / expected - 1.0).abs() < 1e-6,
            "{place}: {error:e} {expected:e}"
        );
        assert!((spread.inflation[place] - 1.0).abs() < 1e-6);
    }
    assert!(spread.taken.iter().all(|taken| (taken - 2.0).abs() < 1e-6));
    assert!((spread.degrees() - 23.0).abs() < 1e-6);
}

/// A drop by itself, and one of two that share nothing but the noise.
#[test]
fn starts_are_known_as_well_as_the_ends_of_straight_lines() {
    let drops = [aloft(1, 0.3), aloft(2, 0.15)];
    let options = Options {
        free: Vec::new(),
        ..Options::default()
    };
    let fit = fit(&model(), &drops, &options).unwrap();
    // Student's quantile for 73 + 37 − 4 points
    let t = 1.983;
    for (drop, fitted) in drops.iter().zip(&fit.drops) {
        let times: Vec<f64> = drop.frames.iter().map(|frame| frame.time_s).collect();
        let line = errors_of_a_line(&times);
        assert_eq!(
            (fitted.frames, fitted.of_frames),
            (times.len(), times.len())
        );
        for place in 0..6 {
            let expected = t * fit.noise[place / 2].sigma * line[place % 2];
            let half_width = fitted.half_width[place].unwrap();
            assert!(
                (half_width / expected - 1.0).abs() < 1e-3,
                "{place}: {half_width:e} {expected:e}"
            );
        }
    }
    assert_eq!((fit.n, fit.fitted), (3 * (73 + 37), 12 + 3));
    assert!(
        fit.remarks
            .iter()
            .all(|remark| matches!(remark, Remark::NoImpact { .. }))
    );
}

/// What the fit states of the noise is what its residuals say, and the likelihood is the product of
/// their normal densities at the standard deviations that make it greatest.
#[test]
fn the_likelihood_is_the_product_of_normal_densities() {
    let drops = [aloft(3, 0.2)];
    let options = Options {
        free: Vec::new(),
        ..Options::default()
    };
    let fit = fit(&model(), &drops, &options).unwrap();
    let mut sum = 0.0;
    for noise in &fit.noise {
        let of_it = fit
            .residuals
            .iter()
            .filter(|one| one.coordinate == noise.coordinate);
        let squares: f64 = of_it.map(|one| one.residual * one.residual).sum();
        let n = noise.n as f64;
        assert!((noise.sigma * noise.sigma / (squares / (n - 2.0)) - 1.0).abs() < 1e-3);
        let variance = squares / n;
        sum -= 0.5 * n * (libm::log(std::f64::consts::TAU * variance) + 1.0);
    }
    assert!(
        (fit.log_likelihood - sum).abs() < 1e-9 * sum.abs(),
        "{} {sum}",
        fit.log_likelihood
    );
    // twice the number of fitted numbers, or once ln n for each
    assert!((fit.aic() + 2.0 * sum - 18.0).abs() < 1e-6);
    assert!((fit.bic() + 2.0 * sum - 9.0 * libm::log(147.0)).abs() < 1e-6);
}

/// The noise of each coordinate is estimated until it no longer changes, whatever it was taken for at first.
#[test]
fn noise_converges_from_any_first_guess() {
    let drops = [aloft(6, 0.3)];
    let task = Task::new(model(), &drops, Loss::Square);
    let from = |factor: f64| {
        let mut problem = at_the_truth(&task, &[]);
        problem.weighing.sigma = SIGMA.map(|sigma| factor * sigma);
        converge_noise(problem).unwrap()
    };
    let (low, around) = from(0.01);
    let (high, _) = from(100.0);
    let deviations = low.deviations().unwrap();
    for coordinate in Coordinate::ALL {
        let c = coordinate.index();
        let of_it = deviations.iter().filter(|one| one.coordinate == coordinate);
        let squares: f64 = of_it.map(|one| one.by * one.by).sum();
        let sigma = (squares / (73.0 - around.taken[c])).sqrt();
        assert!((around.taken[c] - 2.0).abs() < 1e-6);
        for found in [low.weighing.sigma[c], high.weighing.sigma[c]] {
            assert!(
                (found / sigma - 1.0).abs() < 1e-6,
                "{coordinate:?}: {found:e} {sigma:e}"
            );
        }
    }
}

/// Huber's correction: the mean of ψ² over the square of the share of points in the middle, with what fitting takes.
#[test]
fn the_error_of_a_robust_fit_is_hubers() {
    let mut drops = [aloft(7, 0.3)];
    for frame in drops[0].frames.iter_mut().step_by(10) {
        frame.seen[0] = frame.seen[0].map(|x| x + 0.02);
    }
    let task = Task::new(model(), &drops, Loss::Huber);
    let problem = at_the_truth(&task, &[]);
    let (knee, mut squares, mut middle) = (1.345, 0.0, 0.0);
    let deviations = problem.deviations().unwrap();
    for one in &deviations {
        let r: f64 = one.by / SIGMA[one.coordinate.index()];
        squares += r.abs().min(knee) * r.abs().min(knee);
        middle += if r.abs() <= knee { 1.0 } else { 0.0 };
    }
    let n = deviations.len() as f64;
    let expected = squares / (n - 6.0) / (middle / n * middle / n);
    let found = spread(&problem).unwrap().factor;
    assert!(
        expected > 1.05 && (found / expected - 1.0).abs() < 1e-12,
        "{found} {expected}"
    );
}

/// What the optimiser is told: half the sum of squares of its residuals is the cost, and its derivatives are those of
/// its residuals, of points that Huber's loss bends, too.
#[test]
fn the_optimiser_sees_the_cost_and_its_derivatives() {
    let mut drops = [aloft(8, 0.2)];
    for frame in drops[0].frames.iter_mut().step_by(5) {
        frame.seen[1] = frame.seen[1].map(|z| z + 5e-3);
    }
    for loss in [Loss::Square, Loss::Huber] {
        let task = Task::new(model(), &drops, loss);
        let problem = at_the_truth(&task, &[]);
        let residuals = problem.residuals().unwrap();
        assert!((0.5 * residuals.norm_squared() / problem.cost() - 1.0).abs() < 1e-12);
        let jacobian = problem.jacobian().unwrap();
        for j in 0..6 {
            let mut direction = [0.0; 6];
            direction[j] = 1.0;
            let at = |by: f64| {
                let mut moved = problem.clone();
                moved.shift(&direction, by);
                moved.residuals().unwrap()
            };
            // no residual lies within this step of the knee
            let by = 1e-6;
            let slopes = (at(by) - at(-by)) / (2.0 * by);
            let error = (slopes - jacobian.column(j)).norm() / jacobian.column(j).norm();
            assert!(error < 1e-4, "{loss:?} {j}: {error}");
        }
    }
}
