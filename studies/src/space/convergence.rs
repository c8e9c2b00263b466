//! How much of P(side) is due to the engine's settings.
//!
//! Every toss is made with the defaults and with every tolerance and the Zeno rule ten times as
//! tight. The bias is the mean of the differences, toss by toss.

use super::grid::Grid;
use super::paired::{Paired, undecided};
use super::{cells, columns, survey_tosses, tightened};
use clap::Args;
use coinmc_bench::{Report, Table, number};
use coinmc_volumetric::Settings;

/// |bias| that no scene may exceed.
const ASKED: f64 = 0.0005;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct SpaceConvergence {
    /// Tosses of each scene, made twice
    #[arg(long, value_parser = number::count, default_value = "1_000_000", value_name = "N")]
    tosses: u64,

    #[command(flatten)]
    grid: Grid,
}

impl SpaceConvergence {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let default = Settings::default();
        let tight = tightened(&default);
        let cases = self.grid.cases();
        let found = survey_tosses(
            &cases,
            self.tosses,
            |case, tosses| Paired::of(case, [&default, &tight], seed, tosses),
            Paired::merge,
        );
        let title = format!(
            "P(side) with the default settings, and its difference from all of them ten times as \
             tight; {} tosses a scene, paired, 95 % intervals",
            self.tosses
        );
        let more = [
            "p_side",
            "half_width",
            "bias",
            "std_error",
            "discordant",
            "changed",
            "total_error",
            "undecided",
            "undecided_tight",
        ];
        let mut record = Table::new(title, &columns(&more));
        for (case, found) in cases.iter().zip(&found) {
            let mut row = cells(case);
            row.extend(cells_of(found));
            record.push(row);
        }
        let mut report = Report::new(record);
        report.remark(assessment(&found));
        report.remark(
            "half_width: of the statistical interval, undecided tosses counted either way. bias: \
             default minus tight; std_error its standard error, from the tosses that are on the \
             side in one of the two only (discordant). total_error: half_width + |bias| + 1.96 \
             std_error. changed: share of tosses with another face: a single toss is chaotic, a \
             probability is not.",
        );
        report
    }
}

fn cells_of(found: &Paired) -> Vec<String> {
    let half_width = found.side().half_width();
    vec![
        number::probability(found.side().p),
        number::probability(half_width),
        number::difference(found.bias()),
        number::probability(found.std_error()),
        found.discordant().to_string(),
        number::probability(found.changed as f64 / found.first.tosses() as f64),
        number::probability(half_width + found.numerical_error()),
        undecided(&found.first),
        undecided(&found.second),
    ]
}

fn assessment(found: &[Paired]) -> String {
    let largest = found.iter().map(|f| f.bias().abs()).fold(0.0, f64::max);
    let above = found.iter().filter(|f| f.bias().abs() >= ASKED).count();
    let significant = found.iter().filter(|f| {
        let sure = f.bias().abs() - ASKED;
        sure > 1.96 * f.std_error()
    });
    let scores: Vec<f64> = found
        .iter()
        .filter(|f| f.discordant() > 0)
        .map(|f| f.z().powi(2))
        .collect();
    let rms = (scores.iter().sum::<f64>() / scores.len().max(1) as f64).sqrt();
    format!(
        "largest |bias| {largest:.5} (asked: below {ASKED}); at or above it in {above} of {} scenes, \
         beyond its own error in {}; rms of bias/std_error {rms:.2} (1: nothing but chance)",
        found.len(),
        significant.count(),
    )
}
