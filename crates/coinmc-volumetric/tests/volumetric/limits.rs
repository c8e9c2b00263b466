//! Limiting cases with a known answer.

use crate::common::{Start, Tosser, well};
use coinmc_analytic::{precession, zone};
use coinmc_core::{Ended, Face, Launch, Preset, UniformSource};
use coinmc_oracle::{Model, Motion};
use coinmc_testkit::{Dice, adhesive, preset_launch, rolling_scene, stream};
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::TAU;

/// Deviation from the expected share, in standard errors.
fn deviation(count: u32, tosses: u32, p: f64) -> f64 {
    let n = f64::from(tosses);
    (f64::from(count) - n * p) / (n * p * (1.0 - p)).sqrt()
}

/// Without spin and with uniform orientation, the coin sticks in the orientation in which it fell:
/// the zone rule. 4.9 standard errors: false alarms 1e-6 per assertion.
#[test]
fn adhesive_without_spin_is_the_zone_rule() {
    let tosses = 50_000;
    for ratio in [0.1, 0.7, 1.0, 3.0] {
        let scene = adhesive(rolling_scene(ratio, 0.5, 0.3, 0.01));
        let (engine, model) = (Tosser::new(&scene), Model::new(&scene));
        let mut counts = [0; 3];
        for toss in 0..tosses {
            let launch = preset_launch(Preset::Drop, &scene, 230, u64::from(toss));
            let outcome = engine.toss(&launch);
            let face = well(&model, &launch.axis);
            assert_eq!(outcome.face(), Some(face), "{ratio} {toss}");
            assert_eq!(outcome.impacts, 0);
            counts[Face::ALL.iter().position(|f| *f == face).unwrap()] += 1;
        }
        let expected = zone::probabilities(ratio);
        for (count, p) in counts
            .into_iter()
            .zip([expected.heads, expected.tails, expected.side])
        {
            let off = deviation(count, tosses, p);
            assert!(off.abs() < 4.9, "{ratio}: {counts:?} {expected:?}");
        }
    }
}

/// First contact, found by steps of 1/2000 (or 1/2000 rad of rotation, if that is shorter) and
/// bisection.
fn marched(model: &Model, start: &Motion) -> Motion {
    let step = 5e-4 / start.spin.norm().max(1.0);
    let at = |t: f64| {
        let mut motion = *start;
        motion.fly(model, t);
        motion
    };
    let mut t = 0.0;
    while at(t + step).gap(model) > 0.0 {
        t += step;
    }
    let (mut low, mut high) = (t, t + step);
    for _ in 0..50 {
        let middle = f64::midpoint(low, high);
        if at(middle).gap(model) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    at(low)
}

/// With spin, the face is the one towards which the coin leans at first contact. A launch whose
/// contact comes within 1e-6 of a balance proves nothing (a fraction of 1e-6). The steps may miss a
/// contact that enters the surface by less than 1e-7: at most 1 in 400.
#[test]
fn adhesive_with_spin_decides_at_first_contact() {
    let mut wrong = 0;
    for ratio in [0.1, 1.0, 3.0] {
        let scene = adhesive(rolling_scene(ratio, 0.5, 0.3, 0.01));
        let (engine, model) = (Tosser::new(&scene), Model::new(&scene));
        for toss in 0..400 {
            let launch = Start::lively(&mut Dice::new(231, toss)).launch(&scene);
            let motion = marched(&model, &Motion::launched(&scene, &launch));
            let outcome = engine.toss(&launch);
            wrong += u32::from(outcome.face() != Some(well(&model, &motion.axis)));
        }
    }
    assert!(wrong <= 3, "{wrong}");
}

/// Heads up and level, with the angular momentum at an angle ψ from the vertical, thrown down so
/// fast that the coin falls by its own size while u turns by 1e-4 rad. So the phase φ at first
/// contact is that at the surface, which is uniform, and the shares are those of the closed form.
/// 4.9 standard errors: false alarms 1e-6 per assertion. 1e-4 rad change a share by less than half
/// a standard error.
#[test]
fn a_precessing_coin_is_the_closed_form() {
    let tosses = 30_000;
    let fall = 1e4;
    for (ratio, psi) in [(0.2, 1.0), (1.0, 1.4), (1.5, 0.7), (0.7, 1.9)] {
        let scene = adhesive(rolling_scene(ratio, 0.5, 0.3, 0.01));
        let (engine, model) = (Tosser::new(&scene), Model::new(&scene));
        let (sin, cos) = libm::sincos(psi);
        let direction = Vector3::new(sin, 0.0, cos);
        let mut counts = [0; 3];
        let mut wrong = 0;
        for toss in 0..tosses {
            let phase = TAU * (1.0 + stream(232).toss(toss.into()).uniform(0));
            // L/I_t of 1: the centre reaches the surface's height after `phase`
            let spin = model.inverse_inertia(&Vector3::z()) * direction * model.transverse;
            let start = Start {
                z: fall * phase + 0.5 * phase * phase,
                velocity: Vector3::new(0.0, 0.0, -fall),
                axis: Vector3::z(),
                spin,
            };
            let face = engine.toss(&start.launch(&scene)).face().expect("a face");
            counts[Face::ALL.iter().position(|f| *f == face).unwrap()] += 1;
            let height = cos * cos + sin * sin * libm::cos(phase);
            wrong += u32::from(face != well(&model, &Vector3::new(0.0, 0.0, height)));
        }
        // a shift by 1e-4 rad crosses one of at most four boundaries: 4e-4/2π of the tosses
        assert!(wrong < 20, "{ratio} {psi}: {wrong}");
        let expected = precession::thick::probabilities(ratio, psi);
        for (count, p) in counts
            .into_iter()
            .zip([expected.heads, expected.tails, expected.side])
        {
            if p == 0.0 {
                assert_eq!(count, 0, "{ratio} {psi}: {counts:?} {expected:?}");
            } else {
                let off = deviation(count, tosses, p);
                assert!(off.abs() < 4.9, "{ratio} {psi}: {counts:?} {expected:?}");
            }
        }
    }
}

/// A sheet never ends on its side, and a rod never on an end. By the zone rule the expected number
/// of rare faces is 1000·5e-5 (sheet) and far less (rod), and bounces only lower it. Two or more
/// occur in one of a thousand runs.
#[test]
fn sheets_and_rods() {
    for (ratio, e) in [(1e-4, 0.0), (1e-4, 0.5), (1e4, 0.0), (1e4, 0.5)] {
        let scene = rolling_scene(ratio, e, 0.3, 0.01);
        let engine = Tosser::new(&scene);
        let (mut rare, mut undecided) = (0, 0);
        for toss in 0..500 {
            let launch = Start::lively(&mut Dice::new(233, toss)).launch(&scene);
            let outcome = engine.toss(&launch);
            match outcome.face() {
                None => undecided += 1,
                Some(face) => rare += u32::from((face == Face::Side) == (ratio < 1.0)),
            }
        }
        assert_eq!(undecided, 0, "{ratio} {e}");
        assert!(rare <= 1, "{ratio} {e}: {rare}");
    }
}

/// If energy is lost, every toss of an ordinary scene is decided.
#[test]
fn tosses_that_lose_energy_are_decided() {
    for e in [0.0, 0.3, 0.5, 0.8, 0.95] {
        for mu in [0.0, 0.1, 0.3, 1.0, 3.0] {
            for ratio in [0.05, 0.85, 2.0, 10.0] {
                let scene = rolling_scene(ratio, e, mu, 0.01);
                let engine = Tosser::new(&scene);
                for toss in 0..50 {
                    let outcome = engine.toss(&preset_launch(Preset::Clean, &scene, 234, toss));
                    assert!(
                        outcome.face().is_some(),
                        "{e} {mu} {ratio} {toss}: {outcome:?}"
                    );
                }
            }
        }
    }
}

/// At e = 1 without friction no energy is lost: a toss is decided at its launch, by the rule that
/// is exact without friction, or it never settles.
#[test]
fn without_loss_a_toss_is_decided_at_its_launch_or_never() {
    for ratio in [0.1, 1.0, 5.0] {
        let scene = rolling_scene(ratio, 1.0, 0.0, 0.0);
        let engine = Tosser::new(&scene);
        let mut ends = [0; 2];
        for toss in 0..2000 {
            let mut dice = Dice::new(235, toss);
            let mut start = Start::lively(&mut dice);
            start.z = dice.between(0.0, 2.0);
            start.spin *= 0.3;
            start.velocity *= 0.3;
            let outcome = engine.toss(&start.launch(&scene));
            assert_eq!((outcome.impacts, outcome.contact_steps), (0, 0));
            match outcome.ended {
                Ended::Decided(face) => {
                    assert_eq!(face, well(&Model::new(&scene), &start.axis));
                    ends[0] += 1;
                }
                ended => {
                    assert_eq!(ended, Ended::NeverSettles, "{toss}");
                    ends[1] += 1;
                }
            }
        }
        assert!(ends[0] > 50 && ends[1] > 50, "{ratio}: {ends:?}");
    }
}

/// A level coin without spin lands on the face on which it was held. A coin on its side does so if
/// its rims can be struck one after another (H/R > 1.2247: an impact at one does not lift the
/// other).
#[test]
fn level_coins_without_spin_land_level() {
    for ratio in [0.01, 0.5, 2.0] {
        let scene = rolling_scene(ratio, 0.0, 0.3, 0.01);
        let engine = Tosser::new(&scene);
        for (axis, face) in [
            (Vector3::z(), Face::Heads),
            (-Vector3::z(), Face::Tails),
            (Vector3::x(), Face::Side),
        ] {
            if face == Face::Side && ratio < 1.2247 {
                continue;
            }
            let launch = Launch {
                height_m: 1.0,
                velocity_m_s: Vector3::zeros(),
                axis: UnitVector3::new_unchecked(axis),
                spin_rad_s: Vector3::zeros(),
            };
            let outcome = engine.toss(&launch);
            assert_eq!(outcome.face(), Some(face), "{ratio} {axis:?} {outcome:?}");
        }
    }
}
