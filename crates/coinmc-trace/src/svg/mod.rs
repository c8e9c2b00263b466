//! A picture of a toss: a side view with the coin at equal time steps and marks at impacts.
//!
//! A toss can be a thousand times as high as the coin is wide. If that makes the coin too small to
//! see, a second panel magnifies the end of the toss. A picture depends only on the trace.

mod canvas;
mod caption;
mod coin;
mod impacts;
mod panel;
mod strobe;
mod units;
mod view;
mod window;

use crate::trace::Trace;
use canvas::Canvas;
use panel::{Area, Panel};
use std::io::{self, Write};
use view::View;
use window::Window;

/// Width of the picture, margins and the spaces between its parts, px.
const WIDTH: f64 = 960.0;
const MARGIN: f64 = 28.0;
const HEAD: f64 = 104.0;
const FOOT: f64 = 44.0;
const GAP: f64 = 30.0;
/// If the coin is smaller than this, px, a second panel magnifies the end.
const SMALL: f64 = 44.0;
/// Width of the magnified window, in units of the coin's largest extent.
const MAGNIFIED: f64 = 9.0;

/// Writes a trace as an SVG picture: a side view in the plane of the toss (for tosses in space the
/// vertical plane through its horizontal displacement).
///
/// A trace without samples shows only its events. Heads are blue and tails are orange, from a
/// palette for colour-blind readers.
///
/// # Errors
/// Errors of `out`.
pub fn write(trace: &Trace, mut out: impl Write) -> io::Result<()> {
    out.write_all(picture(trace).as_bytes())
}

fn picture(trace: &Trace) -> String {
    let shots = View::of(trace).shots(trace);
    let size_m = 2.0 * trace.scene.coin.rim_distance_m();
    let Some(whole) = Window::around(&shots, size_m) else {
        // all positions are NaN: the caption explains it
        let mut canvas = Canvas::new(WIDTH, HEAD);
        caption::head(&mut canvas, trace, MARGIN);
        return canvas.finish();
    };
    let inner = WIDTH - 2.0 * MARGIN;
    let single = Area::fitting(&whole, [inner, 600.0]);
    let parts = if single.scale_of(&whole) * size_m >= SMALL {
        vec![(single.centred(MARGIN, inner), whole)]
    } else {
        let last = Window::last(&shots, MAGNIFIED * size_m, size_m);
        magnified(whole, last, inner)
    };
    let panels: Vec<Panel<'_>> = parts
        .into_iter()
        .map(|(area, window)| Panel::new(trace, area, window))
        .collect();
    let bottom = panels.iter().map(Panel::bottom).fold(0.0, f64::max);
    let mut canvas = Canvas::new(WIDTH, bottom + FOOT);
    caption::head(&mut canvas, trace, MARGIN);
    for panel in &panels {
        panel.draw(&mut canvas, &shots);
    }
    if let [first, second] = panels.as_slice() {
        first.name(&mut canvas, &shots, "the toss");
        let times = second.scale() / first.scale();
        second.name(
            &mut canvas,
            &shots,
            &format!("its end, magnified {times:.0} times"),
        );
        first.frame(&mut canvas, second);
    } else if let [only] = panels.as_slice() {
        only.name(&mut canvas, &shots, "");
    }
    caption::legend(&mut canvas, &shots, MARGIN, bottom + FOOT - 14.0);
    canvas.finish()
}

/// The whole toss and its end: in two columns if the toss is high, otherwise in two rows.
fn magnified(whole: Window, last: Window, inner: f64) -> Vec<(Area, Window)> {
    let (first, second) = if whole.height() > 0.75 * whole.width() {
        let left = Area::fitting(&whole, [0.36 * inner, 560.0])
            .at_least(200.0)
            .placed(MARGIN, HEAD);
        let right = Area::fitting(&last, [inner - left.width - GAP, 560.0]);
        let below = (left.height - right.height).max(0.0);
        let edge = MARGIN + inner - right.width;
        (left, right.placed(edge, HEAD + below))
    } else {
        let above = Area::fitting(&whole, [inner, 260.0]).centred(MARGIN, inner);
        let below = Area::fitting(&last, [inner, 420.0]).centred(MARGIN, inner);
        let top = above.top + above.height + GAP;
        (above, below.placed(below.left, top))
    };
    vec![(first, whole), (second, last)]
}

#[cfg(test)]
mod tests;
