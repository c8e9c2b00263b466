//! How fast the toss in space is, beside the flat toss, and how far off at that speed.

use super::paired::Paired;
use super::{survey_tosses, tightened};
use crate::number;
use crate::report::{Report, Table};
use anyhow::Context;
use clap::Args;
use coinmc_bench::{Case, Workload, space_workloads, workloads};
use coinmc_volumetric::Settings;
use std::hint::black_box;
use std::time::Instant;

/// The flat toss that all are compared with.
const FLAT: &str = "toss clean-flat x=1.2 e=0.5 mu=0.3";

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct SpaceSpeed {
    /// Tosses of each timed run
    #[arg(long, value_parser = number::count, default_value = "200_000", value_name = "N")]
    tosses: u64,

    /// Timed runs of each scene
    #[arg(long, value_parser = number::count, default_value = "5", value_name = "N")]
    repeats: u64,

    /// Tosses that are made again with settings ten times as tight, for the bias
    #[arg(long, value_parser = number::count, default_value = "1_000_000", value_name = "N")]
    paired: u64,
}

impl SpaceSpeed {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let all = workloads();
        let flat = all.iter().find(|work| work.name == FLAT);
        let flat = flat.with_context(|| format!("no piece of work is called `{FLAT}`"))?;
        let space = space_workloads();
        let cases: Vec<Case> = space.iter().filter_map(Workload::case_in_space).collect();
        let seconds = self.time(flat, &space);
        let default = Settings::default();
        let tight = tightened(&default);
        let biases = survey_tosses(
            &cases,
            self.paired,
            |case, tosses| Paired::of(case, [&default, &tight], seed, tosses),
            Paired::merge,
        );
        let columns = [
            "work",
            "tosses_a_second",
            "lowest",
            "highest",
            "of_the_flat_rate",
            "impacts_a_toss",
            "contact_steps_a_toss",
            "p_side",
            "bias",
            "std_error",
        ];
        let title = format!(
            "One core, {} repeats of {} tosses; bias from {} paired tosses",
            self.repeats, self.tosses, self.paired
        );
        let mut record = Table::new(title, &columns);
        record.push(self.row(&flat.name, &seconds[0], &seconds[0], None));
        for (i, work) in space.iter().enumerate() {
            let bias = biases.get(i);
            record.push(self.row(&work.name, &seconds[i + 1], &seconds[0], bias));
        }
        let mut report = Report::new(record);
        report.remark(
            "Rates are medians; the flat toss is timed in every repeat, and of_the_flat_rate is the \
             median of the ratios: it holds on a busy machine as well. bias: P(side) with the \
             default settings minus that with all of them ten times as tight.",
        );
        Ok(report)
    }

    /// Seconds of every repeat, of the flat toss and of each in space. Every other repeat goes
    /// backwards, so that a drift of the machine's speed favours none.
    fn time(&self, flat: &Workload, space: &[Workload]) -> Vec<Vec<f64>> {
        let works: Vec<&Workload> = std::iter::once(flat).chain(space).collect();
        let mut seconds = vec![Vec::new(); works.len()];
        for repeat in 0..self.repeats {
            for i in 0..works.len() {
                let i = if repeat % 2 == 0 {
                    i
                } else {
                    works.len() - 1 - i
                };
                let start = Instant::now();
                black_box(works[i].run(0..self.tosses));
                seconds[i].push(start.elapsed().as_secs_f64());
            }
        }
        seconds
    }

    fn row(&self, name: &str, own: &[f64], flat: &[f64], bias: Option<&Paired>) -> Vec<String> {
        let rates: Vec<f64> = own.iter().map(|s| self.tosses as f64 / s).collect();
        let ratios: Vec<f64> = flat.iter().zip(own).map(|(flat, own)| flat / own).collect();
        let lowest = rates.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = rates.iter().copied().fold(0.0, f64::max);
        let mut row = vec![name.to_owned()];
        row.extend([number::median(&rates), lowest, highest].map(|rate| format!("{rate:.0}")));
        row.push(format!("{:.3}", number::median(&ratios)));
        row.extend(match bias {
            Some(paired) => {
                let a_toss = |count| format!("{:.2}", count as f64 / self.paired as f64);
                vec![
                    a_toss(paired.first.impacts),
                    a_toss(paired.first.contact_steps),
                    number::probability(paired.side().p),
                    number::difference(paired.bias()),
                    number::probability(paired.std_error()),
                ]
            }
            None => vec![String::new(); 5],
        });
        row
    }
}
