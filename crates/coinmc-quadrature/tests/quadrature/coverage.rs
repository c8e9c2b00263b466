//! The coverage of the intervals.

use crate::common::{found, goal, scene, uneven};
use coinmc_core::{LaunchDistribution, Marginal, Orientation, Preset};
use coinmc_quadrature::{Method, Variable};

/// Scrambles of each case.
const SCRAMBLES: u64 = 400;
/// Allowed misses of 95 % intervals: more than 36 of 400 have the probability 4e-4.
const MAX_MISSES: usize = 36;

/// Counts the intervals that miss, face by face.
fn misses(
    method: Method,
    launches: &LaunchDistribution,
    ratio: f64,
    evaluations: u64,
    half_width: f64,
) -> [usize; 3] {
    let scene = scene(ratio);
    // a hundred times more precise than the tested intervals
    let better = Method::of(&scene, launches, f64::INFINITY).unwrap();
    let truth = found(better, &scene, launches, u64::MAX, &goal(1e-9, 1 << 17));
    let mut misses = [0; 3];
    for seed in 0..SCRAMBLES {
        let integral = found(
            method,
            &scene,
            launches,
            seed,
            &goal(half_width, evaluations),
        );
        for ((misses, share), truth) in misses.iter_mut().zip(integral.faces).zip(truth.faces) {
            *misses += usize::from(truth.p < share.lo || truth.p > share.hi);
        }
    }
    misses
}

#[test]
fn tosses_at_sobol_points_have_the_stated_coverage() {
    for (launches, ratio) in [(Preset::Clean.distribution(), 1.0), (uneven(), 0.5)] {
        // stopped at a fixed number, and by the width
        for (evaluations, half_width) in [(1 << 11, 1e-9), (1 << 13, 0.015)] {
            let misses = misses(Method::Tossed, &launches, ratio, evaluations, half_width);
            assert!(misses.iter().all(|&n| n <= MAX_MISSES), "{misses:?}");
        }
    }
}

/// A face of probability 5e-4: at the first looks a dozen of the 16 replicates have not had it.
#[test]
fn rare_faces_have_the_stated_coverage() {
    let misses = misses(
        Method::Tossed,
        &Preset::Clean.distribution(),
        1e-3,
        1 << 12,
        1e-9,
    );
    assert!(misses.iter().all(|&n| n <= MAX_MISSES), "{misses:?}");
}

#[test]
fn closed_forms_have_the_stated_coverage() {
    let slow = LaunchDistribution {
        velocity_m_s: [
            Marginal::Constant(0.0),
            Marginal::Constant(0.0),
            Marginal::Uniform { from: 0.0, to: 0.4 },
        ],
        orientation: Orientation::EulerAngles,
        ..uneven()
    };
    for (variable, launches) in [
        (Variable::Azimuth, uneven()),
        (Variable::Rate, Preset::Hand.distribution()),
        (Variable::Tilt, Preset::Robot.distribution()),
        (Variable::Velocity, slow),
    ] {
        let misses = misses(Method::Over(variable), &launches, 1.0, 1 << 10, 1e-9);
        assert!(
            misses.iter().all(|&n| n <= MAX_MISSES),
            "{variable:?} {misses:?}"
        );
    }
}
