//! Batches of tosses are bit-identical to the scalar path.

use crate::common::{Section, Start};
use coinmc_core::{DynEngine, Ended, Engine, Face, Landing, Launch, Outcome, Preset, Scene};
use coinmc_flat::{
    Decision, GaekSukhov, HalfSine, Lanes, Law, Lever, LineContact, Materials, PulseTime, Settings,
};
use coinmc_testkit::{Dice, conformance, count_until, preset_launch, scalar_outcomes, scene};

fn launches(scene: &Scene, named: Preset, count: u64) -> Vec<Launch> {
    (0..count)
        .map(|toss| preset_launch(named, scene, 700, toss))
        .collect()
}

/// Low launches with horizontal velocity: many start below the height at which contact is possible,
/// and they slide and rock.
fn lively(scene: &Scene, count: u64) -> Vec<Launch> {
    let start = |toss| {
        let dice = &mut Dice::new(701, toss);
        let start = Start {
            z: dice.between(0.2, 2.5),
            vx: dice.between(-3.0, 3.0),
            ..Start::lively(dice)
        };
        start.launch(scene)
    };
    (0..count).map(start).collect()
}

fn engine(scene: &Scene, settings: &Settings) -> DynEngine {
    settings.engine(scene).expect("good settings")
}

/// Compares every kind of lanes with the scalar path; returns the outcomes.
fn assert_lanes_agree(scene: &Scene, settings: &Settings, launches: &[Launch]) -> Vec<Outcome> {
    let engine = engine(scene, settings);
    let scalar = scalar_outcomes(&engine, launches);
    for lanes in Lanes::ALL {
        let Ok(engine) = engine.clone().with_lanes(lanes) else {
            println!("SKIPPED: this processor does not support {lanes} lanes");
            continue;
        };
        let outcomes = conformance::batch_matches_scalar(&engine, launches);
        assert_eq!(outcomes, scalar, "{lanes} of {scene:?}");
    }
    scalar
}

/// Without losses a toss never ends by itself, so the impacts are limited.
fn bounded(law: Law) -> Settings {
    Settings {
        law,
        max_impacts: 400,
        ..Settings::default()
    }
}

#[test]
fn every_shape_and_surface() {
    let (mut sides, mut steps) = (0, 0);
    for ratio in [0.01, 0.1, 0.85, 1.2, 10.0, 100.0] {
        for e in [0.0, 0.3, 0.5, 0.8, 1.0] {
            for mu in [0.0, 0.1, 0.3, 2.0] {
                let scene = scene(ratio, e, mu);
                for law in Law::RIGID {
                    let settings = bounded(law);
                    let mut outcomes = assert_lanes_agree(&scene, &settings, &lively(&scene, 50));
                    for preset in [Preset::CleanFlat, Preset::Robot] {
                        outcomes.extend(assert_lanes_agree(
                            &scene,
                            &settings,
                            &launches(&scene, preset, 25),
                        ));
                    }
                    let side = Ended::Decided(Face::Side);
                    sides += outcomes.iter().filter(|o| o.ended == side).count();
                    steps += outcomes.iter().map(|o| o.contact_steps).sum::<u32>();
                }
            }
        }
    }
    // all kinds of motion are among them
    assert!(sides > 1000 && steps > 10_000, "{sides} {steps}");
}

/// A corner that touches down very slowly while the turning of the coin holds it up, ω² cos δ = 1, neither rises
/// nor falls after its impact: the search for the next one must not pass by it.
#[test]
fn corners_that_neither_rise_nor_fall() {
    let settings = Settings {
        zeno: 1e-15,
        max_impacts: 400,
        ..Settings::default()
    };
    for ratio in [0.5, 1.2] {
        for e in [0.5, 1.0] {
            let scene = scene(ratio, e, 0.0);
            let section = Section::new(&scene);
            let start = |toss| {
                let dice = &mut Dice::new(702, toss);
                let theta = dice.between(0.0, std::f64::consts::TAU);
                let (x, z) = section.lowest(theta);
                let surplus = dice.pick(&[0.0, 1e-15, 1e-12, 1e-9]);
                let omega = dice.pick(&[-1.0, 1.0]) * ((1.0 + surplus) / -z).sqrt();
                let start = Start {
                    z: -z,
                    vx: 0.0,
                    vz: omega * x - dice.scale(1e-14, 1e-9),
                    theta,
                    omega,
                };
                start.launch(&scene)
            };
            let launches: Vec<Launch> = (0..500).map(start).collect();
            let outcomes = assert_lanes_agree(&scene, &settings, &launches);
            assert!(outcomes.iter().filter(|one| one.impacts > 1).count() > 100);
        }
    }
}

#[test]
fn laws_with_a_duration() {
    let materials = Materials {
        coin_young_pa: 1e8,
        coin_poisson: 0.3,
        surface_young_pa: 1e8,
        surface_poisson: 0.3,
        length_m: 0.02,
    };
    let laws = [
        Law::GaekSukhov(GaekSukhov {
            eta_n_s: 1e-3,
            lever: Lever::Height,
        }),
        Law::HalfSine(HalfSine {
            time: PulseTime::Given(1e-4),
            peak_n: None,
        }),
        Law::LineContact(LineContact {
            materials,
            tangential: LineContact::mindlin(0.3),
        }),
    ];
    let scene = scene(1.2, 0.5, 0.0);
    for law in laws {
        assert_lanes_agree(&scene, &bounded(law), &launches(&scene, Preset::Robot, 60));
    }
}

#[test]
fn adhesive_landings() {
    for ratio in [0.1, 1.2, 10.0] {
        let mut scene = scene(ratio, 0.0, 0.0);
        scene.surface = scene
            .surface
            .with_landing(Landing::Adhesive)
            .expect("a level surface");
        for preset in [Preset::CleanFlat, Preset::Robot] {
            let launches = launches(&scene, preset, 2000);
            let outcomes = assert_lanes_agree(&scene, &Settings::default(), &launches);
            assert!(outcomes.iter().all(|outcome| outcome.face().is_some()));
        }
        assert_lanes_agree(&scene, &Settings::default(), &lively(&scene, 1000));
    }
}

#[test]
fn impact_limits_and_energy_fractions() {
    let scene = scene(1.2, 0.8, 0.3);
    let launches = launches(&scene, Preset::CleanFlat, 300);
    for max_impacts in [1, 2, 5] {
        let settings = Settings {
            max_impacts,
            ..Settings::default()
        };
        let outcomes = assert_lanes_agree(&scene, &settings, &launches);
        let given_up = |outcome: &&Outcome| outcome.ended == Ended::ImpactLimit;
        assert!(outcomes.iter().filter(given_up).count() > 100);
    }
    let settings = Settings {
        decision: Decision::EnergyFraction(0.05),
        ..Settings::default()
    };
    assert_lanes_agree(&scene, &settings, &launches);
}

#[test]
fn extreme_launches() {
    let scene = scene(1.2, 0.5, 0.3);
    let extreme = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        1e-300,
        1e9,
        1e80,
        1e200,
        f64::INFINITY,
        f64::NAN,
    ];
    let mut launches = Vec::new();
    for a in extreme {
        for b in extreme {
            let start = Start {
                z: 1.5,
                vx: 0.5,
                vz: -0.2,
                theta: 0.4,
                omega: 2.0,
            };
            let starts = [
                Start {
                    z: a,
                    vz: b,
                    ..start
                },
                Start {
                    vx: a,
                    omega: b,
                    ..start
                },
                Start {
                    theta: a,
                    omega: b,
                    ..start
                },
                Start {
                    vz: a,
                    omega: b,
                    ..start
                },
            ];
            launches.extend(starts.map(|start| start.launch(&scene)));
        }
    }
    assert_lanes_agree(&scene, &bounded(Law::Moreau), &launches);
}

#[test]
fn early_stops_and_fewer_tosses_than_lanes() {
    let scene = scene(1.2, 0.5, 0.3);
    let launches = launches(&scene, Preset::Robot, 1000);
    for count in [0, 1, 3, 70] {
        assert_lanes_agree(&scene, &Settings::default(), &launches[..count]);
    }
    for lanes in Lanes::ALL {
        let Ok(engine) = engine(&scene, &Settings::default()).with_lanes(lanes) else {
            continue;
        };
        conformance::a_stopped_batch_leaves_nothing_behind(&engine, &launches, 300);
    }
}

#[test]
fn launches_that_end_at_once_are_reported_while_others_fly() {
    let scene = scene(1.2, 0.5, 0.3);
    let mut resting = preset_launch(Preset::Robot, &scene, 700, 0);
    resting.height_m = 0.0;
    (resting.velocity_m_s, resting.spin_rad_s) = Default::default();
    let flying = launches(&scene, Preset::Robot, 300);
    let mixed: Vec<Launch> = flying
        .iter()
        .flat_map(|&fly| [resting, fly, resting])
        .collect();
    let outcomes = assert_lanes_agree(&scene, &Settings::default(), &mixed);
    assert!(outcomes[0].impacts == 0 && outcomes[0].face().is_some());
    for lanes in Lanes::ALL {
        let Ok(engine) = engine(&scene, &Settings::default()).with_lanes(lanes) else {
            continue;
        };
        // without end: none may be held back until the others have ended
        let endless = flying.iter().copied().chain(std::iter::repeat(resting));
        let reported = count_until(&engine, &mut engine.workspace(), endless, 100_000);
        assert_eq!(reported, 100_000, "{lanes}");
    }
}
