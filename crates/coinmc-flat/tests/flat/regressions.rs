//! Tosses that once ended undecided, found among 1e8 others.

use coinmc_core::{Coin, Domain, Engine, Preset, Scene, Stream, Surface};
use coinmc_flat::{FlatEngine, Moreau, Settings};

fn is_decided(preset: Preset, (ratio, e, mu): (f64, f64, f64), point: u64, toss: u64) -> bool {
    let coin = Coin::cylinder(ratio, 0.01).unwrap();
    let scene = Scene::new(coin, Surface::new(e, mu).unwrap(), 9.81).unwrap();
    let engine = FlatEngine::new(&scene, &Settings::default(), Moreau).unwrap();
    let mut uniforms = Stream::new(1, Domain::Launch, point).toss(toss);
    let launch = preset.distribution().launch(&coin, &mut uniforms);
    engine.toss(&mut (), &launch, &mut ()).face().is_some()
}

/// With e = 0 and ω²cos δ = 1 to five digits the corner neither rises nor falls after the impact.
#[test]
fn a_corner_that_hovers_after_an_impact_does_not_stall() {
    for (scene, toss) in [
        ((1.0, 0.0, 0.0), 28_275),
        ((10.0, 0.0, 0.1), 469_505),
        ((100.0, 0.0, 0.1), 322_024),
        ((100.0, 0.0, 0.1), 751_164),
        ((1.0, 0.0, 0.3), 724_435),
        ((1.0, 0.0, 10.0), 428_439),
        ((1.0, 0.0, 10.0), 582_873),
        ((100.0, 0.0, 0.3), 525_929),
    ] {
        assert!(
            is_decided(Preset::CleanFlat, scene, 0, toss),
            "{scene:?} {toss}"
        );
    }
}

/// The friction that sticking needs touches the cone and falls again.
#[test]
fn friction_that_grazes_the_cone_does_not_stall() {
    assert!(is_decided(Preset::Robot, (2.0, 0.3, 0.3), 91, 17_473));
}
