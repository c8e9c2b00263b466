//! The table of results, column by column.

use coinmc::results::{Results, columns};
use serde_json::{Map, Value, json};

/// The columns of these results: name, unit, meaning, and the values, or `all` where they are the same.
pub(crate) fn to_json(results: &Results) -> Value {
    let mut document = results.to_json();
    let rows = match document["points"].take() {
        Value::Array(rows) => rows,
        _ => Vec::new(),
    };
    let Some(Value::Object(first)) = rows.first() else {
        return json!([]);
    };
    let names: Vec<String> = first.keys().cloned().collect();
    let about = columns(results.rows[0].parameters.iter().map(|(name, _)| &**name));
    let about = |name: &str| about.iter().find(|column| column.name == name);
    let mut values: Vec<Vec<Value>> = vec![Vec::with_capacity(rows.len()); names.len()];
    for row in rows {
        let Value::Object(mut row) = row else {
            continue;
        };
        for (name, column) in names.iter().zip(&mut values) {
            column.push(row.get_mut(name).map_or(Value::Null, Value::take));
        }
    }
    let columns = names.iter().zip(values).map(|(name, values)| {
        let mut column = Map::new();
        column.insert("name".to_owned(), json!(name));
        if let Some(about) = about(name) {
            column.insert("unit".to_owned(), json!(about.unit));
            column.insert("kind".to_owned(), json!(about.kind.name()));
            column.insert("doc".to_owned(), json!(about.doc));
        }
        if values.iter().all(|value| *value == values[0]) {
            column.insert("all".to_owned(), values[0].clone());
        } else {
            column.insert("values".to_owned(), Value::Array(values));
        }
        Value::Object(column)
    });
    columns.collect()
}
