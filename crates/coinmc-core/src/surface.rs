//! The surface that the coin lands on.

mod keys;

use crate::{Roughness, RoughnessError, TableTilt, TableTiltError};
use thiserror::Error;

/// Speed of approach at which the coefficient of restitution is meant if none is given.
const DEFAULT_REFERENCE_M_S: f64 = 1.0;

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
    /// e falls with the speed of approach v as v^−exponent and is as given at the reference speed.
    exponent: f64,
    reference_m_s: f64,
    roughness: Option<Roughness>,
    landing: Landing,
    table_radius_m: Option<f64>,
    tilt: Option<TableTilt>,
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
    /// The exponent of restitution lies outside [0, 1].
    #[error("restitution exponent must lie in [0, 1], not {0}")]
    Exponent(f64),
    /// The reference speed of restitution is not a positive finite speed.
    #[error("restitution reference must be positive and finite, not {0} m/s")]
    Reference(f64),
    /// The radius of the table is not a positive finite length.
    #[error("the radius of the table must be positive and finite, not {0} m")]
    TableRadius(f64),
    /// The tilt of the table cannot be modelled.
    #[error(transparent)]
    Tilt(#[from] TableTiltError),
    /// The table is so steep that coins slide off.
    #[error(
        "a table tilted by {tilt_deg}° needs friction above tan {tilt_deg}° = {slope:.4}, not {friction}"
    )]
    Steep {
        /// The tilt, degrees.
        tilt_deg: f64,
        /// Its tangent.
        slope: f64,
        /// μ.
        friction: f64,
    },
    /// An adhesive landing on a tilted table.
    #[error("an adhesive landing on a tilted table is not modelled")]
    TiltedAdhesive,
    /// The roughness cannot be modelled.
    #[error(transparent)]
    Roughness(#[from] RoughnessError),
    /// A coin with a conical edge on ground for which it is not modelled.
    #[error("a coin with a conical edge (draft) is not modelled {0}")]
    Conical(&'static str),
    /// A coin with its centre of mass off the middle on such ground.
    #[error("a coin with its centre of mass off the middle is not modelled {0}")]
    Loaded(&'static str),
    /// A drag rate is negative or not finite.
    #[error("drag must be finite and not negative, not {0} /s")]
    Drag(f64),
    /// g is not a positive finite acceleration.
    #[error("gravity must be positive and finite, not {0} m/s²")]
    Gravity(f64),
}

impl Surface {
    /// A surface that no coin leaves: the assumption of the closed forms.
    pub const fn adhesive() -> Self {
        Self {
            restitution: 0.0,
            friction: 0.0,
            rolling_friction_m: 0.0,
            pivoting_friction_m: 0.0,
            threshold_m_s: 0.0,
            exponent: 0.0,
            reference_m_s: DEFAULT_REFERENCE_M_S,
            roughness: None,
            landing: Landing::Adhesive,
            table_radius_m: None,
            tilt: None,
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
            exponent: 0.0,
            reference_m_s: DEFAULT_REFERENCE_M_S,
            roughness: None,
            landing: Landing::Bouncing,
            table_radius_m: None,
            tilt: None,
        })
    }

    /// The same surface with another coefficient of restitution and another friction coefficient.
    ///
    /// # Errors
    /// Those of [`new`](Self::new), and [`SurfaceError::Steep`] on a tilted table.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::Surface;
    /// let wood = Surface::new(0.5, 0.3)?.with_table_radius(0.2)?;
    /// let waxed = wood.with_impact(0.5, 0.1)?;
    /// assert_eq!((waxed.friction(), waxed.table_radius_m()), (0.1, Some(0.2)));
    /// # Ok::<(), coinmc_core::SurfaceError>(())
    /// ```
    pub fn with_impact(self, restitution: f64, friction: f64) -> Result<Self, SurfaceError> {
        let Self {
            restitution,
            friction,
            ..
        } = Self::new(restitution, friction)?;
        let surface = Self {
            restitution,
            friction,
            ..self
        };
        match self.tilt {
            Some(tilt) => surface.with_tilt(tilt),
            None => Ok(surface),
        }
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

    /// The same surface where restitution falls with the speed of approach v of the contact point:
    /// e(v) = e min(1, (v/v_ref)^−p), with e as given up to the reference speed v_ref.
    ///
    /// p = 1/4 is the law of fully plastic impact (Johnson, Contact Mechanics, 1985, § 11.5; coins of
    /// metal above some 0.1 m/s); p = 0, the default, is Newton's constant e.
    ///
    /// # Errors
    /// [`SurfaceError`] unless 0 <= p <= 1 and the reference speed is positive and finite.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::Surface;
    /// let steel = Surface::new(0.5, 0.2)?.with_speed_dependent_restitution(0.25, 1.0)?;
    /// assert!((steel.restitution_at(10.0) - 0.281).abs() < 1e-3);
    /// assert_eq!(steel.restitution_at(1e-3), 0.5);
    /// # Ok::<(), coinmc_core::SurfaceError>(())
    /// ```
    pub fn with_speed_dependent_restitution(
        self,
        exponent: f64,
        reference_m_s: f64,
    ) -> Result<Self, SurfaceError> {
        if !(0.0..=1.0).contains(&exponent) {
            return Err(SurfaceError::Exponent(exponent));
        }
        if !(reference_m_s > 0.0 && reference_m_s.is_finite()) {
            return Err(SurfaceError::Reference(reference_m_s));
        }
        Ok(Self {
            exponent,
            reference_m_s,
            ..self
        })
    }

    /// The same surface with roughness, or without.
    pub fn with_roughness(self, roughness: Option<Roughness>) -> Self {
        Self { roughness, ..self }
    }

    /// The same surface with another way of landing.
    ///
    /// # Errors
    /// [`SurfaceError::TiltedAdhesive`] if coins are to stick to a tilted surface.
    pub fn with_landing(self, landing: Landing) -> Result<Self, SurfaceError> {
        if landing == Landing::Adhesive && self.tilt().is_some() {
            return Err(SurfaceError::TiltedAdhesive);
        }
        Ok(Self { landing, ..self })
    }

    /// The same surface as a round table of this radius, above whose middle the centre of the coin is
    /// launched. A coin leaves it, [`Ended::Left`](crate::Ended::Left), once its centre is beyond the
    /// edge.
    ///
    /// What a rim does at the edge itself is not modelled: a coin that hangs over the edge with its
    /// centre inside is still held by all of its rim. So the radius is meant to within the size of the
    /// coin.
    ///
    /// # Errors
    /// [`SurfaceError::TableRadius`] unless positive and finite.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::Surface;
    /// let tray = Surface::new(0.5, 0.3)?.with_table_radius(0.2)?;
    /// assert_eq!(tray.table_radius_m(), Some(0.2));
    /// # Ok::<(), coinmc_core::SurfaceError>(())
    /// ```
    pub fn with_table_radius(self, radius_m: f64) -> Result<Self, SurfaceError> {
        if radius_m > 0.0 && radius_m.is_finite() {
            let table_radius_m = Some(radius_m);
            Ok(Self {
                table_radius_m,
                ..self
            })
        } else {
            Err(SurfaceError::TableRadius(radius_m))
        }
    }

    /// The same surface as a tilted table. Launches keep their meaning in the laboratory, with the
    /// vertical as it is; the coin begins straight above the middle of the table.
    ///
    /// # Errors
    /// [`SurfaceError::Steep`] unless tan β < μ (a coin would slide for ever);
    /// [`SurfaceError::TiltedAdhesive`] if the landing is adhesive.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{Surface, TableTilt};
    /// let tilt = TableTilt::new(1.0, 0.0)?;
    /// let table = Surface::new(0.5, 0.3)?.with_tilt(tilt)?;
    /// assert_eq!(table.tilt(), Some(tilt));
    /// assert!(Surface::new(0.5, 0.01)?.with_tilt(tilt).is_err());
    /// # Ok::<(), coinmc_core::SurfaceError>(())
    /// ```
    pub fn with_tilt(self, tilt: TableTilt) -> Result<Self, SurfaceError> {
        if self.landing == Landing::Adhesive && !tilt.is_level() {
            return Err(SurfaceError::TiltedAdhesive);
        }
        if tilt.slope() >= self.friction && !tilt.is_level() {
            return Err(SurfaceError::Steep {
                tilt_deg: tilt.angle_deg(),
                slope: tilt.slope(),
                friction: self.friction,
            });
        }
        let tilt = Some(tilt);
        Ok(Self { tilt, ..self })
    }

    /// The tilt of the table; `None`: it is level.
    pub fn tilt(&self) -> Option<TableTilt> {
        self.tilt.filter(|tilt| !tilt.is_level())
    }

    /// The same surface without an edge.
    pub fn without_edge(self) -> Self {
        Self {
            table_radius_m: None,
            ..self
        }
    }

    /// Radius of the table, m; `None`: it is endless.
    pub fn table_radius_m(&self) -> Option<f64> {
        self.table_radius_m
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

    /// Exponent p with which restitution falls with the speed of approach; 0: it does not.
    pub fn restitution_exponent(&self) -> f64 {
        self.exponent
    }

    /// Approach speed at which restitution is [`restitution`](Self::restitution), m/s. Without an
    /// exponent it does not matter.
    pub fn restitution_reference_m_s(&self) -> f64 {
        self.reference_m_s
    }

    /// Coefficient of restitution of a contact point that approaches at this speed, m/s: with its
    /// exponent and threshold.
    pub fn restitution_at(&self, approach_m_s: f64) -> f64 {
        if approach_m_s < self.threshold_m_s {
            return 0.0;
        }
        if self.exponent == 0.0 {
            return self.restitution;
        }
        let faster = (approach_m_s / self.reference_m_s).max(1.0);
        self.restitution * libm::pow(faster, -self.exponent)
    }

    /// The roughness; `None` on a plane.
    pub fn roughness(&self) -> Option<Roughness> {
        self.roughness.filter(|roughness| !roughness.is_plane())
    }

    /// The roughness as given, of a plane too.
    pub(crate) fn given_roughness(&self) -> Option<Roughness> {
        self.roughness
    }

    /// How the coin lands.
    pub fn landing(&self) -> Landing {
        self.landing
    }
}

#[cfg(test)]
mod tests;
