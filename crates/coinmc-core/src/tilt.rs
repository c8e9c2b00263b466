//! A table that is not level.
//!
//! On a tilted table everything is told in *axes of the table*: z is normal to it, x and y lie in it,
//! and they are the axes of the laboratory turned by β about the horizontal line across the downhill
//! direction ê. In these axes the weight is m g cos β downwards and m g sin β along ê: a tilted table
//! is a level one with the gravity g cos β and a constant pull, tan β of it, to one side.

use crate::{Launch, State};
use nalgebra::{UnitVector3, Vector3};
use thiserror::Error;

/// The tilt of a table: its angle β to the horizontal, and the horizontal direction ê in which it
/// descends.
///
/// # Example
/// ```
/// use coinmc_core::TableTilt;
/// use nalgebra::Vector3;
/// let tilt = TableTilt::new(3.0, 90.0)?;
/// assert!((tilt.slope() - 0.0524).abs() < 1e-4);
/// // the weight, in axes of the table: a little of it points along y, downhill
/// let weight = tilt.in_table_axes(&-Vector3::z());
/// assert!((weight.y - 0.0523).abs() < 1e-4 && weight.x.abs() < 1e-15);
/// # Ok::<(), coinmc_core::TableTiltError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableTilt {
    angle_deg: f64,
    direction_deg: f64,
    /// sin β and cos β.
    sin: f64,
    cos: f64,
    /// ê.
    downhill: [f64; 2],
}

/// Why a tilt cannot be modelled.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum TableTiltError {
    /// The angle is negative, too large or not finite.
    #[error("the tilt of the table must lie in [0, 10] degrees, not {0}")]
    Angle(f64),
    /// The direction is not finite.
    #[error("the direction of the table's tilt must be finite, not {0} degrees")]
    Direction(f64),
}

impl TableTilt {
    /// Largest angle, degrees.
    pub const MAX_DEG: f64 = 10.0;

    /// A table tilted by `angle_deg` that descends in the direction `direction_deg`, measured from the
    /// x axis towards the y axis.
    ///
    /// # Errors
    /// [`TableTiltError`] unless 0 <= `angle_deg` <= [`MAX_DEG`](Self::MAX_DEG) and the direction is
    /// finite.
    pub fn new(angle_deg: f64, direction_deg: f64) -> Result<Self, TableTiltError> {
        if !(0.0..=Self::MAX_DEG).contains(&angle_deg) {
            return Err(TableTiltError::Angle(angle_deg));
        }
        if !direction_deg.is_finite() {
            return Err(TableTiltError::Direction(direction_deg));
        }
        let (sin, cos) = libm::sincos(angle_deg.to_radians());
        let (y, x) = libm::sincos(direction_deg.to_radians());
        Ok(Self {
            angle_deg,
            direction_deg,
            sin,
            cos,
            downhill: [x, y],
        })
    }

    /// β, degrees.
    pub fn angle_deg(&self) -> f64 {
        self.angle_deg
    }

    /// The direction of ê, degrees from the x axis.
    pub fn direction_deg(&self) -> f64 {
        self.direction_deg
    }

    /// Whether the table is level.
    pub fn is_level(&self) -> bool {
        self.angle_deg == 0.0
    }

    /// tan β.
    pub fn slope(&self) -> f64 {
        self.sin / self.cos
    }

    /// cos β.
    pub fn cos(&self) -> f64 {
        self.cos
    }

    /// ê along x and y.
    pub fn downhill(&self) -> [f64; 2] {
        self.downhill
    }

    /// The components of a vector of the laboratory in axes of the table.
    pub fn in_table_axes(&self, v: &Vector3<f64>) -> Vector3<f64> {
        let [ex, ey] = self.downhill;
        // the part along ê turns in the plane of ê and z, that across it stays
        let along = ex * v.x + ey * v.y;
        let turned = along * self.cos - v.z * self.sin;
        Vector3::new(
            v.x + (turned - along) * ex,
            v.y + (turned - along) * ey,
            along * self.sin + v.z * self.cos,
        )
    }

    /// The components of a vector in axes of the table along those of the laboratory.
    pub fn in_laboratory_axes(&self, v: &Vector3<f64>) -> Vector3<f64> {
        let back = Self {
            sin: -self.sin,
            ..*self
        };
        back.in_table_axes(v)
    }

    /// A state in axes of the table along those of the laboratory. Both have their origin in the
    /// middle of the table.
    pub fn state_in_laboratory(&self, state: &State) -> State {
        State {
            time_s: state.time_s,
            position_m: self.in_laboratory_axes(&state.position_m),
            velocity_m_s: self.in_laboratory_axes(&state.velocity_m_s),
            axis: UnitVector3::new_unchecked(self.in_laboratory_axes(&state.axis)),
            spin_rad_s: self.in_laboratory_axes(&state.spin_rad_s),
        }
    }

    /// A launch in axes of the table, and where its centre is along x and y, m. In the laboratory the
    /// centre is `height_m` straight above the middle of the table.
    pub fn launch_in_table_axes(&self, launch: &Launch) -> (Launch, [f64; 2]) {
        let centre = self.in_table_axes(&Vector3::new(0.0, 0.0, launch.height_m));
        let launch = Launch {
            height_m: centre.z,
            velocity_m_s: self.in_table_axes(&launch.velocity_m_s),
            axis: UnitVector3::new_unchecked(self.in_table_axes(&launch.axis)),
            spin_rad_s: self.in_table_axes(&launch.spin_rad_s),
        };
        (launch, [centre.x, centre.y])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_of_the_table_are_turned_about_the_level_line() {
        let tilt = TableTilt::new(7.0, 30.0).unwrap();
        assert!(!tilt.is_level() && TableTilt::new(0.0, 30.0).unwrap().is_level());
        let [ex, ey] = tilt.downhill();
        let (downhill, across) = (Vector3::new(ex, ey, 0.0), Vector3::new(-ey, ex, 0.0));
        assert!((tilt.in_table_axes(&across) - across).norm() < 1e-15);
        // the weight has the part sin β downhill and cos β into the table
        let weight = tilt.in_table_axes(&-Vector3::z());
        let (sin, cos) = libm::sincos(7.0_f64.to_radians());
        assert!((weight - (downhill * sin - Vector3::z() * cos)).norm() < 1e-15);
        // lengths and angles stay
        let (a, b) = (Vector3::new(0.3, -0.2, 0.9), Vector3::new(-0.5, 0.4, 0.1));
        let turned = tilt.in_table_axes(&a).dot(&tilt.in_table_axes(&b));
        assert!((turned - a.dot(&b)).abs() < 1e-15);
    }

    #[test]
    fn a_launch_begins_straight_above_the_middle() {
        let tilt = TableTilt::new(10.0, 0.0).unwrap();
        let launch = Launch {
            height_m: 0.5,
            velocity_m_s: Vector3::new(1.0, 2.0, 3.0),
            axis: Vector3::z_axis(),
            spin_rad_s: Vector3::new(0.0, 4.0, 0.0),
        };
        let (turned, [x, y]) = tilt.launch_in_table_axes(&launch);
        let (sin, cos) = libm::sincos(10.0_f64.to_radians());
        // uphill of the middle, since the vertical leans uphill in these axes
        assert!((x + 0.5 * sin).abs() < 1e-15 && y == 0.0);
        assert!((turned.height_m - 0.5 * cos).abs() < 1e-15);
        assert!((turned.axis.x + sin).abs() < 1e-15);
        assert_eq!(turned.spin_rad_s, launch.spin_rad_s);
    }

    #[test]
    fn the_way_back_to_the_laboratory_undoes_the_turn() {
        let tilt = TableTilt::new(7.0, 30.0).unwrap();
        let parts = [
            (0.3, -0.2, 0.9),
            (-0.5, 0.4, 0.1),
            (0.6, 0.0, 0.8),
            (4.0, 5.0, -6.0),
        ];
        let [position_m, velocity_m_s, axis, spin_rad_s] =
            parts.map(|(x, y, z)| Vector3::new(x, y, z));
        let table = |v: &Vector3<f64>| tilt.in_table_axes(v);
        let back = tilt.state_in_laboratory(&State {
            time_s: 2.0,
            position_m: table(&position_m),
            velocity_m_s: table(&velocity_m_s),
            axis: UnitVector3::new_unchecked(table(&axis)),
            spin_rad_s: table(&spin_rad_s),
        });
        // two turns of vectors shorter than 9: a few roundings
        assert!((back.position_m - position_m).norm() < 1e-14);
        assert!((back.velocity_m_s - velocity_m_s).norm() < 1e-14);
        assert!((back.axis.into_inner() - axis).norm() < 1e-14);
        assert!((back.spin_rad_s - spin_rad_s).norm() < 1e-14);
        assert_eq!(back.time_s, 2.0);
    }

    #[test]
    fn only_small_finite_tilts() {
        for (angle, direction) in [
            (-0.1, 0.0),
            (10.1, 0.0),
            (f64::NAN, 0.0),
            (1.0, f64::INFINITY),
        ] {
            assert!(
                TableTilt::new(angle, direction).is_err(),
                "{angle} {direction}"
            );
        }
        assert!(TableTilt::new(0.0, -720.0).unwrap().is_level());
    }

    /// sin, cos and tan of 30° would be round, but a table tilts by 10° at most: 5°, from tables.
    #[test]
    fn a_tilt_tells_its_angles_and_their_functions() {
        let tilt = TableTilt::new(5.0, 120.0).unwrap();
        assert_eq!((tilt.angle_deg(), tilt.direction_deg()), (5.0, 120.0));
        // 4 ulp: the angle in radians, a sine, a cosine and a quotient are rounded
        assert!((tilt.slope() / 0.087_488_663_525_924_01 - 1.0).abs() < 4.0 * f64::EPSILON);
        assert!((tilt.cos() / 0.996_194_698_091_745_5 - 1.0).abs() < 4.0 * f64::EPSILON);
    }
}
