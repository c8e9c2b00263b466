//! The checked values of a table, at one point of a sweep.

use crate::EngineError;

/// A checked value.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number; if it is swept, its value at this point.
    Number(f64),
    /// Measured numbers, at least one.
    Numbers(Vec<f64>),
    /// A whole number.
    Integer(u64),
    /// `true` or `false`.
    Boolean(bool),
    /// A word.
    Word(&'static str),
    /// Texts, at least one.
    Texts(Vec<String>),
    /// Three values: x, y, z.
    Vector(Vec<Value>),
    /// A table.
    Table(Values),
    /// A table with a single key that names the alternative.
    Tagged(&'static str, Box<Value>),
}

impl Value {
    /// The number.
    ///
    /// # Errors
    /// [`EngineError`] if the value has another kind.
    pub fn number(&self) -> Result<f64, EngineError> {
        match self {
            Self::Number(number) => Ok(*number),
            _ => Err(EngineError::mismatch(
                "a value is not the number its schema promises",
            )),
        }
    }

    /// The values of the table.
    ///
    /// # Errors
    /// [`EngineError`] if the value has another kind.
    pub fn table(&self) -> Result<&Values, EngineError> {
        match self {
            Self::Table(values) => Ok(values),
            _ => Err(EngineError::mismatch(
                "a value is not the table its schema promises",
            )),
        }
    }

    /// The components of the vector.
    ///
    /// # Errors
    /// [`EngineError`] if the value has another kind.
    pub fn components(&self) -> Result<&[Self; 3], EngineError> {
        match self {
            Self::Vector(components) => components.as_slice().try_into().ok(),
            _ => None,
        }
        .ok_or_else(|| EngineError::mismatch("a value is not the vector its schema promises"))
    }
}

/// The checked values of a table, including defaults, from which an engine or a law reads its
/// settings.
///
/// Reading a key or type that is not in the schema is an error that names it: schema and reader
/// disagree.
///
/// # Example
/// ```
/// use coinmc_core::schema::{Value, Values};
/// let values = Values::new(vec![("zeno", Value::Number(0.01)), ("ccd", Value::Boolean(true))]);
/// assert_eq!(values.number("zeno")?, 0.01);
/// assert!(values.boolean("ccd")? && values.word("law").is_err());
/// # Ok::<(), coinmc_core::EngineError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Values(Vec<(&'static str, Value)>);

impl Values {
    /// Values under their keys.
    pub fn new(entries: Vec<(&'static str, Value)>) -> Self {
        Self(entries)
    }

    /// All keys with their values, in order.
    pub fn entries(&self) -> impl Iterator<Item = (&'static str, &Value)> {
        self.0.iter().map(|(key, value)| (*key, value))
    }

    /// The value of a key, if present.
    pub fn get(&self, key: &str) -> Option<&Value> {
        let found = self.0.iter().find(|(name, _)| *name == key);
        found.map(|(_, value)| value)
    }

    /// The same values without this key.
    #[must_use]
    pub fn without(mut self, key: &str) -> Self {
        self.0.retain(|(name, _)| *name != key);
        self
    }

    /// The number under a key.
    ///
    /// # Errors
    /// [`EngineError`] if there is none, as with every method here.
    pub fn number(&self, key: &str) -> Result<f64, EngineError> {
        self.optional(key)?.ok_or_else(|| missing(key))
    }

    /// The value under a key.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn required(&self, key: &str) -> Result<&Value, EngineError> {
        self.get(key).ok_or_else(|| missing(key))
    }

    /// The number under a key; `None` if the key is absent.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn optional(&self, key: &str) -> Result<Option<f64>, EngineError> {
        match self.get(key) {
            Some(Value::Number(number)) => Ok(Some(*number)),
            Some(_) => Err(missing(key)),
            None => Ok(None),
        }
    }

    /// The measured numbers under a key; none if it is absent.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn numbers(&self, key: &str) -> Result<&[f64], EngineError> {
        match self.get(key) {
            Some(Value::Numbers(numbers)) => Ok(numbers),
            Some(_) => Err(missing(key)),
            None => Ok(&[]),
        }
    }

    /// The texts under a key; none if it is absent.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn texts(&self, key: &str) -> Result<&[String], EngineError> {
        match self.get(key) {
            Some(Value::Texts(texts)) => Ok(texts),
            Some(_) => Err(missing(key)),
            None => Ok(&[]),
        }
    }

    /// The whole number under a key.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn integer<T: TryFrom<u64>>(&self, key: &str) -> Result<T, EngineError> {
        match self.get(key) {
            Some(Value::Integer(number)) => T::try_from(*number).map_err(|_| missing(key)),
            _ => Err(missing(key)),
        }
    }

    /// The boolean under a key.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn boolean(&self, key: &str) -> Result<bool, EngineError> {
        match self.get(key) {
            Some(Value::Boolean(holds)) => Ok(*holds),
            _ => Err(missing(key)),
        }
    }

    /// The word under a key.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn word(&self, key: &str) -> Result<&'static str, EngineError> {
        match self.get(key) {
            Some(Value::Word(word)) => Ok(word),
            _ => Err(missing(key)),
        }
    }

    /// The member of `all` with the name under a key.
    ///
    /// # Errors
    /// As [`number`](Self::number), also if the word names none of them.
    pub fn one_of<T: Copy, const N: usize>(
        &self,
        key: &str,
        all: [T; N],
        name: fn(T) -> &'static str,
    ) -> Result<T, EngineError> {
        let word = self.word(key)?;
        let mut all = all.into_iter();
        all.find(|one| name(*one) == word)
            .ok_or_else(|| unlisted(key, word))
    }

    /// The name of an alternative and its values: a word has none, a table has those under its key.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn named(&self, key: &str) -> Result<(&'static str, &Self), EngineError> {
        const NOTHING: &Values = &Values(Vec::new());
        match self.get(key) {
            Some(Value::Word(word)) => Ok((word, NOTHING)),
            Some(Value::Tagged(tag, inner)) => match &**inner {
                Value::Table(values) => Ok((tag, values)),
                _ => Err(missing(key)),
            },
            _ => Err(missing(key)),
        }
    }

    /// The table under a key; `None` if the key is absent.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn table(&self, key: &str) -> Result<Option<&Self>, EngineError> {
        match self.get(key) {
            Some(Value::Table(values)) => Ok(Some(values)),
            Some(_) => Err(missing(key)),
            None => Ok(None),
        }
    }
}

/// An alternative that is in the schema but unknown to its reader.
pub fn unlisted(key: &str, name: &str) -> EngineError {
    EngineError::mismatch(format_args!("there is no `{key}` called `{name}`"))
}

fn missing(key: &str) -> EngineError {
    EngineError::mismatch(format_args!("`{key}` is not what its schema promises"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Landing;

    /// One value of each kind under the name of its kind.
    fn values() -> Values {
        let law = Values::new(vec![("k", Value::Number(2.0))]);
        Values::new(vec![
            ("number", Value::Number(0.5)),
            ("numbers", Value::Numbers(vec![3.0, 1.0, 3.0])),
            ("integer", Value::Integer(300)),
            ("on", Value::Boolean(true)),
            ("off", Value::Boolean(false)),
            ("word", Value::Word("adhesive")),
            ("texts", Value::Texts(vec!["a.csv".into(), "b.csv".into()])),
            (
                "tagged",
                Value::Tagged("spring", Box::new(Value::Table(law.clone()))),
            ),
            (
                "tagged-number",
                Value::Tagged("spring", Box::new(Value::Number(1.0))),
            ),
            ("table", Value::Table(law)),
        ])
    }

    #[test]
    fn each_kind_is_read_as_it_was_given() {
        let values = values();
        assert_eq!(values.number("number"), Ok(0.5));
        assert_eq!(values.numbers("numbers"), Ok(&[3.0, 1.0, 3.0][..]));
        assert_eq!(values.integer::<u32>("integer"), Ok(300));
        assert_eq!(values.boolean("on"), Ok(true));
        assert_eq!(values.boolean("off"), Ok(false));
        assert_eq!(values.word("word"), Ok("adhesive"));
        assert_eq!(values.texts("texts").unwrap(), ["a.csv", "b.csv"]);
        let table = values.table("table").unwrap().unwrap();
        assert_eq!(table.number("k"), Ok(2.0));
    }

    #[test]
    fn an_alternative_has_its_name_and_its_values() {
        let values = values();
        let (name, inner) = values.named("word").unwrap();
        assert_eq!((name, inner.entries().count()), ("adhesive", 0));
        let (name, inner) = values.named("tagged").unwrap();
        assert_eq!((name, inner.number("k")), ("spring", Ok(2.0)));
        for bad in ["tagged-number", "number", "absent"] {
            assert!(values.named(bad).unwrap_err().is_mismatch(), "{bad}");
        }
    }

    #[test]
    fn a_word_chooses_the_member_of_that_name() {
        let values = values();
        let landing = values.one_of("word", Landing::ALL, Landing::name);
        assert_eq!(landing, Ok(Landing::Adhesive));
        let unknown = values.one_of("word", [Landing::Bouncing], Landing::name);
        assert!(unknown.unwrap_err().to_string().contains("adhesive"));
    }

    #[test]
    fn a_value_of_another_kind_is_a_mismatch() {
        let values = values();
        let errors = [
            values.number("on").err(),
            values.numbers("number").err(),
            values.texts("word").err(),
            values.integer::<u32>("number").err(),
            values.boolean("word").err(),
            values.word("on").err(),
            values.table("tagged").err(),
            // 300 is beyond a byte
            values.integer::<u8>("integer").err(),
        ];
        for error in errors {
            assert!(error.unwrap().is_mismatch());
        }
    }

    #[test]
    fn lists_and_tables_may_be_absent_and_single_values_may_not() {
        let values = values();
        assert_eq!(values.numbers("absent"), Ok(&[][..]));
        assert!(values.texts("absent").unwrap().is_empty());
        assert_eq!(values.table("absent"), Ok(None));
        assert_eq!(values.optional("absent"), Ok(None));
        assert!(values.number("absent").is_err() && values.boolean("absent").is_err());
        assert!(values.integer::<u32>("absent").is_err() && values.word("absent").is_err());
    }

    #[test]
    fn without_a_key_all_others_stay_in_order() {
        let (whole, rest) = (values(), values().without("integer"));
        assert!(rest.get("integer").is_none());
        assert!(
            rest.entries()
                .eq(whole.entries().filter(|(key, _)| *key != "integer"))
        );
    }
}
