//! What a user may choose about the volumetric engine.

use crate::laws::{LAWS, Law};
use coinmc_core::schema::{
    Bounds, OutOfRange, TableKind, Values, Whole, choice, count, default, fields, number,
};
use coinmc_core::{EngineError, LawDescriptor};

/// When the face of a toss counts as decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Decision {
    /// When the energy that can still tilt the coin is too small to carry it over its rim. Energy
    /// that cannot become tilt is left out: for a coin that leans towards its side a part of the
    /// energy of straight rolling (the less, the faster its axis turns), for a coin flat on a face
    /// that of sliding and spinning. Also when the coin lies on both rims and its weight has twice
    /// the moment that could lift one. Not quite rigorous: its bias is measured in
    /// docs/validation/spatial.md.
    #[default]
    Tilting,
    /// When the mechanical energy is below m g D, where D is the distance of the rim from the
    /// centre. (Without friction, energy of motion that cannot become tilt is left out.) Rigorous; a
    /// coin that rolls on its side without loss is never decided.
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

    fn doc(self) -> &'static str {
        match self {
            Self::Tilting => {
                "when the energy that can still tilt the coin is too small; its bias is measured"
            }
            Self::Energy => "when the whole energy is too small: rigorous, and slower",
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
    /// On rough ground, the way between the places at which the ground's height is taken, in its
    /// correlation length. Less is more accurate; coins that turn fast then also stay on rough ground while
    /// they lean more.
    pub ground_step: f64,
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
            ground_step: 0.5,
            max_impacts: 100_000,
            max_steps: 1_000_000,
            time_limit: 1e12,
        }
    }
}

const ZENO: Bounds = Bounds::above_zero(1.0);
const TOLERANCE: Bounds = Bounds::closed(1e-12, 1e-2);
/// Small numbers below which motion counts as none.
const SMALL: Bounds = Bounds::above_zero(0.1);
const GROUND_STEP: Bounds = Bounds::closed(0.01, 1.0);
const TIME_LIMIT: Bounds = Bounds::above_zero(1e15);

impl Settings {
    /// The keys of `[engine.volumetric]`.
    pub(crate) fn schema() -> TableKind {
        let settings = Self::default();
        fields(vec![
            LawDescriptor::field(&LAWS, settings.law.name()),
            choice(
                "decision",
                "When the face of a toss counts as decided.",
                Decision::ALL.map(|decision| (decision.name(), decision.doc())),
                settings.decision.name(),
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
                "Error allowed per step of sustained contact, relative to the speed that carries the \
                 coin out of its shallower well.",
                TOLERANCE,
                default(settings.tolerance),
            ),
            number(
                "stick_speed",
                "Slip, in sqrt(g D), below which a contact point that can stick does; D is the \
                 distance of the rim from the centre.",
                SMALL,
                default(settings.stick_speed),
            ),
            number(
                "smoothing_time",
                "Time, in sqrt(D/g), over which rolling and pivoting friction end the last of a \
                 rotation.",
                SMALL,
                default(settings.smoothing_time),
            ),
            number(
                "ground_step",
                "On rough ground: way between the places at which the ground's height is taken, in \
                 correlation lengths (wavelength/2π).",
                GROUND_STEP,
                default(settings.ground_step),
            ),
            count(
                "max_impacts",
                "Impacts after which a toss is given up as undecided.",
                settings.max_impacts,
            ),
            count(
                "max_steps",
                "Steps of sustained contact after which a toss is given up as undecided.",
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
            law: Law::read(values)?,
            decision: values.one_of("decision", Decision::ALL, Decision::name)?,
            zeno: values.number("zeno")?,
            tolerance: values.number("tolerance")?,
            stick_speed: values.number("stick_speed")?,
            smoothing_time: values.number("smoothing_time")?,
            ground_step: values.number("ground_step")?,
            max_impacts: values.integer("max_impacts")?,
            max_steps: values.integer("max_steps")?,
            time_limit: values.number("time_limit")?,
        })
    }

    /// Checks every setting.
    ///
    /// # Errors
    /// The first [`SettingsError`] in the order of the fields.
    pub fn validate(&self) -> Result<(), SettingsError> {
        ZENO.check("zeno", self.zeno)?;
        TOLERANCE.check("tolerance", self.tolerance)?;
        SMALL.check("stick_speed", self.stick_speed)?;
        SMALL.check("smoothing_time", self.smoothing_time)?;
        GROUND_STEP.check("ground_step", self.ground_step)?;
        Whole::COUNT.check("max_impacts", self.max_impacts)?;
        Whole::COUNT.check("max_steps", self.max_steps)?;
        TIME_LIMIT.check("time_limit", self.time_limit)
    }
}

/// A setting outside its range.
pub type SettingsError = OutOfRange;

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::schema::Value;

    /// Each decision has a name by which configs know it, and says when the face is decided: only one of them
    /// rigorously.
    #[test]
    fn decisions_are_told_apart() {
        assert_eq!(Decision::ALL.map(Decision::name), ["tilting", "energy"]);
        let docs = Decision::ALL.map(Decision::doc);
        assert!(docs.iter().all(|doc| doc.starts_with("when ")));
        assert_eq!(docs.map(|doc| doc.contains("rigorous")), [false, true]);
        assert_eq!(docs.map(|doc| doc.contains("tilt the coin")), [true, false]);
    }

    /// Settings of which none is the default.
    fn unusual() -> Settings {
        Settings {
            law: Law::Stronge,
            decision: Decision::Energy,
            zeno: 0.03,
            tolerance: 2e-7,
            stick_speed: 3e-4,
            smoothing_time: 5e-4,
            ground_step: 0.07,
            max_impacts: 321,
            max_steps: 654,
            time_limit: 987.0,
        }
    }

    /// Each value of a config's table is read under its own name, and none is taken for another or left at its default.
    #[test]
    fn every_key_is_read() {
        let values = |zeno| {
            Values::new(vec![
                ("law", Value::Word("stronge")),
                ("decision", Value::Word("energy")),
                ("zeno", Value::Number(zeno)),
                ("tolerance", Value::Number(2e-7)),
                ("stick_speed", Value::Number(3e-4)),
                ("smoothing_time", Value::Number(5e-4)),
                ("ground_step", Value::Number(0.07)),
                ("max_impacts", Value::Integer(321)),
                ("max_steps", Value::Integer(654)),
                ("time_limit", Value::Number(987.0)),
            ])
        };
        let found = Settings::read(&values(0.03)).expect("all is there and in its range");
        assert_eq!(found, unusual());
        assert!(Settings::read(&values(1.5)).is_err());
        assert!(Settings::read(&values(0.03).without("law")).is_err());
    }

    /// Each setting out of its range is refused by its name.
    #[test]
    fn a_setting_out_of_its_range_is_refused() {
        type Spoil = fn(&mut Settings);

        assert_eq!(unusual().validate(), Ok(()));
        let wrong: [(&str, Spoil); 8] = [
            ("zeno", |settings| settings.zeno = 0.0),
            ("tolerance", |settings| settings.tolerance = 0.1),
            ("stick_speed", |settings| settings.stick_speed = -1e-3),
            ("smoothing_time", |settings| settings.smoothing_time = 0.2),
            ("ground_step", |settings| settings.ground_step = 2.0),
            ("max_impacts", |settings| settings.max_impacts = 0),
            ("max_steps", |settings| settings.max_steps = 0),
            ("time_limit", |settings| settings.time_limit = f64::NAN),
        ];
        for (name, spoil) in wrong {
            let mut settings = unusual();
            spoil(&mut settings);
            let refused = settings.validate().expect_err(name);
            assert_eq!(refused.name, name);
        }
    }
}
