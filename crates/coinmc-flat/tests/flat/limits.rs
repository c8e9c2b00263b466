//! Limits with a known answer.

use crate::common::{Section, Start, engine, engine_with, record};
use coinmc_core::{Ended, Engine, EventKind, Face, Launch, Preset, UniformSource, run_tosses};
use coinmc_flat::{ENGINE, Settings};
use coinmc_testkit::{Dice, adhesive, preset_launch, scene, stream};
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::{PI, TAU};

/// Without spin and with uniform tilt the coin keeps its tilt: P(side) = (2/π) atan(x/2). Four
/// standard errors: false alarms 6e-5 per ratio.
#[test]
fn adhesive_without_spin_is_the_arc_rule() {
    let tosses = 100_000_u32;
    for ratio in [0.1, 1.0, 1.1547, 3.0] {
        let scene = adhesive(scene(ratio, 0.5, 0.3));
        let engine = engine(&scene);
        let mut sides = 0;
        for toss in 0..tosses {
            let mut uniforms = stream(80).toss(u64::from(toss));
            let start = Start {
                z: 2.0 + uniforms.uniform(1),
                vx: uniforms.uniform(2),
                vz: 0.0,
                theta: TAU * uniforms.uniform(0),
                omega: 0.0,
            };
            let outcome = engine.toss(&mut (), &start.launch(&scene), &mut ());
            let face = Section::new(&scene).face(start.theta);
            assert_eq!(outcome.face(), Some(face), "{ratio} {toss}");
            assert_eq!(outcome.impacts, 0);
            sides += u32::from(face == Face::Side);
        }
        let expected = 2.0 / PI * libm::atan(ratio / 2.0);
        let p = f64::from(sides) / f64::from(tosses);
        let error = (expected * (1.0 - expected) / f64::from(tosses)).sqrt();
        assert!(
            (p - expected).abs() < 4.0 * error,
            "{ratio}: {p} {expected}"
        );
    }
}

/// With spin the face is that of the well in which the coin is at first contact. The contact is
/// located independently in steps of 1/2000 with bisection. The steps may miss a launch that grazes
/// the surface by less than the dip within a step, (ω/2000)²/8 < 1e-5: at most 1 in 1000.
#[test]
fn adhesive_with_spin_is_the_well_at_first_contact() {
    for ratio in [0.1, 1.0, 3.0] {
        let scene = adhesive(scene(ratio, 0.5, 0.3));
        let (engine, section) = (engine(&scene), Section::new(&scene));
        let mut wrong = 0;
        for toss in 0..5_000 {
            let start = Start::lively(&mut Dice::new(81, toss));
            let gap = |t: f64| {
                start.z + start.vz * t - 0.5 * t * t - section.reach(start.theta + start.omega * t)
            };
            let mut t = 0.0;
            while gap(t + 5e-4) > 0.0 {
                t += 5e-4;
            }
            let (mut low, mut high) = (t, t + 5e-4);
            for _ in 0..60 {
                let middle = f64::midpoint(low, high);
                if gap(middle) > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let face = section.face(start.theta + start.omega * low);
            let outcome = engine.toss(&mut (), &start.launch(&scene), &mut ());
            wrong += u32::from(outcome.face() != Some(face));
        }
        assert!(wrong <= 5, "{ratio}: {wrong}");
    }
}

/// A sheet hardly ever stands on its side, nor a rod on an end. By the arc rule, which bounces can
/// only lower, the expected count of the rare faces is 0.64 in 20,000 at 1e-4 and 1e4: six or more
/// occur once in 20,000 runs.
#[test]
fn sheets_and_rods_avoid_the_rare_faces() {
    for (ratio, restitution) in [(1e-4, 0.0), (1e-4, 0.5), (1e4, 0.0), (1e4, 0.5)] {
        let scene = scene(ratio, restitution, 0.3);
        let launches = Preset::CleanFlat.distribution();
        let tally = run_tosses(
            &engine(&scene),
            &mut (),
            &scene,
            &launches,
            &stream(82),
            0..20_000,
        );
        assert_eq!(tally.undecided(), 0);
        let rare = if ratio < 1.0 {
            tally.side
        } else {
            tally.heads + tally.tails
        };
        assert!(rare <= 5, "{ratio} {restitution}: {rare}");
        if ratio < 1.0 {
            // heads and tails are equally likely: 4 standard errors
            let difference = tally.heads.abs_diff(tally.tails) as f64;
            assert!(difference < 4.0 * 20_000_f64.sqrt(), "{difference}");
        }
    }
}

/// With losses every toss ends on a face: none of these 62,500 is undecided (the goal is fewer than
/// 1 in 10⁶).
#[test]
fn tosses_that_lose_energy_are_decided() {
    let launches = Preset::CleanFlat.distribution();
    for restitution in [0.0, 0.3, 0.5, 0.8, 0.95] {
        for friction in [0.0, 0.1, 0.3, 1.0, 10.0] {
            for ratio in [0.01, 0.1, 1.0, 10.0, 100.0] {
                let scene = scene(ratio, restitution, friction);
                let engine = engine(&scene);
                let tally = run_tosses(&engine, &mut (), &scene, &launches, &stream(85), 0..500);
                assert_eq!(
                    tally.undecided(),
                    0,
                    "{restitution} {friction} {ratio}: {tally:?}"
                );
            }
        }
    }
}

/// Nothing takes energy at e = 1 without friction: the toss has no face and is counted as
/// undecided. Each impact rounds the energy by about 1e-16, 1000 impacts by less than 1e-12, far
/// below 1e-10.
#[test]
fn without_loss_nothing_is_decided() {
    for ratio in [0.1, 1.0, 5.0] {
        let scene = scene(ratio, 1.0, 0.0);
        let k = Section::new(&scene).k;
        let settings = Settings {
            max_impacts: 1000,
            ..Settings::default()
        };
        let engine = engine_with(&scene, settings);
        for toss in 0..100 {
            let launch = preset_launch(Preset::CleanFlat, &scene, 83, toss);
            let (outcome, moments) = record(&engine, &scene, &launch);
            assert_eq!(outcome.ended, Ended::ImpactLimit);
            assert_eq!(outcome.impacts, 1000);
            let before = moments[0].energy(k);
            for moment in &moments {
                assert!((moment.energy(k) / before - 1.0).abs() < 1e-10);
            }
            let impacts = moments.iter().filter(|m| m.kind == EventKind::Impact);
            assert_eq!(impacts.count(), 1000);
        }
    }
}

/// Keller 1986: a coin without thickness that starts from the table at u, heads up, and does not
/// bounce shows heads if cos(ωt) > 0 at t = 2u/g. The rim meets the table early by up to R|sin|/u,
/// an angle of ωR/u: launches nearer than 1.5 times that to the edge of a band are excluded.
#[test]
fn a_thin_coin_lands_in_kellers_bands() {
    let scene = adhesive(scene(1e-7, 0.5, 0.3));
    let engine = engine(&scene);
    let mut checked = 0;
    for toss in 0..20_000 {
        let mut dice = Dice::new(84, toss);
        let (u, omega) = (dice.between(5.0, 30.0), dice.between(-200.0, 200.0));
        let angle = omega * 2.0 * u / scene.gravity_m_s2();
        let clear = 1.5 * (omega * scene.coin.radius_m() / u).abs();
        let cos = libm::cos(angle);
        if cos.abs() <= libm::sin(clear.min(1.5)) {
            continue;
        }
        checked += 1;
        let launch = Launch {
            height_m: scene.coin.height_m(),
            velocity_m_s: Vector3::new(0.0, 0.0, u),
            axis: UnitVector3::new_unchecked(Vector3::z()),
            spin_rad_s: Vector3::new(0.0, omega, 0.0),
        };
        let face = if cos > 0.0 { Face::Heads } else { Face::Tails };
        let outcome = engine.toss(&mut (), &launch, &mut ());
        assert_eq!(outcome.face(), Some(face), "u {u}, ω {omega}");
    }
    assert!(checked > 15_000, "{checked}");
}

/// Where no impact loses energy the engine remarks on it, and nowhere else.
#[test]
fn bounces_without_loss_are_remarked_on() {
    let remark = &ENGINE.remarks[0];
    assert!(remark.text.contains("loses no energy"));
    assert!((remark.applies)(&scene(1.0, 1.0, 0.3)));
    assert!(!(remark.applies)(&scene(1.0, 0.99, 0.3)));
    assert!(!(remark.applies)(&adhesive(scene(1.0, 1.0, 0.3))));
}
