//! Results of an experiment in the schema of a simulated run, so that both fit into one plot.

use crate::Experiment;
use crate::journal::{History, Resolution};
use coinmc::plan::StoppedBy;
use coinmc::results::{Results, Row};
use coinmc_core::{Breaks, Ended, Outcome, Tally};

/// Name in the column of engines.
const ENGINE: &str = "robot";
/// Name in the column of laws.
const LAW: &str = "experiment";

/// The results of an experiment so far.
///
/// Void throws have no face: they count as undecided (in the column `failed`), so that the
/// intervals allow for any face they might have shown.
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
            side_ending: None,
        });
    }
    let complete = tally.tosses() >= u64::from(experiment.throws());
    let stopped_by = if complete {
        StoppedBy::Tosses
    } else {
        StoppedBy::Unfinished
    };
    let row = Row {
        engine: ENGINE,
        law: LAW,
        // which face was up in the robot's hand is not known
        same: None,
        ..Row::new(experiment.plan(), 0, tally, stopped_by)
    };
    Results::new(experiment.plan(), vec![row].into())
}
