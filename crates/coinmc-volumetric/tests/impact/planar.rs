//! Impacts without sideways slip or spin: the laws in the plane, and Stronge's law in closed form.

use crate::common::{Case, case, parts, point};
use coinmc_flat as flat;
use coinmc_flat::ImpactLaw as _;
use coinmc_volumetric::Law;

/// An impact in the plane, without friction lengths.
fn planar(seed: u64, trial: u64) -> Case {
    let mut case = case(seed, trial);
    let t = case.point;
    case.point = point(&case.body, t.sin, [t.slip_x, 0.0, t.approach], [0.0, 0.0]);
    case.friction.contour = 0.0;
    case.friction.pivoting = 0.0;
    case
}

#[test]
fn agrees_with_the_flat_laws() {
    for trial in 0..100_000 {
        let case = planar(31, trial);
        let k = case.point.matrix(&case.body);
        let k = flat::ContactMatrix {
            xx: k.xx,
            xz: k.xz,
            zz: k.zz,
        };
        let (x, z) = (case.point.slip_x, case.point.approach);
        let mu = case.friction.mu;
        for (law, p) in [
            (Law::Moreau, flat::Moreau.impulse(k, x, z, case.e, mu)),
            (
                Law::ChatterjeeRuina,
                flat::ChatterjeeRuina.impulse(k, x, z, case.e, mu),
            ),
        ] {
            let q = case.impulse(law);
            let off = (p.x - q.x).abs().max((p.z - q.z).abs()).max(q.y.abs());
            assert!(off <= 1e-12 * case.size(), "{law:?} {case:?} {p:?} {q:?}");
        }
    }
}

/// Stronge's solution in the plane: u_z(τ) is linear in two pieces, with a corner where the slip
/// stops.
fn closed_form(case: &Case) -> [f64; 2] {
    let k = case.point.matrix(&case.body);
    let (mu, e) = (case.friction.mu, case.e);
    let (slip, u0) = (case.point.slip_x, case.point.approach);
    let n = slip.signum();
    let first = k.zz - mu * k.xz * n;
    let slowing = mu * k.xx - k.xz * n;
    let stop = if slowing > 0.0 {
        slip.abs() / slowing
    } else {
        f64::INFINITY
    };
    let after = if k.xz.abs() <= mu * k.xx {
        -k.xz / k.xx
    } else {
        -mu * k.xz.signum()
    };
    let second = k.zz + k.xz * after;
    let at_stop = u0 + first * stop;
    let work_at_stop = 0.5 * (u0 + at_stop) * stop;
    let end = if first > 0.0 && at_stop > 0.0 {
        let least = -0.5 * u0 * u0 / first;
        let free = -u0 / first * (1.0 + e);
        if free <= stop {
            free
        } else {
            // the part of the e² of the work that is still to be returned after the slip has
            // stopped
            let missing = (1.0 - e * e) * least - work_at_stop;
            let root = (at_stop * at_stop + 2.0 * second * missing).sqrt();
            stop + (root - at_stop) / second
        }
    } else {
        let least = work_at_stop - 0.5 * at_stop * at_stop / second;
        stop + (-at_stop + e * (-2.0 * least * second).sqrt()) / second
    };
    [-mu * n * stop.min(end) + after * (end - stop).max(0.0), end]
}

#[test]
fn stronge_agrees_with_the_closed_form() {
    let (mut stopped, mut jammed) = (0, 0);
    for trial in 0..100_000 {
        let case = planar(32, trial);
        let p = case.impulse(Law::Stronge);
        let [x, z] = closed_form(&case);
        let off = (p.x - x).abs().max((p.z - z).abs()).max(p.y.abs());
        assert!(
            off <= 1e-11 * (case.size() + z),
            "{off:e} {case:?} {:?}",
            parts(&p)
        );
        let k = case.point.matrix(&case.body);
        stopped += u32::from(p.x.abs() < case.friction.mu * p.z * (1.0 - 1e-9));
        jammed += u32::from(k.zz < case.friction.mu * k.xz * case.point.slip_x.signum());
    }
    // the cases that distinguish this law are among them
    assert!(stopped > 10_000 && jammed > 500, "{stopped} {jammed}");
}
