//! When energy alone settles the face.

use crate::{Model, Motion};
use coinmc_core::Face;

/// The face, if it is certain: a coin with less energy than it takes to stand on its rim, 1,
/// stays in the well it is in. A coin that has sunk in stands that much lower.
///
/// With `leave_out_rolling`, the energy of straight rolling does not count for a coin on its side, as
/// far as the axis will not turn.
pub(crate) fn decided(model: &Model, motion: &Motion, leave_out_rolling: bool) -> Option<Face> {
    let energy = motion.energy(model) - motion.gap(model).min(0.0);
    let c = motion.axis.z;
    let side = c.abs() < model.half;
    if energy < 1.0 {
        return Some(match () {
            () if side => Face::Side,
            () if c > 0.0 => Face::Heads,
            () => Face::Tails,
        });
    }
    if side && leave_out_rolling && energy - rolling_energy(model, motion) < 1.0 {
        return Some(Face::Side);
    }
    None
}

/// Kinetic energy of straight rolling on the side that stays so.
///
/// Across its axis the coin moves with v and turns with ω_a; friction f at the contact adds f to v
/// and R f/I_a to ω_a, so v − (I_a/R) ω_a keeps its value and with it the energy of the part of the
/// motion that has no slip (v = −Rω_a): with k = I_a/R², ½(1 + k)·((v − kRω_a)/(1 + k))².
///
/// An axis that turns about the vertical at Ω_z, of Ω = L/I_t (ω without gyroscopic torque), lets that
/// pass into motion along it, and tilt. The share 1/(1 + 4Ω_z²) counts as staying: half of what
/// the engine's rule grants an axis that turns fast.
fn rolling_energy(model: &Model, motion: &Motion) -> f64 {
    let u = &motion.axis;
    // unit vector across: horizontal and normal to u
    let across = nalgebra::Vector3::new(-u.y, u.x, 0.0) / motion.sine();
    let k = model.axial / (model.radius * model.radius);
    let conserved = motion.velocity.dot(&across) - k * model.radius * motion.spin.dot(u);
    let turn = if model.gyroscopic {
        (model.inertia(u) * motion.spin).z / model.transverse
    } else {
        motion.spin.z
    };
    0.5 * conserved * conserved / (1.0 + k) / (1.0 + 4.0 * turn * turn)
}
