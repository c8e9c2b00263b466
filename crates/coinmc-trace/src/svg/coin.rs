//! The coin as a cylinder in parallel projection.
//!
//! Its two faces are ellipses with the half axes R and R|u·eye|, displaced along the projection of
//! u. The half of its side next to heads is drawn in a pale shade of their colour, likewise for
//! tails, so that an upside-down coin is recognisable even from the edge.

use super::canvas::{Canvas, EDGE, HEADS, HEADS_PALE, TAILS, TAILS_PALE, px};
use coinmc_core::Coin;

/// A coin with fewer pixels across than this is a dot in the colour of the upper face.
const DOT: f64 = 5.0;

/// Draws a coin with its centre at `at`, px; `axis` is u to the right, up and towards the eye.
pub(super) fn draw(
    canvas: &mut Canvas,
    coin: &Coin,
    scale: f64,
    at: [f64; 2],
    axis: [f64; 3],
    opacity: f64,
) {
    let [across, up, towards] = axis;
    if 2.0 * scale * coin.rim_distance_m() < DOT {
        let colour = if up >= 0.0 { HEADS } else { TAILS };
        canvas.circle(
            at,
            2.2,
            &format!("fill=\"{colour}\" opacity=\"{}\"", px(opacity)),
        );
        return;
    }
    // in a frame whose y axis is the projection of u, pointing away from the eye's face
    let shown = if towards >= 0.0 { 1.0 } else { -1.0 };
    let (near, far) = if towards >= 0.0 {
        ([HEADS, HEADS_PALE], [TAILS, TAILS_PALE])
    } else {
        ([TAILS, TAILS_PALE], [HEADS, HEADS_PALE])
    };
    let length = (across * across + up * up).sqrt();
    let angle = if length > 0.0 {
        libm::atan2(shown * across, shown * up).to_degrees()
    } else {
        0.0
    };
    let radius = scale * coin.radius_m();
    let minor = radius * towards.abs();
    let half = 0.5 * scale * coin.height_m() * length;
    let [x, y] = at;
    // SVG's y axis points down: the near face lies at −half
    canvas.raw(&format!(
        "<g transform=\"translate({} {}) rotate({})\" opacity=\"{}\" stroke=\"{EDGE}\" stroke-width=\"0.6\">",
        px(x),
        px(y),
        px(angle),
        px(opacity)
    ));
    canvas.raw(&tube(radius, minor, half, 0.0, far[1]));
    canvas.raw(&rim(radius, minor, half, far[0]));
    canvas.raw(&tube(radius, minor, 0.0, -half, near[1]));
    canvas.raw(&face(radius, minor, -half, near[0]));
    canvas.raw("</g>");
}

/// The side from `low` (down the picture, seen from outside) to `high`.
fn tube(radius: f64, minor: f64, low: f64, high: f64, fill: &str) -> String {
    let [r, m, low, high] = [radius, minor, low, high].map(px);
    format!(
        "<path d=\"M-{r} {high}L-{r} {low}A{r} {m} 0 0 0 {r} {low}L{r} {high}A{r} {m} 0 0 1 -{r} {high}Z\" fill=\"{fill}\"/>"
    )
}

/// The visible half of the far face's rim.
fn rim(radius: f64, minor: f64, low: f64, colour: &str) -> String {
    let [r, m, low, width] = [radius, minor, low, stroke(radius)].map(px);
    format!(
        "<path d=\"M-{r} {low}A{r} {m} 0 0 0 {r} {low}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
    )
}

/// The near face; seen from the edge it is a line, where an ellipse would be invisible.
fn face(radius: f64, minor: f64, high: f64, colour: &str) -> String {
    let [r, m, high, width] = [radius, minor, high, stroke(radius)].map(px);
    format!(
        "<path d=\"M-{r} {high}A{r} {m} 0 0 1 {r} {high}A{r} {m} 0 0 1 -{r} {high}Z\" fill=\"{colour}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
    )
}

/// Width of the line along a face's rim, enough to show its colour seen from the edge.
fn stroke(radius: f64) -> f64 {
    (0.08 * radius).clamp(1.0, 3.0)
}
