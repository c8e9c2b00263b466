//! The surface that the coin lands on.

use crate::schema::{
    Absent, Bounds, Condition, Fallback, ReadError, Rule, TableKind, Values, choice, default,
    number,
};
use crate::{Roughness, RoughnessError};
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

impl Landing {
    /// Both ways of landing.
    pub const ALL: [Self; 2] = [Self::Bouncing, Self::Adhesive];

    /// The name used in configs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bouncing => "bouncing",
            Self::Adhesive => "adhesive",
        }
    }

    /// What it means.
    fn doc(self) -> &'static str {
        match self {
            Self::Bouncing => "impacts, rocking, sliding, settling",
            Self::Adhesive => "the first contact decides",
        }
    }
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
    roughness: Option<Roughness>,
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
    /// The keys of the table `[surface]` of a config.
    pub fn schema() -> TableKind {
        TableKind {
            fields: vec![
                number(
                    "restitution",
                    "Coefficient of restitution e at the contact point.",
                    Bounds::closed(0.0, 1.0),
                    Absent::Omitted,
                ),
                number(
                    "friction",
                    "Coefficient of friction μ.",
                    Bounds::closed(0.0, 1e6),
                    Absent::Omitted,
                ),
                number(
                    "rolling_friction_m",
                    "Rolling (contour) friction length, m: the power lost is normal force × this × rate \
                     at which the contact point moves along the rim. Coins on hard surfaces: about \
                     0.001 to 0.01 R.",
                    Bounds::closed(0.0, 1e6),
                    default(0.0),
                ),
                number(
                    "pivoting_friction_m",
                    "Pivoting friction length, m: the power lost is normal force × this × rate at which \
                     the coin turns about the vertical.",
                    Bounds::closed(0.0, 1e6),
                    default(0.0),
                ),
                number(
                    "restitution_threshold_m_s",
                    "Speed of approach, m/s, below which a contact point does not bounce (restitution \
                     0), as in game engines; nature has none.",
                    Bounds::closed(0.0, 1e6),
                    default(0.0),
                ),
                number(
                    "roughness_slope",
                    "Rms slope of the ground along any direction; 0: a perfect plane. With \
                     `roughness_wavelength_m`.",
                    Bounds::closed(0.0, Roughness::STEEPEST),
                    default(0.0),
                ),
                number(
                    "roughness_wavelength_m",
                    "Wavelength of the ground, m: mean distance between places where a profile rises \
                     through its mean. With `roughness_slope`.",
                    Bounds::closed(0.0, 1e6),
                    default(0.0),
                ),
                choice(
                    "landing",
                    "What a contact does.",
                    Landing::ALL.map(|landing| (landing.name(), landing.doc())),
                    Landing::default().name(),
                ),
            ],
            rules: vec![Rule::Unless {
                condition: Condition::Word("landing", Landing::Adhesive.name()),
                keys: &["restitution", "friction"],
                fallback: Some(Fallback::Number(0.0)),
            }],
        }
    }

    /// The surface that a config gives.
    ///
    /// # Errors
    /// [`ReadError`] where [`SurfaceError`] applies.
    pub fn read(values: &Values) -> Result<Self, ReadError> {
        let number = |key| values.number(key);
        let landing = values.one_of("landing", Landing::ALL, Landing::name)?;
        let (rolling, pivoting) = (
            number("rolling_friction_m")?,
            number("pivoting_friction_m")?,
        );
        let threshold = number("restitution_threshold_m_s")?;
        let roughness = read_roughness(
            number("roughness_slope")?,
            number("roughness_wavelength_m")?,
        )?;
        Self::new(number("restitution")?, number("friction")?)
            .and_then(|surface| surface.with_friction_lengths(rolling, pivoting))
            .and_then(|surface| surface.with_restitution_threshold(threshold))
            .map(|surface| surface.with_roughness(roughness).with_landing(landing))
            .map_err(|error| ReadError::new(error.to_string()))
    }

    /// A surface that no coin leaves: the assumption of the closed forms.
    pub const fn adhesive() -> Self {
        Self {
            restitution: 0.0,
            friction: 0.0,
            rolling_friction_m: 0.0,
            pivoting_friction_m: 0.0,
            threshold_m_s: 0.0,
            roughness: None,
            landing: Landing::Adhesive,
        }
    }

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
            roughness: None,
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

    /// The same surface with another roughness; `None` is a perfect plane.
    #[must_use]
    pub fn with_roughness(self, roughness: Option<Roughness>) -> Self {
        Self { roughness, ..self }
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

    /// How rough the ground is; `None` for a perfect plane.
    pub fn roughness(&self) -> Option<Roughness> {
        self.roughness
    }

    /// How the coin lands.
    pub fn landing(&self) -> Landing {
        self.landing
    }
}

/// The roughness that a config gives by these two numbers, both 0 for a plane.
fn read_roughness(slope: f64, wavelength_m: f64) -> Result<Option<Roughness>, ReadError> {
    let lacks = |given: &str, key: &'static str| {
        Err(ReadError::new(format!("{given} needs `{key}` as well")).at(key))
    };
    match (slope > 0.0, wavelength_m > 0.0) {
        (false, false) => Ok(None),
        (true, false) => lacks("`roughness_slope`", "roughness_wavelength_m"),
        (false, true) => lacks("`roughness_wavelength_m`", "roughness_slope"),
        (true, true) => Roughness::new(slope, wavelength_m)
            .map(Some)
            .map_err(|error: RoughnessError| ReadError::new(error.to_string())),
    }
}
