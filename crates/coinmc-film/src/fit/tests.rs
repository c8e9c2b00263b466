//! Drops that stay aloft, in which every coordinate is a straight line but for gravity, so that linear theory is
//! exact and its results are those of textbooks.

use super::covariance::{is_determined, spread};
use super::problem::{Point, Problem, Task, Unknown, Weighing};
use super::search::search_further;
use super::{
    Fit, FitError, Loss, MAX_DROPS, MAX_FRAMES, Options, Remark, check, converge_noise, fit, hop,
    intervals,
};
use crate::drop::{Coordinate, FilmedDrop};
use crate::law::Model;
use crate::parameter::{Parameter, Shared};
use crate::path::start_scales;
use crate::synthetic::Synthetic;
use coinmc_core::Coin;
use coinmc_flat::Law;
use levenberg_marquardt::LeastSquaresProblem;

pub(super) const SIGMA: [f64; 3] = [2e-4, 5e-4, 3e-3];
pub(super) const START: [f64; 6] = [0.1, 0.2, 5.0, 0.3, 0.4, 7.0];

pub(crate) fn model() -> Model {
    Model {
        law: Law::Moreau,
        coin: Coin::cylinder(1.0, 0.01).expect("a coin"),
        gravity_m_s2: 9.81,
    }
}

/// A fit of nothing, to be filled in.
pub(crate) fn blank() -> Fit {
    Fit {
        model: model(),
        parameters: Vec::new(),
        shared: Shared::default(),
        drops: Vec::new(),
        noise: Vec::new(),
        n: 0,
        fitted: 0,
        log_likelihood: 0.0,
        confidence: 0.95,
        remarks: Vec::new(),
        residuals: Vec::new(),
    }
}

/// A drop that falls for so long, s, without touching the ground.
pub(super) fn aloft(seed: u64, duration_s: f64) -> FilmedDrop {
    let film = Synthetic {
        seed,
        start: START,
        duration_s,
        ..Synthetic::default()
    };
    film.film(&model()).expect("a film")
}

/// All frames of the drops, at the states that they were made from.
pub(super) fn at_the_truth<'a>(task: &'a Task<'a>, free: &[Parameter]) -> Problem<'a> {
    let weighing = Weighing {
        frames: task.drops.iter().map(|drop| drop.frames.len()).collect(),
        sigma: SIGMA,
    };
    let point = Point {
        shared: Shared::default(),
        starts: vec![START; task.drops.len()],
    };
    Problem::new(task, weighing, free, point)
}

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

/// A film of two bounces.
fn bounced(seed: u64, free: Parameter, loss: Loss, spoil: impl Fn(&mut FilmedDrop)) -> Fit {
    let mut drop = Synthetic {
        seed,
        duration_s: 0.4,
        position_noise_m: 1e-4,
        angle_noise_rad: 1e-3,
        ..Synthetic::default()
    }
    .film(&model())
    .expect("a film");
    spoil(&mut drop);
    let shared = Synthetic::default().shared;
    let options = Options {
        free: vec![free],
        shared,
        loss,
        bounces: 1,
        ..Options::default()
    };
    fit(&model(), &[drop], &options).expect("a fit")
}

/// Little noise leaves a single parameter so narrow an interval that the path is linear in it, so that the profile of the
/// cost, which is followed by fits, ends where linear theory says: 1.986 standard errors away, for 94 points a coordinate. With
/// Huber's loss, too, where a twentieth of the points lie far off; but its curvature leaps from point to point, so that the cost is
/// a parabola only on average.
#[test]
fn a_narrow_interval_is_that_of_linear_theory() {
    let spoil = |drop: &mut FilmedDrop| {
        for (i, frame) in drop
            .frames
            .iter_mut()
            .enumerate()
            .filter(|(i, _)| i % 20 == 7)
        {
            let far = if i % 40 == 7 { 4e-3 } else { -4e-3 };
            frame.seen = frame.seen.map(|seen| seen.map(|value| value + far));
        }
    };
    let clean = bounced(5, Parameter::Restitution, Loss::Square, |_| {});
    let robust = bounced(5, Parameter::Restitution, Loss::Huber, spoil);
    for (fit, tolerance) in [(clean, 0.01), (robust, 0.05)] {
        let estimate = &fit.parameters[0];
        let error = estimate.std_error.unwrap();
        for arm in [
            estimate.hi.unwrap() - estimate.value,
            estimate.value - estimate.lo.unwrap(),
        ] {
            assert!(
                (arm / (1.986 * error) - 1.0).abs() < tolerance,
                "{estimate:?}"
            );
        }
        assert!((estimate.value - 0.5).abs() < 4.0 * error);
    }
}

/// The units of the search are those of a coin that falls by its own size.
#[test]
fn units_of_the_search_are_those_of_the_coin() {
    let d = (0.01_f64 * 0.01 + 0.005 * 0.005).sqrt();
    let speed = (9.81 * d).sqrt();
    let units = start_scales(&model());
    for (unit, expected) in units.into_iter().zip([d, speed, d, speed, 1.0, speed / d]) {
        assert!((unit / expected - 1.0).abs() < 1e-12);
    }
}

/// The nearest minimum is that of a wrong order of impacts, a hundred times as poor as the right one. Random steps
/// leave it, both those of its errors and those along growing windows, and a search that has found the right one stays.
#[test]
fn random_steps_leave_a_false_minimum() {
    let film = Synthetic::default();
    let drops = [film.film(&model()).unwrap()];
    let task = Task::new(model(), &drops, Loss::Square);
    let from = |restitution, friction| {
        let mut problem = at_the_truth(&task, &[Parameter::Restitution, Parameter::Friction]);
        problem.point.shared = Shared {
            restitution,
            friction,
            ..Shared::default()
        };
        problem.point.starts[0] = film.start;
        problem.weighing.sigma = [5e-4, 5e-4, 0.5_f64.to_radians()];
        problem.weighing.frames[0] = 100;
        problem.minimise(40)
    };
    let (right, wrong) = (from(0.45, 0.3), from(0.8, 0.1));
    assert!(wrong.cost() > 100.0 * right.cost());
    // the profile around it meets lower costs, and gives up its intervals for them unless it may not
    let (around, options) = (spread(&wrong).unwrap(), Options::default());
    let better = intervals(&wrong, &around, &options, true).unwrap_err();
    assert!(better.cost() < wrong.cost());
    assert!(intervals(&wrong, &around, &options, false).is_ok());
    let around = spread(&right).unwrap();
    assert!(intervals(&right, &around, &options, true).is_ok());
    for found in [hop(wrong.clone()).unwrap(), search_further(wrong)] {
        assert!((found.cost() / right.cost() - 1.0).abs() < 1e-6);
        assert!((found.point.shared.restitution - 0.5).abs() < 2e-3);
    }
    assert_eq!(
        search_further(right.clone()).point.starts,
        right.point.starts
    );
    assert!(hop(right.clone()).unwrap().cost() <= right.cost());
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

/// An unknown is moved by a multiple of its unit, as far as its range goes.
#[test]
fn steps_end_at_the_end_of_a_range() {
    let drops = [aloft(1, 0.1)];
    let task = Task::new(model(), &drops, Loss::Square);
    let mut problem = at_the_truth(&task, &[Parameter::Restitution, Parameter::Floor]);
    let units = start_scales(&model());
    let before = problem.clone();
    problem.shift(&[0.25, 2.0, 1.0, 0.0, 0.0, 3.0, 0.0, -1.0], 0.5);
    assert!((problem.point.shared.restitution - 0.625).abs() < 1e-15);
    assert!((problem.point.shared.floor_m - units[0]).abs() < 1e-15);
    let by = [0.5, 0.0, 0.0, 1.5, 0.0, -0.5];
    for place in 0..6 {
        let moved = problem.point.starts[0][place] - before.point.starts[0][place];
        assert!((moved - by[place] * units[place]).abs() < 1e-15);
    }
    problem.shift(&[1.0; 8], 0.5);
    assert_eq!(problem.point.shared.restitution, 1.0);
    assert_eq!([7, 8, 60].map(|usual| before.tries(usual)), [7, 8, 60]);
    let hasty = Problem {
        thorough: false,
        ..before
    };
    assert_eq!([7, 8, 60].map(|usual| hasty.tries(usual)), [1, 1, 8]);
}

/// A parameter is determined if all points together move by more than a standard deviation over the whole of its range, and a
/// state if they do over a thousand units.
#[test]
fn what_moves_nothing_is_not_determined() {
    let drops = [aloft(1, 0.1)];
    let task = Task::new(model(), &drops, Loss::Square);
    let free = [Parameter::Friction, Parameter::PulseTime, Parameter::Floor];
    let problem = at_the_truth(&task, &free);
    let unit = Parameter::PulseTime.scale(&model().coin, 9.81);
    for (j, width) in [(0, 10.0), (1, (1.0 - 1e-7) / unit), (2, 1e3), (3, 1e3)] {
        let least = 1.0 / (width * width);
        assert!(is_determined(&problem, j, 1.001 * least), "{j}");
        assert!(!is_determined(&problem, j, 0.999 * least), "{j}");
    }
    for end in [0.0, 10.0] {
        let mut problem = problem.clone();
        problem.point.shared.friction = end;
        assert!(!is_determined(&problem, 0, 1e9));
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

/// Which fits are refused before anything is computed: at the limits themselves none.
#[test]
fn only_fits_beyond_the_limits_are_refused() {
    let drop = aloft(1, 0.05);
    let checked = |drops: &[FilmedDrop], options: &Options| {
        let task = Task::new(model(), drops, Loss::Square);
        check(&task, options)
    };
    let options = Options::default();
    let few = |count| vec![drop.clone(); count];
    assert_eq!(checked(&few(1), &options), Ok(()));
    assert_eq!(checked(&few(MAX_DROPS), &options), Ok(()));
    assert_eq!(checked(&few(0), &options), Err(FitError::Drops(0)));
    assert_eq!(checked(&few(65), &options), Err(FitError::Drops(65)));
    assert_eq!(checked(&few(70), &options), Err(FitError::Drops(70)));
    for (confidence, fine) in [
        (0.0, false),
        (1.0, false),
        (1.5, false),
        (-0.5, false),
        (f64::NAN, false),
        (0.01, true),
    ] {
        let options = Options {
            confidence,
            ..Options::default()
        };
        assert_eq!(checked(&few(1), &options).is_ok(), fine, "{confidence}");
    }
    let long = |count: usize| {
        let frames = drop.frames.iter().copied().cycle().take(count).collect();
        FilmedDrop {
            name: "long".to_owned(),
            frames,
        }
    };
    let options = Options {
        free: Vec::new(),
        ..Options::default()
    };
    assert_eq!(checked(&[long(MAX_FRAMES)], &options), Ok(()));
    let too_long = FitError::TooLong {
        name: "long".to_owned(),
        frames: MAX_FRAMES + 1,
        max: MAX_FRAMES,
    };
    assert_eq!(checked(&[long(MAX_FRAMES + 1)], &options), Err(too_long));
    // 3 coordinates of 1,111,111 frames in 12 columns are the last to have fewer than 40 million derivatives
    let two = |frames| checked(&vec![long(frames); 8], &options);
    assert_eq!(two(34_722), Ok(()));
    assert_eq!(two(34_723), Err(FitError::TooLarge { frames: 8 * 34_723 }));
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

/// Where x was never marked, where the coin began is not asked for; its speed changes what friction does.
#[test]
fn a_place_that_was_not_marked_is_not_fitted() {
    let mut drops = [aloft(1, 0.05), aloft(2, 0.05)];
    for frame in &mut drops[0].frames {
        frame.seen[0] = None;
    }
    let task = Task::new(model(), &drops, Loss::Square);
    let of_first = (1..6).map(|place| Unknown::Start(0, place));
    let of_second = (0..6).map(|place| Unknown::Start(1, place));
    let expected: Vec<Unknown> = of_first.chain(of_second).collect();
    assert_eq!(at_the_truth(&task, &[]).unknowns, expected);
    let options = Options {
        free: Vec::new(),
        ..Options::default()
    };
    let fit = fit(&model(), &drops[..1], &options).unwrap();
    let coordinates: Vec<_> = fit.noise.iter().map(|noise| noise.coordinate).collect();
    assert_eq!(coordinates, [Coordinate::Z, Coordinate::Theta]);
    assert_eq!((fit.n, fit.fitted), (2 * 13, 5 + 2));
}

/// At a restitution of 1, the end of its range, derivatives are those of the side within, and nearly those close to it.
#[test]
fn derivatives_at_the_end_of_a_range_are_those_close_to_it() {
    let film = Synthetic::default();
    let drops = [film.film(&model()).unwrap()];
    let task = Task::new(model(), &drops, Loss::Square);
    let at = |restitution: f64| {
        let mut problem = at_the_truth(&task, &[Parameter::Restitution]);
        problem.point.shared = Shared {
            restitution,
            ..film.shared
        };
        problem.point.starts[0] = film.start;
        problem.weighing.frames[0] = 80;
        problem.derivatives().unwrap().column(0).clone_owned()
    };
    let (end, close) = (at(1.0), at(1.0 - 1e-4));
    assert!(end.norm() > 100.0 && (end - &close).norm() < 0.01 * close.norm());
}

/// Kenward & Roger's variance in matrices: V + 2 V Σ (2/ν)(N − N V N) V, the sum over the coordinates, N the normal matrix
/// of one. What the others do with a parameter that is held is its column of V.
#[test]
fn errors_hold_what_the_estimated_weights_add() {
    let film = Synthetic::default();
    let drops = [film.film(&model()).unwrap()];
    let task = Task::new(model(), &drops, Loss::Square);
    let mut problem = at_the_truth(&task, &[Parameter::Restitution, Parameter::Friction]);
    problem.point.shared = film.shared;
    problem.point.starts[0] = film.start;
    problem.weighing.frames[0] = 100;
    problem.weighing.sigma = [5e-4, 5e-4, 0.5_f64.to_radians()];
    let found = spread(&problem).unwrap();
    let (matrix, rows) = (
        problem.derivatives().unwrap(),
        problem.deviations().unwrap(),
    );
    let of = |coordinate: Coordinate| {
        let of_it = (0..rows.len()).filter(|i| rows[*i].coordinate == coordinate);
        let part = matrix.select_rows(&of_it.collect::<Vec<_>>());
        part.tr_mul(&part)
    };
    let v = matrix.tr_mul(&matrix).try_inverse().unwrap();
    let mut added = &v * 0.0;
    for coordinate in Coordinate::ALL {
        let n = of(coordinate);
        let taken = (&n * &v).trace();
        assert!((found.taken[coordinate.index()] - taken).abs() < 1e-6);
        added += &v * (&n - &n * &v * &n) * &v * (4.0 / (100.0 - taken));
    }
    for (j, unknown) in problem.unknowns.iter().enumerate() {
        let variance = v[(j, j)] + added[(j, j)].max(0.0);
        let error = found.errors[j].unwrap() / problem.scale(*unknown);
        assert!((error * error / variance - 1.0).abs() < 1e-6, "{unknown:?}");
        assert!((found.inflation[j] * v[(j, j)] / variance - 1.0).abs() < 1e-6);
    }
    assert!(found.inflation[0] > 1.001);
    for (j, valley) in found.valleys.iter().enumerate() {
        let expected = v.column(j) / v[(j, j)];
        assert!(
            valley
                .iter()
                .zip(&expected)
                .all(|(a, b)| (a - b).abs() < 1e-6 * (1.0 + b.abs()))
        );
    }
}
