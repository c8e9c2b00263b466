//! A toss that has ended.

use crate::contact::Usage;
use crate::model::Model;
use crate::toss::Toss;
use coinmc_core::{Breaks, Ended, Outcome};

/// The result of a toss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FinishedToss {
    pub(crate) outcome: Outcome,
    /// Time since the launch, in sqrt(D/g).
    pub(crate) time: f64,
}

impl FinishedToss {
    pub(crate) fn new<L>(model: &Model<L>, ended: Ended, toss: &Toss, usage: &Usage) -> Self {
        let outcome = Outcome {
            ended,
            impacts: toss.impacts,
            contact_steps: usage.steps,
            jams: usage.jams,
            overruled: false,
            breaks: Breaks::default(),
            side_ending: model.side_ending(toss, ended),
        };
        let time = usage.time;
        Self { outcome, time }
    }
}
