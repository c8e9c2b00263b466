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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::descriptor::ENGINE;
    use crate::{GaekSukhov, HalfSine, Lever, LineContact, Materials, PulseTime};
    use coinmc_core::EngineSettings;
    use coinmc_testkit::scene;

    fn values(law: Value, decision: Value) -> Values {
        Values::new(vec![
            ("law", law),
            ("decision", decision),
            ("zeno", Value::Number(0.02)),
            ("tolerance", Value::Number(1e-7)),
            ("max_impacts", Value::Integer(500)),
        ])
    }

    fn law(name: &'static str, entries: Vec<(&'static str, Value)>) -> Value {
        Value::Tagged(name, Box::new(Value::Table(Values::new(entries))))
    }

    fn read(given: Value) -> Settings {
        Settings::from_values(&values(given, Value::Word("energy"))).expect("all is there")
    }

    #[test]
    fn every_key_is_read() {
        let fraction = Value::Tagged("energy_fraction", Box::new(Value::Number(0.25)));
        for (decision, expected) in [
            (Value::Word("energy"), Decision::Energy),
            (fraction, Decision::EnergyFraction(0.25)),
        ] {
            let found = Settings::from_values(&values(Value::Word("moreau"), decision));
            let expected = Settings {
                law: Law::Moreau,
                decision: expected,
                zeno: 0.02,
                tolerance: 1e-7,
                max_impacts: 500,
            };
            assert_eq!(found.expect("all is there"), expected);
        }
    }

    #[test]
    fn each_law_is_read_with_its_parameters_by_its_name() {
        let steel = || {
            vec![
                ("coin_young_pa", Value::Number(206e9)),
                ("coin_poisson", Value::Number(0.3)),
                ("surface_young_pa", Value::Number(207e9)),
                ("surface_poisson", Value::Number(0.31)),
                ("length_m", Value::Number(0.02)),
            ]
        };
        let materials = Materials {
            coin_young_pa: 206e9,
            coin_poisson: 0.3,
            surface_young_pa: 207e9,
            surface_poisson: 0.31,
            length_m: 0.02,
        };
        let lever = |lever: &'static str| {
            let entries = vec![
                ("eta_n_s", Value::Number(0.01)),
                ("lever", Value::Word(lever)),
            ];
            law("gaek-sukhov", entries)
        };
        let gaek_sukhov = |lever: Lever| {
            Law::GaekSukhov(GaekSukhov {
                eta_n_s: 0.01,
                lever,
            })
        };
        let half_sine = |time: PulseTime, peak_n: Option<f64>| {
            let law = HalfSine { time, peak_n };
            Law::HalfSine(law)
        };
        let line_contact = |tangential: f64| {
            Law::LineContact(LineContact {
                materials,
                tangential,
            })
        };
        let mut stiff = steel();
        stiff.push(("tangential", Value::Number(0.9)));
        let given = vec![
            ("time_s", Value::Number(1e-4)),
            ("peak_n", Value::Number(30.0)),
        ];
        let contact = vec![("contact", Value::Table(Values::new(steel())))];
        for (value, expected, name) in [
            (Value::Word("moreau"), Law::Moreau, "moreau"),
            (
                Value::Word("chatterjee-ruina"),
                Law::ChatterjeeRuina,
                "chatterjee-ruina",
            ),
            (lever("height"), gaek_sukhov(Lever::Height), "gaek-sukhov"),
            (
                lever("diameter"),
                gaek_sukhov(Lever::Diameter),
                "gaek-sukhov",
            ),
            (lever("corner"), gaek_sukhov(Lever::Corner), "gaek-sukhov"),
            (
                law("half-sine", given),
                half_sine(PulseTime::Given(1e-4), Some(30.0)),
                "half-sine",
            ),
            (
                law("half-sine", contact),
                half_sine(PulseTime::Contact(materials), None),
                "half-sine",
            ),
            (
                law("line-contact", steel()),
                line_contact(LineContact::mindlin(0.3)),
                "line-contact",
            ),
            (
                law("line-contact", stiff),
                line_contact(0.9),
                "line-contact",
            ),
        ] {
            let found = read(value);
            assert_eq!(found.law, expected);
            // results name it as the config does
            assert_eq!(EngineSettings::law(&found), name);
            assert!(LAWS.iter().any(|law| law.name == name));
            assert!(found.explain(&scene(1.0, 0.5, 0.0)).contains(name));
        }
        let unknown = values(Value::Word("newton"), Value::Word("energy"));
        assert!(Settings::from_values(&unknown).is_err());
    }

    /// Flight is in closed form for any time, so that quadrature may take the place of tosses.
    #[test]
    fn flight_has_no_limit_of_time() {
        let settings = read(Value::Word("moreau"));
        assert_eq!(
            settings.flight_limit_s(&scene(1.0, 0.5, 0.3)),
            Some(f64::INFINITY)
        );
        assert_eq!(settings.descriptor().name, ENGINE.name);
    }
}
