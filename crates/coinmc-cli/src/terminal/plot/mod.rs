//! A small plot in characters: curves with intervals, a reference curve, a horizontal level.

mod axis;
mod canvas;
mod choice;

use super::{Colors, Style};
use axis::Axis;
use canvas::Canvas;

pub(crate) use choice::Plotted;

/// Rows of the drawing area.
const ROWS: usize = 16;
/// Wider than this, a plot of this height gets no clearer.
const MAX_COLUMNS: usize = 84;
/// Columns left of the drawing area: a label, a blank and the axis.
const MARGIN: usize = 7;
/// Columns right of it, for half of the last label.
const RIGHT_MARGIN: usize = 3;
/// Most curves that can be told apart.
pub(crate) const MAX_CURVES: usize = 8;

const UNICODE_MARKS: [char; MAX_CURVES] = ['●', '○', '■', '□', '▲', '△', '◆', '◇'];
const ASCII_MARKS: [char; MAX_CURVES] = ['o', 'x', '#', '%', '@', '&', '$', 'v'];

/// A point of a curve with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mark {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) lo: f64,
    pub(crate) hi: f64,
}

/// A named sequence of points.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Curve {
    pub(crate) label: String,
    pub(crate) marks: Vec<Mark>,
}

/// A curve known at every x.
pub(crate) struct Reference<'a> {
    pub(crate) label: &'a str,
    pub(crate) y: &'a dyn Fn(f64) -> f64,
}

/// A horizontal line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Level<'a> {
    pub(crate) label: &'a str,
    pub(crate) y: f64,
}

/// What to draw.
pub(crate) struct Plot<'a> {
    pub(crate) x_label: &'a str,
    pub(crate) y_label: &'a str,
    pub(crate) curves: &'a [Curve],
    pub(crate) reference: Option<Reference<'a>>,
    pub(crate) level: Option<Level<'a>>,
}

impl Plot<'_> {
    /// The plot as lines of text, or `None` where there is nothing to draw: fewer than two
    /// different x, or no finite point.
    pub(crate) fn render(&self, style: &Style) -> Option<String> {
        let columns = (style.width - MARGIN - RIGHT_MARGIN).min(MAX_COLUMNS);
        let (x, y) = self.axes(columns)?;
        let mut canvas = Canvas::new(columns, ROWS);
        self.draw_lines(&mut canvas, &x, &y, style);
        for (n, curve) in self.shown().enumerate() {
            draw_intervals(&mut canvas, &x, &y, style, n, curve);
        }
        for (n, curve) in self.shown().enumerate() {
            for mark in &curve.marks {
                let (column, row) = (x.cell(mark.x), y.cell(mark.y));
                canvas.set(column, row, symbol(style, n), Colors::Curve(n));
            }
        }
        let mut text = format!("{}\n", style.paint(Colors::Strong, self.y_label));
        write_rows(&mut text, &canvas, &y, style);
        self.write_x_axis(&mut text, &x, style);
        self.write_legend(&mut text, style);
        Some(text)
    }

    fn shown(&self) -> impl Iterator<Item = &Curve> {
        self.curves.iter().take(MAX_CURVES)
    }

    fn axes(&self, columns: usize) -> Option<(Axis, Axis)> {
        let marks = || self.shown().flat_map(|curve| &curve.marks);
        let x = Axis::horizontal(marks().map(|mark| mark.x), columns)?;
        let level = self.level.map(|level| level.y);
        let y = Axis::vertical(marks().map(|mark| mark.y).chain(level), ROWS)?;
        Some((x, y))
    }

    fn draw_lines(&self, canvas: &mut Canvas, x: &Axis, y: &Axis, style: &Style) {
        let (dash, dot) = lines(style);
        for column in 0..canvas.columns() {
            if let Some(level) = self.level {
                canvas.set(Some(column), y.cell(level.y), dash, Colors::Faint);
            }
            if let Some(reference) = &self.reference {
                let row = y.cell((reference.y)(x.value(column)));
                canvas.set(Some(column), row, dot, Colors::Faint);
            }
        }
    }

    fn write_x_axis(&self, text: &mut String, x: &Axis, style: &Style) {
        let (corner, line, tick) = if style.unicode {
            ('└', '─', '┬')
        } else {
            ('+', '-', '+')
        };
        let ticks = x.ticks();
        let at_tick = |column| ticks.iter().any(|tick| tick.cell == column);
        let axis: String = (0..x.cells())
            .map(|c| if at_tick(c) { tick } else { line })
            .collect();
        *text += &format!("{:>6}{corner}{axis}\n", "");
        // Labels are centred under their ticks and dropped where they would touch.
        let mut labels = String::new();
        for tick in &ticks {
            let start = (MARGIN + tick.cell).saturating_sub(tick.label.len() / 2);
            let end = labels.chars().count();
            if end == 0 || start > end {
                labels += &" ".repeat(start - end);
                labels += &tick.label;
            }
        }
        *text += &format!("{labels}\n{:>2$}{}\n", "", self.x_label, MARGIN);
    }

    fn write_legend(&self, text: &mut String, style: &Style) {
        let (dash, dot) = lines(style);
        let mut entries: Vec<(char, Colors, &str)> = self
            .shown()
            .enumerate()
            .filter(|(_, curve)| !curve.label.is_empty())
            .map(|(n, curve)| (symbol(style, n), Colors::Curve(n), curve.label.as_str()))
            .collect();
        entries.extend(
            self.reference
                .as_ref()
                .map(|r| (dot, Colors::Faint, r.label)),
        );
        entries.extend(self.level.map(|level| (dash, Colors::Faint, level.label)));
        let mut used = 0;
        for (symbol, color, label) in entries {
            let length = label.chars().count() + 5;
            if used > 0 && MARGIN + used + length > style.width {
                text.push('\n');
                used = 0;
            }
            let indent = if used == 0 { MARGIN } else { 3 };
            let symbol = style.paint(color, &symbol.to_string());
            *text += &format!("{:indent$}{symbol} {label}", "");
            used += length;
        }
        if used > 0 {
            text.push('\n');
        }
        if self.curves.len() > MAX_CURVES {
            let hidden = self.curves.len() - MAX_CURVES;
            *text += &format!("{:MARGIN$}({hidden} more curves not drawn)\n", "");
        }
    }
}

fn write_rows(text: &mut String, canvas: &Canvas, y: &Axis, style: &Style) {
    let bar = if style.unicode { '│' } else { '|' };
    let tick = if style.unicode { '┤' } else { '+' };
    let ticks = y.ticks();
    for row in (0..ROWS).rev() {
        let label = ticks.iter().find(|tick| tick.cell == row);
        let edge = if label.is_some() { tick } else { bar };
        let label = label.map_or("", |tick| &tick.label);
        let drawn = canvas.row(row, style);
        *text += format!("{label:>5} {edge}{drawn}").trim_end();
        text.push('\n');
    }
}

/// Bars from `lo` to `hi` where that is more than one cell.
fn draw_intervals(canvas: &mut Canvas, x: &Axis, y: &Axis, style: &Style, n: usize, curve: &Curve) {
    let bar = if style.unicode { '│' } else { '|' };
    for mark in &curve.marks {
        let (lo, hi) = (y.clamped_cell(mark.lo), y.clamped_cell(mark.hi));
        if let (Some(lo), Some(hi)) = (lo, hi)
            && hi > lo
            && mark.hi - mark.lo > y.step()
        {
            for row in lo..=hi {
                canvas.set(x.cell(mark.x), Some(row), bar, Colors::Curve(n));
            }
        }
    }
}

fn symbol(style: &Style, n: usize) -> char {
    if style.unicode {
        UNICODE_MARKS[n]
    } else {
        ASCII_MARKS[n]
    }
}

/// The characters of the level and of the reference curve.
fn lines(style: &Style) -> (char, char) {
    if style.unicode {
        ('┄', '·')
    } else {
        ('-', '.')
    }
}

#[cfg(test)]
mod tests;
