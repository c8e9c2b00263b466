//! The same launch gives the same outcome: on the scalar path, in a batch, observed or not.

use crate::common::engine;
use coinmc_core::{Engine, Launch, Preset, Scene, Tally, run_tosses};
use coinmc_testkit::{conformance, preset_launch, scene, stream};

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

fn launches(scene: &Scene, preset: Preset, seed: u64, count: u64) -> Vec<Launch> {
    let launch = |toss| preset_launch(preset, scene, seed, toss);
    (0..count).map(launch).collect()
}

#[test]
fn an_observer_changes_nothing() {
    for (ratio, restitution, friction) in SCENES {
        let scene = scene(ratio, restitution, friction);
        let launches = launches(&scene, Preset::CleanFlat, 90, 6_500);
        conformance::observers_change_nothing(&engine(&scene), &launches, &[]);
    }
}

#[test]
fn outcomes_depend_on_the_launch_alone() {
    for (ratio, restitution, friction) in SCENES {
        let scene = scene(ratio, restitution, friction);
        let launches = launches(&scene, Preset::Robot, 91, 2000);
        let engine = engine(&scene);
        conformance::outcomes_depend_on_the_launch_alone(&engine, &launches);
        conformance::a_stopped_batch_leaves_nothing_behind(&engine, &launches, 300);
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
            let launch = preset_launch(Preset::Robot, &scene, 91, toss);
            one_by_one.add_started(&engine.toss(&mut (), &launch, &mut ()), launch.up());
        }
        assert_eq!(whole, one_by_one);
        assert_eq!(whole.tosses(), 2000);
    }
}
