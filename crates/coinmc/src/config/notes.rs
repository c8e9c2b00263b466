//! Remarks that are not errors: settings without effect, or with surprising effects.

use super::checked::Checked;
use crate::engines::EngineKind;
use crate::plan::Point;
use coinmc_core::{Landing, Surface};

/// The remarks on a config, in the order of its tables.
pub(super) fn notes(root: &Checked, points: &[Point]) -> Vec<String> {
    let mut notes = Vec::new();
    let Some(engine) = points.first().map(|point| point.engine.descriptor()) else {
        return notes;
    };
    if engine.kind == EngineKind::ClosedForm {
        for table in ["surface", "launch", "stop"] {
            if root.get(table).is_some() {
                notes.push(format!(
                    "[{table}] changes nothing: engine.{} makes no toss",
                    engine.name
                ));
            }
        }
        return notes;
    }
    notes.extend(in_vain(points));
    for remark in engine.remarks {
        if points.iter().any(|point| (remark.applies)(&point.scene)) {
            notes.push(remark.text.to_owned());
        }
    }
    notes
}

fn adhesive(point: &Point) -> bool {
    point.scene.surface.landing() == Landing::Adhesive
}

/// A key of `[surface]`, and where its value is.
type Property = (&'static str, fn(&Surface) -> f64);

/// The remark on properties of contacts if no point has contacts.
fn in_vain(points: &[Point]) -> Option<String> {
    let properties: [Property; 7] = [
        ("restitution", Surface::restitution),
        ("friction", Surface::friction),
        ("rolling_friction_m", Surface::rolling_friction_m),
        ("pivoting_friction_m", Surface::pivoting_friction_m),
        (
            "restitution_threshold_m_s",
            Surface::restitution_threshold_m_s,
        ),
        ("restitution_exponent", Surface::restitution_exponent),
        ("roughness_slope", |surface| {
            surface
                .roughness()
                .map_or(0.0, |roughness| roughness.slope())
        }),
    ];
    let given = properties.iter().filter(|(_, value)| {
        let counts = |point: &Point| adhesive(point) && value(&point.scene.surface) != 0.0;
        points.iter().any(counts)
    });
    let keys: Vec<String> = given.map(|(key, _)| format!("surface.{key}")).collect();
    let (last, others) = keys.split_last()?;
    let (keys, change) = if others.is_empty() {
        (last.clone(), "changes")
    } else {
        (format!("{} and {last}", others.join(", ")), "change")
    };
    Some(format!(
        "{keys} {change} nothing: with landing = \"adhesive\" the first contact decides"
    ))
}
