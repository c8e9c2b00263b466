//! P(side) against the step, beside the event-driven engine's of the same launches.
//!
//! The two engines agree on many a toss that is decided early and on few others, so that the
//! difference of the same tosses, x − y, can vary more than x alone. What the event-driven engine
//! makes of them is used for what it is worth instead, as a control variate: x̄ − β(ȳ − P), with P
//! its share of the side among many other tosses and β the regression of x on y. The variance is
//! s_x²(1 − ρ²)/n + (1 − β)² P(1 − P)/N, never above that of x alone, nor of x − y.

use super::trend::{self, Cell};
use super::{Flaws, STEPS};
use crate::survey::survey;
use clap::Args;
use coinmc_bench::rapier::{RATIOS, Tosser, cases};
use coinmc_bench::{Case, Report, Stopwatch, Table, number};
use coinmc_core::{DynEngine, Engine, Face, Tally};
use coinmc_rapier::{Account, Settings};

/// The number of the first toss of the event-driven engine's own sample, beyond all others.
const OTHERS: u64 = 1 << 40;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct RapierStep {
    /// Most tosses of a scene at one step
    #[arg(long, value_parser = number::count, default_value = "100000", value_name = "N")]
    tosses: u64,

    /// Processor time, s, after which no further toss of a scene at one step begins
    #[arg(long, default_value_t = 2.0, value_name = "S")]
    seconds: f64,

    /// Tosses of the event-driven engine by which its P(side) is known
    #[arg(long, value_parser = number::count, default_value = "20000", value_name = "N")]
    reference: u64,

    /// Shortest step, s
    #[arg(long, default_value_t = 5e-4, value_name = "S")]
    shortest: f64,

    /// Substeps of a step
    #[arg(long, default_value_t = 4, value_name = "N")]
    substeps: u32,
}

/// What a scene came to at one step.
#[derive(Default)]
struct Found {
    tally: Tally,
    flaws: Flaws,
    /// On the side: in both engines, in this one only, in the event-driven one only.
    both: u64,
    gained: u64,
    lost: u64,
    changed: u64,
    steps: u64,
    seconds: f64,
}

impl RapierStep {
    pub(crate) fn execute(&self, seed: u64) -> anyhow::Result<Report> {
        let scenes = |scene: usize| RATIOS.map(|ratio| cases(ratio)[scene]);
        let cases: Vec<Case> = (0..2).flat_map(scenes).collect();
        let truths = survey(&cases, |case| self.truth(case, seed));
        let mut jobs = Vec::new();
        for (case, truth) in cases.iter().zip(truths) {
            let truth = truth?;
            let steps = STEPS.into_iter().filter(|step| *step >= self.shortest);
            jobs.extend(steps.map(|step| (*case, step, truth)));
        }
        let found = survey(&jobs, |(case, step, _)| self.toss(case, *step, seed));
        let mut columns = vec![
            "scene",
            "ratio",
            "step_s",
            "tosses",
            "p_side",
            "event_driven",
            "bias",
            "std_error",
            "bound",
            "changed",
            "steps_a_toss",
            "tosses_a_second",
        ];
        columns.extend(Flaws::COLUMNS);
        let title = format!(
            "Against the step, beside the event-driven engine; {} substeps",
            self.substeps
        );
        let mut record = Table::new(title, &columns);
        let mut cells = Vec::new();
        for ((case, step, truth), found) in jobs.iter().zip(found) {
            let found = found?;
            let cell = found.cell(*step, *truth, self.reference);
            record.push(found.row(case, &cell, *truth));
            cells.push((*case, cell));
        }
        let mut report = Report::new(record);
        for scene in cells.chunk_by(|a, b| a.0.to_string() == b.0.to_string()) {
            let of_scene: Vec<Cell> = scene.iter().map(|(_, cell)| *cell).collect();
            report.remark(format!("{}: {}", scene[0].0, trend::summary(&of_scene)));
        }
        report.remark(
            "bias: P(side) minus the event-driven engine's, failed and undecided tosses counted as \
             not on the side, the event-driven outcomes of the same launches as a control variate. \
             bound: |bias| + 1.96 std_error. changed: share of tosses with another face or none.",
        );
        Ok(report)
    }

    /// The event-driven engine's P(side), from tosses of its own.
    fn truth(&self, case: &Case, seed: u64) -> anyhow::Result<f64> {
        let engine = events(case)?;
        let tosses = OTHERS..OTHERS + self.reference;
        let on_side = tosses.filter(|toss| {
            let launch = case.launch(seed, *toss);
            engine.toss(&mut (), &launch, &mut ()).face() == Some(Face::Side)
        });
        Ok(on_side.count() as f64 / self.reference as f64)
    }

    fn toss(&self, case: &Case, step: f64, seed: u64) -> anyhow::Result<Found> {
        let settings = Settings {
            step_s: step,
            substeps: self.substeps,
            ..Settings::default()
        };
        let mut tosser = Tosser::new(case, &settings)?;
        let events = events(case)?;
        let mut found = Found::default();
        let mut accounts: Vec<(Account, Option<Face>)> = Vec::new();
        let clock = Stopwatch::start();
        let go_on = || clock.seconds() < self.seconds;
        tosser.examine_all(seed, 0..self.tosses, go_on, |launch, account| {
            // the event-driven toss takes a hundredth of the time
            let other = events.toss(&mut (), launch, &mut ());
            accounts.push((*account, other.face()));
        });
        found.seconds = clock.seconds();
        for (account, other) in &accounts {
            found.add(account, *other);
        }
        Ok(found)
    }
}

fn events(case: &Case) -> anyhow::Result<DynEngine> {
    let settings = coinmc_volumetric::Settings::default();
    Ok(settings.engine(&case.scene)?)
}

impl Found {
    fn add(&mut self, account: &Account, other: Option<Face>) {
        let face = account.outcome.face();
        self.tally.add(&account.outcome);
        self.flaws.add(account.flaw);
        self.steps += u64::from(account.steps);
        self.changed += u64::from(face != other);
        match (face == Some(Face::Side), other == Some(Face::Side)) {
            (true, true) => self.both += 1,
            (true, false) => self.gained += 1,
            (false, true) => self.lost += 1,
            (false, false) => {}
        }
    }

    fn share(&self, count: u64) -> f64 {
        count as f64 / self.tally.tosses().max(1) as f64
    }

    /// Bias and its standard error, see above.
    fn cell(&self, step: f64, truth: f64, reference: u64) -> Cell {
        let (x, y) = (
            self.share(self.both + self.gained),
            self.share(self.both + self.lost),
        );
        let (var_x, var_y) = (x * (1.0 - x), y * (1.0 - y));
        let shared = self.share(self.both) - x * y;
        let beta = if var_y > 0.0 { shared / var_y } else { 0.0 };
        let n = self.tally.tosses().max(1) as f64;
        let rest = (var_x - beta * shared).max(0.0) / n;
        let of_truth = (1.0 - beta).powi(2) * truth * (1.0 - truth) / reference as f64;
        Cell {
            step,
            bias: x - beta * (y - truth) - truth,
            error: (rest + of_truth).sqrt(),
        }
    }

    fn row(&self, case: &Case, cell: &Cell, truth: f64) -> Vec<String> {
        let mut row = vec![
            case.preset.to_string(),
            case.scene.coin.ratio().to_string(),
            format!("{:.0e}", cell.step),
            self.tally.tosses().to_string(),
            number::probability(self.share(self.tally.side)),
            number::probability(truth),
            number::difference(cell.bias),
            number::probability(cell.error),
            number::probability(cell.bound()),
            number::probability(self.share(self.changed)),
            format!("{:.0}", self.share(self.steps)),
            format!("{:.0}", self.tally.tosses() as f64 / self.seconds),
        ];
        row.extend(self.flaws.cells(&self.tally));
        row
    }
}
