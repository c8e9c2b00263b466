//! The results as a JSON value, for programs that read standard output.

use super::Results;
use super::schema::{FORMAT, columns_of};
use coinmc_table::Cell;
use serde_json::{Map, Value, json};

impl Results {
    /// The results as JSON: `format`, `program_version`, `plan_hash`, `axes`, and `points`, a list
    /// of objects with one entry a column of the table. A missing value is `null`.
    pub fn to_json(&self) -> Value {
        let columns = columns_of(self);
        let points = self.rows.each().map(|row| {
            let cells = columns.iter().map(|column| {
                let value = match column.cell(&row) {
                    Cell::Count(count) => json!(count),
                    Cell::Number(number) => json!(number),
                    Cell::Text(text) => json!(text),
                    Cell::Flag(flag) => json!(flag),
                    Cell::Missing => Value::Null,
                };
                (column.name.clone(), value)
            });
            Value::Object(cells.collect::<Map<_, _>>())
        });
        json!({
            "format": FORMAT,
            "program_version": self.program_version,
            "plan_hash": self.plan_hash,
            "axes": self.axes,
            "points": points.collect::<Vec<_>>(),
        })
    }
}
