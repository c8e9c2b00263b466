//! The coin in parallel projection: a cylinder, or the frustum of a cone.
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
    let ring = |radius_m: f64, distance_m: f64| Ring {
        radius: scale * radius_m,
        minor: scale * radius_m * towards.abs(),
        // SVG's y axis points down: the near face lies above the centre
        at: scale * distance_m * length,
    };
    let [near_rim, middle, far_rim] = rings(coin, towards >= 0.0).map(|[r, z]| ring(r, z));
    let [x, y] = at;
    canvas.raw(&format!(
        "<g transform=\"translate({} {}) rotate({})\" opacity=\"{}\" stroke=\"{EDGE}\" stroke-width=\"0.6\">",
        px(x),
        px(y),
        px(angle),
        px(opacity)
    ));
    canvas.raw(&tube(far_rim, middle, far[1]));
    canvas.raw(&rim(far_rim, far[0]));
    canvas.raw(&tube(middle, near_rim, near[1]));
    canvas.raw(&face(near_rim, near[0]));
    canvas.raw("</g>");
}

/// A circle about the axis: half axes of its picture, and where that is down the picture.
#[derive(Clone, Copy)]
struct Ring {
    radius: f64,
    minor: f64,
    at: f64,
}

/// Radius and place along the axis, from the centre of mass away from the eye, of the near face, the
/// middle of the side and the far face.
fn rings(coin: &Coin, heads_is_near: bool) -> [[f64; 2]; 3] {
    let [heads, tails] = coin.outer_rims();
    let (near, far) = if heads_is_near {
        (heads, tails)
    } else {
        (tails, heads)
    };
    let (near, far) = (
        [near.radius_m, -near.distance_m],
        [far.radius_m, far.distance_m],
    );
    [near, [0, 1].map(|i| 0.5 * (near[i] + far[i])), far]
}

/// The side from one ring to another further up the picture.
fn tube(from: Ring, to: Ring, fill: &str) -> String {
    let [r, m, low] = [from.radius, from.minor, from.at].map(px);
    let [to_r, to_m, high] = [to.radius, to.minor, to.at].map(px);
    format!(
        "<path d=\"M-{to_r} {high}L-{r} {low}A{r} {m} 0 0 0 {r} {low}L{to_r} {high}A{to_r} {to_m} 0 0 1 -{to_r} {high}Z\" fill=\"{fill}\"/>"
    )
}

/// The visible half of the far face's rim.
fn rim(ring: Ring, colour: &str) -> String {
    let [r, m, low, width] = [ring.radius, ring.minor, ring.at, stroke(ring.radius)].map(px);
    format!(
        "<path d=\"M-{r} {low}A{r} {m} 0 0 0 {r} {low}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
    )
}

/// The near face; seen from the edge it is a line, where an ellipse would be invisible.
fn face(ring: Ring, colour: &str) -> String {
    let [r, m, high, width] = [ring.radius, ring.minor, ring.at, stroke(ring.radius)].map(px);
    format!(
        "<path d=\"M-{r} {high}A{r} {m} 0 0 1 {r} {high}A{r} {m} 0 0 1 -{r} {high}Z\" fill=\"{colour}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
    )
}

/// Width of the line along a face's rim, enough to show its colour seen from the edge.
fn stroke(radius: f64) -> f64 {
    (0.08 * radius).clamp(1.0, 3.0)
}
