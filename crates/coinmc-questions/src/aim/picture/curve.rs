//! The curve along one parameter, with the band of its intervals.

use super::{axis, frame, marks};
use crate::aim::{Aimed, Place};
use crate::drawing::{Canvas, Scale};

/// The blue of Okabe & Ito (2008), which colour-blind readers tell from the marks.
const LINE: &str = "fill=\"none\" stroke=\"#0072b2\" stroke-width=\"2\"";
const BAND: &str = "fill=\"#9ccbe6\" stroke=\"none\"";

pub(super) fn draw(canvas: &mut Canvas, answer: &Aimed) {
    let parameter = &answer.question.parameters[0];
    let x = axis(parameter, frame::X);
    let final_ones = [&answer.best, &answer.worst, &answer.baseline];
    let ends = answer.map.iter().chain(final_ones);
    let ends = ends.flat_map(|place| [place.estimate.lo, place.estimate.hi]);
    let y = Scale::of_probabilities(ends, frame::Y);
    let along = |p: fn(&Place) -> f64| -> Vec<[f64; 2]> {
        let point = |place: &Place| [x.at(place.values[0]), y.at(p(place))];
        answer.map.iter().map(point).collect()
    };
    let mut band = along(|place| place.estimate.lo);
    band.extend(along(|place| place.estimate.hi).into_iter().rev());
    canvas.points("polygon", &band, BAND);
    canvas.points("polyline", &along(|place| place.estimate.p), LINE);
    let name = format!("P({})", answer.question.face.name());
    frame::draw(canvas, [&x, &y], [&parameter.key, &name]);
    for place in final_ones
        .into_iter()
        .filter(|place| x.holds(place.values[0]))
    {
        let at = x.at(place.values[0]);
        let [low, high] = [place.estimate.lo, place.estimate.hi].map(|p| y.at(p));
        canvas.line(
            [at, low],
            [at, high],
            "stroke=\"#000000\" stroke-width=\"2\"",
        );
    }
    marks(canvas, answer, |place| {
        let inside = x.holds(place.values[0]);
        inside.then(|| [x.at(place.values[0]), y.at(place.estimate.p)])
    });
}
