//! Stronge's law against the Darboux–Keller equations, integrated with small steps.

use crate::common::{Case, case, parts};
use coinmc_volumetric::{Friction, Law};

/// Implicit steps of 1/`steps` of the frictionless compression. Each step solves Coulomb's law and
/// the friction lengths against the rates at its end. First order.
fn stepped(case: &Case, steps: u32) -> [f64; 5] {
    let (b, t, f) = (&case.body, &case.point, &case.friction);
    let (s, c) = (t.sin, t.cos);
    let k = t.matrix(b);
    let (roll_y, pivot_y) = (
        s * b.radius / b.ka + c * b.half / b.kt,
        c * b.radius / b.ka - s * b.half / b.kt,
    );
    let (rr, rp, pp) = (
        s * s / b.ka + c * c / b.kt,
        s * c * (1.0 / b.ka - 1.0 / b.kt),
        c * c / b.ka + s * s / b.kt,
    );
    let mut rate = [
        t.slip_x,
        t.slip_y,
        t.approach,
        s * t.spin + c * t.turn,
        c * t.spin - s * t.turn,
    ];
    let dz = -t.approach / k.zz / f64::from(steps);
    let (limit_c, limit_p) = (f.contour / s * dz, f.pivoting * dz);
    let (mut work, mut least) = (0.0, 0.0_f64);
    let (mut sum, mut part) = ([0.0; 5], [0.0; 4]);
    for _ in 0..200 * steps {
        for _ in 0..500 {
            let old = part;
            let [x, y, cc, p] = part;
            let stiff = k.xx.max(k.yy);
            let ax = x - (rate[0] + k.xz * dz + k.xx * x) / stiff;
            let ay = y - (rate[1] + k.yy * y - roll_y * cc - pivot_y * p) / stiff;
            let shrink = (f.mu * dz / libm::hypot(ax, ay)).min(1.0);
            let (x, y) = (ax * shrink, ay * shrink);
            let cc = ((rate[3] + roll_y * y - rp * p) / rr).clamp(-limit_c, limit_c);
            let p = ((rate[4] + pivot_y * y - rp * cc) / pp).clamp(-limit_p, limit_p);
            part = [x, y, cc, p];
            let moved = (0..4).map(|i| (part[i] - old[i]).abs()).fold(0.0, f64::max);
            if moved <= 1e-15 * dz {
                break;
            }
        }
        let [x, y, cc, p] = part;
        let change = [
            k.xz * dz + k.xx * x,
            k.yy * y - roll_y * cc - pivot_y * p,
            k.zz * dz + k.xz * x,
            roll_y * y - rr * cc - rp * p,
            pivot_y * y - rp * cc - pp * p,
        ];
        let gain = (rate[2] + 0.5 * change[2]) * dz;
        let target = (1.0 - case.e * case.e) * least;
        let over = rate[2] >= 0.0 && work + gain >= target;
        let share = if over {
            ((target - work) / gain).clamp(0.0, 1.0)
        } else {
            1.0
        };
        for i in 0..5 {
            rate[i] += share * change[i];
        }
        for (total, add) in sum.iter_mut().zip([x, y, dz, s * cc, p]) {
            *total += share * add;
        }
        work += share * gain;
        least = least.min(work);
        if over {
            break;
        }
    }
    sum
}

/// Impacts with slips of the size of the approach, in which the slip turns, stops and resumes.
fn turning(trial: u64) -> Case {
    let mut case = case(61, trial);
    let t = &mut case.point;
    let size = (t.slip_x.abs() + t.slip_y.abs() + 1e-3) / -t.approach;
    t.slip_x /= size;
    t.slip_y /= size;
    t.spin /= size;
    t.turn /= size;
    case
}

fn distance(case: &Case, a: [f64; 5], b: [f64; 5]) -> f64 {
    let far = (0..5).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
    far / (case.size() + b[2])
}

/// The path with small steps converges to that of the law, with an error of first order in the
/// step.
#[test]
fn small_steps_converge_to_the_law() {
    let (mut coarse_sum, mut fine_sum, mut compared) = (0.0, 0.0, 0);
    for trial in 0..600 {
        let case = turning(trial);
        let ratio = case.body.half / case.body.radius;
        if !(0.02..50.0).contains(&ratio) || case.point.sin < 1e-2 {
            continue;
        }
        let p = parts(&case.impulse(Law::Stronge));
        let coarse = distance(&case, stepped(&case, 200), p);
        let fine = distance(&case, stepped(&case, 1600), p);
        assert!(fine <= 5e-3, "trial {trial} {fine:e} {case:?} {p:?}");
        coarse_sum += coarse;
        fine_sum += fine;
        compared += 1;
    }
    let order = libm::log2(coarse_sum / fine_sum) / 3.0;
    println!(
        "{compared} impacts, order {order:.3}, mean {:e}",
        fine_sum / f64::from(compared)
    );
    assert!(compared > 200);
    assert!((0.8..1.3).contains(&order), "{order}");
}

/// With e = 1 the normal impulse loses no energy; without friction no energy is lost at all.
#[test]
fn elastic_without_friction_keeps_the_energy() {
    for trial in 0..20_000 {
        let mut case = case(62, trial);
        case.e = 1.0;
        case.friction = Friction {
            mu: 0.0,
            contour: 0.0,
            pivoting: 0.0,
        };
        let p = case.impulse(Law::Stronge);
        let lost = p.work(&case.body, &case.point).abs();
        assert!(
            lost <= 1e-14 * case.point.approach * case.point.approach,
            "{lost:e}"
        );
    }
}

/// With e = 0 there is only compression: the contact point does not rebound.
#[test]
fn plastic_impacts_end_without_rebound() {
    for trial in 0..50_000 {
        let mut case = case(63, trial);
        case.e = 0.0;
        let p = case.impulse(Law::Stronge);
        let (_, after) = crate::common::motions(&case, &p);
        let size = case.size() + case.point.spin.abs() + case.point.turn.abs() + p.z;
        assert!(after.slip.z.abs() <= 1e-13 * size, "{case:?} {p:?}");
    }
}
