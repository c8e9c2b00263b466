//! What the decision by tilting energy changes against the rigorous one, and how many tosses
//! never end.

use crate::grid::Grid;
use crate::paired::{Paired, undecided};
use crate::survey::survey_tosses;
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_volumetric::{Decision, Settings};

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct SpaceDecision {
    /// Tosses of each scene, made twice
    #[arg(long, value_parser = number::count, default_value = "200_000", value_name = "N")]
    tosses: u64,

    /// Time limit, in sqrt(D/g): without friction lengths `energy` follows a coin that rolls away
    /// up to it
    #[arg(long, default_value_t = 1e4, value_name = "TIME")]
    time_limit: f64,

    #[command(flatten)]
    grid: Grid,
}

impl SpaceDecision {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let [tilting, energy] = [Decision::Tilting, Decision::Energy].map(|decision| Settings {
            decision,
            time_limit: self.time_limit,
            ..Settings::default()
        });
        tilting.validate()?;
        let cases = self.grid.cases();
        let found = survey_tosses(
            &cases,
            self.tosses,
            |case, tosses| Paired::in_space(case, [&tilting, &energy], seed, tosses),
            Paired::merge,
        );
        let more = [
            "p_side",
            "bias",
            "std_error",
            "other_face",
            "work_saved",
            "undecided",
            "undecided_energy",
        ];
        let title = format!(
            "Decision by tilting energy against the rigorous one, {} tosses a scene, paired",
            self.tosses
        );
        let mut record = Table::new(title, &Case::columns(&more));
        for (case, found) in cases.iter().zip(&found) {
            let mut row = case.cells();
            row.extend(cells_of(found));
            record.push(row);
        }
        let mut report = Report::new(record);
        for remark in remarks(&cases, &found) {
            report.remark(remark);
        }
        Ok(report)
    }
}

fn cells_of(found: &Paired) -> Vec<String> {
    let steps = |tally: &coinmc_core::Tally| (tally.impacts + tally.contact_steps) as f64;
    vec![
        number::probability(found.side().p),
        number::difference(found.bias()),
        number::probability(found.std_error()),
        found.changed.to_string(),
        format!("{:.3}", 1.0 - steps(&found.first) / steps(&found.second)),
        undecided(&found.first),
        undecided(&found.second),
    ]
}

fn remarks(cases: &[Case], found: &[Paired]) -> [String; 3] {
    let all = || cases.iter().zip(found);
    let rough = all().filter(|(case, _)| case.rho_over_r() > 0.0);
    let largest = rough.map(|(_, f)| f.bias().abs()).fold(0.0, f64::max);
    let (mut tosses, mut never_settles, mut other) = (0, 0, 0);
    for (_, f) in all().filter(|(case, _)| case.rho_over_r() == 0.0) {
        tosses += f.first.tosses();
        never_settles += f.first.never_settles + f.first.time_limit;
        other += f.first.impact_limit + f.first.failed;
    }
    let share = |count: u64| count as f64 / f64::max(tosses as f64, 1.0);
    [
        format!("largest |bias| with friction lengths: {largest:.5}"),
        format!(
            "without friction lengths {:.5} of {tosses} tosses roll forever (never_settles or at the \
             limit of time), {:.1e} are undecided otherwise",
            share(never_settles),
            share(other)
        ),
        "bias: P(side) of tilting minus energy. other_face: tosses with another outcome; without \
         friction lengths these are mostly coins that roll away on their side, which energy leaves \
         undecided. work_saved: share of impacts and contact steps."
            .to_owned(),
    ]
}
