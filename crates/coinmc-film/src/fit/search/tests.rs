//! Windows, grids and candidates of the search.

use super::*;
use crate::fit::Loss;
use crate::fit::tests::{SIGMA, START, aloft, at_bounces, at_the_truth, model};
use crate::synthetic::Synthetic;

/// Impacts that follow each other closely are one bounce, however many they are.
#[test]
fn impacts_soon_after_each_other_are_one_bounce() {
    let impacts = [1.0, 1.03, 1.07, 2.0, 2.0625, 3.5];
    let times = |together| [0, 1, 2, 3].map(|n| bounce(&impacts, n, together));
    assert_eq!(times(0.0625), [1.0, 2.0, 3.5, f64::INFINITY]);
    assert_eq!(times(0.05), [1.0, 2.0, 2.0625, 3.5]);
    assert_eq!(bounce(&[], 0, 0.1), f64::INFINITY);
}

/// A tenth, a quarter, a half and all of the frames after the first impact, and all those before it.
#[test]
fn windows_grow_from_the_first_impact() {
    let film = Synthetic::default();
    let drops = [film.film(&model()).unwrap(), aloft(2, 0.1)];
    let task = Task::new(model(), &drops, Loss::Square);
    let mut problem = at_the_truth(&task, &[]);
    problem.point.shared = film.shared;
    problem.point.starts[0] = film.start;
    let all = [drops[0].frames.len(), 25];
    let first = task.path(0, &problem.point, all[0]).unwrap().impacts_s[0];
    let before = task.times[0].iter().filter(|time| **time < first).count();
    assert!(before > 30 && all[0] - before > 40);
    let windows = lengths(&problem).unwrap();
    for (window, tenths) in windows.iter().zip([10, 25, 50, 100]) {
        let after = ((all[0] - before) * tenths).div_ceil(100);
        assert_eq!(window[..], [before + after, 25], "{tenths} %");
    }
    // linear theory of the frames soon after the impact knows less of the start
    let short = early(&problem).unwrap();
    let long = spread(&problem).unwrap();
    assert!(short.errors[4].unwrap() > long.errors[4].unwrap());
}

/// Frames count up to the next bounce, up to a time, and as far as the law says anything.
#[test]
fn the_window_ends_with_its_bounces_or_its_time() {
    let film = Synthetic::default();
    let drops = [film.film(&model()).unwrap()];
    let task = Task::new(model(), &drops, Loss::Square);
    let problem = at_bounces(&task, &[], drops[0].frames.len());
    let times = &task.times[0];
    let impacts = task.path(0, &problem.point, times.len()).unwrap().impacts_s;
    let step = 1.0 / film.rate_hz;
    let within = |bounces, until_s| horizon(&problem, Window { bounces, until_s })[0];
    for bounces in 0..3 {
        let end = bounce(&impacts, bounces, 4.0 * step);
        let expected = times.iter().filter(|time| **time < end).count();
        assert_eq!(within(bounces, f64::INFINITY), expected);
    }
    assert!(within(0, f64::INFINITY) < within(1, f64::INFINITY));
    assert_eq!(within(9, times[20]), 21);
    assert_eq!(within(9, f64::INFINITY), times.len());
}

/// The mean square of what is left, in standard deviations: about 1 for noise alone, and much more elsewhere.
#[test]
fn noise_alone_is_not_poor() {
    let drops = [aloft(4, 0.4)];
    let task = Task::new(model(), &drops, Loss::Square);
    let mut problem = at_the_truth(&task, &[]);
    problem.weighing.sigma = [5e-4, 5e-4, 0.5_f64.to_radians()];
    // of 291 squares a mean is known to sqrt(2/291) = 8 %
    assert!(
        (poorness(&problem) - 1.0).abs() < 0.35,
        "{}",
        poorness(&problem)
    );
    problem.point.starts[0][0] += 5e-3;
    assert!(
        (poorness(&problem) - 1.0 - 100.0 / 3.0).abs() < 4.0,
        "{}",
        poorness(&problem)
    );
}

/// Points that differ by less than 1e-4 of a unit in all of their numbers are one; the better one, which comes first, stays.
#[test]
fn the_same_point_is_kept_once() {
    let drops = [aloft(1, 0.1)];
    let task = Task::new(model(), &drops, Loss::Square);
    let best = at_the_truth(&task, &[Parameter::Restitution]);
    let moved = |unknown: usize, by: f64| {
        let mut direction = vec![0.0; best.unknowns.len()];
        direction[unknown] = 1.0;
        let mut other = best.clone();
        other.shift(&direction, by);
        other
    };
    let kept = |unknown, by| distinct(vec![best.clone(), moved(unknown, by)]).len();
    for unknown in 0..best.unknowns.len() {
        assert_eq!(
            [
                kept(unknown, 0.9e-4),
                kept(unknown, 1.2e-4),
                kept(unknown, -1.2e-4)
            ],
            [1, 2, 2]
        );
    }
    let first = &distinct(vec![moved(0, 0.5e-4), best.clone()])[0];
    assert!(first.point.shared.restitution > 0.5);
}

/// All pairs of the values of both grids, in the parameters' own units, and the rest as given.
#[test]
fn the_grid_holds_all_pairs() {
    let given = Shared {
        floor_m: 0.25,
        ..Shared::default()
    };
    let points = grid(
        &model(),
        &given,
        &[
            Parameter::Restitution,
            Parameter::PulseTime,
            Parameter::Floor,
        ],
    );
    let (of_e, of_time) = (Parameter::Restitution.grid(), Parameter::PulseTime.grid());
    assert_eq!(points.len(), of_e.len() * of_time.len());
    let coin = model().coin;
    let unit = (coin.rim_distance_m() / 9.81).sqrt();
    for (i, point) in points.iter().enumerate() {
        let (e, time) = (of_e[i / of_time.len()], unit * of_time[i % of_time.len()]);
        assert_eq!((point.restitution, point.floor_m), (e, 0.25));
        assert!((point.time_s / time - 1.0).abs() < 1e-15);
    }
}

/// Each parameter that is fitted takes each value of its grid while the others stay.
#[test]
fn one_parameter_at_a_time_is_replaced() {
    let drops = [aloft(1, 0.1)];
    let task = Task::new(model(), &drops, Loss::Square);
    let problem = at_the_truth(&task, &[Parameter::PulseTime, Parameter::Restitution]);
    let found = replaced(&problem);
    let unit = (model().coin.rim_distance_m() / 9.81).sqrt();
    let times = Parameter::PulseTime
        .grid()
        .iter()
        .map(|value| (value * unit, 0.5));
    let restitutions = Parameter::Restitution
        .grid()
        .iter()
        .map(|value| (1e-3, *value));
    let expected: Vec<_> = times.chain(restitutions).collect();
    assert_eq!(found.len(), expected.len());
    for (found, (time, e)) in found.iter().zip(expected) {
        let shared = found.point.shared;
        assert!(
            (shared.time_s / time - 1.0).abs() < 1e-15 && (shared.restitution - e).abs() < 1e-15
        );
        assert_eq!(found.point.starts, [START]);
    }
}

/// The lowest first, those without any prediction left out.
#[test]
fn the_best_come_first() {
    let drops = [aloft(1, 0.1)];
    let task = Task::new(model(), &drops, Loss::Square);
    let at = |x: f64| {
        let mut problem = at_the_truth(&task, &[]);
        problem.point.starts[0][0] += x;
        problem
    };
    let candidates = || vec![at(3.0), at(f64::NAN), at(0.0), at(1.0), at(2.0)];
    let order = |keep| -> Vec<f64> {
        let kept = best(candidates(), &[20], keep).into_iter();
        kept.map(|one| (one.point.starts[0][0] - START[0]).round())
            .collect()
    };
    assert_eq!(order(9), [0.0, 1.0, 2.0, 3.0]);
    assert_eq!(order(2), [0.0, 1.0]);
    assert_eq!(best(candidates(), &[20], 1)[0].weighing.frames, [20]);
    assert_eq!(SIGMA, best(candidates(), &[20], 1)[0].weighing.sigma);
}
