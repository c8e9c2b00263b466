//! The only definition of the table of records: CSV, Parquet, JSON lines and
//! docs/reference/traces.md follow it.

use crate::end::outcome_name;
use crate::record::Record;
use crate::trace::Trace;
use coinmc::results::{Cell, Kind};
use coinmc_core::{Coin, State};

/// Version of the trace file formats.
pub const FORMAT: u64 = 1;

/// One column of the table of records.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// Its name.
    pub name: &'static str,
    /// Kind of its values.
    pub kind: Kind,
    /// Unit; `1` for dimensionless numbers, empty for columns that are not numbers.
    pub unit: &'static str,
    /// Description.
    pub doc: &'static str,
    cell: fn(&Row<'_>) -> Cell<'static>,
}

/// A record with the trace it belongs to.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    pub(super) trace: &'a Trace,
    pub(super) number: usize,
    pub(super) record: &'a Record,
}

impl Column {
    pub(super) fn cell(&self, row: &Row<'_>) -> Cell<'static> {
        (self.cell)(row)
    }
}

/// The columns, in order.
pub fn columns() -> &'static [Column] {
    COLUMNS
}

/// The rows of traces, in order.
pub(super) fn rows(traces: &[Trace]) -> impl Iterator<Item = Row<'_>> {
    traces.iter().flat_map(|trace| {
        let records = trace.records.iter().enumerate();
        records.map(move |(number, record)| Row {
            trace,
            number,
            record,
        })
    })
}

/// Height of the coin's lowest point above the surface, m.
pub(super) fn lowest_m(coin: &Coin, state: &State) -> f64 {
    if !coin.has_like_faces() {
        return state.position_m.z + coin.lowest_point_m(&state.axis).z;
    }
    let u = &state.axis;
    let across = (u.x * u.x + u.y * u.y).sqrt();
    let rim = coin.rim_radius_m();
    let centre_line = (0.5 * coin.height_m() - rim) * u.z.abs() + (coin.radius_m() - rim) * across;
    state.position_m.z - centre_line - rim
}

/// The angle between the coin's axis and the vertical, regardless of which end is up, rad.
pub(super) fn tilt_rad(state: &State) -> f64 {
    let u = &state.axis;
    libm::atan2((u.x * u.x + u.y * u.y).sqrt(), u.z.abs())
}

macro_rules! column {
    ($name:literal, $kind:ident, $unit:literal, $doc:literal, $cell:expr) => {
        Column {
            name: $name,
            kind: Kind::$kind,
            unit: $unit,
            doc: $doc,
            cell: $cell,
        }
    };
}

macro_rules! number {
    ($name:literal, $unit:literal, $doc:literal, $value:expr) => {
        column!($name, Number, $unit, $doc, |row| {
            let value: fn(&Row<'_>) -> f64 = $value;
            Cell::finite(value(row))
        })
    };
}

const COLUMNS: &[Column] = &[
    column!("point", Count, "1", "Index of the point, from 0.", |row| {
        Cell::Count(row.trace.point as u64)
    }),
    column!("toss", Count, "1", "Number of the toss, from 0.", |row| {
        Cell::Count(row.trace.toss)
    }),
    column!(
        "record",
        Count,
        "1",
        "Number of the record within its toss, from 0.",
        |row| Cell::Count(row.number as u64)
    ),
    number!("time_s", "s", "Time since launch.", |row| {
        row.record.state.time_s
    }),
    column!("kind", Text, "", "The event, or `sample`.", |row| {
        Cell::Text(row.record.kind.name())
    }),
    column!("mode", Text, "", "How the coin moves from here.", |row| {
        Cell::Text(row.record.mode.name())
    }),
    number!("x_m", "m", "Centre of the coin.", |row| {
        row.record.state.position_m.x
    }),
    number!("y_m", "m", "Centre of the coin.", |row| {
        row.record.state.position_m.y
    }),
    number!(
        "z_m",
        "m",
        "Centre of the coin, above the surface.",
        |row| { row.record.state.position_m.z }
    ),
    number!("vx_m_s", "m/s", "Velocity of the centre.", |row| {
        row.record.state.velocity_m_s.x
    }),
    number!("vy_m_s", "m/s", "Velocity of the centre.", |row| {
        row.record.state.velocity_m_s.y
    }),
    number!("vz_m_s", "m/s", "Velocity of the centre.", |row| {
        row.record.state.velocity_m_s.z
    }),
    number!("ux", "1", "Unit normal of the heads face.", |row| {
        row.record.state.axis.x
    }),
    number!("uy", "1", "Unit normal of the heads face.", |row| {
        row.record.state.axis.y
    }),
    number!("uz", "1", "Unit normal of the heads face.", |row| {
        row.record.state.axis.z
    }),
    number!("qw", "1", "Orientation, a unit quaternion.", |row| {
        row.record.orientation.w
    }),
    number!("qx", "1", "Orientation.", |row| row.record.orientation.i),
    number!("qy", "1", "Orientation.", |row| row.record.orientation.j),
    number!("qz", "1", "Orientation.", |row| row.record.orientation.k),
    number!("wx_rad_s", "rad/s", "Angular velocity.", |row| {
        row.record.state.spin_rad_s.x
    }),
    number!("wy_rad_s", "rad/s", "Angular velocity.", |row| {
        row.record.state.spin_rad_s.y
    }),
    number!("wz_rad_s", "rad/s", "Angular velocity.", |row| {
        row.record.state.spin_rad_s.z
    }),
    number!(
        "tilt_rad",
        "rad",
        "Angle of the coin's axis to the vertical, 0 when it lies flat.",
        |row| tilt_rad(&row.record.state)
    ),
    number!(
        "lowest_m",
        "m",
        "Height of the coin's lowest point.",
        |row| lowest_m(&row.trace.scene.coin, &row.record.state)
    ),
    number!(
        "energy_j_kg",
        "J/kg",
        "Mechanical energy per unit mass; 0 for a point at rest on the surface.",
        |row| row.record.energy_j_kg
    ),
    column!(
        "outcome",
        Text,
        "",
        "How the toss ended: its face, or why it has none.",
        |row| Cell::Text(outcome_name(&row.trace.outcome))
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_numbers_have_units() {
        let mut names = std::collections::HashSet::new();
        for column in columns() {
            assert!(names.insert(column.name), "{}", column.name);
            let is_number = matches!(column.kind, Kind::Count | Kind::Number);
            assert_eq!(is_number, !column.unit.is_empty(), "{}", column.name);
        }
    }
}
