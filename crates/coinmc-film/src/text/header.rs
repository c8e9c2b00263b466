//! The header above the numbers: tracks, columns and units.

use super::dialect::Delimiter;

/// A column: track, name and unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Its track (in Tracker a point mass, protractor, …); empty if none is named.
    pub track: String,
    /// The name without the unit.
    pub name: String,
    /// The unit in brackets after the name.
    pub unit: Option<String>,
}

impl Column {
    /// `track.name`, or only the name if there is no track.
    pub fn full_name(&self) -> String {
        if self.track.is_empty() {
            self.name.clone()
        } else {
            format!("{}.{}", self.track, self.name)
        }
    }

    pub(super) fn is_time(&self) -> bool {
        ["t", "time", "zeit", "tiempo", "temps", "tempo"]
            .contains(&self.name.to_lowercase().as_str())
    }

    /// Whether the name is that of a body's angle. θ_{r} is not: it is Tracker's name for the
    /// direction of the position.
    pub(super) fn is_angle(&self) -> bool {
        [
            "θ", "theta", "\\theta", "angle", "rotation", "φ", "phi", "winkel",
        ]
        .contains(&self.name.to_lowercase().as_str())
    }

    pub(super) fn is_named(&self, name: &str) -> bool {
        self.name.eq_ignore_ascii_case(name)
    }
}

/// The header of a table.
#[derive(Debug, Clone)]
pub(super) struct Header {
    pub(super) delimiter: Delimiter,
    /// Index of the line with the names of the columns.
    pub(super) line: usize,
    /// Columns with the byte positions of their names in that line.
    pub(super) columns: Vec<(Column, std::ops::Range<usize>)>,
    /// Index of the time column.
    pub(super) time: usize,
}

/// Whether a line is blank or a comment. Tracker's `#multi:` begins like a comment.
pub(super) fn is_idle(line: &str) -> bool {
    let line = line.trim();
    line.is_empty() || line.starts_with('#')
}

/// Finds the header: the first line with a time column. Lines before it name tracks.
pub(super) fn header(lines: &[&str]) -> Option<Header> {
    /// Only this many lines are searched for the header.
    const SEARCHED: usize = 50;
    let mut before: Option<&str> = None;
    for (number, line) in lines.iter().enumerate().take(SEARCHED) {
        if is_idle(line) {
            continue;
        }
        if let Some(delimiter) = Delimiter::of(line) {
            let columns: Vec<_> = delimiter
                .cells(line)
                .into_iter()
                .map(|(start, text)| (column(text), start..start + text.len()))
                .collect();
            if let Some(time) = columns.iter().position(|(column, _)| column.is_time()) {
                let mut header = Header {
                    delimiter,
                    line: number,
                    columns,
                    time,
                };
                header.name_tracks(before.unwrap_or(""));
                return Some(header);
            }
        }
        before = Some(line);
    }
    None
}

impl Header {
    /// Assigns names of tracks: a single name applies to all columns; several are above the first
    /// column of each track.
    fn name_tracks(&mut self, line: &str) {
        let names = self.delimiter.cells(line);
        let single = match names[..] {
            [(_, name)] | [(_, name), (_, "")] | [(_, ""), (_, name)] => Some(name),
            _ => None,
        };
        let mut track = single.unwrap_or("");
        for (i, (column, _)) in self.columns.iter_mut().enumerate() {
            let above = names.get(i).filter(|(_, name)| !name.is_empty());
            if let (None, Some((_, name))) = (single, above) {
                track = name;
            }
            if !column.is_time() {
                track.clone_into(&mut column.track);
            }
        }
    }
}

/// Parses `y (cm)`, `y [cm]` or `y`, without a spreadsheet's quotes.
fn column(text: &str) -> Column {
    let text = text.trim_matches('"').trim();
    let bracket = |open: char, close: char| {
        let inner = text.strip_suffix(close)?;
        let at = inner.rfind(open)?;
        (at > 0).then(|| (inner[..at].trim(), inner[at + open.len_utf8()..].trim()))
    };
    let (name, unit) = match bracket('(', ')').or_else(|| bracket('[', ']')) {
        Some((name, unit)) => (name, Some(unit.to_owned())),
        None => (text, None),
    };
    Column {
        track: String::new(),
        name: name.to_owned(),
        unit,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tracks(lines: &[&str]) -> Vec<String> {
        let header = header(lines).expect("a header");
        let columns = header.columns.into_iter();
        columns.map(|(column, _)| column.full_name()).collect()
    }

    /// One name, with or without a delimiter beside it, is that of all columns but the time, wherever that stands.
    #[test]
    fn a_single_name_is_that_of_all_columns() {
        for above in ["mass A", "mass A\t", "\tmass A", "  mass A"] {
            assert_eq!(
                tracks(&[above, "x\ty\tt"]),
                ["mass A.x", "mass A.y", "t"],
                "{above:?}"
            );
        }
        assert_eq!(tracks(&["x\ty\tt"]), ["x", "y", "t"]);
    }

    /// Several stand above the first column of each track.
    #[test]
    fn several_names_begin_their_tracks() {
        let found = tracks(&["#multi:", "\tA\t\tB\t", "t\tx\ty\tx\ty"]);
        assert_eq!(found, ["t", "A.x", "A.y", "B.x", "B.y"]);
        let found = tracks(&["A\tB", "t\tx\ty"]);
        assert_eq!(found, ["t", "B.x", "B.y"]);
    }

    /// A unit stands in brackets after a name; brackets alone are a name.
    #[test]
    fn units_stand_in_brackets_after_a_name() {
        for (text, name, unit) in [
            ("y (cm)", "y", Some("cm")),
            ("\"y [ cm ]\"", "y", Some("cm")),
            ("y(°)", "y", Some("°")),
            ("(cm)", "(cm)", None),
            ("y cm)", "y cm)", None),
            ("θ", "θ", None),
        ] {
            let column = column(text);
            assert_eq!(
                (column.name.as_str(), column.unit.as_deref()),
                (name, unit),
                "{text}"
            );
        }
    }
}
