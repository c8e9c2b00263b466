//! What was designed, as text and as JSON.

use super::files::Written;
use super::{Designed, TEST};
use crate::output::FORMAT_VERSION;
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, grouped, in_ascii};
use serde_json::{Value, json};

/// Errors of the thickness that are spoken of, m.
pub(super) const ERRORS_M: [f64; 3] = [5e-5, 1e-4, 2e-4];
/// Errors of P(side) that a test is to find.
pub(super) const CHANGES: [f64; 4] = [0.02, 0.03, 0.05, 0.1];

/// The design as text.
pub(super) fn text(designed: &Designed, written: &Written, style: &Style) -> String {
    let Designed {
        root, shape, mass, ..
    } = designed;
    let (diameter, thickness) = (1e3 * shape.diameter_m(), 1e3 * shape.thickness_m());
    let error = 1e3 * root.half_width() * root.coin.radius_m();
    let title = format!(
        "{diameter:.2} mm in diameter, {thickness:.2} ± {error:.2} mm thick (H/R = {:.3} ± {:.3}), {} g",
        root.value,
        root.half_width(),
        compact((1e6 * mass.mass_kg).round() / 1e3)
    );
    let mut text = format!("{}\n", style.paint(Colors::Strong, &title));
    if let Some(scene) = designed.scene {
        text += &format!("for the scene {}: {}\n", scene.name, scene.doc);
    }
    let mut tolerance = Table::new(vec![
        Column::right("thickness off by"),
        Column::right("P(side) off by"),
        Column::right("tosses to tell"),
    ]);
    for off in ERRORS_M {
        let change = designed.change(off).abs();
        tolerance.push(vec![
            format!("{} mm", compact(1e3 * off)),
            format!("{change:.4}"),
            grouped(designed.tosses_to_tell(change)),
        ]);
    }
    text += &tolerance.render(style).text;
    text += &format!(
        "(χ² test of {} %, which finds such a coin with {} %)\n",
        compact(100.0 * TEST.false_alarm),
        compact(100.0 * TEST.power)
    );
    for path in &written.paths {
        text += &format!("wrote {}\n", path.display());
    }
    if style.unicode { text } else { in_ascii(&text) }
}

/// The design as JSON.
pub(super) fn document(designed: &Designed, written: &Written) -> Value {
    let Designed {
        root, shape, mass, ..
    } = designed;
    let tolerances = ERRORS_M.map(|off| {
        let change = designed.change(off);
        json!({
            "thickness_error_m": off,
            "p_side_error": change,
            "tosses_to_tell": designed.tosses_to_tell(change),
        })
    });
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "design",
        "scene": designed.scene.map(|scene| scene.name),
        "target": designed.fair.question.target,
        "ratio": root.value,
        "ratio_lo": root.lo,
        "ratio_hi": root.hi,
        "confidence": designed.fair.confidence,
        "slope": root.slope,
        "diameter_m": shape.diameter_m(),
        "thickness_m": shape.thickness_m(),
        "volume_m3": shape.volume_m3(),
        "mass_kg": mass.mass_kg,
        "axial_moment_kg_m2": mass.axial_kg_m2,
        "transverse_moment_kg_m2": mass.transverse_kg_m2,
        "triangles": written.triangles,
        "tolerances": tolerances,
        "test": { "false_alarm": TEST.false_alarm, "power": TEST.power },
        "files": written.paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
    })
}
