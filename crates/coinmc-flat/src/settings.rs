//! What a user may choose about the flat engine.

use crate::laws::gaek_sukhov::GaekSukhov;
use crate::laws::half_sine::HalfSine;
use crate::laws::line_contact::LineContact;
use thiserror::Error;

/// The law of impact at a corner.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Law {
    /// Newton restitution, Coulomb friction against the final slip (Moreau 1988), guarded by
    /// Chatterjee–Ruina where that would gain energy.
    #[default]
    Moreau,
    /// Chatterjee & Ruina (1998), tangential restitution 0.
    ChatterjeeRuina,
    /// Gaek & Sukhov's law as published.
    GaekSukhov(GaekSukhov),
    /// A force that is half a sine in time.
    HalfSine(HalfSine),
    /// Elastic line contact with damping and friction, resolved in time.
    LineContact(LineContact),
}

impl Law {
    /// The laws that are told by their names alone.
    pub const RIGID: [Self; 2] = [Self::Moreau, Self::ChatterjeeRuina];

    /// The name used in configs and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Moreau => "moreau",
            Self::ChatterjeeRuina => "chatterjee-ruina",
            Self::GaekSukhov(_) => "gaek-sukhov",
            Self::HalfSine(_) => "half-sine",
            Self::LineContact(_) => "line-contact",
        }
    }

    fn validate(self) -> Result<(), SettingsError> {
        match self {
            Self::Moreau | Self::ChatterjeeRuina => Ok(()),
            Self::GaekSukhov(gaek_sukhov) => gaek_sukhov.validate(),
            Self::HalfSine(pulse) => pulse.validate(),
            Self::LineContact(line) => line.validate(),
        }
    }
}

/// When the face of a toss counts as decided.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Decision {
    /// When energy alone makes it certain.
    #[default]
    Energy,
    /// When the mechanical energy has fallen to this fraction of its initial value (0.01 in Gaek
    /// & Sukhov, arXiv 2401.03557) or the face is certain. The toss is followed on to the certain
    /// end, and counted as `overruled` where the two disagree.
    EnergyFraction(f64),
}

/// Settings of the flat engine. The defaults are converged: see docs/validation/planar.md.
///
/// # Example
/// ```
/// use coinmc_flat::Settings;
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
    /// Relative error allowed per step of the integration of sliding contact, and of impacts that
    /// are resolved in time.
    pub tolerance: f64,
    /// Impacts, or steps of sustained contact, after which a toss is given up as undecided.
    pub max_impacts: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            law: Law::default(),
            decision: Decision::default(),
            zeno: 0.01,
            tolerance: 1e-6,
            max_impacts: 100_000,
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
    /// No impact is allowed.
    #[error("max_impacts must be at least 1")]
    MaxImpacts,
    /// The energy fraction lies outside (0, 1).
    #[error("energy_fraction must lie in (0, 1), not {0}")]
    EnergyFraction(f64),
    /// A quantity of the law of impact is out of its range.
    #[error("{name} must be {range}, not {found}")]
    Quantity {
        /// Its name, with its unit.
        name: &'static str,
        /// Where it must lie.
        range: &'static str,
        /// What was given.
        found: f64,
    },
    /// Gaek & Sukhov's law has no friction.
    #[error("Gaek & Sukhov's law knows no friction: friction must be 0, not {0}")]
    Friction(f64),
}

impl Settings {
    /// Checks every setting.
    ///
    /// # Errors
    /// The first [`SettingsError`] in the order of the fields.
    pub fn validate(&self) -> Result<(), SettingsError> {
        self.law.validate()?;
        if let Decision::EnergyFraction(fraction) = self.decision
            && !(fraction > 0.0 && fraction < 1.0)
        {
            return Err(SettingsError::EnergyFraction(fraction));
        }
        if !(self.zeno > 0.0 && self.zeno <= 1.0) {
            return Err(SettingsError::Zeno(self.zeno));
        }
        if !(1e-12..=1e-2).contains(&self.tolerance) {
            return Err(SettingsError::Tolerance(self.tolerance));
        }
        if self.max_impacts == 0 {
            return Err(SettingsError::MaxImpacts);
        }
        Ok(())
    }
}

/// A positive, finite quantity of a law.
pub(crate) fn positive(name: &'static str, found: f64) -> Result<(), SettingsError> {
    if found > 0.0 && found.is_finite() {
        Ok(())
    } else {
        Err(SettingsError::Quantity {
            name,
            range: "positive and finite",
            found,
        })
    }
}
