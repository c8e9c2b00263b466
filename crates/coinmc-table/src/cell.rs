//! What a table is made of.

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A whole number, 0 to 2^64 − 1.
    Count,
    /// A 64-bit floating point number.
    Number,
    /// A 32-bit floating point number. Its column in a file has no dictionary, as samples hardly ever repeat.
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
    /// No value.
    Missing,
}

impl<'a> Cell<'a> {
    /// A number; missing if it is not finite.
    pub fn finite(value: f64) -> Self {
        if value.is_finite() {
            Self::Number(value)
        } else {
            Self::Missing
        }
    }

    /// The count, if it is one.
    pub fn count(self) -> Option<u64> {
        match self {
            Self::Count(count) => Some(count),
            _ => None,
        }
    }

    /// The number, if it is one.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(number),
            _ => None,
        }
    }

    /// The number in single precision, if it is one.
    pub fn single(self) -> Option<f32> {
        // rounded, as a column of single precision asks for
        #[allow(clippy::cast_possible_truncation)]
        self.number().map(|number| number as f32)
    }

    /// The text, if it is one.
    pub fn text(self) -> Option<&'a str> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Whether it is true or false, if it is a flag.
    pub fn flag(self) -> Option<bool> {
        match self {
            Self::Flag(flag) => Some(flag),
            _ => None,
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
    /// Unit; `1` for pure numbers, empty for text and flags, and where none is told.
    pub unit: String,
    /// What it means; empty where it is not told.
    pub doc: String,
    /// Whether cells may be missing.
    pub optional: bool,
}

impl Field {
    /// A column; its cells may be missing if it is of [`Kind::Number`] (see [`with_optional`](Self::with_optional)).
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

    /// The same column, with cells that may be missing, or must not.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// As documents of formats name them.
    #[test]
    fn kinds_have_the_names_of_documents() {
        let kinds = [
            Kind::Count,
            Kind::Number,
            Kind::Single,
            Kind::Text,
            Kind::Flag,
        ];
        let names = kinds.map(Kind::name);
        assert_eq!(names, ["u64", "f64", "f32", "text", "bool"]);
    }

    #[test]
    fn a_number_that_is_not_finite_is_missing() {
        assert_eq!(Cell::finite(0.5), Cell::Number(0.5));
        assert_eq!(Cell::finite(f64::NAN), Cell::Missing);
        assert_eq!(Cell::finite(f64::INFINITY), Cell::Missing);
    }
}
