//! Coins on explicit rough ground, by the time-stepping oracle, and by the engine beside it.

mod arguments;
mod engine;
mod starts;
mod tosses;

pub(crate) use starts::RoughStarts;
pub(crate) use tosses::RoughTosses;

use clap::Args;
use coinmc_core::{Coin, Scene, Surface};
use coinmc_oracle::{RoughHistory, RoughSettings};

/// Radius of a 1 euro coin, m.
const RADIUS_M: f64 = 0.0116;
const RESTITUTION: f64 = 0.5;
const FRICTION: f64 = 0.3;
/// Rolling and pivoting friction lengths, m.
const CONTOUR_M: f64 = 5e-5;
const PIVOTING_M: f64 = 5e-6;

/// How finely the oracle follows a coin.
#[derive(Debug, Clone, Copy, Args)]
struct Steps {
    /// The oracle's longest step near the ground, in sqrt(D/g)
    #[arg(long, default_value_t = RoughSettings::default().step, value_name = "STEP")]
    step: f64,

    /// The longest way of the contact along the ground in a step, in correlation lengths
    #[arg(long, default_value_t = RoughSettings::default().advance, value_name = "SHARE")]
    advance: f64,
}

impl Steps {
    fn settings(&self) -> RoughSettings {
        RoughSettings {
            step: self.step,
            advance: self.advance,
            ..RoughSettings::default()
        }
    }
}

/// The scene of this H/R.
fn scene(ratio: f64) -> Scene {
    let coin = Coin::cylinder(ratio, RADIUS_M).expect("the ratio is positive");
    let surface = Surface::new(RESTITUTION, FRICTION)
        .and_then(|surface| surface.with_friction_lengths(CONTOUR_M, PIVOTING_M))
        .expect("the constants are in range");
    Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("gravity is positive")
}

/// All combinations of H/R, slope and wavelength in mm.
fn grid(ratios: &[f64], slopes: &[f64], wavelengths_mm: &[f64]) -> Vec<(f64, f64, f64)> {
    let mut grid = Vec::new();
    for &ratio in ratios {
        for &slope in slopes {
            grid.extend(wavelengths_mm.iter().map(|&wave| (ratio, slope, wave)));
        }
    }
    grid
}

/// The seed of a toss's ground: the same in every scene.
fn ground_seed(seed: u64, toss: u64) -> u64 {
    seed.wrapping_shl(32).wrapping_add(toss)
}

/// Sums over the coins of a scene.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    coins: u64,
    side: u64,
    undecided: u64,
    time: f64,
    way: f64,
    impacts: u64,
    steps: u64,
    unconverged: u64,
    returned: f64,
    gained: f64,
}

impl Sums {
    fn add(&mut self, history: &RoughHistory) {
        self.coins += 1;
        self.side += u64::from(history.face == Some(coinmc_core::Face::Side));
        self.undecided += u64::from(history.face.is_none());
        self.time += history.time;
        self.way += history.way;
        self.impacts += u64::from(history.impacts);
        self.steps += history.steps;
        self.unconverged += history.unconverged;
        self.returned = self.returned.max(history.returned);
        self.gained = self.gained.max(history.gained);
    }

    const COLUMNS: [&str; 12] = [
        "step",
        "coins",
        "on_side",
        "undecided",
        "p_side",
        "std_error",
        "mean_time_s",
        "mean_way_m",
        "impacts",
        "unconverged",
        "most_returned",
        "most_gained",
    ];

    fn cells(&self, steps: &Steps, scene: &Scene) -> Vec<String> {
        let n = self.coins as f64;
        let p = self.side as f64 / n;
        // Laplace's rule, so that 0 and 1 have an error as well
        let smoothed = (self.side as f64 + 1.0) / (n + 2.0);
        vec![
            steps.step.to_string(),
            self.coins.to_string(),
            self.side.to_string(),
            self.undecided.to_string(),
            format!("{p:.4}"),
            format!("{:.4}", (smoothed * (1.0 - smoothed) / n).sqrt()),
            format!("{:.3}", self.time / n * scene.time_scale_s()),
            format!("{:.4}", self.way / n * scene.coin.rim_distance_m()),
            format!("{:.1}", self.impacts as f64 / n),
            format!("{:.1e}", self.unconverged as f64 / self.steps.max(1) as f64),
            format!("{:.1e}", self.returned),
            format!("{:.1e}", self.gained),
        ]
    }
}
