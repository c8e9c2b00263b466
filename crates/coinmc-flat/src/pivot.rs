//! Contact phases that conserve energy: pivoting about a corner that sticks (μ > 0) or slides
//! without friction (μ = 0). Closed form in the angle.
//!
//! The centre is cos δ high, so with the inertia J about the contact (1 + k when stuck, k + sin²δ
//! when smooth) the energy E = ½Jω² + cos δ gives ω at every δ. Neither phase is entered unless
//! E >= 1 (a coin below the barrier is decided), hence ω never changes sign.

use crate::motion::Motion;
use crate::observer_adapter::ObserverAdapter;
use crate::shape::Shape;
use coinmc_core::Observer;
use coinmc_lanes::sin_cos;

/// How a pivoting phase ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PivotEnd {
    /// The friction needed has reached the cone.
    Slips,
    /// The contact force has vanished.
    LiftsOff,
    /// The next corner has come down: flat on an edge.
    Flat,
}

/// Normal and friction force (in m g) of a stuck corner.
#[inline]
pub(crate) fn sticking_forces(sin: f64, cos: f64, omega: f64, k: f64) -> (f64, f64) {
    let w2 = omega * omega;
    let normal = 1.0 - sin * sin / (1.0 + k) - cos * w2;
    let friction = sin * cos / (1.0 + k) - sin * w2;
    (normal, friction)
}

/// Pivots about a stuck corner until it slips or the coin is flat. The cone is not looked at within
/// the first `step`, rad.
///
/// With ω² = 2(E − c)/(1 + k), c = cos δ, s = sin δ, the distances to the two sides of the cone
/// are, times 1 + k, q± = μ(k + 3c² − 2Ec) ∓ s(3c − 2E). Their second derivatives are at most
/// (1 + μ)(6 + 2E); divided by that, q + q'τ − τ²/2 is a lower bound, and stepping to its root
/// never passes a root of q.
pub(crate) fn stick<O: Observer>(
    motion: &mut Motion,
    shape: &Shape,
    mu: f64,
    mut step: f64,
    adapter: &mut ObserverAdapter<'_, O>,
) -> PivotEnd {
    let inertia = 1.0 + shape.k;
    let (sin0, cos0) = sin_cos(motion.delta);
    let energy = 0.5 * inertia * motion.omega * motion.omega + cos0;
    let direction = 1.0_f64.copysign(motion.omega);
    let last = shape.last_angle(motion.quadrant, motion.omega);
    // weights that add up to less than one, so that no friction is too great
    let scale = 1.0 / (6.0 + 2.0 * energy);
    let (cone_part, need_part) = (scale * (mu / (1.0 + mu)), scale / (1.0 + mu));
    let mut delta = motion.delta;
    let end = loop {
        delta += direction * step;
        if (last - delta) * direction <= 0.0 {
            delta = last;
            break PivotEnd::Flat;
        }
        let (sin, cos) = sin_cos(delta);
        let cone = cone_part * (shape.k + 3.0 * cos * cos - 2.0 * energy * cos);
        let need = need_part * sin * (3.0 * cos - 2.0 * energy);
        let cone_rate = direction * cone_part * sin * (2.0 * energy - 6.0 * cos);
        let need_rate =
            direction * need_part * (3.0 * (cos * cos - sin * sin) - 2.0 * energy * cos);
        step = cone_step(cone - need, cone_rate - need_rate)
            .min(cone_step(cone + need, cone_rate + need_rate));
        if step == 0.0 {
            break PivotEnd::Slips;
        }
    };
    let rate = |c: f64| (2.0 * (energy - c).max(0.0) / inertia).sqrt();
    let place = |motion: &mut Motion, delta: f64| {
        let (sin, cos) = sin_cos(delta);
        motion.x += sin - sin0;
        motion.delta = delta;
        motion.set_on_corner(sin, cos, direction * rate(cos), 0.0);
    };
    if O::ACTIVE {
        let slowness = |d: f64| 1.0 / rate(sin_cos(d).1);
        let before = *motion;
        let took = duration(&slowness, before.delta, delta);
        motion.time += took;
        adapter.passed(before.time, motion.time, |t| {
            let mut motion = before;
            let turned = turned(&slowness, (before.delta, delta), t, took);
            place(&mut motion, turned);
            motion
        });
    }
    place(motion, delta);
    end
}

/// Step to the first root of the lower bound of q; 0 when q has reached zero and falls.
fn cone_step(q: f64, rate: f64) -> f64 {
    // q is at most of order 1; this much outside the cone is rounding
    const REACHED: f64 = 1e-13;
    if q <= REACHED && rate <= 0.0 {
        return 0.0;
    }
    let root = (rate * rate + 2.0 * q.max(0.0)).sqrt();
    if rate < 0.0 {
        2.0 * q / (root - rate)
    } else {
        (rate + root).max(REACHED)
    }
}

/// Pivots about a corner that slides without friction until the contact opens or the coin is
/// flat. Horizontal velocity stays what it is.
///
/// The contact force is positive while c² − 2Ec + 1 + k > 0, c = cos δ: it vanishes on the way up
/// to the balance at c* = E − sqrt(E² − 1 − k) if that exists, and never on the way down.
pub(crate) fn slide_without_friction<O: Observer>(
    motion: &mut Motion,
    shape: &Shape,
    adapter: &mut ObserverAdapter<'_, O>,
) -> PivotEnd {
    let (sin0, cos0) = sin_cos(motion.delta);
    let energy = 0.5 * (shape.k + sin0 * sin0) * motion.omega * motion.omega + cos0;
    let direction = 1.0_f64.copysign(motion.omega);
    let opening = energy * energy - 1.0 - shape.k;
    let open_at = energy - opening.max(0.0).sqrt();
    let lifts = motion.delta * direction < 0.0 && opening >= 0.0 && open_at <= 1.0;
    let (delta, end) = if lifts {
        // c < c* <= 1 on the way up; if rounding has it past already, it opens here
        let angle = -direction * libm::acos(open_at);
        let reached = (angle - motion.delta) * direction > 0.0;
        (
            if reached { angle } else { motion.delta },
            PivotEnd::LiftsOff,
        )
    } else {
        (
            shape.last_angle(motion.quadrant, motion.omega),
            PivotEnd::Flat,
        )
    };
    let rate = |s: f64, c: f64| (2.0 * (energy - c).max(0.0) / (shape.k + s * s)).sqrt();
    let place = |motion: &mut Motion, delta: f64| {
        let (sin, cos) = sin_cos(delta);
        motion.delta = delta;
        motion.z = cos;
        motion.omega = direction * rate(sin, cos);
        motion.vz = -motion.omega * sin;
    };
    if O::ACTIVE {
        let slowness = |d: f64| {
            let (s, c) = sin_cos(d);
            1.0 / rate(s, c)
        };
        let before = *motion;
        let took = duration(&slowness, before.delta, delta);
        motion.time += took;
        motion.x += motion.vx * took;
        adapter.passed(before.time, motion.time, |t| {
            let mut motion = before;
            motion.x += motion.vx * t;
            place(
                &mut motion,
                turned(&slowness, (before.delta, delta), t, took),
            );
            motion
        });
    }
    place(motion, delta);
    end
}

/// The angle after time `t` of a phase that turns from one angle to the other in time `took`.
///
/// The inverse of [`duration`]: Newton's method, whose slope is the slowness itself, kept within
/// the bracket by bisection, until the time is met to a rounding or the bracket closes.
fn turned(slowness: &impl Fn(f64) -> f64, (from, to): (f64, f64), t: f64, took: f64) -> f64 {
    const MET: f64 = 1e-13;
    let direction = 1.0_f64.copysign(to - from);
    let (mut low, mut high) = (from, to);
    let mut delta = from + (to - from) * (t / took).clamp(0.0, 1.0);
    for _ in 0..100 {
        let late = duration(slowness, from, delta) - t;
        if late.abs() <= MET * (1.0 + took) {
            break;
        }
        *(if late > 0.0 { &mut high } else { &mut low }) = delta;
        let newton = delta - direction * late / slowness(delta);
        let inside = (newton - low) * (high - newton) > 0.0;
        let next = if inside {
            newton
        } else {
            f64::midpoint(low, high)
        };
        if next == delta {
            break;
        }
        delta = next;
    }
    delta
}

/// |∫ slowness dδ| by adaptive Simpson quadrature to 1e-12: only for observers, who ask when.
fn duration(slowness: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    fn refine(
        f: &impl Fn(f64) -> f64,
        (a, fa): (f64, f64),
        (b, fb): (f64, f64),
        middle: f64,
        whole: f64,
        depth: u32,
    ) -> f64 {
        let m = f64::midpoint(a, b);
        let (left, right) = (f(f64::midpoint(a, m)), f(f64::midpoint(m, b)));
        let h = (b - a) / 12.0;
        let (first, second) = (
            h * (fa + 4.0 * left + middle),
            h * (middle + 4.0 * right + fb),
        );
        let error = first + second - whole;
        // two coarse panels may agree by chance: at least 16 are looked at
        if depth == 0 || depth < 27 && error.abs() <= 15e-12 * (1.0 + whole.abs()) {
            return first + second + error / 15.0;
        }
        refine(f, (a, fa), (m, middle), left, first, depth - 1)
            + refine(f, (m, middle), (b, fb), right, second, depth - 1)
    }
    let (fa, fb) = (slowness(from), slowness(to));
    let middle = slowness(f64::midpoint(from, to));
    let whole = (to - from) / 6.0 * (fa + 4.0 * middle + fb);
    refine(slowness, (from, fa), (to, fb), middle, whole, 30).abs()
}
