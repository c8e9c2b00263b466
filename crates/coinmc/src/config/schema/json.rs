//! The schema as JSON Schema (2020-12).

use super::{Absent, Bounds, Condition, Fallback, Field, Kind, Rule, TableKind, Word, range};
use std::fmt::Write as _;

/// JSON whose objects keep the order they were built in, so that the schema reads like the
/// reference and never depends on how some crate was built.
#[derive(Clone)]
enum Json {
    Text(String),
    /// A number or boolean, as written.
    Literal(String),
    List(Vec<Json>),
    Object(Vec<(&'static str, Json)>),
}

/// The JSON Schema of the whole document.
pub(in crate::config) fn json_schema() -> String {
    let mut schema = vec![
        (
            "$schema",
            text("https://json-schema.org/draft/2020-12/schema"),
        ),
        ("title", text("coinmc config")),
        (
            "description",
            text("How likely a tossed cylinder lands on heads, tails or its side."),
        ),
    ];
    schema.extend(table(&super::root()));
    let mut out = String::new();
    write(&mut out, &Json::Object(schema), 0);
    out.push('\n');
    out
}

fn field(field: &Field) -> (&'static str, Json) {
    let mut schema = vec![("description", text(field.doc))];
    schema.extend(kind(&field.kind));
    if let Absent::Is(fallback) = field.absent {
        schema.extend(default(fallback).map(|value| ("default", value)));
    }
    (field.name, Json::Object(schema))
}

fn kind(kind: &Kind) -> Vec<(&'static str, Json)> {
    match kind {
        Kind::Number(bounds) => any_of(quantity(*bounds)),
        Kind::Real(bounds) => real(*bounds),
        Kind::Reals(bounds) => one_or_several(real(*bounds)),
        Kind::Integer(whole) => vec![
            ("type", text("integer")),
            ("minimum", literal(whole.low)),
            ("maximum", literal(whole.high)),
        ],
        Kind::Boolean => vec![("type", text("boolean"))],
        Kind::Word(list) => any_of(words(list)),
        Kind::Texts => one_or_several(vec![("type", text("string"))]),
        Kind::Vector(component) => vec![
            ("type", text("array")),
            ("items", Json::Object(self::kind(component))),
            ("minItems", literal(3)),
            ("maxItems", literal(3)),
        ],
        Kind::Marginal(bounds, distributions) => {
            let mut alternatives = quantity(*bounds);
            alternatives.push(tagged(distributions));
            any_of(alternatives)
        }
        Kind::Choice(list, tags) => {
            let mut alternatives = words(list);
            alternatives.push(tagged(tags));
            any_of(alternatives)
        }
        Kind::Table(kind) => table(kind),
    }
}

fn real(bounds: Bounds) -> Vec<(&'static str, Json)> {
    let low = if bounds.open.0 {
        "exclusiveMinimum"
    } else {
        "minimum"
    };
    let high = if bounds.open.1 {
        "exclusiveMaximum"
    } else {
        "maximum"
    };
    vec![
        ("type", text("number")),
        (low, Json::Literal(format!("{:?}", bounds.low))),
        (high, Json::Literal(format!("{:?}", bounds.high))),
    ]
}

/// Such a value, or a list of them.
fn one_or_several(one: Vec<(&'static str, Json)>) -> Vec<(&'static str, Json)> {
    let list = vec![
        ("type", text("array")),
        ("items", Json::Object(one.clone())),
        ("minItems", literal(1)),
    ];
    any_of(vec![Json::Object(one), Json::Object(list)])
}

/// A number, a list or a range.
fn quantity(bounds: Bounds) -> Vec<Json> {
    let list = vec![
        ("type", text("array")),
        ("items", Json::Object(real(bounds))),
        ("minItems", literal(1)),
        ("uniqueItems", literal(true)),
    ];
    vec![
        Json::Object(real(bounds)),
        Json::Object(list),
        Json::Object(table(&range(bounds))),
    ]
}

fn words(words: &[Word]) -> Vec<Json> {
    let word = |word: &Word| {
        Json::Object(vec![
            ("const", text(word.name)),
            ("description", text(word.doc)),
        ])
    };
    words.iter().map(word).collect()
}

/// A table with exactly one of these keys.
fn tagged(tags: &[Field]) -> Json {
    Json::Object(vec![
        ("type", text("object")),
        ("properties", Json::Object(tags.iter().map(field).collect())),
        ("additionalProperties", literal(false)),
        ("minProperties", literal(1)),
        ("maxProperties", literal(1)),
    ])
}

fn table(table: &TableKind) -> Vec<(&'static str, Json)> {
    let is_required = |field: &&Field| field.absent == Absent::Required;
    let always: Vec<&str> = table
        .fields
        .iter()
        .filter(is_required)
        .map(|field| field.name)
        .collect();
    let mut schema = vec![
        ("type", text("object")),
        (
            "properties",
            Json::Object(table.fields.iter().map(field).collect()),
        ),
        ("additionalProperties", literal(false)),
    ];
    if !always.is_empty() {
        schema.push(("required", texts(&always)));
    }
    if !table.rules.is_empty() {
        let rules = table
            .rules
            .iter()
            .map(|entry| Json::Object(rule(*entry)))
            .collect();
        schema.push(("allOf", Json::List(rules)));
    }
    schema
}

fn rule(rule: Rule) -> Vec<(&'static str, Json)> {
    match rule {
        Rule::ExactlyOne(keys) => {
            let one = |key: &&'static str| Json::Object(vec![required(&[key])]);
            vec![("oneOf", Json::List(keys.iter().map(one).collect()))]
        }
        Rule::GoesWith { key, others, .. } => {
            let with = |other: &&'static str| {
                let required = Json::Object(vec![(key, texts(&[other]))]);
                Json::Object(vec![("dependentRequired", required)])
            };
            any_of(others.iter().map(with).collect())
        }
        Rule::Together {
            keys: [a, b],
            unless,
        } => {
            let both = vec![(a, texts(&[b])), (b, texts(&[a]))];
            any_of(vec![
                Json::Object(condition(unless)),
                Json::Object(vec![("dependentRequired", Json::Object(both))]),
            ])
        }
        Rule::NotBoth(keys) => vec![("not", Json::Object(vec![required(&keys)]))],
        Rule::Unless {
            condition: unless,
            keys,
            ..
        } => any_of(vec![
            Json::Object(condition(unless)),
            Json::Object(vec![required(keys)]),
        ]),
    }
}

fn condition(condition: Condition) -> Vec<(&'static str, Json)> {
    let with = |key, schema: Vec<(&'static str, Json)>| {
        vec![
            (
                "properties",
                Json::Object(vec![(key, Json::Object(schema))]),
            ),
            required(&[key]),
        ]
    };
    match condition {
        Condition::Given(key) => vec![required(&[key])],
        Condition::Word(key, word) => with(key, vec![("const", text(word))]),
        Condition::Tag(key, tag) => with(key, vec![required(&[tag])]),
        Condition::Either(conditions) => {
            let each = conditions
                .iter()
                .map(|one| Json::Object(self::condition(*one)));
            any_of(each.collect())
        }
    }
}

/// The default as a value; a table's is made of its fields' own.
fn default(fallback: Fallback) -> Option<Json> {
    match fallback {
        Fallback::Number(value) => Some(Json::Literal(format!("{value:?}"))),
        Fallback::Integer(value) => Some(literal(value)),
        Fallback::Boolean(value) => Some(literal(value)),
        Fallback::Word(word) => Some(text(word)),
        Fallback::Table => None,
    }
}

/// One of these; without the wrapping if there is only one.
fn any_of(mut alternatives: Vec<Json>) -> Vec<(&'static str, Json)> {
    match alternatives.pop() {
        Some(Json::Object(only)) if alternatives.is_empty() => only,
        Some(last) => {
            alternatives.push(last);
            vec![("anyOf", Json::List(alternatives))]
        }
        None => vec![],
    }
}

fn required(keys: &[&str]) -> (&'static str, Json) {
    ("required", texts(keys))
}

fn text(text: &str) -> Json {
    Json::Text(text.to_owned())
}

fn texts(list: &[&str]) -> Json {
    Json::List(list.iter().map(|entry| text(entry)).collect())
}

fn literal(value: impl std::fmt::Display) -> Json {
    Json::Literal(value.to_string())
}

/// Longest line, without its indentation, that holds a whole list or object.
const LINE: usize = 80;

/// Writes a value: on one line if it is short, an item a line if not.
fn write(out: &mut String, json: &Json, depth: usize) {
    let mut line = String::new();
    if inline(&mut line, json) {
        out.push_str(&line);
        return;
    }
    let (open, items, close) = parts(json);
    let indent = "  ".repeat(depth);
    out.push_str(open);
    for (index, (key, item)) in items.iter().enumerate() {
        out.push_str(if index == 0 { "\n" } else { ",\n" });
        out.push_str(&indent);
        out.push_str("  ");
        name(out, *key);
        write(out, item, depth + 1);
    }
    out.push('\n');
    out.push_str(&indent);
    out.push_str(close);
}

/// Writes a value on one line; `false`, with the text cut off, if it is too long for that.
/// A text or number is never too long.
fn inline(out: &mut String, json: &Json) -> bool {
    match json {
        Json::Literal(value) => out.push_str(value),
        Json::Text(value) => string(out, value),
        Json::List(_) | Json::Object(_) => {
            let (open, items, close) = parts(json);
            out.push_str(open);
            for (index, (key, item)) in items.iter().enumerate() {
                out.push_str(if index == 0 { "" } else { ", " });
                name(out, *key);
                if !inline(out, item) || out.len() > LINE {
                    return false;
                }
            }
            out.push_str(close);
        }
    }
    true
}

/// The brackets of a list or object and what is between them.
fn parts(json: &Json) -> (&'static str, Vec<(Option<&str>, &Json)>, &'static str) {
    match json {
        Json::Literal(_) | Json::Text(_) => ("", vec![], ""),
        Json::List(items) => ("[", items.iter().map(|item| (None, item)).collect(), "]"),
        Json::Object(entries) => (
            "{",
            entries
                .iter()
                .map(|(key, item)| (Some(*key), item))
                .collect(),
            "}",
        ),
    }
}

fn name(out: &mut String, key: Option<&str>) {
    if let Some(key) = key {
        string(out, key);
        out.push_str(": ");
    }
}

fn string(out: &mut String, value: &str) {
    out.push('"');
    for c in value.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => {
                write!(out, "\\u{:04x}", u32::from(c)).expect("writing to a string cannot fail");
            }
            c => out.push(c),
        }
    }
    out.push('"');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_are_escaped() {
        let mut out = String::new();
        write(
            &mut out,
            &Json::List(vec![text("a\"\\\n"), literal(true), Json::Object(vec![])]),
            0,
        );
        assert_eq!(out, "[\"a\\\"\\\\\\u000a\", true, {}]");
    }
}
