//! The same launch gives the same outcome: on the scalar path, in a batch, after any other toss.

use crate::common::Tosser;
use coinmc_core::{Engine, Launch, Preset};
use coinmc_testkit::{conformance, preset_launch, rolling_scene};
use coinmc_volumetric::{Lanes, Law};

#[test]
fn outcomes_depend_on_the_launch_alone() {
    for law in Law::ALL {
        for (ratio, e, mu, rho) in [
            (0.85, 0.5, 0.3, 0.01),
            (0.25, 0.0, 0.3, 0.003),
            (2.0, 0.8, 0.0, 0.01),
        ] {
            let scene = rolling_scene(ratio, e, mu, rho);
            let launch = |toss| preset_launch(Preset::Clean, &scene, 240, toss);
            let launches: Vec<Launch> = (0..200).map(launch).collect();
            let engine = Tosser::of(&scene, law).0;
            conformance::outcomes_depend_on_the_launch_alone(&engine, &launches);
            for lanes in Lanes::ALL {
                let Ok(engine) = engine.clone().with_lanes(lanes) else {
                    println!("SKIPPED: this processor has no {lanes}");
                    continue;
                };
                conformance::batch_matches_scalar(&engine, &launches);
                conformance::a_stopped_batch_leaves_nothing_behind(&engine, &launches, 100);
            }
        }
    }
}
