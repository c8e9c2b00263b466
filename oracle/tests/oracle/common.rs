//! Random motions that the tests share.

use coinmc_oracle::{Model, Motion};
use coinmc_testkit::Dice;
use nalgebra::Vector3;

/// A motion in contact, tilted by `tilt`, at any azimuth and neither sinking nor rising.
pub(crate) fn in_contact(dice: &mut Dice, model: &Model, tilt: f64) -> Motion {
    let (s, c) = libm::sincos(tilt);
    let (sin, cos) = libm::sincos(dice.between(0.0, std::f64::consts::TAU));
    let axis = Vector3::new(s * cos, s * sin, c);
    let mut motion = Motion {
        position: Vector3::zeros(),
        velocity: dice.vector(1.0),
        axis,
        spin: dice.vector(2.0),
    };
    motion.position.z = -motion.gap(model);
    // the gap's rate, with h = (H/2)|c| + R s
    let c_rate = motion.spin.cross(&axis).z;
    motion.velocity.z = c_rate * (model.half.copysign(c) - model.radius * c / s);
    motion
}
