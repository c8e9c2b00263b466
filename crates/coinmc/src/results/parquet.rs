//! The results table as Parquet, with units and the config in its metadata.

use super::schema::{Column, columns_of, metadata};
use super::{Results, Row};
use coinmc_table::{About, ParquetTable};
use std::io::{self, Write};

/// Rows of a row group, which is the part held in memory.
const GROUP: usize = 1 << 14;

/// Writes the table. The same results give the same bytes: no time, host or path is in them.
///
/// # Errors
/// Those of `out`.
pub fn write_parquet(results: &Results, out: &mut (dyn Write + Send)) -> io::Result<()> {
    let mut table = ResultsParquet::new(results, out)?;
    for row in results.rows.each() {
        table.push(row.into_owned())?;
    }
    table.finish()
}

/// The table, row by row.
pub(super) struct ResultsParquet<'a> {
    table: ParquetTable<'a>,
    columns: Vec<Column>,
    group: Vec<Row>,
}

impl<'a> ResultsParquet<'a> {
    pub(super) fn new(results: &Results, out: &'a mut (dyn Write + Send)) -> io::Result<Self> {
        let columns = columns_of(results);
        let about = About::coinmc(&results.program_version)
            .with_entries(metadata(results))
            .with_entries_in_schema();
        let fields = columns.iter().map(Column::field).collect();
        Ok(Self {
            table: ParquetTable::new(fields, about, out)?,
            columns,
            group: Vec::new(),
        })
    }

    pub(super) fn push(&mut self, row: Row) -> io::Result<()> {
        self.group.push(row);
        if self.group.len() == GROUP {
            self.write_group()?;
        }
        Ok(())
    }

    fn write_group(&mut self) -> io::Result<()> {
        let cell = |row, column: usize| self.columns[column].cell(row);
        self.table.write_group(&self.group.iter(), cell)?;
        self.group.clear();
        Ok(())
    }

    pub(super) fn finish(mut self) -> io::Result<()> {
        if !self.group.is_empty() {
            self.write_group()?;
        }
        self.table.finish()
    }
}
