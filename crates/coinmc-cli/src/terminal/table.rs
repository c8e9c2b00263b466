//! A table that fits its terminal.

use super::{Colors, Style, count, wrapped};

/// Blanks between two columns.
const GAP: usize = 2;

/// Alignment of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Align {
    Left,
    Right,
}

/// A column: its title, alignment and rank.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Column {
    title: String,
    align: Align,
    /// Columns of the lowest rank are left out first when space is short; rank 0 always stays.
    droppable: u8,
}

impl Column {
    /// Text.
    pub(crate) fn left(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            align: Align::Left,
            droppable: 0,
        }
    }

    /// Numbers.
    pub(crate) fn right(title: impl Into<String>) -> Self {
        Self {
            align: Align::Right,
            ..Self::left(title)
        }
    }

    /// May be left out where space is short; larger ranks first.
    pub(crate) fn droppable(self, rank: u8) -> Self {
        Self {
            droppable: rank,
            ..self
        }
    }
}

/// Rows of text under columns.
#[derive(Debug, Clone, Default)]
pub(crate) struct Table {
    columns: Vec<Column>,
    lines: Vec<Line>,
}

#[derive(Debug, Clone)]
enum Line {
    Cells(Vec<String>),
    /// Text in place of omitted rows.
    Note(String),
}

/// A table as text, with a line that names the columns that did not fit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Rendered {
    pub(crate) text: String,
}

impl Table {
    /// An empty table.
    pub(crate) fn new(columns: Vec<Column>) -> Self {
        Self {
            columns,
            lines: Vec::new(),
        }
    }

    /// Adds a row of as many cells as there are columns.
    pub(crate) fn push(&mut self, cells: Vec<String>) {
        assert_eq!(cells.len(), self.columns.len());
        self.lines.push(Line::Cells(cells));
    }

    /// Marks that `rows` rows are omitted here.
    pub(crate) fn push_gap(&mut self, rows: u64) {
        self.push_note(&count(rows, "more row"));
    }

    /// Adds text in place of omitted rows.
    pub(crate) fn push_note(&mut self, what: &str) {
        self.lines.push(Line::Note(what.to_owned()));
    }

    /// Lays the table out within the style's width.
    pub(crate) fn render(&self, style: &Style) -> Rendered {
        let width = if style.whole { usize::MAX } else { style.width };
        let (kept, left_out) = self.fit(width);
        let widths: Vec<usize> = kept.iter().map(|&column| self.width(column)).collect();
        let titles: Vec<&str> = self.columns.iter().map(|c| c.title.as_str()).collect();
        let mut text = style.paint(Colors::Strong, &self.line(&kept, &widths, &titles));
        text.push('\n');
        for line in &self.lines {
            text += &match line {
                Line::Cells(cells) => self.line(&kept, &widths, cells),
                Line::Note(what) => {
                    let note = format!("{0} {what} {0}", style.ellipsis());
                    style.paint(Colors::Faint, &note)
                }
            };
            text.push('\n');
        }
        if !left_out.is_empty() {
            let names: Vec<String> = left_out.into_iter().map(|c| self.left_out(c)).collect();
            let note = format!("Too narrow to show: {}", names.join(", "));
            let note = wrapped(&note, style.width, 4);
            text += &format!("{}\n", style.paint(Colors::Faint, note.trim_end()));
        }
        Rendered { text }
    }

    /// The title of a column that does not fit, and what it says if that is the same in every row.
    fn left_out(&self, column: usize) -> String {
        let title = &self.columns[column].title;
        match self.constant(column) {
            Some(value) => format!("{title} ({value} in every row)"),
            None => title.clone(),
        }
    }

    /// The table in the Markdown of most sites, whole.
    pub(crate) fn markdown(&self) -> String {
        let escaped = |cell: &str| cell.replace('|', "\\|");
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut text = line(self.columns.iter().map(|c| escaped(&c.title)).collect());
        text += &line(
            self.columns
                .iter()
                .map(|column| match column.align {
                    Align::Left => "---".to_owned(),
                    Align::Right => "---:".to_owned(),
                })
                .collect(),
        );
        for cells in self.rows() {
            text += &line(cells.iter().map(|cell| escaped(cell)).collect());
        }
        text
    }

    fn rows(&self) -> impl Iterator<Item = &[String]> {
        self.lines.iter().filter_map(|line| match line {
            Line::Cells(cells) => Some(cells.as_slice()),
            Line::Note(_) => None,
        })
    }

    /// What all of several rows say in a column.
    fn constant(&self, column: usize) -> Option<&str> {
        let mut rows = self.rows();
        let first = rows.next()?[column].as_str();
        let mut others = rows.map(|cells| cells[column].as_str()).peekable();
        (others.peek().is_some() && others.all(|cell| cell == first)).then_some(first)
    }

    /// The columns that fit, in order, and those that do not. What is the same in every row goes
    /// first: a line says it as well.
    fn fit(&self, width: usize) -> (Vec<usize>, Vec<usize>) {
        let mut kept: Vec<usize> = (0..self.columns.len()).collect();
        let mut left_out = Vec::new();
        let needed = |kept: &[usize]| {
            kept.iter()
                .map(|&c| self.width(c) + GAP)
                .sum::<usize>()
                .saturating_sub(GAP)
        };
        while needed(&kept) > width {
            let rank = |&column: &usize| self.columns[column].droppable;
            let folds = |&column: &usize| self.constant(column).is_some();
            let Some(place) = (0..kept.len())
                .filter(|&place| rank(&kept[place]) > 0)
                .max_by_key(|&place| (folds(&kept[place]), rank(&kept[place]), place))
            else {
                break;
            };
            left_out.push(kept.remove(place));
        }
        left_out.sort_unstable();
        (kept, left_out)
    }

    fn width(&self, column: usize) -> usize {
        let cells = self.rows().map(|cells| cells[column].chars().count());
        cells
            .max()
            .unwrap_or(0)
            .max(self.columns[column].title.chars().count())
    }

    fn line(&self, kept: &[usize], widths: &[usize], cells: &[impl AsRef<str>]) -> String {
        let mut line = String::new();
        for (i, (&column, &width)) in kept.iter().zip(widths).enumerate() {
            if i > 0 {
                line.push_str(&" ".repeat(GAP));
            }
            let cell = cells[column].as_ref();
            match self.columns[column].align {
                Align::Left => line += &format!("{cell:<width$}"),
                Align::Right => line += &format!("{cell:>width$}"),
            }
        }
        line.truncate(line.trim_end().len());
        line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(rows: usize) -> Table {
        let mut table = Table::new(vec![
            Column::right("ratio"),
            Column::right("P(side)"),
            Column::right("tosses").droppable(1),
            Column::left("why").droppable(2),
        ]);
        for i in 0..rows {
            table.push(vec![
                format!("{}.5", i),
                "0.3333 ± 0.0010".to_owned(),
                format!("{} 000 000", i + 1),
                if i == 1 {
                    "a long reason why not".to_owned()
                } else {
                    String::new()
                },
            ]);
        }
        table
    }

    #[test]
    fn columns_line_up_and_lines_do_not_end_in_blanks() {
        let rendered = sample(3).render(&Style::plain(80));
        assert_eq!(
            rendered.text,
            "\
ratio          P(side)     tosses  why
  0.5  0.3333 ± 0.0010  1 000 000
  1.5  0.3333 ± 0.0010  2 000 000  a long reason why not
  2.5  0.3333 ± 0.0010  3 000 000
"
        );
    }

    /// What a table says that it does not show, at a width.
    fn left_out(table: &Table, width: usize) -> Option<String> {
        let text = table
            .render(&Style::plain(width))
            .text
            .replace("\n    ", " ");
        let (_, note) = text.split_once("Too narrow to show: ")?;
        Some(note.trim_end().to_owned())
    }

    #[test]
    fn the_least_important_columns_go_first() {
        let table = sample(2);
        assert_eq!(left_out(&table, 80), None);
        assert_eq!(left_out(&table, 40).as_deref(), Some("why"));
        let text = table.render(&Style::plain(40)).text;
        assert!(text.lines().all(|line| line.chars().count() <= 40));
        assert_eq!(left_out(&table, 30).as_deref(), Some("tosses, why"));
        // rank 0 stays even where it does not fit
        assert_eq!(left_out(&table, 5).as_deref(), Some("tosses, why"));
    }

    #[test]
    fn what_is_the_same_everywhere_goes_before_what_is_not() {
        let mut table = Table::new(vec![
            Column::right("ratio"),
            Column::right("P(heads)").droppable(2),
            Column::right("undecided").droppable(1),
        ]);
        for (ratio, heads) in [("1", "0.4 ± 0.1"), ("2", "0.3 ± 0.1")] {
            table.push([ratio, heads, "0"].map(str::to_owned).to_vec());
        }
        let noted = left_out(&table, 20);
        assert_eq!(noted.as_deref(), Some("undecided (0 in every row)"));
        let text = table.render(&Style::plain(20)).text;
        assert!(text.contains("0.3 ± 0.1"), "{text}");
        // nothing is left out where programs read
        let whole = Style {
            whole: true,
            ..Style::plain(20)
        };
        assert!(!table.render(&whole).text.contains("Too narrow"));
        assert_eq!(
            table.markdown(),
            "| ratio | P(heads) | undecided |\n| ---: | ---: | ---: |\n\
             | 1 | 0.4 ± 0.1 | 0 |\n| 2 | 0.3 ± 0.1 | 0 |\n"
        );
    }

    #[test]
    fn a_gap_says_how_much_is_missing() {
        let mut table = sample(1);
        table.push_gap(12_345);
        let text = table.render(&Style::ascii(80)).text;
        assert!(text.ends_with("\n... 12 345 more rows ...\n"), "{text}");
    }

    #[test]
    fn no_rows_leave_the_head() {
        assert_eq!(
            sample(0).render(&Style::plain(80)).text,
            "ratio  P(side)  tosses  why\n"
        );
    }
}
