//! Both tables of a run, written together: a row is computed once, and not kept.

use super::Results;
use super::csv::CsvTable;
use super::parquet::ResultsParquet;
use std::io::{self, Write};

/// Which of the tables failed.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Table {
    Parquet,
    Csv,
}

/// Writes the table as Parquet and as CSV.
///
/// # Errors
/// The table that could not be written, and why.
pub(crate) fn write_tables(
    results: &Results,
    parquet: &mut (dyn Write + Send),
    csv: &mut dyn Write,
) -> Result<(), (Table, io::Error)> {
    let of_parquet = |error| (Table::Parquet, error);
    let of_csv = |error| (Table::Csv, error);
    let mut parquet = ResultsParquet::new(results, parquet).map_err(of_parquet)?;
    let mut csv = CsvTable::new(results, csv).map_err(of_csv)?;
    for row in results.rows.each() {
        csv.push(&row).map_err(of_csv)?;
        parquet.push(row.into_owned()).map_err(of_parquet)?;
    }
    parquet.finish().map_err(of_parquet)
}
