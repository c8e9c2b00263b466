//! Tosses side by side end to the bit as they do one after the other.

use crate::common::{Dice, Start, preset, scene};
use coinmc_core::{Ended, Engine, Face, Landing, Launch, Outcome, Preset, Scene};
use coinmc_flat::{
    AnyFlatEngine, Decision, GaekSukhov, HalfSine, Lanes, Law, Lever, LineContact, Materials,
    PulseTime, Settings,
};
use std::ops::ControlFlow;

fn launches(scene: &Scene, named: Preset, count: u64) -> Vec<Launch> {
    (0..count)
        .map(|toss| preset(named, scene, 700, toss))
        .collect()
}

/// Low starts with sideways velocity: many begin below the height from which they can touch, and
/// they slide and rock.
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

fn engine(scene: &Scene, settings: &Settings) -> AnyFlatEngine {
    AnyFlatEngine::new(scene, settings).expect("good settings")
}

/// Every toss by its number.
fn together(engine: &AnyFlatEngine, launches: &[Launch]) -> Vec<Outcome> {
    let mut outcomes = vec![None; launches.len()];
    engine.toss_all(&mut (), launches.iter().copied(), |number, outcome| {
        let index = usize::try_from(number).expect("a small number");
        assert!(
            outcomes[index].replace(*outcome).is_none(),
            "toss {number} twice"
        );
        ControlFlow::Continue(())
    });
    let outcomes: Option<Vec<Outcome>> = outcomes.into_iter().collect();
    outcomes.expect("every toss ends")
}

/// How many tosses are told of to one who breaks off after `enough`.
fn told(engine: &AnyFlatEngine, launches: impl Iterator<Item = Launch>, enough: u64) -> u64 {
    let mut told = 0;
    engine.toss_all(&mut (), launches, |_, _| {
        told += 1;
        if told == enough {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    told
}

/// Compares every kind of lanes with the single toss.
fn agree(scene: &Scene, settings: &Settings, launches: &[Launch]) -> Vec<Outcome> {
    let engine = engine(scene, settings);
    let single = |launch| engine.toss(&mut (), launch, &mut ());
    let alone: Vec<Outcome> = launches.iter().map(single).collect();
    for lanes in Lanes::ALL {
        let Ok(engine) = engine.clone().with_lanes(lanes) else {
            println!("SKIPPED: this processor has no {lanes}");
            continue;
        };
        let outcomes = together(&engine, launches);
        for (i, (outcome, alone)) in outcomes.iter().zip(&alone).enumerate() {
            assert_eq!(
                outcome, alone,
                "{lanes} toss {i} of {scene:?}: {:?}",
                launches[i]
            );
        }
    }
    alone
}

/// Without losses a toss never ends by itself.
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
                    let mut outcomes = agree(&scene, &settings, &lively(&scene, 50));
                    for preset in [Preset::CleanFlat, Preset::Robot] {
                        outcomes.extend(agree(&scene, &settings, &launches(&scene, preset, 25)));
                    }
                    let side = Ended::Decided(Face::Side);
                    sides += outcomes.iter().filter(|o| o.ended == side).count();
                    steps += outcomes.iter().map(|o| o.contact_steps).sum::<u32>();
                }
            }
        }
    }
    // all kinds of histories are among them
    assert!(sides > 1000 && steps > 10_000, "{sides} {steps}");
}

#[test]
fn laws_that_are_more_than_an_impulse() {
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
        agree(&scene, &bounded(law), &launches(&scene, Preset::Robot, 60));
    }
}

#[test]
fn adhesive_landings() {
    for ratio in [0.1, 1.2, 10.0] {
        let mut scene = scene(ratio, 0.0, 0.0);
        scene.surface = scene.surface.with_landing(Landing::Adhesive);
        for preset in [Preset::CleanFlat, Preset::Robot] {
            let launches = launches(&scene, preset, 2000);
            let outcomes = agree(&scene, &Settings::default(), &launches);
            assert!(outcomes.iter().all(|outcome| outcome.face().is_some()));
        }
        agree(&scene, &Settings::default(), &lively(&scene, 1000));
    }
}

#[test]
fn few_impacts_and_a_share_of_the_energy() {
    let scene = scene(1.2, 0.8, 0.3);
    let launches = launches(&scene, Preset::CleanFlat, 300);
    for max_impacts in [1, 2, 5] {
        let settings = Settings {
            max_impacts,
            ..Settings::default()
        };
        let outcomes = agree(&scene, &settings, &launches);
        let given_up = |outcome: &&Outcome| outcome.ended == Ended::ImpactLimit;
        assert!(outcomes.iter().filter(given_up).count() > 100);
    }
    let settings = Settings {
        decision: Decision::EnergyFraction(0.05),
        ..Settings::default()
    };
    agree(&scene, &settings, &launches);
}

#[test]
fn launches_that_no_one_would_make() {
    let scene = scene(1.2, 0.5, 0.3);
    let odd = [
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
    for a in odd {
        for b in odd {
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
    agree(&scene, &bounded(Law::Moreau), &launches);
}

#[test]
fn breaking_off_and_fewer_tosses_than_lanes() {
    let scene = scene(1.2, 0.5, 0.3);
    let launches = launches(&scene, Preset::Robot, 1000);
    for count in [0, 1, 3, 70] {
        agree(&scene, &Settings::default(), &launches[..count]);
    }
    for lanes in Lanes::ALL {
        let Ok(engine) = engine(&scene, &Settings::default()).with_lanes(lanes) else {
            continue;
        };
        assert_eq!(told(&engine, launches.iter().copied(), 300), 300, "{lanes}");
    }
}

#[test]
fn launches_that_end_at_once_are_told_while_others_go_on() {
    let scene = scene(1.2, 0.5, 0.3);
    let mut resting = preset(Preset::Robot, &scene, 700, 0);
    resting.height_m = 0.0;
    (resting.velocity_m_s, resting.spin_rad_s) = Default::default();
    let flying = launches(&scene, Preset::Robot, 300);
    let mixed: Vec<Launch> = flying
        .iter()
        .flat_map(|&fly| [resting, fly, resting])
        .collect();
    let outcomes = agree(&scene, &Settings::default(), &mixed);
    assert!(outcomes[0].impacts == 0 && outcomes[0].face().is_some());
    for lanes in Lanes::ALL {
        let Ok(engine) = engine(&scene, &Settings::default()).with_lanes(lanes) else {
            continue;
        };
        // of an never_settles number of them, none may be kept until the others have ended
        let never_settles = flying.iter().copied().chain(std::iter::repeat(resting));
        assert_eq!(told(&engine, never_settles, 100_000), 100_000, "{lanes}");
    }
}
