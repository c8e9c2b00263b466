//! A grid of characters, each with its colour.

use crate::terminal::{Colors, Style};

/// Characters in rows, row 0 at the bottom.
#[derive(Debug, Clone)]
pub(super) struct Canvas {
    columns: usize,
    cells: Vec<Option<(char, Colors)>>,
}

impl Canvas {
    /// An empty canvas.
    pub(super) fn new(columns: usize, rows: usize) -> Self {
        Self {
            columns,
            cells: vec![None; columns * rows],
        }
    }

    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    /// Draws a character over what is there; `None` lies outside and is not drawn.
    pub(super) fn set(
        &mut self,
        column: Option<usize>,
        row: Option<usize>,
        symbol: char,
        color: Colors,
    ) {
        if let (Some(column), Some(row)) = (column, row) {
            self.cells[row * self.columns + column] = Some((symbol, color));
        }
    }

    /// A row as text, runs of one colour painted at once, without blanks at the end.
    pub(super) fn row(&self, row: usize, style: &Style) -> String {
        let cells = &self.cells[row * self.columns..(row + 1) * self.columns];
        let end = cells
            .iter()
            .rposition(Option::is_some)
            .map_or(0, |last| last + 1);
        cells[..end]
            .chunk_by(|a, b| a.map(|(_, color)| color) == b.map(|(_, color)| color))
            .map(|run| {
                let text: String = run
                    .iter()
                    .map(|cell| cell.map_or(' ', |(c, _)| c))
                    .collect();
                run[0].map_or(text.clone(), |(_, color)| style.paint(color, &text))
            })
            .collect()
    }
}
