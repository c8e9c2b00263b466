//! P(a coin that starts upright, rolling or spinning, stays on its side).

use super::engine::Beside;
use super::{Steps, Sums, ground_seed, scene};
use crate::survey::survey;
use clap::{Args, ValueEnum};
use coinmc_bench::{Report, Table, number};
use coinmc_core::{Launch, Scene};
use coinmc_oracle::{RoughStepper, Start};
use coinmc_testkit::Dice;

/// Speed of rolling, m/s.
const SPEED_M_S: f64 = 0.3;
/// Rate of spinning, rad/s.
const RATE_RAD_S: f64 = 60.0;
/// Largest lean, rad.
const LEAN_RAD: f64 = 1e-3;

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    Rolling,
    Spinning,
}

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct RoughStarts {
    /// Coins of each scene
    #[arg(long, value_parser = number::count, default_value = "40", value_name = "N")]
    coins: u64,

    /// How they start
    #[arg(long, value_enum, value_delimiter = ',', default_values = ["rolling", "spinning"])]
    starts: Vec<Kind>,

    /// H/R
    #[arg(long, value_delimiter = ',', default_values = ["0.1", "0.2", "0.4", "0.7071"])]
    ratios: Vec<f64>,

    /// Rms slopes of the ground
    #[arg(long, value_delimiter = ',', default_values_t = [0.003, 0.01, 0.03, 0.06])]
    slopes: Vec<f64>,

    /// Wavelengths of the ground, mm
    #[arg(long, value_delimiter = ',', default_values_t = [1.0, 3.0, 10.0])]
    wavelengths_mm: Vec<f64>,

    #[command(flatten)]
    steps: Steps,

    #[command(flatten)]
    beside: Beside,
}

/// A cell of the grid.
#[derive(Debug, Clone, Copy)]
struct Cell {
    kind: Kind,
    ratio: f64,
    slope: f64,
    wavelength_mm: f64,
}

impl RoughStarts {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let cells = self.cells();
        let found = survey(&cells, |cell| self.follow(cell, seed));
        let mut columns = vec!["start", "ratio", "slope", "wavelength_mm"];
        columns.extend(Sums::COLUMNS);
        columns.extend(Beside::COLUMNS);
        let title = format!(
            "P(side) of coins that start upright, rolling at {SPEED_M_S} m/s or spinning at \
             {RATE_RAD_S} rad/s"
        );
        let mut record = Table::new(title, &columns);
        for (cell, sums) in cells.iter().zip(&found) {
            let mut row = vec![
                cell.kind.name().to_owned(),
                cell.ratio.to_string(),
                cell.slope.to_string(),
                cell.wavelength_mm.to_string(),
            ];
            let scene = scene(cell.ratio);
            row.extend(sums.cells(&self.steps, &scene));
            let ground = (cell.slope, cell.wavelength_mm);
            row.extend(
                self.beside
                    .cells(&scene, ground, |coin| cell.launch(&scene, seed, coin)),
            );
            record.push(row);
        }
        let mut report = Report::new(record);
        report.remark(format!(
            "Each coin has a ground of its own, the same in every scene up to its scale, and a lean \
             within ±{LEAN_RAD} rad. It is followed until its energy decides or it rests. \
             most_returned: energy in mgD that steps of contact gained and that was taken back."
        ));
        report
    }

    fn cells(&self) -> Vec<Cell> {
        let mut cells = Vec::new();
        for &kind in &self.starts {
            for &ratio in &self.ratios {
                for &slope in &self.slopes {
                    cells.extend(self.wavelengths_mm.iter().map(|&wavelength_mm| Cell {
                        kind,
                        ratio,
                        slope,
                        wavelength_mm,
                    }));
                }
            }
        }
        cells
    }

    fn follow(&self, cell: &Cell, seed: u64) -> Sums {
        let scene = scene(cell.ratio);
        let mut stepper = RoughStepper::new(&scene, self.steps.settings());
        let mut sums = Sums::default();
        for coin in 0..self.coins {
            let launch = cell.launch(&scene, seed, coin);
            let seed = ground_seed(seed, coin);
            let mut ground = stepper.ground(cell.slope, 1e-3 * cell.wavelength_mm, seed);
            sums.add(&stepper.placed(&launch, &mut ground));
        }
        sums
    }
}

impl Cell {
    fn launch(&self, scene: &Scene, seed: u64, coin: u64) -> Launch {
        let lean = Dice::new(seed, coin).between(-LEAN_RAD, LEAN_RAD);
        self.kind.start().launch(&scene.coin, lean)
    }
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Rolling => "rolling",
            Self::Spinning => "spinning",
        }
    }

    fn start(self) -> Start {
        match self {
            Self::Rolling => Start::Rolling(SPEED_M_S),
            Self::Spinning => Start::Spinning(RATE_RAD_S),
        }
    }
}
