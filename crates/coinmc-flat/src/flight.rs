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

use crate::motion::Motion;
use crate::shape::Shape;
use coinmc_core::trig::sin_cos;

/// f at which the corner touches, in units of D: above the rounding noise of f (about 3e-16),
/// below anything that matters (an energy of 1e-15 m g D).
const TOUCH: f64 = 1e-15;
/// Evaluations after which a flight is given up. The worst flight of the stress test needs fewer
/// than a fifth.
const MAX_EVALUATIONS: u32 = 2_000;
/// Progress that a departing corner makes at first where every bound is zero to rounding: hops this
/// short (in sqrt(D/g)) stay within `TOUCH` of the surface.
const LEAST_DEPARTURE: f64 = 1e-9;

/// What a search in one quadrant found.
enum Search {
    /// Touches after this time.
    Touch(f64),
    /// The rest of the quadrant is clear.
    Clear,
    /// At this time the centre is above 1 and the coin clear of the surface.
    High(f64),
    /// Out of evaluations, or not a number.
    Lost,
}

/// Flies to the first contact and puts the lowest corner on the surface. `departing`: that corner
/// has just been thrown back or lifted off, and approaches by rounding at most. `false` if the
/// search was lost.
#[inline]
pub(crate) fn fly_to_contact(motion: &mut Motion, shape: &Shape, mut departing: bool) -> bool {
    let mut evaluations = MAX_EVALUATIONS;
    loop {
        if motion.z > 1.0 {
            motion.skip_high(shape);
        }
        let found = search(motion, shape, departing, &mut evaluations);
        departing = false;
        match found {
            Search::Touch(t) => {
                motion.advance(t);
                return true;
            }
            Search::High(t) => motion.advance(t),
            Search::Clear => {
                let left = shape.last_angle(motion.quadrant, motion.omega) - motion.delta;
                motion.advance((left / motion.omega).max(0.0));
                motion.cross_flat(shape, motion.omega > 0.0);
            }
            Search::Lost => return false,
        }
    }
}

#[inline]
fn search(motion: &Motion, shape: &Shape, departing: bool, evaluations: &mut u32) -> Search {
    let omega = motion.omega;
    let end = if omega == 0.0 {
        f64::INFINITY
    } else {
        (shape.last_angle(motion.quadrant, omega) - motion.delta) / omega
    };
    let cos_end = shape.last_height(motion.quadrant, omega);
    let mut t = 0.0;
    let mut least = LEAST_DEPARTURE;
    while *evaluations > 0 {
        *evaluations -= 1;
        let delta = motion.delta + omega * t;
        let (sin, cos) = sin_cos(delta);
        let z = motion.z + t * (motion.vz - 0.5 * t);
        let gap = z - cos;
        let slope = motion.vz - t + omega * sin;
        let rate = if departing && t == 0.0 {
            slope.max(0.0)
        } else {
            slope
        };
        if gap <= TOUCH && rate < 0.0 {
            return Search::Touch(t);
        }
        if z > 1.0 {
            return Search::High(t);
        }
        let bound = 1.0 - omega * omega * cos.min(cos_end);
        let step = if gap <= TOUCH {
            // doubled each time: a corner that neither rises nor falls has no acceleration to
            // speak of, and is left behind in a few steps instead of millions
            least *= 2.0;
            departure(delta, omega, cos, rate, bound).max(least)
        } else {
            lower_bound_step(gap, rate, bound)
        };
        // a step below the resolution of t cannot come nearer to the root
        if t + step == t && rate < 0.0 {
            return Search::Touch(t);
        }
        t += step;
        if t >= end {
            return Search::Clear;
        }
    }
    Search::Lost
}

/// Time to the first root of gap + rate·τ − bound·τ²/2; infinite if there is none.
#[inline]
fn lower_bound_step(gap: f64, rate: f64, bound: f64) -> f64 {
    let discriminant = rate * rate + 2.0 * gap * bound;
    if rate < 0.0 {
        // (√… + rate)/bound in the form that does not cancel
        if discriminant < 0.0 {
            f64::INFINITY
        } else {
            2.0 * gap / (discriminant.sqrt() - rate)
        }
    } else if bound <= 0.0 {
        f64::INFINITY
    } else {
        (rate + discriminant.sqrt()) / bound
    }
}

/// A step away from the surface, for a corner that touches and moves up (or not at all).
///
/// Three bounds hold together; the longest is taken. (1) The quadratic one with gap = 0.
/// (2) While the coin turns towards its balance, cos δ exceeds its present value until the mirror
/// image −δ is reached, so if f'' >= 0 now, f is convex until then. (3) |f'''| <= |ω|³, so
/// f >= At²/2 − |ω|³t³/6 > 0 for t < 3A/|ω|³, A = f''.
fn departure(delta: f64, omega: f64, cos: f64, rate: f64, bound: f64) -> f64 {
    let quadratic = if bound <= 0.0 {
        f64::INFINITY
    } else {
        2.0 * rate / bound
    };
    let upwards = omega * omega * cos - 1.0;
    // at lift-off f'' is zero up to rounding
    let convex = if delta * omega < 0.0 && upwards > -1e-12 {
        -2.0 * delta / omega
    } else {
        0.0
    };
    let cubic = if upwards > 0.0 {
        2.0 * upwards / omega.abs().powi(3)
    } else {
        0.0
    };
    quadratic.max(convex).max(cubic)
}
