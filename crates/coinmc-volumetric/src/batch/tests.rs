//! Tosses in a batch end bit-identically to the scalar path.

use super::Batch;
use super::pool::SLOTS;
use crate::engine::VolumetricEngine;
use crate::finished_toss::FinishedToss;
use crate::impact::ImpactLaw;
use crate::laws::{ChatterjeeRuina, Moreau, Stronge};
use crate::settings::{Decision, Settings};
use coinmc_core::{
    Coin, Drag, Ended, Engine, Landing, Launch, Preset, Roughness, Scene, Surface, TossBatch,
};
use coinmc_lanes::{Lanes, WIDTH};
use coinmc_testkit::{count_until, preset_launch};
use std::ops::ControlFlow;

fn surface(e: f64, mu: f64, rho: f64) -> Surface {
    let surface = Surface::new(e, mu).expect("a valid surface");
    surface
        .with_friction_lengths(rho * 0.01, rho * 0.01)
        .expect("a valid surface")
}

/// With rims rounded with the radius `rim`, in R.
fn rounded(ratio: f64, rim: f64, surface: Surface) -> Scene {
    let mut scene = scene(ratio, surface);
    let rim_m = rim * scene.coin.radius_m();
    scene.coin = scene.coin.with_rim_radius(rim_m).expect("a valid rim");
    scene
}

fn scene(ratio: f64, surface: Surface) -> Scene {
    let coin = Coin::cylinder(ratio, 0.01).expect("a valid coin");
    Scene::new(coin, surface, 9.81).expect("a valid scene")
}

fn launches(scene: &Scene, preset: Preset, count: u64) -> Vec<Launch> {
    let launch = |toss| preset_launch(preset, scene, 600, toss);
    (0..count).map(launch).collect()
}

/// Every toss by its number.
fn ends<L: ImpactLaw>(engine: &VolumetricEngine<L>, launches: &[Launch]) -> Vec<FinishedToss> {
    let mut ends = vec![None; launches.len()];
    let batch = engine.batch().expect("lanes");
    batch.toss_all_in_batch(launches.iter().copied(), |ended| {
        for (number, end) in ended {
            let index = usize::try_from(*number).expect("a small number");
            assert!(ends[index].replace(*end).is_none(), "toss {number} twice");
        }
        ControlFlow::Continue(())
    });
    let ends: Option<Vec<FinishedToss>> = ends.into_iter().collect();
    ends.expect("every toss ends")
}

fn same(end: &FinishedToss, expected: &FinishedToss) -> bool {
    end.outcome == expected.outcome && end.time.to_bits() == expected.time.to_bits()
}

/// Compares every set of lanes with the single toss.
fn agree<L: ImpactLaw>(scene: &Scene, settings: &Settings, law: L, launches: &[Launch]) {
    let engine = VolumetricEngine::new(scene, settings, law).expect("valid settings");
    let scalar: Vec<FinishedToss> = launches
        .iter()
        .map(|l| engine.model.run(l, &mut ()))
        .collect();
    for lanes in Lanes::ALL
        .into_iter()
        .filter(|lanes| *lanes != Lanes::Scalar)
    {
        let Ok(engine) = engine.clone().with_lanes(lanes) else {
            println!("SKIPPED: this processor has no {lanes}");
            continue;
        };
        for (i, (end, expected)) in ends(&engine, launches).iter().zip(&scalar).enumerate() {
            assert!(
                same(end, expected),
                "{lanes} toss {i} of {scene:?}: {end:?} instead of {expected:?}"
            );
        }
    }
}

#[test]
fn every_shape_surface_and_law() {
    let mut case = 0;
    for ratio in [0.1, 0.25, 0.85, 2.0, 10.0] {
        for e in [0.0, 0.5, 0.8] {
            for (mu, rho) in [(0.0, 0.0), (0.0, 0.01), (0.3, 0.01), (0.3, 0.003)] {
                let scene = scene(ratio, surface(e, mu, rho));
                let launches = launches(&scene, Preset::Clean, 40);
                let settings = Settings::default();
                match case % 4 {
                    0 => agree(&scene, &settings, ChatterjeeRuina, &launches),
                    1 => agree(&scene, &settings, Stronge, &launches[..12]),
                    _ => agree(&scene, &settings, Moreau, &launches),
                }
                case += 1;
            }
        }
        case += 1;
    }
}

#[test]
fn drag_threshold_adhesion_no_gyroscopic_torque_and_high_or_held_friction() {
    let drag = Drag::new(0.5, 0.3).expect("valid rates");
    let threshold = surface(0.5, 0.3, 0.01).with_restitution_threshold(0.3);
    let softer = surface(0.5, 0.3, 0.01).with_speed_dependent_restitution(0.25, 0.2);
    let scenes = [
        scene(0.85, surface(0.5, 0.3, 0.01)).with_drag(drag),
        scene(0.85, softer.expect("a valid surface")),
        rounded(0.85, 0.3, surface(0.5, 0.3, 0.01)),
        rounded(0.2, 0.09, surface(0.5, 0.3, 0.003)),
        rounded(0.5, 0.2, surface(0.5, 0.0, 0.0)).with_drag(drag),
        scene(0.25, surface(0.8, 0.0, 0.0)).with_drag(drag),
        scene(2.0, threshold.expect("a valid surface")),
        scene(
            1.0,
            surface(0.5, 0.3, 0.0)
                .with_landing(Landing::Adhesive)
                .expect("a level surface"),
        ),
        scene(0.85, surface(0.3, 5.0, 0.01)),
        scene(3.0, surface(0.0, 2.0, 0.003)),
        scene(0.85, surface(0.5, 0.3, 0.01)).with_gyroscopic_torque(false),
        scene(0.5, surface(1.0, 0.0, 0.0)),
        // friction that holds at rest
        scene(0.01, surface(0.5, 0.3, 0.003)),
        scene(0.05, surface(0.5, 0.3, 0.01)).with_drag(drag),
    ];
    for scene in &scenes {
        for preset in [Preset::Clean, Preset::Table1] {
            let launches = launches(scene, preset, 60);
            agree(scene, &Settings::default(), Moreau, &launches);
        }
    }
}

#[test]
fn limits_end_the_same_tosses() {
    let scene = scene(0.85, surface(0.5, 0.3, 0.003));
    let launches = launches(&scene, Preset::Clean, 100);
    let limited = |change: fn(&mut Settings)| {
        let mut settings = Settings::default();
        change(&mut settings);
        agree(&scene, &settings, Moreau, &launches);
    };
    limited(|settings| settings.max_impacts = 5);
    limited(|settings| settings.max_steps = 7);
    limited(|settings| settings.time_limit = 12.0);
    limited(|settings| settings.decision = Decision::Energy);
    // one of these bounces a million times
    limited(|settings| {
        settings.zeno = 1e-8;
        settings.max_impacts = 5000;
    });
    limited(|settings| settings.tolerance = 1e-9);
}

/// Limits reached early, so that this is quick: a toss in lanes ends where the same toss alone does.
#[test]
fn early_limits_end_the_same_tosses() {
    let scene = scene(0.85, surface(0.5, 0.3, 0.003));
    let launches = launches(&scene, Preset::Clean, 24);
    for (max_impacts, time_limit) in [(3, f64::INFINITY), (u32::MAX, 6.0)] {
        let settings = Settings {
            max_impacts,
            time_limit: f64::min(time_limit, Settings::default().time_limit),
            ..Settings::default()
        };
        agree(&scene, &settings, Moreau, &launches);
    }
}

/// Coins on rough ground, whose rims it takes on where they are steep.
#[test]
fn rough_ground_ends_the_same_tosses() {
    let ground = Roughness::new(0.05, 3e-3).expect("a usual ground");
    let scene = scene(0.85, surface(0.5, 0.3, 0.003).with_roughness(Some(ground)));
    let launches = launches(&scene, Preset::Clean, 10);
    agree(&scene, &Settings::default(), Moreau, &launches);
}

/// Lanes are full: no flight is followed before as many fly as there are lanes for.
#[test]
fn all_lanes_fly_before_any_flight_is_followed() {
    let scene = scene(0.85, surface(0.5, 0.3, 0.01));
    let engine =
        VolumetricEngine::new(&scene, &Settings::default(), Moreau).expect("valid settings");
    for lanes in Lanes::wide() {
        let mut batch = Batch::new(&engine.model, lanes);
        for launch in launches(&scene, Preset::Clean, SLOTS as u64) {
            batch.launch(&launch);
        }
        let all = batch.pool.flights.vacant();
        for _ in 0..all / WIDTH {
            assert!(batch.pool.flights.vacant() > 0 && batch.advance());
        }
        assert_eq!(batch.pool.flights.vacant(), 0, "{lanes}");
        assert_eq!(batch.pool.departing.len(), SLOTS - all);
    }
}

#[test]
fn invalid_and_extreme_launches() {
    let scene = scene(0.85, surface(0.5, 0.3, 0.01));
    let mut launches = launches(&scene, Preset::Clean, 30);
    launches[3].velocity_m_s.x = f64::NAN;
    launches[4].height_m = f64::INFINITY;
    launches[11].spin_rad_s *= 1e200;
    launches[17].velocity_m_s *= 1e6;
    launches[18].spin_rad_s *= 1e6;
    launches[19].height_m = -1.0;
    let engine =
        VolumetricEngine::new(&scene, &Settings::default(), Moreau).expect("valid settings");
    assert_eq!(ends(&engine, &launches)[3].outcome.ended, Ended::Failed);
    // the one that spins fastest bounces up to the limit
    let settings = Settings {
        max_impacts: 5000,
        ..Settings::default()
    };
    agree(&scene, &settings, Moreau, &launches);
}

#[test]
fn outcomes_do_not_depend_on_how_launches_are_split() {
    let scene = scene(0.85, surface(0.5, 0.3, 0.003));
    let launches = launches(&scene, Preset::Clean, 700);
    let engine =
        VolumetricEngine::new(&scene, &Settings::default(), Moreau).expect("valid settings");
    let whole = ends(&engine, &launches);
    for cut in [0, 1, 7, 8, 9, 63, 128, 300, 699] {
        let (head, tail) = launches.split_at(cut);
        let parts = [ends(&engine, head), ends(&engine, tail)].concat();
        assert!(parts.iter().zip(&whole).all(|(a, b)| same(a, b)), "{cut}");
    }
}

#[test]
fn a_caller_can_stop_at_any_toss() {
    let scene = scene(0.85, surface(0.5, 0.3, 0.01));
    let launches = launches(&scene, Preset::Clean, 1000);
    let engine =
        VolumetricEngine::new(&scene, &Settings::default(), Moreau).expect("valid settings");
    for lanes in Lanes::ALL.into_iter().filter(|lanes| lanes.is_available()) {
        let engine = engine.clone().with_lanes(lanes).expect("they are there");
        let reported = count_until(&engine, &mut (), launches.iter().copied(), 300);
        assert_eq!(reported, 300, "{lanes}");
    }
}

#[test]
fn launches_that_end_at_once_are_reported_while_others_fly() {
    let scene = scene(0.85, surface(0.5, 0.3, 0.01));
    let flying = launches(&scene, Preset::Clean, 300);
    let resting = Launch {
        height_m: 0.0,
        velocity_m_s: [0.0; 3].into(),
        spin_rad_s: [0.0; 3].into(),
        ..flying[0]
    };
    let mixed = flying.iter().flat_map(|&fly| [resting, fly, resting]);
    let mixed: Vec<Launch> = mixed.collect();
    agree(&scene, &Settings::default(), Moreau, &mixed);
    let engine =
        VolumetricEngine::new(&scene, &Settings::default(), Moreau).expect("valid settings");
    for lanes in Lanes::ALL.into_iter().filter(|lanes| lanes.is_available()) {
        let engine = engine.clone().with_lanes(lanes).expect("they are there");
        // an endless number of them: none may wait until the others have ended
        let endless = flying.iter().copied().chain(std::iter::repeat(resting));
        let reported = count_until(&engine, &mut (), endless, 100_000);
        assert_eq!(reported, 100_000, "{lanes}");
    }
}
