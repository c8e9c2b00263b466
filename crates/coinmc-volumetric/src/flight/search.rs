//! First contact of a flight: the first root of the gap f(t), never missed.
//!
//! # Below: where no root can be
//! f is the smaller of the two rims' gaps f_b = z − b h uz − R sin, b = ±1 (h = H/2). From any
//! moment on, with what [`Bounds`](super::orbit::Bounds) says of uz and sin:
//!
//! * sin = √(sin²) is concave in sin², so sin(τ) <= sin + sin'τ + ½(sin²)''_max τ²/(2 sin), and
//!   f_b(τ) >= f_b + f_b'τ − ½M τ²,  M = 1 + h·swing + R·spread/sin (with drag, the strongest
//!   pull from now on takes the place of 1, here and below);
//! * where sin is small: sin(τ) <= sin + wander·τ, so
//!   f_b(τ) >= f_b + (f_b' + R sin' − R wander) τ − ½(1 + h·swing) τ²;
//! * there too: the horizontal part a of u moves almost straight, sin(τ) <= |a + a'τ| + ½bend τ²,
//!   and as |a + a'τ| is convex it lies below its chord over [0, T]: with the chord's slope σ,
//!   f_b(τ) >= f_b + (f_b' + R sin' − Rσ) τ − ½(1 + h·swing + R·bend) τ² for τ <= T.
//!   This is the one for a coin that claps down flat: its u comes in along a radius, σ = sin'.
//! * without drag, a gap that widens is followed by its curvature: f(τ) >= f' τ + ½f''τ² − J τ³/6
//!   with J no less than |f'''| until then. uz''' is at most w·swing. With V = wander, the part of
//!   a' along a being sin' and the part across p, p² + sin'² <= V², differentiation of |a| gives
//!   sin''' = 3 p a''_p/sin − 3 p² sin'/sin² + a''' along a, where |a''| <= wV, |a'''| <= w²V and
//!   |p² sin'| <= 2V³/√27. Until τ = sin/(4V) sin is no less than ¾ of what it is, so
//!   J = h w·swing + R V(w² + (3/¾) wV/sin + (6/√27)(V/(¾ sin))²). For the short flights of a coin
//!   that comes to rest this bound is all but f itself, where the first is many times too steep;
//!   after lift-off, where f, f' and f'' vanish together, its steps grow by a constant factor.
//!
//! The search steps to the first root of the best bound of the worse rim: no root is passed.
//!
//! # Above: where one must be
//! A point of the coin that turns with Ω is accelerated upwards by at most
//! climb = |Ω_h| w D, and no point is ever below the lowest: f(τ) <= f + f'τ + ½Gτ²,
//! G = climb − 1 (with drag, less the weakest pull instead), and f' − Gτ never grows. So once
//! f' < 0 and f'² >= 2fG, f falls all the way to the root 2f/(√(f'² − 2fG) − f') of that parabola,
//! with exactly one root of f before it. From there, Newton's method with the second-order term
//! closes in, bisecting where it leaves the bracket.

use super::orbit::{Bounds, Extent, Gap, Orbit};
use crate::body::Body;
use crate::motion::Motion;
use coinmc_lanes::{Lane, Mask};

/// Gap that counts as touching, in D: above the rounding of f (about 1e-15), below anything that
/// matters (an energy of 1e-14 m g D).
const TOUCH: f64 = 1e-14;
/// Rounding of the gap's rate of change, relative to the speeds it is the difference of.
const ROUNDING: f64 = 1e-13;
/// Evaluations after which a flight is given up. The worst of the stress test need a tenth.
pub(super) const MAX_EVALUATIONS: u32 = 20_000;

/// A short time against every motion of the coin, times its fastest rate: a point that parts from
/// the surface by acceleration is followed from there.
const PARTING: f64 = 1e-4;
/// The same for one that was thrown back.
const THROWN: f64 = 1e-12;

/// How the flight begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Departure {
    /// Clear of the surface, or anywhere.
    Launched,
    /// The lowest point was just thrown back or lifted off: it does not approach, but for rounding.
    Leaving,
}

/// Where the search ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found<L: Lane> {
    /// Time of first contact.
    pub(crate) time: L,
    /// Out of evaluations, or not a number.
    pub(crate) lost: L::Mask,
}

/// The search, lane by lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search<L: Lane> {
    pub(super) time: L,
    /// Once bracketed, the only root lies between these.
    pub(super) low: L,
    pub(super) high: L,
    pub(super) bracketed: L::Mask,
    pub(super) active: L::Mask,
    /// Progress enforced while a leaving point is within rounding of the surface; it doubles.
    pub(super) least: L,
    /// The search begins where the flight does.
    pub(super) departs: L::Mask,
    /// [`Departure::Launched`].
    pub(super) launched: L::Mask,
}

/// Progress that the search makes where a leaving point is within rounding of the surface.
#[inline(always)]
pub(crate) fn least_time<L: Lane>(orbit: &Orbit<L>, motion: &Motion<L>, parting: L::Mask) -> L {
    let share = L::select(parting, L::splat(PARTING), L::splat(THROWN));
    orbit.moment(motion, share)
}

/// Time of the first contact of a flight, counted as the orbit counts it on return: from where the
/// coin was last too high for any contact. `least` is a time short against every motion of the coin.
#[inline(always)]
pub(crate) fn first_contact<L: Lane>(
    orbit: &mut Orbit<L>,
    body: &Body,
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
        lost: search.active,
    }
}

impl<L: Lane> Search<L> {
    /// The search at its beginning: the orbit counts its time from where contact is possible.
    #[inline(always)]
    pub(super) fn new(
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
    fn step(&mut self, orbit: &Orbit<L>, body: &Body, bounds: &Bounds<L>, now: &Gap<L>) {
        self.touch(now);
        if (self.active & !self.bracketed).any() {
            self.approach(orbit, body, bounds, now);
        }
        self.close_in(orbit, now);
    }

    /// Whether the root in a bracket is reached.
    #[inline(always)]
    pub(super) fn touch(&mut self, now: &Gap<L>) {
        let touches = self.bracketed & now.height.abs().le(L::splat(TOUCH));
        self.active = self.active & !touches;
    }

    /// Without a bracket: a contact, a bracket, or a step that no root is passed by.
    #[inline(always)]
    pub(super) fn approach(
        &mut self,
        orbit: &Orbit<L>,
        body: &Body,
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
        // a point that was just thrown back falls by rounding at most
        let thrown_back = !sinks | (self.departs & self.time.le(zero));
        let leaves = near & ((self.launched & !falls) | (!self.launched & thrown_back));
        self.active = self.active & !(near & !leaves);
        self.bracket(orbit, bounds, now, open & falls & !leaves & self.active);
        let free = open & self.active & !self.bracketed;
        if free.any() {
            let (mut own, other) = lower_bound_steps(orbit, body, bounds, now);
            let lingers = leaves & free;
            if lingers.any() {
                let short = lingers & own.lt(self.least);
                if short.any() {
                    // not beyond where the opposite point of the rim may come down instead
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

    /// Sets the lanes whose root is certain and unique from here on.
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
            // the parabola's root, a rounding later
            let high = self.time + last * L::splat(1.0 + 1e-12) + L::splat(1e-300);
            self.high = L::select(newly, high, self.high);
            self.bracketed = self.bracketed | newly;
        }
    }

    /// In a bracket: one step of Newton's method with the second-order term, kept within it.
    #[inline(always)]
    pub(super) fn close_in(&mut self, orbit: &Orbit<L>, now: &Gap<L>) {
        let lanes = self.bracketed & self.active;
        if !lanes.any() {
            return;
        }
        let above = L::splat(0.0).lt(now.height);
        self.low = L::select(lanes & above, self.time, self.low);
        self.high = L::select(lanes & !above, self.time, self.high);
        let step = first_root(now.height, now.slope, -now.curvature);
        let next = self.time + step;
        // strictly: from one end to the other and back would never end
        let inside = self.low.lt(next) & next.lt(self.high);
        let middle = L::splat(0.5) * (self.low + self.high);
        let next = L::select(inside, next, middle);
        // the resolution of time is reached: nothing lies between, or nothing changes
        let closed = middle.le(self.low) | self.high.le(middle);
        let same = next.le(self.time) & self.time.le(next);
        // the gap has a kink where u becomes horizontal and the other rim the lowest: beyond it the
        // step has followed the wrong one
        let one_rim = L::splat(0.0).le(now.uz * (now.uz + now.uz_rate * step));
        let resolved = inside & one_rim & orbit.resolves(step, now.sin);
        let done = lanes & (closed | same | resolved);
        self.active = self.active & !done;
        self.time = L::select(lanes, L::select(closed, self.low, next), self.time);
    }

    #[inline(always)]
    fn advance(&mut self, step: L, lanes: L::Mask) {
        let next = self.time + step;
        // a step below the resolution of time cannot come nearer to the root
        let stuck = lanes & next.le(self.time);
        self.active = self.active & !stuck;
        self.time = L::select(lanes, next, self.time);
    }
}

/// Time for which the centre certainly stays above all contact; 0 if it is not above.
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
fn lower_bound_steps<L: Lane>(
    orbit: &Orbit<L>,
    body: &Body,
    bounds: &Bounds<L>,
    now: &Gap<L>,
) -> (L, L) {
    const SMALL: f64 = 0.05;
    let (radius, half) = (L::splat(body.radius), L::splat(body.half));
    let inverse = L::splat(1.0) / now.sin;
    // below 0 by rounding at most
    let gap = now.height.max(L::splat(0.0));
    let across = half * bounds.swing + orbit.strongest_pull(now.vz);
    let bend = across + radius * bounds.spread * inverse;
    let rims = Rims {
        gap,
        // the other rim is higher by the coin's height along the vertical
        rise: L::splat(2.0) * half * now.uz.abs(),
        climb: L::splat(2.0) * half * now.uz_rate * L::splat(1.0).copysign(now.uz),
    };
    let (mut own, other) = rims.steps(now.slope, bend);
    if !orbit.is_dragged() {
        own = own.max(widening_step(body, bounds, now, inverse));
    }
    let flat = now.sin.lt(L::splat(SMALL));
    if !flat.any() {
        return (own, other);
    }
    // without sin', which the bounds replace
    let bare = now.slope + radius * now.sin_rate;
    let coarse = rims.steps(bare - radius * bounds.wander, across);
    let (chord, until) = chord(now);
    let straight = rims.steps(bare - radius * chord, across + radius * bounds.bend);
    (
        L::select(flat, own.max(coarse.0).max(straight.0.min(until)), own),
        L::select(flat, other.max(coarse.1).max(straight.1.min(until)), other),
    )
}

/// Time for which the gap of the lowest rim, which widens, certainly goes on to be open: by its
/// curvature now and the bound of the next derivative. 0 if it does not widen.
#[inline(always)]
fn widening_step<L: Lane>(body: &Body, bounds: &Bounds<L>, now: &Gap<L>, inverse_sin: L) -> L {
    let zero = L::splat(0.0);
    let (jerk, until) = bounds.jerk(body, now.sin, inverse_sin);
    let (curvature, bend) = (L::splat(0.5) * now.curvature, L::splat(1.0 / 3.0) * jerk);
    let step = first_root(now.slope, curvature, bend).min(until);
    L::select(zero.le(now.slope), step, zero)
}

/// The gap of the lowest rim, and by how much and how fast the other is higher.
struct Rims<L> {
    gap: L,
    rise: L,
    climb: L,
}

impl<L: Lane> Rims<L> {
    /// For both, the time until a gap of this rate of change and bend has closed.
    #[inline(always)]
    fn steps(&self, slope: L, bend: L) -> (L, L) {
        (
            first_root(self.gap, slope, bend),
            first_root(self.gap + self.rise, slope + self.climb, bend),
        )
    }
}

/// Slope of the chord of |a + a'τ| over the first half of the way to the vertical, and its time.
#[inline(always)]
fn chord<L: Lane>(now: &Gap<L>) -> (L, L) {
    let ([x, y], [vx, vy]) = (now.across, now.across_rate);
    let speed = (vx * vx + vy * vy).sqrt().max(L::splat(1e-30));
    let until = L::splat(0.5) * now.sin / speed;
    let (dx, dy) = (x + vx * until, y + vy * until);
    // a rounding up, as the difference loses digits
    let rounding = L::splat(1e-15) * now.sin;
    let end = (dx * dx + dy * dy).sqrt();
    ((end - now.sin + rounding) / until, until)
}

/// The first root t of gap + slope·t − ½ bend t² where it crosses downwards; very late if there is
/// none. (With gap < 0 < −slope the crossing has been, and t < 0.)
///
/// Either form of the root loses no digits where it is used: (√… + slope)/bend for slope >= 0,
/// 2 gap/(√… − slope) for slope < 0.
#[inline(always)]
fn first_root<L: Lane>(gap: L, slope: L, bend: L) -> L {
    const NEVER: f64 = 1e30;
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
