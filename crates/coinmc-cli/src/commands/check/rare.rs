//! What `coinmc rare` would gain over the run that is checked.

use crate::exit::Failure;
use coinmc::plan::{Plan, Stop};
use coinmc_core::Face;
use coinmc_questions::{Gain, HowRare, Template, Workers, gain_expected};
use std::sync::atomic::AtomicBool;

/// Seconds of one core in which the gain is learnt, and about as many in which it is measured.
const SECONDS: f64 = 1.0;
/// Least and most tosses in these.
const TOSSES: [f64; 2] = [2048.0, 131_072.0];
/// Less work than this factor is no gain.
const WORTH: f64 = 1.2;

/// A face of which the run would need many tosses.
pub(super) struct RareFace {
    pub(super) face: Face,
    /// What `coinmc rare` gains; `None` if the face was hardly seen.
    pub(super) gain: Option<Gain>,
}

/// The relative error that a plan of a single point asks for.
pub(super) fn relative_error(plan: &Plan) -> Option<f64> {
    let Stop::Targets(targets) = plan.stop else {
        return None;
    };
    let by_events = |events: u64| 2.0 / (events as f64).sqrt();
    let error = targets
        .relative_error
        .or_else(|| targets.events.map(by_events))?;
    let single = plan.points.len() == 1 && plan.makes_tosses(0);
    single.then(|| error.clamp(0.01, 0.5))
}

impl RareFace {
    pub(super) fn of(
        face: Face,
        relative_error: f64,
        tosses_per_s: f64,
        template: &Template,
    ) -> Result<Self, Failure> {
        let cancel = AtomicBool::new(false);
        let workers = Workers {
            threads: None,
            cancel: &cancel,
            made: &|_| (),
        };
        let question = HowRare {
            face,
            relative_error,
            max_tosses: u64::MAX,
        };
        let [least, most] = TOSSES;
        // within these limits
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let tosses = (SECONDS * tosses_per_s).clamp(least, most) as u64;
        let gain = gain_expected(template, &question, tosses, &workers)?;
        Ok(Self { face, gain })
    }

    pub(super) fn in_words(&self) -> String {
        let face = self.face.name();
        match self.gain {
            Some(gain) if gain.work >= WORTH => format!(
                "`coinmc rare --face {face}` takes about {:.1} times fewer tosses, {:.1} times less work, for P({face})",
                gain.tosses, gain.work
            ),
            Some(_) => format!("`coinmc rare` would gain little for P({face})"),
            None => {
                format!("P({face}) is too small to tell at a glance what `coinmc rare` would gain")
            }
        }
    }
}
