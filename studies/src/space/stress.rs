//! Random tosses from all over the box of scenes: does each end, and how.

use super::PART;
use super::paired::undecided;
use super::stress_box::Sample;
use crate::survey::survey;
use clap::Args;
use coinmc_bench::{Report, Table, number};
use coinmc_core::{Ended, Estimate, IntervalMethod, Outcome, Tally};
use coinmc_volumetric::{Law, Settings};
use std::ops::Range;
use std::panic::{self, AssertUnwindSafe};
use std::time::Instant;

/// Tosses that are named, of each kind.
const NAMED: usize = 8;
/// Titles of the groups, by whether the coin rolls freely and whether it bounces without loss.
const GROUPS: [&str; 4] = [
    "e < 1: both rho > 0",
    "e = 1: both rho > 0",
    "e < 1: a rho = 0",
    "e = 1: a rho = 0",
];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct SpaceStress {
    /// Tosses, each with a scene of its own
    #[arg(long, value_parser = number::count, default_value = "1_000_000", value_name = "N")]
    tosses: u64,

    /// Impacts after which a toss is given up
    #[arg(long, value_parser = number::count, default_value = "100_000", value_name = "N")]
    max_impacts: u64,

    /// The same where e = 1: such a coin may bounce for ever
    #[arg(long, value_parser = number::count, default_value = "1000", value_name = "N")]
    max_elastic: u64,

    /// Steps of sustained contact after which a toss is given up
    #[arg(long, value_parser = number::count, default_value = "100_000", value_name = "N")]
    max_steps: u64,

    /// Law of impact: moreau, chatterjee-ruina or stronge
    #[arg(long, value_parser = law, default_value = "moreau", value_name = "LAW")]
    law: Law,

    /// Makes this toss alone
    #[arg(long, value_name = "TOSS")]
    only: Option<u64>,
}

/// Something about a toss, to be ranked.
#[derive(Debug, Clone, Copy)]
struct Named {
    toss: u64,
    value: f64,
}

/// What a range of tosses came to.
#[derive(Debug, Clone, Default)]
struct Found {
    groups: [Tally; 4],
    panics: Vec<u64>,
    /// Tosses of the first group without a face.
    unsettled: Vec<u64>,
    failed: Vec<u64>,
    impacts: Vec<Named>,
    steps: Vec<Named>,
    milliseconds: Vec<Named>,
}

/// A limit of a toss; the engine's counters end there.
fn limit(most: u64) -> u32 {
    u32::try_from(most).unwrap_or(u32::MAX)
}

fn law(name: &str) -> Result<Law, String> {
    let law = Law::ALL.into_iter().find(|law| law.name() == name);
    law.ok_or_else(|| "the laws are moreau, chatterjee-ruina, stronge".to_owned())
}

impl SpaceStress {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let settings = [self.max_impacts, self.max_elastic].map(|most| Settings {
            law: self.law,
            max_impacts: limit(most),
            max_steps: limit(self.max_steps),
            ..Settings::default()
        });
        if let Some(number) = self.only {
            return alone(seed, number, &settings);
        }
        let starts = (0..self.tosses.div_ceil(PART)).map(|part| part * PART);
        let parts: Vec<Range<u64>> = starts
            .map(|start| start..(start + PART).min(self.tosses))
            .collect();
        // a panic is counted and named; its message would tear the table
        let hook = panic::take_hook();
        panic::set_hook(Box::new(|_| {}));
        let found = survey(&parts, |part| Found::of(seed, part.clone(), &settings));
        panic::set_hook(hook);
        let mut total = Found::default();
        for found in found {
            total.merge(found);
        }
        self.report(seed, &total)
    }

    fn report(&self, seed: u64, found: &Found) -> Report {
        let columns = ["group", "tosses", "undecided", "share", "below", "jams"];
        let title = format!(
            "Random tosses under {}, given up after {} impacts ({} where e = 1) or {} contact steps",
            self.law.name(),
            self.max_impacts,
            self.max_elastic,
            self.max_steps
        );
        let mut record = Table::new(title.clone(), &columns);
        for (name, tally) in GROUPS.iter().zip(&found.groups) {
            let (count, tosses) = (tally.undecided(), tally.tosses());
            let method = IntervalMethod::ClopperPearson;
            let bound = Estimate::new(count, 0, tosses, 0.9, method).hi;
            record.push(vec![
                (*name).to_owned(),
                tosses.to_string(),
                undecided(tally),
                number::tiny(count as f64 / tosses.max(1) as f64),
                number::tiny(bound),
                tally.jams.to_string(),
            ]);
        }
        let groups = record.select(&title, 0..GROUPS.len());
        let mut report = Report::new(record);
        report.show(groups);
        report.show(named(seed, found));
        report.remark(format!(
            "{} panics, {} tosses with numbers that went wrong. below: 95 % confidence, one-sided \
             (Clopper–Pearson).",
            found.panics.len(),
            found.groups.iter().map(|tally| tally.failed).sum::<u64>()
        ));
        report.remark("--only TOSS makes a toss again, alone.");
        report
    }
}

/// Tosses worth looking at.
fn named(seed: u64, found: &Found) -> Table {
    let mut table = Table::new("Tosses to look at", &["why", "value", "toss", "scene"]);
    let mut push = |why: &str, value: String, toss: u64| {
        let scene = Sample::new(seed, toss).to_string();
        table.push(vec![why.to_owned(), value, toss.to_string(), scene]);
    };
    for (why, tosses) in [
        ("panic", &found.panics),
        ("failed", &found.failed),
        (GROUPS[0], &found.unsettled),
    ] {
        for toss in tosses.iter().take(NAMED) {
            push(why, String::new(), *toss);
        }
    }
    for (why, ranked) in [
        ("impacts", &found.impacts),
        ("contact steps", &found.steps),
        ("milliseconds", &found.milliseconds),
    ] {
        for worst in ranked {
            push(why, format!("{:.0}", worst.value), worst.toss);
        }
    }
    table
}

/// One toss, told in full.
fn alone(seed: u64, number: u64, settings: &[Settings; 2]) -> Report {
    let sample = Sample::new(seed, number);
    let start = Instant::now();
    let outcome = sample.toss(&settings[usize::from(sample.is_elastic())]);
    let took = start.elapsed().as_secs_f64();
    let mut table = Table::new(sample.to_string(), &["what", "value"]);
    for (what, value) in [
        ("ended", format!("{:?}", outcome.ended)),
        ("impacts", outcome.impacts.to_string()),
        ("contact steps", outcome.contact_steps.to_string()),
        ("jams", outcome.jams.to_string()),
        ("milliseconds", format!("{:.3}", 1e3 * took)),
    ] {
        table.push(vec![what.to_owned(), value]);
    }
    Report::new(table)
}

impl Found {
    fn of(seed: u64, tosses: Range<u64>, settings: &[Settings; 2]) -> Self {
        let mut found = Self::default();
        for toss in tosses {
            let sample = Sample::new(seed, toss);
            let settings = &settings[usize::from(sample.is_elastic())];
            let start = Instant::now();
            match panic::catch_unwind(AssertUnwindSafe(|| sample.toss(settings))) {
                Ok(outcome) => found.add(toss, &sample, &outcome, start.elapsed().as_secs_f64()),
                Err(_) => found.panics.push(toss),
            }
        }
        found
    }

    fn add(&mut self, toss: u64, sample: &Sample, outcome: &Outcome, seconds: f64) {
        let group = 2 * usize::from(sample.rolls_freely()) + usize::from(sample.is_elastic());
        self.groups[group].add(outcome);
        if outcome.ended == Ended::Failed {
            self.failed.push(toss);
        } else if group == 0 && outcome.face().is_none() {
            self.unsettled.push(toss);
        }
        for (ranked, value) in [
            (&mut self.impacts, f64::from(outcome.impacts)),
            (&mut self.steps, f64::from(outcome.contact_steps)),
            (&mut self.milliseconds, 1e3 * seconds),
        ] {
            // a lossless coin runs to its limit: nothing to learn from that
            if !sample.is_elastic() {
                rank(ranked, [Named { toss, value }]);
            }
        }
    }

    fn merge(&mut self, other: Self) {
        for (tally, more) in self.groups.iter_mut().zip(&other.groups) {
            tally.merge(more);
        }
        self.panics.extend(other.panics);
        self.unsettled.extend(other.unsettled);
        self.failed.extend(other.failed);
        rank(&mut self.impacts, other.impacts);
        rank(&mut self.steps, other.steps);
        rank(&mut self.milliseconds, other.milliseconds);
    }
}

/// Keeps the largest, in order.
fn rank(ranked: &mut Vec<Named>, more: impl IntoIterator<Item = Named>) {
    for new in more {
        let place = ranked.partition_point(|old| old.value >= new.value);
        if place < NAMED {
            ranked.insert(place, new);
            ranked.truncate(NAMED);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_are_kept_in_order() {
        let mut ranked = Vec::new();
        for toss in 0..100 {
            let value = ((toss * 37) % 100) as f64;
            rank(&mut ranked, [Named { toss, value }]);
        }
        let values: Vec<f64> = ranked.iter().map(|named| named.value).collect();
        assert_eq!(values, [99.0, 98.0, 97.0, 96.0, 95.0, 94.0, 93.0, 92.0]);
    }
}
