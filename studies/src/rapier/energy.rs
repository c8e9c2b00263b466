//! How far the energy of a toss rises above its value at launch.

use crate::survey::survey;
use clap::Args;
use coinmc_bench::rapier::{Tosser, cases};
use coinmc_bench::{Case, Report, Table, number};
use coinmc_rapier::{Flight, Gyroscopic, Settings};

/// A rise that is rounding, as a fraction of the energy at launch.
const ROUNDING: f64 = 1e-12;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct RapierEnergy {
    /// Tosses of each scene
    #[arg(long, value_parser = number::count, default_value = "60", value_name = "N")]
    tosses: u64,
}

impl RapierEnergy {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let mut jobs: Vec<(Case, Settings)> = Vec::new();
        for ratio in [0.25, 1.0, 2.0] {
            let [clean, table1] = cases(ratio);
            for flight in [Flight::Contact, Flight::Off] {
                for gyroscopic in Gyroscopic::ALL {
                    let step = |step_s| Settings {
                        step_s,
                        flight,
                        gyroscopic,
                        // whatever it rises to is to be seen
                        max_gain: 1e6,
                        ..Settings::default()
                    };
                    jobs.extend([5e-3, 1e-3].map(|s| (clean, step(s))));
                    if gyroscopic == Gyroscopic::Exact {
                        jobs.push((table1, step(2e-2)));
                    }
                }
            }
        }
        let found = survey(&jobs, |(case, settings)| self.gains(case, settings, seed));
        let columns = [
            "scene",
            "ratio",
            "step_s",
            "flight",
            "gyroscopic",
            "tosses",
            "above",
            "median",
            "worst",
        ];
        let mut record = Table::new("Rise of the energy above its value at launch", &columns);
        let mut worst_of_defaults = f64::NEG_INFINITY;
        for ((case, settings), gains) in jobs.iter().zip(found) {
            let gains = gains?;
            let worst = gains.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if settings.flight == Flight::Contact && settings.gyroscopic == Gyroscopic::Exact {
                worst_of_defaults = worst_of_defaults.max(worst);
            }
            let above = gains.iter().filter(|gain| **gain > ROUNDING).count();
            record.push(vec![
                case.preset.to_string(),
                case.scene.coin.ratio().to_string(),
                format!("{:.0e}", settings.step_s),
                settings.flight.name().to_owned(),
                settings.gyroscopic.name().to_owned(),
                gains.len().to_string(),
                number::probability(above as f64 / gains.len() as f64),
                format!("{:+.1e}", number::median(&gains)),
                format!("{worst:+.1e}"),
            ]);
        }
        let mut report = Report::new(record);
        report.remark(format!(
            "worst rise with the default settings: {worst_of_defaults:+.1e} of the energy at launch"
        ));
        report.remark(
            "The largest value at the end of any of Rapier's steps, minus that at launch, over that \
             at launch. above: share of tosses in which it is positive by more than rounding.",
        );
        Ok(report)
    }

    fn gains(&self, case: &Case, settings: &Settings, seed: u64) -> anyhow::Result<Vec<f64>> {
        let mut gains = Vec::new();
        Tosser::new(case, settings)?.examine_all(
            seed,
            0..self.tosses,
            || true,
            |_, account| {
                // a toss that is decided before its first step has none
                if account.steps > 0 {
                    gains.push(account.energy_gain);
                }
            },
        );
        Ok(gains)
    }
}
