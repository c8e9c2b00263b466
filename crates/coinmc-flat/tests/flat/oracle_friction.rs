//! Oracle for tosses with friction: Moreau–Jean time stepping, without events.
//!
//! A step moves half way, treats every corner at or below the surface there as a contact, solves
//! for all impulses at once by projected Gauss–Seidel (u_z⁺ >= −e u_z⁻ with p_z >= 0, friction
//! against the final slip) and moves the other half. Steps shrink when a corner approaches fast, so
//! that it is met within 1e-6 D, and are `STEP` long in contact.
//!
//! Jean, "The non-smooth contact dynamics method", Comput. Methods Appl. Mech. Engrg. 177 (1999).

use crate::common::{Section, Start, engine};
use coinmc_core::{Engine, Face};
use coinmc_testkit::{Dice, scene};

/// Longest step near the surface, sqrt(D/g).
const STEP: f64 = 1e-3;

#[derive(Clone, Copy)]
struct Toss {
    section: Section,
    e: f64,
    mu: f64,
    step: f64,
    z: f64,
    vx: f64,
    vz: f64,
    theta: f64,
    omega: f64,
}

/// A corner in contact during a step.
struct Active {
    rx: f64,
    rz: f64,
    /// Least normal velocity after the step.
    rebound: f64,
    px: f64,
    pz: f64,
}

impl Toss {
    fn slip(&self, c: &Active) -> f64 {
        self.vx + self.omega * c.rz
    }

    fn normal(&self, c: &Active) -> f64 {
        self.vz - self.omega * c.rx
    }

    /// Sets the impulse of a contact; returns the change.
    fn push(&mut self, c: &mut Active, px: f64, pz: f64) -> f64 {
        let (dx, dz) = (px - c.px, pz - c.pz);
        self.vx += dx;
        self.vz += dz;
        self.omega += (c.rz * dx - c.rx * dz) / self.section.k;
        (c.px, c.pz) = (px, pz);
        dx.abs() + dz.abs()
    }

    /// Solves one contact with the others fixed: stick, slide in either direction, or open.
    fn relax(&mut self, c: &mut Active) -> f64 {
        let k = self.section.k;
        let (xx, zz) = (1.0 + c.rz * c.rz / k, 1.0 + c.rx * c.rx / k);
        let xz = -c.rx * c.rz / k;
        // velocities without this contact's impulse
        let ux = self.slip(c) - xx * c.px - xz * c.pz;
        let need = c.rebound - (self.normal(c) - xz * c.px - zz * c.pz);
        if need <= 0.0 {
            return self.push(c, 0.0, 0.0);
        }
        let determinant = xx * zz - xz * xz;
        let (px, pz) = (
            (-ux * zz - xz * need) / determinant,
            (xx * need + xz * ux) / determinant,
        );
        if px.abs() <= self.mu * pz {
            return self.push(c, px, pz);
        }
        for side in [1.0, -1.0] {
            let friction = -self.mu * side;
            let pz = need / (zz + xz * friction);
            let slip = ux + (xx * friction + xz) * pz;
            if pz >= 0.0 && slip * side >= 0.0 {
                return self.push(c, friction * pz, pz);
            }
        }
        self.push(c, 0.0, need / zz)
    }

    fn advance(&mut self, h: f64) {
        self.z += 0.5 * h * self.vz;
        self.theta += 0.5 * h * self.omega;
        let mut contacts: Vec<Active> = Vec::new();
        for (rx, rz) in self.section.corners(self.theta) {
            if self.z + rz <= 0.0 {
                let rebound = -self.e * (self.vz - self.omega * rx);
                contacts.push(Active {
                    rx,
                    rz,
                    rebound,
                    px: 0.0,
                    pz: 0.0,
                });
            }
        }
        self.vz -= h;
        for _ in 0..60 {
            let change: f64 = contacts.iter_mut().map(|contact| self.relax(contact)).sum();
            if contacts.len() < 2 || change < 1e-14 {
                break;
            }
        }
        self.z += 0.5 * h * self.vz;
        self.theta += 0.5 * h * self.omega;
    }

    /// The longest step, shortened for a corner that comes down fast.
    fn next_step(&self) -> f64 {
        let mut step = self.step;
        for (rx, rz) in self.section.corners(self.theta) {
            let (height, speed) = (self.z + rz, self.omega * rx - self.vz);
            if height > 0.0 && speed > 0.02 {
                step = step.min((height / speed).max(1e-6));
            }
        }
        step
    }

    /// Runs until energy decides the face. A corner that has sunk in (by 1e-6 D) has a lower
    /// barrier.
    fn run(mut self) -> Face {
        loop {
            let k = self.section.k;
            let kinetic =
                0.5 * (self.vx * self.vx + self.vz * self.vz + k * self.omega * self.omega);
            let gap = self.z - self.section.reach(self.theta);
            if kinetic + self.z - gap.min(0.0) < 1.0 {
                return self.section.face(self.theta);
            }
            if gap > 0.05 {
                // clear of the surface: flight is exact
                let t = gap / (self.vz.abs() + self.omega.abs() + 1.0);
                self.z += t * (self.vz - 0.5 * t);
                self.vz -= t;
                self.theta += t * self.omega;
            } else {
                self.advance(self.next_step());
            }
        }
    }
}

fn toss(section: Section, e: f64, mu: f64, step: f64, start: &Start) -> Face {
    let Start {
        z,
        vx,
        vz,
        theta,
        omega,
    } = *start;
    Toss {
        section,
        e,
        mu,
        step,
        z: z.max(section.reach(theta)),
        vx,
        vz,
        theta,
        omega,
    }
    .run()
}

/// P(side) of the engine, its paired difference to the oracle, and the standard error of that.
fn difference(
    (ratio, e, mu): (f64, f64, f64),
    step: f64,
    tosses: u64,
    vx_factor: f64,
) -> (f64, f64, f64) {
    let scene = scene(ratio, e, mu);
    let (engine, section) = (engine(&scene), Section::new(&scene));
    let (mut up, mut down, mut sides) = (0_u32, 0_u32, 0_u32);
    for number in 0..tosses {
        let mut start = Start::lively(&mut Dice::new(20, number));
        start.vx *= vx_factor;
        let outcome = engine.toss(&mut (), &start.launch(&scene), &mut ());
        let side = outcome.face().expect("decided") == Face::Side;
        let reference = toss(section, e, mu, step, &start) == Face::Side;
        sides += u32::from(side);
        up += u32::from(side && !reference);
        down += u32::from(!side && reference);
    }
    let n = tosses as f64;
    let difference = (f64::from(up) - f64::from(down)) / n;
    let error = f64::from(up + down).sqrt() / n;
    println!(
        "{ratio} {e} {mu} {step}: {:.4}, {difference:.5} ± {error:.5}",
        f64::from(sides) / n
    );
    (f64::from(sides) / n, difference, error)
}

/// Agrees within 3 standard errors of the paired difference (false alarms: 3e-3 per scene), plus
/// .001 for the step. The step causes up to .0007 at e = 0, in proportion to its length (at ratio
/// 0.5: .0021, .0013, .0007, .0004, .0003 at 4, 2, 1, 1/2, 1/4 of `STEP`), and no visible error at
/// e > 0. Nor do simultaneous impacts of two corners, which the engine resolves in sequence.
fn assert_agrees(scene: (f64, f64, f64)) {
    let (_, difference, error) = difference(scene, STEP, 20_000, 1.0);
    assert!(
        difference.abs() <= 3.0 * error + 0.001,
        "{scene:?}: {difference} ± {error}"
    );
}

#[test]
fn coins_that_do_not_bounce_agree() {
    for scene in [(1.0, 0.0, 0.3), (1.5, 0.0, 1.0), (0.5, 0.0, 0.3)] {
        assert_agrees(scene);
    }
}

#[test]
fn bouncing_coins_agree() {
    for scene in [(1.0, 0.5, 0.3), (1.5, 0.3, 1.0), (0.5, 0.7, 0.3)] {
        assert_agrees(scene);
    }
}

/// Fast along the surface: these coins lie flat with an energy above the barrier and keep sliding.
/// A flat slide takes the oracle thousands of steps, hence fewer tosses.
#[test]
fn fast_sliding_coins_agree() {
    for scene in [
        (5.0, 0.0, 0.6),
        (0.5, 0.0, 0.5),
        (1.5, 0.5, 0.3),
        (3.0, 0.3, 1.0),
    ] {
        let (_, difference, error) = difference(scene, STEP, 1_000, 4.0);
        assert!(
            difference.abs() <= 3.0 * error + 0.001,
            "{scene:?}: {difference} ± {error}"
        );
    }
}

/// Released almost flat and fast along the surface, a coin whose base is too narrow for its
/// friction (μ·height > half width) trips over its leading corner; the others slide and stay flat.
/// These motions hardly amplify errors: single tosses agree, except for at most two that come as
/// near to a balance as the error of the step (4e-3 of 200).
#[test]
fn coins_released_flat_agree() {
    for (ratio, e, mu) in [
        (5.0, 0.0, 0.6),
        (0.3, 0.0, 0.5),
        (5.0, 0.0, 0.2),
        (3.0, 0.3, 1.0),
    ] {
        let scene = scene(ratio, e, mu);
        let (engine, section) = (engine(&scene), Section::new(&scene));
        let (mut different, mut changed) = (0, 0);
        let tosses = 200;
        for number in 0..tosses {
            let mut dice = Dice::new(21, number);
            let quarter = f64::from(dice.pick(&[0_u8, 1, 2, 3]));
            let theta = quarter * std::f64::consts::FRAC_PI_2 + dice.between(-1e-5, 1e-5);
            let start = Start {
                z: section.reach(theta) + dice.scale(1e-9, 1e-3),
                vx: dice.between(-4.0, 4.0),
                vz: 0.0,
                theta,
                omega: 0.0,
            };
            let outcome = engine.toss(&mut (), &start.launch(&scene), &mut ());
            let face = outcome.face().expect("decided");
            different += u32::from(face != toss(section, e, mu, STEP, &start));
            changed += u32::from(face != section.face(theta));
        }
        println!("{ratio} {e} {mu}: {different} differ, {changed} changed of {tosses}");
        assert!(different <= 2, "{ratio} {e} {mu}: {different}");
        // the leading corner catches where it should: otherwise this compares nothing
        let trips = mu * ratio.max(4.0 / ratio) / 2.0 > 1.0;
        assert_eq!(changed > 40, trips, "{ratio} {e} {mu}: {changed}");
    }
}

/// The error that `STEP` causes: not part of every run.
#[test]
#[ignore = "takes minutes: run by hand after a change of the oracle"]
fn the_step_is_short_enough() {
    for scene in [(1.0, 0.0, 0.3), (0.5, 0.0, 0.3), (1.0, 0.5, 0.3)] {
        for step in [4.0 * STEP, 2.0 * STEP, STEP, STEP / 2.0, STEP / 4.0] {
            difference(scene, step, 20_000, 1.0);
        }
    }
}
