//! What was designed, as text.

use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, grouped, in_ascii, with_interval};
use coinmc_questions::{Designed, TEST, THICKNESS_ERRORS_M};
use std::path::PathBuf;

/// The design as text. `told` is the diameter that the config gives, m.
pub(super) fn text(
    designed: &Designed,
    told: Option<f64>,
    paths: &[PathBuf],
    style: &Style,
) -> String {
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
    text += &other_diameter(shape.diameter_m(), told);
    if let Some(scene) = designed.scene {
        text += &format!("for the scene {}: {}\n", scene.name, scene.doc);
    }
    text += &faces(designed);
    let mut tolerance = Table::new(vec![
        Column::right("thickness off by"),
        Column::right("P(side) off by"),
        Column::right("tosses to tell"),
    ]);
    for off in THICKNESS_ERRORS_M {
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
    for path in paths {
        text += &format!("wrote {}\n", path.display());
    }
    if style.unicode { text } else { in_ascii(&text) }
}

/// That the config gives another diameter than the coin has.
fn other_diameter(diameter_m: f64, told: Option<f64>) -> String {
    match told {
        Some(told) if (told / diameter_m - 1.0).abs() > 1e-9 => {
            format!(
                "(of the diameter asked for, not the config's {:.2} mm)\n",
                1e3 * told
            )
        }
        _ => String::new(),
    }
}

/// Heads and tails of a coin with a conical edge.
fn faces(designed: &Designed) -> String {
    let Some(faces) = &designed.faces else {
        return String::new();
    };
    let [heads, tails] = designed.shape.face_radii_m().map(|radius| 2e3 * radius);
    let [p_heads, p_tails] = [faces.heads, faces.tails].map(|face| with_interval(&face, 3, "±"));
    format!(
        "conical edge of {}°: heads (towards +z) {heads:.2} mm wide, tails {tails:.2} mm\n\
         P(heads) = {p_heads}, P(tails) = {p_tails}: faces of unequal width are not equally likely at \
         any thickness\n",
        compact(designed.shape.draft_deg())
    )
}

#[cfg(test)]
mod tests {
    use super::other_diameter;

    #[test]
    fn a_diameter_that_is_not_the_configs_is_told() {
        assert_eq!(other_diameter(0.024, None), "");
        assert_eq!(other_diameter(0.01, Some(2.0 * 0.005)), "");
        assert!(other_diameter(0.024, Some(0.01)).contains("config's 10.00 mm"));
    }
}
