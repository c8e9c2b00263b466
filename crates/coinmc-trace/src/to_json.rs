//! Tosses and records as JSON.

use crate::end::EndKind;
use crate::table;
use crate::trace::Trace;
use coinmc::plan::Plan;
use coinmc::results::Cell;
use coinmc_core::{Launch, Outcome};
use nalgebra::Vector3;
use serde_json::{Map, Value, json};

impl Trace {
    /// The toss without its records: point, number, launch and outcome.
    ///
    /// # Panics
    /// If `plan` is not the replayed plan and has no such point.
    pub fn to_json(&self, plan: &Plan) -> Value {
        let point = &plan.points[self.point];
        let parameters = point.parameters.iter();
        let parameters = parameters.map(|(name, value)| (name.to_string(), json!(value)));
        json!({
            "point": self.point,
            "toss": self.toss,
            "engine": self.engine,
            "law": point.engine.law(),
            "parameters": parameters.collect::<Map<_, _>>(),
            "gravity_m_s2": self.scene.gravity_m_s2(),
            "gyroscopic_torque": self.scene.has_gyroscopic_torque(),
            "launch": launch(&self.launch),
            "outcome": outcome(&self.outcome),
            "duration_s": self.duration_s(),
            "rate_hz": self.rate_hz,
            "records": self.records.len(),
            "samples_until_s": self.samples_until_s,
            "events_until_s": self.events_until_s,
        })
    }
}

fn launch(launch: &Launch) -> Value {
    json!({
        "height_m": launch.height_m,
        "velocity_m_s": vector(&launch.velocity_m_s),
        "axis": vector(&launch.axis),
        "spin_rad_s": vector(&launch.spin_rad_s),
    })
}

fn outcome(outcome: &Outcome) -> Value {
    json!({
        "face": outcome.face().map(coinmc_core::Face::name),
        "ended": EndKind::of(outcome.ended).name(),
        "impacts": outcome.impacts,
        "contact_steps": outcome.contact_steps,
        "jams": outcome.jams,
        "overruled": outcome.overruled,
    })
}

pub(super) fn vector(v: &Vector3<f64>) -> Value {
    json!([v.x, v.y, v.z])
}

/// A record, with one entry per column of the table.
pub(super) fn record(row: &table::Row<'_>) -> Map<String, Value> {
    let cells = table::columns().iter().map(|column| {
        let value = match column.cell(row) {
            Cell::Count(count) => json!(count),
            Cell::Number(number) => json!(number),
            Cell::Text(text) => json!(text),
            Cell::Flag(flag) => json!(flag),
            Cell::Missing => Value::Null,
        };
        (column.name.to_owned(), value)
    });
    cells.collect()
}
