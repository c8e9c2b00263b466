//! Coins that start upright on the ground, on both rims.

use coinmc_core::{Coin, Launch};
use nalgebra::{UnitVector3, Vector3};

/// How an upright coin starts. The axis is along x, but for a lean about y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// Rolls along −y at this speed, m/s, without slip: ω = (v/R) u.
    Rolling(f64),
    /// Spins on the spot about the vertical at this rate, rad/s.
    Spinning(f64),
}

impl Start {
    /// The launch: at height 0, from which a coin is lifted until it touches, with the axis
    /// u = (cos lean, 0, sin lean).
    ///
    /// # Example
    /// ```
    /// use coinmc_core::Coin;
    /// use coinmc_oracle::Start;
    ///
    /// let coin = Coin::cylinder(0.2, 0.0116)?;
    /// let launch = Start::Rolling(0.3).launch(&coin, 1e-3);
    /// assert_eq!(launch.velocity_m_s.y, -0.3);
    /// assert!((launch.spin_rad_s.norm() - 0.3 / 0.0116).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn launch(&self, coin: &Coin, lean_rad: f64) -> Launch {
        let (sin, cos) = libm::sincos(lean_rad);
        let axis = UnitVector3::new_normalize(Vector3::new(cos, 0.0, sin));
        let (velocity, spin) = match *self {
            Self::Rolling(speed) => (
                Vector3::new(0.0, -speed, 0.0),
                axis.into_inner() * (speed / coin.radius_m()),
            ),
            Self::Spinning(rate) => (Vector3::zeros(), Vector3::z() * rate),
        };
        Launch {
            height_m: 0.0,
            velocity_m_s: velocity,
            axis,
            spin_rad_s: spin,
        }
    }
}
