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
    rolling_friction_m: f64,
    pivoting_friction_m: f64,
    threshold_m_s: f64,
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
    /// A friction length is negative or not finite.
    #[error("friction lengths must be finite and not negative, not {0} m")]
    FrictionLength(f64),
    /// The restitution threshold is negative or not finite.
    #[error("restitution threshold must be finite and not negative, not {0} m/s")]
    Threshold(f64),
    /// A drag rate is negative or not finite.
    #[error("drag must be finite and not negative, not {0} /s")]
    Drag(f64),
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
            rolling_friction_m: 0.0,
            pivoting_friction_m: 0.0,
            threshold_m_s: 0.0,
            landing: Landing::Bouncing,
        })
    }

    /// The same surface with rolling-type friction at the contact point, by two lengths
    /// (Leine 2009): under the normal force N, *contour* friction takes the power N ρ_c |ψ'| from
    /// a contact point that wanders along the rim at the rate ψ', *pivoting* friction N ρ_p |ω_z|
    /// from a coin that turns about the vertical.
    ///
    /// # Errors
    /// [`SurfaceError::FrictionLength`] unless both are finite and not negative.
    pub fn with_friction_lengths(
        self,
        rolling_friction_m: f64,
        pivoting_friction_m: f64,
    ) -> Result<Self, SurfaceError> {
        for length in [rolling_friction_m, pivoting_friction_m] {
            if !(length >= 0.0 && length.is_finite()) {
                return Err(SurfaceError::FrictionLength(length));
            }
        }
        Ok(Self {
            rolling_friction_m,
            pivoting_friction_m,
            ..self
        })
    }

    /// The same surface where contacts that approach more slowly than this do not bounce (e = 0
    /// there), as physics engines have it (PhysX: `bounceThresholdVelocity`, 2 m/s in Unity).
    ///
    /// # Errors
    /// [`SurfaceError::Threshold`] unless finite and not negative.
    pub fn with_restitution_threshold(self, threshold_m_s: f64) -> Result<Self, SurfaceError> {
        if threshold_m_s >= 0.0 && threshold_m_s.is_finite() {
            Ok(Self {
                threshold_m_s,
                ..self
            })
        } else {
            Err(SurfaceError::Threshold(threshold_m_s))
        }
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

    /// Contour (rolling) friction length ρ_c, m.
    pub fn rolling_friction_m(&self) -> f64 {
        self.rolling_friction_m
    }

    /// Pivoting friction length ρ_p, m.
    pub fn pivoting_friction_m(&self) -> f64 {
        self.pivoting_friction_m
    }

    /// Approach speed of the contact point below which restitution is 0, m/s; 0: none.
    pub fn restitution_threshold_m_s(&self) -> f64 {
        self.threshold_m_s
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
    drag: Drag,
    gyroscopic_torque: bool,
}

/// Linear drag in flight and in contact: v' = −linear·v, L' = −angular·L on top of all else.
///
/// # Example
/// ```
/// use coinmc_core::Drag;
/// assert!(Drag::new(1.0, 0.05).is_ok() && Drag::new(-1.0, 0.0).is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Drag {
    linear_per_s: f64,
    angular_per_s: f64,
}

impl Drag {
    /// Rates of decay of the centre's velocity and of the angular momentum, 1/s.
    ///
    /// # Errors
    /// [`SurfaceError::Drag`] unless both are finite and not negative.
    pub fn new(linear_per_s: f64, angular_per_s: f64) -> Result<Self, SurfaceError> {
        for rate in [linear_per_s, angular_per_s] {
            if !(rate >= 0.0 && rate.is_finite()) {
                return Err(SurfaceError::Drag(rate));
            }
        }
        Ok(Self {
            linear_per_s,
            angular_per_s,
        })
    }

    /// Rate at which the centre's velocity decays, 1/s.
    pub fn linear_per_s(&self) -> f64 {
        self.linear_per_s
    }

    /// Rate at which the angular momentum decays, 1/s.
    pub fn angular_per_s(&self) -> f64 {
        self.angular_per_s
    }

    /// Whether there is none.
    pub fn is_none(&self) -> bool {
        self.linear_per_s == 0.0 && self.angular_per_s == 0.0
    }
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
                drag: Drag::default(),
                gyroscopic_torque: true,
            })
        } else {
            Err(SurfaceError::Gravity(gravity_m_s2))
        }
    }

    /// The same scene with drag.
    pub fn with_drag(self, drag: Drag) -> Self {
        Self { drag, ..self }
    }

    /// The same scene with or without the gyroscopic torque ω × Iω. Without it a coin turns about
    /// a fixed ω instead of a fixed L, which it does not keep: unphysical, and what PhysX (hence
    /// Unity) does unless told otherwise.
    pub fn with_gyroscopic_torque(self, gyroscopic_torque: bool) -> Self {
        Self {
            gyroscopic_torque,
            ..self
        }
    }

    /// The drag.
    pub fn drag(&self) -> Drag {
        self.drag
    }

    /// Whether ω × Iω acts, as it does in nature.
    pub fn has_gyroscopic_torque(&self) -> bool {
        self.gyroscopic_torque
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
        let surface = Surface::new(0.5, 0.3).unwrap();
        for bad in [-1e-9, f64::NAN, f64::INFINITY] {
            assert!(surface.with_friction_lengths(bad, 0.0).is_err());
            assert!(surface.with_friction_lengths(0.0, bad).is_err());
            assert!(surface.with_restitution_threshold(bad).is_err());
            assert!(Drag::new(bad, 0.0).is_err() && Drag::new(0.0, bad).is_err());
        }
        let coin = Coin::cylinder(1.0, 1.0).unwrap();
        for g in [0.0, -9.81, f64::NAN, f64::INFINITY] {
            assert!(Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), g).is_err());
        }
    }
}
