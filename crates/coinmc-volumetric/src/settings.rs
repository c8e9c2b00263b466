//! What a user may choose about the volumetric engine.

use thiserror::Error;

/// The law of impact at the rim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Law {
    /// Newton restitution, Coulomb friction against the final slip (Moreau 1988), guarded by
    /// Chatterjee–Ruina where that would gain energy.
    #[default]
    Moreau,
    /// Chatterjee & Ruina (1998), tangential restitution 0.
    ChatterjeeRuina,
    /// Stronge's energetic restitution, the Darboux–Keller equations through slip reversals.
    Stronge,
}

impl Law {
    /// All laws.
    pub const ALL: [Self; 3] = [Self::Moreau, Self::ChatterjeeRuina, Self::Stronge];

    /// The name used in configs and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Moreau => "moreau",
            Self::ChatterjeeRuina => "chatterjee-ruina",
            Self::Stronge => "stronge",
        }
    }
}

/// When the face of a toss counts as decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Decision {
    /// When the energy that can still tilt the coin is too small to carry it over its rim: leaning
    /// to its side the energy of straight rolling is left out, the less of it the faster its axis
    /// will turn, flat on a face that of sliding and spinning; and when it lies on both rims and its
    /// weight has twice the moment that could lift one. Not quite rigorous; its bias is measured in
    /// docs/validation/spatial.md.
    #[default]
    Tilting,
    /// When the whole mechanical energy (without friction: all but that of motion which nothing
    /// can turn into tilt) is below m g D, D the distance of the rim from the centre: rigorous, and
    /// a coin that rolls along its side without loss is never decided.
    Energy,
}

impl Decision {
    /// All decisions.
    pub const ALL: [Self; 2] = [Self::Tilting, Self::Energy];

    /// The name used in configs and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tilting => "tilting",
            Self::Energy => "energy",
        }
    }
}

/// Settings of the volumetric engine. The defaults are converged: see docs/validation/spatial.md.
///
/// Speeds and times are in sqrt(g D) and sqrt(D/g), D = sqrt(R² + H²/4) being the distance of the
/// rim from the centre: the same settings serve a coin of any size.
///
/// # Example
/// ```
/// use coinmc_volumetric::Settings;
/// assert!(Settings::default().validate().is_ok());
/// assert!(Settings { zeno: 2.0, ..Settings::default() }.validate().is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Law of impact.
    pub law: Law,
    /// When the face counts as decided.
    pub decision: Decision,
    /// A sequence of bounces is replaced by sustained contact when all that remains of it would
    /// turn the coin by less than about this angle, rad.
    pub zeno: f64,
    /// Error allowed per step of the integration of sustained contact, absolute and relative, in
    /// units of the speed that would just carry the coin out of its shallower well.
    pub tolerance: f64,
    /// Slip, in sqrt(g D), below which a contact point that can stick does; also the creep below
    /// which friction holds a coin that lies on both rims.
    pub stick_speed: f64,
    /// Time, in sqrt(D/g), over which rolling and pivoting friction end the last of a rotation.
    pub smoothing_time: f64,
    /// Impacts after which a toss is given up as undecided.
    pub max_impacts: u32,
    /// Steps of sustained contact after which a toss is given up as undecided.
    pub max_steps: u32,
    /// Simulated time, in sqrt(D/g), after which a toss is given up as undecided.
    pub time_limit: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            law: Law::default(),
            decision: Decision::default(),
            zeno: 0.02,
            tolerance: 2e-4,
            stick_speed: 1e-2,
            smoothing_time: 1e-2,
            max_impacts: 100_000,
            max_steps: 1_000_000,
            time_limit: 1e12,
        }
    }
}

/// A setting outside its range.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SettingsError {
    /// zeno lies outside (0, 1].
    #[error("zeno must lie in (0, 1], not {0}")]
    Zeno(f64),
    /// tolerance lies outside [1e-12, 1e-2].
    #[error("tolerance must lie in [1e-12, 1e-2], not {0}")]
    Tolerance(f64),
    /// stick_speed lies outside (0, 0.1].
    #[error("stick_speed must lie in (0, 0.1], not {0}")]
    StickSpeed(f64),
    /// smoothing_time lies outside (0, 0.1].
    #[error("smoothing_time must lie in (0, 0.1], not {0}")]
    SmoothingTime(f64),
    /// No impact is allowed.
    #[error("max_impacts must be at least 1")]
    MaxImpacts,
    /// No step is allowed.
    #[error("max_steps must be at least 1")]
    MaxSteps,
    /// The time limit is not positive.
    #[error("time_limit must be positive, not {0}")]
    TimeLimit(f64),
}

impl Settings {
    /// Checks every setting.
    ///
    /// # Errors
    /// The first [`SettingsError`] in the order of the fields.
    pub fn validate(&self) -> Result<(), SettingsError> {
        if !(self.zeno > 0.0 && self.zeno <= 1.0) {
            return Err(SettingsError::Zeno(self.zeno));
        }
        if !(1e-12..=1e-2).contains(&self.tolerance) {
            return Err(SettingsError::Tolerance(self.tolerance));
        }
        if !(self.stick_speed > 0.0 && self.stick_speed <= 0.1) {
            return Err(SettingsError::StickSpeed(self.stick_speed));
        }
        if !(self.smoothing_time > 0.0 && self.smoothing_time <= 0.1) {
            return Err(SettingsError::SmoothingTime(self.smoothing_time));
        }
        if self.max_impacts == 0 {
            return Err(SettingsError::MaxImpacts);
        }
        if self.max_steps == 0 {
            return Err(SettingsError::MaxSteps);
        }
        if self.time_limit.is_nan() || self.time_limit <= 0.0 {
            return Err(SettingsError::TimeLimit(self.time_limit));
        }
        Ok(())
    }
}
