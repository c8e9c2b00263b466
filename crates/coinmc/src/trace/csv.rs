//! Traces as CSV.

use super::{Trace, table};
use crate::results::Cell;
use crate::results::csv::{end, push};
use std::io::{self, Write};

/// Writes the table of records, with a line of column names first, in the dialect of the results.
///
/// # Errors
/// Those of `out`.
pub fn write_csv(traces: &[Trace], out: &mut dyn Write) -> io::Result<()> {
    let mut line = String::new();
    for column in table::columns() {
        push(&mut line, Cell::Text(column.name));
    }
    end(&mut line, out)?;
    for row in table::rows(traces) {
        for column in table::columns() {
            push(&mut line, column.cell(&row));
        }
        end(&mut line, out)?;
    }
    Ok(())
}
