//! A sliding phase, integrated in time with error control and events.

use super::equations::{JAM, RatedState, SlideState, Sliding};
use super::events::{EventSearch, Margins, SlideEnd, StepMargins, Trial};
use crate::dead_contact::DeadContact;
use crate::motion::Motion;
use crate::observer_adapter::ObserverAdapter;
use crate::shape::Shape;
use coinmc_core::Observer;
use coinmc_lanes::sin_cos;

/// The start of a sliding phase, beside the motion.
pub(crate) struct SlideStart<'a> {
    pub(crate) shape: &'a Shape,
    pub(crate) friction: f64,
    /// The decision on a coin in contact.
    pub(crate) dead: DeadContact,
    /// Slip velocity; where it is zero, its sign is that of the slip about to begin.
    pub(crate) slip: f64,
    pub(crate) tolerance: f64,
    pub(crate) max_steps: u32,
}

/// A sliding phase. The next attempt is a step from `y`: of length `h`, or of a share of it while
/// an event is searched for within the step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SlidePhase {
    pub(super) sliding: Sliding,
    margins: Margins,
    dead: DeadContact,
    tolerance: f64,
    max_steps: u32,
    energy: f64,
    pub(super) y: SlideState,
    h: f64,
    pub(crate) steps: u32,
    consecutive_rejections: u32,
    pub(super) search: Option<EventSearch>,
}

/// An attempt at a whole step.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepAttempt {
    pub(super) start: RatedState,
    /// Whether the equations hold at the start.
    pub(super) begins: bool,
    pub(super) end: RatedState,
    /// Largest relative error.
    pub(super) error: f64,
    /// Whether the equations hold throughout the step.
    pub(super) possible: bool,
}

impl SlidePhase {
    pub(crate) fn new(motion: &Motion, start: &SlideStart) -> Self {
        let shape = *start.shape;
        let direction = 1.0_f64.copysign(start.slip);
        Self {
            sliding: Sliding {
                k: shape.k,
                friction: start.friction * direction,
            },
            margins: Margins {
                shape,
                quadrant: motion.quadrant,
                direction,
            },
            dead: start.dead,
            tolerance: start.tolerance,
            max_steps: start.max_steps,
            energy: motion.energy(shape.k),
            y: [motion.delta, motion.omega, start.slip, motion.x],
            // a fraction of the time in which the coin turns by 1 rad
            h: 0.2 / (1.0 + motion.omega.abs()),
            steps: 0,
            consecutive_rejections: 0,
            search: None,
        }
    }

    /// Slip velocity at the end.
    pub(crate) fn slip(&self, end: SlideEnd) -> f64 {
        if end == SlideEnd::Stops {
            0.0
        } else {
            self.y[2]
        }
    }

    /// Slides until the phase ends. The motion stays on its corner.
    pub(crate) fn run<O: Observer>(
        &mut self,
        motion: &mut Motion,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> SlideEnd {
        loop {
            let end = if let Some(search) = &self.search {
                let trial = self.sliding.step(&search.start, self.length());
                let led_to = trial
                    .possible
                    .then(|| (trial.state, sin_cos(trial.state[0])));
                self.finish_trial(led_to, motion, adapter)
            } else {
                let attempt = self.attempt();
                self.finish_step(attempt, motion, adapter)
            };
            if let Some(end) = end {
                return end;
            }
        }
    }

    /// Length of the next attempt.
    pub(super) fn length(&self) -> f64 {
        let share = self.search.as_ref().map(|search| search.share * self.h);
        share.unwrap_or(self.h)
    }

    fn attempt(&self) -> StepAttempt {
        let (start, begins) = self.sliding.at(&self.y);
        if !begins {
            return StepAttempt {
                start,
                begins,
                end: start,
                error: 0.0,
                possible: false,
            };
        }
        let step = self.sliding.whole_step(&start, self.h);
        StepAttempt {
            start,
            begins,
            end: step.end,
            error: step.error,
            possible: step.possible && step.sound,
        }
    }

    /// Accepts an attempt at a whole step, shortens it, or begins the search for an event within
    /// it; the end of the phase, if it ends here.
    pub(super) fn finish_step<O: Observer>(
        &mut self,
        attempt: StepAttempt,
        motion: &mut Motion,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Option<SlideEnd> {
        let open = attempt.begins && self.sliding.openness(attempt.start.angle) >= JAM;
        if !open || self.consecutive_rejections > 40 {
            return Some(self.end(SlideEnd::Jams, motion));
        }
        if self.steps == self.max_steps {
            return Some(self.end(SlideEnd::OutOfSteps, motion));
        }
        self.steps += 1;
        let margins = self.margins.over_step(&attempt.start, &attempt.end, self.h);
        if let Some(shorter) = self.shorter(&attempt, &margins) {
            self.h = shorter;
            self.consecutive_rejections += 1;
            return None;
        }
        self.consecutive_rejections = 0;
        self.search = margins.search(&attempt.start);
        if self.search.is_some() {
            return None;
        }
        let end = Trial {
            share: 1.0,
            state: attempt.end.state,
            angle: attempt.end.angle,
        };
        self.advance(&attempt.start, &end, motion, adapter);
        // with friction all of the energy counts, unless the rule for dead contact holds
        if self.energy < 1.0 || self.dead.decides(motion, self.sliding.k) {
            return Some(self.end(SlideEnd::Decided, motion));
        }
        let longer = growth(self.tolerance, attempt.error).clamp(0.2, 4.0);
        self.h = (self.h * longer).min(0.5 / (1.0 + self.y[1].abs()));
        None
    }

    /// The length to attempt instead of a step that is rejected; `None` if it is accepted.
    fn shorter(&self, attempt: &StepAttempt, margins: &StepMargins) -> Option<f64> {
        let h = self.h;
        if !attempt.possible {
            return Some(0.25 * h);
        }
        if attempt.error > self.tolerance {
            return Some(h * growth(self.tolerance, attempt.error).max(0.1));
        }
        let dip = margins.dip().map(|share| share * h);
        dip.filter(|shorter| *shorter < 0.99 * h)
    }

    /// Records a trial of the search for an event; the end of the phase, if the event is reached.
    pub(super) fn finish_trial<O: Observer>(
        &mut self,
        led_to: Option<(SlideState, (f64, f64))>,
        motion: &mut Motion,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Option<SlideEnd> {
        let search = self.search.as_mut()?;
        if !search.record(&self.margins, led_to) {
            return None;
        }
        let (start, reached, end) = (search.start, search.last_inside, search.end());
        self.advance(&start, &reached, motion, adapter);
        Some(self.end(end, motion))
    }

    /// Moves the coin to the end of an accepted step, or of part of it.
    fn advance<O: Observer>(
        &mut self,
        start: &RatedState,
        to: &Trial,
        motion: &mut Motion,
        adapter: &mut ObserverAdapter<'_, O>,
    ) {
        let (before, energy, k) = (*motion, self.energy, self.sliding.k);
        self.y = to.state;
        motion.time += to.share * self.h;
        adapter.passed(before.time, motion.time, |t| {
            let mut motion = before;
            // the equations hold in every part of an accepted step
            let mut part = self.sliding.step(start, t);
            if part.possible {
                let angle = sin_cos(part.state[0]);
                place(&mut motion, &mut part.state, angle, (energy, k));
            }
            motion
        });
        place(motion, &mut self.y, to.angle, (energy, k));
        self.energy = energy.min(motion.energy(k));
    }

    /// Ends the phase; a flat coin is set exactly flat.
    fn end(&self, end: SlideEnd, motion: &mut Motion) -> SlideEnd {
        if end == SlideEnd::Flat {
            let (shape, y) = (&self.margins.shape, &self.y);
            // exactly flat, so that the next quadrant begins where this one ended
            motion.delta = shape.last_angle(motion.quadrant, y[0]);
            let (sin, cos) = sin_cos(motion.delta);
            motion.set_on_corner(sin, cos, y[1], y[2]);
            motion.cap_energy(shape.k, self.energy);
        }
        end
    }
}

/// The factor by which the next step may be longer: the usual exponent for a pair of order 5(4),
/// and the usual safety factor.
#[inline]
fn growth(tolerance: f64, error: f64) -> f64 {
    0.9 * libm::pow(tolerance / error.max(1e-30), 0.2)
}

/// Writes the integrated state back to the motion, without the energy that truncation has added.
/// The slip shrinks with the other velocities.
#[inline]
fn place(
    motion: &mut Motion,
    y: &mut SlideState,
    (sin, cos): (f64, f64),
    (energy_before, k): (f64, f64),
) {
    motion.delta = y[0];
    motion.x = y[3];
    motion.set_on_corner(sin, cos, y[1], y[2]);
    motion.cap_energy(k, energy_before);
    y[1] = motion.omega;
    y[2] = motion.vx - motion.omega * cos;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::tests::on_corner;
    use coinmc_testkit::scene;

    /// A step of length 2 whose slip dips where it is lowest, unless it would be hardly shorter.
    #[test]
    fn a_step_that_dips_ends_where_the_margin_is_lowest() {
        let shape = Shape::new(&scene(1.0, 0.0, 0.3).coin);
        let motion = on_corner(0, -0.5, 0.0, 1.0);
        let mut phase = SlidePhase::new(
            &motion,
            &SlideStart {
                shape: &shape,
                friction: 0.3,
                dead: DeadContact::NONE,
                slip: 1.0,
                tolerance: 1e-6,
                max_steps: 10,
            },
        );
        phase.h = 2.0;
        // the slip along the step is (t - lowest)² - 1e-6
        let shorter = |lowest: f64| {
            let at = |t: f64| RatedState {
                state: [-0.5, 0.0, (t - lowest) * (t - lowest) - 1e-6, 0.0],
                rates: [0.0, 0.0, 2.0 * (t - lowest) / phase.h, 0.0],
                angle: sin_cos(motion.delta),
            };
            let attempt = StepAttempt {
                start: at(0.0),
                begins: true,
                end: at(1.0),
                error: 0.0,
                possible: true,
            };
            let margins = phase
                .margins
                .over_step(&attempt.start, &attempt.end, phase.h);
            phase.shorter(&attempt, &margins)
        };
        let found = shorter(0.25).expect("it dips");
        assert!((found - 0.5).abs() < 1e-9, "{found}");
        assert_eq!(shorter(0.995), None);
    }
}
