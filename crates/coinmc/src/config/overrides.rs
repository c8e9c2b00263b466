//! `--set key.path=value`.

use super::diagnostics::Problems;
use super::schema::{self, Kind};
use super::source::{Sources, Span};
use super::syntax::Mistake;
use super::tree::{self, Node, Table, Value};
use coinmc_core::schema::Value as Checked;
use coinmc_core::{Coin, Preset, Surface};
use std::ops::Range;
use std::str::FromStr;
use thiserror::Error;
use toml::de::{DeTable, DeValue};

/// A value that replaces a value of the config file, or adds one.
///
/// The text is `key.path=value`; the value is a TOML expression, and a bare word that is not TOML
/// is read as a string.
///
/// # Example
/// ```
/// use coinmc::config::{self, Override};
/// let text = "coin.ratio = 1.2\nengine.analytic.rule = 'zone'";
/// let overrides: Vec<Override> =
///     vec!["engine.analytic.rule=arc".parse()?, "coin.ratio=[1.0, 2.0]".parse()?];
/// let plan = config::parse("inline", text, &overrides).unwrap();
/// assert_eq!(plan.points.len(), 2);
/// # Ok::<(), coinmc::config::OverrideError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Override {
    text: String,
    keys: Vec<(String, Range<usize>)>,
    value: Range<usize>,
    /// The name and the text of what the override was made of.
    made_of: Option<(String, String)>,
}

/// Why a text is not an override. Problems of the value itself are found when the config is read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum OverrideError {
    /// There is no `=`.
    #[error("expected `key.path=value`, such as `surface.friction=0.2`")]
    NoEquals,
    /// The text before the `=` is not a dotted key.
    #[error("`{0}` is not a dotted key such as `surface.friction`")]
    Key(String),
    /// The text has a line break or another control character.
    #[error("an override is one line without control characters")]
    Control,
}

impl FromStr for Override {
    type Err = OverrideError;

    fn from_str(text: &str) -> Result<Self, OverrideError> {
        if text.chars().any(|c| c.is_control() && c != '\t') {
            return Err(OverrideError::Control);
        }
        let equals = equals_sign(text).ok_or(OverrideError::NoEquals)?;
        let keys = key_path(&text[..equals])
            .ok_or_else(|| OverrideError::Key(text[..equals].trim().chars().take(60).collect()))?;
        let behind = &text[equals + 1..];
        let start = text.len() - behind.trim_start().len();
        let value = start..start.max(text.trim_end().len());
        Ok(Self {
            text: text.to_owned(),
            keys,
            value,
            made_of: None,
        })
    }
}

/// The first `=` outside quotes.
fn equals_sign(text: &str) -> Option<usize> {
    let mut quote = None;
    for (index, c) in text.char_indices() {
        match (quote, c) {
            (None, '=') => return Some(index),
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), _) if open == c => quote = None,
            _ => {}
        }
    }
    None
}

/// The keys of `a.b."c d"` with their places: read as the one key of a TOML document.
fn key_path(text: &str) -> Option<Vec<(String, Range<usize>)>> {
    // a table header would parse too
    if text.trim_start().starts_with(['[', '#']) {
        return None;
    }
    let document = format!("{text}=0");
    let mut table = DeTable::parse(&document).ok()?.into_inner();
    let mut keys = Vec::new();
    loop {
        let (key, value) = table.into_iter().next()?;
        keys.push((key.get_ref().clone().into_owned(), key.span()));
        match value.into_inner() {
            DeValue::Table(inner) => table = inner,
            _ => return Some(keys),
        }
    }
}

impl Override {
    /// What was typed, `key.path=value`.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether it gives something of this table.
    pub fn is_of(&self, table: &str) -> bool {
        self.keys.first().is_some_and(|(first, _)| first == table)
    }

    /// Whether it gives a value to this dotted key, or to a table that holds it.
    pub fn is_about(&self, key: &str) -> bool {
        let mut wanted = key.split('.');
        self.keys
            .iter()
            .all(|(given, _)| wanted.next() == Some(given))
    }

    /// The same override, which a program made of these words of its user: messages name where they were typed, such
    /// as `--vary`, and quote them.
    ///
    /// # Example
    /// ```
    /// use coinmc::config::{self, Override};
    /// let set: Override = "coin.rato=1.0".parse()?;
    /// let set = set.made_of("--vary", "coin.rato");
    /// let text = "coin.ratio = 1.2\nengine.analytic.rule = 'zone'";
    /// let problems = config::parse("inline", text, &[set]).unwrap_err();
    /// let problem = &problems.problems()[0];
    /// assert_eq!((problem.source.as_str(), problem.column), ("--vary", 6));
    /// assert!(!problems.render(false).contains("1.0"));
    /// # Ok::<(), coinmc::config::OverrideError>(())
    /// ```
    #[must_use]
    pub fn made_of(mut self, name: impl Into<String>, words: impl Into<String>) -> Self {
        self.made_of = Some((name.into(), words.into()));
        self
    }

    /// Its text as a source of problems.
    fn add_to(&self, sources: &mut Sources) -> usize {
        match (&self.made_of, equals_sign(&self.text)) {
            (Some((name, words)), Some(equals)) => {
                sources.add_made((&self.text, equals), (name, words))
            }
            _ => sources.add("--set", &self.text),
        }
    }

    /// Puts the value into the tree, or reports what is wrong with it.
    pub(super) fn apply(&self, sources: &mut Sources, root: &mut Table, problems: &mut Problems) {
        let source = self.add_to(sources);
        match self.node(sources, source) {
            Ok(node) => {
                let path: Vec<(String, Span)> = self
                    .keys
                    .iter()
                    .map(|(key, range)| (key.clone(), sources.span(source, range.clone())))
                    .collect();
                lay_out(root, &path, node.span);
                root.set(&path, node);
            }
            Err(Mistake {
                span,
                message,
                help,
            }) => {
                let any = "a number, a list [1, 2], a range {from = 0, to = 1, steps = 5}, true, or a word";
                problems.add_with_help(span, message, help.as_deref().unwrap_or(any));
            }
        }
    }

    fn node(&self, sources: &Sources, source: usize) -> Result<Node, Mistake> {
        let text = &self.text[self.value.clone()];
        tree::value(sources, source, self.value.start, text).or_else(|error| {
            if is_word(text) {
                let span = sources.span(source, self.value.clone());
                Ok(Node {
                    value: Value::Text(text.to_owned()),
                    span,
                })
            } else {
                Err(error)
            }
        })
    }
}

/// Makes room for a value at this place: takes out keys that say the same as its own, and spells out the part of a
/// preset of which it is a part, whose numbers stand in no text: what is wrong with them is told of the value.
fn lay_out(root: &mut Table, path: &[(String, Span)], value: Span) {
    let [(table, _), (key, _), deeper @ ..] = path else {
        return;
    };
    let Some(Value::Table(there)) = root.get_mut(table).map(|node| &mut node.value) else {
        return;
    };
    if deeper.is_empty() {
        let same = same_as(table, key);
        there
            .entries
            .retain(|entry| entry.key == *key || !same.contains(&entry.key.as_str()));
    } else if table == "launch"
        && there.get(key).is_none()
        && let Some(Value::Text(preset)) = there.get("preset").map(|entry| &entry.node.value)
        && let Some(node) = of_preset(preset, key, deeper, value)
    {
        there.set(&[(key.clone(), value)], node);
    }
}

/// Keys that say the same as this one, or of which this one takes the place.
fn same_as(table: &str, key: &str) -> Vec<&'static str> {
    // a number of tosses excludes targets, and whatever belongs to those
    if table == "stop" && key == "tosses" {
        let stop = schema::root()
            .fields
            .into_iter()
            .find(|field| field.name == "stop");
        let Some(Kind::Table(stop)) = stop.map(|field| field.kind) else {
            return vec![];
        };
        return stop.fields.into_iter().map(|field| field.name).collect();
    }
    if table == "stop" && schema::TARGETS.contains(&key) {
        return vec!["tosses"];
    }
    let names = |keys: &[(&'static str, f64)]| keys.iter().map(|(key, _)| *key).collect();
    let mut heights: Vec<&'static str> = names(&Coin::HEIGHTS);
    heights.push("ratio");
    let groups = match table {
        "coin" => vec![heights, names(&Coin::RADII)],
        "surface" => Surface::ALTERNATIVES.map(<[_]>::to_vec).to_vec(),
        _ => vec![],
    };
    let mut groups = groups.into_iter();
    groups
        .find(|group| group.contains(&key))
        .unwrap_or_default()
}

/// The value of a key of a preset, if it is a table with the first key of `deeper`: without what a value
/// at that path says in another way.
fn of_preset(preset: &str, key: &str, deeper: &[(String, Span)], span: Span) -> Option<Node> {
    let values = preset.parse::<Preset>().ok()?.distribution().values();
    let value = values.get(key)?;
    let mut node = Node::of_value(span, value);
    match &node.value {
        Value::Table(table) if table.get(&deeper[0].0).is_some() => {}
        _ => return None,
    }
    drop_other_ways(&mut node, value, deeper);
    Some(node)
}

/// Empties the table of a choice, such as `uniform` or `normal`, in which `path` takes another way.
fn drop_other_ways(node: &mut Node, value: &Checked, path: &[(String, Span)]) {
    let ([(key, _), deeper @ ..], Value::Table(table)) = (path, &mut node.value) else {
        return;
    };
    let inner = match value {
        Checked::Tagged(tag, _) if tag != key => return table.entries.clear(),
        Checked::Tagged(_, inner) => Some(&**inner),
        Checked::Table(values) => values.get(key),
        _ => None,
    };
    if let (Some(node), Some(inner)) = (table.get_mut(key), inner) {
        drop_other_ways(node, inner, deeper);
    }
}

fn is_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_split_with_their_places() {
        let set: Override = r#" a . "b=c" .d = 1"#.parse().unwrap();
        assert_eq!(
            set.keys,
            [
                ("a".into(), 1..2),
                ("b=c".into(), 5..10),
                ("d".into(), 12..13)
            ]
        );
        assert_eq!(set.value, 16..17);
    }

    #[test]
    fn invalid_overrides_are_rejected() {
        for bad in [
            "", "a", "=1", "a.=1", "a b=1", "[a]=1", "#a=1", "a=1\nb=2", "a..b=1", "\"a=1",
        ] {
            assert!(bad.parse::<Override>().is_err(), "{bad}");
        }
        let deep = format!("{}a=1", "a.".repeat(100_000));
        assert!(deep.parse::<Override>().is_err());
    }

    #[test]
    fn an_override_is_about_its_key_and_what_is_in_it() {
        let set: Override = "surface={friction=0.2}".parse().expect("an override");
        assert!(set.is_about("surface.friction") && !set.is_about("coin.ratio"));
        let set: Override = "surface.friction=0.2".parse().expect("an override");
        assert!(set.is_about("surface.friction") && !set.is_about("surface.restitution"));
        assert!(!set.is_about("surface"));
        assert!(set.is_of("surface") && !set.is_of("coin") && !set.is_of("friction"));
    }
}
