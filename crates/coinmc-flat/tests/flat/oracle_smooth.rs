//! Oracle for tosses without friction: four corners in world coordinates, the full angle, small
//! steps with bisection at a contact. It shares only the launch with the engine.
//!
//! Sustained contact is a sequence of tiny elastic hops: a corner that would leave slower than
//! `HOP` leaves at `HOP`. The hops add at most HOP²/2 = 5e-6 m g D, and end when the coin has
//! turned so far that the corner leaves the surface.

use crate::common::{Section, Start, engine};
use coinmc_core::{Engine, Face};
use coinmc_testkit::{Dice, scene};

/// sqrt(gD)
const HOP: f64 = 3e-3;
/// Longest step near the surface, sqrt(D/g): a corner can dip below the surface between two steps
/// by at most |f''| (STEP/2)²/2 = 1e-5 D at ω = 9.
const STEP: f64 = 1e-3;

struct Toss {
    section: Section,
    e: f64,
    hop: f64,
    z: f64,
    vz: f64,
    theta: f64,
    omega: f64,
    impacts: u32,
}

impl Toss {
    fn gap(&self, t: f64) -> f64 {
        self.z + t * (self.vz - 0.5 * t) - self.section.reach(self.theta + self.omega * t)
    }

    /// Flies up to the first step that ends below the surface, and back to the surface.
    fn fly(&mut self) {
        let mut t = 0.0;
        let mut step;
        loop {
            // no corner comes down faster within a time of 1
            let fastest = (self.vz - t).abs() + self.omega.abs() + 1.0;
            step = (self.gap(t) / fastest).clamp(STEP.min(self.hop / 2.0), 1.0);
            if self.gap(t + step) < 0.0 {
                break;
            }
            t += step;
        }
        let (mut low, mut high) = (t, t + step);
        while high - low > 1e-14 {
            let middle = f64::midpoint(low, high);
            if self.gap(middle) < 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        self.z += low * (self.vz - 0.5 * low);
        self.vz -= low;
        self.theta += self.omega * low;
    }

    /// Newton's impact of the lowest corner that approaches.
    fn bounce(&mut self) {
        let k = self.section.k;
        let velocity = |(rx, _): &(f64, f64)| self.vz - self.omega * rx;
        let mut corners = self.section.corners(self.theta);
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        // flat on an edge two corners touch: the one that approaches faster counts
        let second =
            corners[1].1 - corners[0].1 < 1e-10 && velocity(&corners[1]) < velocity(&corners[0]);
        let corner = corners[usize::from(second)];
        let approach = velocity(&corner);
        let leave = (-self.e * approach).max(self.hop);
        if approach >= leave {
            return;
        }
        let p = (leave - approach) / (1.0 + corner.0 * corner.0 / k);
        self.vz += p;
        self.omega -= corner.0 * p / k;
        self.impacts += 1;
    }

    /// To the decision by energy: without friction the energy of horizontal motion cannot come
    /// back.
    fn run(mut self) -> (Face, u32) {
        loop {
            let k = self.section.k;
            let energy = 0.5 * (self.vz * self.vz + k * self.omega * self.omega) + self.z;
            if energy < 1.0 {
                return (self.section.face(self.theta), self.impacts);
            }
            self.fly();
            self.bounce();
        }
    }
}

fn toss(section: Section, e: f64, hop: f64, start: &Start) -> (Face, u32) {
    let Start {
        z,
        vz,
        theta,
        omega,
        ..
    } = *start;
    Toss {
        section,
        e,
        hop,
        z: z.max(section.reach(theta)),
        vz,
        theta,
        omega,
        impacts: 0,
    }
    .run()
}

/// P(side) agrees within 3 standard errors of the paired difference (false alarms: 3e-3 per scene).
/// At e = 0 the hops change P by at most .0009, in proportion to their speed (measured at ratio 1:
/// .0015, .0009, .0005, .0002 at 2, 1, 1/2, 1/4 of `HOP`), so .0015 is allowed there. Where both
/// have at most two impacts, before errors have grown, single tosses agree, except for 1 in 1000
/// whose corner grazes (see `STEP`).
fn assert_agrees(restitution: f64, ratio: f64, hop: f64, tosses: u64) {
    let scene = scene(ratio, restitution, 0.0);
    let (engine, section) = (engine(&scene), Section::new(&scene));
    let (mut up, mut down, mut sides) = (0_u32, 0_u32, 0_u32);
    let (mut short, mut wrong) = (0_u32, 0_u32);
    for number in 0..tosses {
        let start = Start::lively(&mut Dice::new(10, number));
        let outcome = engine.toss(&mut (), &start.launch(&scene), &mut ());
        let face = outcome.face().expect("decided");
        let (reference, impacts) = toss(section, restitution, hop, &start);
        sides += u32::from(face == Face::Side);
        up += u32::from(face == Face::Side && reference != Face::Side);
        down += u32::from(face != Face::Side && reference == Face::Side);
        if outcome.impacts <= 2 && impacts <= 2 && outcome.contact_steps == 0 {
            short += 1;
            wrong += u32::from(face != reference);
        }
    }
    let n = tosses as f64;
    let difference = (f64::from(up) - f64::from(down)) / n;
    let error = f64::from(up + down).sqrt() / n;
    let p = f64::from(sides) / n;
    println!(
        "e {restitution} ratio {ratio}: {p:.4}, difference {difference:.5} ± {error:.5}; {wrong} of {short} short"
    );
    let allowed = 3.0 * error + if restitution == 0.0 { 0.0015 } else { 0.0 };
    assert!(
        difference.abs() <= allowed,
        "{restitution} {ratio}: {difference} ± {error}"
    );
    assert!(
        f64::from(wrong) <= 1.0 + 0.001 * f64::from(short),
        "{wrong} of {short}"
    );
}

#[test]
fn bouncing_coins_agree() {
    for (restitution, ratio) in [
        (0.3, 1.0),
        (0.3, 1.5),
        (0.5, 1.0),
        (0.5, 1.5),
        (0.7, 1.0),
        (0.7, 1.5),
    ] {
        assert_agrees(restitution, ratio, HOP, 20_000);
    }
}

#[test]
fn coins_that_do_not_bounce_agree() {
    for ratio in [0.5, 1.0, 1.5] {
        assert_agrees(0.0, ratio, HOP, 20_000);
    }
}

/// The error that `HOP` causes: not part of every run.
#[test]
#[ignore = "takes minutes: run by hand after a change of the oracle"]
fn the_hops_are_low_enough() {
    for hop in [2.0 * HOP, HOP, HOP / 2.0, HOP / 4.0] {
        assert_agrees(0.0, 1.0, hop, 20_000);
    }
}
