//! Where the answer is known beforehand.

use crate::common::{Tosser, quick};
use coinmc_core::{Face, Landing, Preset, Tally};
use coinmc_testkit::{preset_launch, scene};

fn tally(ratio: f64, tosses: u64) -> Tally {
    let scene = scene(ratio, 0.3, 0.3);
    let mut tosser = Tosser::new(&scene, &quick());
    let mut tally = Tally::default();
    for toss in 0..tosses {
        tally.add(&tosser.toss(&preset_launch(Preset::Clean, &scene, 40, toss)));
    }
    tally
}

/// A rod lies down: its faces have less than 1e-3 of the solid angle, and the tosses of 150 that
/// have a face none of them but once in a hundred.
#[test]
fn a_rod_comes_to_rest_on_its_side() {
    let tally = tally(40.0, 150);
    assert!(
        tally.heads + tally.tails <= 1 && tally.side >= 120,
        "{tally:?}"
    );
}

/// A plate does not stand on its edge. Most of its tosses fail at this step (it is thinner than the
/// way it falls in one), and are counted as that; the rest has heads as often as tails within 5
/// standard errors (false alarms 6e-7).
#[test]
fn a_plate_comes_to_rest_on_a_face() {
    let tally = tally(0.02, 250);
    let decided = tally.heads + tally.tails;
    assert!(tally.side <= 1 && decided >= 20, "{tally:?}");
    let off = tally.heads as f64 - tally.tails as f64;
    assert!(off.abs() <= 5.0 * (decided as f64).sqrt(), "{tally:?}");
}

/// Without spin and with the first contact deciding, the coin keeps the face it was let go with.
#[test]
fn adhesive_without_spin_is_the_well_it_began_in() {
    for ratio in [0.1, 0.7, 1.0, 3.0] {
        let mut scene = scene(ratio, 0.5, 0.3);
        scene.surface = scene
            .surface
            .with_landing(Landing::Adhesive)
            .expect("a level surface");
        let mut tosser = Tosser::new(&scene, &quick());
        let half = ratio / 2.0 / (1.0 + ratio * ratio / 4.0_f64).sqrt();
        for toss in 0..2000 {
            let launch = preset_launch(Preset::Drop, &scene, 41, toss);
            let expected = if launch.axis.z.abs() < half {
                Face::Side
            } else if launch.axis.z > 0.0 {
                Face::Heads
            } else {
                Face::Tails
            };
            let outcome = tosser.toss(&launch);
            assert_eq!(outcome.face(), Some(expected), "{ratio} {toss}");
            assert_eq!((outcome.impacts, outcome.contact_steps), (0, 0));
        }
    }
}

/// With spin the first contact is that of the event-driven engine, whose search for it is its own.
#[test]
fn adhesive_landings_are_those_of_the_event_driven_engine() {
    use coinmc_core::Engine;
    use coinmc_volumetric::{Moreau, Settings, VolumetricEngine};
    for ratio in [0.25, 1.0, 2.0] {
        let mut scene = scene(ratio, 0.5, 0.3);
        scene.surface = scene
            .surface
            .with_landing(Landing::Adhesive)
            .expect("a level surface");
        let events = VolumetricEngine::new(&scene, &Settings::default(), Moreau).unwrap();
        let mut tosser = Tosser::new(&scene, &quick());
        for toss in 0..5000 {
            let launch = preset_launch(Preset::Clean, &scene, 42, toss);
            let expected = events.toss(&mut (), &launch, &mut ());
            assert_eq!(tosser.toss(&launch).ended, expected.ended, "{ratio} {toss}");
        }
    }
}
