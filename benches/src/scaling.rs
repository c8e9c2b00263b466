//! Whole runs over threads and over numbers of tosses: rate, speed-up, memory.
//!
//! Each run is a process of its own. Absolute rates depend on the machine and on what else it does;
//! a speed-up is the ratio of two runs that followed each other at once.

use crate::run_apart::{RunApart, Taken, Toss};
use clap::Args;
use coinmc_bench::{Report, Table, number};
use std::num::NonZeroUsize;
use std::thread::available_parallelism;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Scaling {
    /// What is tossed
    #[arg(long, value_enum, default_value_t = Toss::Flat)]
    toss: Toss,

    /// Tosses of each run over threads
    #[arg(long, value_parser = number::count, default_value = "1e8", value_name = "N")]
    tosses: u64,

    /// Runs with each number of threads
    #[arg(long, value_parser = number::count, default_value = "3", value_name = "N")]
    repeats: u64,

    /// Tosses of the largest run over numbers of tosses, which go up to it by factors of ten
    #[arg(long, value_parser = number::count, default_value = "1e9", value_name = "N")]
    most: u64,
}

/// A run of fewer tosses tells how long a process takes to start.
const FEWEST: u64 = 1000;

const COLUMNS: [&str; 8] = [
    "toss",
    "tosses",
    "threads",
    "tosses_a_second",
    "tosses_a_processor_second",
    "speed_up",
    "threads_at_work",
    "peak_mib",
];

impl Scaling {
    pub(crate) fn execute(&self) -> anyhow::Result<Report> {
        let cores = available_parallelism().map_or(1, NonZeroUsize::get);
        let mut record = Table::new("Whole runs", &COLUMNS);
        self.over_threads(cores, &mut record)?;
        self.over_tosses(cores, &mut record)?;
        let mut report = Report::new(record);
        report.remark(
            "speed_up: against the run on one thread that came before it, median over repeats. \
             threads_at_work: processor time over time; where it is below `threads`, others had the \
             processors, and the speed-up is theirs as much as coinmc's.",
        );
        Ok(report)
    }

    fn over_threads(&self, cores: usize, record: &mut Table) -> anyhow::Result<()> {
        let mut counts: Vec<usize> = (0..usize::BITS).map(|i| 1 << i).collect();
        counts.retain(|&threads| threads < cores);
        counts.push(cores);
        let mut taken = vec![Vec::new(); counts.len()];
        for _ in 0..self.repeats {
            for (threads, taken) in counts.iter().zip(&mut taken) {
                taken.push(self.run(self.tosses, *threads)?);
            }
        }
        for (threads, own) in counts.iter().zip(&taken) {
            let pairs = taken[0].iter().zip(own);
            let ratios: Vec<f64> = pairs.map(|(one, own)| one.wall_s / own.wall_s).collect();
            record.push(self.row(self.tosses, *threads, own, Some(number::median(&ratios))));
        }
        Ok(())
    }

    fn over_tosses(&self, cores: usize, record: &mut Table) -> anyhow::Result<()> {
        let mut counts: Vec<u64> = (0..5).map(|i| self.most / 10_u64.pow(i)).collect();
        counts.retain(|&tosses| tosses >= FEWEST);
        for tosses in counts.into_iter().rev() {
            let taken = self.run(tosses, cores)?;
            record.push(self.row(tosses, cores, &[taken], None));
        }
        Ok(())
    }

    fn run(&self, tosses: u64, threads: usize) -> anyhow::Result<Taken> {
        RunApart {
            toss: self.toss,
            tosses,
            threads: NonZeroUsize::new(threads),
        }
        .measure()
    }

    fn row(
        &self,
        tosses: u64,
        threads: usize,
        taken: &[Taken],
        speed_up: Option<f64>,
    ) -> Vec<String> {
        let median = |of: &dyn Fn(&Taken) -> f64| {
            number::median(&taken.iter().map(of).collect::<Vec<f64>>())
        };
        vec![
            self.toss.name().to_owned(),
            tosses.to_string(),
            threads.to_string(),
            format!("{:.0}", median(&|t| tosses as f64 / t.wall_s)),
            format!("{:.0}", median(&|t| tosses as f64 / t.processor_s)),
            speed_up.map_or(String::new(), |ratio| format!("{ratio:.3}")),
            format!("{:.2}", median(&|t| t.processor_s / t.wall_s)),
            format!("{:.1}", median(&|t| t.peak_kb / 1024.0)),
        ]
    }
}
