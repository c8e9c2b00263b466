//! The surface the coin lands on, and the scene: coin, surface and gravity together.

use crate::Coin;
use thiserror::Error;

/// What a contact with the surface does to the coin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Landing {
    /// Impacts follow the engine's impact law; the coin bounces, slides, rocks and settles.
    #[default]
    Bouncing,
    /// The first contact decides: the coin sticks and topples to the side its centre hangs over.
    ///
    /// This is what the closed forms assume. It is not `restitution = 0`: such a coin still
    /// rotates about the point that stuck and can roll over several edges.
    Adhesive,
}

/// Contact properties of the surface (of the pair coin–surface, strictly).
///
/// # Example
/// ```
/// use coinmc_core::Surface;
/// let wood = Surface::new(0.5, 0.3)?;
/// assert_eq!(wood.restitution(), 0.5);
/// assert!(Surface::new(1.2, 0.3).is_err());
/// # Ok::<(), coinmc_core::SurfaceError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    restitution: f64,
    friction: f64,
    landing: Landing,
}

/// Why a surface or scene cannot be built.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SurfaceError {
    /// e lies outside [0, 1].
    #[error("restitution must lie in [0, 1], not {0}")]
    Restitution(f64),
    /// μ is negative or not finite.
    #[error("friction must be finite and not negative, not {0}")]
    Friction(f64),
    /// g is not a positive finite acceleration.
    #[error("gravity must be positive and finite, not {0} m/s²")]
    Gravity(f64),
}

impl Surface {
    /// A bouncing surface with coefficient of restitution e (Newton's, at the contact point) and
    /// Coulomb friction coefficient μ (static = kinetic).
    ///
    /// # Errors
    /// [`SurfaceError`] unless 0 <= e <= 1 and μ >= 0 is finite.
    pub fn new(restitution: f64, friction: f64) -> Result<Self, SurfaceError> {
        if !(0.0..=1.0).contains(&restitution) {
            return Err(SurfaceError::Restitution(restitution));
        }
        if !(friction >= 0.0 && friction.is_finite()) {
            return Err(SurfaceError::Friction(friction));
        }
        Ok(Self {
            restitution,
            friction,
            landing: Landing::Bouncing,
        })
    }

    /// The same surface with another way of landing.
    pub fn with_landing(self, landing: Landing) -> Self {
        Self { landing, ..self }
    }

    /// Coefficient of restitution e, dimensionless, 0 to 1.
    pub fn restitution(&self) -> f64 {
        self.restitution
    }

    /// Coefficient of Coulomb friction μ, dimensionless.
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// How the coin lands.
    pub fn landing(&self) -> Landing {
        self.landing
    }
}

/// Everything about a toss that is not its launch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scene {
    /// What is tossed.
    pub coin: Coin,
    /// What it lands on.
    pub surface: Surface,
    gravity_m_s2: f64,
}

impl Scene {
    /// Standard acceleration of gravity as the literature on coins rounds it, m/s².
    pub const STANDARD_GRAVITY_M_S2: f64 = 9.81;

    /// A coin, a surface and the acceleration of gravity.
    ///
    /// # Errors
    /// [`SurfaceError::Gravity`] unless `gravity_m_s2` is positive and finite.
    pub fn new(coin: Coin, surface: Surface, gravity_m_s2: f64) -> Result<Self, SurfaceError> {
        if gravity_m_s2 > 0.0 && gravity_m_s2.is_finite() {
            Ok(Self {
                coin,
                surface,
                gravity_m_s2,
            })
        } else {
            Err(SurfaceError::Gravity(gravity_m_s2))
        }
    }

    /// Acceleration of gravity g, m/s².
    pub fn gravity_m_s2(&self) -> f64 {
        self.gravity_m_s2
    }

    /// sqrt(D/g), s: the time scale of a coin toppling over its rim.
    pub fn time_scale_s(&self) -> f64 {
        (self.coin.rim_distance_m() / self.gravity_m_s2).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_each_range_are_in_and_beyond_is_out() {
        assert!(Surface::new(0.0, 0.0).is_ok() && Surface::new(1.0, 1e6).is_ok());
        for (e, mu) in [
            (-1e-9, 0.0),
            (1.0 + 1e-9, 0.0),
            (0.5, -1e-9),
            (f64::NAN, 0.0),
        ] {
            assert!(Surface::new(e, mu).is_err(), "{e} {mu}");
        }
        assert!(Surface::new(0.5, f64::INFINITY).is_err());
        let coin = Coin::cylinder(1.0, 1.0).unwrap();
        for g in [0.0, -9.81, f64::NAN, f64::INFINITY] {
            assert!(Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), g).is_err());
        }
    }
}
