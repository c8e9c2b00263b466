//! The same launch gives the same outcome: scalar, in a batch, observed or not.

use crate::common::{Recorder, engine, preset, scene, stream};
use coinmc_core::{Engine, Preset, Tally, run_tosses};

/// All kinds of contact: rocking, sliding, pivoting, frictionless, grazing, thin, thick.
const SCENES: [(f64, f64, f64); 8] = [
    (1.0, 0.0, 0.3),
    (0.2, 0.0, 1.0),
    (3.0, 0.0, 0.1),
    (1.0, 0.0, 0.0),
    (1.2, 0.5, 0.3),
    (0.05, 0.3, 10.0),
    (2.0, 0.7, 0.0),
    (20.0, 0.5, 0.3),
];

#[test]
fn an_observer_changes_nothing() {
    for (ratio, restitution, friction) in SCENES {
        let scene = scene(ratio, restitution, friction);
        let engine = engine(&scene);
        for toss in 0..6_500 {
            let launch = preset(Preset::CleanFlat, &scene, 90, toss);
            let mut recorder = Recorder::default();
            let observed = engine.toss(&mut (), &launch, &mut recorder);
            let unobserved = engine.toss(&mut (), &launch, &mut ());
            assert_eq!(
                observed, unobserved,
                "{ratio} {restitution} {friction} {toss}"
            );
            assert!(recorder.0.len() >= 2);
        }
    }
}

#[test]
fn a_toss_does_not_depend_on_its_batch() {
    let launches = Preset::Robot.distribution();
    for (ratio, restitution, friction) in SCENES {
        let scene = scene(ratio, restitution, friction);
        let engine = engine(&scene);
        let run = |range| run_tosses(&engine, &mut (), &scene, &launches, &stream(91), range);
        let whole = run(0..2000);
        let mut merged = Tally::default();
        // in reverse order and in chunks of unequal length
        for range in [1999..2000, 700..1999, 1..700, 0..1] {
            merged.merge(&run(range));
        }
        assert_eq!(whole, merged);
        let mut one_by_one = Tally::default();
        for toss in (0..2000).rev() {
            let launch = preset(Preset::Robot, &scene, 91, toss);
            one_by_one.add(&engine.toss(&mut (), &launch, &mut ()));
        }
        assert_eq!(whole, one_by_one);
        assert_eq!(whole.tosses(), 2000);
    }
}
