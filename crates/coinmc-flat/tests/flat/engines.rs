//! Comparison with other engines.

use crate::common::engine;
use coinmc_core::{Coin, Preset, Scene, Surface, run_tosses};
use coinmc_testkit::stream;

/// Chipmunk 7 and Box2D 2.4 tossed a rectangle (I = m(4R² + H²)/12, the section's own) with e = .5
/// and μ = .3 from 1 m at uniform angle and N(0, 20 rad/s): P(side) = .077 ± .006 and .078 at
/// H/R = 1, .248 ± .010 at 1.5 (2000 tosses). Allowed: three of their standard errors, plus .008
/// and .010 for the errors of fixed steps at a bounce.
#[test]
fn rectangles_agree_with_chipmunk_and_box2d() {
    for (ratio, expected, allowed) in [(1.0, 0.077, 0.026), (1.5, 0.248, 0.04)] {
        let coin = Coin::cylinder(ratio, 0.01).unwrap();
        let rectangle = coin.mass_kg() * 1e-4 * (4.0 + ratio * ratio) / 12.0;
        let coin = coin.with_moments(None, Some(rectangle)).unwrap();
        let scene = Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), 9.81).unwrap();
        let launches = Preset::CleanFlat.distribution();
        let tally = run_tosses(
            &engine(&scene),
            &mut (),
            &scene,
            &launches,
            &stream(130),
            0..100_000,
        );
        let p = tally.side as f64 / 100_000.0;
        println!("ratio {ratio}: {p}");
        assert!((p - expected).abs() < allowed, "{ratio}: {p}");
    }
}
