//! Results of a study: tables to read, and every row for a file.

use coinmc_core::csv_cell;
use std::fmt;
use std::io::{self, BufWriter, Write};

/// Rows of text under columns.
#[derive(Debug, Clone)]
pub struct Table {
    title: String,
    columns: Vec<&'static str>,
    rows: Vec<Vec<String>>,
}

/// The outcome of a study.
#[derive(Debug, Clone)]
pub struct Report {
    /// Every row; what `--csv` writes.
    record: Table,
    /// What is printed instead of the record, where that is too long to read.
    shown: Vec<Table>,
    /// Conclusions, a sentence each.
    remarks: Vec<String>,
}

impl Table {
    /// An empty table.
    pub fn new(title: impl Into<String>, columns: &[&'static str]) -> Self {
        Self {
            title: title.into(),
            columns: columns.to_vec(),
            rows: Vec::new(),
        }
    }

    /// Adds a row.
    ///
    /// # Panics
    /// If there are not as many cells as columns.
    pub fn push(&mut self, cells: Vec<String>) {
        assert_eq!(cells.len(), self.columns.len());
        self.rows.push(cells);
    }

    /// The rows with these indices, in that order, under another title.
    ///
    /// # Panics
    /// If a row does not exist.
    pub fn select(&self, title: &str, rows: impl IntoIterator<Item = usize>) -> Self {
        Self {
            title: title.to_owned(),
            columns: self.columns.clone(),
            rows: rows.into_iter().map(|i| self.rows[i].clone()).collect(),
        }
    }

    fn widths(&self) -> Vec<usize> {
        let width = |text: &str| text.chars().count();
        let mut widths: Vec<usize> = self.columns.iter().map(|title| width(title)).collect();
        for row in &self.rows {
            for (widest, cell) in widths.iter_mut().zip(row) {
                *widest = width(cell).max(*widest);
            }
        }
        widths
    }
}

impl Report {
    /// A report that shows its record.
    pub fn new(record: Table) -> Self {
        Self {
            record,
            shown: Vec::new(),
            remarks: Vec::new(),
        }
    }

    /// Prints this table instead of the record.
    pub fn show(&mut self, table: Table) {
        self.shown.push(table);
    }

    /// Adds a sentence.
    pub fn remark(&mut self, text: impl Into<String>) {
        self.remarks.push(text.into());
    }

    /// Writes every row of the record as CSV (RFC 4180).
    ///
    /// # Errors
    /// If `out` cannot be written to.
    pub fn write_csv(&self, out: impl Write) -> io::Result<()> {
        let mut out = BufWriter::new(out);
        let line = |cells: &mut dyn Iterator<Item = &str>| {
            let cells: Vec<_> = cells.map(csv_cell).collect();
            cells.join(",") + "\n"
        };
        out.write_all(line(&mut self.record.columns.iter().copied()).as_bytes())?;
        for row in &self.record.rows {
            out.write_all(line(&mut row.iter().map(String::as_str)).as_bytes())?;
        }
        out.flush()
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title)?;
        let widths = self.widths();
        let line = |cells: &mut dyn Iterator<Item = &str>| {
            let padded = cells.zip(&widths).map(|(cell, &width)| {
                // numbers to the right, as their first character shows
                let number = cell.starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c));
                if number {
                    format!("{cell:>width$}")
                } else {
                    format!("{cell:<width$}")
                }
            });
            padded.collect::<Vec<_>>().join("  ").trim_end().to_owned()
        };
        writeln!(f, "{}", line(&mut self.columns.iter().copied()))?;
        for row in &self.rows {
            writeln!(f, "{}", line(&mut row.iter().map(String::as_str)))?;
        }
        Ok(())
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown = if self.shown.is_empty() {
            std::slice::from_ref(&self.record)
        } else {
            &self.shown
        };
        for table in shown {
            writeln!(f, "{table}")?;
        }
        for remark in &self.remarks {
            writeln!(f, "{remark}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let mut table = Table::new("A table", &["name", "value"]);
        table.push(vec!["a, \"b\"".to_owned(), "1.5".to_owned()]);
        table.push(vec!["c".to_owned(), "-10.25".to_owned()]);
        table
    }

    #[test]
    fn numbers_line_up_on_the_right_and_words_on_the_left() {
        let text = "A table\nname    value\na, \"b\"     1.5\nc       -10.25\n";
        assert_eq!(table().to_string(), text);
    }

    #[test]
    fn csv_holds_the_whole_record_and_quotes_what_needs_it() {
        let mut report = Report::new(table());
        report.show(table().select("Second", [1]));
        let mut csv = Vec::new();
        report.write_csv(&mut csv).unwrap();
        let text = String::from_utf8(csv).unwrap();
        assert_eq!(text, "name,value\n\"a, \"\"b\"\"\",1.5\nc,-10.25\n");
        assert!(report.to_string().starts_with("Second\n") && !report.to_string().contains("1.5"));
    }
}
