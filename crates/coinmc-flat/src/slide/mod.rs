//! A corner that slides with friction: integrated in time with error control and events.

mod equations;
mod events;
mod side_by_side;

use crate::motion::Motion;
use crate::observer_adapter::ObserverAdapter;
use crate::shape::Shape;
use coinmc_core::Observer;
use coinmc_lanes::sin_cos;
use equations::{Arrival, JAM, Slide, Sliding};
use events::{EventSearch, Inside, Margins, Over};
pub(crate) use side_by_side::slide_on;

/// How a sliding phase ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SlideEnd {
    /// Slip has come to zero.
    Stops,
    /// The contact force has vanished.
    LiftsOff,
    /// The next corner has come down: flat on an edge.
    Flat,
    /// The force that sliding needs grows without bound: Painlevé's configuration.
    Jams,
    /// Energy has fallen below the barrier: the face is certain.
    Certain,
    /// Out of steps.
    Lost,
}

/// What the sliding phase is told beside the motion.
pub(crate) struct SlideTask<'a> {
    pub(crate) shape: &'a Shape,
    pub(crate) mu: f64,
    /// Slip velocity; its sign, or where it is zero that of the slip about to begin.
    pub(crate) slip: f64,
    pub(crate) tolerance: f64,
    pub(crate) max_steps: u32,
}

/// A sliding phase on its way: what is attempted next is a step from `y`, the whole of it or, on
/// the search for an event within, a share.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SlidePhase {
    sliding: Sliding,
    margins: Margins,
    tolerance: f64,
    max_steps: u32,
    energy: f64,
    y: Slide,
    h: f64,
    pub(crate) steps: u32,
    rejected_in_a_row: u32,
    search: Option<EventSearch>,
}

/// An attempt at a whole step.
#[derive(Debug, Clone, Copy)]
struct Made {
    start: Arrival,
    /// Whether the motion goes on at all from there.
    begins: bool,
    end: Arrival,
    /// Largest relative error.
    error: f64,
    possible: bool,
}

impl SlidePhase {
    pub(crate) fn new(motion: &Motion, task: &SlideTask) -> Self {
        let shape = *task.shape;
        let direction = 1.0_f64.copysign(task.slip);
        Self {
            sliding: Sliding {
                k: shape.k,
                friction: task.mu * direction,
            },
            margins: Margins {
                shape,
                quadrant: motion.quadrant,
                direction,
            },
            tolerance: task.tolerance,
            max_steps: task.max_steps,
            energy: motion.energy(shape.k),
            y: [motion.delta, motion.omega, task.slip, motion.x],
            // a fraction of the time in which the fastest thing here turns by one
            h: 0.2 / (1.0 + motion.omega.abs()),
            steps: 0,
            rejected_in_a_row: 0,
            search: None,
        }
    }

    /// Slip at the end.
    pub(crate) fn slip(&self, end: SlideEnd) -> f64 {
        if end == SlideEnd::Stops {
            0.0
        } else {
            self.y[2]
        }
    }

    /// Slides until the phase ends. The motion is left on its corner.
    pub(crate) fn follow<O: Observer>(
        &mut self,
        motion: &mut Motion,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> SlideEnd {
        loop {
            let end = if let Some(search) = &self.search {
                let tried = self.sliding.step(&search.start, self.length());
                let to = tried
                    .possible
                    .then(|| (tried.state, sin_cos(tried.state[0])));
                self.tried(to, motion, adapter)
            } else {
                let made = self.attempt();
                self.made(made, motion, adapter)
            };
            if let Some(end) = end {
                return end;
            }
        }
    }

    /// Length of the step to attempt.
    fn length(&self) -> f64 {
        let share = self.search.as_ref().map(|search| search.share * self.h);
        share.unwrap_or(self.h)
    }

    fn attempt(&self) -> Made {
        let (start, begins) = self.sliding.at(&self.y);
        if !begins {
            return Made {
                start,
                begins,
                end: start,
                error: 0.0,
                possible: false,
            };
        }
        let step = self.sliding.whole_step(&start, self.h);
        Made {
            start,
            begins,
            end: step.end,
            error: step.error,
            possible: step.possible && step.sound,
        }
    }

    /// Takes up an attempt at a whole step.
    fn made<O: Observer>(
        &mut self,
        made: Made,
        motion: &mut Motion,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Option<SlideEnd> {
        let open = made.begins && self.sliding.openness(made.start.angle) >= JAM;
        if !open || self.rejected_in_a_row > 40 {
            return Some(self.end(SlideEnd::Jams, motion));
        }
        if self.steps == self.max_steps {
            return Some(self.end(SlideEnd::Lost, motion));
        }
        self.steps += 1;
        let over = self.margins.over(&made.start, &made.end, self.h);
        if let Some(shorter) = self.shorter(&made, &over) {
            self.h = shorter;
            self.rejected_in_a_row += 1;
            return None;
        }
        self.rejected_in_a_row = 0;
        self.search = over.search(&made.start);
        if self.search.is_some() {
            return None;
        }
        let end = Inside {
            share: 1.0,
            state: made.end.state,
            angle: made.end.angle,
        };
        self.move_on(&made.start, &end, motion, adapter);
        if self.energy < 1.0 {
            return Some(self.end(SlideEnd::Certain, motion));
        }
        let longer = growth(self.tolerance, made.error).clamp(0.2, 4.0);
        self.h = (self.h * longer).min(0.5 / (1.0 + self.y[1].abs()));
        None
    }

    /// The length of the step to try instead, of one that is not accepted.
    fn shorter(&self, made: &Made, over: &Over) -> Option<f64> {
        let h = self.h;
        if !made.possible {
            return Some(0.25 * h);
        }
        if made.error > self.tolerance {
            return Some(h * growth(self.tolerance, made.error).max(0.1));
        }
        let dip = over.dip().map(|share| share * h);
        dip.filter(|shorter| *shorter < 0.99 * h)
    }

    /// Takes up a trial of the search for an event.
    fn tried<O: Observer>(
        &mut self,
        to: Option<(Slide, (f64, f64))>,
        motion: &mut Motion,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Option<SlideEnd> {
        let search = self.search.as_mut()?;
        if !search.tried(&self.margins, to) {
            return None;
        }
        let (start, inside, end) = (search.start, search.inside, search.end());
        self.move_on(&start, &inside, motion, adapter);
        Some(self.end(end, motion))
    }

    /// Moves the coin to the end of an accepted step, or part of it.
    fn move_on<O: Observer>(
        &mut self,
        start: &Arrival,
        to: &Inside,
        motion: &mut Motion,
        adapter: &mut ObserverAdapter<'_, O>,
    ) {
        let (before, energy, k) = (*motion, self.energy, self.sliding.k);
        self.y = to.state;
        motion.time += to.share * self.h;
        adapter.passed(before.time, motion.time, |t| {
            let mut motion = before;
            // a part of a step that was accepted is a step that can be made
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

    /// Ends the phase.
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

/// By how much the next step may be longer: the usual exponent for a pair of order 5(4), and the
/// usual caution.
#[inline]
fn growth(tolerance: f64, error: f64) -> f64 {
    0.9 * libm::pow(tolerance / error.max(1e-30), 0.2)
}

/// Writes the integrated state back, taking out what truncation added to the energy; the slip
/// shrinks with the other velocities.
#[inline]
fn place(
    motion: &mut Motion,
    y: &mut Slide,
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
