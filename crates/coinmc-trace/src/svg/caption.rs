//! The captions above and below the picture.

use super::canvas::{Anchor, Canvas, FAINT, HEADS, LINE, SLIDING, STICKING, TAILS, TEXT};
use super::units::{digits, length, time};
use super::view::Shot;
use crate::record::Mode;
use crate::trace::Trace;
use coinmc_core::{Ended, Face, Landing};

/// The outcome and the parameters of the toss.
pub(super) fn head(canvas: &mut Canvas, trace: &Trace, left: f64) {
    canvas.label([left, 38.0], 22.0, Anchor::Start, TEXT, &outcome(trace));
    canvas.label([left, 60.0], 13.0, Anchor::Start, FAINT, &scene(trace));
}

/// "Heads, decided after 0.412 s and 7 impacts"
fn outcome(trace: &Trace) -> String {
    let adhesive = trace.scene.surface.landing() == Landing::Adhesive;
    let what = match trace.outcome.ended {
        Ended::Decided(face) => {
            let face = match face {
                Face::Heads => "Heads",
                Face::Tails => "Tails",
                Face::Side => "On its side",
            };
            let how = if adhesive {
                "by the first contact"
            } else {
                "decided"
            };
            format!("{face}, {how}")
        }
        Ended::Left => "Left the table".to_owned(),
        Ended::NeverSettles => "Proven never to settle".to_owned(),
        Ended::TimeLimit => "Undecided at the limit of time".to_owned(),
        Ended::ImpactLimit => "Undecided at the limit of impacts".to_owned(),
        Ended::Failed => "Failed: not a number".to_owned(),
    };
    let end = trace.records.last().map(|record| record.state.time_s);
    let when = end
        .filter(|end| end.is_finite())
        .map_or(String::new(), |end| format!(" after {}", time(end)));
    let impacts = match trace.outcome.impacts {
        0 => String::new(),
        1 => " and 1 impact".to_owned(),
        n => format!(" and {n} impacts"),
    };
    format!("{what}{when}{impacts}")
}

fn scene(trace: &Trace) -> String {
    let (coin, surface) = (&trace.scene.coin, &trace.scene.surface);
    let mut parts = vec![
        format!("H/R {}", digits(coin.ratio())),
        format!("R {}", length(coin.radius_m())),
    ];
    if surface.landing() == Landing::Bouncing {
        parts.push(format!("e {}", digits(surface.restitution())));
        parts.push(format!("μ {}", digits(surface.friction())));
    }
    let launch = &trace.launch;
    parts.push(format!("from {}", length(launch.height_m)));
    let turns = launch.spin_rad_s.norm() / std::f64::consts::TAU;
    parts.push(format!("{} turns per second", digits(turns)));
    parts.push(format!("{} engine", trace.engine));
    parts.push(format!("point {}, toss {}", trace.point, trace.toss));
    if trace.samples_until_s.is_some() || trace.events_until_s.is_some() {
        parts.push("not recorded to its end".to_owned());
    }
    parts.join("  ·  ")
}

/// Explains the colours and marks; of the modes of contact only those that occur.
pub(super) fn legend(canvas: &mut Canvas, shots: &[Shot], left: f64, y: f64) {
    let mut x = left;
    let mut label = |canvas: &mut Canvas, text: &str, width: f64| {
        canvas.label([x + 20.0, y], 12.0, Anchor::Start, TEXT, text);
        let at = x;
        x += 20.0 + width;
        at
    };
    for (colour, name) in [(HEADS, "heads"), (TAILS, "tails")] {
        let at = label(canvas, name, 52.0);
        canvas.rectangle([at, y - 10.0], [13.0, 11.0], &format!("fill=\"{colour}\""));
    }
    let at = label(canvas, "path of the centre", 126.0);
    let style = format!("stroke=\"{LINE}\" stroke-width=\"1.2\"");
    canvas.line([at, y - 4.0], [at + 14.0, y - 4.0], &style);
    for (mode, colour, name, room) in [
        (Mode::Sticking, STICKING, "sticks or rolls", 104.0),
        (Mode::Sliding, SLIDING, "slides", 60.0),
    ] {
        if shots.iter().any(|shot| shot.mode == mode) {
            let at = label(canvas, name, room);
            canvas.rectangle([at, y - 8.0], [14.0, 7.0], &format!("fill=\"{colour}\""));
        }
    }
    if shots.iter().any(Shot::is_impact) {
        let at = label(canvas, "impacts in order, larger if harder", 0.0);
        let style = format!("fill=\"{TEXT}\"");
        canvas.triangle([at + 7.0, y - 9.0], 9.0, &style);
    }
}
