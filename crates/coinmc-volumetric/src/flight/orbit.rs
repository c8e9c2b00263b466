//! The motion of the coin in flight, in closed form.
//!
//! u turns about the fixed vector Ω. With e = Ω/w, w = |Ω| and the phase φ,
//!
//! u(φ) = a + b cos φ + d sin φ,  a = e(e·u), b = u − a, d = e × u.
//!
//! Without drag φ = wt and the centre follows a parabola. With linear drag k and angular drag k_a
//! (v' = −kv − g, Ω' = −k_a Ω) the direction of Ω stays fixed, φ = w t p(k_a t), and the height of
//! the centre is z + v_z t p(kt) − g t² q(kt), with p and q of [`decay`].

use crate::body::Body;
use crate::drag::Drag;
use crate::motion::{LEAST_SIN, Motion};
use crate::series::{decay, sin_cos};
use coinmc_lanes::Lane;

/// The numbers that describe a flight, apart from its drag.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OrbitState<T> {
    /// The vectors a, b, d of the module's text.
    pub(super) a: [T; 3],
    pub(super) b: [T; 3],
    pub(super) d: [T; 3],
    /// Height and vertical velocity of the centre at t = 0.
    pub(super) z: T,
    pub(super) vz: T,
    /// Time from the start of the flight to t = 0.
    pub(super) elapsed: T,
    /// w, the rate at which u turns.
    pub(super) rate: T,
    /// The part of w that moves u, and the horizontal part of Ω.
    pub(super) across: T,
    pub(super) horizontal: T,
}

impl<T: Copy> OrbitState<T> {
    pub(crate) const COLUMNS: usize = 15;

    /// The state as an array, for memory.
    #[inline(always)]
    pub(crate) fn columns(&self) -> [T; 15] {
        let fall = [self.z, self.vz, self.elapsed];
        let rates = [self.rate, self.across, self.horizontal];
        let triples = [self.a, self.b, self.d, fall, rates];
        let mut columns = [self.z; 15];
        for (column, number) in columns.iter_mut().zip(triples.as_flattened()) {
            *column = *number;
        }
        columns
    }

    /// The state of [`columns`](Self::columns).
    #[inline(always)]
    pub(crate) fn from_columns(columns: &[T; 15]) -> Self {
        let c = columns;
        Self {
            a: [c[0], c[1], c[2]],
            b: [c[3], c[4], c[5]],
            d: [c[6], c[7], c[8]],
            z: c[9],
            vz: c[10],
            elapsed: c[11],
            rate: c[12],
            across: c[13],
            horizontal: c[14],
        }
    }
}

/// A flight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Orbit<L> {
    pub(crate) state: OrbitState<L>,
    pub(super) drag: Drag,
}

impl<L: Lane> Orbit<L> {
    /// The flight that begins with the motion `m`.
    #[inline(always)]
    pub(crate) fn new(m: &Motion<L>, drag: Drag) -> Self {
        let zero = L::splat(0.0);
        let square = m.ox * m.ox + m.oy * m.oy + m.oz * m.oz;
        let rate = square.sqrt();
        let turns = zero.lt(rate);
        let inverse = L::select(turns, L::splat(1.0) / rate, zero);
        let e = [m.ox * inverse, m.oy * inverse, m.oz * inverse];
        let along = e[0] * m.sin + e[2] * m.cos;
        let turn = m.ox * m.cos - m.oz * m.sin;
        let a = [e[0] * along, e[1] * along, e[2] * along];
        let state = OrbitState {
            a,
            b: [m.sin - a[0], -a[1], m.cos - a[2]],
            d: [e[1] * m.cos, e[2] * m.sin - e[0] * m.cos, -(e[1] * m.sin)],
            z: m.z,
            vz: m.vz,
            elapsed: zero,
            rate,
            across: (turn * turn + m.oy * m.oy).sqrt(),
            horizontal: (m.ox * m.ox + m.oy * m.oy).sqrt(),
        };
        Self { state, drag }
    }

    /// A flight whose state was kept in memory.
    #[inline(always)]
    pub(crate) fn resumed(columns: &[L; 15], drag: Drag) -> Self {
        Self {
            state: OrbitState::from_columns(columns),
            drag,
        }
    }

    /// Moves t = 0 to the time `t`, in the lanes of `on`: times close to it then keep their digits.
    #[inline(always)]
    pub(crate) fn rebase(&mut self, t: L, on: L::Mask) {
        let (s, c, rate) = self.phase(t);
        let (z, vz) = self.fall(t);
        let set = |number: &mut L, to: L| *number = L::select(on, to, *number);
        for i in 0..3 {
            let (b, d) = (self.state.b[i], self.state.d[i]);
            set(&mut self.state.b[i], b * c + d * s);
            set(&mut self.state.d[i], d * c - b * s);
        }
        set(&mut self.state.z, z);
        set(&mut self.state.vz, vz);
        set(&mut self.state.rate, rate);
        let elapsed = self.state.elapsed + t;
        set(&mut self.state.elapsed, elapsed);
    }

    pub(crate) fn is_dragged(&self) -> bool {
        self.drag.acts()
    }

    /// Time from the start of the flight.
    #[inline(always)]
    pub(crate) fn since_start(&self, t: L) -> L {
        self.state.elapsed + t
    }

    /// sin and cos of the phase, and its rate.
    #[inline(always)]
    pub(super) fn phase(&self, t: L) -> (L, L, L) {
        if self.drag.angular == 0.0 {
            let (s, c) = sin_cos(self.state.rate * t);
            return (s, c, self.state.rate);
        }
        let x = L::splat(self.drag.angular) * t;
        let (p, _) = decay(x);
        let (s, c) = sin_cos(self.state.rate * t * p);
        (s, c, self.state.rate * (L::splat(1.0) - x * p))
    }

    /// Height and vertical velocity of the centre.
    #[inline(always)]
    pub(crate) fn fall(&self, t: L) -> (L, L) {
        if self.drag.linear == 0.0 {
            return (
                self.state.z + t * (self.state.vz - L::splat(0.5) * t),
                self.state.vz - t,
            );
        }
        let x = L::splat(self.drag.linear) * t;
        let (p, q) = decay(x);
        (
            self.state.z + t * (self.state.vz * p - t * q),
            self.state.vz * (L::splat(1.0) - x * p) - t * p,
        )
    }

    /// Upper bound of the downward acceleration of the centre from now on, if it rises at `vz`.
    #[inline(always)]
    pub(crate) fn strongest_pull(&self, vz: L) -> L {
        L::splat(1.0) + L::splat(self.drag.linear) * vz.max(L::splat(0.0))
    }

    /// Lower bound of the downward acceleration of the centre from now on; negative if it falls
    /// faster than its terminal velocity.
    #[inline(always)]
    pub(crate) fn weakest_pull(&self, vz: L) -> L {
        if self.drag.linear == 0.0 {
            return L::splat(1.0);
        }
        (L::splat(1.0) + L::splat(self.drag.linear) * vz).min(L::splat(0.0))
    }

    /// The motion at time `t`, at the height where the coin touches the surface, in the folded
    /// frame of that moment. Also the x axis of that frame in the frame of the flight, and whether
    /// the axis was reflected.
    #[inline(always)]
    pub(crate) fn land(&self, m: &Motion<L>, body: &Body, t: L) -> (Motion<L>, [L; 2], L::Mask) {
        let (mut after, x_axis, reflected) = self.at(m, t);
        after.z = after.rest_height(body);
        (after, x_axis, reflected)
    }

    /// The same as [`land`](Self::land), at the height that the coin has.
    #[inline(always)]
    pub(crate) fn at(&self, m: &Motion<L>, t: L) -> (Motion<L>, [L; 2], L::Mask) {
        let zero = L::splat(0.0);
        let (s, c, _) = self.phase(t);
        let (z, vz) = self.fall(t);
        let at = |i: usize| self.state.a[i] + (self.state.b[i] * c + self.state.d[i] * s);
        let (ux, uy, uz) = (at(0), at(1), at(2));
        // |u| is 1 apart from rounding, which must not accumulate over thousands of flights
        let horizontal = ux * ux + uy * uy;
        let scale = L::splat(1.5) - L::splat(0.5) * (horizontal + uz * uz);
        let sin = horizontal.sqrt();
        let reflected = uz.lt(zero);
        let upright = !zero.lt(sin);
        let inverse = L::select(upright, zero, L::splat(1.0) / sin);
        let sign = L::select(reflected, L::splat(-1.0), L::splat(1.0));
        let nx = L::select(upright, L::splat(1.0), ux * inverse * sign);
        let ny = uy * inverse * sign;
        let mut after = *m;
        let mut slow = L::splat(1.0);
        let mut turn = L::splat(1.0);
        if self.drag.acts() {
            slow = velocity_left(self.drag.linear, self.since_start(t));
            turn = self.spin_left(t);
        }
        after.set_tilt(sin * scale, uz.abs() * scale);
        after.vx = m.vx * slow;
        after.vy = m.vy * slow;
        after.vz = vz;
        after.ox = m.ox * turn;
        after.oy = m.oy * turn;
        after.oz = m.oz * turn;
        after.align(nx, ny);
        after.z = z;
        (after, [nx, ny], reflected)
    }

    /// A fraction `share` of the shortest time in which anything can happen at the start of a
    /// flight: turning, toppling, or another point becoming the lowest (the opposite point of the
    /// rim as the tilt vanishes, a point of the other rim as u becomes horizontal).
    #[inline(always)]
    pub(crate) fn short_time(&self, m: &Motion<L>, share: L) -> L {
        let least = L::splat(LEAST_SIN);
        let way = (m.sin * m.cos.max(least)).max(least);
        // share/(1 + w + across/way)
        share * way / ((L::splat(1.0) + self.state.rate) * way + self.state.across)
    }

    /// The fraction of the angular momentum that drag leaves at time `t`.
    #[inline(always)]
    pub(crate) fn spin_left(&self, t: L) -> L {
        if self.drag.angular == 0.0 {
            return L::splat(1.0);
        }
        remains(self.drag.angular, self.since_start(t))
    }

    /// Whether a Newton step of length `step`, with the second-order term, leaves a gap below
    /// 1e-14: its error is of third order, and f''' of the order of the cube of the rates.
    #[inline(always)]
    pub(crate) fn resolves(&self, step: L, sin: L) -> L::Mask {
        const THIRD_ORDER: f64 = 2e-5;
        // the fastest rate times sin
        let fastest = (L::splat(1.0) + self.state.rate) * sin + self.state.across;
        (step.abs() * fastest).lt(L::splat(THIRD_ORDER) * sin)
    }

    /// The horizontal displacement of the centre.
    pub(crate) fn drift(&self, m: &Motion<L>, t: L) -> (L, L) {
        if self.drag.linear == 0.0 {
            return (m.vx * t, m.vy * t);
        }
        let (p, _) = decay(L::splat(self.drag.linear) * t);
        (m.vx * t * p, m.vy * t * p)
    }
}

/// The share of a horizontal velocity that linear drag leaves: e^(−kt), and never less than rounding would
/// leave of it. So what a tilted table adds on the way can be told as a velocity at the start.
#[inline(always)]
pub(crate) fn velocity_left<L: Lane>(k: f64, t: L) -> L {
    const LEAST: f64 = 1e-16;
    remains(k, t).max(L::splat(LEAST))
}

/// e^(−kt).
#[inline(always)]
fn remains<L: Lane>(k: f64, t: L) -> L {
    let x = L::splat(k) * t;
    let (p, _) = decay(x);
    // p is exact apart from rounding for any x; 1 − x p is not, and must not become negative
    (L::splat(1.0) - x * p).max(L::splat(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toss::tests::{launch, model};
    use coinmc_testkit::Dice;
    use nalgebra::Vector3;

    /// A flight whose time is counted from a later instant is the same flight, with drag and without.
    #[test]
    fn a_rebased_orbit_is_the_same_flight() {
        let model = model();
        for number in 0..200 {
            let mut dice = Dice::new(522, number);
            let toss = model.launch(&launch(&mut dice, None));
            let drag = Drag {
                linear: dice.between(-0.5, 0.5).max(0.0),
                angular: dice.between(-0.5, 0.5).max(0.0),
            };
            let whole = Orbit::new(&toss.motion, drag);
            let mut rebased = whole;
            rebased.rebase(9.0, false);
            let mut start = 0.0;
            for _ in 0..2 {
                let t = dice.between(0.0, 2.0);
                rebased.rebase(t, true);
                start += t;
            }
            let after = dice.between(0.0, 2.0);
            let ((z, vz), (there, thence)) = (rebased.fall(after), whole.fall(start + after));
            assert!((z - there).abs() < 1e-12 * (1.0 + there.abs()) && (vz - thence).abs() < 1e-12);
            assert!((rebased.since_start(after) - start - after).abs() < 1e-14);
            let turned = |orbit: &Orbit<f64>, t: f64| {
                let (s, c, rate) = orbit.phase(t);
                let OrbitState { a, b, d, .. } = orbit.state;
                let axis = std::array::from_fn(|i| a[i] + b[i] * c + d[i] * s);
                (axis, rate)
            };
            let ((now, rate), (then, before)) =
                (turned(&rebased, after), turned(&whole, start + after));
            let now: [f64; 3] = now;
            let off = now
                .iter()
                .zip(then)
                .map(|(now, then): (_, f64)| (now - then).abs());
            assert!(off.fold(0.0, f64::max) < 1e-12 * (1.0 + before * start));
            assert!((rate - before).abs() < 1e-13 * before);
        }
    }

    /// The time scales of a flight add up as rates: that of falling, 1, of turning, w, and that at which the axis comes
    /// to the vertical or becomes horizontal, whichever is nearer.
    #[test]
    fn short_steps_are_shorter_than_anything_that_may_happen() {
        let model = model();
        for number in 0..200 {
            let toss = model.launch(&launch(&mut Dice::new(854, number), None));
            let m = &toss.motion;
            let orbit = Orbit::new(m, model.dynamics.drag);
            let about = Vector3::new(m.ox, m.oy, m.oz);
            let speed = about.cross(&Vector3::new(m.sin, 0.0, m.cos)).norm();
            let share = 0.013;
            let rates = share / orbit.short_time(m, share);
            let ways = rates - 1.0 - about.norm();
            assert!((ways / speed - 1.0 / (m.sin * m.cos)).abs() < 1e-9 * rates / speed);
            assert!(rates > speed / m.sin && rates > speed / m.cos);

            // the error of a Newton step is of third order in the step over the shortest of these times
            let fastest = 1.0 + about.norm() + speed / m.sin;
            let step = libm::cbrt(8e-15) / fastest;
            for sign in [1.0, -1.0] {
                assert!(orbit.resolves(0.99 * sign * step, m.sin));
                assert!(!orbit.resolves(1.01 * sign * step, m.sin));
            }
        }
    }

    /// Whatever the speed of the centre and the drag, it is pulled down by no more than the strongest pull and by no less
    /// than the weakest from then on.
    #[test]
    fn the_centre_is_pulled_within_the_bounds() {
        let model = model();
        for number in 0..200 {
            let mut dice = Dice::new(855, number);
            let toss = model.launch(&launch(&mut dice, None));
            let drag = Drag {
                linear: dice.between(-0.7, 0.7).max(0.0),
                angular: 0.0,
            };
            let mut motion = toss.motion;
            motion.vz = dice.between(-3.0, 3.0);
            let orbit = Orbit::new(&motion, drag);
            let (strongest, weakest) = (
                orbit.strongest_pull(motion.vz),
                orbit.weakest_pull(motion.vz),
            );
            for i in 0..50 {
                let t = 0.1 * f64::from(i);
                let pull = (orbit.fall(t).1 - orbit.fall(t + 1e-4).1) / 1e-4;
                assert!(weakest - 1e-9 < pull && pull < strongest + 1e-9, "{pull}");
            }
            let soon = (orbit.fall(0.0).1 - orbit.fall(1e-6).1) / 1e-6;
            assert!(motion.vz < 0.0 || (soon - strongest).abs() < 1e-4);
            // in air the pull dies away: of a coin faster than its terminal velocity it is negative until then
            if drag.linear > 0.0 {
                assert!((soon.min(0.0) - weakest).abs() < 1e-4, "{soon} {weakest}");
            }
        }
    }

    /// The way of the centre is the integral of its velocity, which drag lets decay: (1 − e^(−kt))/k times the velocity.
    #[test]
    fn the_centre_drifts_as_far_as_drag_lets_it() {
        let model = model();
        let mut dice = Dice::new(523, 0);
        let toss = model.launch(&launch(&mut dice, None));
        let m = Motion {
            vx: 0.7,
            vy: -0.4,
            ..toss.motion
        };
        for (linear, t) in [(0.0, 1.7), (0.6, 1.7), (3.0, 0.2)] {
            let drag = Drag {
                linear,
                angular: 0.3,
            };
            let (x, y) = Orbit::new(&m, drag).drift(&m, t);
            let way = if linear == 0.0 {
                t
            } else {
                -libm::expm1(-linear * t) / linear
            };
            assert!((x - 0.7 * way).abs() < 1e-13 && (y + 0.4 * way).abs() < 1e-13);
        }
    }
}
