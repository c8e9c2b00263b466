//! Tosses a second with all skips, against the naive loop at the same step.

use super::{RATIOS, Tosser, cases};
use crate::number;
use crate::report::{Report, Table};
use clap::Args;
use coinmc_bench::Case;
use coinmc_rapier::{Decision, Flight, Settings};
use std::time::Instant;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct RapierSpeed {
    /// Tosses of each scene, made both ways in turn
    #[arg(long, value_parser = number::count, default_value = "40", value_name = "N")]
    tosses: u64,

    /// Step in the scene clean, s
    #[arg(long, default_value_t = 1e-3, value_name = "S")]
    clean_step: f64,

    /// Step in the scene table1, s
    #[arg(long, default_value_t = 2e-2, value_name = "S")]
    table1_step: f64,
}

/// One way of making tosses.
#[derive(Default)]
struct Way {
    seconds: f64,
    steps: u64,
    undecided: u64,
}

impl RapierSpeed {
    pub(crate) fn carry_out(&self, seed: u64) -> anyhow::Result<Report> {
        let columns = [
            "scene",
            "ratio",
            "step_s",
            "skipping",
            "naive",
            "ratio_of_rates",
            "ratio_of_steps",
            "steps_a_toss",
            "naive_steps",
            "us_a_step",
            "naive_undecided",
        ];
        let title = format!(
            "Tosses a second on one core: all skips against stepped flight and waiting for rest, {} \
             tosses a scene in turn",
            self.tosses
        );
        let mut record = Table::new(title, &columns);
        let mut table1 = Vec::new();
        for (scene, step) in [self.clean_step, self.table1_step].into_iter().enumerate() {
            for ratio in RATIOS {
                let case = cases(ratio)[scene];
                let [skips, naive] = self.both(&case, step, seed)?;
                if scene == 1 {
                    table1.push(skips.seconds / self.tosses as f64);
                }
                record.push(self.row(&case, step, &skips, &naive));
            }
        }
        let mean = table1.iter().sum::<f64>() / table1.len() as f64;
        let mut report = Report::new(record);
        report.remark(format!(
            "1e6 tosses of table1, its ratios in equal parts, take {:.0} minutes on two such cores.",
            1e6 * mean / 60.0 / 2.0
        ));
        report.remark(
            "naive: Rapier steps the flight, and a toss ends when the coin rests or at the limit of \
             time (naive_undecided: a coin that rolls or spins has no rest). Rates are wall time and \
             depend on what else the machine does; ratio_of_steps does not.",
        );
        Ok(report)
    }

    /// Toss after toss in both ways, so that a busy machine favours neither.
    fn both(&self, case: &Case, step_s: f64, seed: u64) -> anyhow::Result<[Way; 2]> {
        let skips = Settings {
            step_s,
            ..Settings::default()
        };
        let naive = Settings {
            flight: Flight::Off,
            decision: Decision::Rest,
            skip_standing: false,
            ..skips
        };
        let mut tossers = [Tosser::new(case, &skips)?, Tosser::new(case, &naive)?];
        let mut ways = [Way::default(), Way::default()];
        for toss in 0..self.tosses {
            for (tosser, way) in tossers.iter_mut().zip(&mut ways) {
                let launch = tosser.launch(seed, toss);
                let start = Instant::now();
                let account = tosser.examine(&launch);
                way.seconds += start.elapsed().as_secs_f64();
                way.steps += u64::from(account.steps);
                way.undecided += u64::from(account.outcome.face().is_none());
            }
        }
        Ok(ways)
    }

    fn row(&self, case: &Case, step: f64, skips: &Way, naive: &Way) -> Vec<String> {
        let tosses = self.tosses as f64;
        vec![
            case.preset.to_string(),
            case.scene.coin.ratio().to_string(),
            format!("{step:.0e}"),
            format!("{:.0}", tosses / skips.seconds),
            format!("{:.1}", tosses / naive.seconds),
            format!("{:.1}", naive.seconds / skips.seconds),
            format!("{:.1}", naive.steps as f64 / skips.steps as f64),
            format!("{:.0}", skips.steps as f64 / tosses),
            format!("{:.0}", naive.steps as f64 / tosses),
            format!("{:.1}", 1e6 * skips.seconds / skips.steps as f64),
            naive.undecided.to_string(),
        ]
    }
}
