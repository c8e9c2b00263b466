//! The config after every key and value has been checked; the resolved TOML and the plan are
//! derived from it.

use super::quantity::Quantity;
use super::source::Span;
use coinmc_core::schema::Value;

/// A checked value and its location for error messages. The location of a default is the table that
/// lacks the key; that of a value from a preset is the name of the preset.
#[derive(Debug, Clone)]
pub(super) struct Checked {
    pub(super) span: Span,
    pub(super) value: CheckedValue,
}

#[derive(Debug, Clone)]
pub(super) enum CheckedValue {
    /// Already reported.
    Invalid,
    /// A number that may be swept, and the index of its axis if it is.
    Number(Quantity, Option<usize>),
    Real(f64),
    Reals(Vec<f64>),
    Integer(u64),
    Boolean(bool),
    Word(&'static str),
    Texts(Vec<String>),
    /// x, y, z.
    Vector(Vec<Checked>),
    /// The keys that are present, in the order of the schema.
    Table(Vec<(&'static str, Checked)>),
    /// A table with a single key that names the alternative.
    Tagged(&'static str, Box<Checked>),
}

/// Names of a vector's components in column names.
pub(super) const COMPONENTS: [&str; 3] = ["x", "y", "z"];

impl Checked {
    pub(super) fn new(span: Span, value: CheckedValue) -> Self {
        Self { span, value }
    }

    /// A constant value; `span` is its location for error messages.
    pub(super) fn of_value(span: Span, value: &Value) -> Self {
        let nested = |value| Self::of_value(span, value);
        let value = match value {
            Value::Number(number) => CheckedValue::Number(Quantity::Constant(*number), None),
            Value::Numbers(numbers) => CheckedValue::Reals(numbers.clone()),
            Value::Integer(number) => CheckedValue::Integer(*number),
            Value::Boolean(holds) => CheckedValue::Boolean(*holds),
            Value::Word(word) => CheckedValue::Word(word),
            Value::Texts(texts) => CheckedValue::Texts(texts.clone()),
            Value::Vector(components) => {
                CheckedValue::Vector(components.iter().map(nested).collect())
            }
            Value::Table(values) => {
                let entries = values.entries().map(|(key, value)| (key, nested(value)));
                CheckedValue::Table(entries.collect())
            }
            Value::Tagged(tag, inner) => CheckedValue::Tagged(tag, Box::new(nested(inner))),
        };
        Self::new(span, value)
    }

    pub(super) fn invalid(span: Span) -> Self {
        Self {
            span,
            value: CheckedValue::Invalid,
        }
    }

    /// The value of a key, if this is a table that has it.
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        match &self.value {
            CheckedValue::Table(entries) => entries
                .iter()
                .find(|(name, _)| *name == key)
                .map(|(_, checked)| checked),
            _ => None,
        }
    }

    pub(super) fn word(&self) -> Option<&'static str> {
        match self.value {
            CheckedValue::Word(word) => Some(word),
            _ => None,
        }
    }

    pub(super) fn tag(&self) -> Option<&'static str> {
        match self.value {
            CheckedValue::Tagged(tag, _) => Some(tag),
            _ => None,
        }
    }

    /// Whether any number in it is an axis.
    pub(super) fn is_swept(&self) -> bool {
        match &self.value {
            CheckedValue::Number(_, axis) => axis.is_some(),
            CheckedValue::Vector(components) => components.iter().any(Self::is_swept),
            CheckedValue::Table(entries) => entries.iter().any(|(_, checked)| checked.is_swept()),
            CheckedValue::Tagged(_, inner) => inner.is_swept(),
            _ => false,
        }
    }
}
