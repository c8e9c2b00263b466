//! A trace's events as rows, and which of them get a line of their own.

use coinmc_core::{Coin, EventKind, State};
use coinmc_trace::{Mode, Record, RecordKind, Trace};

/// Successive events within this fraction of the toppling time sqrt(D/g) are small: the coin hardly
/// turns or moves in that time.
const SMALL: f64 = 0.1;
/// At least this many successive small events share one line.
const FLOOD: usize = 5;
/// A longer table than this shows only its first and last `END` lines.
const LONG: usize = 60;
const END: usize = 25;

/// The row of an event.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    pub(super) time_s: f64,
    pub(super) event: String,
    pub(super) is_impact: bool,
    /// How the coin moves from here.
    pub(super) goes_on: &'static str,
    /// Of the centre.
    pub(super) height_m: f64,
    pub(super) energy_j_kg: f64,
    /// Energy as a fraction of that at balance on the rim, at rest.
    pub(super) of_balance: f64,
    pub(super) turns_s: f64,
    /// The face that is up.
    pub(super) up: &'static str,
    /// Angle from lying on a face, 90° being the side.
    pub(super) tilt_deg: f64,
    /// At an impact, the downward speed of the lowest point; in contact, its sliding speed.
    pub(super) rim_m_s: Option<f64>,
}

/// A line of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Line<'a> {
    Row(&'a Row),
    /// Successive small events.
    Group(&'a [Row]),
    /// Omitted rows.
    Hidden(&'a [Row]),
}

/// One row per event; touching and the impact that follows share one.
pub(super) fn rows(trace: &Trace) -> Vec<Row> {
    let mut rows = Vec::new();
    let (mut impacts, mut touching) = (0_u64, None);
    for record in &trace.records {
        let RecordKind::Event(kind) = record.kind else {
            continue;
        };
        let (sinks, slips) = rim_speeds(&trace.scene.coin, &record.state);
        let (event, rim_m_s) = match kind {
            EventKind::Touching => {
                touching = Some(sinks);
                continue;
            }
            EventKind::Impact => {
                impacts += 1;
                (format!("impact {impacts}"), touching.take())
            }
            EventKind::Launched => ("launched".to_owned(), None),
            EventKind::Sticking => ("sticks".to_owned(), None),
            EventKind::Sliding => ("slides".to_owned(), Some(slips)),
            EventKind::LiftOff => ("lifts off".to_owned(), None),
            EventKind::Ended => ("ends".to_owned(), None),
        };
        rows.push(row(trace, record, event, rim_m_s));
    }
    rows
}

fn row(trace: &Trace, record: &Record, event: String, rim_m_s: Option<f64>) -> Row {
    let state = &record.state;
    let axis = state.axis.into_inner();
    let across = axis.xy().norm();
    Row {
        time_s: state.time_s,
        is_impact: record.kind == RecordKind::Event(EventKind::Impact),
        event,
        goes_on: match record.mode {
            Mode::Flight => "flies",
            Mode::Sticking => "sticks or rolls",
            Mode::Sliding => "slides",
            Mode::Ended => "",
        },
        height_m: state.position_m.z,
        energy_j_kg: record.energy_j_kg,
        of_balance: of_balance(trace, record),
        turns_s: state.spin_rad_s.norm() / std::f64::consts::TAU,
        up: if axis.z >= 0.0 { "heads" } else { "tails" },
        tilt_deg: libm::atan2(across, axis.z.abs()).to_degrees(),
        rim_m_s,
    }
}

/// Energy as a fraction of that of a coin balanced at rest on its rim, g (D + r).
pub(super) fn of_balance(trace: &Trace, record: &Record) -> f64 {
    let scene = &trace.scene;
    let balance = scene.coin.rim_distance_m() + scene.coin.rim_radius_m();
    record.energy_j_kg / (scene.gravity_m_s2() * balance)
}

/// Downward speed and sliding speed of the lowest point, m/s.
fn rim_speeds(coin: &Coin, state: &State) -> (f64, f64) {
    let arm = coin.lowest_point_m(&state.axis);
    let velocity = state.velocity_m_s + state.spin_rad_s.cross(&arm);
    (-velocity.z, velocity.xy().norm())
}

/// The lines to show, in order.
pub(super) fn lines(rows: &[Row], time_scale_s: f64, all: bool) -> Vec<Line<'_>> {
    if all {
        return rows.iter().map(Line::Row).collect();
    }
    let lines = groups(rows, SMALL * time_scale_s);
    if lines.len() <= LONG {
        return lines;
    }
    // the rows between the first lines and the last
    let shown = |lines: &[Line<'_>]| lines.iter().map(Line::rows).sum::<usize>();
    let (head, tail) = (&lines[..END], &lines[lines.len() - END..]);
    let hidden = &rows[shown(head)..rows.len() - shown(tail)];
    [head, &[Line::Hidden(hidden)], tail].concat()
}

/// Groups long series of small events, except for the first and the last of each.
fn groups(rows: &[Row], small_s: f64) -> Vec<Line<'_>> {
    let mut lines = Vec::new();
    let flood = |pair: &[Row]| pair[1].time_s - pair[0].time_s < small_s;
    let mut begin = 0;
    while begin < rows.len() {
        let steps = rows[begin..].windows(2).take_while(|pair| flood(pair));
        let end = begin + 1 + steps.count();
        let run = &rows[begin..end];
        match run {
            [first, small @ .., last] if small.len() >= FLOOD => {
                lines.extend([Line::Row(first), Line::Group(small), Line::Row(last)]);
            }
            _ => lines.extend(run.iter().map(Line::Row)),
        }
        begin = end;
    }
    lines
}

impl Line<'_> {
    /// Number of rows that the line stands for.
    fn rows(&self) -> usize {
        match self {
            Line::Row(_) => 1,
            Line::Group(rows) | Line::Hidden(rows) => rows.len(),
        }
    }
}
