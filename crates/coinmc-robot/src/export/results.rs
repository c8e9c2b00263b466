//! An experiment in the schema of a simulated run, so that both go into one plot.

use crate::Experiment;
use crate::journal::{History, Resolution};
use coinmc::results::{Results, Row};
use coinmc_core::{Breaks, Ended, Outcome, Tally};

/// The engine's name of what nature did.
const ENGINE: &str = "robot";
/// Its law.
const LAW: &str = "experiment";

/// The results of an experiment, as far as it is.
///
/// Void throws have no face: they count as undecided (in the column `failed`), so that the
/// intervals allow for whatever they would have shown.
pub fn results(experiment: &Experiment, history: &History) -> Results {
    let mut tally = Tally::default();
    for throw in history.throws() {
        let ended = match (throw.resolution, &throw.reading) {
            (Some(Resolution::Done), Some((reading, _))) => Ended::Decided(reading.face),
            (Some(_), _) => Ended::Failed,
            (None, _) => continue,
        };
        tally.add(&Outcome {
            ended,
            impacts: 0,
            contact_steps: 0,
            jams: 0,
            overruled: false,
            breaks: Breaks::default(),
        });
    }
    let complete = tally.tosses() >= u64::from(experiment.throws());
    let row = Row {
        engine: ENGINE,
        law: LAW,
        ..Row::new(experiment.plan(), 0, tally, complete)
    };
    Results::new(experiment.plan(), vec![row])
}
