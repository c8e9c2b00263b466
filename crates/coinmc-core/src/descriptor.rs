//! Descriptors: everything that the rest of the program knows about an engine or a law of impact.

use crate::schema::{Absent, Fallback, Field, Kind, TableKind, Values, Word, field, fields, table};
use crate::{DynEngine, Landing, Scene};
use std::any::Any;
use std::fmt::{self, Debug, Display};
use std::sync::Arc;
use thiserror::Error;

/// An engine, as needed to read configs, plan, explain and report. Its settings are
/// [`EngineSettings`].
#[derive(Debug, Clone, Copy)]
pub struct EngineDescriptor {
    /// Its name in configs and results.
    pub name: &'static str,
    /// Description, one sentence.
    pub doc: &'static str,
    /// The kind of its results.
    pub kind: EngineKind,
    /// Whether a toss takes a millisecond or more, as with time steps; its chunks are then smaller.
    pub stepped: bool,
    /// The laws of impact that can be chosen with the key `law`; empty if there is no choice.
    pub laws: &'static [LawDescriptor],
    /// What it does not model with any settings.
    pub unmodelled: &'static [Unmodelled],
    /// What users should know about it in some scenes.
    pub remarks: &'static [Remark],
    /// Settings whose numerical error is to be measured, and how to make them finer.
    pub finer: &'static [(&'static str, Finer)],
    /// The keys of its table in a config.
    pub schema: fn() -> TableKind,
    /// Reads its settings from the values of that table.
    pub read: fn(&Values) -> Result<EngineChoice, EngineError>,
}

/// How a numerical setting is made finer, so that the difference between results shows its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Finer {
    /// Times this factor.
    Times(f64),
    /// This word instead.
    Word(&'static str),
}

/// The kind of results of an engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EngineKind {
    /// Tosses in the xz plane; launches must lie in it.
    Planar,
    /// Tosses in space.
    Spatial,
    /// Probabilities without tosses.
    ClosedForm,
}

/// A law of impact: its name, its parameters, and what it does not model.
#[derive(Debug, Clone, Copy)]
pub struct LawDescriptor {
    /// Its name in configs and results.
    pub name: &'static str,
    /// Description, one sentence.
    pub doc: &'static str,
    /// The keys of its table; a law without parameters is given by its name alone.
    pub parameters: fn() -> TableKind,
    /// What it does not model.
    pub unmodelled: &'static [Unmodelled],
}

/// A law of impact with its parameters, as described by a [`LawDescriptor`].
pub trait LawSettings: Sized {
    /// Its name in configs and results.
    const NAME: &'static str;
    /// Description, one sentence.
    const DOC: &'static str;
    /// What it does not model.
    const UNMODELLED: &'static [Unmodelled] = &[];

    /// The keys of its table; none (the default) for a law without parameters.
    fn parameters() -> TableKind {
        fields(vec![])
    }

    /// The law with these parameters.
    ///
    /// # Errors
    /// [`EngineError`] if they do not match the schema.
    fn read(parameters: &Values) -> Result<Self, EngineError>;
}

impl LawDescriptor {
    /// The descriptor of a law.
    pub const fn of<L: LawSettings>() -> Self {
        Self {
            name: L::NAME,
            doc: L::DOC,
            parameters: L::parameters,
            unmodelled: L::UNMODELLED,
        }
    }

    /// The key `law` of an engine with several laws.
    pub fn field(laws: &[Self], fallback: &'static str) -> Field {
        let (mut words, mut tables) = (vec![], vec![]);
        for &Self {
            name,
            doc,
            parameters,
            ..
        } in laws
        {
            let parameters = parameters();
            if parameters.fields.is_empty() {
                words.push(Word { name, doc });
            } else {
                tables.push(table(name, doc, parameters, Absent::Required));
            }
        }
        let kind = if tables.is_empty() {
            Kind::Word(words)
        } else {
            Kind::Choice(words, tables)
        };
        let fallback = Absent::Is(Fallback::Word(fallback));
        field("law", "Law of impact.", kind, fallback)
    }
}

/// A key of the scene that an engine or law would ignore. It must therefore be 0, or true if it is
/// not a number: otherwise results would claim what was never computed.
#[derive(Debug, Clone, Copy)]
pub struct Unmodelled {
    /// The table of the config.
    pub table: &'static str,
    /// Its key.
    pub key: &'static str,
    /// The error message.
    pub message: &'static str,
    /// The remedy.
    pub help: &'static str,
}

/// What users should know about an engine in some scenes.
#[derive(Debug, Clone, Copy)]
pub struct Remark {
    /// Whether it applies to a scene.
    pub applies: fn(&Scene) -> bool,
    /// The text of the remark.
    pub text: &'static str,
}

/// Ratio H/R below which the ground under a coin decides how often it stays on its side. On wood
/// P(side) differs from that on a plane by less than a tenth at H/R = 0.5 and by half at 0.3.
const THIN: f64 = 0.4;

impl Remark {
    /// For engines in space: a thin coin on a perfect plane.
    pub const PERFECT_PLANE: Self = Self {
        applies: is_thin_on_a_plane,
        text: "surface.roughness_slope = 0 is a perfect plane, on which thin coins roll standing up: for \
               H/R below 0.4 P(side) is an upper bound; surface.material gives a real surface",
    };

    /// For engines with rough ground: waves so long that a coin bounces from one slope to the next.
    pub const LONG_WAVES: Self = Self {
        applies: is_wavy,
        text: "surface.roughness_wavelength_m is above 0.3: each landing counts as on other ground, so a coin \
               that bounces meets another slope each time; surface.table_tilt_deg gives the table one slope",
    };
}

/// Wavelength beyond which a coin that bounces lands on what should be the same slope, m.
const LONG_M: f64 = 0.3;

fn is_wavy(scene: &Scene) -> bool {
    let roughness = scene.surface.roughness();
    roughness.is_some_and(|roughness| roughness.wavelength_m() > LONG_M)
}

fn is_thin_on_a_plane(scene: &Scene) -> bool {
    scene.surface.landing() == Landing::Bouncing
        && scene.surface.roughness().is_none()
        && scene.coin.ratio() < THIN
}

/// The settings of an engine: comparable data from which an engine is built for each scene.
pub trait EngineSettings: Any + Debug + Send + Sync {
    /// The engine that has these settings.
    fn descriptor(&self) -> &'static EngineDescriptor;

    /// The name in results of the law of impact, or of whatever takes its place.
    fn law(&self) -> &'static str;

    /// Describes what is computed for a scene in which the first contact does not decide.
    fn explain(&self, scene: &Scene) -> String;

    /// Limit of simulated time, s, of an engine that computes flight in closed form. Quadrature may
    /// then replace the engine in scenes in which the first contact decides; with `None` (the
    /// default) it may not.
    fn flight_limit_s(&self, _: &Scene) -> Option<f64> {
        None
    }

    /// Builds the engine for a scene, or computes the exact probabilities.
    ///
    /// # Errors
    /// [`EngineError`] if a setting is out of range or incompatible with the scene.
    fn build(&self, scene: &Scene) -> Result<Answer, EngineError>;
}

/// An engine built for a scene, or exact probabilities.
#[derive(Debug, Clone)]
pub enum Answer {
    /// Tosses of this engine.
    Tosses(DynEngine),
    /// Exact probabilities of heads, tails and side.
    Exact([f64; 3]),
}

/// Why an engine cannot be built.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{reason}")]
pub struct EngineError {
    reason: String,
    is_mismatch: bool,
}

impl EngineError {
    /// An error with this reason.
    pub fn new(reason: impl Display) -> Self {
        Self {
            reason: reason.to_string(),
            is_mismatch: false,
        }
    }

    /// An error for values that do not match their schema: they violate a rule of their table, or
    /// the schema and its reader disagree.
    pub fn mismatch(reason: impl Display) -> Self {
        Self {
            is_mismatch: true,
            ..Self::new(reason)
        }
    }

    /// Whether the values do not match their schema.
    pub fn is_mismatch(&self) -> bool {
        self.is_mismatch
    }
}

impl From<crate::schema::OutOfRange> for EngineError {
    fn from(error: crate::schema::OutOfRange) -> Self {
        Self::new(error)
    }
}

/// Any engine with its settings: [`EngineSettings`] behind a pointer that can be compared, cloned
/// and downcast.
#[derive(Clone)]
pub struct EngineChoice(Arc<dyn ComparableSettings>);

trait ComparableSettings: EngineSettings {
    fn equals(&self, other: &dyn Any) -> bool;
}

impl<S: EngineSettings + PartialEq> ComparableSettings for S {
    fn equals(&self, other: &dyn Any) -> bool {
        other.downcast_ref() == Some(self)
    }
}

impl EngineChoice {
    /// The engine with these settings.
    pub fn new(settings: impl EngineSettings + PartialEq) -> Self {
        Self(Arc::new(settings))
    }

    /// The engine.
    pub fn descriptor(&self) -> &'static EngineDescriptor {
        self.0.descriptor()
    }

    /// Its name in configs and results.
    pub fn name(&self) -> &'static str {
        self.descriptor().name
    }

    /// Whether the engine makes tosses.
    pub fn makes_tosses(&self) -> bool {
        self.descriptor().kind != EngineKind::ClosedForm
    }

    /// The settings, if they have this type.
    pub fn settings<S: EngineSettings>(&self) -> Option<&S> {
        let settings: &dyn Any = &*self.0;
        settings.downcast_ref()
    }
}

/// Settings of any engine.
impl std::ops::Deref for EngineChoice {
    type Target = dyn EngineSettings;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl PartialEq for EngineChoice {
    fn eq(&self, other: &Self) -> bool {
        let other: &dyn Any = &*other.0;
        self.0.equals(other)
    }
}

impl Debug for EngineChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::scene;
    use crate::{Coin, Roughness};

    /// Settings of engines that do nothing; each number is another engine.
    #[derive(Debug, PartialEq)]
    struct Idle<const ENGINE: u8>(EngineKind);

    const fn descriptor(name: &'static str, kind: EngineKind) -> EngineDescriptor {
        EngineDescriptor {
            name,
            doc: "Does nothing.",
            kind,
            stepped: false,
            laws: &[],
            unmodelled: &[],
            remarks: &[],
            finer: &[],
            schema: || fields(vec![]),
            read: |_| Err(EngineError::new("has no settings")),
        }
    }

    static PLANAR: EngineDescriptor = descriptor("idle-flat", EngineKind::Planar);
    static SPATIAL: EngineDescriptor = descriptor("idle", EngineKind::Spatial);
    static CLOSED_FORM: EngineDescriptor = descriptor("idle-exact", EngineKind::ClosedForm);

    impl<const ENGINE: u8> EngineSettings for Idle<ENGINE> {
        fn descriptor(&self) -> &'static EngineDescriptor {
            match self.0 {
                EngineKind::Planar => &PLANAR,
                EngineKind::Spatial => &SPATIAL,
                EngineKind::ClosedForm => &CLOSED_FORM,
            }
        }

        fn law(&self) -> &'static str {
            "none"
        }

        fn explain(&self, _: &Scene) -> String {
            String::new()
        }

        fn build(&self, _: &Scene) -> Result<Answer, EngineError> {
            Ok(Answer::Exact([0.5, 0.5, 0.0]))
        }
    }

    #[test]
    fn closed_forms_make_no_tosses() {
        for (kind, name, makes_tosses) in [
            (EngineKind::Planar, "idle-flat", true),
            (EngineKind::Spatial, "idle", true),
            (EngineKind::ClosedForm, "idle-exact", false),
        ] {
            let choice = EngineChoice::new(Idle::<0>(kind));
            assert_eq!((choice.name(), choice.makes_tosses()), (name, makes_tosses));
        }
    }

    #[test]
    fn engines_are_equal_if_their_types_and_settings_are() {
        let spatial = EngineChoice::new(Idle::<0>(EngineKind::Spatial));
        assert_eq!(spatial, EngineChoice::new(Idle::<0>(EngineKind::Spatial)));
        assert_ne!(spatial, EngineChoice::new(Idle::<0>(EngineKind::Planar)));
        assert_ne!(spatial, EngineChoice::new(Idle::<1>(EngineKind::Spatial)));
    }

    #[test]
    fn settings_are_found_by_their_type_alone() {
        let choice = EngineChoice::new(Idle::<0>(EngineKind::Planar));
        assert_eq!(choice.settings(), Some(&Idle::<0>(EngineKind::Planar)));
        assert_eq!(choice.settings::<Idle<1>>(), None);
    }

    /// Quadrature replaces only engines that say that it may.
    #[test]
    fn an_engine_has_no_limit_of_flight_unless_it_says_so() {
        let idle = Idle::<0>(EngineKind::Spatial);
        assert_eq!(idle.flight_limit_s(&scene()), None);
    }

    #[test]
    fn a_value_out_of_range_is_no_mismatch_with_the_schema() {
        assert!(EngineError::mismatch("no such key").is_mismatch());
        assert!(!EngineError::new("too large").is_mismatch());
    }

    #[test]
    fn the_remark_on_long_waves_is_on_waves_longer_than_bounces() {
        let applies = |slope, wavelength_m| {
            let mut scene = scene();
            let rough = Roughness::new(slope, wavelength_m).unwrap();
            scene.surface = scene.surface.with_roughness(Some(rough));
            (Remark::LONG_WAVES.applies)(&scene)
        };
        assert!(!(Remark::LONG_WAVES.applies)(&scene()));
        assert!(!applies(0.05, 0.3) && applies(0.05, 0.31));
        // none of no height
        assert!(!applies(0.0, 0.31));
    }

    /// P(side) on a plane is an upper bound for thin coins, and for these alone: on a real surface it is
    /// right, and where a coin does not bounce it does not roll.
    #[test]
    fn the_remark_on_planes_is_on_thin_coins_that_bounce_on_one() {
        let applies = |ratio, surface| {
            let coin = Coin::cylinder(ratio, 0.01).unwrap();
            let scene = Scene::new(coin, surface, 9.81).unwrap();
            (Remark::PERFECT_PLANE.applies)(&scene)
        };
        let plane = scene().surface;
        let level = Roughness::new(0.0, 1e-3).unwrap();
        let rough = Roughness::new(0.05, 1e-3).unwrap();
        assert!(applies(0.1, plane) && applies(0.399, plane));
        assert!(applies(0.1, plane.with_roughness(Some(level))));
        assert!(!applies(0.4, plane) && !applies(0.6, plane));
        for ratio in [0.1, 0.6] {
            assert!(!applies(ratio, plane.with_roughness(Some(rough))));
            assert!(!applies(
                ratio,
                plane
                    .with_landing(Landing::Adhesive)
                    .expect("a level surface")
            ));
        }
    }
}
