//! The settings of the planar engine.

use crate::laws::{LAWS, Law};
use crate::settings_error::SettingsError;
use coinmc_core::schema::{
    Absent, Bounds, Fallback, Kind, TableKind, Value, Values, Whole, Word, count, default, field,
    fields, number,
};
use coinmc_core::{EngineError, LawDescriptor};

/// When the face of a toss counts as decided.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Decision {
    /// When energy alone decides it.
    #[default]
    Energy,
    /// When the mechanical energy has fallen to this fraction of its initial value (0.01 in Gaek &
    /// Sukhov, arXiv 2401.03557), or energy alone decides it. The toss continues until energy alone
    /// decides, and is counted as `overruled` if the two faces differ.
    EnergyFraction(f64),
}

/// Settings of the planar engine. The defaults are converged: see docs/validation/planar.md.
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
    /// Sustained contact replaces a sequence of bounces when the rest of it would turn the coin by
    /// less than about this angle, rad.
    pub zeno: f64,
    /// Allowed relative error per step of the integration of sliding, and of impacts resolved in
    /// time.
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

const ENERGY_FRACTION: Bounds = Bounds::open(0.0, 1.0);
const ZENO: Bounds = Bounds::above_zero(1.0);
const TOLERANCE: Bounds = Bounds::closed(1e-12, 1e-2);

/// The name of the decision that needs no number.
const ENERGY: &str = "energy";

impl Settings {
    /// The keys of `[engine.flat]`.
    pub(crate) fn schema() -> TableKind {
        let settings = Self::default();
        fields(vec![
            LawDescriptor::field(&LAWS, settings.law.name()),
            field(
                "decision",
                "When the face of a toss counts as decided.",
                Kind::Choice(
                    vec![Word {
                        name: ENERGY,
                        doc: "when energy alone decides it",
                    }],
                    vec![number(
                        "energy_fraction",
                        "Decided when the energy has fallen to this fraction of its first value, or \
                         earlier if energy alone decides it.",
                        ENERGY_FRACTION,
                        Absent::Required,
                    )],
                ),
                Absent::Is(Fallback::Word(ENERGY)),
            ),
            number(
                "zeno",
                "A sequence of bounces becomes sustained contact when the rest of it would turn the \
                 coin by less than about this angle, rad.",
                ZENO,
                default(settings.zeno),
            ),
            number(
                "tolerance",
                "Relative error allowed per step of sliding contact and of impacts resolved in time.",
                TOLERANCE,
                default(settings.tolerance),
            ),
            count(
                "max_impacts",
                "Impacts after which a toss is given up as undecided.",
                settings.max_impacts,
            ),
        ])
    }

    /// The settings that the values of that table give.
    pub(crate) fn from_values(values: &Values) -> Result<Self, EngineError> {
        Ok(Self {
            law: Law::read(values)?,
            decision: match values.get("decision") {
                Some(Value::Tagged(_, fraction)) => Decision::EnergyFraction(fraction.number()?),
                _ => Decision::Energy,
            },
            zeno: values.number("zeno")?,
            tolerance: values.number("tolerance")?,
            max_impacts: values.integer("max_impacts")?,
        })
    }

    /// Checks every setting.
    ///
    /// # Errors
    /// The first [`SettingsError`] in the order of the fields.
    pub fn validate(&self) -> Result<(), SettingsError> {
        self.law.validate()?;
        if let Decision::EnergyFraction(fraction) = self.decision {
            ENERGY_FRACTION.check("energy_fraction", fraction)?;
        }
        ZENO.check("zeno", self.zeno)?;
        TOLERANCE.check("tolerance", self.tolerance)?;
        Ok(Whole::COUNT.check("max_impacts", self.max_impacts)?)
    }
}
