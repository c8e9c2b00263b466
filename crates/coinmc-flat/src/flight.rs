//! First contact of a flight: the first root of f(t) = z(t) − cos δ(t), never missed.
//!
//! Within a quadrant one corner is lowest, δ = δ₀ + ωt and z is a parabola, so
//! f'' = −1 + ω² cos δ. As cos δ is concave there, it is nowhere below the smaller of its values
//! now and at the end of the quadrant:
//!
//! f'' >= −M,  M = 1 − ω² min(cos δ, cos δ_end).
//!
//! Hence f(t + τ) >= f + f'τ − Mτ²/2, and stepping to the root of this lower bound never passes
//! a root of f. Near a root the step is Newton's with a second-order correction: it converges
//! quadratically, from the left. Neither a bracket nor sampling is needed.
//!
//! All formulas are written over lanes: for one flight, or for one flight per lane.

use crate::motion::Motion;
use crate::shape::{Shape, as_quadrant};
use coinmc_lanes::{Lane, Mask, sin_cos};

/// The corner touches where f is below this, in units of D: above the rounding noise of f (about
/// 3e-16), and irrelevant to the motion (an energy of 1e-15 m g D).
const TOUCH: f64 = 1e-15;
/// Evaluations after which a flight is given up. The worst flight of the stress test needs fewer
/// than a fifth.
pub(crate) const MAX_EVALUATIONS: u32 = 2_000;
/// The first step of a departing corner where every bound is zero to rounding: a coin that hops for
/// so short a time (in sqrt(D/g)) stays within `TOUCH` of the surface. The step doubles each time,
/// because a corner that neither rises nor falls has hardly any acceleration: a few steps instead
/// of millions leave it behind.
pub(crate) const LEAST_DEPARTURE: f64 = 1e-9;

/// A flight from its present state to the end of the quadrant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FlightSegment<L> {
    /// The quadrant, as a floating-point number.
    pub(crate) quadrant: L,
    pub(crate) delta: L,
    pub(crate) omega: L,
    pub(crate) z: L,
    pub(crate) vz: L,
    /// Time to the quadrant's end.
    pub(crate) end: L,
    /// Height of the centre when flat there.
    pub(crate) cos_end: L,
}

/// One evaluation of the search for contact.
pub(crate) struct Evaluation<L: Lane> {
    /// The corner touches.
    pub(crate) touches: L::Mask,
    /// The centre is above 1, and the coin clear of the surface.
    pub(crate) high: L::Mask,
    /// Otherwise: the instant until which the coin does not touch.
    pub(crate) next: L,
}

/// Flies to the first contact and puts the lowest corner on the surface. `departing`: this corner
/// has just rebounded or lifted off, so that it approaches by rounding at most. `false` if the
/// search ran out of evaluations.
#[inline]
pub(crate) fn fly_to_contact(motion: &mut Motion, shape: &Shape, mut departing: bool) -> bool {
    let mut flight = FlightSegment::of(motion, shape);
    let mut pass = |t: f64| {
        motion.x += motion.vx * t;
        motion.time += t;
    };
    let mut evaluations = MAX_EVALUATIONS;
    let found = 'search: loop {
        if flight.z > 1.0 {
            let skipped = flight.high_time();
            pass(skipped);
            flight = flight.skip_high(shape, skipped);
        }
        let (mut t, mut least) = (0.0, LEAST_DEPARTURE);
        while evaluations > 0 {
            evaluations -= 1;
            let evaluation = flight.evaluate(t, departing && t == 0.0, &mut least);
            if evaluation.touches || evaluation.high {
                pass(t);
                flight.advance(t);
            }
            if evaluation.touches {
                break 'search true;
            }
            if evaluation.high {
                departing = false;
                continue 'search;
            }
            t = evaluation.next;
            if t >= flight.end {
                pass(flight.time_to_end());
                flight = flight.cross(shape);
                departing = false;
                continue 'search;
            }
        }
        break false;
    };
    flight.write_to(motion);
    found
}

impl FlightSegment<f64> {
    #[inline]
    pub(crate) fn of(motion: &Motion, shape: &Shape) -> Self {
        let state = [motion.delta, motion.omega, motion.z, motion.vz];
        Self::new(shape, f64::from(motion.quadrant), state)
    }

    /// Sets the motion to the segment's start, except for what is constant in flight.
    #[inline]
    pub(crate) fn write_to(&self, motion: &mut Motion) {
        motion.quadrant = as_quadrant(self.quadrant);
        (motion.delta, motion.z, motion.vz) = (self.delta, self.z, self.vz);
    }
}

impl<L: Lane> FlightSegment<L> {
    /// From this state (δ, ω, z, v_z) to the quadrant's end.
    #[inline(always)]
    pub(crate) fn new(shape: &Shape, quadrant: L, [delta, omega, z, vz]: [L; 4]) -> Self {
        let (last, cos_end) = shape.quadrant_end(quadrant, omega);
        let still = omega.le(L::splat(0.0)) & L::splat(0.0).le(omega);
        let end = (last - delta) / omega;
        Self {
            quadrant,
            delta,
            omega,
            z,
            vz,
            end: L::select(still, L::splat(f64::INFINITY), end),
            cos_end,
        }
    }

    /// One evaluation of the search, at time `t` from the start of the segment. `departs`: the
    /// corner leaves the surface, so that it approaches by rounding at most. `least` is the least
    /// step of a departing corner.
    #[inline(always)]
    pub(crate) fn evaluate(&self, t: L, departs: L::Mask, least: &mut L) -> Evaluation<L> {
        let (zero, touch) = (L::splat(0.0), L::splat(TOUCH));
        let delta = self.delta + self.omega * t;
        let (sin, cos) = sin_cos(delta);
        let z = self.z + t * (self.vz - L::splat(0.5) * t);
        let gap = z - cos;
        let slope = self.vz - t + self.omega * sin;
        let rate = L::select(departs, slope.max(zero), slope);
        let (near, falls) = (gap.le(touch), rate.lt(zero));
        let touches = near & falls;
        let high = L::splat(1.0).lt(z) & !touches;
        if !(!(touches | high)).any() {
            return Evaluation {
                touches,
                high,
                next: t,
            };
        }
        let bound = self.bound(cos);
        let grazes = near & !falls & !high;
        let mut step = zero;
        if (!grazes).any() {
            step = lower_bound_step(gap, rate, bound);
        }
        if grazes.any() {
            *least = L::select(grazes, L::splat(2.0) * *least, *least);
            let away = departure(delta, self.omega, cos, rate, bound);
            step = L::select(grazes, away.max(*least), step);
        }
        let next = t + step;
        // a step below the resolution of t cannot come nearer to the root
        let stuck = next.le(t) & t.le(next) & falls & !high;
        Evaluation {
            touches: touches | stuck,
            high,
            next,
        }
    }

    /// The first step of a corner that has just rebounded, given sine and cosine of its angle: as
    /// [`evaluate`](Self::evaluate) with a gap of zero.
    #[inline(always)]
    pub(crate) fn first_step(&self, sin: L, cos: L) -> L {
        let rate = (self.vz + self.omega * sin).max(L::splat(0.0));
        let away = departure(self.delta, self.omega, cos, rate, self.bound(cos));
        away.max(L::splat(2.0 * LEAST_DEPARTURE))
    }

    /// M for the rest of the quadrant.
    #[inline(always)]
    fn bound(&self, cos: L) -> L {
        L::splat(1.0) - self.omega * self.omega * cos.min(self.cos_end)
    }

    /// Flies for `t` within the quadrant. The time to its end is not updated.
    #[inline(always)]
    pub(crate) fn advance(&mut self, t: L) {
        self.z += t * (self.vz - L::splat(0.5) * t);
        self.vz -= t;
        self.delta += self.omega * t;
    }

    /// Time to the quadrant's end.
    #[inline(always)]
    pub(crate) fn time_to_end(&self) -> L {
        self.end.max(L::splat(0.0))
    }

    /// The segment that begins at the next quadrant, if nothing touches in this one.
    #[inline(always)]
    pub(crate) fn cross(&self, shape: &Shape) -> Self {
        let t = self.time_to_end();
        let z = self.z + t * (self.vz - L::splat(0.5) * t);
        let vz = self.vz - t;
        let (last, _) = shape.quadrant_end(self.quadrant, self.omega);
        let on = self.quadrant + L::splat(1.0).copysign(self.omega);
        // the next quadrant begins where this one ends, measured from its own corner
        Self::new(shape, within_four(on), [-last, self.omega, z, vz])
    }

    /// Time until the centre comes down to z = 1, above which nothing can touch.
    #[inline(always)]
    pub(crate) fn high_time(&self) -> L {
        let above = L::splat(2.0) * (self.z - L::splat(1.0));
        self.vz + (self.vz * self.vz + above).sqrt()
    }

    /// The segment that begins where the centre comes down to z = 1, after `t` and any number of
    /// quadrants.
    #[inline(always)]
    pub(crate) fn skip_high(&self, shape: &Shape, t: L) -> Self {
        let angle = self.delta + shape.first_span_lanes(self.quadrant) + self.omega * t;
        let (quadrant, delta) = shape.enter(self.quadrant, angle);
        let (z, vz) = (L::splat(1.0), self.vz - t);
        Self::new(shape, quadrant, [delta, self.omega, z, vz])
    }
}

/// A quadrant number from −1 to 4, reduced to 0 to 3.
#[inline(always)]
fn within_four<L: Lane>(quadrant: L) -> L {
    let (zero, four) = (L::splat(0.0), L::splat(4.0));
    let below = L::select(quadrant.lt(zero), quadrant + four, quadrant);
    L::select(four.le(below), below - four, below)
}

/// Time to the first root of gap + rate·τ − bound·τ²/2; infinite if there is none.
#[inline(always)]
fn lower_bound_step<L: Lane>(gap: L, rate: L, bound: L) -> L {
    let zero = L::splat(0.0);
    let discriminant = rate * rate + L::splat(2.0) * gap * bound;
    let root = discriminant.sqrt();
    let falls = rate.lt(zero);
    // (√… + rate)/bound; for a falling corner in the form without cancellation
    let over = L::select(falls, L::splat(2.0) * gap, rate + root);
    let under = L::select(falls, root - rate, bound);
    let none = falls & discriminant.lt(zero) | !falls & bound.le(zero);
    L::select(none, L::splat(f64::INFINITY), over / under)
}

/// A step away from the surface, for a corner that touches and moves up (or not at all).
///
/// Each of three bounds on the step holds, so the longest is used. (1) The quadratic one with
/// gap = 0. (2) While the coin turns towards its balance, cos δ exceeds its present value until the
/// mirror image −δ is reached; so if f'' >= 0 now, f is convex until then. (3) |f'''| <= |ω|³, so
/// f >= At²/2 − |ω|³t³/6 > 0 for t < 3A/|ω|³, A = f''.
#[inline(always)]
fn departure<L: Lane>(delta: L, omega: L, cos: L, rate: L, bound: L) -> L {
    let (zero, two) = (L::splat(0.0), L::splat(2.0));
    let quadratic = L::select(bound.le(zero), L::splat(f64::INFINITY), two * rate / bound);
    let upwards = omega * omega * cos - L::splat(1.0);
    // at lift-off f'' is zero up to rounding
    let towards = (delta * omega).lt(zero) & L::splat(-1e-12).lt(upwards);
    let mut longest = quadratic;
    if towards.any() {
        let convex = L::select(towards, -two * delta / omega, zero);
        longest = longest.max(convex);
    }
    let accelerates = zero.lt(upwards);
    if accelerates.any() {
        let rate = omega.abs();
        let cubic = two * upwards / (rate * rate * rate);
        longest = longest.max(L::select(accelerates, cubic, zero));
    }
    longest
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_testkit::scene;

    /// A flight that is no number never touches: it ends when its evaluations are used up.
    #[test]
    fn a_flight_that_finds_no_contact_is_given_up() {
        let shape = Shape::new(&scene(1.0, 0.5, 0.3).coin);
        let mut motion = Motion {
            quadrant: 0,
            delta: -0.2,
            omega: 0.1,
            x: 0.0,
            z: f64::NAN,
            vx: 0.0,
            vz: 0.0,
            time: 0.0,
        };
        assert!(!fly_to_contact(&mut motion, &shape, false));
    }

    /// A corner that lifts off has f'' = 0 up to rounding, on either side: while the coin turns towards its balance
    /// it stays clear as far as the mirror image of its angle.
    #[test]
    fn a_corner_that_lifts_off_stays_clear_up_to_the_mirrored_angle() {
        let (delta, cos) = (-0.3, libm::cos(0.3));
        for rounding in [-1e-13, 1e-13] {
            for sign in [1.0, -1.0] {
                let omega = ((1.0 + rounding) / cos).sqrt();
                let bound = 1.0 - omega * omega * 0.5;
                let step = departure(sign * delta, sign * omega, cos, 0.0, bound);
                assert_eq!(step, 0.6 / omega);
            }
        }
        // one that would fall in again has no such bound
        let omega = (0.99_f64 / cos).sqrt();
        assert_eq!(departure(delta, omega, cos, 0.0, 0.5), 0.0);
    }

    /// Above the height of a corner nothing touches, whichever way it moves; a corner at the surface that comes down
    /// does; and then there is nothing to look for.
    #[test]
    fn what_is_high_or_touches_needs_no_next_step() {
        let shape = Shape::new(&scene(1.0, 0.5, 0.3).coin);
        let at = |z: f64, vz: f64| {
            let segment = FlightSegment::new(&shape, 0.0, [-0.2, 0.1, z, vz]);
            let found = segment.evaluate(0.0, false, &mut 1e-3);
            (found.touches, found.high, found.next)
        };
        let corner = libm::cos(0.2);
        assert_eq!(at(1.5, -1.0), (false, true, 0.0));
        assert_eq!(at(1.5, 1.0), (false, true, 0.0));
        assert_eq!(at(corner, -1.0), (true, false, 0.0));
        let (touches, high, next) = at(0.5 * (1.0 + corner), -1.0);
        assert!(!touches && !high && next > 0.0);
    }
}
