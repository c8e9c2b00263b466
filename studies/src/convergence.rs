//! How much of P(side) is due to the engine's own settings.
//!
//! Every toss is made with each setting and with a reference in which both are ten times as
//! tight. The bias of a setting is the mean of the differences, toss by toss, so its standard
//! error is that of the few tosses that differ.

use crate::survey::{CASE_COLUMNS, case_cells, survey};
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Engine, Face, Preset};
use coinmc_flat::Settings;

const ZENO: [f64; 6] = [1.0, 0.3, 0.1, 0.03, 0.003, 0.001];
const TOLERANCE: [f64; 5] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-8];

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Convergence {
    /// Tosses of each scene with each setting
    #[arg(long, value_parser = number::count, default_value = "100_000", value_name = "N")]
    tosses: u64,
}

struct Variant {
    name: String,
    settings: Settings,
}

/// How the tosses with one setting differ from the reference's.
#[derive(Debug, Clone, Copy, Default)]
struct Change {
    tosses: u64,
    /// On the side with the setting.
    side: u64,
    /// On the side with the setting only, and with the reference only.
    gained: u64,
    lost: u64,
    /// With another outcome, heads and tails told apart.
    changed: u64,
    /// Impacts and contact steps.
    steps: u64,
}

impl Convergence {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let cases = Case::grid(
            &[Preset::CleanFlat],
            &[0.0, 0.3, 0.5, 0.8],
            &[0.0, 0.3, 1.0],
            &[0.25, 1.0, 2.0],
        );
        let variants = variants();
        let changes = survey(&cases, |case| compare(case, &variants, seed, self.tosses));
        let title = format!(
            "P(side) with a setting minus P(side) with both ten times as tight, {} tosses a scene, \
             paired",
            self.tosses
        );
        let mut record = Table::new(title, &record_columns());
        for (case, changes) in cases.iter().zip(&changes) {
            for (variant, change) in variants.iter().zip(changes) {
                record.push(row(case, variant, change));
            }
        }
        let defaults = (0..cases.len()).map(|case| case * variants.len());
        let shown = record.select("The defaults, scene by scene", defaults);
        let mut report = Report::new(record);
        report.show(summary(&cases, &variants, &changes));
        report.show(shown);
        report.remark(
            "bias: mean difference toss by toss, std_error its standard error. changed: share of \
             tosses with another outcome. rms: of bias/std_error over the scenes in which any toss \
             landed otherwise; 1 where nothing but chance is at work.",
        );
        report.remark(format!(
            "A scene in which none of {} tosses changed has |bias| < {:.0e} with 95 % confidence.",
            self.tosses,
            3.0 / self.tosses as f64
        ));
        report
    }
}

/// The defaults first.
fn variants() -> Vec<Variant> {
    let default = Settings::default();
    let mut variants = vec![Variant {
        name: "default".to_owned(),
        settings: default,
    }];
    variants.extend(ZENO.map(|zeno| Variant {
        name: format!("zeno {zeno}"),
        settings: Settings { zeno, ..default },
    }));
    variants.extend(TOLERANCE.map(|tolerance| Variant {
        name: format!("tolerance {tolerance:e}"),
        settings: Settings {
            tolerance,
            ..default
        },
    }));
    variants
}

fn compare(case: &Case, variants: &[Variant], seed: u64, tosses: u64) -> Vec<Change> {
    let default = Settings::default();
    let tight = Settings {
        zeno: default.zeno / 10.0,
        tolerance: default.tolerance / 10.0,
        ..default
    };
    let reference = case.engine(&tight);
    let engines: Vec<_> = variants.iter().map(|v| case.engine(&v.settings)).collect();
    let mut changes = vec![Change::default(); variants.len()];
    let (launches, stream) = (case.launches(), Case::stream(seed));
    for toss in 0..tosses {
        let launch = launches.launch(&case.scene.coin, &mut stream.toss(toss));
        let expected = reference.toss(&mut (), &launch, &mut ()).face();
        for (engine, change) in engines.iter().zip(&mut changes) {
            let outcome = engine.toss(&mut (), &launch, &mut ());
            change.add(outcome.face(), expected);
            change.steps += u64::from(outcome.impacts) + u64::from(outcome.contact_steps);
        }
    }
    changes
}

impl Change {
    fn add(&mut self, face: Option<Face>, expected: Option<Face>) {
        let (now, before) = (face == Some(Face::Side), expected == Some(Face::Side));
        self.tosses += 1;
        self.side += u64::from(now);
        self.gained += u64::from(now && !before);
        self.lost += u64::from(before && !now);
        self.changed += u64::from(face != expected);
    }

    fn bias(&self) -> f64 {
        (self.gained as f64 - self.lost as f64) / self.tosses as f64
    }

    /// Standard error of the mean of differences that are −1, 0 or 1.
    fn std_error(&self) -> f64 {
        let n = self.tosses as f64;
        let mean_square = (self.gained + self.lost) as f64 / n;
        ((mean_square - self.bias().powi(2)).max(0.0) / n).sqrt()
    }

    fn share(&self, count: u64) -> f64 {
        count as f64 / self.tosses as f64
    }
}

fn record_columns() -> Vec<&'static str> {
    let columns = ["setting", "p_side", "bias", "std_error", "changed"];
    CASE_COLUMNS.into_iter().chain(columns).collect()
}

fn row(case: &Case, variant: &Variant, change: &Change) -> Vec<String> {
    let mut cells = case_cells(case);
    cells.extend([
        variant.name.clone(),
        number::probability(change.share(change.side)),
        number::difference(change.bias()),
        number::probability(change.std_error()),
        number::probability(change.share(change.changed)),
    ]);
    cells
}

/// One row a setting: its worst scene, and all scenes together.
fn summary(cases: &[Case], variants: &[Variant], changes: &[Vec<Change>]) -> Table {
    let mut table = Table::new(
        "Settings (the other at its default), against both ten times as tight as the defaults",
        &[
            "setting",
            "largest_bias",
            "std_error",
            "where",
            "rms",
            "changed",
            "steps_a_toss",
        ],
    );
    for (v, variant) in variants.iter().enumerate() {
        let of_cases = || cases.iter().zip(changes.iter().map(|of_case| of_case[v]));
        let largest = of_cases().max_by(|a, b| a.1.bias().abs().total_cmp(&b.1.bias().abs()));
        let Some((case, worst)) = largest else {
            continue;
        };
        let scores: Vec<f64> = of_cases()
            .filter(|(_, change)| change.std_error() > 0.0)
            .map(|(_, change)| (change.bias() / change.std_error()).powi(2))
            .collect();
        let rms = (scores.iter().sum::<f64>() / scores.len() as f64).sqrt();
        let (mut tosses, mut changed, mut steps) = (0, 0, 0);
        for (_, change) in of_cases() {
            tosses += change.tosses;
            changed += change.changed;
            steps += change.steps;
        }
        table.push(vec![
            variant.name.clone(),
            number::difference(worst.bias()),
            number::probability(worst.std_error()),
            if worst.changed == 0 {
                String::new()
            } else {
                case.to_string()
            },
            if scores.is_empty() {
                "none".to_owned()
            } else {
                format!("{rms:.2}")
            },
            number::probability(changed as f64 / tosses as f64),
            format!("{:.2}", steps as f64 / tosses as f64),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_a_paired_difference_is_that_of_the_tosses_that_differ() {
        let mut change = Change::default();
        let (side, heads) = (Some(Face::Side), Some(Face::Heads));
        for _ in 0..90 {
            change.add(side, side);
        }
        for _ in 0..8 {
            change.add(side, heads);
        }
        change.add(heads, side);
        change.add(None, side);
        assert_eq!((change.side, change.changed), (98, 10));
        assert!((change.bias() - 0.06).abs() < 1e-15);
        // mean square 0.1, mean 0.06, n = 100
        assert!((change.std_error() - ((0.1 - 0.0036) / 100.0_f64).sqrt()).abs() < 1e-15);
    }
}
