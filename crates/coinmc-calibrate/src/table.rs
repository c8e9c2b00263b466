//! The draws of a posterior as a table.

use crate::calibration::Calibration;
use crate::model::Model;

/// A column of the table of draws.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: &'static str,
    /// Its unit; `1` for a plain number.
    pub unit: &'static str,
    /// What it holds.
    pub doc: &'static str,
    /// Its values, one a draw.
    pub values: Vec<f64>,
}

/// The columns of the table of draws: the parameters, the probabilities of the faces by the fit, and the
/// logarithms of prior and likelihood.
pub fn columns(model: &Model, calibration: &Calibration) -> Vec<Column> {
    let draws = &calibration.posterior.draws;
    let mut columns: Vec<Column> = model
        .parameters()
        .iter()
        .enumerate()
        .map(|(d, parameter)| Column {
            name: parameter.key(),
            unit: parameter.unit(),
            doc: parameter.words(),
            values: draws.iter().map(|draw| draw[d]).collect(),
        })
        .collect();
    let faces = calibration.faces(model);
    for (f, (name, doc)) in [
        ("p_heads", "probability of heads in the scene to predict"),
        ("p_tails", "probability of tails"),
        ("p_side", "probability of the side"),
    ]
    .into_iter()
    .enumerate()
    {
        columns.push(Column {
            name,
            unit: "1",
            doc,
            values: faces.iter().map(|faces| faces[f]).collect(),
        });
    }
    let of_draws = |of: &dyn Fn(&[f64]) -> f64| draws.iter().map(|draw| of(draw)).collect();
    columns.push(Column {
        name: "log_prior",
        unit: "1",
        doc: "ln of the prior density",
        values: of_draws(&|draw| model.log_prior(draw)),
    });
    columns.push(Column {
        name: "log_likelihood",
        unit: "1",
        doc: "ln of the likelihood, but for a constant",
        values: of_draws(&|draw| model.log_likelihood(draw)),
    });
    columns
}

/// The table of draws as CSV.
pub fn csv(columns: &[Column]) -> String {
    let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
    let mut text = names.join(",") + "\n";
    let rows = columns.first().map_or(0, |column| column.values.len());
    for row in 0..rows {
        let cells: Vec<String> = columns
            .iter()
            .map(|column| format!("{:?}", column.values[row]))
            .collect();
        text += &(cells.join(",") + "\n");
    }
    text
}

/// The table of draws as Parquet.
#[cfg(feature = "parquet")]
pub(crate) mod parquet {
    use super::Column;
    use arrow_array::{ArrayRef, Float64Array, RecordBatch};
    use arrow_schema::Schema;
    use coinmc::results::{Kind, arrow_field, parquet_error};
    use parquet::arrow::ArrowWriter;
    use parquet::basic::Compression;
    use parquet::file::metadata::KeyValue;
    use parquet::file::properties::WriterProperties;
    use serde_json::Value;
    use std::io::{self, Write};
    use std::sync::Arc;

    /// Writes the table of draws, with the JSON document of the calibration in its metadata. The same
    /// calibration gives the same bytes.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_parquet(
        columns: &[Column],
        document: &Value,
        out: &mut (dyn Write + Send),
    ) -> io::Result<()> {
        let fields = columns
            .iter()
            .map(|column| arrow_field(column.name, Kind::Number, column.unit, column.doc));
        let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        let entry = |key: &str, value: String| KeyValue::new(format!("coinmc.{key}"), value);
        let properties = WriterProperties::builder()
            .set_created_by(format!("coinmc {}", env!("CARGO_PKG_VERSION")))
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(vec![
                entry("posterior_format", "1".to_owned()),
                entry("program_version", env!("CARGO_PKG_VERSION").to_owned()),
                entry("calibration", document.to_string()),
            ]))
            .build();
        let arrays = columns
            .iter()
            .map(|column| Arc::new(Float64Array::from(column.values.clone())) as ArrayRef);
        let batch = RecordBatch::try_new(Arc::clone(&schema), arrays.collect());
        let mut writer =
            ArrowWriter::try_new(out, schema, Some(properties)).map_err(parquet_error)?;
        writer
            .write(&batch.map_err(io::Error::other)?)
            .map_err(parquet_error)?;
        writer.close().map(drop).map_err(parquet_error)
    }
}
