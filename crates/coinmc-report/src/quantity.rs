//! Quantities of a launch that a map can vary, under the names of `coinmc.plot.VARIABLES`.

use coinmc_core::Launch;
use nalgebra::{UnitVector3, Vector3};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A quantity of the launch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Height of the centre, m.
    Height,
    /// A component of the velocity, m/s.
    Velocity(usize),
    /// A component of the angular velocity, rad/s.
    Spin(usize),
    /// Angle of the heads normal from the vertical towards x, rad.
    TiltRad,
    /// The same in degrees.
    TiltDeg,
}

const NAMES: [(&str, Quantity); 9] = [
    ("height_m", Quantity::Height),
    ("vx_m_s", Quantity::Velocity(0)),
    ("vy_m_s", Quantity::Velocity(1)),
    ("vz_m_s", Quantity::Velocity(2)),
    ("wx_rad_s", Quantity::Spin(0)),
    ("wy_rad_s", Quantity::Spin(1)),
    ("wz_rad_s", Quantity::Spin(2)),
    ("tilt_rad", Quantity::TiltRad),
    ("tilt_deg", Quantity::TiltDeg),
];

/// There is no quantity of this name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no quantity `{0}`: use {list}", list = list())]
pub struct UnknownQuantity(String);

fn list() -> String {
    NAMES.map(|(name, _)| name).join(", ")
}

impl FromStr for Quantity {
    type Err = UnknownQuantity;

    fn from_str(text: &str) -> Result<Self, UnknownQuantity> {
        let found = NAMES.iter().find(|(name, _)| *name == text);
        found
            .map(|(_, quantity)| *quantity)
            .ok_or_else(|| UnknownQuantity(text.to_owned()))
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = NAMES.iter().find(|(_, quantity)| quantity == self);
        f.write_str(name.expect("a test finds all names").0)
    }
}

impl Quantity {
    /// Whether both are the same quantity, in whatever unit.
    pub(crate) fn is_same(self, other: Self) -> bool {
        let is_tilt = |quantity| matches!(quantity, Self::TiltRad | Self::TiltDeg);
        self == other || is_tilt(self) && is_tilt(other)
    }

    /// Whether a toss in the xz plane has it.
    pub(crate) fn is_planar(self) -> bool {
        !matches!(self, Self::Velocity(1) | Self::Spin(0 | 2))
    }

    /// The launch with another value of this quantity.
    pub(crate) fn set(self, launch: &mut Launch, value: f64) {
        match self {
            Self::Height => launch.height_m = value,
            Self::Velocity(i) => launch.velocity_m_s[i] = value,
            Self::Spin(i) => launch.spin_rad_s[i] = value,
            Self::TiltRad => launch.axis = tilted(value),
            Self::TiltDeg => launch.axis = tilted(value.to_radians()),
        }
    }
}

fn tilted(angle: f64) -> UnitVector3<f64> {
    let (sin, cos) = libm::sincos(angle);
    UnitVector3::new_normalize(Vector3::new(sin, 0.0, cos))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for (name, quantity) in NAMES {
            assert_eq!(
                (quantity.to_string(), name.parse()),
                (name.to_owned(), Ok(quantity))
            );
        }
        let error = "edge".parse::<Quantity>().unwrap_err();
        assert!(
            error.to_string().contains("use height_m, vx_m_s"),
            "{error}"
        );
        assert!(
            Quantity::TiltDeg.is_same(Quantity::TiltRad)
                && !Quantity::Height.is_same(Quantity::TiltRad)
        );
    }
}
