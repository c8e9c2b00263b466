//! What a plan will cost, from tossing some of its points for a moment.

use coinmc::plan::{Plan, Stop};
use coinmc::run::{RunError, Shard, run_shard};
use coinmc_core::{Face, Tally, inverse_normal_cdf};
use std::thread;
use std::time::{Duration, Instant};

/// At most so many points are tried, spread over the sweep.
const POINTS: usize = 8;
/// Time for all of them. A single toss may overrun it, nothing else does.
const BUDGET: Duration = Duration::from_millis(600);

/// Tosses before a point that stops at a half width is first looked at.
const FIRST_LOOK: u64 = 1 << 14;

/// A forecast, good to a factor of two or so.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cost {
    /// Tosses that the run will make.
    pub(super) tosses: u64,
    /// Speed of one thread.
    pub(super) tosses_per_s: f64,
    /// Threads that a run uses unless told otherwise.
    pub(super) threads: usize,
    /// How long the run will take; `None` if nothing is tossed.
    pub(super) time: Option<Duration>,
}

/// Tosses a sample of points and extrapolates.
pub(super) fn estimate(plan: &Plan) -> Result<Cost, RunError> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let sample = sample(plan);
    if sample.is_empty() {
        return Ok(Cost {
            tosses: 0,
            tosses_per_s: 0.0,
            threads,
            time: None,
        });
    }
    let tossed = plan
        .points
        .iter()
        .filter(|point| point.engine.makes_tosses())
        .count();
    let budget = BUDGET / u32::try_from(sample.len()).unwrap_or(u32::MAX);
    let (mut tosses, mut seconds, mut made, mut spent) = (0.0, 0.0, 0.0, 0.0);
    for &point in &sample {
        let (tally, time) = toss_for(plan, point, budget)?;
        let (n, time) = (tally.tosses() as f64, time.as_secs_f64());
        let needed = needed(plan, &tally) as f64;
        tosses += needed;
        seconds += needed * time / n;
        made += n;
        spent += time;
    }
    let scale = tossed as f64 / sample.len() as f64;
    let time = Duration::try_from_secs_f64(seconds * scale / threads as f64);
    // Casting saturates, and so it should: a forecast beyond u64 is "forever".
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let tosses = (tosses * scale) as u64;
    Ok(Cost {
        tosses,
        tosses_per_s: made / spent,
        threads,
        time: Some(time.unwrap_or(Duration::MAX)),
    })
}

/// Points that toss, evenly spread over those there are, the first among them.
fn sample(plan: &Plan) -> Vec<usize> {
    let points = plan.points.iter().enumerate();
    let tossed: Vec<usize> = points
        .filter(|(_, point)| point.engine.makes_tosses())
        .map(|(index, _)| index)
        .collect();
    let wanted = tossed.len().min(POINTS);
    (0..wanted)
        .map(|i| tossed[i * tossed.len() / wanted])
        .collect()
}

/// The first tosses of a point, ever more of them until the time is up.
fn toss_for(plan: &Plan, point: usize, budget: Duration) -> Result<(Tally, Duration), RunError> {
    let start = Instant::now();
    let mut tally = Tally::default();
    let mut batch = 1;
    loop {
        let from = tally.tosses();
        tally.merge(&run_shard(
            plan,
            &Shard {
                point,
                tosses: from..from + batch,
            },
        )?);
        let elapsed = start.elapsed();
        // The next batch, twice as large, would take about twice what all took so far.
        if elapsed * 3 > budget {
            return Ok((tally, elapsed));
        }
        batch *= 2;
    }
}

/// Tosses that a point needs, judged by a few of them.
///
/// Where it stops at a half width h: n = z² p (1 − p)/h² by the normal approximation, with the
/// least sure face, rounded up to the next look (a power of two; each look has its share of the
/// confidence).
fn needed(plan: &Plan, tally: &Tally) -> u64 {
    let (half_width, max_tosses) = match plan.stop {
        Stop::Tosses(tosses) => return tosses,
        Stop::HalfWidth {
            half_width,
            max_tosses,
        } => (half_width, max_tosses),
    };
    let n = tally.tosses() as f64;
    let variance = |face| {
        // One more of each: a face that was not seen may still show.
        let p = (tally.count(face) as f64 + 1.0) / (n + 2.0);
        p * (1.0 - p)
    };
    let variance = Face::ALL.into_iter().map(variance).fold(0.0, f64::max);
    // Some 10 to 40 looks: their number matters little under the logarithm of the tail.
    let looks = libm::log2(max_tosses as f64 / FIRST_LOOK as f64).max(0.0) + 1.0;
    let z = -inverse_normal_cdf((1.0 - plan.confidence) / (2.0 * looks));
    // Saturates; then max_tosses is what stops.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let wanted = (z * z * variance / (half_width * half_width)) as u64;
    wanted
        .checked_next_power_of_two()
        .unwrap_or(u64::MAX)
        .max(FIRST_LOOK)
        .min(max_tosses)
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
        assert_eq!(
            sample(&plan("tosses = 1000")),
            [0, 5, 10, 15, 20, 25, 30, 35]
        );
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
        // 13 looks: z = 2.89 at 95 %, 8.4 · 0.222/1e-6 = 1.86e6, next power of two
        assert_eq!(
            needed("half_width = 1e-3, max_tosses = 100_000_000"),
            1 << 21
        );
        assert_eq!(
            needed("half_width = 1e-3, max_tosses = 1_000_000"),
            1_000_000
        );
        assert_eq!(needed("half_width = 0.1, max_tosses = 5000"), 5000);
        assert_eq!(needed("half_width = 0.1"), 1 << 14);
        assert_eq!(
            needed("half_width = 1e-6, max_tosses = 100_000_000_000_000"),
            1 << 42
        );
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
