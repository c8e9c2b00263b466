//! The parsed text before it is checked: tables, lists and scalars with their locations.

use super::diagnostics::Problems;
use super::source::{Sources, Span};
use super::syntax::{Mistake, ParseError, all_errors, help, mistakes};
use std::ops::Range;
use toml::de::{DeFloat, DeInteger, DeTable, DeValue};

/// A value and its location.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) value: Value,
    pub(super) span: Span,
}

#[derive(Debug, Clone)]
pub(super) enum Value {
    Text(String),
    /// Integers of more than 64 bits are kept so that messages can quote them; beyond 128 they
    /// saturate.
    Integer(i128),
    Float(f64),
    Boolean(bool),
    Datetime,
    List(Vec<Node>),
    Table(Table),
}

impl Node {
    /// A value that stands in no text; `span` is its place in messages.
    pub(super) fn of_value(span: Span, value: &coinmc_core::schema::Value) -> Self {
        use coinmc_core::schema::Value as Checked;
        let nested = |value| Self::of_value(span, value);
        let table = |entries: Vec<(&'static str, Self)>| {
            let entries = entries.into_iter().map(|(key, node)| Entry {
                key: key.to_owned(),
                key_span: span,
                node,
            });
            Value::Table(Table {
                entries: entries.collect(),
            })
        };
        let list = |values: Vec<Value>| {
            let nodes = values.into_iter().map(|value| Self { value, span });
            Value::List(nodes.collect())
        };
        let value = match value {
            Checked::Number(number) => Value::Float(*number),
            Checked::Numbers(numbers) => list(numbers.iter().map(|n| Value::Float(*n)).collect()),
            Checked::Integer(number) => Value::Integer((*number).into()),
            Checked::Boolean(holds) => Value::Boolean(*holds),
            Checked::Word(word) => Value::Text((*word).to_owned()),
            Checked::Texts(texts) => list(texts.iter().cloned().map(Value::Text).collect()),
            Checked::Vector(components) => Value::List(components.iter().map(nested).collect()),
            Checked::Table(values) => table(
                values
                    .entries()
                    .map(|(key, value)| (key, nested(value)))
                    .collect(),
            ),
            Checked::Tagged(tag, inner) => table(vec![(*tag, nested(inner))]),
        };
        Self { value, span }
    }
}

impl Value {
    /// Name of this type in messages.
    pub(super) fn type_name(&self) -> &'static str {
        match self {
            Self::Text(_) => "text",
            Self::Integer(_) => "an integer",
            Self::Float(_) => "a number",
            Self::Boolean(_) => "a boolean",
            Self::Datetime => "a date",
            Self::List(_) => "a list",
            Self::Table(_) => "a table",
        }
    }
}

/// Keys with their values, in no particular order.
#[derive(Debug, Clone, Default)]
pub(super) struct Table {
    pub(super) entries: Vec<Entry>,
}

#[derive(Debug, Clone)]
pub(super) struct Entry {
    pub(super) key: String,
    pub(super) key_span: Span,
    pub(super) node: Node,
}

impl Table {
    pub(super) fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    pub(super) fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        let entry = self.entries.iter_mut().find(|entry| entry.key == key);
        entry.map(|entry| &mut entry.node)
    }

    /// Replaces or adds the value at a path of keys; values on the path that are not tables are
    /// replaced by tables.
    pub(super) fn set(&mut self, path: &[(String, Span)], node: Node) {
        let Some(((key, key_span), rest)) = path.split_first() else {
            return;
        };
        let (key_span, found) = (*key_span, self.entries.iter().position(|e| e.key == *key));
        if rest.is_empty() {
            let entry = Entry {
                key: key.clone(),
                key_span,
                node,
            };
            match found {
                Some(index) => self.entries[index] = entry,
                None => self.entries.push(entry),
            }
            return;
        }
        let index = found.unwrap_or_else(|| {
            let node = Node {
                value: Value::Table(Self::default()),
                span: key_span,
            };
            self.entries.push(Entry {
                key: key.clone(),
                key_span,
                node,
            });
            self.entries.len() - 1
        });
        let inner = &mut self.entries[index].node;
        if !matches!(inner.value, Value::Table(_)) {
            *inner = Node {
                value: Value::Table(Self::default()),
                span: key_span,
            };
        }
        if let Value::Table(table) = &mut inner.value {
            table.set(rest, node);
        }
    }
}

/// Reads the text of a source as TOML. [Mistakes](mistakes) of syntax are told at once, and nothing else then;
/// duplicate keys are reported and the first of each is kept.
pub(super) fn document(
    sources: &Sources,
    source: usize,
    text: &str,
    problems: &mut Problems,
) -> Option<Table> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let place = |range: Range<usize>| {
        // an error at the end of the text is shown after its last character
        if range.start >= text.len() {
            sources.end(source)
        } else {
            sources.span(source, range)
        }
    };
    let errors = errors.iter().map(|error| {
        let range = error.span().unwrap_or(text.len()..text.len());
        (range, error.message().to_owned())
    });
    // The message of the TOML crate identifies the errors after which parsing can continue.
    let is_duplicate = |(_, message): &ParseError| message == "duplicate key";
    let (duplicates, fatal): (Vec<_>, Vec<_>) = errors.partition(is_duplicate);
    if !fatal.is_empty() {
        let mut fatal = all_errors(text, fatal);
        fatal.retain(|error| !is_duplicate(error));
        let fatal = fatal.iter();
        let fatal = fatal.map(|(range, message)| (place(range.clone()), message.as_str()));
        for mistake in mistakes(sources, fatal.collect()) {
            problems.push(mistake.span, mistake.message, mistake.help);
        }
        return None;
    }
    for (range, _) in duplicates {
        let span = place(range);
        let key = super::diagnostics::quoted(sources.text(span));
        problems.add_with_help(span, format!("{key} is given twice"), "keep one of them");
    }
    Some(convert_table(sources, source, 0, table.get_ref()))
}

/// Reads one TOML value that stands at `offset` in its source.
pub(super) fn value(
    sources: &Sources,
    source: usize,
    offset: usize,
    text: &str,
) -> Result<Node, Mistake> {
    match DeValue::parse(text) {
        Ok(value) => {
            let span = value.span();
            let span = sources.span(source, span.start + offset..span.end + offset);
            Ok(Node {
                value: convert(sources, source, offset, value.get_ref()),
                span,
            })
        }
        Err(_) if text.trim().is_empty() => {
            let span = sources.span(source, offset..offset + text.len());
            Err(Mistake {
                span,
                message: "there is no value after `=`".to_owned(),
                help: None,
            })
        }
        Err(error) => {
            let range = error.span().unwrap_or(0..text.len());
            let span = sources.span(source, range.start + offset..range.end + offset);
            Err(Mistake {
                span,
                message: format!("this is no TOML value: {}", error.message()),
                help: help(text),
            })
        }
    }
}

/// Nesting is bounded by the TOML parser (80 levels), so recursion is too.
fn convert(sources: &Sources, source: usize, offset: usize, value: &DeValue<'_>) -> Value {
    match value {
        DeValue::String(text) => Value::Text(text.clone().into_owned()),
        DeValue::Integer(integer) => Value::Integer(to_integer(integer)),
        DeValue::Float(float) => Value::Float(to_float(float)),
        DeValue::Boolean(boolean) => Value::Boolean(*boolean),
        DeValue::Datetime(_) => Value::Datetime,
        DeValue::Array(items) => Value::List(
            items
                .iter()
                .map(|item| Node {
                    value: convert(sources, source, offset, item.get_ref()),
                    span: shifted(sources, source, offset, item.span()),
                })
                .collect(),
        ),
        DeValue::Table(table) => Value::Table(convert_table(sources, source, offset, table)),
    }
}

fn convert_table(sources: &Sources, source: usize, offset: usize, table: &DeTable<'_>) -> Table {
    let entries = table
        .iter()
        .map(|(key, value)| Entry {
            key: key.get_ref().clone().into_owned(),
            key_span: shifted(sources, source, offset, key.span()),
            node: Node {
                value: convert(sources, source, offset, value.get_ref()),
                span: shifted(sources, source, offset, value.span()),
            },
        })
        .collect();
    Table { entries }
}

fn shifted(sources: &Sources, source: usize, offset: usize, range: Range<usize>) -> Span {
    sources.span(source, range.start + offset..range.end + offset)
}

fn to_integer(integer: &DeInteger<'_>) -> i128 {
    let text = integer.as_str();
    i128::from_str_radix(text, integer.radix()).unwrap_or(if text.starts_with('-') {
        i128::MIN
    } else {
        i128::MAX
    })
}

/// The lexer leaves only what `f64` can parse; anything else would be reported as not a number.
fn to_float(float: &DeFloat<'_>) -> f64 {
    float.as_str().parse().unwrap_or(f64::NAN)
}
