//! The resolved config as TOML: every default and preset spelled out, in a fixed order. Equal plans
//! have equal texts, so the hash of the text identifies the plan.

use super::checked::{Checked, CheckedValue};
use super::quantity::Quantity;
use std::fmt::Write;

/// Writes the document. Top-level tables get a header, everything else is inline.
pub(super) fn document(root: &Checked) -> String {
    let mut text = String::new();
    let CheckedValue::Table(entries) = &root.value else {
        return text;
    };
    for (key, checked) in entries
        .iter()
        .filter(|(_, checked)| header(checked).is_none())
    {
        line(&mut text, key, checked);
    }
    for (key, checked) in entries {
        let Some((tag, inner)) = header(checked) else {
            continue;
        };
        let dot = if tag.is_empty() { "" } else { "." };
        put(&mut text, format_args!("\n[{key}{dot}{tag}]\n"));
        if let CheckedValue::Table(entries) = &inner.value {
            for (key, checked) in entries {
                line(&mut text, key, checked);
            }
        }
    }
    text
}

/// The tag (empty for a plain table) and the table, if the value gets a header.
fn header(checked: &Checked) -> Option<(&'static str, &Checked)> {
    match &checked.value {
        CheckedValue::Table(_) => Some(("", checked)),
        CheckedValue::Tagged(tag, inner) => Some((tag, inner)),
        _ => None,
    }
}

fn line(text: &mut String, key: &str, checked: &Checked) {
    text.push_str(key);
    text.push_str(" = ");
    value(text, checked);
    text.push('\n');
}

fn value(text: &mut String, checked: &Checked) {
    match &checked.value {
        CheckedValue::Number(number, _) => quantity(text, number),
        CheckedValue::Real(value) => float(text, *value),
        CheckedValue::Reals(values) => list(text, values, |text, value| float(text, *value)),
        CheckedValue::Integer(value) => put(text, format_args!("{value}")),
        CheckedValue::Boolean(value) => put(text, format_args!("{value}")),
        CheckedValue::Word(word) => put(text, format_args!("\"{word}\"")),
        CheckedValue::Texts(texts) => list(text, texts, |text, value| {
            put(text, format_args!("{value:?}"));
        }),
        CheckedValue::Vector(components) => list(text, components, value),
        CheckedValue::Tagged(tag, inner) => {
            put(text, format_args!("{{ {tag} = "));
            value(text, inner);
            text.push_str(" }");
        }
        CheckedValue::Table(entries) => {
            text.push('{');
            for (index, (key, checked)) in entries.iter().enumerate() {
                put(
                    text,
                    format_args!("{} {key} = ", if index == 0 { "" } else { "," }),
                );
                value(text, checked);
            }
            text.push_str(" }");
        }
        // a config with problems is never written
        CheckedValue::Invalid => {}
    }
}

fn quantity(text: &mut String, quantity: &Quantity) {
    match quantity.canonical() {
        Quantity::Constant(value) => float(text, value),
        Quantity::List(values) => list(text, &values, |text, value| float(text, *value)),
        Quantity::Range(range) => {
            text.push_str("{ from = ");
            float(text, range.from);
            text.push_str(", to = ");
            float(text, range.to);
            put(text, format_args!(", steps = {}", range.steps));
            text.push_str(if range.log {
                ", scale = \"log\" }"
            } else {
                " }"
            });
        }
    }
}

fn list<T>(text: &mut String, items: &[T], item: impl Fn(&mut String, &T)) {
    text.push('[');
    for (index, value) in items.iter().enumerate() {
        if index > 0 {
            text.push_str(", ");
        }
        item(text, value);
    }
    text.push(']');
}

/// The shortest text that reads back as the same number; always with a point or an exponent.
fn float(text: &mut String, value: f64) {
    put(text, format_args!("{value:?}"));
}

fn put(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    text.write_fmt(arguments)
        .expect("writing to a string cannot fail");
}
