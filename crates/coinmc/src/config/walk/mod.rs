//! Checks the parsed text against the schema: every key and value, and the rules between the keys
//! of one table.

mod number;
mod table;

use super::checked::{Checked, CheckedValue};
use super::diagnostics::{Problems, quoted};
use super::nearest::nearest;
use super::schema::{Field, Kind, TableKind, Whole, Word};
use super::source::{Sources, Span};
use super::tree::{Entry, Node, Table, Value};

/// Checks a whole document.
pub(super) fn document(
    sources: &Sources,
    problems: &mut Problems,
    schema: &TableKind,
    root: &Table,
    end: Span,
) -> Checked {
    Walker { sources, problems }.table(schema, root, end, "")
}

/// Checks one table of a document; `path` is its name in messages.
pub(super) fn section(
    sources: &Sources,
    problems: &mut Problems,
    kind: &TableKind,
    node: &Node,
    path: &str,
) -> Checked {
    Walker { sources, problems }.value(&Kind::Table(kind.clone()), node, path)
}

struct Walker<'a> {
    sources: &'a Sources,
    problems: &'a mut Problems,
}

impl Walker<'_> {
    /// Checks one value; `path` is its name in messages.
    fn value(&mut self, kind: &Kind, node: &Node, path: &str) -> Checked {
        match kind {
            Kind::Number(bounds) => self.quantity(*bounds, node, path),
            Kind::Real(bounds) => match self.real(*bounds, node, path) {
                Some(value) => Checked::new(node.span, CheckedValue::Real(value)),
                None => Checked::invalid(node.span),
            },
            Kind::Reals(bounds) => self.reals(*bounds, node, path),
            Kind::Integer(whole) => self.integer(*whole, node, path),
            Kind::Boolean => match node.value {
                Value::Boolean(value) => Checked::new(node.span, CheckedValue::Boolean(value)),
                _ => self.wrong_type(node, path, "true or false"),
            },
            Kind::Word(words) => match &node.value {
                Value::Text(text) => self.word(words, &[], text, node.span, path),
                _ => self.wrong_type(node, path, &alternatives(words, &[])),
            },
            Kind::Texts => self.texts(node, path),
            Kind::Vector(component) => self.vector(component, node, path),
            Kind::Marginal(bounds, distributions) => match &node.value {
                Value::Table(table) if is_distribution(table, distributions) => {
                    self.tagged(distributions, table, node.span, path)
                }
                _ => self.quantity(*bounds, node, path),
            },
            Kind::Choice(words, tags) => match &node.value {
                Value::Table(table) => self.tagged(tags, table, node.span, path),
                Value::Text(text) => self.word(words, tags, text, node.span, path),
                _ => self.wrong_type(node, path, &alternatives(words, tags)),
            },
            Kind::Table(kind) => match &node.value {
                Value::Table(table) => self.table(kind, table, node.span, path),
                _ => self.wrong_type(node, path, "a table"),
            },
        }
    }

    fn wrong_type(&mut self, node: &Node, path: &str, expected: &str) -> Checked {
        let found = node.value.type_name();
        let message = match &node.value {
            Value::Table(_) | Value::List(_) => {
                format!("`{path}` must be {expected}, found {found}")
            }
            _ => {
                let text = quoted(self.sources.text(node.span));
                format!("`{path}` must be {expected}, found {found}: {text}")
            }
        };
        let is_number = |text: &str| text.trim().parse::<f64>().is_ok();
        let help = match &node.value {
            Value::Text(text) if is_number(text) && expected.contains("number") => {
                Some("remove the quotes".to_owned())
            }
            _ => None,
        };
        self.problems.push(node.span, message, help);
        Checked::invalid(node.span)
    }

    fn integer(&mut self, whole: Whole, node: &Node, path: &str) -> Checked {
        let expected = format!("a whole number from {} to {}", whole.low, whole.high);
        // whole numbers up to 2^64 are exact in 128 bits, and beyond that they are out of range
        #[allow(clippy::cast_possible_truncation)]
        let value = match node.value {
            Value::Integer(value) => value,
            // 1e6 is the only way to write a million without counting zeros
            Value::Float(value) if value.fract() == 0.0 => value as i128,
            _ => return self.wrong_type(node, path, &expected),
        };
        if let Ok(value) = u64::try_from(value)
            && (whole.low..=whole.high).contains(&value)
        {
            return Checked::new(node.span, CheckedValue::Integer(value));
        }
        let found = quoted(self.sources.text(node.span));
        self.problems.add(
            node.span,
            format!("`{path}` must be {expected}, found {found}"),
        );
        Checked::invalid(node.span)
    }

    fn word(
        &mut self,
        words: &[Word],
        tags: &[Field],
        text: &str,
        span: Span,
        path: &str,
    ) -> Checked {
        if let Some(word) = words.iter().find(|word| word.name == text) {
            return Checked::new(span, CheckedValue::Word(word.name));
        }
        let expected = alternatives(words, tags);
        let message = format!("`{path}` must be {expected}, found {}", quoted(text));
        let near = nearest(text, words.iter().map(|word| word.name));
        self.problems.push(
            span,
            message,
            near.map(|near| format!("did you mean \"{near}\"?")),
        );
        Checked::invalid(span)
    }

    /// One text or a list of texts.
    fn texts(&mut self, node: &Node, path: &str) -> Checked {
        let items = match &node.value {
            Value::List(items) if !items.is_empty() => items.as_slice(),
            Value::Text(_) => std::slice::from_ref(node),
            _ => return self.wrong_type(node, path, "a text or a list of texts"),
        };
        let mut texts = vec![];
        for item in items {
            match &item.value {
                Value::Text(text) => texts.push(text.clone()),
                _ => return self.wrong_type(item, path, "a text or a list of texts"),
            }
        }
        Checked::new(node.span, CheckedValue::Texts(texts))
    }

    fn vector(&mut self, component: &Kind, node: &Node, path: &str) -> Checked {
        let Value::List(items) = &node.value else {
            return self.wrong_type(node, path, "a list of three, x, y and z");
        };
        if items.len() != 3 {
            let message = format!(
                "`{path}` must be a list of three, x, y and z, found {}",
                items.len()
            );
            self.problems.add(node.span, message);
            return Checked::invalid(node.span);
        }
        let components = super::checked::COMPONENTS
            .iter()
            .zip(items)
            .map(|(name, item)| self.value(component, item, &format!("{path}.{name}")))
            .collect();
        Checked::new(node.span, CheckedValue::Vector(components))
    }

    /// A table with exactly one key, which names the alternative.
    fn tagged(&mut self, tags: &[Field], table: &Table, span: Span, path: &str) -> Checked {
        let (mut known, unknown): (Vec<&Entry>, Vec<&Entry>) = table
            .entries
            .iter()
            .partition(|entry| tags.iter().any(|tag| tag.name == entry.key));
        for entry in &unknown {
            self.unknown_key(entry, tags, path);
            self.meant(entry, table, tags, path);
        }
        known.sort_by_key(|entry| entry.key_span);
        // every alternative is checked, so that no problem hides behind another
        let mut forms: Vec<Checked> = known
            .iter()
            .filter_map(|entry| {
                let tag = tags.iter().find(|tag| tag.name == entry.key)?;
                let inner = self.value(&tag.kind, &entry.node, &format!("{path}.{}", tag.name));
                Some(Checked::new(
                    span,
                    CheckedValue::Tagged(tag.name, Box::new(inner)),
                ))
            })
            .collect();
        for entry in known.iter().skip(1) {
            let message = format!(
                "`{path}` is already `{}`: exactly one of {} is allowed",
                known[0].key,
                names(tags)
            );
            self.problems.add(entry.key_span, message);
        }
        if known.is_empty() && unknown.is_empty() {
            self.problems.add(
                span,
                format!("`{path}` is empty: it needs one of {}", names(tags)),
            );
        }
        match forms.pop() {
            Some(checked) if known.len() == 1 && unknown.is_empty() => checked,
            _ => Checked::invalid(span),
        }
    }

    /// Checks what is in a table that is without doubt one of these, if its name is not.
    fn meant(&mut self, entry: &Entry, table: &Table, fields: &[Field], path: &str) {
        if let Some(field) = table::meant(entry, table, fields) {
            self.value(&field.kind, &entry.node, &table::join(path, field.name));
        }
    }

    fn unknown_key(&mut self, entry: &Entry, fields: &[Field], path: &str) {
        let place = if path.is_empty() {
            String::new()
        } else {
            format!(" in `{path}`")
        };
        let message = format!("unknown key {}{place}", quoted(&entry.key));
        let near = nearest(&entry.key, fields.iter().map(|field| field.name));
        let measured = path.is_empty() && OF_CALIBRATE.contains(&entry.key.as_str());
        let help = match (near, home(&entry.key)) {
            _ if measured => format!(
                "`coinmc calibrate` reads [{}]: it is no table of a run",
                entry.key
            ),
            (Some(near), _) => format!("did you mean `{near}`?"),
            (None, Some(table)) => format!("`{}` belongs in [{table}]", entry.key),
            (None, None) => format!("allowed: {}", names(fields)),
        };
        self.problems.add_with_help(entry.key_span, message, help);
    }
}

/// Tables beside those of a run, which `coinmc calibrate` reads (the crate coinmc-calibrate has their keys).
const OF_CALIBRATE: [&str; 9] = [
    "prior",
    "predict",
    "counts",
    "film",
    "roll_out",
    "tilt",
    "spin_down",
    "whirr",
    "bounces",
];

/// Whether a table is meant as a distribution rather than as a range.
fn is_distribution(table: &Table, distributions: &[Field]) -> bool {
    const RANGE: [&str; 4] = ["from", "to", "steps", "scale"];
    let has = |name: &str| table.get(name).is_some();
    distributions.iter().any(|tag| has(tag.name)) || !RANGE.iter().any(|name| has(name))
}

/// The table of the schema that has this key.
fn home(key: &str) -> Option<&'static str> {
    super::schema::root()
        .fields
        .into_iter()
        .find_map(|field| match field.kind {
            Kind::Table(kind) => kind.field(key).map(|_| field.name),
            _ => None,
        })
}

/// "`a`, `b`".
fn names(fields: &[Field]) -> String {
    fields
        .iter()
        .map(|field| format!("`{}`", field.name))
        .collect::<Vec<_>>()
        .join(", ")
}

/// "one of "a", "b", {c = …}".
fn alternatives(words: &[Word], tags: &[Field]) -> String {
    let words = words.iter().map(|word| format!("\"{}\"", word.name));
    let tags = tags.iter().map(|tag| format!("{{{} = …}}", tag.name));
    let all: Vec<String> = words.chain(tags).collect();
    if all.len() == 1 {
        all.concat()
    } else {
        format!("one of {}", all.join(", "))
    }
}
