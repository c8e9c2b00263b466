//! Impacts and phases of contact as an observer sees them.

use crate::common::{Moment, Start, Tosser};
use coinmc_core::{Coin, EventKind, Scene, Surface};
use coinmc_oracle::{Model, Motion};
use coinmc_testkit::{Dice, rolling_scene};
use coinmc_volumetric::Law;
use nalgebra::Vector3;

/// Velocity of the lowest rim point, by vectors in the laboratory frame.
fn lowest_velocity(model: &Model, motion: &Motion) -> Vector3<f64> {
    let u = &motion.axis;
    let across = (u * u.z - Vector3::z()) / motion.sine();
    let centre_line = across * model.radius - u * model.half.copysign(u.z);
    let arm = centre_line - Vector3::z() * model.rim;
    motion.velocity + motion.spin.cross(&arm)
}

fn impacts(moments: &[Moment]) -> impl Iterator<Item = (&Moment, &Moment, &Moment)> {
    moments.windows(3).filter_map(|three| {
        let [before, after, next] = three else {
            return None;
        };
        (before.kind == EventKind::Touching).then_some((before, after, next))
    })
}

/// The normal velocity is reversed by e (also under Stronge's law if there is no friction); or it
/// becomes 0, and sustained contact follows instead of flight to another contact. Rounding: 1e-12
/// of the velocities, and more where the lowest point of a flat coin is ill-defined (left out below
/// a sine of 1e-4).
#[test]
fn impacts_reverse_the_approach_by_e() {
    let (mut bounced, mut stopped) = (0, 0);
    for law in Law::ALL {
        for (ratio, e, mu, rho) in [
            (0.85, 0.5, 0.3, 0.01),
            (0.1, 0.8, 1.0, 0.0),
            (3.0, 0.3, 0.0, 0.001),
            (1.2, 0.95, 0.1, 0.0),
            (0.5, 0.0, 0.3, 0.01),
        ] {
            let mu = if law == Law::Stronge { 0.0 } else { mu };
            let scene = rolling_scene(ratio, e, mu, rho);
            let model = Model::new(&scene);
            let engine = Tosser::of(&scene, law);
            for trial in 0..400 {
                let start = Start::lively(&mut Dice::new(210, trial));
                let (_, moments) = engine.record(&scene, &start.launch(&scene));
                for (before, after, next) in impacts(&moments) {
                    assert_eq!(after.kind, EventKind::Impact);
                    if before.motion.sine() < 1e-4 {
                        continue;
                    }
                    let size = 1.0 + before.motion.velocity.norm() + before.motion.spin.norm();
                    let approach = lowest_velocity(&model, &before.motion).z;
                    let back = lowest_velocity(&model, &after.motion).z;
                    assert!(approach <= 1e-12 * size, "{approach:e} {before:?}");
                    let flies = next.kind == EventKind::Touching && next.time > after.time;
                    if (back + e * approach).abs() <= 1e-12 * size {
                        bounced += 1;
                    } else {
                        stopped += 1;
                        assert!(
                            back.abs() <= 1e-12 * size,
                            "{law:?} {approach} {back} {before:?}"
                        );
                        assert!(!flies, "{law:?} {before:?} {after:?} {next:?}");
                    }
                }
            }
        }
    }
    println!("{bounced} bounced, {stopped} stopped");
    assert!(bounced > 10_000 && stopped > 500, "{bounced} {stopped}");
}

/// The contact point of a rounded rim is below its centre line: there e and friction act.
#[test]
fn rounded_rims_bounce_by_e_at_their_lowest_point() {
    let mut bounced = 0;
    for law in Law::ALL {
        for (ratio, rim) in [(0.85, 0.3), (0.2, 0.09), (2.0, 0.9)] {
            let mu = if law == Law::Stronge { 0.0 } else { 0.3 };
            let mut scene = rolling_scene(ratio, 0.5, mu, 0.01);
            let radius = scene.coin.radius_m();
            scene.coin = scene.coin.with_rim_radius(rim * radius).unwrap();
            let (model, engine) = (Model::new(&scene), Tosser::of(&scene, law));
            for trial in 0..200 {
                let start = Start::lively(&mut Dice::new(214, trial));
                let (_, moments) = engine.record(&scene, &start.launch(&scene));
                for (before, after, _) in impacts(&moments) {
                    let approach = lowest_velocity(&model, &before.motion).z;
                    let back = lowest_velocity(&model, &after.motion).z;
                    if before.motion.sine() < 1e-4 || back <= 1e-9 {
                        continue;
                    }
                    bounced += 1;
                    assert!((back + 0.5 * approach).abs() <= 1e-11, "{approach} {back}");
                    let gained = after.motion.energy(&model) / before.motion.energy(&model) - 1.0;
                    assert!(gained <= 1e-12, "{gained:e}");
                }
            }
        }
    }
    assert!(bounced > 3000, "{bounced}");
}

/// Below the threshold an impact does not bounce; above it an impact is the same as without a
/// threshold.
#[test]
fn slow_impacts_below_the_threshold_do_not_bounce() {
    let base = rolling_scene(0.85, 0.6, 0.3, 0.01);
    let speed = base.coin.rim_distance_m() / base.time_scale_s();
    let mut scene = base;
    let threshold = 0.8;
    scene.surface = scene
        .surface
        .with_restitution_threshold(threshold * speed)
        .unwrap();
    let (model, engine) = (Model::new(&scene), Tosser::new(&scene));
    let (mut slow, mut fast) = (0, 0);
    for trial in 0..1000 {
        let start = Start::lively(&mut Dice::new(211, trial));
        let (_, moments) = engine.record(&scene, &start.launch(&scene));
        for (before, after, _) in impacts(&moments) {
            if before.motion.sine() < 1e-4 {
                continue;
            }
            let approach = -lowest_velocity(&model, &before.motion).z;
            let back = lowest_velocity(&model, &after.motion).z;
            if approach < threshold {
                slow += 1;
                assert!(back.abs() <= 1e-11, "{approach} {back}");
            } else {
                fast += 1;
                assert!((back - 0.6 * approach).abs() <= 1e-11, "{approach} {back}");
            }
        }
    }
    assert!(slow > 1000 && fast > 1000, "{slow} {fast}");
}

/// Restitution that falls with the speed: every impact that bounces has that of its own speed, above
/// the reference speed and below it.
#[test]
fn fast_impacts_bounce_less_by_the_stated_power() {
    let mut scene = rolling_scene(0.85, 0.6, 0.3, 0.01);
    let speed = scene.coin.rim_distance_m() / scene.time_scale_s();
    let (exponent, reference) = (0.25, 0.8);
    scene.surface = scene
        .surface
        .with_speed_dependent_restitution(exponent, reference * speed)
        .unwrap();
    let (model, engine) = (Model::new(&scene), Tosser::new(&scene));
    let (mut slow, mut fast) = (0, 0);
    for trial in 0..1000 {
        let start = Start::lively(&mut Dice::new(213, trial));
        let (_, moments) = engine.record(&scene, &start.launch(&scene));
        for (before, after, _) in impacts(&moments) {
            let approach = -lowest_velocity(&model, &before.motion).z;
            let back = lowest_velocity(&model, &after.motion).z;
            let bounces = back > 1e-9 * approach;
            if before.motion.sine() < 1e-4 || !bounces {
                continue;
            }
            let e = 0.6 * libm::pow((approach / reference).max(1.0), -exponent);
            assert!((back - e * approach).abs() <= 1e-11, "{approach} {back}");
            if approach < reference {
                slow += 1;
            } else {
                fast += 1;
            }
        }
    }
    assert!(slow > 1000 && fast > 1000, "{slow} {fast}");
}

/// No impact, flight or phase of contact ends with more energy than at its start, for all ratios,
/// e, μ and friction lengths.
#[test]
fn no_event_gains_energy() {
    let mut worst = [0.0_f64; 3];
    let mut events = 0;
    for trial in 0..6000 {
        let mut dice = Dice::new(212, trial);
        let coin = Coin::cylinder(dice.scale(1e-3, 1e3), 0.01).unwrap();
        let e = dice.pick(&[0.0, 0.3, 0.8, 1.0]);
        let mu = dice.pick(&[0.0, 0.1, 0.5, 2.0, 10.0]);
        let mut length = || dice.pick(&[0.0, 1e-6, 1e-4, 1e-3]);
        let (contour, pivoting) = (length(), length());
        let surface = Surface::new(e, mu)
            .and_then(|s| s.with_friction_lengths(contour, pivoting))
            .unwrap();
        let scene = Scene::new(coin, surface, 9.81).unwrap();
        let model = Model::new(&scene);
        let mut start = Start::lively(&mut dice);
        start.spin *= dice.pick(&[0.1, 1.0, 10.0]);
        let law = Law::ALL[(trial % 3) as usize];
        let settings = coinmc_volumetric::Settings {
            law,
            max_impacts: 200,
            max_steps: 2000,
            ..Default::default()
        };
        let (_, moments) = Tosser::with(&scene, &settings).record(&scene, &start.launch(&scene));
        for pair in moments.windows(2) {
            let [from, to] = pair else { continue };
            let (before, after) = (from.motion.energy(&model), to.motion.energy(&model));
            let gain = after / before - 1.0;
            let which = match from.kind {
                EventKind::Touching => 0,
                EventKind::Sticking | EventKind::Sliding => 1,
                _ => 2,
            };
            worst[which] = worst[which].max(gain);
            events += 1;
            // in flight, the rounding of u is multiplied by I_t/I_a (rods)
            let flight = if which == 2 {
                1e-15 * model.transverse / model.axial
            } else {
                0.0
            };
            assert!(
                gain <= 1e-12 + flight,
                "trial {trial} {law:?}: {gain:e} {from:?} {to:?} {scene:?}"
            );
        }
    }
    println!("{events} events, worst gains {worst:?}");
    assert!(events > 50_000, "{events}");
}
