//! The frame around a plot, with its ticks and labels.

use crate::drawing::{Anchor, Canvas, LINE, Scale};
use crate::number::compact;

/// The whole picture, px.
pub(super) const SIZE: [f64; 2] = [720.0, 560.0];
/// The plot within it, px.
pub(super) const LEFT: f64 = 84.0;
pub(super) const TOP: f64 = 84.0;
pub(super) const WIDTH: f64 = 520.0;
pub(super) const HEIGHT: f64 = 420.0;

/// Where the x axis begins and ends, and the y axis.
pub(super) const X: [f64; 2] = [LEFT, LEFT + WIDTH];
pub(super) const Y: [f64; 2] = [TOP + HEIGHT, TOP];

/// Draws the frame of a plot with the names of both axes.
pub(super) fn draw(canvas: &mut Canvas, [x, y]: [&Scale; 2], names: [&str; 2]) {
    let style = format!("stroke=\"{LINE}\"");
    canvas.rectangle(
        [LEFT, TOP],
        [WIDTH, HEIGHT],
        &format!("fill=\"none\" {style}"),
    );
    let bottom = TOP + HEIGHT;
    for tick in x.ticks() {
        let at = x.at(tick);
        canvas.line([at, bottom], [at, bottom + 5.0], &style);
        canvas.label([at, bottom + 19.0], Anchor::Middle, &compact(tick));
    }
    for tick in y.ticks() {
        let at = y.at(tick);
        canvas.line([LEFT - 5.0, at], [LEFT, at], &style);
        canvas.label([LEFT - 9.0, at + 4.0], Anchor::End, &compact(tick));
    }
    canvas.label(
        [LEFT + 0.5 * WIDTH, bottom + 42.0],
        Anchor::Middle,
        names[0],
    );
    canvas.upright_label([18.0, TOP + 0.5 * HEIGHT], names[1]);
}
