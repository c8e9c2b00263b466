//! Limits with known answers.

use crate::common::{Case, body, case, motions, parts, point};
use coinmc_volumetric::{Friction, Law};

#[test]
fn without_friction_every_law_is_newtons() {
    for trial in 0..20_000 {
        let mut case = case(41, trial);
        case.friction = Friction {
            mu: 0.0,
            contour: 0.0,
            pivoting: 0.0,
        };
        let k = case.point.matrix(&case.body);
        let z = (1.0 + case.e) * -case.point.approach / k.zz;
        for law in Law::ALL {
            let p = case.impulse(law);
            assert_eq!([p.x, p.y, p.contour, p.pivoting], [0.0; 4], "{law:?}");
            assert!((p.z - z).abs() <= 4e-15 * z, "{law:?} {p:?} {z}");
        }
    }
}

/// The friction impulse is at most μ p_z: the impulse departs by O(μ).
#[test]
fn little_friction_changes_little() {
    for trial in 0..20_000 {
        let mut case = case(42, trial);
        case.friction.contour = 0.0;
        case.friction.pivoting = 0.0;
        for mu in [1e-3, 1e-6, 1e-12, 1e-100] {
            case.friction.mu = mu;
            let k = case.point.matrix(&case.body);
            let z = (1.0 + case.e) * -case.point.approach / k.zz;
            for law in Law::ALL {
                let p = case.impulse(law);
                // K_xz/K_zz <= 2; Stronge's rebound follows the slope of u_z, and is right to 1e-9
                assert!(
                    (p.z - z).abs() <= 10.0 * (mu + 1e-10) * z,
                    "{law:?} {case:?}"
                );
                assert!(libm::hypot(p.x, p.y) <= mu * p.z * (1.0 + 1e-10), "{p:?}");
            }
        }
    }
}

/// Friction without end stops the contact point; as Moreau's impact then may gain energy, e = 0.
#[test]
fn much_friction_sticks() {
    for trial in 0..20_000 {
        let mut case = case(43, trial);
        case.e = 0.0;
        case.friction = Friction {
            mu: 1e9,
            contour: 0.0,
            pivoting: 0.0,
        };
        let sticks = |law: Law, case: &Case| {
            let p = case.impulse(law);
            let (_, after) = motions(case, &p);
            let size = case.size() + case.point.spin.abs() + case.point.turn.abs();
            // without pressure there is nothing to stick with
            p.z <= 1e-6 * case.size() || after.slip.norm() <= 1e-6 * size
        };
        for law in Law::ALL {
            assert!(sticks(law, &case), "{law:?} {case:?}");
        }
    }
}

/// Friction lengths without end stop the turning: R/10 is their largest, here 1e12.
#[test]
fn long_friction_lengths_stop_the_turning() {
    for law in Law::ALL {
        for trial in 0..20_000 {
            let mut case = case(44, trial);
            case.friction.contour = 1e12;
            case.friction.pivoting = 1e12;
            let p = case.impulse(law);
            let (_, after) = motions(&case, &p);
            let size = case.size() + case.point.spin.abs() + case.point.turn.abs();
            let off = after.omega_x.abs() + after.omega_z.abs();
            assert!(off <= 1e-9 * size, "{law:?} {off:e} {case:?} {p:?}");
        }
    }
}

/// A coin on edge that falls straight, and a flat one: the contact below and beside the centre.
#[test]
fn thin_and_thick() {
    let friction = Friction {
        mu: 0.5,
        contour: 0.0,
        pivoting: 0.0,
    };
    for law in Law::ALL {
        for (ratio, sin) in [(1e-4, 1.0 - 1e-12), (1e4, 1e-12)] {
            let body = body(ratio);
            let case = Case {
                body,
                friction,
                point: point(&body, sin, [0.0, 0.0, -1.0], [0.0, 0.0]),
                e: 0.5,
            };
            // the centre is over the contact: a ball's bounce, to the order of the overhang
            let p = case.impulse(law);
            assert!((p.z - 1.5).abs() < 1e-3, "{law:?} {:?}", parts(&p));
        }
        // a thin disk flat on its rim: a lever of R against k_t = R²/4, K_zz = 5
        let body = body(1e-4);
        let case = Case {
            body,
            friction,
            point: point(&body, 1e-9, [0.0, 0.0, -1.0], [0.0, 0.0]),
            e: 0.5,
        };
        let p = case.impulse(law);
        assert!((p.z - 0.3).abs() < 1e-3, "{law:?} {:?}", parts(&p));
    }
}

/// A vanishing tilt makes ψ' and its friction's moment never_settles: everything stays finite.
#[test]
fn almost_flat() {
    for law in Law::ALL {
        for sin in [1e-6, 1e-9, 1e-12, 1e-15] {
            for trial in 0..2_000 {
                let mut case = case(45, trial);
                let t = case.point;
                case.point = point(
                    &case.body,
                    sin,
                    [t.slip_x, t.slip_y, t.approach],
                    [t.spin, t.turn],
                );
                let p = case.impulse(law);
                let (before, after) = motions(&case, &p);
                assert!(after.energy.is_finite(), "{law:?} {case:?} {p:?}");
                assert!(
                    after.energy <= before.energy * (1.0 + 1e-12),
                    "{law:?} {case:?} {p:?}"
                );
            }
        }
    }
}

#[test]
fn without_approach_no_impulse() {
    for law in Law::ALL {
        let mut case = case(46, 0);
        case.point.approach = 0.0;
        assert_eq!(parts(&case.impulse(law)), [0.0; 5], "{law:?}");
    }
}
