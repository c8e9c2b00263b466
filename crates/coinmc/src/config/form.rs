//! The config once every key and value has been checked by itself: what the canonical text and
//! the plan are made from.

use super::quantity::Quantity;
use super::source::Span;
use coinmc_core::schema::Value;

/// A checked value and the place to blame for it. A default's place is the table that lacks it,
/// a preset's the name of the preset.
#[derive(Debug, Clone)]
pub(super) struct Form {
    pub(super) span: Span,
    pub(super) what: What,
}

#[derive(Debug, Clone)]
pub(super) enum What {
    /// Already reported.
    Invalid,
    /// A number that may be swept, and which axis of the sweep it is.
    Number(Quantity, Option<usize>),
    Real(f64),
    Integer(u64),
    Boolean(bool),
    Word(&'static str),
    /// x, y, z.
    Vector(Vec<Form>),
    /// The keys that are present, in the order of the schema.
    Table(Vec<(&'static str, Form)>),
    /// A table with the one key that says which alternative it is.
    Tagged(&'static str, Box<Form>),
}

/// Names of a vector's components in column names.
pub(super) const COMPONENTS: [&str; 3] = ["x", "y", "z"];

impl Form {
    pub(super) fn new(span: Span, what: What) -> Self {
        Self { span, what }
    }

    /// A constant value; `span` is blamed for it.
    pub(super) fn of_value(span: Span, value: &Value) -> Self {
        let nested = |value| Self::of_value(span, value);
        let what = match value {
            Value::Number(number) => What::Number(Quantity::Constant(*number), None),
            Value::Integer(number) => What::Integer(*number),
            Value::Boolean(holds) => What::Boolean(*holds),
            Value::Word(word) => What::Word(word),
            Value::Vector(components) => What::Vector(components.iter().map(nested).collect()),
            Value::Table(values) => {
                let entries = values.entries().map(|(key, value)| (key, nested(value)));
                What::Table(entries.collect())
            }
            Value::Tagged(tag, inner) => What::Tagged(tag, Box::new(nested(inner))),
        };
        Self::new(span, what)
    }

    pub(super) fn invalid(span: Span) -> Self {
        Self {
            span,
            what: What::Invalid,
        }
    }

    /// The value of a key, if this is a table that has it.
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        match &self.what {
            What::Table(entries) => entries
                .iter()
                .find(|(name, _)| *name == key)
                .map(|(_, form)| form),
            _ => None,
        }
    }

    pub(super) fn word(&self) -> Option<&'static str> {
        match self.what {
            What::Word(word) => Some(word),
            _ => None,
        }
    }

    pub(super) fn tag(&self) -> Option<&'static str> {
        match self.what {
            What::Tagged(tag, _) => Some(tag),
            _ => None,
        }
    }

    /// Whether any number in it is an axis.
    pub(super) fn is_swept(&self) -> bool {
        match &self.what {
            What::Number(_, axis) => axis.is_some(),
            What::Vector(components) => components.iter().any(Self::is_swept),
            What::Table(entries) => entries.iter().any(|(_, form)| form.is_swept()),
            What::Tagged(_, inner) => inner.is_swept(),
            _ => false,
        }
    }
}
