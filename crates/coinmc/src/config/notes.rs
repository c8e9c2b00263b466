//! Remarks that are no problems: something given that changes nothing, or that may surprise.

use super::form::Form;
use crate::plan::{EngineChoice, Point};
use coinmc_core::Landing;

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
    let adhesive = |point: &Point| point.scene.surface.landing() == Landing::Adhesive;
    let counts = |point: &Point| {
        let surface = &point.scene.surface;
        adhesive(point) && (surface.restitution() != 0.0 || surface.friction() != 0.0)
    };
    if points.iter().any(counts) {
        notes.push(
            "surface.restitution and surface.friction change nothing: with landing = \"adhesive\" \
             the first contact decides"
                .to_owned(),
        );
    }
    let lossless = |point: &Point| !adhesive(point) && point.scene.surface.restitution() == 1.0;
    if points.iter().any(lossless) {
        notes.push(
            "restitution = 1 loses no energy in a frictionless impact: tosses may stay undecided \
             up to engine.flat.max_impacts"
                .to_owned(),
        );
    }
    notes
}
