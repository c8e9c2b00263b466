//! What happens within a step of contact: a point of a rim comes down, or the mode no longer holds.

use super::attempt::{DOWN, YIELD, can_stick, holds, margin, slip_speed, swings_over};
use super::follow::{Contact, FLAT, Leave, Next, Phase, RESEED, SEED};
use super::integrator::Trial;
use super::rim::{Mode, OMEGA_Y, Rates, RimState, TILT};
use super::state::change_slip;
use coinmc_core::Decided;
use std::f64::consts::FRAC_PI_2;

/// Turning points of the tilt after which a conserving motion is seen to repeat itself.
const TURNING_POINTS: u32 = 3;
/// As close to the balance, in u_z, an extreme of the tilt is not told from it: a hundred times the
/// error of the dense output.
const CLOSE: f64 = 1e-4;
/// Steps of Newton's method to where a point comes down; halving alone needs as many.
const MOST_TRIES: u32 = 40;

/// The search for the moment of a step at which a margin is gone: the chord's zero, a little to its
/// far side so that the next is met from the other, and the middle every third time.
struct Narrowing {
    /// Fraction of the step and margin there: with a mode that holds, and one that does not.
    low: (f64, f64),
    high: (f64, f64),
    tries: u32,
    /// Whether the mode held at the last try.
    held: bool,
}

impl Narrowing {
    /// Width that is narrow enough, and how far beyond the chord's zero to look.
    const ENOUGH: f64 = 4e-3;
    const BEYOND: f64 = 1.6e-3;

    fn new(low: f64, high: f64) -> Self {
        Self {
            low: (0.0, low),
            high: (1.0, high),
            tries: 0,
            held: true,
        }
    }

    /// Where to look next; `None` once it is narrow enough.
    fn next(&mut self) -> Option<f64> {
        let ((low, above), (high, below)) = (self.low, self.high);
        let width = high - low;
        if width <= Self::ENOUGH {
            return None;
        }
        self.tries += 1;
        let zero = low + width * above / (above - below);
        let beyond = if self.held {
            Self::BEYOND
        } else {
            -Self::BEYOND
        };
        let chord = zero + beyond;
        let inside = low < chord && chord < high && !self.tries.is_multiple_of(3);
        Some(if inside { chord } else { low + 0.5 * width })
    }

    fn narrow(&mut self, at: f64, margin: f64, holds: bool) {
        self.held = holds;
        if holds {
            self.low = (at, margin);
        } else {
            self.high = (at, margin);
        }
    }
}

/// The search for the length of the step that ends where the tilt reaches a goal: Newton's method
/// in a bracket, each evaluation an attempt at the step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reach {
    goal: f64,
    leave: Leave,
    low: f64,
    high: f64,
    /// Of the last attempt, and of the next.
    pub(crate) length: f64,
    tries: u32,
}

impl Reach {
    /// The search, if the step of `length` from `phase` to `state` passes a goal.
    #[inline]
    pub(crate) fn of(phase: &Phase, state: &RimState<f64>, length: f64) -> Option<Self> {
        let tilt = state[TILT];
        let falls_on = tilt > FRAC_PI_2 - DOWN && state[OMEGA_Y] > 0.0;
        // beyond, it has come down within the step, even if it has turned round since
        let (goal, leave) = if falls_on || tilt > FRAC_PI_2 + DOWN {
            (FRAC_PI_2, Leave::OtherRim)
        } else if tilt < FLAT && phase.state[TILT] > FLAT {
            (FLAT, Leave::Upright)
        } else {
            return None;
        };
        Some(Self {
            goal,
            leave,
            low: 0.0,
            high: length,
            length,
            tries: 0,
        })
    }

    /// Whether the last attempt, which led to `state`, is not there yet: then the next is to be
    /// made.
    pub(crate) fn is_away(&mut self, state: &RimState<f64>) -> bool {
        let gap = state[TILT] - self.goal;
        if self.tries == MOST_TRIES || gap.abs() <= DOWN {
            return false;
        }
        self.tries += 1;
        // the side the phase is on: it may start at the goal itself, going away and coming back
        let before = if self.leave == Leave::OtherRim {
            -1.0
        } else {
            1.0
        };
        if gap * before > 0.0 {
            self.low = self.length;
        } else {
            self.high = self.length;
        }
        let newton = self.length - gap / state[OMEGA_Y];
        self.length = if newton > self.low && newton < self.high {
            newton
        } else {
            0.5 * (self.low + self.high)
        };
        true
    }

    /// Ends the step there; how long it was.
    pub(crate) fn arrive(&self, phase: &mut Phase, mut state: RimState<f64>) -> (Next, f64) {
        state[TILT] = self.goal;
        phase.state = state;
        (Next::End(self.leave), self.length)
    }
}

impl Contact<'_> {
    /// Sees whether an accepted step passes an event; if so the phase goes to the event instead.
    pub(crate) fn accept(
        &mut self,
        phase: &mut Phase,
        trial: &Trial<f64, 6>,
        now: &Rates<f64>,
        length: f64,
        wanted: f64,
    ) -> (Next, f64) {
        if let Some(mut reach) = Reach::of(phase, &trial.state, length) {
            let state = self.follow_up(phase, &mut reach, trial.state);
            return reach.arrive(phase, state);
        }
        // the other rim may also have come down within the step and be up again at its end
        let (before, after) = (phase.state[OMEGA_Y], trial.state[OMEGA_Y]);
        if swings_over(phase.state[TILT], before, after, length) {
            let (fraction, state) = turning_point(phase, trial);
            if let Some(down) = self.comes_down(phase, &state, fraction * length) {
                return down;
            }
        }
        if holds(self.law, phase.mode, now) {
            if self.law.conserves(phase.mode) && before * after < 0.0 {
                let (_, state) = turning_point(phase, trial);
                phase.turned(state[TILT]);
            }
            phase.state = trial.state;
            phase.now = *now;
            phase.length = wanted;
            return (self.after_step(phase), length);
        }
        let (fraction, state, now) = self.locate(phase, trial, now);
        if let Some(down) = self.comes_down(phase, &state, fraction * length) {
            return down;
        }
        phase.state = state;
        phase.state[TILT] = phase.state[TILT].min(FRAC_PI_2);
        phase.now = now;
        phase.length = wanted;
        let next = if now.press <= 0.0 {
            Next::End(Leave::LiftOff)
        } else if phase.mode == Mode::Slip && now.yields < YIELD {
            self.jammed(phase)
        } else {
            Next::Change
        };
        (next, fraction * length)
    }

    /// Attempts at the step, from one that led to `state`, until the tilt is at its goal; where that
    /// leads.
    fn follow_up(
        &mut self,
        phase: &Phase,
        reach: &mut Reach,
        mut state: RimState<f64>,
    ) -> RimState<f64> {
        while reach.is_away(&state) {
            self.spent.steps += 1;
            state = self.attempt(phase, reach.length).0.state;
        }
        state
    }

    /// Goes to where the other rim comes down on the way to `state`, which the dense output gives for
    /// a time `length` into the step; `None` if it does not: the dense output's error may be what
    /// lies beyond.
    fn comes_down(
        &mut self,
        phase: &mut Phase,
        state: &RimState<f64>,
        length: f64,
    ) -> Option<(Next, f64)> {
        if state[TILT] <= FRAC_PI_2 + DOWN {
            return None;
        }
        let mut reach = Reach::of(phase, state, length)?;
        let state = self.follow_up(phase, &mut reach, *state);
        let arrives = (state[TILT] - FRAC_PI_2).abs() <= DOWN && state[OMEGA_Y] > 0.0;
        arrives.then(|| reach.arrive(phase, state))
    }

    /// A moment of the step at which the mode no longer holds, shortly after one at which it does, by
    /// the dense output: its own error is that of the step, so a few thousandths of the step are close
    /// enough.
    fn locate(
        &self,
        phase: &Phase,
        trial: &Trial<f64, 6>,
        now: &Rates<f64>,
    ) -> (f64, RimState<f64>, Rates<f64>) {
        let margin = |now: &Rates<f64>| margin(self.law, phase.mode, now);
        let before = self.law.rates(&phase.state, phase.mode);
        let mut narrowing = Narrowing::new(margin(&before), margin(now));
        let mut found = (trial.state, *now);
        while let Some(at) = narrowing.next() {
            let state = trial.between(&phase.state, at);
            let now = self.law.rates(&state, phase.mode);
            let holds = holds(self.law, phase.mode, &now);
            narrowing.narrow(at, margin(&now), holds);
            if !holds {
                found = (state, now);
            }
        }
        (narrowing.high.0, found.0, found.1)
    }

    fn after_step(&self, phase: &Phase) -> Next {
        if phase.turning_points >= TURNING_POINTS {
            return Next::End(self.repeats(phase));
        }
        if phase.mode == Mode::Slip && self.is_stopping(phase) {
            Next::Change
        } else {
            Next::Go
        }
    }

    /// The end of a motion that repeats itself. Between its extremes the tilt passes none beyond
    /// them: with both in one well the coin stays there for ever, and that decides the face unless
    /// energy alone may.
    fn repeats(&self, phase: &Phase) -> Leave {
        // u_z is largest where the tilt is least
        let [highest, lowest] = phase.tilts.map(libm::cos);
        let half = self.law.body.half;
        if !self.rule.is_tilting() {
            Leave::NeverSettles
        } else if highest < half - CLOSE {
            Leave::Decided(Decided::Side)
        } else if lowest > half + CLOSE {
            Leave::Decided(Decided::Face)
        } else {
            Leave::NeverSettles
        }
    }

    /// Whether a sliding phase has come to where it sticks, or its direction is lost.
    fn is_stopping(&self, phase: &Phase) -> bool {
        let state = &phase.state;
        let slip = slip_speed(state);
        let [.., gx, gy] = *state;
        let [.., ax, ay] = phase.now.state;
        if self.law.friction.mu == 0.0
            || slip > self.settings.stick_speed
            || gx * ax + gy * ay >= 0.0
        {
            return false;
        }
        let held = change_slip(self.law, state, 0.0, 0.0);
        slip < RESEED * SEED * self.settings.stick_speed
            || can_stick(self.law, &self.law.rates(&held, Mode::Stick))
    }
}

/// Where in a step the tilt turns, by bisection of the dense output.
fn turning_point(phase: &Phase, trial: &Trial<f64, 6>) -> (f64, RimState<f64>) {
    let rises = phase.state[OMEGA_Y] > 0.0;
    let (mut low, mut high) = (0.0, 1.0);
    while high - low > 1e-3 {
        let middle = 0.5 * (low + high);
        if (trial.between(&phase.state, middle)[OMEGA_Y] > 0.0) == rises {
            low = middle;
        } else {
            high = middle;
        }
    }
    (high, trial.between(&phase.state, high))
}
