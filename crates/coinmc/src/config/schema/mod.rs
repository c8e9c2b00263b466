//! What a config may say, described once: the walker, its messages, the canonical text and the
//! JSON Schema are all made from this description.

mod engines;
mod fields;
mod json;
mod launch;
mod rapier;
mod terms;

pub(super) use engines::ENERGY;
pub(super) use fields::{range, root};
pub(super) use json::json_schema;

/// A key of a table.
#[derive(Debug, Clone)]
pub(super) struct Field {
    pub(super) name: &'static str,
    /// What it means, with its unit.
    pub(super) doc: &'static str,
    pub(super) kind: Kind,
    pub(super) absent: Absent,
}

/// What it means that a key is absent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Absent {
    /// That is a problem.
    Required,
    /// Nothing, unless one of the table's rules says otherwise.
    Omitted,
    /// The same as this value.
    Is(Fallback),
}

/// A value that stands in for an absent key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fallback {
    Number(f64),
    Integer(u64),
    Boolean(bool),
    Word(&'static str),
    /// A table with all its own fallbacks.
    Table,
}

/// What a value may be.
#[derive(Debug, Clone)]
pub(super) enum Kind {
    /// A number that may be swept: a number, a list or a range.
    Number(Bounds),
    /// A number that may not.
    Real(Bounds),
    /// A whole number.
    Integer(Whole),
    Boolean,
    /// One of these words.
    Word(Vec<Word>),
    /// Exactly three of a kind: x, y, z.
    Vector(Box<Kind>),
    /// A number that may be swept, or a distribution (a table with exactly one of these keys).
    Marginal(Bounds, Vec<Field>),
    /// One of these words, or a table with exactly one of these keys.
    Choice(Vec<Word>, Vec<Field>),
    Table(TableKind),
}

/// The keys of a table and how they depend on each other.
#[derive(Debug, Clone)]
pub(super) struct TableKind {
    pub(super) fields: Vec<Field>,
    pub(super) rules: Vec<Rule>,
}

/// How the keys of one table depend on each other.
#[derive(Debug, Clone, Copy)]
pub(super) enum Rule {
    /// Exactly one of these is given.
    ExactlyOne(&'static [&'static str]),
    /// The key goes with another one only, and has this value where that one stands alone.
    GoesWith {
        key: &'static str,
        other: &'static str,
        fallback: Fallback,
    },
    /// These are given unless a condition holds; then, absent, they are the fallback.
    Unless {
        condition: Condition,
        keys: &'static [&'static str],
        fallback: Option<Fallback>,
    },
}

/// A condition on another key of the same table.
#[derive(Debug, Clone, Copy)]
pub(super) enum Condition {
    /// It is given.
    Given(&'static str),
    /// It is this word.
    Word(&'static str, &'static str),
    /// It is a table with this key.
    Tag(&'static str, &'static str),
}

impl Condition {
    /// As the end of "… is missing: required unless …".
    pub(super) fn text(self) -> String {
        match self {
            Self::Given(key) => format!("`{key}` is given"),
            Self::Word(key, word) => format!("{key} = \"{word}\""),
            Self::Tag(key, tag) => format!("the {key} is {tag}"),
        }
    }
}

/// A word with its meaning.
#[derive(Debug, Clone, Copy)]
pub(super) struct Word {
    pub(super) name: &'static str,
    pub(super) doc: &'static str,
}

/// Whole numbers from `low` to `high`, both allowed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Whole {
    pub(super) low: u64,
    pub(super) high: u64,
}

/// Numbers from `low` to `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Whether `low` and `high` themselves are out.
    pub(super) open: (bool, bool),
}

impl Bounds {
    pub(super) const fn closed(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            open: (false, false),
        }
    }

    /// The ends are out.
    pub(super) const fn open(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            open: (true, true),
        }
    }

    pub(super) fn contains(&self, x: f64) -> bool {
        (x > self.low || (x == self.low && !self.open.0))
            && (x < self.high || (x == self.high && !self.open.1))
    }
}

impl std::fmt::Display for Bounds {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (low, high) = (short(self.low), short(self.high));
        match self.open {
            (false, false) => write!(f, "from {low} to {high}"),
            (false, true) => write!(f, "at least {low} and below {high}"),
            (true, false) => write!(f, "above {low} and at most {high}"),
            (true, true) => write!(f, "above {low} and below {high}"),
        }
    }
}

/// A limit as a person writes it: `0.5`, `1e-12`.
fn short(x: f64) -> String {
    if x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

impl TableKind {
    pub(super) fn field(&self, name: &str) -> Option<&Field> {
        self.fields.iter().find(|field| field.name == name)
    }
}
