//! The rows of an answer as CSV.

use coinmc_core::csv_cell;
use serde_json::Value;

/// The `rows` of a [document](crate::document_of_ranking) as CSV (RFC 4180), one line for each. A number
/// with its interval is three columns, `x`, `x_lo` and `x_hi`; what is not known is empty.
///
/// # Example
/// ```
/// use serde_json::json;
/// let rows = json!({ "rows": [
///     { "parameter": "coin.ratio", "total": { "value": 0.5, "lo": 0.25, "hi": 0.75 } },
///     { "parameter": "surface.friction", "total": null },
/// ] });
/// let csv = coinmc_questions::csv_of_rows(&rows);
/// assert_eq!(csv, "parameter,total,total_lo,total_hi\ncoin.ratio,0.5,0.25,0.75\nsurface.friction,,,\n");
/// ```
pub fn csv_of_rows(document: &Value) -> String {
    let rows = document["rows"].as_array().map_or(&[][..], Vec::as_slice);
    let Some(first) = rows.first().and_then(Value::as_object) else {
        return String::new();
    };
    let has_interval = |key: &str| rows.iter().any(|row| row[key].is_object());
    let mut columns: Vec<(String, String)> = vec![];
    for key in first.keys() {
        if has_interval(key) {
            for (end, suffix) in [("value", ""), ("lo", "_lo"), ("hi", "_hi")] {
                columns.push((format!("/{key}/{end}"), format!("{key}{suffix}")));
            }
        } else {
            columns.push((format!("/{key}"), key.clone()));
        }
    }
    let header = columns.iter().map(|(_, name)| name.clone());
    let mut csv = header.collect::<Vec<_>>().join(",") + "\n";
    for row in rows {
        let cells = columns
            .iter()
            .map(|(place, _)| row.pointer(place).map_or_else(String::new, csv_of_value));
        csv += &(cells.collect::<Vec<_>>().join(",") + "\n");
    }
    csv
}

/// A number, text or null of a document as a cell of a CSV file (RFC 4180); null is empty.
///
/// # Example
/// ```
/// use coinmc_questions::csv_of_value;
/// let values = [serde_json::json!("a, b"), serde_json::json!(0.5), serde_json::Value::Null];
/// assert_eq!(values.map(|value| csv_of_value(&value)), ["\"a, b\"", "0.5", ""]);
/// ```
pub fn csv_of_value(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => csv_cell(text).into_owned(),
        other => other.to_string(),
    }
}
