//! Tosses that have no face when the engine gives them up.

use crate::survey::{planar_stress, survey};
use clap::Args;
use coinmc_bench::{Case, Report, Table, number};
use coinmc_core::{Engine, Estimate, IntervalMethod, Preset, Tally};
use coinmc_flat::Settings;
use std::time::Instant;

/// Slowest scenes that are printed.
const SLOWEST: usize = 10;
/// Undecided tosses that are named, of a scene.
const NAMED: usize = 5;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Undecided {
    /// Tosses of each scene
    #[arg(long, value_parser = number::count, default_value = "100_000", value_name = "N")]
    tosses: u64,

    /// How the coin is let go
    #[arg(long, default_value_t = Preset::CleanFlat)]
    preset: Preset,
}

struct Found {
    tally: Tally,
    /// Numbers of the first undecided tosses.
    named: Vec<u64>,
    seconds: f64,
}

impl Undecided {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        let cases = planar_stress(&[self.preset], &[0.0, 0.3, 0.5, 0.8, 0.95]);
        let found = survey(&cases, |case| toss(case, seed, self.tosses));
        let columns = [
            "tosses",
            "undecided",
            "failed",
            "jams",
            "impacts_a_toss",
            "contact_steps_a_toss",
            "tosses_a_second",
            "undecided_tosses",
        ];
        let mut record = Table::new("Every scene", &Case::columns(&columns));
        for (case, found) in cases.iter().zip(&found) {
            record.push(row(case, found));
        }
        let unsettled = (0..found.len()).filter(|&i| found[i].tally.undecided() > 0);
        let unsettled = record.select("Scenes with undecided tosses", unsettled);
        let mut order: Vec<usize> = (0..found.len()).collect();
        order.sort_by(|&a, &b| found[a].rate().total_cmp(&found[b].rate()));
        let slowest = record.select("Slowest scenes", order.into_iter().take(SLOWEST));
        let mut report = Report::new(record);
        report.show(unsettled);
        report.show(slowest);
        let mut total = Tally::default();
        for found in &found {
            total.merge(&found.tally);
        }
        let (undecided, tosses) = (total.undecided(), total.tosses());
        let method = IntervalMethod::ClopperPearson;
        let bound = Estimate::new(undecided, 0, tosses, 0.9, method).hi;
        report.remark(format!(
            "{undecided} of {tosses} tosses undecided (time {}, never_settles {}, impacts {}, failed {}): \
             below {bound:.1e} with 95 % confidence, at the limit of {} impacts; {} jams",
            total.time_limit,
            total.never_settles,
            total.impact_limit,
            total.failed,
            Settings::default().max_impacts,
            total.jams,
        ));
        report
    }
}

fn toss(case: &Case, seed: u64, tosses: u64) -> Found {
    let engine = case.engine(&Settings::default());
    let (launches, stream) = (case.launches(), Case::stream(seed));
    let (mut tally, mut named) = (Tally::default(), Vec::new());
    let start = Instant::now();
    for toss in 0..tosses {
        let launch = launches.launch(&case.scene.coin, &mut stream.toss(toss));
        let outcome = engine.toss(&mut (), &launch, &mut ());
        tally.add(&outcome);
        if outcome.face().is_none() && named.len() < NAMED {
            named.push(toss);
        }
    }
    Found {
        tally,
        named,
        seconds: start.elapsed().as_secs_f64(),
    }
}

impl Found {
    fn rate(&self) -> f64 {
        self.tally.tosses() as f64 / self.seconds
    }
}

fn row(case: &Case, found: &Found) -> Vec<String> {
    let tally = &found.tally;
    let a_toss = |count: u64| format!("{:.2}", count as f64 / tally.tosses() as f64);
    let named: Vec<String> = found.named.iter().map(u64::to_string).collect();
    let mut cells = case.cells();
    cells.extend([
        tally.tosses().to_string(),
        tally.undecided().to_string(),
        tally.failed.to_string(),
        tally.jams.to_string(),
        a_toss(tally.impacts),
        a_toss(tally.contact_steps),
        format!("{:.0}", found.rate()),
        named.join(" "),
    ]);
    cells
}
