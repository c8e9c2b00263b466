//! An answer as a picture: a heat map of a plane, or a curve along one parameter.

mod colour;
mod curve;
mod frame;
mod heat;

use super::{Aimed, Parameter, Place};
use crate::drawing::{Anchor, Canvas, Scale};
use crate::number::compact;
use coinmc_core::Estimate;

/// The answer to an [`Aim`](super::Aim) as SVG.
///
/// With two parameters a heat map of the plane, the first parameter along x: its colours are those
/// of viridis, lighter where the face is more likely. With one parameter a curve with the band of
/// its intervals. The map is that of the first tosses; the numbers in the text are those of the
/// final tosses. A white dot marks the best place, a black one the worst, and a cross the config's
/// own launch where it lies in the plane.
///
/// # Example
/// ```
/// # use coinmc_core::Face;
/// # use coinmc_questions::{Aim, Parameter, Template, Workers, aim};
/// # use std::sync::atomic::AtomicBool;
/// use coinmc_questions::picture;
/// # let text = "coin.ratio = 1.0\nsurface = { restitution = 0.5, friction = 0.3 }\n\
/// #             launch.preset = 'robot'\nengine.flat = {}";
/// # let key = "launch.height_m".to_owned();
/// # let parameters = vec![Parameter { key, from: 0.1, to: 0.5, values: 3 }];
/// # let question =
/// #     Aim { face: Face::Side, parameters, tosses: 64, final_tosses: 64, clumsiness: vec![] };
/// # let cancel = AtomicBool::new(false);
/// # let workers = Workers { threads: None, cancel: &cancel, made: &|_| () };
/// # let template = Template::new("inline", text, &[]);
/// let answer = aim(&template, &question, &workers)?;
/// let svg = picture(&answer);
/// assert!(svg.starts_with("<svg") && svg.contains("launch.height_m"));
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
pub fn picture(answer: &Aimed) -> String {
    let mut canvas = Canvas::new(frame::SIZE);
    text(&mut canvas, answer);
    if let [x, y] = &answer.question.parameters[..] {
        heat::draw(&mut canvas, answer, [x, y]);
    } else {
        curve::draw(&mut canvas, answer);
    }
    canvas.finish()
}

/// The axis of a parameter.
fn axis(parameter: &Parameter, pixels: [f64; 2]) -> Scale {
    Scale::of_values(parameter.span(), parameter.values, pixels)
}

/// What was found, in words.
fn text(canvas: &mut Canvas, answer: &Aimed) {
    let face = answer.question.face.name();
    let title = format!(
        "P({face}) by launch; engine {}, {}; intervals of {} %",
        answer.engine,
        answer.law,
        compact(100.0 * answer.confidence)
    );
    let line = |mark: &str, what: &str, place: &Place| {
        let values: Vec<String> = place.values.iter().map(|value| compact(*value)).collect();
        let (p, at) = (probability(&place.estimate), values.join(", "));
        format!("{mark} {what}: {p} at ({at})")
    };
    let lines = [
        title,
        line("○", "most likely", &answer.best),
        line("●", "least likely", &answer.worst),
        line("×", "own launch", &answer.baseline),
    ];
    for (index, line) in lines.iter().enumerate() {
        let y = 20.0 + 16.0 * index as f64;
        canvas.label([frame::LEFT, y], Anchor::Start, line);
    }
}

/// A probability and its interval, with as many digits as it is worth.
fn probability(estimate: &Estimate) -> String {
    let digits = if estimate.half_width() < 0.002 { 4 } else { 3 };
    let Estimate { p, lo, hi, .. } = estimate;
    format!("{p:.digits$} ({lo:.digits$} to {hi:.digits$})")
}

/// Marks of the best place, the worst, and the config's own launch where it is in the picture; `at`
/// gives the point of a place.
fn marks(canvas: &mut Canvas, answer: &Aimed, at: impl Fn(&Place) -> Option<[f64; 2]>) {
    const OWN: [&str; 2] = [
        "stroke=\"#ffffff\" stroke-width=\"5\"",
        "stroke=\"#000000\" stroke-width=\"2\"",
    ];
    if let Some(point) = at(&answer.baseline) {
        for style in OWN {
            canvas.cross(point, 5.0, style);
        }
    }
    if let Some(point) = at(&answer.worst) {
        canvas.circle(
            point,
            6.0,
            "fill=\"#000000\" stroke=\"#ffffff\" stroke-width=\"2\"",
        );
    }
    if let Some([x, y]) = at(&answer.best) {
        canvas.circle(
            [x, y],
            6.0,
            "fill=\"#ffffff\" stroke=\"#000000\" stroke-width=\"2\"",
        );
        let left = x < frame::LEFT + 0.5 * frame::WIDTH;
        let (anchor, shift) = if left {
            (Anchor::Start, 12.0)
        } else {
            (Anchor::End, -12.0)
        };
        // below the top of the frame, where a label would cover other text
        let y = (y + 4.0).max(frame::TOP + 14.0);
        canvas.label([x + shift, y], anchor, &probability(&answer.best.estimate));
    }
}

#[cfg(test)]
mod tests;
