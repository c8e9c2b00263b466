//! The one definition of the results table: CSV, Parquet, JSON and docs/reference/formats.md follow it.

use super::{Results, Row};
use coinmc_core::{relative_error, rule_of_thumb_relative_error};

/// Version of the table.
pub const FORMAT: u64 = 1;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A whole number, 0 to 2^64 − 1.
    Count,
    /// A 64-bit floating point number.
    Number,
    /// Text.
    Text,
    /// Yes or no.
    Flag,
}

impl Kind {
    /// The kind's name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::Count => "u64",
            Self::Number => "f64",
            Self::Text => "text",
            Self::Flag => "bool",
        }
    }
}

/// A cell of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Cell<'a> {
    Count(u64),
    Number(f64),
    Text(&'a str),
    Flag(bool),
    /// Not defined here: no tosses, or no such face among them.
    Missing,
}

impl Cell<'_> {
    /// A number, or nothing if it is not one.
    pub(crate) fn finite(value: f64) -> Self {
        if value.is_finite() {
            Self::Number(value)
        } else {
            Self::Missing
        }
    }
}

/// One column of the results table.
#[derive(Debug, Clone)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub kind: Kind,
    /// Unit; `1` for pure numbers, empty for what is no number.
    pub unit: &'static str,
    /// What it means.
    pub doc: &'static str,
    source: Source,
}

#[derive(Debug, Clone, Copy)]
enum Source {
    Parameter(usize),
    Fixed(fn(&Row) -> Cell<'_>),
}

impl Column {
    /// The column's cell in a row.
    pub(crate) fn cell<'a>(&self, row: &'a Row) -> Cell<'a> {
        match self.source {
            Source::Fixed(cell) => cell(row),
            Source::Parameter(index) => match row.parameters.get(index) {
                Some((name, value)) if **name == *self.name => Cell::Number(*value),
                _ => {
                    let found = row.parameters.iter().find(|(name, _)| **name == *self.name);
                    found.map_or(Cell::Missing, |(_, value)| Cell::Number(*value))
                }
            },
        }
    }
}

type Definition = (
    &'static str,
    Kind,
    &'static str,
    &'static str,
    fn(&Row) -> Cell<'_>,
);

/// The columns after `point` and the parameters.
const FIXED: &[Definition] = &[
    (
        "engine",
        Kind::Text,
        "",
        "Who followed the tosses.",
        |row| Cell::Text(row.engine),
    ),
    (
        "law",
        Kind::Text,
        "",
        "Law of impact, or the closed form.",
        |row| Cell::Text(row.law),
    ),
    (
        "gyroscopic_torque",
        Kind::Flag,
        "",
        "Whether the gyroscopic torque acts, as in nature.",
        |row| Cell::Flag(row.gyroscopic_torque),
    ),
    (
        "tosses",
        Kind::Count,
        "1",
        "All tosses, undecided ones included; 0 for a closed form or an integral.",
        |row| Cell::Count(row.tally.tosses()),
    ),
    (
        "heads",
        Kind::Count,
        "1",
        "Tosses that show heads.",
        |row| Cell::Count(row.tally.heads),
    ),
    (
        "tails",
        Kind::Count,
        "1",
        "Tosses that show tails.",
        |row| Cell::Count(row.tally.tails),
    ),
    ("side", Kind::Count, "1", "Tosses on the side.", |row| {
        Cell::Count(row.tally.side)
    }),
    (
        "undecided",
        Kind::Count,
        "1",
        "Tosses without a face: the sum of the next four.",
        |row| Cell::Count(row.tally.undecided()),
    ),
    (
        "time_limit",
        Kind::Count,
        "1",
        "Undecided at the limit of simulated time.",
        |row| Cell::Count(row.tally.time_limit),
    ),
    (
        "never_settles",
        Kind::Count,
        "1",
        "Undecided for ever: proven never to settle.",
        |row| Cell::Count(row.tally.never_settles),
    ),
    (
        "impact_limit",
        Kind::Count,
        "1",
        "Undecided at the limit of impacts or of steps in contact.",
        |row| Cell::Count(row.tally.impact_limit),
    ),
    (
        "failed",
        Kind::Count,
        "1",
        "Undecided because numbers went wrong.",
        |row| Cell::Count(row.tally.failed),
    ),
    (
        "p_heads",
        Kind::Number,
        "1",
        "Probability of heads: heads/tosses, or the integral.",
        |row| Cell::finite(row.heads.p),
    ),
    (
        "p_heads_lo",
        Kind::Number,
        "1",
        "Lower end of its interval.",
        |row| Cell::finite(row.heads.lo),
    ),
    (
        "p_heads_hi",
        Kind::Number,
        "1",
        "Upper end of its interval.",
        |row| Cell::finite(row.heads.hi),
    ),
    (
        "p_tails",
        Kind::Number,
        "1",
        "Probability of tails: tails/tosses, or the integral.",
        |row| Cell::finite(row.tails.p),
    ),
    (
        "p_tails_lo",
        Kind::Number,
        "1",
        "Lower end of its interval.",
        |row| Cell::finite(row.tails.lo),
    ),
    (
        "p_tails_hi",
        Kind::Number,
        "1",
        "Upper end of its interval.",
        |row| Cell::finite(row.tails.hi),
    ),
    (
        "p_side",
        Kind::Number,
        "1",
        "Probability of the side: side/tosses, or the integral.",
        |row| Cell::finite(row.side.p),
    ),
    (
        "p_side_lo",
        Kind::Number,
        "1",
        "Lower end of its interval.",
        |row| Cell::finite(row.side.lo),
    ),
    (
        "p_side_hi",
        Kind::Number,
        "1",
        "Upper end of its interval.",
        |row| Cell::finite(row.side.hi),
    ),
    (
        "confidence",
        Kind::Number,
        "1",
        "Probability that an interval holds the true value.",
        |row| Cell::Number(row.side.confidence),
    ),
    (
        "interval",
        Kind::Text,
        "",
        "How the intervals were computed.",
        |row| Cell::Text(row.interval),
    ),
    (
        "rel_error_side",
        Kind::Number,
        "1",
        "Relative standard error of p_side, sqrt((1 - P)/(P N)); empty while no toss shows the side.",
        |row| counted(row, relative_error(row.side.p, row.side.n)),
    ),
    (
        "rule_of_thumb",
        Kind::Number,
        "1",
        "The rule of thumb for it, 1/sqrt(N), exact only at P = 1/2.",
        |row| counted(row, rule_of_thumb_relative_error(row.side.n)),
    ),
    (
        "impacts_per_toss",
        Kind::Number,
        "1",
        "Mean number of impacts.",
        |row| per_toss(row, row.tally.impacts),
    ),
    (
        "contact_steps_per_toss",
        Kind::Number,
        "1",
        "Mean number of steps in sustained contact.",
        |row| per_toss(row, row.tally.contact_steps),
    ),
    (
        "jams",
        Kind::Count,
        "1",
        "Tangential impacts in Painlevé configurations, in all tosses.",
        |row| Cell::Count(row.tally.jams),
    ),
    (
        "overruled",
        Kind::Count,
        "1",
        "Tosses that the stopping rule chosen decides otherwise than energy.",
        |row| Cell::Count(row.tally.overruled),
    ),
    (
        "reached_target",
        Kind::Flag,
        "",
        "The point has the tosses, or the half width, asked for.",
        |row| Cell::Flag(row.reached_target),
    ),
    (
        "negative_heights",
        Kind::Count,
        "1",
        "Impacts at which the law of impact asked for a negative height of rebound, in all tosses.",
        |row| Cell::Count(row.tally.negative_heights),
    ),
    (
        "energy_gains",
        Kind::Count,
        "1",
        "Impacts at which the law of impact would have gained energy, in all tosses.",
        |row| Cell::Count(row.tally.energy_gains),
    ),
    (
        "wrong_levers",
        Kind::Count,
        "1",
        "Impacts at which the law's lever turned the coin the wrong way, in all tosses.",
        |row| Cell::Count(row.tally.wrong_levers),
    ),
    (
        "sinkings",
        Kind::Count,
        "1",
        "Impacts after which the corner would have gone on into the surface, in all tosses.",
        |row| Cell::Count(row.tally.sinkings),
    ),
    (
        "unresolved",
        Kind::Count,
        "1",
        "Impacts whose integration in time was given up, in all tosses.",
        |row| Cell::Count(row.tally.unresolved),
    ),
    (
        "sampling",
        Kind::Text,
        "",
        "How launches were drawn: random, quasi-random, or closed-form where none was.",
        |row| Cell::Text(row.sampling),
    ),
    (
        "evaluations",
        Kind::Count,
        "1",
        "Evaluations of a point that was integrated; 0 where tosses were counted, and for a rule.",
        |row| Cell::Count(row.evaluations),
    ),
];

/// The columns of a table with these parameters, in order.
pub fn columns<'a>(parameters: impl IntoIterator<Item = &'a str>) -> Vec<Column> {
    let point = Column {
        name: "point".to_owned(),
        kind: Kind::Count,
        unit: "1",
        doc: "Index of the point in the sweep, from 0.",
        source: Source::Fixed(|row| Cell::Count(row.point as u64)),
    };
    let parameters = parameters
        .into_iter()
        .enumerate()
        .map(|(index, name)| Column {
            name: name.to_owned(),
            kind: Kind::Number,
            unit: unit_of(name),
            doc: "Parameter of the point.",
            source: Source::Parameter(index),
        });
    let fixed = FIXED.iter().map(|&(name, kind, unit, doc, cell)| Column {
        name: name.to_owned(),
        kind,
        unit,
        doc,
        source: Source::Fixed(cell),
    });
    std::iter::once(point)
        .chain(parameters)
        .chain(fixed)
        .collect()
}

/// The columns of these results.
pub(crate) fn columns_of(results: &Results) -> Vec<Column> {
    let mut names: Vec<&str> = Vec::new();
    for row in &results.rows {
        // nearly always the same names in the same places
        for (index, (name, _)) in row.parameters.iter().enumerate() {
            if names.get(index) != Some(&&**name) && !names.contains(&&**name) {
                names.push(name);
            }
        }
    }
    columns(names)
}

/// The unit that a name ends in.
fn unit_of(name: &str) -> &'static str {
    const UNITS: [(&str, &str); 10] = [
        ("_per_s", "1/s"),
        ("_kg_m2", "kg m²"),
        ("_rad_s", "rad/s"),
        ("_m_s2", "m/s²"),
        ("_m_s", "m/s"),
        ("_rad", "rad"),
        ("_kg", "kg"),
        ("_m2", "m²"),
        ("_m", "m"),
        ("_s", "s"),
    ];
    UNITS
        .iter()
        .find(|(suffix, _)| name.ends_with(suffix))
        .map_or("1", |(_, unit)| unit)
}

/// A value that only counts of tosses have.
fn counted(row: &Row, value: f64) -> Cell<'static> {
    if row.side.n == 0 || row.evaluations > 0 {
        Cell::Missing
    } else {
        Cell::finite(value)
    }
}

fn per_toss(row: &Row, count: u64) -> Cell<'static> {
    Cell::finite(count as f64 / row.tally.tosses() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_units_follow_from_them() {
        let parameters = ["ratio", "radius_m", "launch_spin_rad_s", "gravity_m_s2"];
        let columns = columns(parameters.into_iter().chain(["linear_drag_per_s"]));
        let names: std::collections::HashSet<_> = columns.iter().map(|c| &c.name).collect();
        assert_eq!(names.len(), columns.len());
        let units: Vec<_> = columns[..6].iter().map(|column| column.unit).collect();
        assert_eq!(units, ["1", "1", "m", "rad/s", "m/s²", "1/s"]);
        // every fixed column names its unit if it is a number, and no other does
        for column in &columns[6..] {
            let is_number = matches!(column.kind, Kind::Count | Kind::Number);
            assert_eq!(column.unit == "1", is_number, "{}", column.name);
        }
    }
}
