//! The output streams: results go to standard output, everything else to standard error.

use crate::terminal::{Style, harmless, harmless_json};
use clap::{ColorChoice, ValueEnum};
use serde_json::Value;
use std::io::{self, BufWriter, StdoutLock, Write};

/// Version of every JSON document printed. It stays when fields are added, and changes when a field
/// changes its meaning or is removed.
pub(crate) const FORMAT_VERSION: u32 = 1;

/// How results are written to standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// For people
    Table,
    /// One JSON document
    Json,
}

/// How rows are written to standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum RowsFormat {
    /// For people
    Table,
    /// One JSON document
    Json,
    /// Every row as comma-separated values, numbers in full
    Csv,
}

impl RowsFormat {
    /// How failures are written: as the only document, where programs read.
    pub(crate) fn of_failures(self) -> Format {
        match self {
            Self::Json => Format::Json,
            Self::Table | Self::Csv => Format::Table,
        }
    }
}

/// How a table of results is written to standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ResultFormat {
    /// For people
    Table,
    /// One JSON document
    Json,
    /// Every column of every point, as in results.csv
    Csv,
    /// The table for people, whole, to be pasted
    Markdown,
}

impl ResultFormat {
    /// How failures are written: as the only document, where programs read.
    pub(crate) fn of_failures(self) -> Format {
        match self {
            Self::Json => Format::Json,
            Self::Table | Self::Csv | Self::Markdown => Format::Table,
        }
    }
}

/// Both streams, and how to write to them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Console {
    format: Format,
    stdout: Style,
    stderr: Style,
}

impl Console {
    /// The process's own streams.
    pub(crate) fn new(color: ColorChoice, format: Format) -> Self {
        Self {
            format,
            stdout: Style::stdout(color),
            stderr: Style::stderr(color),
        }
    }

    pub(crate) fn format(&self) -> Format {
        self.format
    }

    pub(crate) fn stdout(&self) -> &Style {
        &self.stdout
    }

    pub(crate) fn stderr(&self) -> &Style {
        &self.stderr
    }
}

/// Writes to standard output, without what a terminal would obey. A closed pipe (`| head`) is no error.
pub(crate) fn print(text: &str) -> io::Result<()> {
    print_bytes(harmless(text).as_bytes())
}

/// The same for the bytes of a table, as they are.
pub(crate) fn print_bytes(bytes: &[u8]) -> io::Result<()> {
    print_with(|stdout| stdout.write_all(bytes))
}

/// The same for what is written bit by bit.
pub(crate) fn print_with(
    write: impl FnOnce(&mut BufWriter<StdoutLock<'static>>) -> io::Result<()>,
) -> io::Result<()> {
    let mut stdout = BufWriter::new(io::stdout().lock());
    match write(&mut stdout).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(of_standard_output),
    }
}

/// An error that says what could not be written.
#[allow(clippy::needless_pass_by_value)] // for `map_err`
fn of_standard_output(error: io::Error) -> io::Error {
    let message = format!("cannot write to standard output: {error}");
    io::Error::new(error.kind(), message)
}

/// Writes a document to standard output.
pub(crate) fn print_json(document: &Value) -> io::Result<()> {
    let text = format!("{document:#}\n");
    print_bytes(harmless_json(&text).as_bytes())
}

/// Writes a line to standard error; a failure to do so cannot be reported anywhere.
pub(crate) fn note(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", harmless(text));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_that_fails_is_named_and_a_closed_one_is_none() {
        let fails = |kind: io::ErrorKind| print_with(|_| Err(kind.into()));
        let told = fails(io::ErrorKind::StorageFull).expect_err("a full disk");
        assert_eq!(told.kind(), io::ErrorKind::StorageFull);
        let told = told.to_string();
        assert!(
            told.starts_with("cannot write to standard output: "),
            "{told}"
        );
        assert!(fails(io::ErrorKind::BrokenPipe).is_ok());
    }
}
