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
    use coinmc_table::{About, Cell, Field, Kind, ParquetTable};
    use serde_json::Value;
    use std::io::{self, Write};

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
            .map(|column| Field::new(column.name, Kind::Number, column.unit, column.doc));
        let version = env!("CARGO_PKG_VERSION");
        let about = About::coinmc(version).with_entries([
            ("coinmc.posterior_format", "1".to_owned()),
            ("coinmc.program_version", version.to_owned()),
            ("coinmc.calibration", document.to_string()),
        ]);
        let mut table = ParquetTable::new(fields.collect(), about, out)?;
        let rows = columns.first().map_or(0, |column| column.values.len());
        table.write_group(&(0..rows), |row, column| {
            Cell::Number(columns[column].values[row])
        })?;
        table.finish()
    }
}
