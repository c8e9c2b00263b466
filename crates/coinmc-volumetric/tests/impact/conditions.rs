//! What each law guarantees, on 2e5 random impacts over all ranges.

use crate::common::{Case, case, motions, parts};
use coinmc_volumetric::{Impulse, Law};

const TRIALS: u64 = 200_000;

fn each(seed: u64, law: Law, mut check: impl FnMut(&Case, &Impulse<f64>)) {
    for trial in 0..TRIALS {
        let case = case(seed, trial);
        let p = case.impulse(law);
        assert!(
            parts(&p).iter().all(|part| part.is_finite()),
            "{law:?} {trial} {case:?} {p:?}"
        );
        check(&case, &p);
    }
}

/// K p loses digits according to its largest product: a factor of at most 6, with |p| <= 10 × the
/// velocities.
#[test]
fn newton_restitution_is_exact() {
    for law in [Law::Moreau, Law::ChatterjeeRuina] {
        each(11, law, |case, p| {
            let (_, after) = motions(case, p);
            let parts = p.x.abs() + p.z.abs() + case.size();
            let off = (after.slip.z + case.e * case.point.approach).abs();
            // the spins, up to 1000 times as large, and ω_y enter the velocities that this test
            // computes
            let spins = case.point.spin.abs() + case.point.turn.abs();
            assert!(
                off <= 1e-14 * (parts + spins + 1.0),
                "{law:?} {off:e} {case:?} {p:?}"
            );
        });
    }
}

#[test]
fn no_law_gains_energy() {
    for law in Law::ALL {
        let mut worst = 0.0_f64;
        each(12, law, |case, p| {
            let (before, after) = motions(case, p);
            let gain = (after.energy - before.energy) / before.energy;
            worst = worst.max(gain);
            assert!(gain <= 1e-12, "{law:?} {gain:e} {case:?} {p:?}");
            // the work that the kernel computes agrees
            let work = p.work(&case.body, &case.point);
            let off = (work - (after.energy - before.energy)).abs() / before.energy;
            assert!(off <= 1e-12, "{law:?} {off:e} {case:?} {p:?}");
        });
        println!("{law:?}: largest gain {worst:e} of the energy");
    }
}

#[test]
fn every_part_keeps_its_limit() {
    for law in Law::ALL {
        each(13, law, |case, p| {
            let f = &case.friction;
            let tight = 1.0 + 1e-10;
            assert!(p.z >= 0.0, "{law:?} {case:?} {p:?}");
            let tangential = libm::hypot(p.x, p.y);
            assert!(tangential <= f.mu * p.z * tight, "{law:?} {case:?} {p:?}");
            assert!(p.contour.abs() <= f.contour * p.z * tight, "{law:?} {p:?}");
            assert!(
                p.pivoting.abs() <= f.pivoting * p.z * tight,
                "{law:?} {p:?}"
            );
        });
    }
}

/// One of Moreau's set-valued laws: inside its limit the rate is 0; at its limit the friction
/// opposes the rate.
fn opposes(part: f64, limit: f64, rate: f64, size: f64) -> bool {
    let small = 1e-10 * size;
    if limit == 0.0 {
        part == 0.0
    } else if part.abs() < limit * (1.0 - 1e-10) {
        rate.abs() <= small
    } else {
        rate * part.signum() >= -small
    }
}

#[test]
fn moreau_opposes_the_final_slip() {
    let mut guarded = 0;
    each(14, Law::Moreau, |case, p| {
        if parts(p) == parts(&case.impulse(Law::ChatterjeeRuina)) && case.friction.mu > 0.0 {
            guarded += 1;
            return;
        }
        let (_, after) = motions(case, p);
        let size = case.size() + case.point.spin.abs() + case.point.turn.abs() + p.z;
        let slip = libm::hypot(after.slip.x, after.slip.y);
        if slip > 1e-10 * size {
            let friction = libm::hypot(p.x, p.y);
            let limit = case.friction.mu * p.z;
            assert!((friction - limit).abs() <= 1e-10 * limit, "{case:?} {p:?}");
            let along = p.x * after.slip.x + p.y * after.slip.y;
            assert!(
                (along + friction * slip).abs() <= 1e-10 * friction * size,
                "{case:?} {p:?}"
            );
        }
        let f = &case.friction;
        assert!(
            opposes(p.contour, f.contour * p.z, after.omega_x, size),
            "{case:?} {p:?} {after:?}"
        );
        assert!(
            opposes(p.pivoting, f.pivoting * p.z, after.omega_z, size),
            "{case:?} {p:?} {after:?}"
        );
    });
    println!("guarded: {guarded} of {TRIALS}");
    assert!(guarded < TRIALS / 10);
}

/// A reflection in the xz plane changes the sign of the y velocities and of all angular velocities
/// except that about y, and so of p_y, J_c and J_p.
#[test]
fn mirror_images_are_exact() {
    for law in Law::ALL {
        for trial in 0..50_000 {
            let mut case = case(15, trial);
            let p = case.impulse(law);
            case.point.slip_y = -case.point.slip_y;
            case.point.spin = -case.point.spin;
            case.point.turn = -case.point.turn;
            let q = case.impulse(law);
            assert_eq!(
                [p.x, -p.y, p.z, -p.contour, -p.pivoting],
                parts(&q),
                "{law:?} {case:?}"
            );
        }
    }
}

/// If velocities are multiplied by a power of 2, so is the impulse, bit by bit.
#[test]
fn velocities_scale() {
    for law in Law::ALL {
        for trial in 0..50_000 {
            let mut case = case(16, trial);
            let p = case.impulse(law);
            for factor in [0.0625, 1024.0] {
                let t = case.point;
                case.point.slip_x *= factor;
                case.point.slip_y *= factor;
                case.point.approach *= factor;
                case.point.spin *= factor;
                case.point.turn *= factor;
                let q = case.impulse(law);
                assert_eq!(parts(&p).map(|part| part * factor), parts(&q), "{law:?}");
                case.point = t;
            }
        }
    }
}
