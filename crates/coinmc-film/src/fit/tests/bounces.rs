//! Films of bounces: intervals, false minima and derivatives across impacts.

use super::{at_bounces, model};
use crate::drop::{Coordinate, FilmedDrop};
use crate::fit::covariance::spread;
use crate::fit::problem::Task;
use crate::fit::search::search_further;
use crate::fit::{Fit, Loss, Options, fit, hop, intervals};
use crate::parameter::{Parameter, Shared};
use crate::synthetic::Synthetic;

/// The restitution of a film of two bounces.
fn bounced(seed: u64, loss: Loss, spoil: impl Fn(&mut FilmedDrop)) -> Fit {
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
        free: vec![Parameter::Restitution],
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
    let clean = bounced(5, Loss::Square, |_| {});
    let robust = bounced(5, Loss::Huber, spoil);
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

/// The nearest minimum is that of a wrong order of impacts, a hundred times as poor as the right one. Random steps
/// leave it, both those of its errors and those along growing windows, and a search that has found the right one stays.
#[test]
fn random_steps_leave_a_false_minimum() {
    let drops = [Synthetic::default().film(&model()).unwrap()];
    let task = Task::new(model(), &drops, Loss::Square);
    let from = |restitution, friction| {
        let mut problem = at_bounces(&task, &[Parameter::Restitution, Parameter::Friction], 100);
        problem.point.shared = Shared {
            restitution,
            friction,
            ..Shared::default()
        };
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

/// At a restitution of 1, the end of its range, derivatives are those of the side within, and nearly those close to it.
#[test]
fn derivatives_at_the_end_of_a_range_are_those_close_to_it() {
    let drops = [Synthetic::default().film(&model()).unwrap()];
    let task = Task::new(model(), &drops, Loss::Square);
    let at = |restitution: f64| {
        let mut problem = at_bounces(&task, &[Parameter::Restitution], 80);
        problem.point.shared.restitution = restitution;
        problem.derivatives().unwrap().column(0).clone_owned()
    };
    let (end, close) = (at(1.0), at(1.0 - 1e-4));
    assert!(end.norm() > 100.0 && (end - &close).norm() < 0.01 * close.norm());
}

/// Kenward & Roger's variance in matrices: V + 2 V Σ (2/ν)(N − N V N) V, the sum over the coordinates, N the normal matrix
/// of one. What the others do with a parameter that is held is its column of V.
#[test]
fn errors_hold_what_the_estimated_weights_add() {
    let drops = [Synthetic::default().film(&model()).unwrap()];
    let task = Task::new(model(), &drops, Loss::Square);
    let problem = at_bounces(&task, &[Parameter::Restitution, Parameter::Friction], 100);
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
