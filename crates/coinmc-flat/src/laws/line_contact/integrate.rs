//! The integration of an impact from touch to release.

use super::equations::{CORNERS, State};
use super::impact_state::ImpactState;
use super::release::Release;
use crate::dormand_prince::{Step, System, growth};

/// Steps after which an impact is given up. A hard impact needs some tens, the worst of the stress
/// test a few hundred.
const MAX_STEPS: u32 = 20_000;

/// A step that meets the tolerance, up to the first event in it.
struct Accepted {
    /// Share of the step that is taken.
    share: f64,
    /// The margin that breaks at its end.
    event: Option<usize>,
    y: State,
    balance: f64,
    /// Error in units of the allowed error.
    error: f64,
}

impl ImpactState {
    /// Integrates to the release, or to the time `until` after the touch (`None`).
    pub(super) fn integrate(&mut self, until: f64) -> Option<Release> {
        self.touch_at_start();
        let mut h = 0.01 * self.scale.time;
        let mut rates = self.body.rates(&self.y);
        loop {
            if self.record.steps == MAX_STEPS || !self.y.iter().all(|y| y.is_finite()) {
                return Some(Release::GivenUp);
            }
            self.record.steps += 1;
            let step = Step::take(&self.body, &self.y, &rates, h);
            let accepted = match self.accept(&step, h) {
                Ok(accepted) => accepted,
                Err(shorter) => {
                    h = shorter;
                    continue;
                }
            };
            let taken = accepted.share * h;
            if self.time + taken > until {
                self.y = step.at((until - self.time) / h);
                self.time = until;
                return None;
            }
            self.time += taken;
            (self.y, self.balance) = (accepted.y, accepted.balance);
            if let Some(margin) = accepted.event {
                self.change(margin);
                rates = self.body.rates(&self.y);
                // the force on a corner that has just met the surface rises steeply
                h = h.min(0.05 * self.scale.time);
            } else {
                rates = step.rates;
                h = (h * growth(accepted.error)).min(self.scale.time / 6.0);
            }
            let release = self.release();
            if release.is_some() {
                return release;
            }
        }
    }

    /// The corners that touch at the start begin to press.
    pub(super) fn touch_at_start(&mut self) {
        for which in 0..CORNERS {
            let at = self.body.place(&self.y, which);
            if which == 0 || (at.depth >= 0.0 && at.rate > 0.0) {
                self.touch(which);
            }
        }
    }

    /// Checks a step of length `h`.
    ///
    /// # Errors
    /// The length to try instead.
    fn accept(&self, step: &Step<11>, h: f64) -> Result<Accepted, f64> {
        let error = self.error(step);
        if error > 1.0 || error.is_nan() {
            return Err(h * growth(error).min(0.9));
        }
        let event = self.first_event(step);
        let share = event.map_or(1.0, |(share, _)| share);
        // beyond the event the force differs, which has spoiled the step
        if (1.0 - share) * h > self.tolerance * self.scale.time {
            return Err(h * share);
        }
        let y = event.map_or(step.end, |(share, _)| step.at(share));
        let balance = self.balance(&y);
        let drift = (balance - self.balance).abs() / self.allowed_drift(share * h);
        if drift > 1.0 {
            return Err(h * growth(drift).min(0.9));
        }
        Ok(Accepted {
            share,
            event: event.map(|(_, margin)| margin),
            y,
            balance,
            error: error.max(drift),
        })
    }
}
