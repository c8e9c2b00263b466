//! The one definition of the results table: CSV, Parquet, JSON and docs/reference/formats.md follow it.

use super::{Results, Row};
use coinmc_core::{CounterKind, Estimate, Tally, relative_error, rule_of_thumb_relative_error};
use coinmc_table::{Cell, Field, Kind};

/// Version of the table.
pub const FORMAT: u64 = 1;

/// One column of the results table.
#[derive(Debug, Clone)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub kind: Kind,
    /// Unit; `1` for pure numbers, empty for text and flags.
    pub unit: &'static str,
    /// What it means.
    pub doc: &'static str,
    source: Source,
}

/// Where a column's cells come from.
#[derive(Debug, Clone, Copy)]
enum Source {
    /// The parameter at this place.
    Parameter(usize),
    /// The tally's counter at this place.
    Counter(usize),
    Row(fn(&Row) -> Cell<'_>),
}

impl Column {
    /// Its name, kind, unit and meaning, as a column of a file.
    pub fn field(&self) -> Field {
        Field::new(&self.name, self.kind, self.unit, self.doc)
    }

    /// The column's cell in a row; a parameter that the row lacks is missing.
    pub fn cell<'a>(&self, row: &'a Row) -> Cell<'a> {
        match self.source {
            Source::Row(cell) => cell(row),
            Source::Counter(index) => Cell::Count(row.tally.to_array()[index]),
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

/// What the table says of itself, by key: the metadata of its files, and of Arrow's tables.
pub fn metadata(results: &Results) -> [(&'static str, String); 5] {
    [
        ("coinmc.format", FORMAT.to_string()),
        ("coinmc.program_version", results.program_version.clone()),
        ("coinmc.plan_hash", results.plan_hash.clone()),
        ("coinmc.axes", results.axes.join(",")),
        ("coinmc.config", results.config.clone()),
    ]
}

/// What was computed, and the counts of how tosses ended.
fn endings() -> Vec<Column> {
    vec![
        text("engine", "The engine.", |row| Cell::Text(row.engine)),
        text("law", "Law of impact, or the closed form.", |row| {
            Cell::Text(row.law)
        }),
        flag(
            "gyroscopic_torque",
            "Whether the gyroscopic torque acts, as in nature.",
            |row| Cell::Flag(row.gyroscopic_torque),
        ),
        count(
            "tosses",
            "All tosses, undecided ones included; 0 for a closed form or an integral.",
            |row| Cell::Count(row.tally.tosses()),
        ),
        counter("heads"),
        counter("tails"),
        counter("side"),
        count(
            "undecided",
            "Tosses of which it is not known how they end: the sum of the next four.",
            |row| Cell::Count(row.tally.undecided()),
        ),
        counter("time_limit"),
        counter("never_settles"),
        counter("impact_limit"),
        counter("failed"),
    ]
}

/// The probabilities with their intervals and errors.
fn probabilities() -> Vec<Column> {
    vec![
        number(
            "p_heads",
            "Probability of heads: heads/tosses, or the integral.",
            |row| Cell::finite(row.heads.p),
        ),
        number("p_heads_lo", "Lower end of its interval.", |row| {
            Cell::finite(row.heads.lo)
        }),
        number("p_heads_hi", "Upper end of its interval.", |row| {
            Cell::finite(row.heads.hi)
        }),
        number(
            "p_tails",
            "Probability of tails: tails/tosses, or the integral.",
            |row| Cell::finite(row.tails.p),
        ),
        number("p_tails_lo", "Lower end of its interval.", |row| {
            Cell::finite(row.tails.lo)
        }),
        number("p_tails_hi", "Upper end of its interval.", |row| {
            Cell::finite(row.tails.hi)
        }),
        number(
            "p_side",
            "Probability of the side: side/tosses, or the integral.",
            |row| Cell::finite(row.side.p),
        ),
        number("p_side_lo", "Lower end of its interval.", |row| {
            Cell::finite(row.side.lo)
        }),
        number("p_side_hi", "Upper end of its interval.", |row| {
            Cell::finite(row.side.hi)
        }),
        number(
            "confidence",
            "Probability that an interval holds the true value.",
            |row| Cell::Number(row.side.confidence),
        ),
        text("interval", "How the intervals were computed.", |row| {
            Cell::Text(row.interval)
        }),
        number(
            "rel_error_side",
            "Relative standard error of p_side, sqrt((1 - P)/(P N)); empty while no toss shows the side.",
            |row| counted(row, relative_error(row.side.p, row.side.n)),
        ),
        number(
            "rule_of_thumb",
            "The rule of thumb for it, 1/sqrt(N), exact only at P = 1/2.",
            |row| counted(row, rule_of_thumb_relative_error(row.side.n)),
        ),
    ]
}

/// The work done, what went wrong on the way, and how launches were drawn.
fn work() -> Vec<Column> {
    vec![
        number("impacts_per_toss", "Mean number of impacts.", |row| {
            per_toss(row, row.tally.impacts)
        }),
        number(
            "contact_steps_per_toss",
            "Mean number of steps in sustained contact.",
            |row| per_toss(row, row.tally.contact_steps),
        ),
        counter("jams"),
        counter("overruled"),
        flag(
            "reached_target",
            "Whether the point has the tosses asked for or meets its targets.",
            |row| Cell::Flag(row.stopped_by.is_reached()),
        ),
        counter("negative_heights"),
        counter("energy_gains"),
        counter("wrong_levers"),
        counter("sinkings"),
        counter("unresolved"),
        text(
            "sampling",
            "How launches were drawn: random, quasi-random, or closed-form where none was.",
            |row| Cell::Text(row.sampling),
        ),
        count(
            "evaluations",
            "Evaluations of a point that was integrated; 0 for counted tosses and for closed forms.",
            |row| Cell::Count(row.evaluations),
        ),
    ]
}

/// How tosses on the side came to end there.
fn side_endings() -> Vec<Column> {
    let counters = Tally::COUNTERS.iter();
    let counters = counters.filter(|counter| counter.kind == CounterKind::SideEnding);
    counters.map(|found| counter(found.name)).collect()
}

/// When points stopped.
fn stopping() -> Vec<Column> {
    vec![
        text(
            "stopped_by",
            "The rule that ended the point, see below.",
            |row| Cell::Text(row.stopped_by.name()),
        ),
        count(
            "pilot_tosses",
            "Tosses before those that count, which only say how many the targets need.",
            |row| Cell::Count(row.pilot_tosses),
        ),
    ]
}

/// A number of an estimate that not every row has.
fn of(estimate: Option<&Estimate>, number: fn(&Estimate) -> f64) -> Cell<'_> {
    Cell::finite(estimate.map_or(f64::NAN, number))
}

/// How tosses ended by how they began.
fn same_side() -> Vec<Column> {
    vec![
        counter("same"),
        number(
            "p_same",
            "Probability of that: same/tosses; empty where it is not known.",
            |row| of(row.same.as_ref(), |same| same.p),
        ),
        number("p_same_lo", "Lower end of its interval.", |row| {
            of(row.same.as_ref(), |same| same.lo)
        }),
        number("p_same_hi", "Upper end of its interval.", |row| {
            of(row.same.as_ref(), |same| same.hi)
        }),
    ]
}

/// Tosses that left a table with an edge.
fn left() -> Vec<Column> {
    vec![
        counter("left"),
        number(
            "p_left",
            "Probability of that: left/tosses; empty where the table has no edge.",
            |row| of(row.left.as_ref(), |left| left.p),
        ),
        number("p_left_lo", "Lower end of its interval.", |row| {
            of(row.left.as_ref(), |left| left.lo)
        }),
        number("p_left_hi", "Upper end of its interval.", |row| {
            of(row.left.as_ref(), |left| left.hi)
        }),
    ]
}

/// The column of one of the tally's counters.
fn counter(name: &str) -> Column {
    let mut counters = Tally::COUNTERS.iter().enumerate();
    let (index, counter) = counters
        .find(|(_, counter)| counter.name == name)
        .unwrap_or_else(|| unreachable!("a test builds every column: {name}"));
    column(name, Kind::Count, "1", counter.doc, Source::Counter(index))
}

fn count(name: &str, doc: &'static str, cell: fn(&Row) -> Cell<'_>) -> Column {
    column(name, Kind::Count, "1", doc, Source::Row(cell))
}

fn number(name: &str, doc: &'static str, cell: fn(&Row) -> Cell<'_>) -> Column {
    column(name, Kind::Number, "1", doc, Source::Row(cell))
}

fn text(name: &str, doc: &'static str, cell: fn(&Row) -> Cell<'_>) -> Column {
    column(name, Kind::Text, "", doc, Source::Row(cell))
}

fn flag(name: &str, doc: &'static str, cell: fn(&Row) -> Cell<'_>) -> Column {
    column(name, Kind::Flag, "", doc, Source::Row(cell))
}

fn column(name: &str, kind: Kind, unit: &'static str, doc: &'static str, source: Source) -> Column {
    Column {
        name: name.to_owned(),
        kind,
        unit,
        doc,
        source,
    }
}

/// The columns of a table with these parameters, in order.
pub fn columns<'a>(parameters: impl IntoIterator<Item = &'a str>) -> Vec<Column> {
    let point = count("point", "Index of the point in the sweep, from 0.", |row| {
        Cell::Count(row.point as u64)
    });
    let parameters = parameters.into_iter().enumerate().map(|(index, name)| {
        let source = Source::Parameter(index);
        column(
            name,
            Kind::Number,
            unit_of(name),
            "Parameter of the point.",
            source,
        )
    });
    std::iter::once(point)
        .chain(parameters)
        .chain(endings())
        .chain(probabilities())
        .chain(work())
        .chain(side_endings())
        .chain(stopping())
        .chain(same_side())
        .chain(left())
        .collect()
}

/// The columns of these results.
pub fn columns_of(results: &Results) -> Vec<Column> {
    // all points of a plan have the same parameters
    let first = results.rows.each().next();
    let first = first.as_deref().map_or(&[][..], |row| &row.parameters);
    columns(first.iter().map(|(name, _)| &**name))
}

/// The unit that a name ends in.
fn unit_of(name: &str) -> &'static str {
    const UNITS: [(&str, &str); 11] = [
        ("_per_s", "1/s"),
        ("_kg_m2", "kg m²"),
        ("_rad_s", "rad/s"),
        ("_m_s2", "m/s²"),
        ("_m_s", "m/s"),
        ("_rad", "rad"),
        ("_deg", "deg"),
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

/// A value that is defined for counted tosses only.
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
    use crate::plan::StoppedBy;

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

    /// Readers know these columns by their place at the end, where new ones are added.
    #[test]
    fn newer_columns_follow_the_older_ones() {
        let columns = columns([]);
        let names: Vec<_> = columns.iter().map(|column| &*column.name).collect();
        let (_, newer) = names.split_at(names.len() - 20);
        assert_eq!(
            newer,
            [
                "side_rested",
                "side_rolled",
                "side_spun",
                "rolled_1_cm",
                "rolled_3_cm",
                "rolled_10_cm",
                "rolled_30_cm",
                "rolled_1_m",
                "rolled_3_m",
                "rolled_10_m",
                "stopped_by",
                "pilot_tosses",
                "same",
                "p_same",
                "p_same_lo",
                "p_same_hi",
                "left",
                "p_left",
                "p_left_lo",
                "p_left_hi"
            ]
        );
    }

    #[test]
    fn a_parameter_is_found_by_its_name() {
        let plan = crate::config::parse(
            "inline",
            "coin.ratio = 0.75\nengine.analytic.rule = 'arc'",
            &[],
        );
        let plan = plan.unwrap();
        let row = |parameters: &[(&str, f64)]| {
            let parameters = parameters.iter().map(|&(name, value)| (name.into(), value));
            Row {
                parameters: parameters.collect(),
                ..Row::new(&plan, 0, Tally::default(), StoppedBy::Tosses)
            }
        };
        let columns = columns(["ratio", "friction"]);
        let cells =
            |row: &Row| [1, 2].map(|column: usize| format!("{:?}", columns[column].cell(row)));
        let both = ["Number(0.75)", "Number(0.3)"];
        assert_eq!(cells(&row(&[("ratio", 0.75), ("friction", 0.3)])), both);
        assert_eq!(cells(&row(&[("friction", 0.3), ("ratio", 0.75)])), both);
        assert_eq!(
            cells(&row(&[("radius_m", 0.01), ("friction", 0.3)])),
            ["Missing", both[1]]
        );
    }
}
