//! How far a point has come.

use super::chunk_result::Tossed;
use super::packed::Counted;
use crate::plan::{Looks, Plan, StoppedBy, Verdict};
use coinmc_core::{Estimate, Face, IntervalMethod, Tally};
use coinmc_quadrature::Integral;

/// Rounded down; saturates.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn whole(tosses: f64) -> u64 {
    tosses as u64
}

/// A point's counts, and what is next.
#[derive(Debug, Clone)]
pub(super) struct PointState {
    /// The tosses that count.
    pub(super) tally: Tally,
    /// Those of the pilot.
    pilot: Tally,
    /// Computing time of all tosses, where it is limited.
    microseconds: u64,
    /// Where the point stops at targets, when it is looked at.
    pub(super) looks: Option<Looks>,
    /// The result of a point without tosses.
    pub(super) integral: Option<Integral>,
    /// The rule that ended it.
    pub(super) stopped_by: StoppedBy,
    /// The rule that ends it if no more tosses are allowed.
    pub(super) limited_by: StoppedBy,
    /// Chunks of the stage that are handed out and not yet complete.
    pub(super) outstanding: u64,
    /// All chunks of the stage are handed out.
    pub(super) handed_out: bool,
    /// The widest arm of an interval.
    pub(super) half_width: f64,
    /// Whether any toss was made.
    pub(super) is_seen: bool,
    /// Tosses that the point is expected to need.
    pub(super) forecast: u64,
}

impl PointState {
    /// A point of which no toss was made.
    pub(super) fn new(looks: Option<Looks>, limited_by: StoppedBy) -> Self {
        Self {
            tally: Tally::default(),
            pilot: Tally::default(),
            microseconds: 0,
            looks,
            integral: None,
            stopped_by: StoppedBy::Unfinished,
            limited_by,
            outstanding: 0,
            handed_out: false,
            half_width: 0.0,
            is_seen: false,
            forecast: 0,
        }
    }

    /// Counts tosses of the present stage; false if a counter would overflow, which only forged counts do.
    pub(super) fn count(&mut self, tossed: &Tossed) -> bool {
        let of_stage = if self.is_in_pilot() {
            &mut self.pilot
        } else {
            &mut self.tally
        };
        let Some(sum) = of_stage.checked_merge(&tossed.tally) else {
            return false;
        };
        *of_stage = sum;
        self.microseconds = self.microseconds.saturating_add(tossed.microseconds);
        true
    }

    /// What its row is made of.
    pub(super) fn counted(&self) -> Counted {
        let after_pilot = self.looks.as_ref().filter(|looks| !looks.is_pilot());
        Counted {
            tally: *self.shown(),
            integral: self.integral,
            look: after_pilot.map(|looks| (looks.pilot(), looks.confidence())),
            stopped_by: self.stopped_by,
        }
    }

    /// Whether the pilot has not ended.
    pub(super) fn is_in_pilot(&self) -> bool {
        self.looks.as_ref().is_some_and(Looks::is_pilot)
    }

    /// What to show: the tosses that count, or those of the pilot while it lasts.
    pub(super) fn shown(&self) -> &Tally {
        if self.is_in_pilot() {
            &self.pilot
        } else {
            &self.tally
        }
    }

    /// All tosses made.
    pub(super) fn tosses(&self) -> u64 {
        self.pilot.tosses() + self.tally.tosses()
    }

    /// Computing time so far, s.
    pub(super) fn seconds(&self) -> f64 {
        1e-6 * self.microseconds as f64
    }

    /// Computing time of a toss, s.
    pub(super) fn seconds_per_toss(&self) -> f64 {
        self.seconds() / self.tosses() as f64
    }

    /// Lets the pilot take its part of this computing time, in all, s.
    pub(super) fn limit_pilot(&mut self, seconds: f64) {
        let tosses = whole(seconds / self.seconds_per_toss());
        if let Some(looks) = &mut self.looks {
            looks.limit_pilot(tosses);
        }
    }

    /// Lets the next stage take at most this computing time, if it is limited.
    pub(super) fn limit_seconds(&mut self, limit: Option<f64>) {
        if let Some(limit) = limit {
            let left = (limit - self.seconds()).max(0.0);
            let tosses = whole(left / self.seconds_per_toss());
            if tosses < self.next_tosses() {
                self.limit(tosses, StoppedBy::MaxCoreSeconds);
            }
        }
    }

    /// Tosses of the next stage.
    pub(super) fn next_tosses(&self) -> u64 {
        let stage = self.looks.as_ref().map_or(0..0, Looks::stage);
        stage.end - stage.start
    }

    /// Tosses that the next stage would have without any limit.
    pub(super) fn wanted(&self) -> f64 {
        self.looks.as_ref().map_or(0.0, Looks::wanted)
    }

    /// Lets the next stage have this many tosses at most, and be the last.
    pub(super) fn limit(&mut self, tosses: u64, by: StoppedBy) {
        if let Some(looks) = &mut self.looks {
            looks.end_after(tosses);
        }
        self.limited_by = by;
    }

    /// The rule that ends it short of its targets.
    pub(super) fn stopped_short_by(&self) -> StoppedBy {
        if self.looks.as_ref().is_some_and(Looks::is_hopeless) {
            StoppedBy::Undecided
        } else {
            self.limited_by
        }
    }

    /// Looks at the point at the end of a stage; `None` if the number of its tosses is fixed.
    pub(super) fn look(&mut self) -> Option<Verdict> {
        let tally = *self.shown();
        self.looks.as_mut().map(|looks| looks.look(&tally))
    }

    /// The widest arm of any face's interval, by Wilson's formula: good enough to display.
    pub(super) fn quick_half_width(&self, plan: &Plan) -> f64 {
        if let Some(integral) = &self.integral {
            return integral.half_width();
        }
        let confidence = match &self.looks {
            Some(looks) => looks.confidence(),
            None => plan.confidence,
        };
        let tally = self.shown();
        let (undecided, n) = (tally.undecided(), tally.tosses());
        let arm = |face| {
            let count = tally.count(face);
            Estimate::new(count, undecided, n, confidence, IntervalMethod::Wilson).half_width()
        };
        Face::ALL.into_iter().map(arm).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Targets;

    /// A pilot of 64 tosses of a millisecond each leaves a second of 1.064 s: time for a thousand tosses.
    #[test]
    fn what_is_left_of_a_limit_of_time_is_divided_by_the_time_of_a_toss() {
        let targets = Targets {
            half_width: Some(1e-3),
            relative_error: None,
            events: None,
            face: None,
            max_tosses: 1 << 40,
            total_tosses: None,
            max_core_seconds: Some(1.064),
            total_core_seconds: None,
        };
        let looks = Looks::new(targets, 0.95);
        let mut point = PointState::new(Some(looks), StoppedBy::MaxTosses);
        let pilot = Tossed {
            tally: Tally {
                heads: 32,
                tails: 32,
                ..Tally::default()
            },
            microseconds: 64_000,
        };
        assert!(point.count(&pilot));
        assert!((point.seconds_per_toss() - 1e-3).abs() < 1e-15);
        assert_eq!(point.look(), Some(Verdict::More));
        assert!(point.next_tosses() > 2000);
        // enough for all changes nothing, and so does no more than that
        let just_enough = (64.5 + point.next_tosses() as f64) * 1e-3;
        for enough in [1e9, just_enough] {
            point.limit_seconds(Some(enough));
            assert_eq!(point.limited_by, StoppedBy::MaxTosses);
        }
        point.limit_seconds(targets.max_core_seconds);
        assert!(point.next_tosses().abs_diff(1000) <= 1);
        assert_eq!(point.limited_by, StoppedBy::MaxCoreSeconds);
    }
}
