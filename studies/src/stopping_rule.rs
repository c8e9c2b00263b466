//! Stopping when the energy has fallen to a hundredth, against going on until the face is decided.
//!
//! The rule is that of Gaek & Sukhov, arXiv 2401.03557. It can only differ where a hundredth of
//! the energy is more than the barrier m g D: where the drop height is beyond 100 D or so.

use crate::survey::{side, survey, tally};
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Estimate, IntervalMethod, Preset, Tally};
use coinmc_flat::{Decision, Settings};

/// Share of the initial energy at which the rule stops.
const FRACTION: f64 = 0.01;
const FRICTION: f64 = 0.3;
const RADII_M: [f64; 4] = [0.001, 0.002, 0.005, 0.01];
const RESTITUTIONS: [f64; 3] = [0.3, 0.5, 0.7];
const RATIOS: [f64; 5] = [0.5, 1.0, 1.5, 2.0, 2.5];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct StoppingRule {
    /// Tosses of each scene under each rule
    #[arg(long, value_parser = number::count, default_value = "100_000", value_name = "N")]
    tosses: u64,
}

struct Compared {
    case: Case,
    certain: Tally,
    early: Tally,
}

impl StoppingRule {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let cases = cases();
        let compared = survey(&cases, |case| {
            let under = |decision| {
                let settings = Settings {
                    decision,
                    ..Settings::default()
                };
                tally(case, &case.engine(&settings), seed, 0..self.tosses)
            };
            Compared {
                case: *case,
                certain: under(Decision::Energy),
                early: under(Decision::EnergyFraction(FRACTION)),
            }
        });
        let columns = [
            "radius_m",
            "height_over_100_d",
            "disagree",
            "disagree_lo",
            "disagree_hi",
            "p_side_certain",
            "p_side_rule",
            "difference",
        ];
        let title = format!(
            "Stopping at {FRACTION} of the energy against certainty, {} tosses a scene (95 % \
             intervals)",
            self.tosses
        );
        let mut record = Table::new(title, &Case::columns(&columns));
        for one in &compared {
            record.push(one.row());
        }
        let differing = (0..compared.len()).filter(|&i| compared[i].early.overruled > 0);
        let shown = record.select("Scenes in which the rules ever disagree", differing);
        let mut report = Report::new(record);
        report.show(shown);
        for preset in [Preset::Robot, Preset::CleanFlat] {
            report.remark(remark(preset, &compared));
        }
        report
    }
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for preset in [Preset::Robot, Preset::CleanFlat] {
        for radius in RADII_M {
            for e in RESTITUTIONS {
                cases.extend(RATIOS.map(|x| Case::new(preset, radius, x, e, FRICTION)));
            }
        }
    }
    cases
}

fn remark(preset: Preset, compared: &[Compared]) -> String {
    let of_preset = || compared.iter().filter(|one| one.case.preset == preset);
    let share = |one: &&Compared| one.disagreement().p;
    let worst = of_preset().max_by(|a, b| share(a).total_cmp(&share(b)));
    let never = of_preset().filter(|one| one.early.overruled == 0).count();
    match worst {
        Some(worst) if worst.early.overruled > 0 => format!(
            "{preset}: at most {:.2} % of tosses ({}); never in {never} of {} scenes",
            100.0 * worst.disagreement().p,
            worst.case,
            of_preset().count(),
        ),
        _ => format!("{preset}: the rules never disagree"),
    }
}

impl Compared {
    /// Share of tosses on which the rules disagree.
    fn disagreement(&self) -> Estimate {
        let (n, method) = (self.early.tosses(), IntervalMethod::Wilson);
        Estimate::new(self.early.overruled, 0, n, 0.95, method)
    }

    /// Drop height over 100 D: the rule can differ from about 1 up (spin adds a little).
    fn height_over_100_d(&self) -> f64 {
        let height = self.case.launches().height_m.quantile(0.5);
        height / (100.0 * self.case.scene.coin.rim_distance_m())
    }

    fn row(&self) -> Vec<String> {
        let (certain, early) = (side(&self.certain).p, side(&self.early).p);
        let disagree = self.disagreement();
        let mut cells = self.case.cells();
        cells.extend([
            self.case.scene.coin.radius_m().to_string(),
            format!("{:.2}", self.height_over_100_d()),
            number::probability(disagree.p),
            number::probability(disagree.lo),
            number::probability(disagree.hi),
            number::probability(certain),
            number::probability(early),
            number::difference(early - certain),
        ]);
        cells
    }
}
