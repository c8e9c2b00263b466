//! A ranking as a picture: a tornado.

use super::{Ranked, Ranking};
use crate::drawing::{Anchor, Canvas, LINE, Scale};
use crate::number::compact;

/// Where the bars begin and end, and the widths of the texts on either side, px.
const X: [f64; 2] = [330.0, 730.0];
const INDEX: f64 = 752.0;
const WIDTH: f64 = 900.0;
/// The first bar, the distance from one to the next, and their thickness, px.
const TOP: f64 = 92.0;
const ROW: f64 = 30.0;
const BAR: f64 = 16.0;
/// Blue and vermilion of Okabe & Ito (2008), which colour-blind readers tell apart.
const TO_FROM: &str = "fill=\"#56b4e9\"";
const TO_TO: &str = "fill=\"#d55e00\"";
const WHISKER: &str = "stroke=\"#000000\" stroke-width=\"1.5\"";

/// The answer to a [`Rank`](super::Rank) as SVG: a tornado plot.
///
/// A bar for each unknown, in the order of the ranking, leads from the face's probability at one end of
/// its range to that at the other: blue to the lower end of the range, red to the upper, the others as
/// the config has them. Beside it stands its total index.
pub fn picture_of_ranking(ranking: &Ranking) -> String {
    let numbers = &ranking.numbers;
    let bottom = TOP + ROW * numbers.len() as f64;
    let mut canvas = Canvas::new([WIDTH, bottom + 64.0]);
    let ends = numbers
        .iter()
        .flat_map(|ranked| ranked.ends.iter().flat_map(|end| [end.lo, end.hi]));
    let x = Scale::of_probabilities(ends.chain([ranking.p.lo, ranking.p.hi]), X);
    title(&mut canvas, ranking);
    axis(&mut canvas, &x, bottom, ranking);
    for (index, ranked) in numbers.iter().enumerate() {
        bar(
            &mut canvas,
            &x,
            TOP + ROW * (index as f64 + 0.5),
            ranking.p.p,
            ranked,
        );
    }
    let own = x.at(ranking.p.p);
    canvas.line([own, TOP - 6.0], [own, bottom], "stroke=\"#333333\"");
    canvas.finish()
}

fn title(canvas: &mut Canvas, ranking: &Ranking) {
    let title = format!(
        "P({}) over the range of each unknown; engine {}, {}; intervals of {} %",
        ranking.question.face.name(),
        ranking.engine,
        ranking.law,
        compact(100.0 * ranking.confidence)
    );
    canvas.label([20.0, 24.0], Anchor::Start, &title);
    let (mean, deviation) = (ranking.mean.value, ranking.deviation.value);
    let all = format!("all of them unknown: mean {mean:.3}, standard deviation {deviation:.3}");
    canvas.label([20.0, 42.0], Anchor::Start, &all);
    for (left, colour, text) in [
        (20.0, TO_FROM, "lower end of the range"),
        (200.0, TO_TO, "upper end"),
    ] {
        canvas.rectangle([left, 54.0], [12.0, 12.0], colour);
        canvas.label([left + 18.0, 64.0], Anchor::Start, text);
    }
    canvas.label([INDEX, 64.0], Anchor::Start, "total index");
}

fn axis(canvas: &mut Canvas, x: &Scale, bottom: f64, ranking: &Ranking) {
    canvas.line(
        [X[0], bottom],
        [X[1], bottom],
        &format!("stroke=\"{LINE}\""),
    );
    for tick in x.ticks() {
        let at = x.at(tick);
        canvas.line([at, TOP], [at, bottom], "stroke=\"#e0e0e0\"");
        canvas.label([at, bottom + 19.0], Anchor::Middle, &compact(tick));
    }
    let name = format!("P({})", ranking.question.face.name());
    canvas.label([0.5 * (X[0] + X[1]), bottom + 42.0], Anchor::Middle, &name);
}

fn bar(canvas: &mut Canvas, x: &Scale, middle: f64, own: f64, ranked: &Ranked) {
    let unknown = &ranked.unknown;
    canvas.label(
        [X[0] - 12.0, middle - 2.0],
        Anchor::End,
        short(&unknown.key),
    );
    let range = format!("{} to {}", compact(unknown.from), compact(unknown.to));
    canvas.label([X[0] - 12.0, middle + 11.0], Anchor::End, &range);
    for (end, colour) in ranked.ends.iter().zip([TO_FROM, TO_TO]) {
        let [left, right] = [own.min(end.value), own.max(end.value)].map(|p| x.at(p));
        canvas.rectangle([left, middle - 0.5 * BAR], [right - left, BAR], colour);
    }
    for end in &ranked.ends {
        let [low, high] = [end.lo, end.hi].map(|p| x.at(p));
        canvas.line([low, middle], [high, middle], WHISKER);
    }
    if let Some(total) = &ranked.total {
        let text = format!("{:.2} ± {:.2}", total.value, total.half_width());
        canvas.label([INDEX, middle + 4.0], Anchor::Start, &text);
    }
}

/// The end of a key that has room: its last 44 characters, from a dot on.
fn short(key: &str) -> &str {
    const ROOM: usize = 44;
    if key.len() <= ROOM {
        return key;
    }
    let tail = key
        .char_indices()
        .rev()
        .nth(ROOM - 1)
        .map_or(0, |(at, _)| at);
    key[tail..]
        .find('.')
        .map_or(&key[tail..], |dot| &key[tail + dot + 1..])
}
