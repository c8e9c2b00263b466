//! Forecasts the cost of a plan by tossing some of its points for a moment.

mod clock;
mod integrals;

use clock::Clock;
use coinmc::plan::{Looks, Plan, Stop};
use coinmc::run::{Chunk, RunError, run_chunk};
use coinmc_core::{Face, Tally};
use std::thread;
use std::time::Duration;

/// Most points that are tried, spread over the sweep.
const POINTS: usize = 24;
/// Time for all of them; only a single long toss may overrun it.
const BUDGET: Duration = Duration::from_millis(800);

/// A forecast should be right within this factor.
const SURE: f64 = 1.5;

/// A forecast.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cost {
    /// Tosses that the run will make.
    pub(super) tosses: u64,
    /// Speed of one thread.
    pub(super) tosses_per_s: f64,
    /// Threads that a run uses by default.
    pub(super) threads: usize,
    /// How long the run will take; `None` if nothing is tossed.
    pub(super) time: Option<Duration>,
    /// Whether the times of the tried tosses varied so much that the forecast is unsure.
    pub(super) unsure: bool,
    /// The face that the last point tried showed least.
    pub(super) rarest: Option<Face>,
    /// The cost of each tossed point, in the order of the sweep.
    pub(super) points: Vec<PointCost>,
}

/// The forecast for one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PointCost {
    pub(super) point: usize,
    pub(super) tosses: f64,
    /// Rate of one thread.
    pub(super) seconds: f64,
}

impl Cost {
    /// Time of one core that all points take, s.
    pub(super) fn core_seconds(&self) -> f64 {
        let seconds = self.points.iter().map(|point| point.seconds);
        seconds.fold(0.0, |sum, seconds| sum + seconds)
    }
}

/// Tries a sample of points and interpolates between them.
pub(super) fn estimate(plan: &Plan) -> Result<Cost, RunError> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let points = 0..plan.points.len();
    let tossed: Vec<usize> = points
        .clone()
        .filter(|&point| plan.makes_tosses(point))
        .collect();
    let integrated = points.filter(|&point| plan.integrates(point));
    let budget = BUDGET / u32::try_from(tossed.len().clamp(1, POINTS)).unwrap_or(u32::MAX);
    let mut with_batch = [0.0; 2];
    let mut rarest = None;
    let mut points = costs(&tossed, |point| {
        let (tally, pace) = toss_for(plan, point, budget)?;
        let tosses = needed(plan, &tally) as f64;
        rarest = Face::ALL.into_iter().min_by_key(|&face| tally.count(face));
        with_batch[0] += tosses * pace.before;
        with_batch[1] += tosses * pace.last;
        Ok((tosses, tosses * pace.last))
    })?;
    limit(plan, &mut points);
    let sum = |points: &[PointCost], of: fn(&PointCost) -> f64| points.iter().map(of).sum::<f64>();
    let tosses = sum(&points, |point| point.tosses);
    let tosses_per_s = if points.is_empty() {
        0.0
    } else {
        tosses / sum(&points, |point| point.seconds)
    };
    points.extend(costs(&integrated.collect::<Vec<_>>(), |point| {
        Ok((0.0, integrals::seconds(plan, point)?))
    })?);
    points.sort_by_key(|cost| cost.point);
    let seconds = sum(&points, |point| point.seconds) / threads as f64;
    let time = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
    Ok(Cost {
        // Casting saturates, and so it should: a forecast beyond u64 is "forever".
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        tosses: tosses.round() as u64,
        tosses_per_s,
        threads,
        time: (!points.is_empty()).then_some(time),
        unsure: is_unsure(with_batch),
        rarest,
        points,
    })
}

/// Lowers the forecasts to the limits of time, and of the whole run, where every point is short of what it
/// needs by the same factor.
fn limit(plan: &Plan, points: &mut [PointCost]) {
    let Stop::Targets(targets) = plan.stop else {
        return;
    };
    let lower = |points: &mut [PointCost], factor: f64| {
        for point in points {
            point.tosses *= factor.min(1.0);
            point.seconds *= factor.min(1.0);
        }
    };
    if let Some(most) = targets.max_core_seconds {
        for point in &mut *points {
            let factor = most / point.seconds;
            lower(std::slice::from_mut(point), factor);
        }
    }
    if let Some(total) = targets.total_tosses {
        let all: f64 = points.iter().map(|point| point.tosses).sum();
        lower(points, total as f64 / all);
    }
    if let Some(total) = targets.total_core_seconds {
        let all: f64 = points.iter().map(|point| point.seconds).sum();
        lower(points, total / all);
    }
}

/// Whether two forecasts from different tosses differ by more than a forecast may differ from the run.
fn is_unsure([one, other]: [f64; 2]) -> bool {
    one.max(other) > SURE * one.min(other)
}

/// The cost of each of the points: `try_one` gives tosses and seconds of those that are tried,
/// straight lines between them those of the others.
fn costs(
    points: &[usize],
    mut try_one: impl FnMut(usize) -> Result<(f64, f64), RunError>,
) -> Result<Vec<PointCost>, RunError> {
    let mut known = Vec::new();
    for place in spread(points.len()) {
        let (tosses, seconds) = try_one(points[place])?;
        known.push((place, tosses, seconds));
    }
    Ok(between(points, &known))
}

/// Places in a list of `length`, evenly spread, the first and the last among them.
fn spread(length: usize) -> impl Iterator<Item = usize> {
    let wanted = length.min(POINTS);
    let gaps = wanted.saturating_sub(1).max(1);
    (0..wanted).map(move |i| i * (length - 1) / gaps)
}

/// The cost of every point, `known` holding the place, the tosses and the seconds of those tried.
fn between(points: &[usize], known: &[(usize, f64, f64)]) -> Vec<PointCost> {
    let cost = |(place, &point): (usize, &usize)| {
        let after = known.partition_point(|(there, ..)| *there < place);
        let high = known[after.min(known.len() - 1)];
        let low = known[after.saturating_sub(1)];
        let width = high.0.saturating_sub(low.0).max(1) as f64;
        let share = place.saturating_sub(low.0) as f64 / width;
        let at = |low: f64, high: f64| low + (high - low) * share.min(1.0);
        PointCost {
            point,
            tosses: at(low.1, high.1),
            seconds: at(low.2, high.2),
        }
    };
    points.iter().enumerate().map(cost).collect()
}

/// Seconds that a toss took.
#[derive(Debug, Clone, Copy)]
struct Pace {
    /// In the last half of all tosses.
    last: f64,
    /// In the quarter before.
    before: f64,
}

/// Tosses a point in growing batches until the time is up, and measures the last half of them: at first
/// an engine that tosses in lanes has not filled its lanes.
fn toss_for(plan: &Plan, point: usize, budget: Duration) -> Result<(Tally, Pace), RunError> {
    let start = Clock::now();
    let mut tally = Tally::default();
    let mut batch = 1;
    let mut before = None;
    loop {
        let (from, begun) = (tally.tosses(), Clock::now());
        tally.merge(&run_chunk(
            plan,
            &Chunk {
                point,
                tosses: from..from + batch,
            },
        )?);
        let last = begun.elapsed().as_secs_f64() / batch as f64;
        // The next batch, twice as large, would take about twice what all took so far.
        if start.has_taken(budget / 3) {
            let before = before.unwrap_or(last);
            return Ok((tally, Pace { last, before }));
        }
        before = Some(last);
        batch *= 2;
    }
}

/// Tosses that a point needs, judged by a few of them.
fn needed(plan: &Plan, tally: &Tally) -> u64 {
    match plan.stop {
        Stop::Tosses(tosses) => tosses,
        Stop::Targets(targets) => {
            // one more of each face: one that did not show yet may still do so
            let shown = Tally {
                heads: tally.heads + 1,
                tails: tally.tails + 1,
                side: tally.side + 1,
                ..*tally
            };
            Looks::new(targets, plan.confidence).forecast(&shown)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc::config;

    fn plan(stop: &str) -> Plan {
        let config = format!(
            "coin.ratio = {{ from = 0.5, to = 2.5, steps = 40 }}\n\
             surface = {{ restitution = 0.5, friction = 0.3 }}\n\
             launch.preset = 'robot'\nengine.flat = {{}}\nstop = {{ {stop} }}"
        );
        config::parse("test", &config, &[]).unwrap_or_else(|problems| panic!("{problems}"))
    }

    #[test]
    fn the_sample_is_spread_over_the_sweep() {
        let places: Vec<usize> = spread(40).collect();
        assert_eq!(places.len(), POINTS);
        assert_eq!((places[0], places[POINTS - 1]), (0, 39));
        let steps = places.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(steps.into_iter().all(|step| step == 1 || step == 2));
        assert_eq!(spread(2).collect::<Vec<_>>(), [0, 1]);
        assert_eq!(spread(1).collect::<Vec<_>>(), [0]);
        assert_eq!(spread(0).count(), 0);
    }

    #[test]
    fn points_between_those_tried_lie_on_straight_lines() {
        let costs = between(
            &[3, 4, 6, 7, 9],
            &[(0, 10.0, 1.0), (2, 20.0, 2.0), (4, 20.0, 6.0)],
        );
        let expected = [
            (3, 10.0, 1.0),
            (4, 15.0, 1.5),
            (6, 20.0, 2.0),
            (7, 20.0, 4.0),
            (9, 20.0, 6.0),
        ];
        for (cost, (point, tosses, seconds)) in costs.iter().zip(expected) {
            assert_eq!(
                *cost,
                PointCost {
                    point,
                    tosses,
                    seconds
                }
            );
        }
    }

    #[test]
    fn a_fixed_number_of_tosses_is_what_it_says() {
        assert_eq!(estimate(&plan("tosses = 1000")).unwrap().tosses, 40_000);
    }

    #[test]
    fn a_half_width_needs_its_square() {
        let tally = Tally {
            heads: 333,
            tails: 333,
            side: 334,
            ..Tally::default()
        };
        let needed = |stop| needed(&plan(stop), &tally);
        // With 4.85 % for the first look, Clopper and Pearson's arm is 1e-3 at 867,847 tosses (SciPy), and whole
        // counts take up to one toss more of a face, 2/h = 2000 tosses; 0.3 % more for them. A pilot of 2^13: twice
        // as many would save .29 of the 16,300 tosses that its error costs, 2.5 standard errors of .334, .34703,
        // where p(1 - p) is 1.01866 times as large.
        let tosses = needed("half_width = 1e-3, max_tosses = 100_000_000");
        let counted = (tosses - (1 << 13)) as f64 / 1.01866;
        assert!((870_450.0..=872_460.0).contains(&counted), "{tosses}");
        assert_eq!(
            needed("half_width = 1e-3, max_tosses = 1_000_000"),
            tosses.min(1_000_000)
        );
        assert_eq!(needed("half_width = 0.001, max_tosses = 5000"), 5000);
        assert!(needed("half_width = 0.1") < 2048);
    }

    #[test]
    fn the_run_has_a_limit_too() {
        let plan = plan("half_width = 1e-4, total_tosses = 1_000_000");
        assert_eq!(estimate(&plan).unwrap().tosses, 1_000_000);
    }

    #[test]
    fn limits_of_time_are_those_of_the_forecast() {
        for stop in ["total_core_seconds = 20", "max_core_seconds = 0.5"] {
            let plan = plan(&format!("half_width = 1e-6, max_tosses = 1e12, {stop}"));
            let cost = estimate(&plan).unwrap();
            let seconds: f64 = cost.points.iter().map(|point| point.seconds).sum();
            assert!((seconds - 20.0).abs() < 1e-9, "{stop}: {seconds}");
        }
    }

    #[test]
    fn two_batches_that_agree_make_a_forecast_sure() {
        assert!(!is_unsure([0.0, 0.0]) && !is_unsure([2.0, 2.9]) && !is_unsure([2.9, 2.0]));
        assert!(is_unsure([2.0, 3.1]) && is_unsure([3.1, 2.0]) && is_unsure([0.0, 1.0]));
    }

    #[test]
    fn closed_forms_cost_nothing() {
        let plan = config::parse(
            "test",
            "coin.ratio = 1.0\nengine.analytic.rule = 'arc'",
            &[],
        );
        assert_eq!(estimate(&plan.unwrap()).unwrap().time, None);
    }
}
