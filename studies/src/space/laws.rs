//! P(side) with its total error, law by law.

use super::tightened;
use crate::grid::Grid;
use crate::paired::{Paired, undecided};
use crate::survey::{side, survey_tosses, tally, volumetric};
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::Tally;
use coinmc_volumetric::{Law, Settings};

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct SpaceLaws {
    /// Tosses of each scene under each law
    #[arg(long, value_parser = number::count, default_value = "400_000", value_name = "N")]
    tosses: u64,

    /// Tosses of them that are made again with settings ten times as tight
    #[arg(long, value_parser = number::count, default_value = "100_000", value_name = "N")]
    paired: u64,

    #[command(flatten)]
    grid: Grid,
}

impl SpaceLaws {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let scenes = self.scenes();
        let tallies = survey_tosses(
            &scenes,
            self.tosses,
            |(case, law), tosses| tally(case, &volumetric(case, &settings(*law)), seed, tosses),
            Tally::merge,
        );
        let paired = survey_tosses(
            &scenes,
            self.paired.min(self.tosses),
            |(case, law), tosses| {
                let settings = settings(*law);
                Paired::in_space(case, [&settings, &tightened(&settings)], seed, tosses)
            },
            Paired::merge,
        );
        let more = [
            "law",
            "p_side",
            "half_width",
            "numerical_error",
            "total_error",
            "minus_moreau",
            "undecided",
        ];
        let title = format!(
            "P(side) by law of impact, {} tosses a scene (paired between the laws), numerical error \
             from {} of them; 95 % intervals",
            self.tosses,
            self.paired.min(self.tosses),
        );
        let mut record = Table::new(title, &Case::columns(&more));
        for (i, ((case, law), tally)) in scenes.iter().zip(&tallies).enumerate() {
            let moreau = side(&tallies[i - i % Law::ALL.len()]).p;
            let (estimate, error) = (side(tally), paired[i].numerical_error());
            let mut row = case.cells();
            row.extend([
                law.name().to_owned(),
                number::probability(estimate.p),
                number::probability(estimate.half_width()),
                number::probability(error),
                number::probability(estimate.half_width() + error),
                number::difference(estimate.p - moreau),
                undecided(tally),
            ]);
            record.push(row);
        }
        let mut report = Report::new(record);
        report.remark(
            "numerical_error: |bias| + 1.96 of its standard error, the bias being the mean \
             difference from settings ten times as tight; where few tosses are paired it is mostly \
             their noise. total_error: half_width + numerical_error.",
        );
        report
    }

    /// The laws of a scene follow each other, Moreau's first.
    fn scenes(&self) -> Vec<(Case, Law)> {
        let cases = self.grid.cases();
        let with_laws = |case: Case| Law::ALL.map(|law| (case, law));
        cases.into_iter().flat_map(with_laws).collect()
    }
}

fn settings(law: Law) -> Settings {
    Settings {
        law,
        ..Settings::default()
    }
}
