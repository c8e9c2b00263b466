//! Moreau's law by an independent method: projected Gauss–Seidel iteration on the five parts of the
//! impulse, with vectors, until it has converged.

use crate::common::{Case, case, motions, parts};
use coinmc_volumetric::{Impulse, Law};

type Matrix = [[f64; 5]; 5];

/// The response of the rates (slip_x, slip_y, u_z, −ω_x, −ω_z) to unit parts (p_x, p_y, p_z, C, P),
/// C = J_c/s, and the rates without impulse.
fn delassus(case: &Case) -> (Matrix, [f64; 5]) {
    let rates = |p: [f64; 5]| {
        let p = Impulse {
            x: p[0],
            y: p[1],
            z: p[2],
            contour: p[3] * case.point.sin,
            pivoting: p[4],
        };
        let (_, after) = motions(case, &p);
        [
            after.slip.x,
            after.slip.y,
            after.slip.z,
            -after.omega_x,
            -after.omega_z,
        ]
    };
    let free = rates([0.0; 5]);
    let mut matrix = [[0.0; 5]; 5];
    for j in 0..5 {
        let mut unit = [0.0; 5];
        unit[j] = 1.0;
        let column = rates(unit);
        for i in 0..5 {
            matrix[i][j] = column[i] - free[i];
        }
    }
    (matrix, free)
}

/// The impulse of which every part obeys its law with the rates after the impact; `None` if the
/// iteration does not converge.
fn gauss_seidel(case: &Case) -> Option<[f64; 5]> {
    let (g, free) = delassus(case);
    let f = &case.friction;
    let wanted = -case.e * case.point.approach;
    let mut p = [0.0; 5];
    for _ in 0..200_000 {
        let old = p;
        let rate = |p: &[f64; 5], i: usize| free[i] + (0..5).map(|j| g[i][j] * p[j]).sum::<f64>();
        p[2] = (p[2] - (rate(&p, 2) - wanted) / g[2][2]).max(0.0);
        let step = 0.7 / g[0][0].max(g[1][1]);
        let (x, y) = (p[0] - step * rate(&p, 0), p[1] - step * rate(&p, 1));
        let shrink = (f.mu * p[2] / libm::hypot(x, y)).min(1.0);
        (p[0], p[1]) = (x * shrink, y * shrink);
        let limit = f.contour / case.point.sin * p[2];
        p[3] = (p[3] - rate(&p, 3) / g[3][3]).clamp(-limit, limit);
        let limit = f.pivoting * p[2];
        p[4] = (p[4] - rate(&p, 4) / g[4][4]).clamp(-limit, limit);
        let moved = (0..5).map(|i| (p[i] - old[i]).abs()).fold(0.0, f64::max);
        if moved <= 1e-15 * case.size() {
            return Some(p);
        }
    }
    None
}

/// Above μ = 1/2 there may be several solutions, and the iteration may find another one. Below, the
/// impulse agrees to 1e-8: the iteration stops where it changes by less than 1e-15 per sweep, and
/// it contracts by 1e-4 per sweep at worst.
#[test]
fn moreau_agrees_with_gauss_seidel() {
    let (mut compared, mut skipped) = (0, 0);
    for trial in 0..20_000 {
        let mut case = case(51, trial);
        case.friction.mu = case.friction.mu.min(0.5 * case.friction.mu / 10.0 + 0.2);
        let ratio = case.body.half / case.body.radius;
        if case.friction.mu == 0.0 || !(0.02..50.0).contains(&ratio) || case.point.sin < 1e-3 {
            continue;
        }
        let p = case.impulse(Law::Moreau);
        if parts(&p) == parts(&case.impulse(Law::ChatterjeeRuina)) {
            skipped += 1;
            continue;
        }
        let Some(q) = gauss_seidel(&case) else {
            skipped += 1;
            continue;
        };
        let p = [p.x, p.y, p.z, p.contour / case.point.sin, p.pivoting];
        let scale = q.iter().fold(case.size(), |sum, part| sum + part.abs());
        for i in 0..5 {
            assert!(
                (p[i] - q[i]).abs() <= 1e-8 * scale,
                "trial {trial} {case:?}\n{p:?}\n{q:?}"
            );
        }
        compared += 1;
    }
    println!("{compared} compared, {skipped} skipped");
    assert!(compared > 5_000 && skipped * 20 < compared);
}

/// The plastic impact of Moreau's law leaves the least energy that friction within its limits can
/// leave: random changes of the friction inside the limits, with u_z⁺ = 0 and the same p_z, leave
/// no less.
#[test]
fn a_plastic_impact_dissipates_most() {
    for trial in 0..20_000 {
        let mut case = case(52, trial);
        case.e = 0.0;
        let p = case.impulse(Law::Moreau);
        let (_, after) = motions(&case, &p);
        let f = &case.friction;
        let mut dice = coinmc_testkit::Dice::new(53, trial);
        for _ in 0..20 {
            let share = dice.scale(1e-4, 1.0);
            let mut q = p;
            // p_y, C and P do not move u_z
            let room = (f.mu * p.z * (f.mu * p.z) - p.x * p.x).max(0.0).sqrt();
            q.y += share * (dice.between(-room, room) - p.y);
            let limit = f.contour * p.z;
            q.contour += share * (dice.between(-limit, limit) - p.contour);
            let limit = f.pivoting * p.z;
            q.pivoting += share * (dice.between(-limit, limit) - p.pivoting);
            let (before, other) = motions(&case, &q);
            assert!(
                other.energy >= after.energy - 1e-12 * before.energy,
                "{case:?} {p:?} {q:?}"
            );
        }
    }
}
