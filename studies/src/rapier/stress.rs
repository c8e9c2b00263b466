//! Random tosses from the box that the event-driven engine has to survive: does each end, and how.

use super::Flaws;
use crate::sample::Sample;
use crate::survey::survey;
use clap::Args;
use coinmc_bench::{Report, Table, number};
use coinmc_core::{Engine, Tally};
use coinmc_rapier::{RapierEngine, Settings};
use std::ops::Range;
use std::panic::{self, AssertUnwindSafe};

/// Tosses that one thread makes at a time.
const PART: u64 = 100;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct RapierStress {
    /// Tosses, each with a scene of its own, of each step
    #[arg(long, value_parser = number::count, default_value = "1000", value_name = "N")]
    tosses: u64,

    /// Steps after which a toss is given up
    #[arg(long, value_parser = number::count, default_value = "5000", value_name = "N")]
    max_steps: u64,
}

/// What a range of tosses came to.
#[derive(Debug, Clone, Copy, Default)]
struct Found {
    tally: Tally,
    flaws: Flaws,
    panics: u64,
    steps: u64,
}

/// Steps, in sqrt(D/g): the same for coins of all sizes.
const STEPS: [f64; 3] = [0.1, 0.03, 0.01];

impl RapierStress {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let starts = (0..self.tosses.div_ceil(PART)).map(|part| part * PART);
        let ranges = starts.map(|start| start..(start + PART).min(self.tosses));
        let ranges: Vec<Range<u64>> = ranges.collect();
        let jobs: Vec<(f64, Range<u64>)> = STEPS
            .iter()
            .flat_map(|step| ranges.iter().map(|range| (*step, range.clone())))
            .collect();
        let hook = panic::take_hook();
        panic::set_hook(Box::new(|_| {}));
        let found = survey(&jobs, |(step, range)| {
            self.tosses(seed, *step, range.clone())
        });
        panic::set_hook(hook);
        let mut columns = vec!["step", "tosses", "decided", "panics"];
        columns.extend(Flaws::COLUMNS);
        columns.push("steps_a_toss");
        let title = format!(
            "Random tosses in random scenes, given up after {} steps",
            self.max_steps
        );
        let mut record = Table::new(title, &columns);
        for (step, parts) in STEPS.iter().zip(found.chunks(ranges.len())) {
            let mut sum = Found::default();
            for part in parts {
                sum.merge(part);
            }
            let tosses = sum.tally.tosses();
            let decided = tosses - sum.tally.undecided();
            let mut row = vec![
                step.to_string(),
                (tosses + sum.panics).to_string(),
                number::probability(decided as f64 / tosses.max(1) as f64),
                sum.panics.to_string(),
            ];
            row.extend(sum.flaws.cells(&sum.tally));
            row.push(format!("{:.0}", sum.steps as f64 / tosses.max(1) as f64));
            record.push(row);
        }
        let mut report = Report::new(record);
        report.remark(
            "H/R 1e-4 … 1e4, e 0 … 1, mu 0 … 10, spin up to 1e5 rad/s, height up to 1e3 R, friction \
             lengths up to 0.1 R (the box of `stability`). step in sqrt(D/g). decided: share of tosses with \
             a face; all others are counted under what became of them.",
        );
        report
    }

    fn tosses(&self, seed: u64, step: f64, tosses: Range<u64>) -> Found {
        let mut found = Found::default();
        for toss in tosses {
            let sample = Sample::new(seed, toss);
            let settings = Settings {
                step_s: step * sample.scene.time_scale_s(),
                max_steps: u32::try_from(self.max_steps).unwrap_or(u32::MAX),
                ..Settings::default()
            };
            let account = panic::catch_unwind(AssertUnwindSafe(|| {
                let engine = RapierEngine::new(&sample.scene, &settings).expect("in range");
                engine.examine(&mut engine.workspace(), &sample.launch, &mut ())
            }));
            match account {
                Ok(account) => {
                    found.tally.add(&account.outcome);
                    found.flaws.add(account.flaw);
                    found.steps += u64::from(account.steps);
                }
                Err(_) => found.panics += 1,
            }
        }
        found
    }
}

impl Found {
    fn merge(&mut self, other: &Self) {
        self.tally.merge(&other.tally);
        self.flaws.merge(&other.flaws);
        self.panics += other.panics;
        self.steps += other.steps;
    }
}
