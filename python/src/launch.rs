//! Launches as rows of twelve numbers, the layout of the structured arrays in Python.

use coinmc::engines::EngineKind;
use coinmc::plan::Point;
use coinmc_core::{Launch, State};
use nalgebra::{UnitVector3, Vector3};

/// Numbers of a row: position, velocity, axis, spin, each x, y, z.
pub(crate) const ROW: usize = 12;

/// An axis this close to unit length is not normalized, so that launches drawn for the user are
/// bit-identical when they are tossed.
const UNIT: f64 = 1e-12;

/// Relative motion out of the plane that is treated as a rounding error.
const PLANAR: f64 = 1e-9;

/// What is wrong with a row; the message begins with the number of the row.
pub(crate) type Fault = &'static str;

/// Checks that the engine of a point can toss the launch of a row. Numbers other than the axis may
/// be infinite or NaN: the engine counts such a toss as failed.
pub(crate) fn check(point: &Point, row: &[f64]) -> Result<(), Fault> {
    let axis = vector(row, 2);
    let norm = axis.norm();
    if !(norm > 0.0 && norm.is_finite()) {
        return Err("its axis has no direction: give a vector of finite, non-zero length");
    }
    // wherever the ground lies exactly; NaN is counted as failed
    if row[2] < -point.scene.coin.rim_distance_m() {
        return Err("it lies below the surface: z is the height of the centre over it");
    }
    if point.engine.descriptor().kind == EngineKind::Planar && !is_planar(row, norm) {
        return Err("the flat engine needs axis and velocity in the xz plane and spin about y");
    }
    Ok(())
}

fn is_planar(row: &[f64], norm: f64) -> bool {
    let (velocity, spin) = (vector(row, 1), vector(row, 3));
    // NaN and infinity pass
    let is_out = |part: f64, whole: f64| part.abs() > PLANAR * whole;
    !(is_out(row[7], norm)
        || is_out(velocity.y, velocity.norm())
        || is_out(spin.x, spin.norm())
        || is_out(spin.z, spin.norm()))
}

/// The launch of a row that passed [`check`].
pub(crate) fn launch(row: &[f64]) -> Launch {
    let axis = vector(row, 2);
    Launch {
        height_m: row[2],
        velocity_m_s: vector(row, 1),
        axis: if (axis.norm_squared() - 1.0).abs() <= UNIT {
            UnitVector3::new_unchecked(axis)
        } else {
            UnitVector3::new_normalize(axis)
        },
        spin_rad_s: vector(row, 3),
    }
}

/// Writes a launch into a row.
pub(crate) fn write_launch(launch: &Launch, row: &mut [f64]) {
    row[..3].copy_from_slice(&[0.0, 0.0, launch.height_m]);
    row[3..6].copy_from_slice(launch.velocity_m_s.as_slice());
    row[6..9].copy_from_slice(launch.axis.as_slice());
    row[9..].copy_from_slice(launch.spin_rad_s.as_slice());
}

/// Writes a state into a row; `from` is the horizontal position of the launch, which engines
/// ignore.
pub(crate) fn write_state(state: &State, from: [f64; 2], row: &mut [f64]) {
    row[..3].copy_from_slice(state.position_m.as_slice());
    row[0] += from[0];
    row[1] += from[1];
    row[3..6].copy_from_slice(state.velocity_m_s.as_slice());
    row[6..9].copy_from_slice(state.axis.as_slice());
    row[9..].copy_from_slice(state.spin_rad_s.as_slice());
}

fn vector(row: &[f64], number: usize) -> Vector3<f64> {
    let at = 3 * number;
    Vector3::new(row[at], row[at + 1], row[at + 2])
}
