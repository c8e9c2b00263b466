//! How much faster tosses go side by side than one after the other.

use super::{cells, columns};
use crate::number;
use crate::processor_time::Stopwatch;
use crate::report::{Report, Table};
use clap::Args;
use coinmc_bench::{Case, Workload};
use coinmc_core::Preset;
use coinmc_volumetric::Lanes;
use std::hint::black_box;

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
    pub(crate) fn carry_out(&self) -> Report {
        let kinds = Lanes::ALL.into_iter().filter(|lanes| lanes.is_available());
        let kinds: Vec<Lanes> = kinds.collect();
        let title = format!(
            "One core, {} repeats of {} tosses, friction {}",
            self.repeats,
            self.tosses,
            super::FRICTION
        );
        let names = ["lanes", "tosses_a_second", "lowest", "highest", "of_scalar"];
        let mut record = Table::new(title, &columns(&names));
        for case in cases() {
            let works: Vec<Workload> = kinds
                .iter()
                .map(|lanes| Workload::toss_in_space(case, *lanes))
                .collect();
            let seconds = self.time(&works);
            for (lanes, own) in kinds.iter().zip(&seconds) {
                let mut row = cells(&case);
                row.push(lanes.to_string());
                row.extend(self.rates(own, &seconds[0]));
                record.push(row);
            }
        }
        let mut report = Report::new(record);
        report.remark(
            "Rates are medians, by the time on the processor. All kinds of lanes take turns in \
             every repeat, and of_scalar is the median of the ratios: it holds on a busy machine \
             as well. The tosses are the same with all of them, to the last bit.",
        );
        report
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
                // a run too short for the clock counts as its least
                seconds[i].push(watch.seconds().max(1e-6));
            }
        }
        seconds
    }

    fn rates(&self, own: &[f64], scalar: &[f64]) -> Vec<String> {
        let rates: Vec<f64> = own.iter().map(|s| self.tosses as f64 / s).collect();
        let ratios: Vec<f64> = scalar.iter().zip(own).map(|(one, own)| one / own).collect();
        let lowest = rates.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = rates.iter().copied().fold(0.0, f64::max);
        let mut cells: Vec<String> = [number::median(&rates), lowest, highest]
            .map(|rate| format!("{rate:.0}"))
            .into();
        cells.push(format!("{:.2}", number::median(&ratios)));
        cells
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
