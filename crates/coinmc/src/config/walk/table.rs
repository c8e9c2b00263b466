//! Tables: their keys, the defaults of absent keys, and the rules between keys.

use super::Walker;
use super::names;
use crate::config::checked::{Checked, CheckedValue};
use crate::config::nearest::{is_same_but_one, nearest};
use crate::config::quantity::Quantity;
use crate::config::schema::{Absent, Condition, Fallback, Field, Kind, Rule, TableKind};
use crate::config::source::Span;
use crate::config::tree::{Entry, Table, Value};

/// A table while it is checked: what each field holds, in the order of the schema.
struct Slots<'a> {
    fields: &'a [Field],
    forms: Vec<Option<Checked>>,
    span: Span,
    path: &'a str,
    /// Fields whose name was probably mistyped; the unknown key has been reported.
    mistyped: Vec<&'static str>,
    /// Fields reported as missing.
    missing: Vec<&'static str>,
}

impl Walker<'_> {
    /// Checks a table. `span` is the location of problems with absent keys.
    pub(super) fn table(
        &mut self,
        kind: &TableKind,
        table: &Table,
        span: Span,
        path: &str,
    ) -> Checked {
        let fields = &kind.fields;
        let forms = vec![None; fields.len()];
        let mut slots = Slots {
            fields,
            forms,
            span,
            path,
            mistyped: vec![],
            missing: vec![],
        };
        for entry in &table.entries {
            let Some(index) = fields.iter().position(|field| field.name == entry.key) else {
                self.unknown_key(entry, fields, path);
                slots
                    .mistyped
                    .extend(nearest(&entry.key, fields.iter().map(|f| f.name)));
                self.meant(entry, table, fields, path);
                continue;
            };
            let path = join(path, fields[index].name);
            slots.forms[index] = Some(self.value(&fields[index].kind, &entry.node, &path));
        }
        for (index, field) in fields.iter().enumerate() {
            if slots.forms[index].is_none() {
                match field.absent {
                    Absent::Required => self.missing(&mut slots, index, ""),
                    Absent::Is(fallback) => slots.fill(index, fallback),
                    Absent::Omitted => {}
                }
            }
        }
        for rule in &kind.rules {
            self.rule(*rule, &mut slots);
        }
        let present = fields.iter().zip(slots.forms);
        let entries = present
            .filter_map(|(field, checked)| Some((field.name, checked?)))
            .collect();
        Checked::new(span, CheckedValue::Table(entries))
    }

    fn missing(&mut self, slots: &mut Slots<'_>, index: usize, unless: &str) {
        let field = &slots.fields[index];
        if !slots.mistyped.contains(&field.name) {
            let place = if slots.path.is_empty() {
                String::new()
            } else {
                format!(" in `{}`", slots.path)
            };
            let message = format!("`{}` is missing{place}{unless}", field.name);
            let help = match &field.kind {
                Kind::Choice(words, tags) if words.is_empty() => {
                    format!("{} One of {}.", field.doc, names(tags))
                }
                Kind::Table(_) if slots.path.is_empty() => {
                    format!("add [{}]: {}", field.name, field.doc)
                }
                _ => field.doc.to_owned(),
            };
            self.problems.add_with_help(slots.span, message, help);
            slots.missing.push(field.name);
        }
        slots.forms[index] = Some(Checked::invalid(slots.span));
    }

    fn rule(&mut self, rule: Rule, slots: &mut Slots<'_>) {
        match rule {
            Rule::ExactlyOne(keys) => self.exactly_one(keys, slots),
            Rule::Together { keys, unless } => self.together(keys, unless, slots),
            Rule::NotBoth(keys) => self.not_both(keys, slots),
            Rule::GoesWith {
                key,
                others,
                fallback,
            } => {
                let Some(at) = slots.index(key) else {
                    return;
                };
                let with = others.iter().any(|other| slots.get(other).is_some());
                match (&slots.forms[at], with, fallback) {
                    (Some(checked), false, _) => {
                        let others: Vec<_> = others.iter().map(|key| format!("`{key}`")).collect();
                        let message = format!("`{key}` goes with {} only", others.join(" or "));
                        self.problems.add(checked.span, message);
                    }
                    (None, true, Some(fallback)) => slots.fill(at, fallback),
                    _ => {}
                }
            }
            Rule::Unless {
                condition,
                keys,
                fallback,
            } => {
                let holds = slots.holds(condition);
                for index in keys
                    .iter()
                    .filter_map(|key| slots.index(key))
                    .collect::<Vec<_>>()
                {
                    match (&slots.forms[index], holds, fallback) {
                        (None, Some(false), _) => {
                            let unless = format!(" (required unless {})", condition.text());
                            self.missing(slots, index, &unless);
                        }
                        (None, Some(true), Some(fallback)) => slots.fill(index, fallback),
                        // an invalid value may have meant either: no further message
                        (None, None, _) => slots.forms[index] = Some(Checked::invalid(slots.span)),
                        _ => {}
                    }
                }
            }
        }
    }

    fn exactly_one(&mut self, keys: &[&'static str], slots: &mut Slots<'_>) {
        let all = keys
            .iter()
            .map(|key| format!("`{key}`"))
            .collect::<Vec<_>>()
            .join(", ");
        let given: Vec<Span> = keys
            .iter()
            .filter_map(|key| Some(slots.get(key)?.span))
            .collect();
        for span in given.iter().skip(1) {
            let message = format!("only one of {all} is allowed in `{}`", slots.path);
            self.problems
                .add_with_help(*span, message, "remove the others");
        }
        if given.is_empty() && !keys.iter().any(|key| slots.mistyped.contains(key)) {
            let message = format!("one of {all} is missing in `{}`", slots.path);
            self.problems.add(slots.span, message);
        }
    }

    fn together(&mut self, keys: [&'static str; 2], unless: Condition, slots: &mut Slots<'_>) {
        if slots.holds(unless) != Some(false) {
            return;
        }
        let [a, b] = keys.map(|key| slots.get(key).is_some());
        let (given, absent) = match (a, b) {
            (true, false) => (keys[0], keys[1]),
            (false, true) => (keys[1], keys[0]),
            _ => return,
        };
        if let Some(index) = slots.index(absent) {
            self.missing(slots, index, &format!(" (required with `{given}`)"));
        }
    }

    fn not_both(&mut self, keys: [&'static str; 2], slots: &Slots<'_>) {
        let [Some(first), Some(second)] = keys.map(|key| slots.get(key)) else {
            return;
        };
        let message = format!(
            "only one of `{}`, `{}` is allowed in `{}`",
            keys[0], keys[1], slots.path
        );
        let span = first.span.max(second.span);
        self.problems
            .add_with_help(span, message, "remove the other");
    }
}

impl Slots<'_> {
    fn index(&self, key: &str) -> Option<usize> {
        self.fields.iter().position(|field| field.name == key)
    }

    fn get(&self, key: &str) -> Option<&Checked> {
        self.forms[self.index(key)?].as_ref()
    }

    fn fill(&mut self, index: usize, fallback: Fallback) {
        self.forms[index] = Some(absent(&self.fields[index].kind, fallback, self.span));
    }

    /// Whether a condition holds; `None` if that is unknown because a value is invalid.
    fn holds(&self, condition: Condition) -> Option<bool> {
        let decided = |key: &str, holds: &dyn Fn(&Checked) -> bool| match self.get(key) {
            _ if self.missing.contains(&key) => Some(false),
            Some(Checked {
                value: CheckedValue::Invalid,
                ..
            }) => None,
            Some(checked) => Some(holds(checked)),
            None if self.mistyped.contains(&key) => None,
            None => Some(false),
        };
        match condition {
            // an invalid preset is still a given one
            Condition::Given(key) => Some(self.get(key).is_some() || self.mistyped.contains(&key)),
            Condition::Word(key, word) => decided(key, &|checked| checked.word() == Some(word)),
            Condition::Tag(key, tag) => decided(key, &|checked| checked.tag() == Some(tag)),
            Condition::Either(conditions) => {
                let mut held: Vec<_> = conditions.iter().map(|one| self.holds(*one)).collect();
                // true if any is, unknown if none is but one might be
                held.sort_by_key(|holds| match holds {
                    Some(true) => 0,
                    None => 1,
                    Some(false) => 2,
                });
                held.first().copied().flatten()
            }
        }
    }
}

/// The table that an entry of another name is without doubt: what is in it is checked as well.
pub(super) fn meant<'a>(entry: &Entry, table: &Table, fields: &'a [Field]) -> Option<&'a Field> {
    let name = nearest(&entry.key, fields.iter().map(|field| field.name))?;
    let field = fields.iter().find(|field| field.name == name)?;
    let both_tables = matches!(field.kind, Kind::Table(_) | Kind::Choice(..))
        && matches!(entry.node.value, Value::Table(_));
    let is_sure = is_same_but_one(&entry.key, name);
    (both_tables && is_sure && table.get(name).is_none()).then_some(field)
}

/// The default of an absent key.
fn absent(kind: &Kind, fallback: Fallback, span: Span) -> Checked {
    let constant = |value| CheckedValue::Number(Quantity::Constant(value), None);
    let value = match (fallback, kind) {
        (Fallback::Number(value), Kind::Real(_)) => CheckedValue::Real(value),
        (Fallback::Number(value), _) => constant(value),
        (Fallback::Integer(value), _) => CheckedValue::Integer(value),
        (Fallback::Boolean(value), _) => CheckedValue::Boolean(value),
        (Fallback::Word(word), _) => CheckedValue::Word(word),
        (Fallback::Table, Kind::Table(table)) => CheckedValue::Table(
            table
                .fields
                .iter()
                .filter_map(|field| match field.absent {
                    Absent::Is(fallback) => Some((field.name, absent(&field.kind, fallback, span))),
                    Absent::Required | Absent::Omitted => None,
                })
                .collect(),
        ),
        (Fallback::Table, _) => CheckedValue::Invalid,
    };
    Checked::new(span, value)
}

pub(super) fn join(path: &str, key: &str) -> String {
    if path.is_empty() {
        key.to_owned()
    } else {
        format!("{path}.{key}")
    }
}
