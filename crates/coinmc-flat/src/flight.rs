//! First contact of a flight: the first root of f(t) = z(t) − cos δ(t), never missed.
//!
//! Within a quadrant one corner is lowest, δ = δ₀ + ωt and z is a parabola, so
//! f'' = −1 + ω² cos δ. As cos δ is concave there, it is nowhere below the smaller of its values
//! at the two ends of what is left of the quadrant:
//!
//! f'' >= −M,  M = 1 − ω² min(cos δ, cos δ_end).
//!
//! Hence f(t + τ) >= f + f'τ − Mτ²/2, and stepping to the root of this lower bound never passes
//! a root of f. Near a root the step is Newton's with a second-order correction: it converges
//! quadratically, from the left. No bracket and no sampling is needed.
//!
//! All of it is written over lanes: one flight, or eight side by side.

use crate::motion::Motion;
use crate::shape::Shape;
use coinmc_lanes::{Lane, Mask, sin_cos};

/// f at which the corner touches, in units of D: above the rounding noise of f (about 3e-16),
/// below anything that matters (an energy of 1e-15 m g D).
const TOUCH: f64 = 1e-15;
/// Evaluations after which a flight is given up. The worst flight of the stress test needs fewer
/// than a fifth.
pub(crate) const MAX_EVALUATIONS: u32 = 2_000;
/// Progress that a departing corner makes at first where every bound is zero to rounding: hops this
/// short (in sqrt(D/g)) stay within `TOUCH` of the surface. Doubled each time: a corner that
/// neither rises nor falls has no acceleration to speak of, and is left behind in a few steps
/// instead of millions.
pub(crate) const LEAST_DEPARTURE: f64 = 1e-9;

/// What is left of a quadrant, in flight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Arc<L> {
    /// The quadrant, as a number.
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

/// What the search sees at one instant.
pub(crate) struct Look<L: Lane> {
    /// The corner touches.
    pub(crate) touches: L::Mask,
    /// The centre is above 1, and the coin clear of the surface.
    pub(crate) high: L::Mask,
    /// Where neither, the instant until which the coin does not touch.
    pub(crate) next: L,
}

/// Flies to the first contact and puts the lowest corner on the surface. `departing`: that corner
/// has just been thrown back or lifted off, and approaches by rounding at most. `false` if the
/// search was lost.
#[inline]
pub(crate) fn fly_to_contact(motion: &mut Motion, shape: &Shape, mut departing: bool) -> bool {
    let mut arc = motion.arc(shape);
    let mut pass = |t: f64| {
        motion.x += motion.vx * t;
        motion.time += t;
    };
    let mut evaluations = MAX_EVALUATIONS;
    let found = 'flight: loop {
        if arc.z > 1.0 {
            let skipped = arc.high_time();
            pass(skipped);
            arc = arc.skip_high(shape, skipped);
        }
        let (mut t, mut least) = (0.0, LEAST_DEPARTURE);
        while evaluations > 0 {
            evaluations -= 1;
            let look = arc.look(t, departing && t == 0.0, &mut least);
            if look.touches || look.high {
                pass(t);
                arc.advance(t);
            }
            if look.touches {
                break 'flight true;
            }
            if look.high {
                departing = false;
                continue 'flight;
            }
            t = look.next;
            if t >= arc.end {
                pass(arc.clear_time());
                arc = arc.cross(shape);
                departing = false;
                continue 'flight;
            }
        }
        break false;
    };
    motion.set_flight(&arc);
    found
}

impl<L: Lane> Arc<L> {
    /// From here to the quadrant's end.
    #[inline(always)]
    pub(crate) fn new(shape: &Shape, quadrant: L, [delta, omega, z, vz]: [L; 4]) -> Self {
        let (last, cos_end) = shape.last(quadrant, omega);
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

    /// One evaluation, a time `t` from the beginning. `departs`: the corner leaves the surface,
    /// and approaches by rounding at most.
    #[inline(always)]
    pub(crate) fn look(&self, t: L, departs: L::Mask, least: &mut L) -> Look<L> {
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
            return Look {
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
        Look {
            touches: touches | stuck,
            high,
            next,
        }
    }

    /// The first evaluation of a corner that has just been thrown back, whose sine and cosine are
    /// known: how far it departs, as [`look`](Self::look) with a gap of zero.
    #[inline(always)]
    pub(crate) fn depart(&self, sin: L, cos: L) -> L {
        let rate = (self.vz + self.omega * sin).max(L::splat(0.0));
        let away = departure(self.delta, self.omega, cos, rate, self.bound(cos));
        away.max(L::splat(2.0 * LEAST_DEPARTURE))
    }

    /// M for what is left of the quadrant.
    #[inline(always)]
    fn bound(&self, cos: L) -> L {
        L::splat(1.0) - self.omega * self.omega * cos.min(self.cos_end)
    }

    /// Flight for `t`, within the quadrant; its end is not looked at again.
    #[inline(always)]
    pub(crate) fn advance(&mut self, t: L) {
        self.z += t * (self.vz - L::splat(0.5) * t);
        self.vz -= t;
        self.delta += self.omega * t;
    }

    /// Time to the quadrant's end, if it has one.
    #[inline(always)]
    pub(crate) fn clear_time(&self) -> L {
        self.end.max(L::splat(0.0))
    }

    /// At the beginning of the next quadrant, with nothing touched in this one.
    #[inline(always)]
    pub(crate) fn cross(&self, shape: &Shape) -> Self {
        let t = self.clear_time();
        let z = self.z + t * (self.vz - L::splat(0.5) * t);
        let vz = self.vz - t;
        let (last, _) = shape.last(self.quadrant, self.omega);
        let on = self.quadrant + L::splat(1.0).copysign(self.omega);
        // it begins where the other ended, seen from its own corner
        Self::new(shape, within_four(on), [-last, self.omega, z, vz])
    }

    /// Above z = 1 nothing can touch: time to where the centre comes down to 1.
    #[inline(always)]
    pub(crate) fn high_time(&self) -> L {
        let above = L::splat(2.0) * (self.z - L::splat(1.0));
        self.vz + (self.vz * self.vz + above).sqrt()
    }

    /// Where the centre comes down to 1, after `t`: through any number of quadrants.
    #[inline(always)]
    pub(crate) fn skip_high(&self, shape: &Shape, t: L) -> Self {
        let angle = self.delta + shape.first(self.quadrant) + self.omega * t;
        let (quadrant, delta) = shape.enter(self.quadrant, angle);
        let (z, vz) = (L::splat(1.0), self.vz - t);
        Self::new(shape, quadrant, [delta, self.omega, z, vz])
    }
}

/// A quadrant's number from −1 to 4, back among the four.
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
    // (√… + rate)/bound, for a corner that falls in the form that does not cancel
    let over = L::select(falls, L::splat(2.0) * gap, rate + root);
    let under = L::select(falls, root - rate, bound);
    let none = falls & discriminant.lt(zero) | !falls & bound.le(zero);
    L::select(none, L::splat(f64::INFINITY), over / under)
}

/// A step away from the surface, for a corner that touches and moves up (or not at all).
///
/// Three bounds hold together; the longest is taken. (1) The quadratic one with gap = 0.
/// (2) While the coin turns towards its balance, cos δ exceeds its present value until the mirror
/// image −δ is reached, so if f'' >= 0 now, f is convex until then. (3) |f'''| <= |ω|³, so
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
