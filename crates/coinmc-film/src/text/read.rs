//! Parsing a file into a drop.

use super::choice::{Choice, Layout, Picked, Picker};
use super::diagnostics::{Diagnostics, Problems, quoted};
use super::dialect::{Cell, Delimiter, Dialect, cell};
use super::encoding::decoded;
use super::header::{Column, Header, header, is_idle};
use crate::drop::{FilmedDrop, Frame, MAX_FRAMES, wrapped};

/// Longest file, bytes.
pub const MAX_BYTES: usize = 16 << 20;
/// Longest line, bytes.
pub const MAX_LINE: usize = 20_000;
/// Greatest number of columns.
pub const MAX_COLUMNS: usize = 500;

/// The interpretation of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Footage {
    /// The drop.
    pub drop: FilmedDrop,
    /// The dialect of the file.
    pub dialect: Dialect,
    /// Every column of the file, in order.
    pub columns: Vec<Column>,
    /// The columns used for x, y and the angle (of two points: their x and y).
    pub used: Vec<String>,
    /// Numbers of frames in which x, z and θ are not marked.
    pub missing: [usize; 3],
}

/// Parses a file, which messages call `name`.
///
/// # Errors
/// All problems, up to a limit.
///
/// # Example
/// ```
/// use coinmc_film::text::{Choice, read};
/// let text = "mass_A\nt\tx\ty\tθ\n0,00\t0,1\t0,200\t90\n0,01\t0,1\t\t91\n";
/// let footage = read("drop.txt", text.as_bytes(), &Choice::default())?;
/// assert_eq!(footage.drop.frames[0].seen[1], Some(0.2));
/// assert_eq!(footage.missing, [0, 1, 0]);
/// # Ok::<(), coinmc_film::text::Diagnostics>(())
/// ```
pub fn read(name: &str, bytes: &[u8], choice: &Choice) -> Result<Footage, Diagnostics> {
    let refuse = |message: String, help: &str| {
        Err(Diagnostics::of_file(name, message, Some(help.to_owned())))
    };
    if bytes.len() > MAX_BYTES {
        let message = format!("a file has at most {MAX_BYTES} bytes");
        return refuse(message, "export only the frames of one drop");
    }
    let Some((text, encoding)) = decoded(bytes) else {
        let message = "this is not text in UTF-8 or Latin-1".to_owned();
        return refuse(
            message,
            "export it from Tracker as text, or save it as UTF-8",
        );
    };
    let crlf = text.contains("\r\n");
    let text = with_line_feeds(text);
    let lines: Vec<&str> = text.lines().collect();
    let mut problems = Problems::new(name, &lines);
    if let Some(long) = lines.iter().position(|line| line.len() > MAX_LINE) {
        let message = format!("a line has at most {MAX_LINE} bytes");
        problems.add(long, MAX_LINE..MAX_LINE, message, None);
        return Err(problems.finish());
    }
    let Some(header) = header(&lines) else {
        let message = "no line names columns that include a time `t`".to_owned();
        return refuse(
            message,
            "in Tracker: File > Export > Data File, all cells, with the columns t, x, y and an angle",
        );
    };
    if header.columns.len() > MAX_COLUMNS {
        let message = format!("a file has at most {MAX_COLUMNS} columns");
        problems.add(header.line, 0..0, message, None);
        return Err(problems.finish());
    }
    let mut picker = Picker {
        header: &header,
        choice,
        problems: &mut problems,
    };
    let Some((layout, time_unit)) = picker.layout() else {
        return Err(problems.finish());
    };
    let wanted = wanted(&header, &layout);
    let decimal_comma = has_decimal_comma(&lines, &header, &wanted);
    let mut rows = Rows {
        header: &header,
        choice,
        layout,
        time_unit,
        wanted: &wanted,
        decimal_comma,
        problems: &mut problems,
    };
    let frames = rows.read(&lines);
    if frames.len() < 2 && problems.is_empty() {
        let message = match frames.len() {
            0 => "there are no numbers below the column names",
            _ => "one frame is no film: below the column names there is but one line of numbers",
        };
        problems.add(header.line, 0..0, message.to_owned(), None);
    }
    if !problems.is_empty() {
        return Err(problems.finish());
    }
    let missing = [0, 1, 2].map(|c: usize| frames.iter().filter(|f| f.seen[c].is_none()).count());
    let used = wanted[1..].iter().map(|i| header.columns[*i].0.full_name());
    Ok(Footage {
        drop: FilmedDrop {
            name: name.to_owned(),
            frames,
        },
        dialect: Dialect {
            delimiter: header.delimiter,
            decimal_comma,
            crlf,
            encoding,
        },
        used: used.collect(),
        columns: header
            .columns
            .iter()
            .map(|(column, _)| column.clone())
            .collect(),
        missing,
    })
}

/// A text whose lines end with carriage returns alone, as old Macs wrote them, with line feeds instead.
fn with_line_feeds(text: String) -> String {
    if text.contains('\n') {
        return text;
    }
    text.replace('\r', "\n")
}

/// The columns to read, the time first.
fn wanted(header: &Header, layout: &Layout) -> Vec<usize> {
    let mut wanted = vec![header.time];
    match layout {
        Layout::Centre(x, y, angle) => {
            wanted.extend(x.iter().chain([y, angle]).map(|picked| picked.index));
        }
        Layout::Ends(ends) => wanted.extend(ends.iter().flatten().map(|picked| picked.index)),
    }
    wanted
}

/// Whether more of the cells to read have a comma than a point.
fn has_decimal_comma(lines: &[&str], header: &Header, wanted: &[usize]) -> bool {
    if header.delimiter == Delimiter::Comma {
        return false;
    }
    let (mut commas, mut points) = (0, 0);
    for line in lines
        .iter()
        .skip(header.line + 1)
        .filter(|line| !is_idle(line))
    {
        let cells = header.delimiter.cells(line);
        for (_, text) in wanted.iter().filter_map(|i| cells.get(*i)) {
            commas += usize::from(text.contains(','));
            points += usize::from(text.contains('.'));
        }
    }
    commas > points
}

/// Parses the lines below the header.
struct Rows<'a, 'b, 'c> {
    header: &'a Header,
    choice: &'a Choice,
    layout: Layout,
    time_unit: f64,
    wanted: &'a [usize],
    decimal_comma: bool,
    problems: &'b mut Problems<'c>,
}

impl Rows<'_, '_, '_> {
    fn read(&mut self, lines: &[&str]) -> Vec<Frame> {
        let mut frames: Vec<Frame> = Vec::new();
        for (number, line) in lines.iter().enumerate().skip(self.header.line + 1) {
            if is_idle(line) {
                continue;
            }
            if frames.len() == MAX_FRAMES {
                let message = format!("a drop has at most {MAX_FRAMES} frames");
                self.problems.add(number, 0..line.len(), message, None);
                break;
            }
            let Some(frame) = self.frame(number, line) else {
                continue;
            };
            if let Some(before) = frames.last().filter(|last| frame.time_s <= last.time_s) {
                let message = format!(
                    "times must increase from line to line, but the one before is {}",
                    before.time_s / self.time_unit
                );
                self.problems.add(number, 0..line.len(), message, None);
                continue;
            }
            frames.push(frame);
        }
        // skip the frames before the first mark and after the last
        while frames.last().is_some_and(is_blank) {
            frames.pop();
        }
        let first = frames
            .iter()
            .position(|frame| !is_blank(frame))
            .unwrap_or(0);
        frames.drain(..first);
        frames
    }

    fn frame(&mut self, number: usize, line: &str) -> Option<Frame> {
        let cells = self.header.delimiter.cells(line);
        let columns = self.header.columns.len();
        let beyond = cells
            .iter()
            .skip(columns)
            .find(|(_, text)| !text.is_empty());
        if let Some((start, text)) = beyond {
            let message = format!(
                "this line has {} cells, but {columns} columns are named",
                cells.len()
            );
            let help = (self.header.delimiter == Delimiter::Comma).then(|| {
                "commas between cells and within numbers cannot be distinguished: export with \
                 semicolons or tabs"
                    .to_owned()
            });
            self.problems
                .add(number, *start..start + text.len(), message, help);
            return None;
        }
        if self.header.delimiter == Delimiter::Blank && cells.len() < columns {
            let message = format!(
                "this line has {} cells, but {columns} columns are named",
                cells.len()
            );
            let help = "spaces do not show which point was not marked: export with tabs".to_owned();
            self.problems
                .add(number, 0..line.len(), message, Some(help));
            return None;
        }
        self.numbers(number, line, &cells)
    }

    fn numbers(&mut self, number: usize, line: &str, cells: &[(usize, &str)]) -> Option<Frame> {
        let mut values = vec![None; self.header.columns.len()];
        let mut right = true;
        for &index in self.wanted {
            let (start, text) = cells.get(index).copied().unwrap_or((line.len(), ""));
            match cell(text, self.decimal_comma) {
                Cell::Empty => {}
                Cell::Number(value, _) => values[index] = Some(value),
                wrong => {
                    right = false;
                    let (message, help) = self.wrong(wrong, text);
                    self.problems
                        .add(number, start..start + text.len(), message, help);
                }
            }
        }
        if !right {
            return None;
        }
        let Some(time) = values[self.header.time] else {
            let (start, _) = cells.get(self.header.time).copied().unwrap_or((0, ""));
            let message = "the time is missing".to_owned();
            self.problems.add(number, start..start, message, None);
            return None;
        };
        let of = |picked: &Picked| Some(values[picked.index]? * picked.unit);
        let angle_of = self.choice.angle_of;
        let seen = match &self.layout {
            Layout::Centre(x, y, angle) => [
                x.as_ref().and_then(of),
                of(y),
                of(angle).map(|angle| wrapped(angle_of.theta(angle))),
            ],
            Layout::Ends([[ax, ay], [bx, by]]) => {
                let between = |a: &Picked, b: &Picked| Some((of(a)?, of(b)?));
                let (x, y) = (between(ax, bx), between(ay, by));
                let angle = x.zip(y).map(|(x, y)| libm::atan2(y.1 - y.0, x.1 - x.0));
                [
                    x.map(|(a, b)| f64::midpoint(a, b)),
                    y.map(|(a, b)| f64::midpoint(a, b)),
                    angle.map(|angle| wrapped(angle_of.theta(angle))),
                ]
            }
        };
        let time_s = time * self.time_unit;
        let finite = time_s.is_finite() && seen.iter().flatten().all(|value| value.is_finite());
        if !finite {
            let message = "these numbers are far out of range".to_owned();
            self.problems.add(number, 0..line.len(), message, None);
            return None;
        }
        Some(Frame { time_s, seen })
    }

    fn wrong(&self, cell: Cell, text: &str) -> (String, Option<String>) {
        if cell == Cell::OtherMark {
            let (here, there) = if self.decimal_comma {
                ("point", "comma")
            } else {
                ("comma", "point")
            };
            let message = format!(
                "a decimal {here} in {}, but this file uses the decimal {there}",
                quoted(text)
            );
            return (
                message,
                Some(format!("write the decimal {there} throughout")),
            );
        }
        let message = format!("{} is not a number", quoted(text));
        let help = "leave the cell empty if the point was not marked".to_owned();
        (message, Some(help))
    }
}

fn is_blank(frame: &Frame) -> bool {
    frame.seen.iter().all(Option::is_none)
}
