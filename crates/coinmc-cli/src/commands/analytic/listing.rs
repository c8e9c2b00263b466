//! Rows under named columns, written as a table, JSON or CSV.

use crate::output::FORMAT_VERSION;
use crate::terminal::table::{Column, Table};
use crate::terminal::{Style, compact, in_ascii};
use coinmc_questions::csv_of_value;
use serde_json::{Map, Value, json};

/// Significant digits of numbers in tables.
const DIGITS: usize = 6;

/// A column: its name in JSON and CSV, and how it heads a table.
#[derive(Debug, Clone)]
pub(super) struct Field {
    name: &'static str,
    column: Column,
    /// Numbers stand as the user gave them.
    given: bool,
}

impl Field {
    /// A column of text.
    pub(super) fn text(name: &'static str, title: &str) -> Self {
        Self {
            name,
            column: Column::left(title),
            given: false,
        }
    }

    /// A column of numbers.
    pub(super) fn number(name: &'static str, title: &str) -> Self {
        Self {
            column: Column::right(title),
            ..Self::text(name, title)
        }
    }

    /// A column of numbers that the user gave.
    pub(super) fn given(name: &'static str, title: &str) -> Self {
        Self {
            given: true,
            ..Self::number(name, title)
        }
    }

    /// A column that a narrow table leaves out, those with the larger `rank` first.
    pub(super) fn droppable(self, rank: u8) -> Self {
        Self {
            column: self.column.droppable(rank),
            ..self
        }
    }
}

/// What `analytic` prints.
#[derive(Debug, Clone)]
pub(super) struct Listing {
    kind: &'static str,
    fields: Vec<Field>,
    rows: Vec<Vec<Value>>,
    /// A line under the table.
    note: &'static str,
}

impl Listing {
    /// A listing without rows. `kind` names it in JSON.
    pub(super) fn new(kind: &'static str, fields: Vec<Field>, note: &'static str) -> Self {
        Self {
            kind,
            fields,
            rows: Vec::new(),
            note,
        }
    }

    /// Adds a row; a number that does not exist (NaN) becomes null.
    pub(super) fn push(&mut self, cells: Vec<Value>) {
        assert_eq!(cells.len(), self.fields.len());
        self.rows.push(cells);
    }

    /// For people.
    pub(super) fn to_table(&self, style: &Style) -> String {
        let mut table = Table::new(
            self.fields
                .iter()
                .map(|field| field.column.clone())
                .collect(),
        );
        for row in &self.rows {
            table.push(
                row.iter()
                    .zip(&self.fields)
                    .map(|(cell, field)| shown(cell, field))
                    .collect(),
            );
        }
        let mut text = table.render(style).text;
        if !self.note.is_empty() {
            text += &format!("\n{}\n", self.note);
        }
        if style.unicode { text } else { in_ascii(&text) }
    }

    /// One JSON document: `{format_version, kind, rows: [{name: value}]}`.
    pub(super) fn to_json(&self) -> Value {
        let rows: Vec<Value> = self
            .rows
            .iter()
            .map(|row| {
                let names = self.fields.iter().map(|field| field.name.to_owned());
                Value::Object(names.zip(row.iter().cloned()).collect::<Map<_, _>>())
            })
            .collect();
        json!({ "format_version": FORMAT_VERSION, "kind": self.kind, "rows": rows })
    }

    /// RFC 4180, lines ended by a line feed.
    pub(super) fn to_csv(&self) -> String {
        let names = self
            .fields
            .iter()
            .map(|field| field.name.to_owned())
            .collect::<Vec<_>>();
        let rows = self
            .rows
            .iter()
            .map(|row| row.iter().map(csv_of_value).collect::<Vec<_>>());
        std::iter::once(names)
            .chain(rows)
            .map(|cells| cells.join(",") + "\n")
            .collect()
    }
}

fn shown(cell: &Value, field: &Field) -> String {
    match (cell, cell.as_f64()) {
        (Value::Null, _) => "none".to_owned(),
        (Value::String(text), _) => text.clone(),
        (_, Some(x)) if field.given => compact(x),
        (_, Some(x)) => significant(x),
        (other, None) => other.to_string(),
    }
}

/// Six significant digits, zeros at the end included so that a column lines up.
fn significant(x: f64) -> String {
    let magnitude = x.abs();
    if magnitude != 0.0 && !(1e-4..1e6).contains(&magnitude) {
        return format!("{x:.*e}", DIGITS - 1);
    }
    if magnitude < 10.0 {
        return format!("{x:.*}", DIGITS - 1);
    }
    // 10 <= magnitude < 1e6: 1 to 5 digits more before the point
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let before = libm::floor(libm::log10(magnitude)) as usize;
    format!("{x:.*}", DIGITS - 1 - before)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Listing {
        let fields = vec![Field::text("rule", "rule"), Field::number("ratio", "H/R")];
        let mut listing = Listing::new("sample", fields, "");
        listing.push(vec!["a, \"b\"".into(), (1.0 / 3.0).into()]);
        listing.push(vec!["c".into(), f64::NAN.into()]);
        listing
    }

    #[test]
    fn csv_quotes_what_needs_it_and_keeps_all_digits() {
        assert_eq!(
            sample().to_csv(),
            "rule,ratio\n\"a, \"\"b\"\"\",0.3333333333333333\nc,\n"
        );
    }

    #[test]
    fn json_has_null_for_what_does_not_exist() {
        let document = sample().to_json();
        assert_eq!(document["kind"], "sample");
        assert_eq!(document["rows"][1]["ratio"], Value::Null);
        assert_eq!(document["rows"][0]["ratio"], 1.0 / 3.0);
    }

    #[test]
    fn tables_show_six_digits() {
        let text = sample().to_table(&Style::plain(80));
        assert_eq!(
            text,
            "rule        H/R\na, \"b\"  0.33333\nc          none\n"
        );
        assert_eq!(significant(238.6), "238.600");
        assert_eq!(significant(0.0), "0.00000");
        assert_eq!(significant(1e-7), "1.00000e-7");
    }
}
