//! Stress of the line contact: the balance of energy, and that every impact ends in numbers.

use super::{impact, line, scene, touch};
use crate::survey::survey;
use clap::Args;
use coinmc_bench::{Report, Table, number};
use coinmc_core::State;
use coinmc_flat::Materials;
use coinmc_testkit::Dice;
use std::f64::consts::{FRAC_PI_2, PI};

/// Young's modulus of both bodies, Pa: one row each, log-uniform from one to the next.
const YOUNG_PA: [f64; 8] = [1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct ImpactBalance {
    /// Impacts of each row
    #[arg(long, value_parser = number::count, default_value = "5_000", value_name = "N")]
    impacts: u64,

    /// Error allowed per step
    #[arg(long, default_value_t = 1e-6, value_name = "X")]
    tolerance: f64,
}

/// The worst of the impacts of a row.
#[derive(Default)]
struct Worst {
    imbalance: f64,
    gain: f64,
    kept_gain: f64,
    steps: u32,
    unresolved: u32,
    stays: u64,
    not_finite: u64,
}

impl ImpactBalance {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let columns = [
            "young_pa",
            "impacts",
            "worst_imbalance",
            "worst_gain",
            "gain_kept",
            "most_steps",
            "stays",
            "unresolved",
            "not_finite",
        ];
        let title = format!(
            "Line contact, tolerance {:e}: speeds 1e-6 to 1e3 m/s, H/R 0.05 to 20, every tilt, e .01 to \
             1, friction 0 to 10",
            self.tolerance
        );
        let mut record = Table::new(title, &columns);
        let places: Vec<usize> = (0..YOUNG_PA.len()).collect();
        let rows = survey(&places, |&place| self.row(place, seed));
        for (young, worst) in YOUNG_PA.iter().zip(&rows) {
            record.push(vec![
                format!("{young:e}"),
                self.impacts.to_string(),
                number::tiny(worst.imbalance),
                number::tiny(worst.gain),
                number::tiny(worst.kept_gain),
                worst.steps.to_string(),
                worst.stays.to_string(),
                worst.unresolved.to_string(),
                worst.not_finite.to_string(),
            ]);
        }
        let mut report = Report::new(record);
        report.remark(
            "worst_imbalance: energy that the integration lost track of, over the energy before. \
             worst_gain: of impacts that leave the surface, before the engine takes it back; gain_kept: \
             after. unresolved: given up and done by Moreau's law.",
        );
        report
    }

    fn row(&self, place: usize, seed: u64) -> Worst {
        let mut worst = Worst::default();
        for trial in 0..self.impacts {
            let mut dice = Dice::new(seed.wrapping_add(place as u64), trial);
            let young = YOUNG_PA[place];
            let materials = Materials {
                coin_young_pa: young,
                coin_poisson: 0.3,
                surface_young_pa: young,
                surface_poisson: 0.3,
                length_m: super::LENGTH_M,
            };
            let scene = scene(
                dice.scale(0.05, 20.0),
                dice.pick(&[0.01, 0.1, 0.3, 0.7, 0.95, 1.0]),
                dice.pick(&[0.0, 0.1, 0.5, 2.0, 10.0]),
            );
            let over = libm::atan2(2.0, scene.coin.ratio());
            let flat = f64::from(dice.pick(&[0_u8, 1, 2, 3])) * FRAC_PI_2;
            let near = dice.pick(&[-1.0, 1.0]) * dice.scale(1e-16, 1e-2);
            let any = dice.between(-PI, PI);
            let tilts = [flat, flat + near, over, over + near, -over, any, any];
            let theta = dice.pick(&tilts);
            let speed = dice.scale(1e-6, 1e3);
            let fall = speed * dice.pick(&[0.0, 1e-3, 1.0, 1.0]);
            let (vx, rim) = (dice.between(-1.0, 1.0), dice.between(-1.0, 1.0));
            let launch = touch(
                theta,
                vx * speed,
                -fall,
                rim * speed / scene.coin.radius_m(),
            );
            let law = line(materials, dice.pick(&[0.1, 0.8, 0.8, 10.0]));
            let found = impact(&scene, law, self.tolerance, &launch);
            let energy = |state: &State| state.energy_j_kg(&scene);
            let (before, mass) = (energy(&found.before), scene.coin.mass_kg());
            worst.not_finite += u64::from(!energy(&found.after).is_finite());
            worst.unresolved += found.breaks.unresolved;
            worst.steps = worst.steps.max(found.steps);
            worst.stays += u64::from(found.stays);
            worst.kept_gain = worst.kept_gain.max(energy(&found.after) / before - 1.0);
            if found.breaks.unresolved == 0 {
                let imbalance = found.imbalance_j.abs() / mass / before;
                worst.imbalance = worst.imbalance.max(imbalance);
                if !found.stays {
                    worst.gain = worst.gain.max(found.gain_j / mass / before);
                }
            }
        }
        worst
    }
}
