//! P(a coin that starts on its rim, rolling or spinning, stays on its side).

use super::arguments::{ratio, slope, wavelength_mm};
use super::engine::Beside;
use super::{Steps, Sums, grid, ground_seed, scene};
use crate::survey::survey;
use clap::{Args, ValueEnum};
use coinmc_bench::{Report, Table, number};
use coinmc_core::{Launch, Scene};
use coinmc_oracle::{RoughStepper, Start};
use coinmc_testkit::Dice;

/// Rate of spinning, rad/s.
const RATE_RAD_S: f64 = 60.0;
/// Largest difference of a coin's lean from that asked for, rad.
const SCATTER_RAD: f64 = 1e-3;

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
    #[arg(long, value_delimiter = ',', value_parser = ratio, default_values = ["0.1", "0.2", "0.4", "0.7071"])]
    ratios: Vec<f64>,

    /// Rms slopes of the ground
    #[arg(long, value_delimiter = ',', value_parser = slope, default_values_t = [0.003, 0.01, 0.03, 0.06])]
    slopes: Vec<f64>,

    /// Wavelengths of the ground, mm
    #[arg(long, value_delimiter = ',', value_parser = wavelength_mm, default_values_t = [1.0, 3.0, 10.0])]
    wavelengths_mm: Vec<f64>,

    /// Speed of those that roll, m/s
    #[arg(long, default_value_t = 0.3, value_name = "SPEED")]
    speed_m_s: f64,

    /// Lean from upright, rad
    #[arg(long, default_value_t = 0.0, value_name = "LEAN")]
    lean_rad: f64,

    #[command(flatten)]
    steps: Steps,

    #[command(flatten)]
    beside: Beside,
}

/// A cell of the grid.
#[derive(Debug, Clone, Copy)]
struct Cell {
    kind: Kind,
    start: Start,
    lean_rad: f64,
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
            "P(side) of coins that start leaning by {} rad, rolling at {} m/s or spinning at \
             {RATE_RAD_S} rad/s",
            self.lean_rad, self.speed_m_s
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
             within ±{SCATTER_RAD} rad of that. It is followed until its energy decides or it rests. \
             most_returned: energy in mgD that steps of contact gained and that was taken back."
        ));
        report
    }

    fn cells(&self) -> Vec<Cell> {
        let grounds = grid(&self.ratios, &self.slopes, &self.wavelengths_mm);
        let of_kind = |&kind: &Kind| {
            let start = kind.start(self.speed_m_s);
            grounds
                .iter()
                .map(move |&(ratio, slope, wavelength_mm)| Cell {
                    kind,
                    start,
                    lean_rad: self.lean_rad,
                    ratio,
                    slope,
                    wavelength_mm,
                })
        };
        self.starts.iter().flat_map(of_kind).collect()
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
        let lean = self.lean_rad + Dice::new(seed, coin).between(-SCATTER_RAD, SCATTER_RAD);
        self.start.launch(&scene.coin, lean)
    }
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Rolling => "rolling",
            Self::Spinning => "spinning",
        }
    }

    fn start(self, speed_m_s: f64) -> Start {
        match self {
            Self::Rolling => Start::Rolling(speed_m_s),
            Self::Spinning => Start::Spinning(RATE_RAD_S),
        }
    }
}
