//! Limiting cases with known answers.

use crate::common::{Case, body, case, motions, parts, point};
use coinmc_volumetric::{Friction, Law};

#[test]
fn without_friction_all_laws_agree_with_newton() {
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

/// The friction impulse is at most μ p_z, so it changes the impulse by O(μ).
#[test]
fn low_friction_changes_little() {
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
                // K_xz/K_zz <= 2; the error of Stronge's law is below 1e-9
                assert!(
                    (p.z - z).abs() <= 10.0 * (mu + 1e-10) * z,
                    "{law:?} {case:?}"
                );
                assert!(libm::hypot(p.x, p.y) <= mu * p.z * (1.0 + 1e-10), "{p:?}");
            }
        }
    }
}

/// Very high friction stops the contact point. With e > 0 Moreau's impact might gain energy, so
/// e = 0.
#[test]
fn high_friction_sticks() {
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
            // without a normal impulse there is no friction
            p.z <= 1e-6 * case.size() || after.slip.norm() <= 1e-6 * size
        };
        for law in Law::ALL {
            assert!(sticks(law, &case), "{law:?} {case:?}");
        }
    }
}

/// Very large friction lengths stop the rotation: here 1e12, while scenes allow R/10.
#[test]
fn large_friction_lengths_stop_the_rotation() {
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

/// A coin on its edge and a flat coin fall without rotation: the contact point is below the centre,
/// and beside it.
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
            // the centre is above the contact point: it bounces like a ball, up to the small offset
            let p = case.impulse(law);
            assert!((p.z - 1.5).abs() < 1e-3, "{law:?} {:?}", parts(&p));
        }
        // a flat thin disk touches at its rim: a lever arm of R, and k_t = R²/4, so K_zz = 5
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

/// As the tilt vanishes, ψ' and the moment of contour friction become infinite; the impulse remains
/// finite.
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
