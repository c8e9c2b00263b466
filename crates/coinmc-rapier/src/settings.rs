//! What a user may choose, and what is refused.

use thiserror::Error;

/// How Rapier solves friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FrictionModel {
    /// Coulomb's cone at every contact point.
    #[default]
    Coulomb,
    /// Rapier's own default: one cone in the middle of the contact points, and a torque about the
    /// normal.
    Simplified,
}

/// Which part of free flight is computed in closed form instead of stepped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Flight {
    /// All of it, to the moment of contact, where Rapier's steps begin anew.
    #[default]
    Contact,
    /// Whole steps, up to the last one that ends clear of the surface: what Rapier would do, without
    /// its errors of integration.
    Steps,
    /// None: Rapier makes every step.
    Off,
}

/// Who adds the gyroscopic torque between contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Gyroscopic {
    /// This engine: after every step ω turns about the coin's axis as that of a free top does. No
    /// energy is gained.
    #[default]
    Exact,
    /// Rapier: an explicit term, which gains energy.
    Rapier,
}

/// Who slows a coin that stands on its rim and spins about the vertical, where drag alone slows it:
/// only without gyroscopic torque does it stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Standing {
    /// This engine, by 30 % at a time, without the steps between. What tips the coin in the end is
    /// then another thing, and statistics are not those of [`Self::Rapier`].
    #[default]
    Drag,
    /// Rapier, step by step.
    Rapier,
}

/// When the face of a toss counts as decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Decision {
    /// When the energy that can still tilt the coin is too small to carry it over its rim.
    #[default]
    Tilting,
    /// When its whole energy is too small.
    Energy,
    /// When it has come to rest.
    Rest,
}

macro_rules! names {
    ($type:ident { $($variant:ident = $name:literal),+ }) => {
        impl $type {
            /// Every choice.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$variant),+];

            /// The name used in configs and results.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),+
                }
            }
        }
    };
}

names!(FrictionModel { Coulomb = "coulomb", Simplified = "simplified" });
names!(Flight { Contact = "contact", Steps = "steps", Off = "off" });
names!(Gyroscopic { Exact = "exact", Rapier = "rapier" });
names!(Standing { Drag = "drag", Rapier = "rapier" });
names!(Decision { Tilting = "tilting", Energy = "energy", Rest = "rest" });

impl Gyroscopic {
    pub(crate) fn is_rapiers(self) -> bool {
        self == Self::Rapier
    }
}

/// Settings of the engine.
///
/// # Example
/// ```
/// use coinmc_rapier::Settings;
/// assert!(Settings::default().validate().is_ok());
/// assert!(Settings { substeps: 0, ..Settings::default() }.validate().is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Step, s.
    pub step_s: f64,
    /// Substeps of every step, in each of which Rapier solves its contacts once.
    pub substeps: u32,
    /// How friction is solved.
    pub friction_model: FrictionModel,
    /// Gap, in D, below which Rapier sees a contact.
    pub prediction: f64,
    /// Rapier's continuous collision detection. It does nothing for a half-space.
    pub ccd: bool,
    /// Who adds the gyroscopic torque, if the scene has one.
    pub gyroscopic: Gyroscopic,
    /// What of free flight is computed in closed form.
    pub flight: Flight,
    /// Who slows a coin that stands on its rim and spins.
    pub standing: Standing,
    /// Tosses that share one world, where there are many to make. With continuous collision
    /// detection, which may cut a step for all, a toss has the world to itself.
    pub tosses_at_once: u32,
    /// When a face counts as decided.
    pub decision: Decision,
    /// Rise of the energy above its value at launch, as a fraction of that, beyond which a toss has
    /// failed.
    pub max_gain: f64,
    /// Steps after which a toss is given up as undecided.
    pub max_steps: u32,
    /// Simulated time, in sqrt(D/g), after which a toss is given up as undecided.
    pub time_limit: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            step_s: 1e-3,
            substeps: 4,
            friction_model: FrictionModel::default(),
            prediction: 1e-3,
            ccd: false,
            gyroscopic: Gyroscopic::default(),
            flight: Flight::default(),
            standing: Standing::default(),
            tosses_at_once: 32,
            decision: Decision::default(),
            max_gain: 0.5,
            max_steps: 1_000_000,
            time_limit: 1000.0,
        }
    }
}

/// A setting outside its range.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SettingsError {
    /// The step lies outside (0, 100].
    #[error("step_s must lie in (0, 100], not {0}")]
    Step(f64),
    /// substeps lies outside 1 … 1000.
    #[error("substeps must lie in 1 … 1000, not {0}")]
    Substeps(u32),
    /// prediction lies outside (0, 1].
    #[error("prediction must lie in (0, 1], not {0}")]
    Prediction(f64),
    /// Rapier was not compiled: the feature `rapier` is off.
    #[error(
        "this build has no Rapier: build coinmc with the feature `rapier`, or toss with \
         engine.volumetric"
    )]
    NotBuilt,
    /// tosses_at_once lies outside 1 … 1000.
    #[error("tosses_at_once must lie in 1 … 1000, not {0}")]
    TossesAtOnce(u32),
    /// max_gain is not positive.
    #[error("max_gain must be positive, not {0}")]
    MaxGain(f64),
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
        let is_positive = |value: f64, most: f64| value > 0.0 && value <= most;
        if !is_positive(self.step_s, 100.0) {
            return Err(SettingsError::Step(self.step_s));
        }
        if !(1..=1000).contains(&self.substeps) {
            return Err(SettingsError::Substeps(self.substeps));
        }
        if !is_positive(self.prediction, 1.0) {
            return Err(SettingsError::Prediction(self.prediction));
        }
        if !(1..=1000).contains(&self.tosses_at_once) {
            return Err(SettingsError::TossesAtOnce(self.tosses_at_once));
        }
        if !cfg!(feature = "rapier") {
            return Err(SettingsError::NotBuilt);
        }
        if !is_positive(self.max_gain, f64::INFINITY) {
            return Err(SettingsError::MaxGain(self.max_gain));
        }
        if self.max_steps == 0 {
            return Err(SettingsError::MaxSteps);
        }
        if !is_positive(self.time_limit, f64::INFINITY) {
            return Err(SettingsError::TimeLimit(self.time_limit));
        }
        Ok(())
    }

    /// Coins in one world.
    pub(crate) fn slots(&self) -> usize {
        if self.ccd {
            1
        } else {
            self.tosses_at_once as usize
        }
    }
}
