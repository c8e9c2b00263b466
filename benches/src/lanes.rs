//! How much faster batches are than the scalar path, with every kind of lanes.

use crate::run_apart::Toss;
use clap::Args;
use coinmc_bench::{Case, Report, Stopwatch, Table, Workload, number};
use coinmc_core::Preset;
use coinmc_volumetric::Lanes;
use std::hint::black_box;

/// Titles of a rate's cells.
const RATE_COLUMNS: [&str; 5] = ["lanes", "tosses_a_second", "lowest", "highest", "of_scalar"];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct LaneRates {
    /// What is tossed
    #[arg(long, value_enum, default_value_t = Toss::Flat)]
    toss: Toss,

    /// Tosses of each timed run
    #[arg(long, value_parser = number::count, default_value = "50_000", value_name = "N")]
    tosses: u64,

    /// Timed runs of each scene with each kind of lanes
    #[arg(long, value_parser = number::count, default_value = "5", value_name = "N")]
    repeats: u64,
}

impl LaneRates {
    pub(crate) fn execute(&self) -> Report {
        let title = format!(
            "One core, {} repeats of {} tosses",
            self.repeats, self.tosses
        );
        let mut record = Table::new(title, &Case::columns(&RATE_COLUMNS));
        let (cases, workload): (_, fn(Case, Lanes) -> Workload) = match self.toss {
            Toss::Flat => (flat_cases(), Workload::toss_flat),
            Toss::Space => (space_cases(), Workload::toss_in_space),
        };
        for case in cases {
            for rates in self.rates(|lanes| workload(case, lanes)) {
                record.push([case.cells(), rates].concat());
            }
        }
        let mut report = Report::new(record);
        report.remark(
            "Rates are medians of processor time. All kinds of lanes take turns in every repeat; \
             of_scalar is the median of the ratios and holds on a busy machine as well. The tosses \
             of all kinds are bit-identical.",
        );
        report
    }

    /// The cells under [`RATE_COLUMNS`] of every kind of lanes that this processor has.
    fn rates(&self, work: impl Fn(Lanes) -> Workload) -> Vec<Vec<String>> {
        let kinds = Lanes::ALL.into_iter().filter(|lanes| lanes.is_available());
        let kinds: Vec<Lanes> = kinds.collect();
        let works: Vec<Workload> = kinds.iter().map(|lanes| work(*lanes)).collect();
        let seconds = self.time(&works);
        let row = |(lanes, own): (&Lanes, &Vec<f64>)| {
            let mut row = vec![lanes.to_string()];
            row.extend(self.cells(own, &seconds[0]));
            row
        };
        kinds.iter().zip(&seconds).map(row).collect()
    }

    /// Seconds of every repeat of each; every other repeat goes backwards.
    fn time(&self, works: &[Workload]) -> Vec<Vec<f64>> {
        let mut seconds = vec![Vec::new(); works.len()];
        for repeat in 0..self.repeats {
            let mut order: Vec<usize> = (0..works.len()).collect();
            if repeat % 2 == 1 {
                order.reverse();
            }
            for i in order {
                let watch = Stopwatch::start();
                black_box(works[i].run(0..self.tosses));
                // a run below the clock's resolution counts as one tick
                seconds[i].push(watch.seconds().max(1e-6));
            }
        }
        seconds
    }

    fn cells(&self, own: &[f64], scalar: &[f64]) -> Vec<String> {
        let rates: Vec<f64> = own.iter().map(|s| self.tosses as f64 / s).collect();
        let ratios: Vec<f64> = scalar.iter().zip(own).map(|(one, own)| one / own).collect();
        let spread = number::spread(&rates);
        let mut cells: Vec<String> = spread.map(|rate| format!("{rate:.0}")).into();
        cells.push(format!("{:.2}", number::median(&ratios)));
        cells
    }
}

/// The scenes with required rates, then dull, bouncy, thin and thick coins.
fn flat_cases() -> Vec<Case> {
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

fn space_cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for ratio in [0.85, 0.1, 0.25, 2.0, 10.0] {
        for e in [0.5, 0.0, 0.8] {
            for rho in [0.01, 0.003] {
                let case = Case::new(Preset::Clean, 0.01, ratio, e, 0.3);
                cases.push(case.rolling(rho));
            }
        }
    }
    cases
}
