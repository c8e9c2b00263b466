//! What a user may choose, and what is refused.

use coinmc_core::EngineError;
use coinmc_core::schema::{
    Absent, Bounds, Fallback, Kind, OutOfRange, TableKind, Values, Whole, choice, count, default,
    field, fields, flag, number,
};
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
    ($type:ident { $($variant:ident = $name:literal: $doc:literal),+ $(,)? }) => {
        impl $type {
            /// Every choice.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$variant),+];

            /// The name used in configs and results.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),+
                }
            }

            fn doc(self) -> &'static str {
                match self {
                    $(Self::$variant => $doc),+
                }
            }
        }
    };
}

names!(FrictionModel {
    Coulomb = "coulomb": "Coulomb's cone at every contact point",
    Simplified = "simplified":
        "one cone amid the contact points and a torque about the normal: Rapier's own default",
});
names!(Flight {
    Contact = "contact": "all of it, to the moment of contact",
    Steps = "steps": "whole steps, up to the last one that ends clear of the surface",
    Off = "off": "none",
});
names!(Gyroscopic {
    Exact = "exact": "this engine, after every step, without gain of energy",
    Rapier = "rapier": "Rapier, by an explicit term that gains energy",
});
names!(Standing {
    Drag = "drag": "this engine, by 30 % at a time, without the steps between",
    Rapier = "rapier": "Rapier, step by step",
});
names!(Decision {
    Tilting = "tilting": "when the energy that can still tilt the coin is too small",
    Energy = "energy": "when the whole energy is too small",
    Rest = "rest": "when the coin has come to rest",
});

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

const STEP_S: Bounds = Bounds::above_zero(100.0);
const SUBSTEPS: Whole = Whole { low: 1, high: 1000 };
const PREDICTION: Bounds = Bounds::above_zero(1.0);
const TOSSES_AT_ONCE: Whole = Whole { low: 1, high: 1000 };
const MAX_GAIN: Bounds = Bounds::above_zero(1e6);
const TIME_LIMIT: Bounds = Bounds::above_zero(1e15);

/// A choice that has a name and a meaning.
macro_rules! named {
    ($key:literal, $doc:literal, $type:ident, $default:expr) => {
        choice(
            $key,
            $doc,
            $type::ALL.map(|one| (one.name(), one.doc())),
            $default.name(),
        )
    };
}

impl Settings {
    /// The keys of `[engine.rapier]`.
    pub(crate) fn schema() -> TableKind {
        let settings = Self::default();
        let whole = |name, doc, whole, fallback: u32| {
            let fallback = Fallback::Integer(u64::from(fallback));
            field(name, doc, Kind::Integer(whole), Absent::Is(fallback))
        };
        fields(vec![
            number("step_s", "Time step, s.", STEP_S, default(settings.step_s)),
            whole(
                "substeps",
                "Substeps of every step, in each of which contacts are solved once.",
                SUBSTEPS,
                settings.substeps,
            ),
            named!(
                "friction_model",
                "How friction is solved.",
                FrictionModel,
                settings.friction_model
            ),
            number(
                "prediction",
                "Gap below which Rapier sees a contact, as a fraction of the distance of the rim from \
                 the centre.",
                PREDICTION,
                default(settings.prediction),
            ),
            flag(
                "ccd",
                "Rapier's continuous collision detection; it does nothing for a plane.",
                settings.ccd,
            ),
            named!(
                "gyroscopic",
                "Who adds the gyroscopic torque, if there is one.",
                Gyroscopic,
                settings.gyroscopic
            ),
            named!(
                "flight",
                "What of free flight is computed in closed form instead of stepped.",
                Flight,
                settings.flight
            ),
            named!(
                "standing",
                "Who slows a coin that stands on its rim and spins, where drag alone does, without \
                 gyroscopic torque.",
                Standing,
                settings.standing
            ),
            whole(
                "tosses_at_once",
                "Tosses that share one world; 1 where ccd is on.",
                TOSSES_AT_ONCE,
                settings.tosses_at_once,
            ),
            named!(
                "decision",
                "When the face of a toss counts as decided.",
                Decision,
                settings.decision
            ),
            number(
                "max_gain",
                "Rise of the energy above its value at launch, as a fraction of it, beyond which a \
                 toss has failed.",
                MAX_GAIN,
                default(settings.max_gain),
            ),
            count(
                "max_steps",
                "Steps after which a toss is given up as undecided.",
                settings.max_steps,
            ),
            number(
                "time_limit",
                "Simulated time, in sqrt(D/g), after which a toss is given up as undecided.",
                TIME_LIMIT,
                default(settings.time_limit),
            ),
        ])
    }

    /// The settings that the values of that table give.
    pub(crate) fn from_values(values: &Values) -> Result<Self, EngineError> {
        Ok(Self {
            step_s: values.number("step_s")?,
            substeps: values.integer("substeps")?,
            friction_model: values.one_of(
                "friction_model",
                FrictionModel::ALL,
                FrictionModel::name,
            )?,
            prediction: values.number("prediction")?,
            ccd: values.boolean("ccd")?,
            gyroscopic: values.one_of("gyroscopic", Gyroscopic::ALL, Gyroscopic::name)?,
            flight: values.one_of("flight", Flight::ALL, Flight::name)?,
            standing: values.one_of("standing", Standing::ALL, Standing::name)?,
            tosses_at_once: values.integer("tosses_at_once")?,
            decision: values.one_of("decision", Decision::ALL, Decision::name)?,
            max_gain: values.number("max_gain")?,
            max_steps: values.integer("max_steps")?,
            time_limit: values.number("time_limit")?,
        })
    }

    /// Checks every setting.
    ///
    /// # Errors
    /// The first [`SettingsError`] in the order of the fields.
    pub fn validate(&self) -> Result<(), SettingsError> {
        STEP_S.check("step_s", self.step_s)?;
        SUBSTEPS.check("substeps", self.substeps)?;
        PREDICTION.check("prediction", self.prediction)?;
        TOSSES_AT_ONCE.check("tosses_at_once", self.tosses_at_once)?;
        if !cfg!(feature = "rapier") {
            return Err(SettingsError::NotBuilt);
        }
        MAX_GAIN.check("max_gain", self.max_gain)?;
        Whole::COUNT.check("max_steps", self.max_steps)?;
        Ok(TIME_LIMIT.check("time_limit", self.time_limit)?)
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

/// Settings that no engine has.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SettingsError {
    /// A setting is out of its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// Rapier was not compiled: the feature `rapier` is off.
    #[error(
        "this build has no Rapier: build coinmc with the feature `rapier`, or toss with \
         engine.volumetric"
    )]
    NotBuilt,
}
