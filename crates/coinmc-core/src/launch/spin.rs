//! How the coin spins when it is let go.

use super::dimension::SPIN;
use super::{LaunchError, Marginal, sample3};
use crate::{Coin, UniformSource};
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

impl Spin {
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
        let [a, b, c] = SPIN;
        match self {
            Self::Components(components) => sample3(components, SPIN, uniforms),
            Self::About { axis, rate_rad_s } => axis.into_inner() * rate_rad_s.sample(a, uniforms),
            Self::Precessing {
                rate_rad_s,
                psi_rad,
            } => {
                let rate = rate_rad_s.sample(a, uniforms);
                let (sin_psi, cos_psi) = libm::sincos(psi_rad.sample(b, uniforms));
                let (sin, cos) = libm::sincos(TAU * uniforms.uniform(c));
                let (e1, e2) = normals(axis);
                // L = I_t·rate·(cos ψ u + sin ψ e): its component along u belongs to I_a
                let along = cos_psi * coin.transverse_gyration_m2() / coin.axial_gyration_m2();
                (axis.into_inner() * along + (e1 * cos + e2 * sin) * sin_psi) * rate
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
fn normals(u: &UnitVector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let sign = 1.0_f64.copysign(u.z);
    let a = -1.0 / (sign + u.z);
    let b = u.x * u.y * a;
    (
        Vector3::new(1.0 + sign * u.x * u.x * a, sign * b, -sign * u.x),
        Vector3::new(b, sign + u.y * u.y * a, -u.y),
    )
}
