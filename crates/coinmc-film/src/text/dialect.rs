//! Dialects of the text format.

use super::Encoding;

/// The separator between cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Delimiter {
    /// A tab: Tracker's default.
    #[default]
    Tab,
    /// A semicolon.
    Semicolon,
    /// A comma.
    Comma,
    /// One or more spaces; cells cannot be empty then.
    Blank,
}

impl Delimiter {
    /// The name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tab => "tab",
            Self::Semicolon => "semicolon",
            Self::Comma => "comma",
            Self::Blank => "blank",
        }
    }

    /// The character.
    pub(super) fn character(self) -> char {
        match self {
            Self::Tab => '\t',
            Self::Semicolon => ';',
            Self::Comma => ',',
            Self::Blank => ' ',
        }
    }

    /// The delimiter of a table, from the line with its column names: the first of tab, semicolon,
    /// comma and space that occurs.
    pub(super) fn of(header: &str) -> Option<Self> {
        let all = [Self::Tab, Self::Semicolon, Self::Comma, Self::Blank];
        let header = header.trim();
        all.into_iter().find(|d| header.contains(d.character()))
    }

    /// The cells of a line with their byte positions, without spaces around them.
    pub(super) fn cells(self, line: &str) -> Vec<(usize, &str)> {
        let mut cells = Vec::new();
        let mut start = 0;
        for piece in line.split(self.character()) {
            let text = piece.trim();
            let lead = piece.len() - piece.trim_start().len();
            if self != Self::Blank || !text.is_empty() {
                cells.push((start + if text.is_empty() { 0 } else { lead }, text));
            }
            start += piece.len() + 1;
        }
        cells
    }
}

/// The dialect of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Dialect {
    /// Separator between cells.
    pub delimiter: Delimiter,
    /// Decimal mark: `,` if true, else `.`.
    pub decimal_comma: bool,
    /// Lines end with carriage return and line feed.
    pub crlf: bool,
    /// Encoding of characters.
    pub encoding: Encoding,
}

/// Content of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Cell {
    /// Empty: the point was not marked.
    Empty,
    /// A number, and whether a degree sign follows it.
    Number(f64, bool),
    /// Not a number.
    Wrong,
    /// A number with the other decimal mark.
    OtherMark,
}

/// Parses a cell. Java writes 1.25E-3, and NaN or the replacement character for missing values.
pub(super) fn cell(text: &str, decimal_comma: bool) -> Cell {
    let text = text.trim_matches('"').trim();
    if text.is_empty() || text.eq_ignore_ascii_case("nan") || text == "\u{FFFD}" {
        return Cell::Empty;
    }
    let (digits, degrees) = match text.strip_suffix('°') {
        Some(digits) => (digits.trim_end(), true),
        None => (text, false),
    };
    let allowed = |c: char| c.is_ascii_digit() || "+-eE.,".contains(c);
    if !digits.chars().all(allowed) {
        return Cell::Wrong;
    }
    let (mark, other) = if decimal_comma {
        (',', '.')
    } else {
        ('.', ',')
    };
    if digits.contains(other) {
        // a number with several marks does not parse
        return match digits.replace(other, ".").parse::<f64>() {
            Ok(value) if value.is_finite() => Cell::OtherMark,
            _ => Cell::Wrong,
        };
    }
    match digits.replace(mark, ".").parse::<f64>() {
        Ok(value) if value.is_finite() => Cell::Number(value, degrees),
        _ => Cell::Wrong,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_numbers_or_say_why_not() {
        for (text, comma, expected) in [
            ("1.25E-3", false, Cell::Number(1.25e-3, false)),
            ("\"-2,5 °\"", true, Cell::Number(-2.5, true)),
            (" NaN ", false, Cell::Empty),
            ("\u{FFFD}", true, Cell::Empty),
            ("1,5", false, Cell::OtherMark),
            ("1.5", true, Cell::OtherMark),
            ("1,5,0", false, Cell::Wrong),
            ("1,000.5", false, Cell::Wrong),
            ("1.000,5", true, Cell::Wrong),
            ("1,0e999", false, Cell::Wrong),
            ("1e999", false, Cell::Wrong),
            ("inf", false, Cell::Wrong),
            ("0x1", false, Cell::Wrong),
        ] {
            assert_eq!(cell(text, comma), expected, "{text}");
        }
    }

    /// Bytes are counted from the beginning of the line, at the first letter of a cell.
    #[test]
    fn cells_know_where_they_stand() {
        let cells = |delimiter: Delimiter, line| delimiter.cells(line);
        assert_eq!(
            cells(Delimiter::Semicolon, "a; bé ;;d"),
            [(0, "a"), (3, "bé"), (8, ""), (9, "d")]
        );
        assert_eq!(cells(Delimiter::Blank, "  a   b "), [(2, "a"), (6, "b")]);
        assert_eq!(
            cells(Delimiter::Tab, "a\t  \tb"),
            [(0, "a"), (2, ""), (5, "b")]
        );
    }
}
