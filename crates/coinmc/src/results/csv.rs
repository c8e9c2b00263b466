//! The results table as CSV (RFC 4180, but lines end in a single line feed).

use super::schema::{Column, columns_of};
use super::{Results, Row};
use coinmc_core::csv_cell;
use coinmc_table::Cell;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Writes the table, with a line of column names first. Numbers are the shortest decimals that
/// read back to the same bits; a missing value is an empty cell.
///
/// # Errors
/// Those of `out`.
pub fn write_csv(results: &Results, out: &mut dyn Write) -> io::Result<()> {
    let mut table = CsvTable::new(results, out)?;
    let mut rows = results.rows.each();
    rows.try_for_each(|row| table.push(&row))
}

/// The table, row by row.
pub(super) struct CsvTable<'a> {
    columns: Vec<Column>,
    out: &'a mut dyn Write,
}

impl<'a> CsvTable<'a> {
    pub(super) fn new(results: &Results, out: &'a mut dyn Write) -> io::Result<Self> {
        let columns = columns_of(results);
        write_csv_row(columns.iter().map(|column| Cell::Text(&column.name)), out)?;
        Ok(Self { columns, out })
    }

    pub(super) fn push(&mut self, row: &Row) -> io::Result<()> {
        write_csv_row(self.columns.iter().map(|column| column.cell(row)), self.out)
    }
}

/// Writes a row of cells in the dialect of [`write_csv`].
///
/// # Errors
/// Those of `out`.
pub fn write_csv_row<'a>(
    cells: impl IntoIterator<Item = Cell<'a>>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut line = String::new();
    for cell in cells {
        push(&mut line, cell);
    }
    line.pop();
    line.push('\n');
    out.write_all(line.as_bytes())
}

fn push(line: &mut String, cell: Cell<'_>) {
    match cell {
        Cell::Count(count) => line.push_str(&count.to_string()),
        // Debug switches to exponents where Display would write hundreds of zeros
        Cell::Number(number) => write!(line, "{number:?}").expect("a String takes all text"),
        Cell::Flag(flag) => line.push_str(if flag { "true" } else { "false" }),
        Cell::Text(text) => line.push_str(&csv_cell(text)),
        Cell::Missing => {}
    }
    line.push(',');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_where_they_must_be() {
        let cells = [
            Cell::Text("plain"),
            Cell::Text("a \"b\", c"),
            Cell::Number(1e-300),
            Cell::Number(0.1),
            Cell::Count(u64::MAX),
            Cell::Flag(true),
            Cell::Missing,
            Cell::Count(0),
        ];
        let mut out = Vec::new();
        write_csv_row(cells, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert_eq!(
            text,
            "plain,\"a \"\"b\"\", c\",1e-300,0.1,18446744073709551615,true,,0\n"
        );
    }
}
