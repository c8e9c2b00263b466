//! How much faster tosses go side by side than one after the other.

use super::{cells, columns};
use crate::number;
use crate::report::{Report, Table};
use crate::studies::lanes::{RATE_COLUMNS, RATES, Turns};
use clap::Args;
use coinmc_bench::{Case, Workload};
use coinmc_core::Preset;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct SpaceLanes {
    /// Tosses of each timed run
    #[arg(long, value_parser = number::count, default_value = "50_000", value_name = "N")]
    tosses: u64,

    /// Timed runs of each scene with each kind of lanes
    #[arg(long, value_parser = number::count, default_value = "5", value_name = "N")]
    repeats: u64,
}

impl SpaceLanes {
    pub(crate) fn execute(&self) -> Report {
        let turns = Turns {
            tosses: self.tosses,
            repeats: self.repeats,
        };
        let title = format!(
            "One core, {} repeats of {} tosses, friction {}",
            self.repeats,
            self.tosses,
            super::FRICTION
        );
        let mut record = Table::new(title, &columns(&RATE_COLUMNS));
        for case in cases() {
            for rates in turns.rates(|lanes| Workload::toss_in_space(case, lanes)) {
                record.push([cells(&case), rates].concat());
            }
        }
        let mut report = Report::new(record);
        report.remark(RATES);
        report
    }
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for ratio in [0.85, 0.1, 0.25, 2.0, 10.0] {
        for e in [0.5, 0.0, 0.8] {
            for rho in [0.01, 0.003] {
                let case = Case::new(Preset::Clean, 0.01, ratio, e, super::FRICTION);
                cases.push(case.rolling(rho));
            }
        }
    }
    cases
}
