//! The sheet of a design: one page (A4, in millimetres) to print and keep with the coin.

use super::{CHANGES, Designed, TEST, THICKNESS_ERRORS_M};
use crate::drawing::escaped;
use crate::number::{compact, grouped};
use crate::scenes::changed;
use coinmc_solid::{Edge, Shape};

/// Left edge of the text, mm.
const LEFT: f64 = 20.0;
/// Height of a line, mm.
const LINE: f64 = 5.5;
/// Characters of what was changed of a scene.
const CHANGED: usize = 90;
/// Greatest size of a drawing, mm; larger coins are drawn smaller.
const DRAWN: f64 = 60.0;

/// A page that is filled from the top.
struct Page {
    svg: String,
    y: f64,
}

/// The sheet as SVG.
pub(super) fn svg(designed: &Designed) -> String {
    let mut page = Page {
        svg: "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"210mm\" height=\"297mm\" \
              viewBox=\"0 0 210 297\" font-family=\"sans-serif\" font-size=\"3.6\">\n\
              <rect width=\"210\" height=\"297\" fill=\"white\"/>\n"
            .to_owned(),
        y: 24.0,
    };
    page.title(designed.title());
    page.heads(designed);
    page.drawings(designed);
    page.tolerances(designed);
    page.test(designed);
    page.assumptions(designed);
    page.svg + "</svg>\n"
}

impl Page {
    fn add(&mut self, svg: &str) {
        self.svg.push_str(svg);
    }

    fn title(&mut self, text: &str) {
        let y = self.y;
        self.add(&format!(
            "<text x=\"{LEFT}\" y=\"{y}\" font-size=\"7\">{}</text>\n",
            escaped(text)
        ));
        self.y += 2.0 * LINE;
    }

    fn heading(&mut self, text: &str) {
        self.y += 0.6 * LINE;
        let y = self.y;
        self.add(&format!(
            "<text x=\"{LEFT}\" y=\"{y:.1}\" font-weight=\"bold\">{}</text>\n",
            escaped(text)
        ));
        self.y += LINE;
    }

    fn row(&mut self, cells: &[(f64, String)]) {
        let y = self.y;
        for (x, cell) in cells {
            let x = LEFT + x;
            self.add(&format!(
                "<text x=\"{x}\" y=\"{y:.1}\">{}</text>\n",
                escaped(cell)
            ));
        }
        self.y += LINE;
    }

    fn line(&mut self, text: String) {
        self.row(&[(0.0, text)]);
    }

    fn heads(&mut self, designed: &Designed) {
        let (root, shape, mass) = (&designed.root, &designed.shape, &designed.mass);
        let target = designed.fair.question.target;
        let error = 1e3 * root.half_width() * root.coin.radius_m();
        let percent = compact(100.0 * designed.fair.confidence);
        self.line(format!(
            "Diameter {:.2} mm, thickness {:.2} ± {error:.2} mm ({percent} %), mass {:.2} g.",
            1e3 * shape.diameter_m(),
            1e3 * shape.thickness_m(),
            1e3 * mass.mass_kg
        ));
        self.line(match shape.edge() {
            Edge::Sharp if shape.draft_deg() != 0.0 => {
                let [heads, tails] = shape.face_radii_m().map(|radius| 2e3 * radius);
                let draft = compact(shape.draft_deg());
                format!(
                    "Conical edge of {draft}°: heads {heads:.2} mm wide, tails {tails:.2} mm. Sharp rims."
                )
            }
            Edge::Sharp => "Sharp rims.".to_owned(),
            Edge::Rounded { radius_m } => {
                format!("Rims rounded with {} mm.", compact(1e3 * radius_m))
            }
            Edge::Chamfered { size_m } => format!(
                "Rims cut at 45° by {} mm; the answer is that of rims rounded with as much.",
                compact(1e3 * size_m)
            ),
        });
        self.line(format!(
            "It comes to rest on its side with P = {:.4}, H/R = {:.3} ± {:.3}, of {} tosses.",
            target,
            root.value,
            root.half_width(),
            grouped(root.tosses)
        ));
        if let Some(faces) = &designed.faces {
            let [heads, tails] = [faces.heads, faces.tails]
                .map(|face| format!("{:.3} ± {:.3}", face.p, face.half_width()));
            self.line(format!(
                "P(heads) = {heads}, P(tails) = {tails}: its faces are not alike at any thickness."
            ));
        }
        self.line(match designed.scene {
            Some(scene) => format!(
                "Tossed by hand, from {} m above {}.",
                scene.height_m, scene.doc
            ),
            None => "Tossed as its config says.".to_owned(),
        });
        if designed.scene.is_some() && !designed.overrides.is_empty() {
            // longer lists would leave the page
            let changed: String = changed(&designed.overrides).chars().take(CHANGED).collect();
            self.line(format!("But with {changed}."));
        }
    }

    /// The coin from above and from the side.
    fn drawings(&mut self, designed: &Designed) {
        let shape = &designed.shape;
        let (diameter, thickness) = (1e3 * shape.diameter_m(), 1e3 * shape.thickness_m());
        let scale = (DRAWN / diameter.max(thickness)).min(1.0);
        let (d, t, edge) = (
            scale * diameter,
            scale * thickness,
            1e3 * scale * shape.edge().size_m(),
        );
        let [heads, tails] = shape.face_radii_m();
        let inner = if shape.draft_deg() == 0.0 {
            (0.5 * d - edge).max(0.0)
        } else {
            1e3 * scale * heads.min(tails)
        };
        let (x, y) = (LEFT + 0.5 * d, self.y + 4.0 + 0.5 * d.max(t));
        let (side, middle) = (LEFT + d + 20.0, y);
        self.add(&format!(
            "<g fill=\"none\" stroke=\"black\" stroke-width=\"0.3\">\n\
             <circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{:.2}\"/>\n\
             <circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{:.2}\" stroke-width=\"0.1\"/>\n",
            0.5 * d,
            inner
        ));
        if let Some(marks) = shape.marks() {
            for radius in [marks.inner_m, marks.outer_m] {
                let r = 1e3 * scale * radius;
                self.add(&format!(
                    "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r:.2}\" stroke-dasharray=\"1\" stroke-width=\"0.15\"/>\n"
                ));
            }
        }
        self.add(&from_the_side(shape, scale, [side, middle]));
        self.y = y + 0.5 * d.max(t) + LINE;
        let drawn = if scale < 1.0 {
            format!("drawn at {scale:.2} of its size")
        } else {
            "drawn in its size, if printed without scaling".to_owned()
        };
        self.row(&[(0.0, format!("from above and from the side, {drawn}"))]);
    }

    fn tolerances(&mut self, designed: &Designed) {
        self.heading("Printed too thick or too thin");
        for off in THICKNESS_ERRORS_M {
            let change = designed.change(off).abs();
            self.row(&[
                (0.0, format!("± {} mm", compact(1e3 * off))),
                (30.0, format!("P(side) ± {change:.4}")),
            ]);
        }
    }

    fn test(&mut self, designed: &Designed) {
        self.heading("Tosses that test it");
        self.line(format!(
            "χ² test of heads, tails and side, rejected at {} %; to find a wrong coin with {} %:",
            compact(100.0 * TEST.false_alarm),
            compact(100.0 * TEST.power)
        ));
        for change in CHANGES {
            let tosses = grouped(designed.tosses_to_tell(change));
            self.row(&[
                (0.0, format!("P(side) off by {change}")),
                (50.0, format!("{tosses} tosses")),
            ]);
        }
    }

    /// How far fairness depends on how the coin is tossed, and on what.
    fn assumptions(&mut self, designed: &Designed) {
        if designed.effects.is_empty() {
            return;
        }
        self.heading("What the answer rests on");
        let columns = [0.0, 72.0, 92.0, 125.0];
        let ratio = if designed.is_for_a_third() {
            "a fair coin has H/R"
        } else {
            "the coin has H/R"
        };
        let titles = ["", "assumed", "if it were", ratio];
        let row = |cells: [String; 4]| columns.into_iter().zip(cells).collect::<Vec<_>>();
        self.row(&row(titles.map(str::to_owned)));
        for effect in &designed.effects {
            let (assumed, [low, high]) = (&effect.assumption, &effect.roots);
            self.row(&row([
                assumed.name.to_owned(),
                compact(assumed.value),
                format!("{} to {}", short(assumed.low), short(assumed.high)),
                format!(
                    "{:.2} to {:.2} (± {:.2})",
                    low.value,
                    high.value,
                    low.half_width.max(high.half_width)
                ),
            ]));
        }
    }
}

/// The outline of the coin, heads up, whose side begins at `left` and is drawn around the height `middle`.
fn from_the_side(shape: &Shape, scale: f64, [left, middle]: [f64; 2]) -> String {
    let d = 1e3 * scale * shape.diameter_m();
    let t = 1e3 * scale * shape.thickness_m();
    let (top, bottom) = (middle - 0.5 * t, middle + 0.5 * t);
    if shape.draft_deg() != 0.0 {
        let axis = left + 0.5 * d;
        let [heads, tails] = shape.face_radii_m().map(|radius| 1e3 * scale * radius);
        return format!(
            "<polygon points=\"{:.2},{top:.2} {:.2},{top:.2} {:.2},{bottom:.2} {:.2},{bottom:.2}\"/>\n</g>\n",
            axis - heads,
            axis + heads,
            axis + tails,
            axis - tails
        );
    }
    let round = match shape.edge() {
        Edge::Rounded { radius_m } => 1e3 * scale * radius_m,
        _ => 0.0,
    };
    format!(
        "<rect x=\"{left:.2}\" y=\"{top:.2}\" width=\"{d:.2}\" height=\"{t:.2}\" rx=\"{round:.2}\"/>\n</g>\n"
    )
}

/// To three digits.
fn short(x: f64) -> String {
    compact(format!("{x:.2e}").parse().unwrap_or(x))
}
