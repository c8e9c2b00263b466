//! How much faster flat tosses go side by side than one after the other.

use super::lanes::{RATE_COLUMNS, RATES, Turns};
use super::{case_cells, with_case_columns};
use crate::number;
use crate::report::{Report, Table};
use clap::Args;
use coinmc_bench::{Case, Workload};
use coinmc_core::Preset;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct FlatLanes {
    /// Tosses of each timed run
    #[arg(long, value_parser = number::count, default_value = "200_000", value_name = "N")]
    tosses: u64,

    /// Timed runs of each scene with each kind of lanes
    #[arg(long, value_parser = number::count, default_value = "5", value_name = "N")]
    repeats: u64,
}

impl FlatLanes {
    pub(crate) fn execute(&self) -> Report {
        let turns = Turns {
            tosses: self.tosses,
            repeats: self.repeats,
        };
        let title = format!(
            "One core, {} repeats of {} tosses",
            self.repeats, self.tosses
        );
        let mut record = Table::new(title, &with_case_columns(&RATE_COLUMNS));
        for case in cases() {
            for rates in turns.rates(|lanes| Workload::toss_flat(case, lanes)) {
                record.push([case_cells(&case), rates].concat());
            }
        }
        let mut report = Report::new(record);
        report.remark(RATES);
        report
    }
}

/// The scenes with asked rates, then dull, bouncy, thin and thick ones.
fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for preset in [Preset::CleanFlat, Preset::Robot] {
        for friction in [0.0, 0.3] {
            cases.push(Case::new(preset, 0.01, 1.2, 0.5, friction));
        }
    }
    for friction in [0.0, 0.3] {
        for (ratio, e) in [(1.2, 0.0), (1.2, 0.8), (0.1, 0.5), (10.0, 0.5)] {
            cases.push(Case::new(Preset::CleanFlat, 0.01, ratio, e, friction));
        }
    }
    cases
}
