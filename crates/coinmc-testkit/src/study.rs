//! Programs whose commands write CSV files: the studies and the benchmarks.

use std::process::{Command, Output};

/// The path of such a program.
#[derive(Debug, Clone, Copy)]
pub struct Program(pub &'static str);

/// The rows of a CSV file, without quoted cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    titles: Vec<String>,
    lines: Vec<String>,
}

impl Program {
    /// Executes a command.
    ///
    /// # Panics
    /// If the program does not start.
    pub fn execute(&self, arguments: &[&str]) -> Output {
        let output = Command::new(self.0).args(arguments).output();
        output.expect("the program starts")
    }

    /// Executes a study and returns its rows.
    ///
    /// # Panics
    /// If the study fails, prints less than 200 bytes or writes no CSV file.
    pub fn study(&self, arguments: &[&str]) -> Rows {
        let directory = tempfile::tempdir().expect("a temporary directory");
        let path = directory.path().join("study.csv");
        let csv = ["--csv", path.to_str().expect("a path in UTF-8")];
        let output = self.execute(&[&csv[..], arguments].concat());
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {errors}");
        assert!(output.stdout.len() > 200, "{arguments:?} prints nothing");
        Rows::parse(&std::fs::read_to_string(path).expect("the study writes its file"))
    }
}

impl Rows {
    fn parse(csv: &str) -> Self {
        let mut lines = csv.lines().map(str::to_owned);
        let titles = lines.next().expect("a line of titles");
        Self {
            titles: titles.split(',').map(str::to_owned).collect(),
            lines: lines.collect(),
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.lines.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// The lines below the titles.
    pub fn lines(&self) -> &[String] {
        &self.lines
    }

    /// The column with this title.
    ///
    /// # Panics
    /// If there is none.
    pub fn column(&self, title: &str) -> Vec<&str> {
        let place = self.titles.iter().position(|other| other == title);
        let place = place.unwrap_or_else(|| panic!("no {title} in {:?}", self.titles));
        let cells = self.lines.iter().map(|line| line.split(',').nth(place));
        cells
            .map(|cell| cell.expect("as many cells as titles"))
            .collect()
    }

    /// The column with this title as numbers; a cell like "3 (never_settles 3)" counts as its first
    /// word.
    ///
    /// # Panics
    /// If there is none, or a cell is not a number.
    pub fn numbers(&self, title: &str) -> Vec<f64> {
        let number = |cell: &str| cell.split(' ').next().and_then(|word| word.parse().ok());
        let cells = self.column(title).into_iter();
        cells
            .map(|cell| number(cell).unwrap_or_else(|| panic!("{title}: {cell}")))
            .collect()
    }
}
