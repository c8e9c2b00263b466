//! Remarks that are no problems: something given that changes nothing, or that may surprise.

use super::form::Form;
use crate::plan::{EngineChoice, Point};
use crate::run::engine_name;
use coinmc_core::{Landing, Surface};

/// The remarks on a config, in the order of its tables.
pub(super) fn notes(root: &Form, points: &[Point]) -> Vec<String> {
    let mut notes = Vec::new();
    let analytic = points
        .iter()
        .any(|point| matches!(point.engine, EngineChoice::Analytic(_)));
    if analytic {
        for table in ["surface", "launch", "stop"] {
            if root.get(table).is_some() {
                notes.push(format!(
                    "[{table}] changes nothing: engine.analytic makes no toss"
                ));
            }
        }
        return notes;
    }
    notes.extend(in_vain(points));
    let lossless = |point: &Point| !adhesive(point) && point.scene.surface.restitution() == 1.0;
    if let Some(point) = points.iter().find(|point| lossless(point)) {
        notes.push(format!(
            "restitution = 1 loses no energy in a frictionless impact: tosses may stay undecided \
             up to engine.{}.{}",
            engine_name(&point.engine),
            match point.engine {
                EngineChoice::Rapier(_) => "max_steps",
                _ => "max_impacts",
            }
        ));
    }
    if points.iter().any(rolls_for_ever) {
        notes.push(
            "surface.rolling_friction_m = 0: nothing stops a coin that rolls on its rim; tosses that roll from \
             face to side and back stay undecided, never_settles or up to engine.volumetric.max_steps"
                .to_owned(),
        );
    }
    let steps = |point: &Point| matches!(point.engine, EngineChoice::Rapier(_)) && !adhesive(point);
    if points.iter().any(steps) {
        notes.push(
            "engine.rapier: the intervals hold the chance of the tosses, not the error of the time \
             steps and of Rapier's impacts; docs/methods/rapier.md has measured it"
                .to_owned(),
        );
    }
    notes
}

fn adhesive(point: &Point) -> bool {
    point.scene.surface.landing() == Landing::Adhesive
}

/// A key of `[surface]`, and where its value is.
type Property = (&'static str, fn(&Surface) -> f64);

/// Properties of contacts where there are none.
fn in_vain(points: &[Point]) -> Option<String> {
    let properties: [Property; 5] = [
        ("restitution", Surface::restitution),
        ("friction", Surface::friction),
        ("rolling_friction_m", Surface::rolling_friction_m),
        ("pivoting_friction_m", Surface::pivoting_friction_m),
        (
            "restitution_threshold_m_s",
            Surface::restitution_threshold_m_s,
        ),
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

/// Whether a coin can roll without any loss.
fn rolls_for_ever(point: &Point) -> bool {
    let (scene, surface) = (&point.scene, &point.scene.surface);
    matches!(point.engine, EngineChoice::Volumetric(_))
        && !adhesive(point)
        && surface.friction() > 0.0
        && surface.rolling_friction_m() == 0.0
        && scene.drag().is_none()
}
