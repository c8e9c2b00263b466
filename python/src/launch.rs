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
/// be infinite or NaN: such a toss is counted as failed.
pub(crate) fn check(point: &Point, row: &[f64]) -> Result<(), Fault> {
    let axis = vector(row, 2);
    if axis == Vector3::zeros() || !is_finite(&row[6..9]) {
        return Err("its axis has no direction: give a vector of finite, non-zero length");
    }
    if !is_finite(row) {
        return Ok(());
    }
    // wherever the ground lies exactly
    if row[2] < -point.scene.coin.rim_distance_m() {
        return Err("it lies below the surface: z is the height of the centre over it");
    }
    if [row[0], row[1]] != [0.0; 2] && has_middle(point) {
        return Err(
            "x and y must be 0: coins are launched above the middle of a table that has an edge or \
             is tilted",
        );
    }
    if point.engine.descriptor().kind == EngineKind::Planar && !is_planar(row) {
        return Err("the flat engine needs axis and velocity in the xz plane and spin about y");
    }
    Ok(())
}

/// Whether a coin launched elsewhere over the surface would be tossed differently.
fn has_middle(point: &Point) -> bool {
    let surface = &point.scene.surface;
    surface.table_radius_m().is_some() || surface.tilt().is_some()
}

fn is_planar(row: &[f64]) -> bool {
    let [velocity, axis, spin] = [1, 2, 3].map(|number| near_one(&vector(row, number)));
    let is_out = |part: f64, whole: &Vector3<f64>| part.abs() > PLANAR * whole.norm();
    !(is_out(axis.y, &axis)
        || is_out(velocity.y, &velocity)
        || is_out(spin.x, &spin)
        || is_out(spin.z, &spin))
}

/// A vector of the same direction, and of a length whose square neither over- nor underflows: its
/// largest component is from 1 to 2. Zero stays zero.
fn near_one(vector: &Vector3<f64>) -> Vector3<f64> {
    if *vector == Vector3::zeros() {
        return *vector;
    }
    // by a power of two, which rounds nothing
    let exponent = libm::ilogb(vector.amax());
    vector.map(|part| libm::scalbn(part, -exponent))
}

/// The launch of a row that passed [`check`].
pub(crate) fn launch(row: &[f64]) -> Launch {
    let axis = vector(row, 2);
    Launch {
        // engines look at the height, and not at numbers that they have no use for
        height_m: if is_finite(row) { row[2] } else { f64::NAN },
        velocity_m_s: vector(row, 1),
        axis: if (axis.norm_squared() - 1.0).abs() <= UNIT {
            UnitVector3::new_unchecked(axis)
        } else {
            UnitVector3::new_normalize(near_one(&axis))
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

/// What engines do not know of a launch.
#[derive(Clone, Copy)]
pub(crate) enum Start<'a> {
    /// Where it is along x and y, m.
    At([f64; 2]),
    /// Its row, not all of which is finite: the coin goes nowhere.
    Nowhere(&'a [f64]),
}

impl<'a> Start<'a> {
    /// That of a launch drawn for the user.
    pub(crate) const MIDDLE: Self = Self::At([0.0; 2]);

    /// That of the launch in a row.
    pub(crate) fn of(row: &'a [f64]) -> Self {
        if is_finite(row) {
            Self::At([row[0], row[1]])
        } else {
            Self::Nowhere(row)
        }
    }

    /// Moves a state of the toss to where it is.
    pub(crate) fn apply(self, state: &mut State) {
        match self {
            Self::At([x, y]) => {
                state.position_m.x += x;
                state.position_m.y += y;
            }
            // but for the axis, which the launch may give with any length
            Self::Nowhere(row) => {
                state.position_m = vector(row, 0);
                state.velocity_m_s = vector(row, 1);
                state.spin_rad_s = vector(row, 3);
            }
        }
    }
}

/// Writes a state of a toss into a row.
pub(crate) fn write_state(state: &State, row: &mut [f64]) {
    row[..3].copy_from_slice(state.position_m.as_slice());
    row[3..6].copy_from_slice(state.velocity_m_s.as_slice());
    row[6..9].copy_from_slice(state.axis.as_slice());
    row[9..].copy_from_slice(state.spin_rad_s.as_slice());
}

fn is_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| number.is_finite())
}

fn vector(row: &[f64], number: usize) -> Vector3<f64> {
    let at = 3 * number;
    Vector3::new(row[at], row[at + 1], row[at + 2])
}
