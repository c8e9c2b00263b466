//! A toss is the same toss whatever the world did before it, and whoever makes it.

use crate::common::{Tosser, launch, quick, scene, table1};
use coinmc_core::{Outcome, Preset, Scene};
use coinmc_rapier::{Account, Flight, Settings};
use std::thread;

fn scenes() -> [(Scene, Preset, Settings); 4] {
    let steps = Settings {
        flight: Flight::Steps,
        ..quick()
    };
    let coarse = Settings {
        step_s: 0.02,
        ..Settings::default()
    };
    [
        (scene(0.5, 0.5, 0.3), Preset::Clean, quick()),
        (scene(2.0, 0.0, 0.3), Preset::Clean, quick()),
        (scene(2.0, 0.8, 1.0), Preset::Clean, steps),
        (table1(1.0), Preset::Table1, coarse),
    ]
}

/// To the last bit: every count and the energy and depth of the account.
#[test]
fn a_toss_alone_is_the_toss_in_a_batch() {
    let mut tosses = 0;
    for (scene, preset, settings) in scenes() {
        let mut batch = Tosser::new(&scene, &settings);
        let together: Vec<Account> = (0..600)
            .map(|toss| batch.examine(&launch(preset, &scene, 10, toss)))
            .collect();
        // backwards, so that every toss has other predecessors; every third in a world of its own
        let mut other = Tosser::new(&scene, &settings);
        for (toss, expected) in together.iter().enumerate().rev() {
            if toss % 3 == 0 {
                other = Tosser::new(&scene, &settings);
            }
            let alone = other.examine(&launch(preset, &scene, 10, toss as u64));
            assert_eq!(alone, *expected, "toss {toss} of {preset}");
            tosses += 1;
        }
    }
    assert_eq!(tosses, 2400);
}

#[test]
fn threads_do_not_matter() {
    let (scene, preset, settings) = scenes()[0];
    let toss = |from: u64| -> Vec<Outcome> {
        let mut tosser = Tosser::new(&scene, &settings);
        let tosses = (0..200).map(|k| launch(preset, &scene, 11, 4 * k + from));
        tosses.map(|launch| tosser.toss(&launch)).collect()
    };
    let apart: Vec<Vec<Outcome>> = thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|from| scope.spawn(move || toss(from))).collect();
        threads.into_iter().map(|t| t.join().unwrap()).collect()
    });
    let mut tosser = Tosser::new(&scene, &settings);
    for k in 0..800_usize {
        let outcome = tosser.toss(&launch(preset, &scene, 11, k as u64));
        assert_eq!(apart[k % 4][k / 4], outcome, "{k}");
    }
}
