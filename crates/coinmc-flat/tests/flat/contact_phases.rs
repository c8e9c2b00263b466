//! Sustained contact against Newton and Euler's equations in world coordinates.
//!
//! The reference has three degrees of freedom and one corner in contact. At every evaluation it
//! solves a 3 × 3 system for F, N and the angular acceleration α with a_x = F, a_z = N − 1,
//! kα = r_z F − r_x N. Classical Runge–Kutta in steps of 1/2000: relative error (ω h)⁴/120, below
//! 1e-12 at ω = 2.

use crate::common::{Moment, Section, Start, engine, engine_with, record};
use coinmc_core::{Engine, EventKind, Scene};
use coinmc_flat::Settings;
use coinmc_testkit::{Dice, scene};
use nalgebra::{Matrix3, SVector, Vector3};

/// (x, z, θ, v_x, v_z, ω)
pub(crate) type World = SVector<f64, 6>;

/// The mode of the corner.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Mode {
    Stuck,
    /// Friction −μ n N; the value is μ n.
    Slides(f64),
}

pub(crate) struct Body {
    k: f64,
    /// The corner in the coin's own frame (across, along u).
    corner: (f64, f64),
}

impl Body {
    fn arm(&self, theta: f64) -> (f64, f64) {
        let (sin, cos) = libm::sincos(theta);
        let (across, along) = self.corner;
        (across * cos + along * sin, -across * sin + along * cos)
    }

    /// (F, N, α)
    fn forces(&self, y: &World, mode: Mode) -> Vector3<f64> {
        let (rx, rz) = self.arm(y[2]);
        let w2 = y[5] * y[5];
        // the corner accelerates by a + α (r_z, −r_x) − ω² r
        let (first, right) = match mode {
            Mode::Stuck => ([1.0, 0.0, rz], w2 * rx),
            Mode::Slides(friction) => ([1.0, friction, 0.0], 0.0),
        };
        let matrix = Matrix3::new(
            first[0], first[1], first[2], 0.0, 1.0, -rx, rz, -rx, -self.k,
        );
        let vector = Vector3::new(right, 1.0 + w2 * rz, 0.0);
        matrix
            .lu()
            .solve(&vector)
            .expect("no Painlevé configuration here")
    }

    fn rates(&self, y: &World, mode: Mode) -> World {
        let f = self.forces(y, mode);
        World::from([y[3], y[4], y[5], f[0], f[1] - 1.0, f[2]])
    }

    pub(crate) fn integrate(
        &self,
        mut y: World,
        mode: Mode,
        time: f64,
        mut visit: impl FnMut(&World),
    ) -> World {
        // a nonnegative time of a few units: a few thousand steps
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let steps = (time * 2000.0).ceil().max(1.0) as u32;
        let h = time / f64::from(steps);
        for _ in 0..steps {
            visit(&y);
            let a = self.rates(&y, mode);
            let b = self.rates(&(y + a * (h / 2.0)), mode);
            let c = self.rates(&(y + b * (h / 2.0)), mode);
            let d = self.rates(&(y + c * h), mode);
            y += (a + (b + c) * 2.0 + d) * (h / 6.0);
        }
        visit(&y);
        y
    }

    fn slip(&self, y: &World) -> f64 {
        y[3] + y[5] * self.arm(y[2]).1
    }
}

/// Counts of phases and transitions, and the largest difference.
#[derive(Default, Debug)]
struct PhaseCounts {
    tolerance: f64,
    stuck: u32,
    slid: u32,
    smooth: u32,
    to_flat: u32,
    to_flight: u32,
    to_slip: u32,
    to_stop: u32,
    worst: f64,
}

pub(crate) fn world(m: &Moment) -> World {
    World::from([m.x, m.z, m.theta, m.vx, m.vz, m.omega])
}

/// The corner of the phase between two observed moments, and its mode.
pub(crate) fn phase(section: &Section, mu: f64, from: &Moment, to: &Moment) -> (Body, Mode) {
    let start = world(from);
    let lowest = |theta: f64| {
        let corners = section.corners(theta);
        (0..4)
            .min_by(|a, b| corners[*a].1.total_cmp(&corners[*b].1))
            .expect("four corners")
    };
    // at a flat start two corners are lowest: the one that stays down counts
    let which = lowest(from.theta + (from.omega * 1e-6).clamp(-1e-6, 1e-6));
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)][which];
    let body = Body {
        k: section.k,
        corner: (signs.0 * section.radius, signs.1 * section.half_height),
    };
    let slip = body.slip(&start);
    let mode = if from.kind == EventKind::Sticking {
        assert!(slip.abs() < 1e-10, "sticks while it slips: {from:?}");
        Mode::Stuck
    } else {
        // a slide that begins at rest has the direction in which the corner has moved
        let moved = to.x + body.arm(to.theta).0 - from.x - body.arm(from.theta).0;
        let direction = if slip.abs() > 1e-10 { slip } else { moved };
        Mode::Slides(mu.copysign(direction))
    };
    (body, mode)
}

/// Checks the phase between two observed moments.
fn check_phase(section: &Section, mu: f64, from: &Moment, to: &Moment, seen: &mut PhaseCounts) {
    let start = world(from);
    let time = to.time - from.time;
    let (body, mode) = phase(section, mu, from, to);
    let stuck = from.kind == EventKind::Sticking;
    let mut least = [f64::INFINITY; 2];
    let mut at_end = [0.0; 2];
    let end = body.integrate(start, mode, time, |y| {
        let f = body.forces(y, mode);
        let spare = match mode {
            Mode::Stuck => mu * f[1] - f[0].abs(),
            Mode::Slides(friction) => body.slip(y) * 1.0_f64.copysign(friction),
        };
        at_end = [f[1], if mu == 0.0 { 1.0 } else { spare }];
        least = [least[0].min(at_end[0]), least[1].min(at_end[1])];
    });
    let turned = (end[2] - to.theta + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU)
        - std::f64::consts::PI;
    let found = world(to);
    for (i, difference) in [
        (0, end[0] - found[0]),
        (1, end[1] - found[1]),
        (2, turned),
        (3, end[3] - found[3]),
        (4, end[4] - found[4]),
        (5, end[5] - found[5]),
    ] {
        seen.worst = seen.worst.max(difference.abs());
        assert!(
            difference.abs() < seen.tolerance,
            "component {i} is off by {difference:e}: {mode:?} {from:?} {to:?}"
        );
    }
    assert!(
        least[0] > -seen.tolerance,
        "pulled down by {}: {from:?}",
        least[0]
    );
    assert!(
        least[1] > -seen.tolerance,
        "left its mode by {}: {from:?}",
        least[1]
    );
    match to.kind {
        EventKind::Touching => {
            let mut heights = section.corners(found[2]).map(|(_, z)| found[1] + z);
            heights.sort_by(f64::total_cmp);
            assert!(heights[1].abs() < 1e-10, "not flat: {to:?}");
            seen.to_flat += 1;
        }
        EventKind::LiftOff => {
            assert!(
                at_end[0].abs() < seen.tolerance,
                "pressed by {}: {to:?}",
                at_end[0]
            );
            seen.to_flight += 1;
        }
        EventKind::Sliding if stuck => {
            assert!(at_end[1].abs() < seen.tolerance, "inside the cone: {to:?}");
            seen.to_slip += 1;
        }
        EventKind::Sticking | EventKind::Sliding => {
            assert!(
                at_end[1].abs() < seen.tolerance,
                "slips by {}: {to:?}",
                at_end[1]
            );
            seen.to_stop += 1;
        }
        // or, without rebound, below the highest barrier of both wells without the energy of sliding
        _ => {
            let energy = to.energy(section.k);
            let narrowest = section.radius.min(section.half_height);
            let barrier = (1.0 + mu * mu).sqrt() - mu * narrowest;
            let decided = energy < 1.0 || energy - 0.5 * to.vx * to.vx < barrier.min(1.0);
            assert!(decided, "ends undecided: {to:?}");
        }
    }
    match mode {
        Mode::Stuck => seen.stuck += 1,
        Mode::Slides(_) if mu == 0.0 => seen.smooth += 1,
        Mode::Slides(_) => seen.slid += 1,
    }
}

/// A coin on its corner, which slides and neither approaches nor leaves, that turns almost fast
/// enough to lift off (ω²cos δ from 0.5 to 1).
fn touching(section: &Section, dice: &mut Dice) -> Start {
    let theta = dice.between(0.0, std::f64::consts::TAU);
    let lowest = section.lowest(theta);
    let z = -lowest.1;
    let omega = dice.pick(&[-1.0, 1.0]) * (dice.between(0.5, 1.0) / z).sqrt();
    Start {
        z,
        vx: omega * z + dice.pick(&[0.0, 1.0]) * dice.between(-1.0, 1.0),
        vz: omega * lowest.0,
        theta,
        omega,
    }
}

/// Events are located to 1e-11 in their margins and slides integrated to 1e-12 per step, with some
/// tens of steps: 1e-9 leaves room for the amplification by the motion itself.
#[test]
fn phases_follow_newton_and_euler() {
    let seen = check_tosses(1e-12, 1e-9);
    let PhaseCounts {
        stuck,
        slid,
        smooth,
        to_flat,
        to_flight,
        to_slip,
        to_stop,
        ..
    } = seen;
    for count in [stuck, slid, smooth, to_flat] {
        assert!(count >= 50, "{seen:?}");
    }
    for count in [to_flight, to_slip, to_stop] {
        assert!(count >= 10, "{seen:?}");
    }
}

/// The same at the default tolerance, with some tens of steps; slides that stay near the balance
/// amplify the error by as much again.
#[test]
fn phases_at_the_default_tolerance_follow_newton_and_euler() {
    check_tosses(Settings::default().tolerance, 1e-4);
}

/// Checks all phases of a few thousand tosses at this tolerance, to `allowed`.
fn check_tosses(tolerance: f64, allowed: f64) -> PhaseCounts {
    let settings = Settings {
        tolerance,
        ..Settings::default()
    };
    let mut seen = PhaseCounts {
        tolerance: allowed,
        ..PhaseCounts::default()
    };
    for (ratio, mu) in [
        (1.0, 0.3),
        (1.0, 0.0),
        (0.3, 0.5),
        (0.3, 0.0),
        (2.0, 0.7),
        (2.0, 0.1),
        (4.0, 0.0),
        (5.0, 0.3),
    ] {
        let scene = scene(ratio, 0.0, mu);
        let (engine, section) = (engine_with(&scene, settings), Section::new(&scene));
        for toss in 0..300 {
            let start = if toss % 2 == 0 {
                Start::lively(&mut Dice::new(60, toss))
            } else {
                touching(&section, &mut Dice::new(61, toss))
            };
            let (_, moments) = record(&engine, &scene, &start.launch(&scene));
            for pair in moments.windows(2) {
                if matches!(pair[0].kind, EventKind::Sticking | EventKind::Sliding) {
                    check_phase(&section, mu, &pair[0], &pair[1], &mut seen);
                }
            }
        }
    }
    println!("{seen:?}");
    seen
}

/// A coin that does not rebound, with this multiple of the friction above which a corner that slides can jam: where
/// A = K_zz − μ K_xz is not positive, k + s² <= μ s c for some angle, s and c its sine and cosine, which asks for
/// μ >= 2 sqrt(k(1 + k)) (4/3 for a rod, k = 1/3: Painlevé 1895; Génot & Brogliato 1999).
fn near_jamming(ratio: f64, multiple: f64) -> Scene {
    let k = Section::new(&scene(ratio, 0.0, 0.0)).k;
    scene(ratio, 0.0, multiple * 2.0 * (k * (1.0 + k)).sqrt())
}

#[test]
fn corners_jam_only_above_the_critical_friction() {
    for ratio in [0.1, 1.0, 3.0, 10.0] {
        let [below, above] = [0.99, 1.5].map(|multiple| {
            let scene = near_jamming(ratio, multiple);
            let (engine, section) = (engine(&scene), Section::new(&scene));
            (0..2000)
                .map(|toss| {
                    let start = touching(&section, &mut Dice::new(62, toss));
                    engine.toss(&mut (), &start.launch(&scene), &mut ()).jams
                })
                .sum::<u32>()
        });
        assert!(below == 0 && above > 0, "H/R {ratio}: {below}, {above}");
    }
}

/// A corner that has jammed sticks, or leaves at once where the coin turns so fast that nothing presses it down: it
/// does not slide on for no time.
#[test]
fn corners_that_have_jammed_stick_or_leave() {
    let mut left = 0;
    for ratio in [1.0, 3.0, 10.0] {
        let scene = near_jamming(ratio, 1.5);
        let (engine, section) = (engine(&scene), Section::new(&scene));
        for toss in 0..2000 {
            let start = touching(&section, &mut Dice::new(62, toss));
            let (outcome, moments) = record(&engine, &scene, &start.launch(&scene));
            if outcome.jams == 0 {
                continue;
            }
            for pair in moments.windows(2) {
                if pair[0].kind == EventKind::Sliding && pair[1].kind == EventKind::LiftOff {
                    // a slide that jams at once takes no time either, but changes the turning
                    let same = pair[1].time == pair[0].time && pair[1].omega == pair[0].omega;
                    assert!(!same, "H/R {ratio}, toss {toss}");
                    left += 1;
                }
            }
        }
    }
    assert!(left > 30, "{left}");
}
