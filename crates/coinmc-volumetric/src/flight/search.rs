//! First contact of a flight: the first root of the gap f(t), never missed.
//!
//! # Lower bounds of f: where no root can be
//! f is the smaller of the gaps of the two rims, f_b = z − b h uz − R sin, b = ±1 (h = H/2). From
//! any moment on, with the [`Bounds`] of uz and sin:
//!
//! * sin = √(sin²) is concave in sin², so sin(τ) <= sin + sin'τ + ½(sin²)''_max τ²/(2 sin), and
//!   f_b(τ) >= f_b + f_b'τ − ½M τ²,  M = 1 + h·swing + R·spread/sin. (With drag, the strongest pull
//!   from now on replaces the 1, here and below.)
//! * Where sin is small: sin(τ) <= sin + wander·τ, so
//!   f_b(τ) >= f_b + (f_b' + R sin' − R wander) τ − ½(1 + h·swing) τ².
//! * Where sin is small, also: the horizontal part a of u moves in an almost straight line,
//!   sin(τ) <= |a + a'τ| + ½bend τ². As |a + a'τ| is convex, it lies below its chord over [0, T].
//!   With the slope σ of that chord,
//!   f_b(τ) >= f_b + (f_b' + R sin' − Rσ) τ − ½(1 + h·swing + R·bend) τ² for τ <= T.
//!   This is the best bound for a coin that comes down flat: then u moves along a radius, σ = sin'.
//! * Without drag and while the gap widens: f(τ) >= f' τ + ½f''τ² − J τ³/6, where J bounds |f'''|.
//!   uz''' is at most w·swing. Let V = wander, and let p be the part of a' across a; the part along
//!   a is sin', and p² + sin'² <= V². Differentiating |a| gives sin''' = 3 p a''_p/sin − 3 p²
//!   sin'/sin² + (the part of a''' along a), where |a''| <= wV, |a'''| <= w²V and |p²
//!   sin'| <= 2V³/√27. Until τ = sin/(4V), sin keeps at least ¾ of its value, so J = h w·swing + R
//!   V(w² + (3/¾) wV/sin + (6/√27)(V/(¾ sin))²). For the short flights of a coin that is coming to
//!   rest this bound is very close to f, while the first one is many times too steep. After a
//!   lift-off, where f, f' and f'' vanish together, its steps grow by a constant factor.
//!
//! For each rim the search takes the first root of its best bound, and steps to the earlier of the
//! two. So it never passes a root of f.
//!
//! # Upper bound of f: where a root must be
//! A point of the coin that turns with Ω is accelerated upwards by at most climb = |Ω_h| w D, and
//! no point is ever below the lowest one: f(τ) <= f + f'τ + ½Gτ², G = climb − 1 (with drag, the
//! weakest pull replaces the 1), and f' − Gτ never increases. So once f' < 0 and f'² >= 2fG, f
//! decreases all the way to the root 2f/(√(f'² − 2fG) − f') of that parabola, and has exactly one
//! root before it. From there Newton's method with the second-order term closes in, with bisection
//! where it leaves the bracket.

use super::bounds::{Bounds, Extent};
use super::departure::Departure;
use super::gap::Gap;
use super::orbit::Orbit;
use super::profile::Profile;
use crate::body::Body;
use crate::motion::Motion;
use coinmc_lanes::{Lane, Mask};

/// A gap below this counts as contact, in D: above the rounding of f (about 1e-15), and negligible
/// as an energy (1e-14 m g D).
const TOUCH: f64 = 1e-14;
/// Rounding of the gap's rate of change, relative to the speeds of which it is the difference.
const ROUNDING: f64 = 1e-13;
/// Evaluations after which a search is given up. The hardest flights of the stress test need a
/// tenth.
pub(crate) const MAX_EVALUATIONS: u32 = 20_000;

/// First step away from the surface, as a fraction of the time scale of the coin's fastest motion:
/// for a point that separates by acceleration alone.
const LIFT_OFF_STEP: f64 = 1e-4;
/// The same for a point that rebounds.
const REBOUND_STEP: f64 = 1e-12;

/// A time that never comes.
const NEVER: f64 = 1e30;

/// Where the search ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found<L: Lane> {
    /// Time of first contact.
    pub(crate) time: L,
    /// The search used up its evaluations, or met a NaN.
    pub(crate) gave_up: L::Mask,
}

/// The search, lane by lane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Search<L: Lane> {
    pub(crate) time: L,
    /// Once bracketed, the only root lies between these.
    pub(crate) low: L,
    pub(crate) high: L,
    pub(crate) bracketed: L::Mask,
    pub(crate) active: L::Mask,
    /// Smallest step while a receding point is within rounding of the surface; doubled by each
    /// step.
    pub(crate) least: L,
    /// The search begins at the start of the flight.
    pub(crate) departs: L::Mask,
    /// The flight began as [`Departure::Launched`].
    pub(crate) launched: L::Mask,
}

/// The smallest step while a receding point is within rounding of the surface.
#[inline(always)]
pub(crate) fn least_time<L: Lane>(orbit: &Orbit<L>, motion: &Motion<L>, lifts_off: L::Mask) -> L {
    let share = L::select(lifts_off, L::splat(LIFT_OFF_STEP), L::splat(REBOUND_STEP));
    orbit.short_time(motion, share)
}

/// Finds the first contact of a flight. On return t = 0 of the orbit may have moved: to where the
/// coin was last too high for any contact. `least` comes from [`least_time`].
#[inline(always)]
pub(crate) fn first_contact<L: Lane, P: Profile>(
    orbit: &mut Orbit<L>,
    body: &P,
    departure: Departure,
    least: L,
) -> Found<L> {
    let extent = orbit.extent(body);
    let launched = L::Mask::splat(departure == Departure::Launched);
    let mut search = Search::new(orbit, &extent, launched, least);
    let bounds = orbit.bounds(&extent);
    let mut gap = orbit.first_gap(body);
    for _ in 0..MAX_EVALUATIONS {
        search.step(orbit, body, &bounds, &gap);
        if !search.active.any() {
            break;
        }
        gap = orbit.gap(body, search.time);
    }
    Found {
        time: search.time,
        gave_up: search.active,
    }
}

impl<L: Lane> Search<L> {
    /// A new search. Moves t = 0 of the orbit to where contact first becomes possible.
    #[inline(always)]
    pub(crate) fn new(
        orbit: &mut Orbit<L>,
        extent: &Extent<L>,
        launched: L::Mask,
        least: L,
    ) -> Self {
        let zero = L::splat(0.0);
        let (z, vz) = orbit.fall(zero);
        let skip = high_step(orbit, extent.clear, z, vz);
        let departs = skip.le(zero);
        let skips = zero.lt(skip);
        if skips.any() {
            orbit.rebase(skip, skips);
        }
        Self {
            time: zero,
            departs,
            low: zero,
            high: zero,
            bracketed: L::Mask::splat(false),
            active: L::Mask::splat(true),
            least,
            launched,
        }
    }

    #[inline(always)]
    fn step<P: Profile>(&mut self, orbit: &Orbit<L>, body: &P, bounds: &Bounds<L>, now: &Gap<L>) {
        self.stop_at_contact(now);
        if (self.active & !self.bracketed).any() {
            self.approach(orbit, body, bounds, now);
        }
        self.close_in_on::<P>(orbit, now);
    }

    /// Ends the search of bracketed lanes whose gap is closed.
    #[inline(always)]
    pub(crate) fn stop_at_contact(&mut self, now: &Gap<L>) {
        let touches = self.bracketed & now.height.abs().le(L::splat(TOUCH));
        self.active = self.active & !touches;
    }

    /// For lanes without a bracket: finds a contact or a bracket, or takes a step that passes no
    /// root.
    #[inline(always)]
    pub(crate) fn approach(
        &mut self,
        orbit: &Orbit<L>,
        body: &impl Profile,
        bounds: &Bounds<L>,
        now: &Gap<L>,
    ) {
        let (zero, touch) = (L::splat(0.0), L::splat(TOUCH));
        let open = self.active & !self.bracketed;
        let falls = now.slope.lt(zero);
        let sinks = now
            .slope
            .lt(-(L::splat(ROUNDING) * (now.vz.abs() + bounds.wander)));
        let near = open & now.height.le(touch);
        // a point that has just rebounded sinks by rounding at most
        let rebounds = !sinks | (self.departs & self.time.le(zero));
        let recedes = near & ((self.launched & !falls) | (!self.launched & rebounds));
        self.active = self.active & !(near & !recedes);
        self.bracket(orbit, bounds, now, open & falls & !recedes & self.active);
        let free = open & self.active & !self.bracketed;
        if free.any() {
            let (mut own, other) = lower_bound_steps(orbit, body, bounds, now);
            let lingers = recedes & free;
            if lingers.any() {
                let short = lingers & own.lt(self.least);
                if short.any() {
                    // not beyond where the opposite point of the rim may touch instead
                    let (_, until) = chord(now);
                    own = L::select(short, own.max(self.least.min(until)), own);
                }
                self.least = L::select(lingers, self.least + self.least, self.least);
            }
            let step = own
                .min(other)
                .max(high_step(orbit, bounds.clear, now.z, now.vz));
            self.advance(step, free);
        }
    }

    /// Sets the bracket of lanes whose root is certain and unique from here on.
    #[inline(always)]
    fn bracket(&mut self, orbit: &Orbit<L>, bounds: &Bounds<L>, now: &Gap<L>, falls: L::Mask) {
        let two = L::splat(2.0);
        let climb = bounds.climb - orbit.weakest_pull(now.vz);
        let square = now.slope * now.slope;
        let discriminant = square - two * now.height * climb;
        let newly = falls & !self.bracketed & L::splat(0.0).le(discriminant);
        if newly.any() {
            let last = two * now.height / (discriminant.max(L::splat(0.0)).sqrt() - now.slope);
            self.low = L::select(newly, self.time, self.low);
            // the parabola's root, rounded up
            let high = self.time + last * L::splat(1.0 + 1e-12) + L::splat(1e-300);
            self.high = L::select(newly, high, self.high);
            self.bracketed = self.bracketed | newly;
        }
    }

    /// For lanes with a bracket: one Newton step with the second-order term, kept within the
    /// bracket.
    #[inline(always)]
    pub(crate) fn close_in(&mut self, orbit: &Orbit<L>, now: &Gap<L>) {
        self.close_in_on::<Body>(orbit, now);
    }

    /// The same for any shape.
    #[inline(always)]
    fn close_in_on<P: Profile>(&mut self, orbit: &Orbit<L>, now: &Gap<L>) {
        let lanes = self.bracketed & self.active;
        if !lanes.any() {
            return;
        }
        let above = L::splat(0.0).lt(now.height);
        self.low = L::select(lanes & above, self.time, self.low);
        self.high = L::select(lanes & !above, self.time, self.high);
        let step = first_root(now.height, now.slope, -now.curvature);
        let next = self.time + step;
        // strictly inside: going from one end to the other and back would never end
        let inside = self.low.lt(next) & next.lt(self.high);
        let middle = L::splat(0.5) * (self.low + self.high);
        let next = L::select(inside, next, middle);
        // the resolution of time is reached: no number lies between, or the time does not change
        let closed = middle.le(self.low) | self.high.le(middle);
        let same = next.le(self.time) & self.time.le(next);
        // the gap has a kink where u becomes horizontal and the other rim the lowest: a step beyond
        // it has followed the wrong rim
        let one_rim = if P::ALONE {
            L::Mask::splat(true)
        } else {
            L::splat(0.0).le(now.uz * (now.uz + now.uz_rate * step))
        };
        let resolved = inside & one_rim & orbit.resolves(step, now.sin);
        let done = lanes & (closed | same | resolved);
        self.active = self.active & !done;
        self.time = L::select(lanes, L::select(closed, self.low, next), self.time);
    }

    #[inline(always)]
    fn advance(&mut self, step: L, lanes: L::Mask) {
        let next = self.time + step;
        // a step below the resolution of time comes no closer to the root
        let no_progress = lanes & next.le(self.time);
        self.active = self.active & !no_progress;
        self.time = L::select(lanes, next, self.time);
    }
}

/// Time for which the centre certainly stays too high for any contact; 0 if it is not too high.
#[inline(always)]
fn high_step<L: Lane>(orbit: &Orbit<L>, clear: L, z: L, vz: L) -> L {
    let zero = L::splat(0.0);
    let excess = z - clear;
    let high = zero.lt(excess);
    if !high.any() {
        return zero;
    }
    L::select(high, first_root(excess, vz, orbit.strongest_pull(vz)), zero)
}

/// Times for which the gaps of the lowest rim and of the other certainly stay positive.
#[inline(always)]
fn lower_bound_steps<L: Lane, P: Profile>(
    orbit: &Orbit<L>,
    body: &P,
    bounds: &Bounds<L>,
    now: &Gap<L>,
) -> (L, L) {
    const SMALL: f64 = 0.05;
    let (radius, half) = (L::splat(body.radius()), L::splat(body.half()));
    let inverse = L::splat(1.0) / now.sin;
    // negative by rounding at most
    let gap = now.height.max(L::splat(0.0));
    let across = half * bounds.swing + orbit.strongest_pull(now.vz);
    let bend = across + radius * bounds.spread * inverse;
    let rims = Rims {
        gap,
        // the other rim is higher by the vertical extent of the coin's thickness
        rise: L::splat(2.0) * half * now.uz.abs(),
        climb: L::splat(2.0) * half * now.uz_rate * L::splat(1.0).copysign(now.uz),
    };
    let (mut own, other) = rims.steps::<P>(now.slope, bend);
    if !orbit.is_dragged() {
        own = own.max(widening_step(body, bounds, now, inverse));
    }
    let flat = now.sin.lt(L::splat(SMALL));
    if !flat.any() {
        return (own, other);
    }
    // without the part of sin', which these bounds replace
    let bare = now.slope + radius * now.sin_rate;
    let coarse = rims.steps::<P>(bare - radius * bounds.wander, across);
    let (chord, until) = chord(now);
    let straight = rims.steps::<P>(bare - radius * chord, across + radius * bounds.bend);
    (
        L::select(flat, own.max(coarse.0).max(straight.0.min(until)), own),
        L::select(flat, other.max(coarse.1).max(straight.1.min(until)), other),
    )
}

/// Time for which a widening gap of the lowest rim certainly stays open, from its curvature now and
/// the bound of its third derivative. 0 if the gap does not widen.
#[inline(always)]
fn widening_step<L: Lane>(
    body: &impl Profile,
    bounds: &Bounds<L>,
    now: &Gap<L>,
    inverse_sin: L,
) -> L {
    let zero = L::splat(0.0);
    let (jerk, until) = bounds.jerk(body, now.sin, inverse_sin);
    let (curvature, bend) = (L::splat(0.5) * now.curvature, L::splat(1.0 / 3.0) * jerk);
    let step = first_root(now.slope, curvature, bend).min(until);
    L::select(zero.le(now.slope), step, zero)
}

/// The gap of the lowest rim, how much higher the other rim is, and how fast that difference grows.
struct Rims<L> {
    gap: L,
    rise: L,
    climb: L,
}

impl<L: Lane> Rims<L> {
    /// For each rim, the time until a gap with this rate of change and bend has closed.
    #[inline(always)]
    fn steps<P: Profile>(&self, slope: L, bend: L) -> (L, L) {
        let own = first_root(self.gap, slope, bend);
        if P::ALONE {
            return (own, L::splat(NEVER));
        }
        let other = first_root(self.gap + self.rise, slope + self.climb, bend);
        (own, other)
    }
}

/// Slope of the chord of |a + a'τ| over the first half of the way to the vertical, and its
/// duration.
#[inline(always)]
fn chord<L: Lane>(now: &Gap<L>) -> (L, L) {
    let ([x, y], [vx, vy]) = (now.across, now.across_rate);
    let speed = (vx * vx + vy * vy).sqrt().max(L::splat(1e-30));
    let until = L::splat(0.5) * now.sin / speed;
    let (dx, dy) = (x + vx * until, y + vy * until);
    // rounded up, as the difference loses digits
    let rounding = L::splat(1e-15) * now.sin;
    let end = (dx * dx + dy * dy).sqrt();
    ((end - now.sin + rounding) / until, until)
}

/// The first time t at which gap + slope·t − ½ bend t² crosses 0 downwards, or 1e30 if it never
/// does. (With gap < 0 < −slope the crossing lies in the past, and t < 0.)
///
/// Each form of the root loses no digits where it is used: (√… + slope)/bend for slope >= 0, and
/// 2 gap/(√… − slope) for slope < 0.
#[inline(always)]
fn first_root<L: Lane>(gap: L, slope: L, bend: L) -> L {
    let zero = L::splat(0.0);
    let discriminant = slope * slope + L::splat(2.0) * gap * bend;
    let real = zero.le(discriminant);
    let root = discriminant.max(zero).sqrt();
    let rises = zero.le(slope);
    let numerator = L::select(rises, slope + root, L::splat(2.0) * gap);
    let denominator = L::select(rises, bend, root - slope);
    let exists = real & zero.lt(denominator);
    L::select(exists, numerator / denominator, L::splat(NEVER))
}

#[cfg(test)]
mod tests;
