//! What the rest of the program knows of an engine and of a law of impact.

use crate::schema::{Absent, Fallback, Field, Kind, TableKind, Values, Word, field, fields, table};
use crate::{DynEngine, Scene};
use std::any::Any;
use std::fmt::{self, Debug, Display};
use std::sync::Arc;
use thiserror::Error;

/// An engine: all that reading a config, planning, explaining and reporting need to know of it. The
/// settings themselves are [`EngineSettings`].
#[derive(Debug, Clone, Copy)]
pub struct EngineDescriptor {
    /// Its name in configs and results.
    pub name: &'static str,
    /// What it does, in a sentence.
    pub doc: &'static str,
    /// What it computes.
    pub kind: EngineKind,
    /// A toss takes a millisecond or more, as in time steps: work is cut finer.
    pub stepped: bool,
    /// Its laws of impact, of which its table names one under `law`; empty if it has no choice.
    pub laws: &'static [LawDescriptor],
    /// What it does not model, whatever its settings.
    pub unmodelled: &'static [Unmodelled],
    /// What a user should know of it in some scenes.
    pub remarks: &'static [Remark],
    /// The keys of its table in a config.
    pub schema: fn() -> TableKind,
    /// Its settings, from the values of that table.
    pub read: fn(&Values) -> Result<EngineChoice, EngineError>,
}

/// What an engine computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EngineKind {
    /// Tosses in the xz plane: launches must lie in it.
    Planar,
    /// Tosses in space.
    Spatial,
    /// Probabilities, without a toss.
    ClosedForm,
}

/// A law of impact: its name, its parameters, and what does not go with it.
#[derive(Debug, Clone, Copy)]
pub struct LawDescriptor {
    /// Its name in configs and results.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub doc: &'static str,
    /// The keys of its table; a law without any is told by its name alone.
    pub parameters: fn() -> TableKind,
    /// What it does not model.
    pub unmodelled: &'static [Unmodelled],
}

/// A law of impact as a config gives it: the parameters that [`LawDescriptor`] tells of.
pub trait LawSettings: Sized {
    /// Its name in configs and results.
    const NAME: &'static str;
    /// What it is, in a sentence.
    const DOC: &'static str;
    /// What it does not model.
    const UNMODELLED: &'static [Unmodelled] = &[];

    /// The keys of its table; none (the default) of a law that is told by its name alone.
    fn parameters() -> TableKind {
        fields(vec![])
    }

    /// The law with these parameters.
    ///
    /// # Errors
    /// [`EngineError`] if they are not those of the schema.
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

    /// The key `law` of an engine with a choice of laws.
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

/// A key of the scene that an engine or law would ignore, and that must therefore be 0, or true if it
/// is no number: results would claim what was never computed.
#[derive(Debug, Clone, Copy)]
pub struct Unmodelled {
    /// The table of the config.
    pub table: &'static str,
    /// Its key.
    pub key: &'static str,
    /// What is wrong.
    pub message: &'static str,
    /// What can be done.
    pub help: &'static str,
}

/// What a user should know of an engine in some scenes.
#[derive(Debug, Clone, Copy)]
pub struct Remark {
    /// Whether it applies to a scene.
    pub applies: fn(&Scene) -> bool,
    /// What to say.
    pub text: &'static str,
}

/// The settings of an engine: comparable data, of which an engine is built for each scene.
pub trait EngineSettings: Any + Debug + Send + Sync {
    /// Whose settings they are.
    fn descriptor(&self) -> &'static EngineDescriptor;

    /// The name in results of the law that is followed: of impact, or whatever takes its place.
    fn law(&self) -> &'static str;

    /// What is computed for a scene in which the first contact does not decide, in words.
    fn explain(&self, scene: &Scene) -> String;

    /// Simulated time, s, after which a toss is given up, of an engine that follows flight in closed
    /// form: where the first contact decides, quadrature may then take its place. `None` (the default)
    /// if it must not.
    fn flight_limit_s(&self, _: &Scene) -> Option<f64> {
        None
    }

    /// What answers a scene.
    ///
    /// # Errors
    /// [`EngineError`] if a setting is out of range or does not go with the scene.
    fn build(&self, scene: &Scene) -> Result<Answer, EngineError>;
}

/// What answers a scene.
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
    /// For this reason, in words.
    pub fn new(reason: impl Display) -> Self {
        Self {
            reason: reason.to_string(),
            is_mismatch: false,
        }
    }

    /// Values that do not follow their schema, for this reason: they broke a rule of their table, or
    /// the schema and its reader contradict each other.
    pub fn mismatch(reason: impl Display) -> Self {
        Self {
            is_mismatch: true,
            ..Self::new(reason)
        }
    }

    /// Whether the values do not follow their schema.
    pub fn is_mismatch(&self) -> bool {
        self.is_mismatch
    }
}

impl From<crate::schema::OutOfRange> for EngineError {
    fn from(error: crate::schema::OutOfRange) -> Self {
        Self::new(error)
    }
}

/// An engine with its settings, whichever it is: [`EngineSettings`] behind a pointer that can be
/// compared, cloned and asked for what it is.
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
    /// These settings, and so their engine.
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

    /// Whether the engine tosses at all.
    pub fn makes_tosses(&self) -> bool {
        self.descriptor().kind != EngineKind::ClosedForm
    }

    /// The settings, if they are of this type.
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
