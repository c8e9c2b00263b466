//! Shorthands for writing schemas.

use super::Absent::Is;
use super::{Absent, Bounds, Fallback, Field, Kind, TableKind, Whole, Word};

/// A key.
pub fn field(name: &'static str, doc: &'static str, kind: Kind, absent: Absent) -> Field {
    Field {
        name,
        doc,
        kind,
        absent,
    }
}

/// A number that may be swept.
pub fn number(name: &'static str, doc: &'static str, bounds: Bounds, absent: Absent) -> Field {
    field(name, doc, Kind::Number(bounds), absent)
}

/// A table.
pub fn table(name: &'static str, doc: &'static str, kind: TableKind, absent: Absent) -> Field {
    field(name, doc, Kind::Table(kind), absent)
}

/// The keys of a table without rules.
pub fn fields(fields: Vec<Field>) -> TableKind {
    TableKind {
        fields,
        rules: vec![],
    }
}

/// A default number.
pub fn default(value: f64) -> Absent {
    Is(Fallback::Number(value))
}

/// A count of at least 1.
pub fn count(name: &'static str, doc: &'static str, fallback: u32) -> Field {
    let fallback = Fallback::Integer(u64::from(fallback));
    field(name, doc, Kind::Integer(Whole::COUNT), Is(fallback))
}

/// A boolean.
pub fn flag(name: &'static str, doc: &'static str, fallback: bool) -> Field {
    field(name, doc, Kind::Boolean, Is(Fallback::Boolean(fallback)))
}

/// One of these words, each with its meaning.
pub fn choice<const N: usize>(
    name: &'static str,
    doc: &'static str,
    words: [(&'static str, &'static str); N],
    fallback: &'static str,
) -> Field {
    let words = words.map(|(name, doc)| Word { name, doc });
    let kind = Kind::Word(words.to_vec());
    field(name, doc, kind, Is(Fallback::Word(fallback)))
}
