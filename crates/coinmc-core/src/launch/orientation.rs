//! Orientation of the coin at launch.

use super::config::{direction_kind, direction_value, read_direction, to_degrees};
use super::dimension::ORIENTATION;
use super::draw::Uniforms;
use super::sincos::sin_cos;
use super::{LaunchError, Marginal};
use crate::UniformSource;
use crate::schema::{Absent, Bounds, Kind, ReadError, Value, Word, field};
use coinmc_lanes::Lane;
use nalgebra::UnitVector3;
use std::f64::consts::TAU;

/// The distribution of the axis u.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Orientation {
    /// A fixed axis.
    Fixed(UnitVector3<f64>),
    /// Uniform on the sphere: c = u_z uniform in (−1, 1) (Archimedes), azimuth uniform.
    Isotropic,
    /// Three independent uniform Euler angles, as Unity's `Quaternion.Euler` of three uniform numbers:
    /// from upright, −b about y, then −a about x, then c about the vertical, all to the right. **Not**
    /// uniform on the sphere: u_z = cos a · cos b.
    EulerAngles,
    /// In the xz plane, at this angle from the vertical, rad: u = (sin θ, 0, cos θ).
    Tilt(Marginal),
}

impl Orientation {
    /// The value of the key `orientation` of a config.
    pub(super) fn kind() -> Kind {
        let words = vec![
            Word {
                name: "isotropic",
                doc: "uniform on the sphere",
            },
            Word {
                name: "euler-angles",
                doc: "three uniform Euler angles",
            },
        ];
        let tables = vec![
            Marginal::field(
                "tilt_deg",
                "Angle of the heads normal from the vertical, in the xz plane, degrees.",
                Bounds::closed(-36_000.0, 36_000.0),
                Absent::Required,
            ),
            field(
                "axis",
                "Always this direction of the heads normal, of any length.",
                direction_kind(),
                Absent::Required,
            ),
        ];
        Kind::Choice(words, tables)
    }

    /// The orientation that a config gives.
    pub(super) fn read(value: &Value) -> Result<Self, ReadError> {
        Ok(match value {
            Value::Word("isotropic") => Self::Isotropic,
            Value::Word("euler-angles") => Self::EulerAngles,
            Value::Tagged("tilt_deg", tilt) => {
                Self::Tilt(Marginal::read(tilt)?.scaled(f64::to_radians))
            }
            Value::Tagged("axis", axis) => Self::Fixed(read_direction(axis)?),
            // the schema lets no other value through
            _ => return Err(ReadError::new("this is no orientation")),
        })
    }

    /// The reverse of [`read`](Self::read).
    pub(super) fn value(&self) -> Value {
        match self {
            Self::Fixed(axis) => Value::Tagged("axis", Box::new(direction_value(axis))),
            Self::Isotropic => Value::Word("isotropic"),
            Self::EulerAngles => Value::Word("euler-angles"),
            Self::Tilt(tilt) => {
                Value::Tagged("tilt_deg", Box::new(tilt.scaled(to_degrees).value()))
            }
        }
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`LaunchError`] if the tilt's marginal is not a distribution.
    pub fn validate(&self) -> Result<(), LaunchError> {
        match self {
            Self::Tilt(marginal) => marginal.validate(),
            Self::Fixed(_) | Self::Isotropic | Self::EulerAngles => Ok(()),
        }
    }

    /// The axis of these uniforms.
    #[inline]
    pub fn axis(&self, uniforms: &mut impl UniformSource) -> UnitVector3<f64> {
        UnitVector3::new_unchecked(self.draw(uniforms).into())
    }

    /// The axis in every lane.
    #[inline(always)]
    pub(super) fn draw<L: Lane>(&self, uniforms: &mut impl Uniforms<L>) -> [L; 3] {
        let [a, b, c] = ORIENTATION;
        let (k, turn) = (L::splat, L::splat(TAU));
        match self {
            Self::Fixed(axis) => [k(axis.x), k(axis.y), k(axis.z)],
            Self::Isotropic => {
                let z = k(2.0) * uniforms.uniform(a) - k(1.0);
                let (sin, cos) = sin_cos(turn * uniforms.uniform(b));
                // (1 − z)(1 + z): 1 − z² would lose the digits near the poles
                let s = ((k(1.0) - z) * (k(1.0) + z)).sqrt();
                [s * cos, s * sin, z]
            }
            Self::EulerAngles => {
                let (sin_a, cos_a) = sin_cos(turn * uniforms.uniform(a));
                let (sin_b, cos_b) = sin_cos(turn * uniforms.uniform(b));
                let (sin_c, cos_c) = sin_cos(turn * uniforms.uniform(c));
                let (x, y) = (-sin_b, cos_b * sin_a);
                [x * cos_c - y * sin_c, x * sin_c + y * cos_c, cos_b * cos_a]
            }
            Self::Tilt(angle) => {
                let (sin, cos) = sin_cos(angle.sample(a, uniforms));
                [sin, k(0.0), cos]
            }
        }
    }

    /// Whether u always lies in the xz plane.
    pub fn is_planar(&self) -> bool {
        match self {
            Self::Fixed(axis) => axis.y == 0.0,
            Self::Tilt(_) => true,
            Self::Isotropic | Self::EulerAngles => false,
        }
    }
}
