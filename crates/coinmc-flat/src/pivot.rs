//! Contact phases that conserve energy: pivoting about a corner that sticks (μ > 0), or that slides
//! without friction (μ = 0). Closed form in the angle.
//!
//! The centre is at the height cos δ. With the inertia J about the contact (1 + k when the corner
//! sticks, sin²δ + k without friction) the energy E = ½Jω² + cos δ gives ω at every δ. Both phases
//! begin with E >= 1 (below the barrier the coin is decided), hence ω never changes sign.

use crate::motion::Motion;
use crate::observer_adapter::ObserverAdapter;
use crate::pivot_time::{angle_after, duration};
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

/// Normal and friction force (in m g) of a sticking corner.
#[inline]
pub(crate) fn sticking_forces(sin: f64, cos: f64, omega: f64, k: f64) -> (f64, f64) {
    let w2 = omega * omega;
    let normal = 1.0 - sin * sin / (1.0 + k) - cos * w2;
    let friction = sin * cos / (1.0 + k) - sin * w2;
    (normal, friction)
}

/// Pivots about a sticking corner until it slips or the coin is flat. The cone is not checked over
/// the first `unchecked`, rad.
pub(crate) fn stick<O: Observer>(
    motion: &mut Motion,
    shape: &Shape,
    mu: f64,
    unchecked: f64,
    adapter: &mut ObserverAdapter<'_, O>,
) -> PivotEnd {
    let inertia = 1.0 + shape.k;
    let (sin0, cos0) = sin_cos(motion.delta);
    let energy = 0.5 * inertia * motion.omega * motion.omega + cos0;
    let direction = 1.0_f64.copysign(motion.omega);
    let (delta, end) = stick_until(motion, shape, mu, energy, unchecked);
    let rate = |c: f64| (2.0 * (energy - c).max(0.0) / inertia).sqrt();
    let slowness = |d: f64| 1.0 / rate(sin_cos(d).1);
    let place = |motion: &mut Motion, delta: f64, _: f64| {
        let (sin, cos) = sin_cos(delta);
        motion.x += sin - sin0;
        motion.delta = delta;
        motion.set_on_corner(sin, cos, direction * rate(cos), 0.0);
    };
    turn_to(motion, delta, &slowness, &place, adapter);
    end
}

/// The angle at which a corner stops sticking, and how.
///
/// With ω² = 2(E − c)/(1 + k), c = cos δ, s = sin δ, the distances to the two sides of the cone
/// are, times 1 + k, q± = μ(k + 3c² − 2Ec) ∓ s(3c − 2E). Their second derivatives are at most
/// (1 + μ)(6 + 2E); divided by that, q + q'τ − τ²/2 is a lower bound, and stepping to its root
/// never passes a root of q.
fn stick_until(
    motion: &Motion,
    shape: &Shape,
    mu: f64,
    energy: f64,
    unchecked: f64,
) -> (f64, PivotEnd) {
    let direction = 1.0_f64.copysign(motion.omega);
    let last = shape.last_angle(motion.quadrant, motion.omega);
    // weights that add up to less than one, so that no friction is too great
    let scale = 1.0 / (6.0 + 2.0 * energy);
    let (cone_part, need_part) = (scale * (mu / (1.0 + mu)), scale / (1.0 + mu));
    let mut delta = motion.delta;
    let mut step = unchecked;
    loop {
        delta += direction * step;
        if (last - delta) * direction <= 0.0 {
            return (last, PivotEnd::Flat);
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
            return (delta, PivotEnd::Slips);
        }
    }
}

/// Step to the first root of the lower bound of q; 0 if q has reached zero and falls.
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

/// Pivots about a corner that slides without friction, until the contact opens or the coin is flat.
/// Horizontal velocity stays constant.
pub(crate) fn slide_without_friction<O: Observer>(
    motion: &mut Motion,
    shape: &Shape,
    adapter: &mut ObserverAdapter<'_, O>,
) -> PivotEnd {
    let (sin0, cos0) = sin_cos(motion.delta);
    let energy = 0.5 * (shape.k + sin0 * sin0) * motion.omega * motion.omega + cos0;
    let direction = 1.0_f64.copysign(motion.omega);
    let (delta, end) = slide_until(motion, shape, energy);
    let rate = |s: f64, c: f64| (2.0 * (energy - c).max(0.0) / (shape.k + s * s)).sqrt();
    let slowness = |d: f64| {
        let (s, c) = sin_cos(d);
        1.0 / rate(s, c)
    };
    let place = |motion: &mut Motion, delta: f64, t: f64| {
        let (sin, cos) = sin_cos(delta);
        motion.x += motion.vx * t;
        motion.delta = delta;
        motion.z = cos;
        motion.omega = direction * rate(sin, cos);
        motion.vz = -motion.omega * sin;
    };
    turn_to(motion, delta, &slowness, &place, adapter);
    end
}

/// The angle at which sliding without friction ends, and how.
///
/// The contact force is positive while c² − 2Ec + 1 + k > 0, c = cos δ: it vanishes on the way up
/// to the balance at c* = E − sqrt(E² − 1 − k) if that exists, and never on the way down.
fn slide_until(motion: &Motion, shape: &Shape, energy: f64) -> (f64, PivotEnd) {
    let direction = 1.0_f64.copysign(motion.omega);
    let opening = energy * energy - 1.0 - shape.k;
    let open_at = energy - opening.max(0.0).sqrt();
    let lifts = motion.delta * direction < 0.0 && opening >= 0.0 && open_at <= 1.0;
    if !lifts {
        let last = shape.last_angle(motion.quadrant, motion.omega);
        return (last, PivotEnd::Flat);
    }
    // c < c* <= 1 on the way up; if rounding has it past c* already, the contact opens here
    let angle = -direction * libm::acos(open_at);
    let ahead = (angle - motion.delta) * direction > 0.0;
    let opens_at = if ahead { angle } else { motion.delta };
    (opens_at, PivotEnd::LiftsOff)
}

/// Turns the coin to the angle `delta`. `slowness` is the time per angle, `place` sets the motion
/// at an angle and a time since the start. Only an observer needs the time.
fn turn_to<O: Observer>(
    motion: &mut Motion,
    delta: f64,
    slowness: &impl Fn(f64) -> f64,
    place: &impl Fn(&mut Motion, f64, f64),
    adapter: &mut ObserverAdapter<'_, O>,
) {
    let mut took = 0.0;
    if O::ACTIVE {
        let before = *motion;
        took = duration(slowness, before.delta, delta);
        motion.time += took;
        adapter.passed(before.time, motion.time, |t| {
            let mut motion = before;
            let angle = angle_after(slowness, (before.delta, delta), t, took);
            place(&mut motion, angle, t);
            motion
        });
    }
    place(motion, delta, took);
}
