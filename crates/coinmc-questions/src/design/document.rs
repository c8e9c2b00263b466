//! A design as a JSON document.

use super::{Designed, TEST, THICKNESS_ERRORS_M};
use crate::document::FORMAT_VERSION;
use coinmc::config::Override;
use coinmc_core::Estimate;
use serde_json::{Value, json};

/// A design as a JSON document, but for the names of its files. docs/reference/formats.md describes its
/// fields.
pub fn document_of_design(designed: &Designed) -> Value {
    let Designed {
        root, shape, mass, ..
    } = designed;
    let tolerances = THICKNESS_ERRORS_M.map(|off| {
        let change = designed.change(off);
        json!({
            "thickness_error_m": off,
            "p_side_error": change,
            "tosses_to_tell": designed.tosses_to_tell(change),
        })
    });
    let estimate = |face: &Estimate| json!({ "p": face.p, "lo": face.lo, "hi": face.hi });
    let faces = designed.faces.as_ref().map(|faces| {
        json!({
            "heads": estimate(&faces.heads),
            "tails": estimate(&faces.tails),
            "tosses": faces.heads.n,
        })
    });
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "design",
        "scene": designed.scene.map(|scene| scene.name),
        "overrides": designed.overrides.iter().map(Override::text).collect::<Vec<_>>(),
        "target": designed.fair.question.target,
        "ratio": root.value,
        "ratio_lo": root.lo,
        "ratio_hi": root.hi,
        "half_width": designed.fair.question.half_width,
        "reached": root.reached,
        "tosses": root.tosses,
        "undecided": root.undecided,
        "confidence": designed.fair.confidence,
        "slope": root.slope,
        "diameter_m": shape.diameter_m(),
        "thickness_m": shape.thickness_m(),
        "draft_deg": shape.draft_deg(),
        "centre_of_mass_m": shape.centre_m(),
        "faces": faces,
        "volume_m3": shape.volume_m3(),
        "mass_kg": mass.mass_kg,
        "axial_moment_kg_m2": mass.axial_kg_m2,
        "transverse_moment_kg_m2": mass.transverse_kg_m2,
        "triangles": designed.mesh.triangles().len(),
        "tolerances": tolerances,
        "test": { "false_alarm": TEST.false_alarm, "power": TEST.power },
    })
}
