//! Where the coin is in flight: closed form.
//!
//! u turns about the fixed vector Ω: with e = Ω/w, w = |Ω|, and the phase φ,
//!
//! u(φ) = a + b cos φ + d sin φ,  a = e(e·u), b = u − a, d = e × u.
//!
//! Without drag φ = wt and the centre follows a parabola. With linear drag k and angular drag k_a
//! (v' = −kv − g, Ω' = −k_a Ω) the direction of Ω stays, φ = w t p(k_a t), and the centre is at
//! z + v_z t p(kt) − g t² q(kt); p and q are those of [`decay`].

use crate::body::Body;
use crate::motion::{LEAST_SIN, Motion};
use crate::series::{decay, sin_cos};
use coinmc_lanes::Lane;

/// Rates of drag, in sqrt(g/D).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drag {
    pub(crate) linear: f64,
    pub(crate) angular: f64,
}

impl Drag {
    const NONE: Self = Self {
        linear: 0.0,
        angular: 0.0,
    };

    /// The same, of which the compiler knows where there is none: `ACTS` is whether it
    /// [`acts`](Self::acts).
    #[inline(always)]
    pub(crate) fn known<const ACTS: bool>(self) -> Self {
        if ACTS { self } else { Self::NONE }
    }

    pub(crate) fn acts(self) -> bool {
        self.linear != 0.0 || self.angular != 0.0
    }
}

/// One flight from its start.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Orbit<L> {
    a: [L; 3],
    b: [L; 3],
    d: [L; 3],
    z: L,
    vz: L,
    /// w, the rate at which u turns.
    rate: L,
    /// The part of w that moves u, and the horizontal part of Ω.
    across: L,
    horizontal: L,
    drag: Drag,
    /// Time from the start of the flight to what this orbit calls t = 0.
    elapsed: L,
}

/// The gap f = z − (height of the centre at which the lowest point touches), and what the search
/// for its root needs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gap<L> {
    pub(crate) z: L,
    pub(crate) vz: L,
    /// Horizontal and vertical parts of u.
    pub(crate) sin: L,
    pub(crate) uz: L,
    /// Rate of change of uz.
    pub(crate) uz_rate: L,
    /// Horizontal part of u, and its rate of change.
    pub(crate) across: [L; 2],
    pub(crate) across_rate: [L; 2],
    /// Rate of change of its length.
    pub(crate) sin_rate: L,
    /// f.
    pub(crate) height: L,
    pub(crate) slope: L,
    pub(crate) curvature: L,
}

impl<T: Copy> Orbit<T> {
    /// Numbers of a flight beside its drag.
    pub(crate) const NUMBERS: usize = 15;

    /// All of them, for memory.
    #[inline(always)]
    pub(crate) fn numbers(&self) -> [T; 15] {
        let ([ax, ay, az], [bx, by, bz], [dx, dy, dz]) = (self.a, self.b, self.d);
        [
            ax,
            ay,
            az,
            bx,
            by,
            bz,
            dx,
            dy,
            dz,
            self.z,
            self.vz,
            self.rate,
            self.across,
            self.horizontal,
            self.elapsed,
        ]
    }

    /// The flight of [`numbers`](Self::numbers).
    #[inline(always)]
    pub(crate) fn of(numbers: &[T; 15], drag: Drag) -> Self {
        let [
            ax,
            ay,
            az,
            bx,
            by,
            bz,
            dx,
            dy,
            dz,
            z,
            vz,
            rate,
            across,
            horizontal,
            elapsed,
        ] = *numbers;
        Self {
            a: [ax, ay, az],
            b: [bx, by, bz],
            d: [dx, dy, dz],
            z,
            vz,
            rate,
            across,
            horizontal,
            drag,
            elapsed,
        }
    }
}

impl<L: Lane> Orbit<L> {
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
        Self {
            a,
            b: [m.sin - a[0], -a[1], m.cos - a[2]],
            d: [e[1] * m.cos, e[2] * m.sin - e[0] * m.cos, -(e[1] * m.sin)],
            z: m.z,
            vz: m.vz,
            rate,
            across: (turn * turn + m.oy * m.oy).sqrt(),
            horizontal: (m.ox * m.ox + m.oy * m.oy).sqrt(),
            drag,
            elapsed: zero,
        }
    }

    /// The same flight with time counted from `t` on, in the lanes of `on`: what is small then
    /// keeps its digits.
    #[inline(always)]
    pub(crate) fn rebase(&mut self, t: L, on: L::Mask) {
        let (s, c, rate) = self.phase(t);
        let (z, vz) = self.fall(t);
        let set = |of: &mut L, to: L| *of = L::select(on, to, *of);
        for i in 0..3 {
            let (b, d) = (self.b[i], self.d[i]);
            set(&mut self.b[i], b * c + d * s);
            set(&mut self.d[i], d * c - b * s);
        }
        set(&mut self.z, z);
        set(&mut self.vz, vz);
        set(&mut self.rate, rate);
        let elapsed = self.elapsed + t;
        set(&mut self.elapsed, elapsed);
    }

    /// Whether drag acts.
    pub(crate) fn is_dragged(&self) -> bool {
        self.drag.acts()
    }

    /// Time from the start of the flight.
    #[inline(always)]
    pub(crate) fn since_start(&self, t: L) -> L {
        self.elapsed + t
    }

    /// sin and cos of the phase, and its rate.
    #[inline(always)]
    fn phase(&self, t: L) -> (L, L, L) {
        if self.drag.angular == 0.0 {
            let (s, c) = sin_cos(self.rate * t);
            return (s, c, self.rate);
        }
        let x = L::splat(self.drag.angular) * t;
        let (p, _) = decay(x);
        let (s, c) = sin_cos(self.rate * t * p);
        (s, c, self.rate * (L::splat(1.0) - x * p))
    }

    /// Height and vertical velocity of the centre.
    #[inline(always)]
    pub(crate) fn fall(&self, t: L) -> (L, L) {
        if self.drag.linear == 0.0 {
            return (self.z + t * (self.vz - L::splat(0.5) * t), self.vz - t);
        }
        let x = L::splat(self.drag.linear) * t;
        let (p, q) = decay(x);
        (
            self.z + t * (self.vz * p - t * q),
            self.vz * (L::splat(1.0) - x * p) - t * p,
        )
    }

    /// The centre is accelerated downwards by at most this from now on, when it rises at `vz`.
    #[inline(always)]
    pub(crate) fn strongest_pull(&self, vz: L) -> L {
        L::splat(1.0) + L::splat(self.drag.linear) * vz.max(L::splat(0.0))
    }

    /// The centre is accelerated downwards by at least this from now on; negative if it falls
    /// faster than drag lets it.
    #[inline(always)]
    pub(crate) fn weakest_pull(&self, vz: L) -> L {
        if self.drag.linear == 0.0 {
            return L::splat(1.0);
        }
        (L::splat(1.0) + L::splat(self.drag.linear) * vz).min(L::splat(0.0))
    }

    /// The gap at time `t`.
    #[inline(always)]
    pub(crate) fn gap(&self, body: &Body, t: L) -> Gap<L> {
        self.gap_at(body, self.phase(t), self.fall(t))
    }

    /// The gap at t = 0, where no phase need be computed.
    #[inline(always)]
    pub(crate) fn first_gap(&self, body: &Body) -> Gap<L> {
        let phase = (L::splat(0.0), L::splat(1.0), self.rate);
        self.gap_at(body, phase, (self.z, self.vz))
    }

    #[inline(always)]
    fn gap_at(&self, body: &Body, (s, c, rate): (L, L, L), (z, vz): (L, L)) -> Gap<L> {
        let at = |i: usize| self.a[i] + (self.b[i] * c + self.d[i] * s);
        let (ux, uy, uz) = (at(0), at(1), at(2));
        let sin = (ux * ux + uy * uy).sqrt().max(L::splat(LEAST_SIN));
        let uz_rate = rate * (self.d[2] * c - self.b[2] * s);
        let mut uz_curve = -(rate * rate) * (uz - self.a[2]);
        let mut fall_curve = L::splat(-1.0);
        if self.drag.acts() {
            uz_curve -= L::splat(self.drag.angular) * uz_rate;
            fall_curve -= L::splat(self.drag.linear) * vz;
        }
        let (radius, half) = (L::splat(body.radius), L::splat(body.half));
        // h = half|uz| + radius·sin; near flat sin' keeps its digits in this form alone
        let inverse = L::splat(1.0) / sin;
        let across_rate = [
            rate * (self.d[0] * c - self.b[0] * s),
            rate * (self.d[1] * c - self.b[1] * s),
        ];
        let sin_rate = (ux * across_rate[0] + uy * across_rate[1]) * inverse;
        // and sin'' = −(uz uz'' + uz'²/sin²)/sin
        let lever = half.copysign(uz) - radius * uz * inverse;
        let bend = radius * uz_rate * uz_rate * (inverse * inverse * inverse);
        Gap {
            z,
            vz,
            sin,
            uz,
            uz_rate,
            across: [ux, uy],
            across_rate,
            sin_rate,
            height: z - (half * uz.abs() + radius * sin),
            slope: vz - (half.copysign(uz) * uz_rate + radius * sin_rate),
            curvature: fall_curve - uz_curve * lever + bend,
        }
    }

    /// The motion at time `t`, in the frame of that moment, touching the surface; the frame's x
    /// axis, and whether it was reflected.
    #[inline(always)]
    pub(crate) fn land(&self, m: &Motion<L>, body: &Body, t: L) -> (Motion<L>, [L; 2], L::Mask) {
        let (mut after, x_axis, reflected) = self.at(m, t);
        after.z = after.rest_height(body);
        (after, x_axis, reflected)
    }

    /// The motion at time `t`, as [`land`](Self::land) gives it, at the height it has.
    #[inline(always)]
    pub(crate) fn at(&self, m: &Motion<L>, t: L) -> (Motion<L>, [L; 2], L::Mask) {
        let zero = L::splat(0.0);
        let (s, c, _) = self.phase(t);
        let (z, vz) = self.fall(t);
        let at = |i: usize| self.a[i] + (self.b[i] * c + self.d[i] * s);
        let (ux, uy, uz) = (at(0), at(1), at(2));
        // exactly 1 but for rounding, which must not pile up over thousands of flights
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
            slow = remains(self.drag.linear, self.since_start(t));
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

    /// A time that is a `share` of what the flight's first moments take at the fastest: of turning,
    /// of toppling, and of another point becoming the lowest (the opposite one of the rim as the
    /// tilt vanishes, the other rim's as u becomes horizontal).
    #[inline(always)]
    pub(crate) fn moment(&self, m: &Motion<L>, share: L) -> L {
        let least = L::splat(LEAST_SIN);
        let way = (m.sin * m.cos.max(least)).max(least);
        // share/(1 + w + across/way)
        share * way / ((L::splat(1.0) + self.rate) * way + self.across)
    }

    /// What drag leaves of the angular momentum at time `t`.
    #[inline(always)]
    pub(crate) fn spin_left(&self, t: L) -> L {
        if self.drag.angular == 0.0 {
            return L::splat(1.0);
        }
        remains(self.drag.angular, self.since_start(t))
    }

    /// Whether Newton's step of length `step`, with the second-order term, leaves a gap below
    /// 1e-14: its error is of third order, and f''' of the order of the cube of the rates.
    #[inline(always)]
    pub(crate) fn resolves(&self, step: L, sin: L) -> L::Mask {
        const THIRD_ORDER: f64 = 2e-5;
        // the fastest rate times sin
        let fastest = (L::splat(1.0) + self.rate) * sin + self.across;
        (step.abs() * fastest).lt(L::splat(THIRD_ORDER) * sin)
    }

    /// How far the centre goes sideways.
    pub(crate) fn drift(&self, m: &Motion<L>, t: L) -> (L, L) {
        let (p, _) = decay(L::splat(self.drag.linear) * t);
        (m.vx * t * p, m.vy * t * p)
    }

    /// What bounds the whole flight.
    #[inline(always)]
    pub(crate) fn extent(&self, body: &Body) -> Extent<L> {
        let amplitude = (self.b[2] * self.b[2] + self.d[2] * self.d[2]).sqrt();
        Extent {
            amplitude,
            clear: highest(body, self.a[2].abs(), amplitude),
            reach: L::splat(REACH) / self.across,
        }
    }

    /// Bounds that hold for the flight from now on.
    #[inline(always)]
    pub(crate) fn bounds(&self, extent: &Extent<L>) -> Bounds<L> {
        let amplitude = extent.amplitude;
        let faster = self.rate + L::splat(self.drag.angular);
        let swing = self.rate * faster * amplitude;
        Bounds {
            rate: self.rate,
            swing,
            spread: swing * (self.a[2].abs() + amplitude),
            wander: self.across,
            bend: faster * self.across,
            climb: self.horizontal * faster,
            clear: extent.clear,
            reach: extent.reach,
        }
    }
}

/// The largest height h(uz) at which the lowest point can touch while uz stays within
/// `amplitude` of ±`middle`. h grows up to |uz| = half (where it is 1) and falls beyond.
#[inline(always)]
fn highest<L: Lane>(body: &Body, middle: L, amplitude: L) -> L {
    let (one, half) = (L::splat(1.0), L::splat(body.half));
    let low = (middle - amplitude).max(L::splat(0.0));
    let high = (middle + amplitude).min(one);
    let nearest = half.max(low).min(high);
    let sin = ((one - nearest) * (one + nearest))
        .max(L::splat(0.0))
        .sqrt();
    // one rounding of each term may be lost: stay above
    (half * nearest + L::splat(body.radius) * sin) * L::splat(1.0 + 1e-15)
}

/// e^(−kt).
#[inline(always)]
fn remains<L: Lane>(k: f64, t: L) -> L {
    let x = L::splat(k) * t;
    let (p, _) = decay(x);
    // p is exact to rounding for any x, the difference from 1 is not: no energy is gained by it
    (L::splat(1.0) - x * p).max(L::splat(0.0))
}

/// Part of its distance from the vertical that u may go while [`Bounds::jerk`] holds.
const REACH: f64 = 0.25;

/// What bounds a flight beside its orbit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extent<L> {
    /// uz goes this far to either side.
    amplitude: L,
    /// No contact while the centre is above this.
    pub(crate) clear: L,
    /// [`REACH`] over the greatest speed of u.
    reach: L,
}

impl<T: Copy> Extent<T> {
    /// All of it, for memory.
    #[inline(always)]
    pub(crate) fn numbers(&self) -> [T; 3] {
        [self.amplitude, self.clear, self.reach]
    }

    /// The extent of [`numbers`](Self::numbers).
    #[inline(always)]
    pub(crate) fn of(&[amplitude, clear, reach]: &[T; 3]) -> Self {
        Self {
            amplitude,
            clear,
            reach,
        }
    }
}

/// See [`Orbit::bounds`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bounds<L> {
    /// u turns no faster.
    rate: L,
    /// |uz''| is nowhere larger.
    pub(crate) swing: L,
    /// Half of (sin²)'' is nowhere larger.
    pub(crate) spread: L,
    /// u moves sideways no faster.
    pub(crate) wander: L,
    /// u is accelerated sideways no more.
    pub(crate) bend: L,
    /// No point of the coin is accelerated upwards by the rotation more than this.
    pub(crate) climb: L,
    /// No contact while the centre is above this.
    pub(crate) clear: L,
    reach: L,
}

impl<L: Lane> Bounds<L> {
    /// |f'''| of a rim is nowhere larger, without drag, for the time that it also gives: while u
    /// is no nearer the vertical than 1 − [`REACH`] of what it is, `sin`. See `search`, *Below*.
    #[inline(always)]
    pub(crate) fn jerk(&self, body: &Body, sin: L, inverse_sin: L) -> (L, L) {
        const CROSS: f64 = 3.0 / (1.0 - REACH);
        // 3·2/√27 over (1 − REACH)², a rounding up
        const CUBE: f64 = 1.154_701 / ((1.0 - REACH) * (1.0 - REACH));
        let turns = self.wander * inverse_sin;
        let bends =
            self.rate * self.rate + turns * (L::splat(CROSS) * self.rate + L::splat(CUBE) * turns);
        let jerk = L::splat(body.half) * self.rate * self.swing
            + L::splat(body.radius) * self.wander * bends;
        (jerk, self.reach * sin)
    }
}
