//! Angular velocity of the coin at launch.

use super::config::{
    direction_kind, direction_value, read_direction, read_vector, to_degrees, vector_kind,
    vector_value,
};
use super::dimension::SPIN;
use super::draw::{Uniforms, sample3};
use super::sincos::sin_cos;
use super::{LaunchError, Marginal};
use crate::schema::{
    Absent, Bounds, Kind, ReadError, Value, Values, field, fields, table, unlisted,
};
use crate::{Coin, UniformSource};
use coinmc_lanes::Lane;
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::TAU;

/// The distribution of the angular velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spin {
    /// Component by component in the laboratory frame, rad/s.
    Components([Marginal; 3]),
    /// About a fixed axis of the laboratory.
    About {
        /// The axis; y for a flat toss.
        axis: UnitVector3<f64>,
        /// Signed magnitude, rad/s.
        rate_rad_s: Marginal,
    },
    /// A free symmetric top: the angular momentum L makes the angle ψ with the coin's axis, at a
    /// uniform azimuth about it. ψ = 90° flips end over end, ψ = 0 spins like a wheel; between,
    /// the coin precesses (Diaconis, Holmes & Montgomery 2007).
    Precessing {
        /// |L|/I_t, the rate at which the axis goes round L, rad/s.
        rate_rad_s: Marginal,
        /// ψ, rad.
        psi_rad: Marginal,
    },
}

/// Limit of every rate of turning, rad/s.
const RATE: Bounds = Bounds::closed(-1e9, 1e9);

/// The key of the standard deviation of an isotropic spin.
const ISOTROPIC: &str = "isotropic_sd_rad_s";

impl Spin {
    /// A spin in any direction alike: components normal about 0 with this standard deviation.
    fn isotropic(sd: f64) -> Self {
        let component = match sd {
            0.0 => Marginal::Constant(0.0),
            sd => Marginal::Normal { mean: 0.0, sd },
        };
        Self::Components([component; 3])
    }

    /// The value of the key `spin` of a config.
    pub(super) fn kind() -> Kind {
        let about = fields(vec![
            field(
                "axis",
                "The axis, of any length; y for a flat toss.",
                direction_kind(),
                Absent::Required,
            ),
            Marginal::field("rate_rad_s", "Signed rate, rad/s.", RATE, Absent::Required),
        ]);
        let precessing = fields(vec![
            Marginal::field(
                "rate_rad_s",
                "Angular momentum over transverse moment, rad/s.",
                RATE,
                Absent::Required,
            ),
            Marginal::field(
                "psi_deg",
                "Angle between angular momentum and the coin's axis, degrees.",
                Bounds::closed(0.0, 180.0),
                Absent::Required,
            ),
        ]);
        let tables = vec![
            field(
                "components_rad_s",
                "Component by component in the laboratory frame, rad/s.",
                vector_kind(RATE),
                Absent::Required,
            ),
            field(
                ISOTROPIC,
                "In any direction alike: every component is normal about 0 with this standard \
                 deviation, rad/s.",
                Kind::Number(Bounds::closed(0.0, 1e9)),
                Absent::Required,
            ),
            table(
                "about",
                "About a fixed axis of the laboratory.",
                about,
                Absent::Required,
            ),
            table(
                "precessing",
                "A free symmetric top.",
                precessing,
                Absent::Required,
            ),
        ];
        Kind::Choice(vec![], tables)
    }

    /// The spin that a config gives.
    pub(super) fn read(value: &Value) -> Result<Self, ReadError> {
        let Value::Tagged(name, inner) = value else {
            return Err(ReadError::new("this is no spin"));
        };
        let marginal = |values: &Values, key| {
            Marginal::read(values.required(key)?).map_err(|error| error.at(key))
        };
        match *name {
            "components_rad_s" => Ok(Self::Components(read_vector(inner)?)),
            ISOTROPIC => Ok(Self::isotropic(inner.number()?)),
            "about" => {
                let values = inner.table()?;
                let axis = read_direction(values.required("axis")?);
                Ok(Self::About {
                    axis: axis.map_err(|error| error.at("axis"))?,
                    rate_rad_s: marginal(values, "rate_rad_s")?,
                })
            }
            "precessing" => {
                let values = inner.table()?;
                Ok(Self::Precessing {
                    rate_rad_s: marginal(values, "rate_rad_s")?,
                    psi_rad: marginal(values, "psi_deg")?.scaled(f64::to_radians),
                })
            }
            _ => Err(unlisted("spin", name).into()),
        }
    }

    /// The reverse of [`read`](Self::read).
    pub(super) fn value(&self) -> Value {
        let table =
            |name, entries| Value::Tagged(name, Box::new(Value::Table(Values::new(entries))));
        match self {
            Self::Components(components) => {
                Value::Tagged("components_rad_s", Box::new(vector_value(components)))
            }
            Self::About { axis, rate_rad_s } => table(
                "about",
                vec![
                    ("axis", direction_value(axis)),
                    ("rate_rad_s", rate_rad_s.value()),
                ],
            ),
            Self::Precessing {
                rate_rad_s,
                psi_rad,
            } => table(
                "precessing",
                vec![
                    ("rate_rad_s", rate_rad_s.value()),
                    ("psi_deg", psi_rad.scaled(to_degrees).value()),
                ],
            ),
        }
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`LaunchError`] if a marginal is not a distribution.
    pub fn validate(&self) -> Result<(), LaunchError> {
        match self {
            Self::Components(components) => components.iter().try_for_each(Marginal::validate),
            Self::About { rate_rad_s, .. } => rate_rad_s.validate(),
            Self::Precessing {
                rate_rad_s,
                psi_rad,
            } => {
                rate_rad_s.validate()?;
                psi_rad.validate()
            }
        }
    }

    /// The angular velocity of these uniforms for a coin turned to `axis`, rad/s.
    #[inline]
    pub fn angular_velocity(
        &self,
        coin: &Coin,
        axis: &UnitVector3<f64>,
        uniforms: &mut impl UniformSource,
    ) -> Vector3<f64> {
        self.draw(coin, [axis.x, axis.y, axis.z], uniforms).into()
    }

    /// The angular velocity in every lane.
    #[inline(always)]
    pub(super) fn draw<L: Lane>(
        &self,
        coin: &Coin,
        axis: [L; 3],
        uniforms: &mut impl Uniforms<L>,
    ) -> [L; 3] {
        let [a, b, c] = SPIN;
        match self {
            Self::Components(components) => sample3(components, SPIN, uniforms),
            Self::About { axis, rate_rad_s } => {
                let rate = rate_rad_s.sample(a, uniforms);
                let k = L::splat;
                [k(axis.x) * rate, k(axis.y) * rate, k(axis.z) * rate]
            }
            Self::Precessing {
                rate_rad_s,
                psi_rad,
            } => {
                let rate = rate_rad_s.sample(a, uniforms);
                let (sin_psi, cos_psi) = sin_cos(psi_rad.sample(b, uniforms));
                let (sin, cos) = sin_cos(L::splat(TAU) * uniforms.uniform(c));
                let (e1, e2) = normals(axis);
                // L = I_t·rate·(cos ψ u + sin ψ e): its component along u belongs to I_a
                let along = cos_psi * L::splat(coin.transverse_gyration_m2())
                    / L::splat(coin.axial_gyration_m2());
                let mut spin = axis;
                for (i, part) in spin.iter_mut().enumerate() {
                    *part = (*part * along + (e1[i] * cos + e2[i] * sin) * sin_psi) * rate;
                }
                spin
            }
        }
    }

    /// Whether the spin is always about y.
    pub fn is_planar(&self) -> bool {
        const NONE: Marginal = Marginal::Constant(0.0);
        match self {
            Self::Components([x, _, z]) => *x == NONE && *z == NONE,
            Self::About { axis, .. } => axis.x == 0.0 && axis.z == 0.0,
            Self::Precessing { .. } => false,
        }
    }
}

/// Two unit vectors that complete u to an orthonormal triad.
///
/// Duff et al., "Building an orthonormal basis, revisited", JCGT 6 (2017) 1: no branch, no
/// singular direction.
#[inline(always)]
fn normals<L: Lane>([x, y, z]: [L; 3]) -> ([L; 3], [L; 3]) {
    let one = L::splat(1.0);
    let sign = one.copysign(z);
    let a = -one / (sign + z);
    let b = x * y * a;
    (
        [one + sign * x * x * a, sign * b, -sign * x],
        [b, sign + y * y * a, -y],
    )
}
