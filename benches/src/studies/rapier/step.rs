//! P(side) against the step, beside the event-driven engine's of the same launches.

use super::super::survey;
use super::{Flaws, RATIOS, STEPS, Tosser, cases};
use crate::number;
use crate::report::{Report, Table};
use clap::Args;
use coinmc_bench::Case;
use coinmc_core::{Engine, Face, Tally};
use coinmc_rapier::Settings;
use coinmc_volumetric::{Moreau, VolumetricEngine};
use std::time::Instant;

/// Bias that is asked for.
const ASKED: f64 = 0.005;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct RapierStep {
    /// Tosses of a scene with steps of 1 ms and more; fewer in proportion to shorter steps
    #[arg(long, value_parser = number::count, default_value = "120", value_name = "N")]
    tosses: u64,

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
    events: Tally,
    /// On the side in this engine only, and in the event-driven one only.
    gained: u64,
    lost: u64,
    changed: u64,
    steps: u64,
    seconds: f64,
}

impl RapierStep {
    pub(crate) fn carry_out(&self, seed: u64) -> anyhow::Result<Report> {
        let mut jobs = Vec::new();
        for scene in 0..2 {
            for ratio in RATIOS {
                let steps = STEPS.into_iter().filter(|step| *step >= self.shortest);
                jobs.extend(steps.map(|step| (cases(ratio)[scene], step)));
            }
        }
        let found = survey(&jobs, |(case, step)| self.compare(case, *step, seed));
        let mut columns = vec![
            "scene",
            "ratio",
            "step_s",
            "tosses",
            "p_side",
            "event_driven",
            "bias",
            "std_error",
            "changed",
            "steps_a_toss",
            "tosses_a_second",
        ];
        columns.extend(Flaws::COLUMNS);
        let title = format!(
            "Against the step: the first tosses of every scene, paired with the event-driven engine; \
             {} substeps",
            self.substeps
        );
        let mut record = Table::new(title, &columns);
        let mut best = Vec::new();
        for ((case, step), found) in jobs.iter().zip(found) {
            let found = found?;
            best.push((*case, *step, found.bias(), found.std_error()));
            record.push(found.row(case, *step));
        }
        let mut report = Report::new(record);
        report.remark(largest(&best));
        report.remark(
            "bias: P(side) minus the event-driven engine's, failed and undecided tosses counted as \
             not on the side; std_error from the tosses that are on the side in one of the two only. \
             changed: share of tosses with another face or none. sunk, tunnelled and exploded tosses \
             are counted as failed.",
        );
        Ok(report)
    }

    fn compare(&self, case: &Case, step: f64, seed: u64) -> anyhow::Result<Found> {
        // truncation is meant: a share of a count
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let tosses = ((self.tosses as f64 * (step / 1e-3).min(1.0)) as u64).max(20);
        let settings = Settings {
            step_s: step,
            substeps: self.substeps,
            ..Settings::default()
        };
        let mut tosser = Tosser::new(case, &settings)?;
        let events =
            VolumetricEngine::new(&case.scene, &coinmc_volumetric::Settings::default(), Moreau)?;
        let mut found = Found::default();
        for toss in 0..tosses {
            let launch = tosser.launch(seed, toss);
            let start = Instant::now();
            let account = tosser.examine(&launch);
            found.seconds += start.elapsed().as_secs_f64();
            let other = events.toss(&mut (), &launch, &mut ());
            let (one, two) = (account.outcome.face(), other.face());
            found.tally.add(&account.outcome);
            found.events.add(&other);
            found.flaws.add(account.flaw);
            found.steps += u64::from(account.steps);
            let side = |face| face == Some(Face::Side);
            found.gained += u64::from(side(one) && !side(two));
            found.lost += u64::from(side(two) && !side(one));
            found.changed += u64::from(one != two);
        }
        Ok(found)
    }
}

impl Found {
    fn share(&self, count: u64) -> f64 {
        count as f64 / self.tally.tosses() as f64
    }

    fn bias(&self) -> f64 {
        self.share(self.gained) - self.share(self.lost)
    }

    fn std_error(&self) -> f64 {
        let square = self.share(self.gained + self.lost);
        ((square - self.bias().powi(2)).max(0.0) / self.tally.tosses() as f64).sqrt()
    }

    fn row(&self, case: &Case, step: f64) -> Vec<String> {
        let mut row = vec![
            case.preset.to_string(),
            case.scene.coin.ratio().to_string(),
            format!("{step:.0e}"),
            self.tally.tosses().to_string(),
            number::probability(self.share(self.tally.side)),
            number::probability(self.share(self.events.side)),
            number::difference(self.bias()),
            number::probability(self.std_error()),
            number::probability(self.share(self.changed)),
            format!("{:.0}", self.share(self.steps)),
            format!("{:.0}", self.tally.tosses() as f64 / self.seconds),
        ];
        row.extend(self.flaws.cells(&self.tally));
        row
    }
}

/// The largest step of every scene from which on, down to the shortest, the bias is below what is
/// asked for within two standard errors.
fn largest(found: &[(Case, f64, f64, f64)]) -> String {
    let mut lines = Vec::new();
    for scene in found.chunk_by(|a, b| a.0.to_string() == b.0.to_string()) {
        let within = scene.iter().rev();
        let within = within.take_while(|(_, _, bias, error)| bias.abs() < ASKED + 2.0 * error);
        lines.push(match within.last() {
            Some((case, step, ..)) => format!("{case}: {step:.0e} s"),
            None => format!("{}: none", scene[0].0),
        });
    }
    format!(
        "Largest step from which on |bias| is compatible with less than {ASKED} (2 standard \
         errors): {}",
        lines.join("; ")
    )
}
