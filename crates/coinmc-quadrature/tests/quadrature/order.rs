//! The order of convergence.

use crate::common::{found, goal, scene, uneven};
use coinmc_core::{LaunchDistribution, Orientation, Preset};
use coinmc_quadrature::{Method, Variable};

/// Root mean square error of P(heads) over scrambles.
fn error(method: Method, launches: &LaunchDistribution, evaluations: u64, truth: f64) -> f64 {
    const SCRAMBLES: u64 = 24;
    let scene = scene(1.0);
    let square: f64 = (0..SCRAMBLES)
        .map(|seed| {
            let integral = found(method, &scene, launches, seed, &goal(1e-12, evaluations));
            (integral.faces[0].p - truth).powi(2)
        })
        .sum();
    (square / SCRAMBLES as f64).sqrt()
}

/// The exponent of the error between 2^10 and 2^15 evaluations; with 24 scrambles it is known
/// within 0.09.
fn exponent(method: Method, launches: &LaunchDistribution, truth: f64) -> f64 {
    let errors = [1 << 10, 1 << 15].map(|n| error(method, launches, n, truth));
    libm::log2(errors[1] / errors[0]) / 5.0
}

fn precise(method: Method, launches: &LaunchDistribution) -> f64 {
    found(method, &scene(1.0), launches, 99, &goal(1e-12, 1 << 18)).faces[0].p
}

/// Monte Carlo's exponent is −0.5.
#[test]
fn errors_fall_faster_than_by_sampling() {
    let (hand, robot) = (Preset::Hand.distribution(), Preset::Robot.distribution());
    for (variable, launches, bound) in [
        (Variable::Tilt, robot, -1.2),
        (Variable::Rate, hand, -0.75),
        (Variable::Azimuth, uneven(), -0.75),
    ] {
        let method = Method::Over(variable);
        let exponent = exponent(method, &launches, precise(method, &launches));
        assert!(exponent < bound, "{variable:?} {exponent}");
    }
}

/// A discontinuous integrand gains much with few dimensions, here the two angles that matter, and
/// hardly with the six of `clean`: the reason to integrate one of them in closed form.
#[test]
fn tosses_converge_faster_with_few_dimensions() {
    let drop = LaunchDistribution {
        orientation: Orientation::EulerAngles,
        ..Preset::Drop.distribution()
    };
    let two = exponent(Method::Tossed, &drop, precise(Method::Tossed, &drop));
    assert!(two < -0.6, "{two}");
    let zone = coinmc_analytic::zone::probabilities(1.0).heads;
    let many = exponent(Method::Tossed, &Preset::Clean.distribution(), zone);
    assert!(many < -0.4, "{many}");
}
