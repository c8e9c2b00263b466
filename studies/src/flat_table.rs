//! P(side) in scenes that others have computed.

use crate::survey::{side, survey, tally};
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Estimate, Preset};
use coinmc_flat::Settings;

const RATIOS: [f64; 4] = [1.0, 1.2, 1.5, 1.7];

/// P(side) of an earlier event-driven study of ours, by restitution and ratio: preset clean-flat,
/// no friction, R = 1 cm, each within 0.003.
const EARLIER: [(f64, [f64; 4]); 4] = [
    (0.0, [0.105, 0.148, 0.291, 0.383]),
    (0.3, [0.107, 0.185, 0.311, 0.402]),
    (0.5, [0.132, 0.207, 0.319, 0.394]),
    (0.7, [0.101, 0.181, 0.303, 0.392]),
];

/// (program, ratio, P(side), its standard error) at e = 0.5 and μ = 0.3, preset clean-flat: 2000
/// tosses with steps of 0.25 ms each. Where the error was not noted it is that of 2000 tosses.
const STEPPED: [(&str, f64, f64, f64); 4] = [
    ("Chipmunk", 1.0, 0.077, 0.006),
    ("Chipmunk", 1.5, 0.248, 0.010),
    ("Box2D", 1.0, 0.078, 0.006),
    ("Box2D", 1.5, 0.234, 0.009),
];

/// Farthest a value may lie from the earlier study's.
const AGREEMENT: f64 = 0.004;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct FlatTable {
    /// Tosses of each scene
    #[arg(long, value_parser = number::count, default_value = "1_000_000", value_name = "N")]
    tosses: u64,
}

/// A value of others and the scene it belongs to.
struct Entry {
    case: Case,
    inertia: &'static str,
    source: &'static str,
    value: f64,
    error: f64,
}

impl FlatTable {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let entries = entries();
        let settings = Settings::default();
        let estimates = survey(&entries, |entry| {
            side(&tally(
                &entry.case,
                &entry.case.engine(&settings),
                seed,
                0..self.tosses,
            ))
        });
        let mut record = Table::new(
            format!(
                "P(side) of {} tosses a scene against values of others (clean-flat, R = 1 cm; \
                 95 % intervals)",
                self.tosses
            ),
            &[
                "source",
                "inertia",
                "restitution",
                "friction",
                "ratio",
                "p_side",
                "p_side_lo",
                "p_side_hi",
                "reference",
                "its_error",
                "difference",
            ],
        );
        for (entry, p) in entries.iter().zip(&estimates) {
            record.push(entry.row(p));
        }
        let mut report = Report::new(record);
        for inertia in INERTIAS {
            let found = entries.iter().zip(&estimates);
            let of_inertia = found.filter(|(entry, _)| entry.inertia == inertia);
            report.remark(agreement(inertia, &of_inertia.collect::<Vec<_>>()));
        }
        report
    }
}

/// How well the earlier study's table is met with one moment of inertia.
fn agreement(inertia: &str, found: &[(&Entry, &Estimate)]) -> String {
    let earlier = || {
        found
            .iter()
            .filter(|(entry, _)| entry.source == EARLIER_STUDY)
    };
    let bouncing = || earlier().filter(|(entry, _)| entry.case.scene.surface.restitution() >= 0.3);
    let difference = |(entry, p): &(&Entry, &Estimate)| p.p - entry.value;
    let largest = bouncing()
        .map(|one| difference(one).abs())
        .fold(0.0, f64::max);
    let close = bouncing()
        .filter(|one| difference(one).abs() <= AGREEMENT)
        .count();
    let chi_square: f64 = earlier()
        .map(|one| {
            let (entry, p) = one;
            let variance = p.p * (1.0 - p.p) / p.n as f64 + entry.error * entry.error;
            difference(one).powi(2) / variance
        })
        .sum();
    format!(
        "{inertia}'s inertia: within {AGREEMENT} of the earlier study in {close} of {} scenes with \
         e >= 0.3, at most {largest:.4} away; chi-square {chi_square:.0} over {} scenes, if its \
         error is one standard error",
        bouncing().count(),
        earlier().count(),
    )
}

const EARLIER_STUDY: &str = "earlier study";

const INERTIAS: [&str; 2] = ["cylinder", "rectangle"];

fn entries() -> Vec<Entry> {
    let case = |ratio, e, mu, inertia| {
        let case = Case::new(Preset::CleanFlat, 0.01, ratio, e, mu);
        if inertia == "rectangle" {
            case.with_rectangle_inertia()
        } else {
            case
        }
    };
    let mut entries = Vec::new();
    for inertia in INERTIAS {
        for (e, values) in EARLIER {
            entries.extend(RATIOS.into_iter().zip(values).map(|(ratio, value)| Entry {
                case: case(ratio, e, 0.0, inertia),
                inertia,
                source: EARLIER_STUDY,
                value,
                error: 0.003,
            }));
        }
        entries.extend(STEPPED.map(|(source, ratio, value, error)| Entry {
            case: case(ratio, 0.5, 0.3, inertia),
            inertia,
            source,
            value,
            error,
        }));
    }
    entries
}

impl Entry {
    fn row(&self, p: &Estimate) -> Vec<String> {
        let surface = &self.case.scene.surface;
        vec![
            self.source.to_owned(),
            self.inertia.to_owned(),
            surface.restitution().to_string(),
            surface.friction().to_string(),
            self.case.scene.coin.ratio().to_string(),
            number::probability(p.p),
            number::probability(p.lo),
            number::probability(p.hi),
            self.value.to_string(),
            self.error.to_string(),
            format!("{:+.4}", p.p - self.value),
        ]
    }
}
