//! Sums and extremes over many tosses.

use super::region::AXES;
use super::witness::Seen;
use crate::sample::Sample;
use crate::worst::Worst;
use coinmc_bench::number;
use coinmc_core::{Ended, Outcome, Tally};

/// Titles of the cells of [`Region::row`].
pub(super) const COLUMNS: [&str; 16] = [
    "parameter",
    "region",
    "tosses",
    "undecided",
    "impact_or_step_limit",
    "time_limit",
    "never_settles",
    "failed",
    "not_finite",
    "panics",
    "gain",
    "residual",
    "drift",
    "missed",
    "depth",
    "differ",
];

/// How many tosses of each kind are listed.
const NAMED: usize = 6;

/// Tosses of one region of the box.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Region {
    pub(super) tally: Tally,
    panics: u64,
    not_finite: u64,
    flights: u64,
    missed: u64,
    compared: u64,
    differ: u64,
    gain: Worst,
    residual: Worst,
    drift: Worst,
    depth: Worst,
}

/// The tosses that came closest to an error, the worst first.
#[derive(Debug, Clone, Default)]
pub(super) struct Hardest {
    broken: Vec<(&'static str, u64)>,
    gain: Vec<Worst>,
    residual: Vec<Worst>,
    drift: Vec<Worst>,
    depth: Vec<Worst>,
}

/// Sums and extremes over a range of tosses.
#[derive(Debug, Clone, Default)]
pub(super) struct Found {
    /// By parameter, then by region.
    pub(super) regions: [Vec<Region>; AXES.len()],
    pub(super) hardest: Hardest,
}

impl Found {
    /// Adds a toss; `None` where it panicked.
    pub(super) fn add(&mut self, toss: u64, sample: &Sample, made: Option<(Outcome, Seen)>) {
        for (axis, regions) in AXES.iter().zip(&mut self.regions) {
            regions.resize(axis.regions(), Region::default());
            regions[axis.region(sample)].add(toss, made.as_ref());
        }
        self.hardest.add(toss, made.as_ref());
    }

    /// Both together. `later` has the higher numbers.
    pub(super) fn merge(mut self, later: Self) -> Self {
        for (axis, (regions, more)) in AXES.iter().zip(self.regions.iter_mut().zip(&later.regions))
        {
            regions.resize(axis.regions(), Region::default());
            for (region, more) in regions.iter_mut().zip(more) {
                region.merge(more);
            }
        }
        self.hardest.merge(later.hardest);
        self
    }

    /// All regions of a parameter: every toss once.
    pub(super) fn total(&self) -> Region {
        let mut total = Region::default();
        for region in &self.regions[0] {
            total.merge(region);
        }
        total
    }
}

impl Region {
    fn add(&mut self, toss: u64, made: Option<&(Outcome, Seen)>) {
        let Some((outcome, seen)) = made else {
            self.panics += 1;
            return;
        };
        self.tally.add(outcome);
        self.not_finite += u64::from(seen.not_finite);
        self.flights += seen.flights;
        self.missed += seen.missed;
        self.compared += u64::from(seen.agrees.is_some());
        self.differ += u64::from(seen.agrees == Some(false));
        self.gain.see(seen.gain, toss);
        self.residual.see(seen.residual, toss);
        self.drift.see(seen.drift, toss);
        self.depth.see(seen.depth, toss);
    }

    fn merge(&mut self, other: &Self) {
        self.tally.merge(&other.tally);
        self.panics += other.panics;
        self.not_finite += other.not_finite;
        self.flights += other.flights;
        self.missed += other.missed;
        self.compared += other.compared;
        self.differ += other.differ;
        for (worst, other) in [
            (&mut self.gain, other.gain),
            (&mut self.residual, other.residual),
            (&mut self.drift, other.drift),
            (&mut self.depth, other.depth),
        ] {
            worst.see(other.value, other.toss);
        }
    }

    pub(super) fn row(&self, parameter: &str, region: String) -> Vec<String> {
        let tally = &self.tally;
        let share = tally.undecided() as f64 / tally.tosses().max(1) as f64;
        let mut row = vec![parameter.to_owned(), region];
        row.push(tally.tosses().to_string());
        row.push(number::tiny(share));
        let counts = [
            tally.impact_limit,
            tally.time_limit,
            tally.never_settles,
            tally.failed,
            self.not_finite,
            self.panics,
        ];
        row.extend(counts.map(|count| count.to_string()));
        row.extend([self.gain, self.residual, self.drift].map(value));
        row.push(format!("{} of {}", self.missed, self.flights));
        row.push(value(self.depth));
        row.push(format!("{} of {}", self.differ, self.compared));
        row
    }
}

impl Hardest {
    fn add(&mut self, toss: u64, made: Option<&(Outcome, Seen)>) {
        let Some((outcome, seen)) = made else {
            self.name("panic", toss);
            return;
        };
        if outcome.ended == Ended::Failed {
            self.name("failed", toss);
        } else if seen.not_finite {
            self.name("not finite", toss);
        }
        if seen.missed > 0 {
            self.name("missed contact", toss);
        }
        if seen.agrees == Some(false) {
            self.name("differs", toss);
        }
        for (ranked, value) in [
            (&mut self.gain, seen.gain),
            (&mut self.residual, seen.residual),
            (&mut self.drift, seen.drift),
            (&mut self.depth, seen.depth),
        ] {
            rank(ranked, Worst { value, toss });
        }
    }

    fn name(&mut self, why: &'static str, toss: u64) {
        if self.broken.iter().filter(|(w, _)| *w == why).count() < NAMED {
            self.broken.push((why, toss));
        }
    }

    fn merge(&mut self, later: Self) {
        for (why, toss) in later.broken {
            self.name(why, toss);
        }
        for (ranked, more) in [
            (&mut self.gain, later.gain),
            (&mut self.residual, later.residual),
            (&mut self.drift, later.drift),
            (&mut self.depth, later.depth),
        ] {
            for worst in more {
                rank(ranked, worst);
            }
        }
    }

    /// Why, value, toss.
    pub(super) fn rows(&self) -> impl Iterator<Item = (&'static str, String, u64)> {
        let broken = self
            .broken
            .iter()
            .map(|(why, toss)| (*why, String::new(), *toss));
        let ranked = [
            ("gain", &self.gain),
            ("residual", &self.residual),
            ("drift", &self.drift),
            ("depth", &self.depth),
        ];
        let ranked = ranked.into_iter().flat_map(|(why, ranked)| {
            let row = move |worst: &Worst| (why, value(*worst), worst.toss);
            ranked.iter().map(row)
        });
        broken.chain(ranked)
    }
}

/// Keeps the largest, in order; what is not a number is larger than any.
fn rank(ranked: &mut Vec<Worst>, new: Worst) {
    if new.value == f64::NEG_INFINITY {
        return;
    }
    let stays = |old: &Worst| old.value.is_nan() || old.value >= new.value;
    let place = ranked.partition_point(stays);
    if place < NAMED {
        ranked.insert(place, new);
        ranked.truncate(NAMED);
    }
}

fn value(worst: Worst) -> String {
    if worst.value == f64::NEG_INFINITY {
        "none".to_owned()
    } else {
        number::tiny(worst.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::Face;

    fn made(gain: f64, ended: Ended) -> (Outcome, Seen) {
        let outcome = Outcome {
            ended,
            impacts: 1,
            contact_steps: 0,
            jams: 0,
            overruled: false,
            breaks: coinmc_core::Breaks::default(),
            side_ending: None,
        };
        let seen = Seen {
            gain,
            residual: 0.0,
            drift: 0.0,
            ..Seen::nothing()
        };
        (outcome, seen)
    }

    /// In parts and at once, the same: a long study may be interrupted and added up.
    #[test]
    fn parts_merge_to_the_whole_and_the_worst_come_first() {
        let toss = |found: &mut Found, number: u64| {
            let ended = if number == 7 {
                Ended::Failed
            } else {
                Ended::Decided(Face::Side)
            };
            let gain = ((number * 37) % 100) as f64;
            found.add(number, &Sample::new(1, number), Some(made(gain, ended)));
        };
        let [mut whole, mut first, mut second] = [0; 3].map(|_| Found::default());
        for number in 0..100 {
            toss(&mut whole, number);
            toss(if number < 40 { &mut first } else { &mut second }, number);
        }
        let both = first.merge(second);
        let rows = |found: &Found| {
            let regions = found.regions.iter().flatten();
            let cells = regions.map(|region| region.row("", String::new()));
            (
                cells.collect::<Vec<_>>(),
                found.hardest.rows().collect::<Vec<_>>(),
            )
        };
        assert_eq!(rows(&both), rows(&whole));
        assert_eq!(whole.total().tally.tosses(), 100);
        let (_, hardest) = rows(&whole);
        assert_eq!(hardest[0].0, "failed");
        assert_eq!((hardest[1].1.as_str(), hardest[1].2), ("9.9e1", 27));
    }

    #[test]
    fn a_panic_is_counted_and_named() {
        let mut found = Found::default();
        found.add(3, &Sample::new(1, 3), None);
        assert_eq!(found.total().panics, 1);
        assert_eq!(
            found.hardest.rows().next(),
            Some(("panic", String::new(), 3))
        );
    }
}
