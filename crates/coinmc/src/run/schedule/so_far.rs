//! How far a schedule has come.

use super::Schedule;
use crate::plan::Stop;
use crate::results::integrated;
use crate::run::chunk_result::ChunkResult;
use crate::run::{Latest, Progress};
use coinmc_core::{Estimate, Face, IntervalMethod};

impl Schedule {
    /// How far the run is.
    pub(in crate::run) fn progress(&self) -> Progress {
        // a forecast may be out of date
        let tosses_planned = self.progress.tosses_planned.max(self.progress.tosses_done);
        Progress {
            tosses_planned,
            worst_half_width: self.states.widest(),
            latest: self.latest.map(|point| self.so_far(point)),
            ..self.progress
        }
    }

    /// What a point has shown, by Wilson's formula, which is quick.
    fn so_far(&self, point: usize) -> Latest {
        let face = match self.plan.stop {
            Stop::Targets(targets) => targets.face.unwrap_or(Face::Side),
            Stop::Tosses(_) => Face::Side,
        };
        let counted = self.states.counted(point);
        let estimate = if let Some(integral) = &counted.integral {
            integrated(&self.plan, integral)[face as usize]
        } else {
            let tally = &counted.tally;
            let (count, undecided) = (tally.count(face), tally.undecided());
            let method = IntervalMethod::Wilson;
            Estimate::new(
                count,
                undecided,
                tally.tosses(),
                self.plan.confidence,
                method,
            )
        };
        Latest {
            point,
            face,
            estimate,
        }
    }

    /// Point and first toss of the chunks of an earlier run that this one did not need; they no longer
    /// count as its progress.
    pub(in crate::run) fn take_unneeded(&mut self) -> Vec<(usize, u64)> {
        let unneeded = std::mem::take(&mut self.finished);
        self.progress.tosses_done -= unneeded.tosses();
        self.progress.tosses_reused -= unneeded.tosses();
        self.progress.reused_chunks -= unneeded.left();
        unneeded.rest().collect()
    }

    /// Takes back what an earlier run counted.
    pub(super) fn forget_reused(&mut self, result: &ChunkResult) {
        self.progress.tosses_done -= result.tosses();
        self.progress.tosses_reused -= result.tosses();
        self.progress.reused_chunks -= 1;
    }

    /// Replaces what was said of the tosses that a point will make.
    pub(super) fn set_forecast(&mut self, index: usize, forecast: u64) {
        let point = self.states.open(index);
        let others = self.progress.tosses_planned.saturating_sub(point.forecast);
        self.progress.tosses_planned = others.saturating_add(forecast);
        point.forecast = forecast;
    }

    /// Takes note of what was just counted of a point.
    pub(super) fn seen(&mut self, index: usize) {
        self.latest = Some(index);
        let half_width = self.states.open(index).quick_half_width(&self.plan);
        self.states.set_arm(index, half_width);
    }
}
