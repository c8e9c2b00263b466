//! What progress says of a run.

use super::with_prefix;
use crate::terminal::{Style, compact, decimals_for, duration, tosses};
use coinmc::plan::Plan;
use coinmc::run::{Latest, Progress as Counts};
use std::time::Duration;

/// Tosses that this process has made, and the time they took.
#[derive(Debug, Clone, Copy)]
pub(super) struct Made {
    pub(super) tosses: u64,
    pub(super) time: Duration,
}

/// `12/76 points  1 234 567 tosses  812 k/s  P(side) 0.0731 [0.0715, 0.0747] at ratio 1  worst ±0.0012  34.0 s left`,
/// without what has no room in so many columns.
pub(super) fn message(
    counts: &Counts,
    made: Made,
    plan: Option<&Plan>,
    room: usize,
    style: &Style,
) -> String {
    let rate = made.tosses as f64 / made.time.as_secs_f64();
    // the first moments predict nothing
    let settled = made.tosses > 0 && made.time > Duration::from_millis(200);
    let left = || {
        let left = counts.tosses_planned.saturating_sub(counts.tosses_done) as f64 / rate;
        let left = Duration::try_from_secs_f64(left).unwrap_or(Duration::MAX);
        format!("{} left", duration(left))
    };
    let worst = counts.worst_half_width.filter(|_| counts.points > 1);
    let worst = worst.map(|arm| format!("worst {}{arm:.1e}", style.plus_minus()));
    let rate = settled.then(|| format!("{}/s", with_prefix(rate)));
    let probability = counts.latest.map(|latest| probability(&latest));
    let place = counts.latest.and_then(|latest| place(&latest, plan?));
    // with the order in which they go where there is no room; 0 stays
    let mut parts = vec![
        (
            3,
            Some(format!("{}/{} points", counts.points_done, counts.points)),
        ),
        (0, Some(tosses(counts.tosses_done))),
        (2, rate),
        (0, probability),
        (4, place),
        (5, worst),
        (0, settled.then(left)),
    ];
    for goes in (0..6).rev() {
        let text = joined(&parts);
        if text.chars().count() <= room || goes == 0 {
            return text;
        }
        parts.retain(|(when, _)| *when != goes);
    }
    unreachable!("the last round returns")
}

fn joined(parts: &[(u8, Option<String>)]) -> String {
    let mut text = String::new();
    for part in parts.iter().filter_map(|(_, part)| part.as_ref()) {
        // where it is belongs to what it is
        let gap = if part.starts_with("at ") { " " } else { "  " };
        if !text.is_empty() {
            text += gap;
        }
        text += part;
    }
    text
}

/// `P(side) 0.0731 [0.0715, 0.0747]`.
fn probability(latest: &Latest) -> String {
    let estimate = &latest.estimate;
    let decimals = decimals_for(estimate.half_width());
    let [p, lo, hi] =
        [estimate.p, estimate.lo, estimate.hi].map(|number| format!("{number:.decimals$}"));
    format!("P({}) {p} [{lo}, {hi}]", latest.face.name())
}

/// `at ratio 1, friction 0.3`: the point, if there are several.
fn place(latest: &Latest, plan: &Plan) -> Option<String> {
    let point = (latest.point < plan.points.len()).then(|| plan.points.at(latest.point))?;
    let values = plan.axes.iter().filter_map(|axis| {
        let mut parameters = point.parameters.iter();
        let (_, value) = parameters.find(|(name, _)| **name == **axis)?;
        Some(format!("{axis} {}", compact(*value)))
    });
    let values: Vec<_> = values.collect();
    (!values.is_empty()).then(|| format!("at {}", values.join(", ")))
}

#[cfg(test)]
pub(super) use tests::counts;

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Estimate, Face, IntervalMethod};

    const MADE: Made = Made {
        tosses: 1_000_000,
        time: Duration::from_secs(2),
    };

    pub(in crate::terminal::progress) fn counts() -> Counts {
        Counts {
            points_done: 12,
            points: 76,
            tosses_done: 1_234_567,
            tosses_planned: 2_234_567,
            tosses_reused: 234_567,
            reused_chunks: 3,
            worst_half_width: Some(0.001_23),
            latest: Some(Latest {
                point: 1,
                face: Face::Side,
                estimate: Estimate::new(7310, 0, 100_000, 0.95, IntervalMethod::Wilson),
            }),
        }
    }

    fn plan() -> Plan {
        let text = "coin.ratio = [0.5, 1]\nsurface = { restitution = 0.5, friction = 0.3 }\n\
                    launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 1000";
        coinmc::config::parse("test", text, &[]).unwrap()
    }

    #[test]
    fn the_message_says_points_tosses_rate_probability_error_and_time_left() {
        let told = |room| message(&counts(), MADE, Some(&plan()), room, &Style::plain(100));
        assert_eq!(
            told(usize::MAX),
            "12/76 points  1 234 567 tosses  500 k/s  P(side) 0.0731 [0.0715, 0.0747] at ratio 1  worst ±1.2e-3  \
             2.0 s left"
        );
        assert_eq!(
            told(80),
            "12/76 points  1 234 567 tosses  500 k/s  P(side) 0.0731 [0.0715, 0.0747]  2.0 s left"
                .replace("12/76 points  ", "")
        );
        // what matters most is told in any case
        assert_eq!(
            told(10),
            "1 234 567 tosses  P(side) 0.0731 [0.0715, 0.0747]  2.0 s left"
        );
    }

    #[test]
    fn an_interval_stays_within_0_to_1() {
        let latest = Latest {
            point: 0,
            face: Face::Heads,
            estimate: Estimate::new(0, 0, 3, 0.95, IntervalMethod::Wilson),
        };
        assert_eq!(probability(&latest), "P(heads) 0.000 [0.000, 0.561]");
    }

    #[test]
    fn nothing_is_extrapolated_from_nothing() {
        let ascii = Style::ascii(100);
        let none = Made {
            tosses: 0,
            time: Duration::from_secs(9),
        };
        let unknown = Counts {
            latest: None,
            ..counts()
        };
        let text = message(&unknown, none, None, 100, &ascii);
        assert_eq!(text, "12/76 points  1 234 567 tosses  worst +-1.2e-3");
        let endless = Counts {
            tosses_planned: u64::MAX,
            worst_half_width: None,
            ..unknown
        };
        let slow = Made {
            tosses: 1,
            time: Duration::from_secs(1_000_000),
        };
        let text = message(&endless, slow, None, 100, &ascii);
        assert!(text.ends_with(" d left"), "{text}");
    }
}
