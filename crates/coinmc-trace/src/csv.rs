//! Traces as CSV.

use crate::table;
use crate::trace::Trace;
use coinmc::results::{Cell, write_csv_row};
use std::io::{self, Write};

/// Writes the table of records, with a line of column names first, in the dialect of the results.
///
/// # Errors
/// Errors of `out`.
pub fn write_csv(traces: &[Trace], out: &mut dyn Write) -> io::Result<()> {
    let columns = table::columns();
    write_csv_row(columns.iter().map(|column| Cell::Text(column.name)), out)?;
    for row in table::rows(traces) {
        write_csv_row(columns.iter().map(|column| column.cell(&row)), out)?;
    }
    Ok(())
}
