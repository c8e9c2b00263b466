//! P(side) of whole tosses onto rough ground.

use super::arguments::{ratio, slope, wavelength_mm};
use super::engine::Beside;
use super::{Steps, Sums, grid, ground_seed, scene};
use crate::survey::survey;
use anyhow::ensure;
use clap::{Args, ValueEnum};
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{LaunchDistribution, Preset};
use coinmc_oracle::RoughStepper;
use coinmc_testkit::hand_at;

/// How coins are tossed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Way {
    /// By hand, as in examples/hand.toml
    Hand,
    /// Dropped at any orientation, without spin
    Drop,
}

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct RoughTosses {
    /// Tosses of each scene
    #[arg(long, value_parser = number::count, default_value = "400", value_name = "N")]
    tosses: u64,

    /// Number of the first toss: a long study can be made in parts
    #[arg(long, value_parser = number::count_or_zero, default_value = "0", value_name = "N")]
    first: u64,

    /// How they are tossed
    #[arg(long, value_enum, default_value = "hand", value_name = "WAY")]
    launch: Way,

    /// Angle between spin and axis of tosses by hand, degrees [default: 75]
    #[arg(long, value_name = "PSI")]
    psi_deg: Option<f64>,

    /// H/R
    #[arg(long, value_delimiter = ',', value_parser = ratio, default_values = ["0.2", "0.7071"])]
    ratios: Vec<f64>,

    /// Rms slopes of the ground: smooth, wood, rough
    #[arg(long, value_delimiter = ',', value_parser = slope, default_values_t = [0.003, 0.02, 0.05])]
    slopes: Vec<f64>,

    /// Wavelengths of the ground, mm
    #[arg(long, value_delimiter = ',', value_parser = wavelength_mm, default_values_t = [3.0])]
    wavelengths_mm: Vec<f64>,

    #[command(flatten)]
    steps: Steps,

    #[command(flatten)]
    beside: Beside,
}

impl RoughTosses {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        ensure!(
            self.launch == Way::Hand || self.psi_deg.is_none(),
            "--psi-deg is the angle of a toss by hand: a dropped coin does not turn"
        );
        let scenes = grid(&self.ratios, &self.slopes, &self.wavelengths_mm);
        let found = survey(&scenes, |scene| self.follow(*scene, seed));
        let mut columns = vec!["ratio", "slope", "wavelength_mm"];
        columns.extend(Sums::COLUMNS);
        columns.extend(Beside::COLUMNS);
        let title = format!("P(side) of tosses {}, on rough ground", self.how());
        let mut record = Table::new(title, &columns);
        for ((ratio, slope, wavelength_mm), sums) in scenes.iter().zip(&found) {
            let mut row = vec![
                ratio.to_string(),
                slope.to_string(),
                wavelength_mm.to_string(),
            ];
            let scene = scene(*ratio);
            row.extend(sums.cells(&self.steps, &scene));
            let launches = self.launches();
            let ground = (*slope, *wavelength_mm);
            row.extend(self.beside.cells(&scene, ground, |toss| {
                launches.launch(&scene.coin, &mut Case::stream(seed).toss(toss))
            }));
            record.push(row);
        }
        let mut report = Report::new(record);
        report.remark("Each toss lands on a ground of its own.");
        Ok(report)
    }

    fn follow(&self, (ratio, slope, wavelength_mm): (f64, f64, f64), seed: u64) -> Sums {
        let scene = scene(ratio);
        let launches = self.launches();
        let mut stepper = RoughStepper::new(&scene, self.steps.settings());
        let mut sums = Sums::default();
        for toss in self.first..self.first.saturating_add(self.tosses) {
            let mut uniforms = Case::stream(seed).toss(toss);
            let launch = launches.launch(&scene.coin, &mut uniforms);
            let seed = ground_seed(seed, toss);
            let mut ground = stepper.ground(slope, 1e-3 * wavelength_mm, seed);
            sums.add(&stepper.toss(&launch, &mut ground));
        }
        sums
    }

    /// Angle between spin and axis of tosses by hand, degrees.
    fn psi_deg(&self) -> f64 {
        /// As in `examples/hand.toml`.
        const USUAL: f64 = 75.0;
        self.psi_deg.unwrap_or(USUAL)
    }

    fn how(&self) -> String {
        match self.launch {
            Way::Hand => format!("by hand, psi {} degrees", self.psi_deg()),
            Way::Drop => "dropped without spin".to_owned(),
        }
    }

    fn launches(&self) -> LaunchDistribution {
        match self.launch {
            Way::Hand => hand_at(self.psi_deg()),
            Way::Drop => Preset::Drop.distribution(),
        }
    }
}
