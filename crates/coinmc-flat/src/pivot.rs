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
    let cone = Cone::new(shape.k, mu, energy, direction);
    let mut delta = motion.delta;
    let mut step = unchecked;
    loop {
        delta += direction * step;
        if (last - delta) * direction <= 0.0 {
            return (last, PivotEnd::Flat);
        }
        let [above, below] = cone.spare(delta);
        step = cone_step(above.0, above.1).min(cone_step(below.0, below.1));
        if step == 0.0 {
            return (delta, PivotEnd::Slips);
        }
    }
}

/// What [`stick_until`] searches for a root.
struct Cone {
    k: f64,
    energy: f64,
    direction: f64,
    mu_share: f64,
    need_share: f64,
}

impl Cone {
    fn new(k: f64, mu: f64, energy: f64, direction: f64) -> Self {
        // weights that add up to less than one, so that no friction is too great
        let scale = 1.0 / (6.0 + 2.0 * energy);
        Self {
            k,
            energy,
            direction,
            mu_share: scale * (mu / (1.0 + mu)),
            need_share: scale / (1.0 + mu),
        }
    }

    /// q+ and q− over (1 + μ)(6 + 2E), each with its rate in the direction of turning.
    #[inline]
    fn spare(&self, delta: f64) -> [(f64, f64); 2] {
        let &Self {
            k,
            energy,
            direction,
            mu_share,
            need_share,
        } = self;
        let (sin, cos) = sin_cos(delta);
        let cone = mu_share * (k + 3.0 * cos * cos - 2.0 * energy * cos);
        let need = need_share * sin * (3.0 * cos - 2.0 * energy);
        let cone_rate = direction * mu_share * sin * (2.0 * energy - 6.0 * cos);
        let need_rate =
            direction * need_share * (3.0 * (cos * cos - sin * sin) - 2.0 * energy * cos);
        [
            (cone - need, cone_rate - need_rate),
            (cone + need, cone_rate + need_rate),
        ]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::tests::on_corner;
    use coinmc_testkit::{Dice, scene};

    fn turning(shape: &Shape, delta: f64, omega: f64) -> Motion {
        assert!(delta > -shape.first_span(0) && delta < shape.last_angle(0, 1.0));
        on_corner(0, delta, omega, 0.0)
    }

    /// The force on a corner at rest is that which moves the centre on its circle, (sin δ, cos δ) from the
    /// corner: x'' = F and z'' = N − 1.
    #[test]
    fn sticking_forces_move_the_centre_on_its_circle() {
        let mut dice = Dice::new(61, 0);
        for _ in 0..100 {
            let (delta, omega) = (dice.between(-1.5, 1.5), dice.between(-1.0, 1.0));
            let k = dice.between(0.1, 1.0);
            let (sin, cos) = sin_cos(delta);
            // the weight turns the coin about its corner
            let turning = sin / (1.0 + k);
            let (normal, friction) = sticking_forces(sin, cos, omega, k);
            let x = cos * turning - sin * omega * omega;
            let z = -sin * turning - cos * omega * omega;
            assert!((friction - x).abs() < 1e-14);
            assert!((normal - (1.0 + z)).abs() < 1e-14);
        }
    }

    /// The rates are derivatives, and the second derivatives are at most 1: so no step passes a root.
    #[test]
    fn spare_friction_has_its_rates_and_a_bounded_curvature() {
        let mut dice = Dice::new(62, 0);
        for _ in 0..200 {
            let (k, mu, energy) = (
                dice.between(0.1, 1.0),
                dice.between(0.01, 3.0),
                dice.between(1.0, 3.0),
            );
            let direction = dice.pick(&[-1.0, 1.0]);
            let cone = Cone::new(k, mu, energy, direction);
            let delta = dice.between(-1.5, 1.5);
            let at = cone.spare(delta);
            let step = 1e-4;
            let after = cone.spare(delta + direction * step);
            let before = cone.spare(delta - direction * step);
            let (sin, cos) = sin_cos(delta);
            let rate = 2.0 * (energy - cos) / (1.0 + k);
            let (normal, friction) = sticking_forces(sin, cos, rate.sqrt(), k);
            let unit = (1.0 + k) / ((1.0 + mu) * (6.0 + 2.0 * energy));
            for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
                let expected = unit * (mu * normal - sign * friction);
                assert!((at[side].0 - expected).abs() < 1e-14);
                // errors of the central differences: step² and rounding over step²
                let slope = (after[side].0 - before[side].0) / (2.0 * step);
                assert!((at[side].1 - slope).abs() < 1e-7, "{slope}");
                let curvature = (after[side].1 - before[side].1) / (2.0 * step);
                assert!(curvature.abs() <= 1.0, "{curvature}");
            }
        }
    }

    /// A step leads to the root of q + q'τ − τ²/2.
    #[test]
    fn steps_lead_to_the_root_of_the_lower_bound() {
        for q in [0.0, 1e-3, 0.3, 1.0] {
            for rate in [-0.7, -1e-3, 1e-3, 0.4] {
                let step = cone_step(q, rate);
                assert!((q + rate * step - 0.5 * step * step).abs() < 1e-15);
                assert_eq!(step > 0.0, q > 0.0 || rate > 0.0);
            }
        }
        // without cancellation
        assert!((cone_step(2e-12, -0.5) / 4e-12 - 1.0).abs() < 1e-10);
    }

    /// A coin that falls from its balance sticks until the friction that it needs is μN: there, and nowhere
    /// earlier. With enough friction it falls flat.
    #[test]
    fn a_corner_slips_where_the_friction_needed_reaches_the_cone() {
        let shape = Shape::new(&scene(1.0, 0.0, 0.3).coin);
        let spare = |mu: f64, energy: f64, delta: f64| {
            let (sin, cos) = sin_cos(delta);
            let omega = (2.0 * (energy - cos) / (1.0 + shape.k)).sqrt();
            let (normal, friction) = sticking_forces(sin, cos, omega, shape.k);
            mu * normal - friction.abs()
        };
        let mut slips = 0;
        for mu in [0.1, 0.2, 0.3, 0.5, 5.0] {
            for direction in [-1.0, 1.0] {
                let motion = turning(&shape, 0.01 * direction, 0.1 * direction);
                let (_, cos) = sin_cos(motion.delta);
                let energy = 0.5 * (1.0 + shape.k) * 0.01 + cos;
                let (delta, end) = stick_until(&motion, &shape, mu, energy, 0.0);
                if end == PivotEnd::Slips {
                    slips += 1;
                    // reached to 1e-13 of the distances in their unit, of order 0.1
                    assert!(spare(mu, energy, delta).abs() < 1e-11);
                } else {
                    assert_eq!(end, PivotEnd::Flat);
                    assert_eq!(delta, shape.last_angle(0, direction));
                }
                for share in 0..1000 {
                    let share = 0.999 * f64::from(share) / 1000.0;
                    let between = motion.delta + share * (delta - motion.delta);
                    assert!(spare(mu, energy, between) > 0.0, "μ {mu}, δ {between}");
                }
            }
        }
        assert!((4..10).contains(&slips), "{slips}");
    }

    /// Nothing presses a smooth corner down where the centre slows as in free fall, d(v_z²/2)/dz = −1, on the way up
    /// to the balance.
    #[test]
    fn a_smooth_corner_lifts_off_where_its_centre_slows_as_in_free_fall() {
        let shape = Shape::new(&scene(1.0, 0.0, 0.0).coin);
        let vertical = |cos: f64, energy: f64| {
            let square = 1.0 - cos * cos;
            square * (energy - cos) / (shape.k + square)
        };
        // the error of the difference is of order 1e-10
        let slowing = |cos: f64, energy: f64| {
            (vertical(cos + 1e-6, energy) - vertical(cos - 1e-6, energy)) / 2e-6
        };
        for (delta, omega, energy) in [(-0.4, 1.0, 1.14), (0.4, -1.0, 1.14), (-0.7, 1.0, 1.2)] {
            let (opens_at, how) = slide_until(&turning(&shape, delta, omega), &shape, energy);
            assert_eq!(how, PivotEnd::LiftsOff);
            assert!((slowing(libm::cos(opens_at), energy) + 1.0).abs() < 1e-8);
            assert!(opens_at * omega < 0.0 && (opens_at - delta) * omega > 0.0);
            // on the way down, or with less energy, it stays on the surface until it is flat
            for (omega, energy) in [(-omega, energy), (omega, 1.05)] {
                let ends = slide_until(&turning(&shape, delta, omega), &shape, energy);
                assert_eq!(ends, (shape.last_angle(0, omega), PivotEnd::Flat));
            }
        }
    }
}
