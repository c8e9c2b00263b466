//! Schema of configs, as data: keys, their meaning, bounds and defaults.
//!
//! Engines and laws describe their own tables with these types, and read the checked [`Values`] of
//! them. The config reader, its messages, the resolved TOML and the JSON Schema are all derived
//! from these descriptions. Nothing here reads or writes files.
//!
//! # Example
//! ```
//! use coinmc_core::schema::{Bounds, default, fields, number};
//! const STEP: Bounds = Bounds::above_zero(100.0);
//! let table = fields(vec![number("step_s", "Time step, s.", STEP, default(1e-3))]);
//! assert_eq!(table.field("step_s").unwrap().doc, "Time step, s.");
//! assert_eq!(STEP.check("step_s", 0.0).unwrap_err().to_string(),
//!            "step_s must be above 0 and at most 100, not 0");
//! ```

mod bounds;
mod read_error;
mod terms;
mod values;

pub use bounds::{Bounds, OutOfRange, Whole};
pub use read_error::ReadError;
pub use terms::{choice, count, default, field, fields, flag, number, table};
pub use values::{Value, Values, unlisted};

/// A key of a table.
#[derive(Debug, Clone)]
pub struct Field {
    /// The key.
    pub name: &'static str,
    /// What it means, with its unit.
    pub doc: &'static str,
    /// The allowed values.
    pub kind: Kind,
    /// The meaning of its absence.
    pub absent: Absent,
}

/// The meaning of an absent key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Absent {
    /// It is an error.
    Required,
    /// Nothing, unless one of the table's rules says otherwise.
    Omitted,
    /// The same as this value.
    Is(Fallback),
}

/// The default of an absent key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fallback {
    /// A number.
    Number(f64),
    /// A whole number.
    Integer(u64),
    /// `true` or `false`.
    Boolean(bool),
    /// A word.
    Word(&'static str),
    /// A table with all its defaults.
    Table,
}

/// The kind of a value.
#[derive(Debug, Clone)]
pub enum Kind {
    /// A number that may be swept: a number, a list or a range.
    Number(Bounds),
    /// A number that cannot be swept.
    Real(Bounds),
    /// One or several measured numbers, in the order given: equal ones are no mistake.
    Reals(Bounds),
    /// A whole number.
    Integer(Whole),
    /// `true` or `false`.
    Boolean,
    /// One of these words.
    Word(Vec<Word>),
    /// One or several texts, such as names of files.
    Texts,
    /// A list of three values of this kind: x, y, z.
    Vector(Box<Kind>),
    /// A number that may be swept, or a distribution (a table with exactly one of these keys).
    Marginal(Bounds, Vec<Field>),
    /// One of these words, or a table with exactly one of these keys.
    Choice(Vec<Word>, Vec<Field>),
    /// A table.
    Table(TableKind),
}

/// The keys of a table and how they depend on each other.
#[derive(Debug, Clone)]
pub struct TableKind {
    /// Its keys, in the order of the reference.
    pub fields: Vec<Field>,
    /// How they depend on each other.
    pub rules: Vec<Rule>,
}

/// How the keys of one table depend on each other.
#[derive(Debug, Clone, Copy)]
pub enum Rule {
    /// Exactly one of these is given.
    ExactlyOne(&'static [&'static str]),
    /// The key is allowed only with one of some other keys, and may have a default where it is not
    /// given with them.
    GoesWith {
        /// The key.
        key: &'static str,
        /// The keys of which it requires at least one.
        others: &'static [&'static str],
        /// The default of the key if any of the others is given.
        fallback: Option<Fallback>,
    },
    /// Both of these are given or none, unless a condition holds.
    Together {
        /// The keys.
        keys: [&'static str; 2],
        /// When one of them may be given alone.
        unless: Condition,
    },
    /// At most one of these is given.
    NotBoth([&'static str; 2]),
    /// These keys are required unless a condition holds; then they have a default.
    Unless {
        /// When they may be absent.
        condition: Condition,
        /// The keys.
        keys: &'static [&'static str],
        /// Their default, if they have one.
        fallback: Option<Fallback>,
    },
}

/// A condition on another key of the same table.
#[derive(Debug, Clone, Copy)]
pub enum Condition {
    /// It is given.
    Given(&'static str),
    /// It is this word.
    Word(&'static str, &'static str),
    /// It is a table with this key.
    Tag(&'static str, &'static str),
    /// Any of these holds.
    Either(&'static [Condition]),
}

impl Condition {
    /// The condition in words, after "… is missing: required unless …".
    pub fn text(self) -> String {
        match self {
            Self::Given(key) => format!("`{key}` is given"),
            Self::Word(key, word) => format!("{key} = \"{word}\""),
            Self::Tag(key, tag) => format!("the {key} is {tag}"),
            Self::Either(conditions) => {
                let texts: Vec<String> = conditions.iter().map(|one| one.text()).collect();
                texts.join(" or ")
            }
        }
    }
}

/// A word with its meaning.
#[derive(Debug, Clone, Copy)]
pub struct Word {
    /// The word.
    pub name: &'static str,
    /// What it means.
    pub doc: &'static str,
}

impl TableKind {
    /// The field with this name.
    pub fn field(&self, name: &str) -> Option<&Field> {
        self.fields.iter().find(|field| field.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_found_by_its_name() {
        let table = fields(vec![
            count("steps", "Steps.", 10),
            flag("ccd", "Whether.", true),
        ]);
        assert_eq!(table.field("steps").unwrap().doc, "Steps.");
        assert_eq!(table.field("ccd").unwrap().doc, "Whether.");
        assert!(table.field("step").is_none());
    }

    #[test]
    fn a_condition_reads_as_words_after_unless() {
        const KINDS: [Condition; 3] = [
            Condition::Given("preset"),
            Condition::Word("spin", "none"),
            Condition::Tag("orientation", "fixed"),
        ];
        let text = Condition::Either(&KINDS).text();
        let expected = "`preset` is given or spin = \"none\" or the orientation is fixed";
        assert_eq!(text, expected);
    }
}
