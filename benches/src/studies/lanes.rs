//! The same work with every kind of lanes, timed by turns.

use crate::number;
use crate::processor_time::Stopwatch;
use coinmc_bench::Workload;
use coinmc_volumetric::Lanes;
use std::hint::black_box;

/// Titles of the cells of a rate.
pub(super) const RATE_COLUMNS: [&str; 5] =
    ["lanes", "tosses_a_second", "lowest", "highest", "of_scalar"];

/// How to read them.
pub(super) const RATES: &str = "Rates are medians, by the time on the processor. All kinds of lanes \
     take turns in every repeat, and of_scalar is the median of the ratios: it holds on a busy machine \
     as well. The tosses are the same with all of them, to the last bit.";

/// Timed runs of so many tosses, so often with each kind of lanes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turns {
    pub(super) tosses: u64,
    pub(super) repeats: u64,
}

impl Turns {
    /// The cells under [`RATE_COLUMNS`] of every kind of lanes that this processor has.
    pub(super) fn rates(&self, work: impl Fn(Lanes) -> Workload) -> Vec<Vec<String>> {
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
                // a run too short for the clock counts as its least
                seconds[i].push(watch.seconds().max(1e-6));
            }
        }
        seconds
    }

    fn cells(&self, own: &[f64], scalar: &[f64]) -> Vec<String> {
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
