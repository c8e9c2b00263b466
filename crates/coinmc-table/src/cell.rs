//! What a table is made of.

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A whole number, 0 to 2^64 − 1.
    Count,
    /// A 64-bit floating point number.
    Number,
    /// A 32-bit floating point number, for samples: a file holds them without a dictionary of those met before.
    Single,
    /// Text.
    Text,
    /// True or false.
    Flag,
}

impl Kind {
    /// The kind's name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::Count => "u64",
            Self::Number => "f64",
            Self::Single => "f32",
            Self::Text => "text",
            Self::Flag => "bool",
        }
    }
}

/// A cell of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell<'a> {
    /// A count.
    Count(u64),
    /// A finite number. A column of [`Kind::Single`] rounds it.
    Number(f64),
    /// Text.
    Text(&'a str),
    /// True or false.
    Flag(bool),
    /// Undefined: no tosses, or none with that face.
    Missing,
}

impl Cell<'_> {
    /// A number; missing if it is not finite.
    pub fn finite(value: f64) -> Self {
        if value.is_finite() {
            Self::Number(value)
        } else {
            Self::Missing
        }
    }
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub kind: Kind,
    /// Unit; `1` for pure numbers, empty for text and flags.
    pub unit: String,
    /// What it means.
    pub doc: String,
    /// Whether cells may be missing.
    pub optional: bool,
}

impl Field {
    /// A column whose cells may be missing if they are numbers.
    pub fn new(
        name: impl Into<String>,
        kind: Kind,
        unit: impl Into<String>,
        doc: impl Into<String>,
    ) -> Self {
        Self {
            name: name.into(),
            kind,
            unit: unit.into(),
            doc: doc.into(),
            optional: kind == Kind::Number,
        }
    }

    /// The column, and whether its cells may be missing.
    #[must_use]
    pub fn with_optional(self, optional: bool) -> Self {
        Self { optional, ..self }
    }

    /// What Arrow's schema says of the column, by key: its meaning and unit, where it has them.
    pub fn metadata(&self) -> impl Iterator<Item = (&'static str, &str)> {
        [("description", &*self.doc), ("unit", &*self.unit)]
            .into_iter()
            .filter(|(_, text)| !text.is_empty())
    }
}
