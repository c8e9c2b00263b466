//! The heat map of a plane.

use super::colour::viridis;
use super::{axis, frame, marks};
use crate::aim::{Aimed, Parameter, Place};
use crate::drawing::{Anchor, Canvas, LINE, Scale};
use crate::number::compact;

/// The bar of colours: its left edge and its width, px.
const BAR: [f64; 2] = [frame::LEFT + frame::WIDTH + 24.0, 18.0];
/// Stops of its gradient, which are those of the colours.
const STOPS: u32 = 10;

pub(super) fn draw(canvas: &mut Canvas, answer: &Aimed, parameters: [&Parameter; 2]) {
    let [x, y] = [(parameters[0], frame::X), (parameters[1], frame::Y)]
        .map(|(parameter, pixels)| axis(parameter, pixels));
    let p = answer.map.iter().map(|place| place.estimate.p);
    let colours = Scale::of_probabilities(p, frame::Y);
    let cell = [
        frame::WIDTH / parameters[0].values as f64,
        frame::HEIGHT / parameters[1].values as f64,
    ];
    let at = |place: &Place| [x.at(place.values[0]), y.at(place.values[1])];
    // without seams between the cells
    canvas.raw("<g shape-rendering=\"crispEdges\">");
    for place in &answer.map {
        let [x, y] = at(place);
        let fill = viridis(colours.share(place.estimate.p));
        let corner = [x - 0.5 * cell[0], y - 0.5 * cell[1]];
        canvas.rectangle(corner, cell, &format!("fill=\"{fill}\""));
    }
    canvas.raw("</g>");
    frame::draw(canvas, [&x, &y], [&parameters[0].key, &parameters[1].key]);
    bar(canvas, &colours, answer.question.face.name());
    marks(canvas, answer, |place| {
        let inside = x.holds(place.values[0]) && y.holds(place.values[1]);
        inside.then(|| at(place))
    });
}

/// The bar that says which colour is which probability.
fn bar(canvas: &mut Canvas, colours: &Scale, face: &str) {
    let [left, width] = BAR;
    canvas.raw("<linearGradient id=\"probability\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">");
    for stop in 0..=STOPS {
        let share = f64::from(stop) / f64::from(STOPS);
        canvas.raw(&format!(
            "<stop offset=\"{share}\" stop-color=\"{}\"/>",
            viridis(share)
        ));
    }
    canvas.raw("</linearGradient>");
    let style = format!("fill=\"url(#probability)\" stroke=\"{LINE}\"");
    canvas.rectangle([left, frame::TOP], [width, frame::HEIGHT], &style);
    for tick in colours.ticks() {
        let y = colours.at(tick);
        let right = left + width;
        canvas.line([right, y], [right + 5.0, y], &format!("stroke=\"{LINE}\""));
        canvas.label([right + 9.0, y + 4.0], Anchor::Start, &compact(tick));
    }
    canvas.label(
        [left, frame::TOP - 8.0],
        Anchor::Start,
        &format!("P({face})"),
    );
}
