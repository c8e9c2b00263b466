//! How the coin moves from one keyframe to the next: what the page computes, in the same words as
//! `web/src/toss/motion.js`.
//!
//! In flight the closed forms of the engines and of traces hold (see `coinmc-trace`, `turning.rs`): a parabola,
//! or its form with linear drag, and a free symmetric top. In contact the centre follows the cubic through
//! both places and velocities, and the coin is turned by the mean of both angular velocities. What then lacks
//! to the next keyframe is added evenly on the way, so that the motion never jumps.

use coinmc_core::{Scene, State};
use coinmc_trace::{Mode, Record};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Place of the centre, m, and orientation.
pub(crate) type Pose = (Vector3<f64>, UnitQuaternion<f64>);

/// The pose between two keyframes, a share `s` (0 to 1) of the way in time.
pub(crate) fn between(scene: &Scene, from: &Record, to: &Record, s: f64) -> Pose {
    let h = to.state.time_s - from.state.time_s;
    if from.mode == Mode::Flight {
        let (end, end_turn) = flown(scene, from, h);
        let (place, turn) = flown(scene, from, s * h);
        let place = place + (to.state.position_m - end) * s;
        (place, share(to.orientation * end_turn.inverse(), s) * turn)
    } else {
        let mean = (from.state.spin_rad_s + to.state.spin_rad_s) * 0.5;
        let end_turn = rotation(&(mean * h)) * from.orientation;
        let turn = rotation(&(mean * (s * h))) * from.orientation;
        let place = cubic(&from.state, &to.state, h, s);
        (place, share(to.orientation * end_turn.inverse(), s) * turn)
    }
}

/// The pose after `t` seconds of flight.
fn flown(scene: &Scene, from: &Record, t: f64) -> Pose {
    let (state, weight) = (&from.state, scene.weight_m_s2());
    let k = scene.drag().linear_per_s();
    let place = if k > 0.0 {
        let eased = effective(k, t);
        state.position_m + (state.velocity_m_s - weight / k) * eased + weight * (t / k)
    } else {
        state.position_m + state.velocity_m_s * t + weight * (0.5 * t * t)
    };
    let factor = axial_factor(scene);
    let axis = state.axis.into_inner();
    let axial = state.spin_rad_s.dot(&axis);
    let omega = state.spin_rad_s - axis * (axial * (1.0 - factor));
    let eased = effective(scene.drag().angular_per_s(), t);
    let spin = Vector3::new(0.0, 0.0, axial * (1.0 - factor) * eased);
    let turn = rotation(&(omega * eased)) * from.orientation * rotation(&spin);
    (place, turn)
}

/// I_a/I_t; 1 where no gyroscopic torque acts.
pub(crate) fn axial_factor(scene: &Scene) -> f64 {
    if scene.has_gyroscopic_torque() {
        scene.coin.axial_gyration_m2() / scene.coin.transverse_gyration_m2()
    } else {
        1.0
    }
}

/// The time in which a coin without drag would do what one with drag `k` does in `t`.
fn effective(k: f64, t: f64) -> f64 {
    if k > 0.0 { -libm::expm1(-k * t) / k } else { t }
}

/// The cubic through both places with both velocities (Hermite).
fn cubic(from: &State, to: &State, h: f64, s: f64) -> Vector3<f64> {
    let (a, b) = (from.position_m, to.position_m);
    let (u, v) = (from.velocity_m_s * h, to.velocity_m_s * h);
    let r = 1.0 - s;
    a * (r * r * (1.0 + 2.0 * s)) + u * (s * r * r) + b * (s * s * (3.0 - 2.0 * s))
        - v * (s * s * r)
}

/// The rotation by a vector.
fn rotation(by: &Vector3<f64>) -> UnitQuaternion<f64> {
    let angle = by.norm();
    if !(angle > 0.0 && angle.is_finite()) {
        return UnitQuaternion::identity();
    }
    let (sin, cos) = libm::sincos(0.5 * angle);
    let v = by * (sin / angle);
    UnitQuaternion::new_normalize(Quaternion::new(cos, v.x, v.y, v.z))
}

/// A share of a rotation, the short way round.
fn share(whole: UnitQuaternion<f64>, s: f64) -> UnitQuaternion<f64> {
    let q = whole.into_inner();
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    let v = Vector3::new(q.i, q.j, q.k) * sign;
    let sin = v.norm();
    if sin < 1e-12 {
        return UnitQuaternion::identity();
    }
    let angle = 2.0 * libm::atan2(sin, q.w * sign);
    rotation(&(v * (angle * s / sin)))
}
