//! What was designed, as text.

use super::super::other_size::OtherSize;
use crate::terminal::table::{Column, Table};
use crate::terminal::with_interval;
use crate::terminal::{Colors, Style, compact, decimals_that_show, grouped, in_ascii, wrapped};
use coinmc_questions::scenes::but_with;
use coinmc_questions::{Designed, Root, TEST, THICKNESS_ERRORS_M};
use coinmc_solid::{Infill, Shape};
use std::path::PathBuf;

/// The design as text. `told` is the diameter that the config gives, m; `infill` was asked for.
pub(super) fn text(
    designed: &Designed,
    told: Option<f64>,
    infill: Option<Infill>,
    paths: &[PathBuf],
    style: &Style,
) -> String {
    let Designed {
        root, shape, mass, ..
    } = designed;
    let (diameter, thickness) = (1e3 * shape.diameter_m(), 1e3 * shape.thickness_m());
    let error = 1e3 * root.half_width() * root.coin.radius_m();
    let arm = root.half_width();
    let (of_length, of_ratio) = (decimals_that_show(error, 2), decimals_that_show(arm, 3));
    let title = format!(
        "{diameter:.2} mm in diameter, {thickness:.of_length$} ± {error:.of_length$} mm thick \
         (H/R = {:.of_ratio$} ± {arm:.of_ratio$}), {} g",
        root.value,
        compact((1e6 * mass.mass_kg).round() / 1e3)
    );
    let mut text = format!("{}\n", style.paint(Colors::Strong, &title));
    let other = told.map(|told_m| OtherSize {
        asked: "diameter",
        told_m,
    });
    text += &other.map_or(String::new(), |other| other.remark(shape.diameter_m()));
    if let Some(scene) = designed.scene {
        let but = but_with(&designed.overrides);
        let line = format!("for the scene {}: {}{but}", scene.name, scene.doc);
        text += &wrapped(&line, style.width, 0);
    }
    text += &shortcomings(root, designed.fair.question.half_width);
    text += &infill.map_or(String::new(), |infill| solid(shape, infill));
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

/// That walls are so thick that there is nothing to fill.
fn solid(shape: &Shape, infill: Infill) -> String {
    if infill.leaves_a_core(shape) {
        return String::new();
    }
    format!(
        "the infill changes nothing: walls of {} mm leave no core in this coin\n",
        compact(1e3 * infill.walls_m)
    )
}

/// That the ratio is not known as well as asked for, and that tosses are undecided.
fn shortcomings(root: &Root, half_width: f64) -> String {
    let mut text = String::new();
    if !root.reached {
        text += &format!(
            "short of the half width asked for, H/R ± {}: the thickness may be further off\n",
            compact(half_width)
        );
    }
    if root.undecided > 0 {
        text += &format!(
            "undecided: {} of {} tosses; the interval allows for any face of these tosses\n",
            grouped(root.undecided),
            grouped(root.tosses)
        );
    }
    text
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
    use super::{shortcomings, solid};
    use coinmc_core::Coin;
    use coinmc_questions::Root;
    use coinmc_solid::{Edge, Infill, Shape};

    #[test]
    fn why_the_thickness_is_not_known_as_asked_is_told() {
        let root = Root {
            value: 1.0,
            lo: Some(0.7),
            hi: Some(1.3),
            slope: 0.3,
            slope_error: 0.01,
            reached: true,
            tosses: 8000,
            undecided: 0,
            rounds: vec![],
            numerical: None,
            coin: Coin::cylinder(1.0, 0.01).expect("a coin"),
        };
        assert_eq!(shortcomings(&root, 0.1), "");
        let short = Root {
            reached: false,
            undecided: 2500,
            ..root
        };
        let text = shortcomings(&short, 0.1);
        assert!(
            text.starts_with("short of the half width asked for, H/R ± 0.1"),
            "{text}"
        );
        assert!(
            text.contains("\nundecided: 2 500 of 8 000 tosses"),
            "{text}"
        );
    }

    #[test]
    fn walls_that_leave_no_core_are_told() {
        let shape = Shape::new(0.024, 0.012, Edge::Sharp).expect("a shape");
        let of = |walls_m| {
            let density_fraction = 0.2;
            solid(
                &shape,
                Infill {
                    walls_m,
                    density_fraction,
                },
            )
        };
        assert_eq!(of(0.005), "");
        assert_eq!(
            of(0.006),
            "the infill changes nothing: walls of 6 mm leave no core in this coin\n"
        );
    }
}
