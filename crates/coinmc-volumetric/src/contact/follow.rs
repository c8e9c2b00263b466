//! Sustained contact of one rim point: its two modes and what ends them.
//!
//! ```text
//!             ┌── cone reached ──▶
//!   sticking                       sliding ── no force holds it (Painlevé) ──▶ tangential impact
//!             ◀── slip vanishes ──┘
//!   either ── normal force vanishes ──▶ flight
//!   either ── the other rim comes down, or the tilt vanishes ──▶ impact there
//! ```

use super::attempt::{YIELD, can_stick, limit, slip_speed, wanted};
use super::integrator::{LEAST_STEP, Trial, is_accepted, shorter, step};
use super::rim::{Law, Mode, OMEGA_Y, Rates, RimFlow, RimState, TILT};
use super::state::{change_slip, kicked, place_below, rim_state};
use crate::impact::jam;
use crate::motion::{Motion, Spin};
use crate::observer_adapter::ObserverAdapter;
use crate::settings::Settings;
use coinmc_core::{Decided, DecisionRule, EventKind, Observer};
use std::f64::consts::FRAC_PI_2;

/// How sustained contact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Leave {
    /// The contact force has vanished: flight.
    LiftOff,
    /// The other rim has come down: the coin lies along its side, cos = 0, and still tilts.
    OtherRim,
    /// The tilt has vanished: the opposite point of the rim has come down.
    Upright,
    /// The face is decided.
    Decided(Decided),
    /// The motion repeats itself without loss.
    NeverSettles,
    /// Out of time.
    Late,
    /// Out of steps, or not a number.
    Lost,
}

/// Tilt at which the opposite point of the rim has come down, rad: a coin that does not roll round
/// the rim before comes down on all of it.
pub(crate) const FLAT: f64 = 1e-9;
/// A contact that gives way starts to slide at this fraction of `stick_speed`: its direction then
/// is decided within a time of that order. One that slows down to `RESEED` of that starts anew.
pub(super) const SEED: f64 = 1.0;
pub(super) const RESEED: f64 = 0.1;

/// Contact of one toss: the laws in force, and what the toss has taken.
pub(crate) struct Contact<'a> {
    pub(crate) law: &'a Law,
    pub(crate) rule: &'a DecisionRule,
    pub(crate) settings: &'a Settings,
    /// Error allowed per step, absolute and relative.
    pub(crate) tolerance: f64,
    pub(crate) spent: Spent,
}

/// What a toss has taken so far.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Spent {
    pub(crate) steps: u32,
    pub(crate) jams: u32,
    /// Time since launch, in flight and in contact.
    pub(crate) time: f64,
}

impl Spent {
    /// Counts an attempt at a step of `length`; whether there may be one.
    #[inline]
    pub(crate) fn may_attempt(&mut self, length: f64, settings: &Settings) -> bool {
        self.steps += 1;
        !(length < LEAST_STEP || self.steps >= settings.max_steps)
    }
}

/// [`Phase::tilts`] before the first.
const NO_TILTS: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// A phase on one rim point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Phase {
    pub(crate) state: RimState<f64>,
    pub(crate) mode: Mode,
    pub(crate) now: Rates<f64>,
    /// Length of the next step, but for what the state forbids.
    pub(crate) length: f64,
    pub(super) turning_points: u32,
    /// The least and the largest tilt at a turning point, rad.
    pub(super) tilts: [f64; 2],
    /// The energy at the mode's beginning: within it, truncation may err either way.
    pub(crate) ceiling: f64,
}

/// Where a step begins.
struct Start {
    state: RimState<f64>,
    rates: RimState<f64>,
    mode: Mode,
}

impl Phase {
    /// No phase yet.
    pub(crate) fn none() -> Self {
        Self {
            state: [0.0; 6],
            mode: Mode::Stick,
            now: Rates::none(),
            length: 0.0,
            turning_points: 0,
            tilts: NO_TILTS,
            ceiling: 0.0,
        }
    }

    /// Counts a turning point.
    pub(super) fn turned(&mut self, tilt: f64) {
        self.turning_points += 1;
        self.tilts = [self.tilts[0].min(tilt), self.tilts[1].max(tilt)];
    }

    fn start(&self) -> Start {
        Start {
            state: self.state,
            rates: self.now.state,
            mode: self.mode,
        }
    }
}

/// What a step led to.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Next {
    Go,
    /// Sticking or sliding changes; decided anew.
    Change,
    End(Leave),
}

impl Contact<'_> {
    /// Follows sustained contact from `motion`, which is left where it ends. `observer_adapter` is told of
    /// every mode and every step.
    pub(crate) fn follow<O: Observer>(
        &mut self,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Leave {
        let mut phase = self.start(motion, spin);
        adapter.event(kind(phase.mode), motion, spin);
        loop {
            if let Some(leave) = self.is_over(motion, spin) {
                return leave;
            }
            let before = O::ACTIVE.then(|| phase.start());
            let (next, length) = match self.blocked(&mut phase) {
                Some(next) => (next, 0.0),
                None => self.advance(&mut phase),
            };
            let ceiling = phase.ceiling;
            self.move_on(&mut phase, length, motion, spin);
            if let Some(start) = before {
                adapter.passed(length, |t| self.within(&start, t, ceiling));
            }
            if let Some(leave) = self.go_on(next, &mut phase, motion, spin) {
                return leave;
            }
            if matches!(next, Next::Change) {
                adapter.event(kind(phase.mode), motion, spin);
            }
        }
    }

    /// To where the next attempt at a step begins; `Some` if contact ends before.
    pub(crate) fn poise(
        &mut self,
        phase: &mut Phase,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
    ) -> Option<Leave> {
        loop {
            if let Some(leave) = self.is_over(motion, spin) {
                return Some(leave);
            }
            let next = self.blocked(phase)?;
            self.move_on(phase, 0.0, motion, spin);
            if let Some(leave) = self.go_on(next, phase, motion, spin) {
                return Some(leave);
            }
        }
    }

    /// What a step led to, done; `Some` if contact ends with it.
    pub(crate) fn go_on(
        &self,
        next: Next,
        phase: &mut Phase,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
    ) -> Option<Leave> {
        match next {
            Next::Go => None,
            Next::Change => {
                self.change(phase, motion, spin);
                None
            }
            Next::End(leave) => Some(leave),
        }
    }

    /// The phase that begins with `motion`.
    pub(crate) fn start(&self, motion: &mut Motion<f64>, spin: &mut Spin<f64>) -> Phase {
        let state = rim_state(self.law, motion, spin);
        let mut phase = self.enter(state);
        let rate = (1.0 + spin.tilt * spin.tilt + spin.axial * spin.axial).sqrt();
        phase.length = 0.1 / rate;
        self.begin(&mut phase, motion, spin);
        phase
    }

    #[inline]
    pub(super) fn decide(&self, motion: &Motion<f64>, spin: &Spin<f64>) -> Decided {
        self.rule
            .decide(&motion.decision_state(&self.law.body, spin))
    }

    /// Whether the face is decided or the toss is to be given up.
    fn is_over(&self, motion: &Motion<f64>, spin: &Spin<f64>) -> Option<Leave> {
        let decided = self.decide(motion, spin);
        if decided != Decided::Open {
            Some(Leave::Decided(decided))
        } else if self.spent.steps >= self.settings.max_steps {
            Some(Leave::Lost)
        } else if self.spent.time > self.settings.time_limit {
            Some(Leave::Late)
        } else {
            None
        }
    }

    /// The motion after a step of `length` that led to the state of `phase`.
    #[inline]
    pub(crate) fn move_on(
        &mut self,
        phase: &mut Phase,
        length: f64,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
    ) {
        self.spent.time += length;
        place_below(self.law, &mut phase.state, motion, spin, phase.ceiling);
    }

    /// The phase that follows one whose mode no longer holds.
    fn change(&self, phase: &mut Phase, motion: &mut Motion<f64>, spin: &mut Spin<f64>) {
        let length = phase.length;
        *phase = self.enter(phase.state);
        phase.length = length;
        self.begin(phase, motion, spin);
    }

    /// Puts the motion where a mode begins, with no more energy than it had.
    fn begin(&self, phase: &mut Phase, motion: &mut Motion<f64>, spin: &mut Spin<f64>) {
        let before = motion.energy(&self.law.body, spin);
        place_below(self.law, &mut phase.state, motion, spin, before);
        phase.ceiling = motion.energy(&self.law.body, spin).min(before);
    }

    /// The motion a time `t` into a step: by a shorter step from where it began.
    fn within(&self, start: &Start, t: f64, ceiling: f64) -> (Motion<f64>, Spin<f64>) {
        let mut state = step(
            &start.state,
            &start.rates,
            t,
            self.tolerance,
            |state: &_| self.law.rates(state, start.mode).state,
        )
        .state;
        // a long step may go a little beyond the side and come back
        state[TILT] = state[TILT].clamp(0.0, FRAC_PI_2);
        let (mut motion, mut spin) = (Motion::still(), Spin::still());
        place_below(self.law, &mut state, &mut motion, &mut spin, ceiling);
        (motion, spin)
    }

    /// Sticks if it can and the slip is all but gone, else slides.
    fn enter(&self, state: RimState<f64>) -> Phase {
        let mu = self.law.friction.mu;
        let slip = slip_speed(&state);
        let phase = |state, mode| Phase {
            state,
            mode,
            now: self.law.rates(&state, mode),
            ..Phase::none()
        };
        if mu == 0.0 || slip > self.settings.stick_speed {
            return phase(state, Mode::Slip);
        }
        let stick = phase(change_slip(self.law, &state, 0.0, 0.0), Mode::Stick);
        if can_stick(self.law, &stick.now) {
            return stick;
        }
        // it gives way against the friction that holding it would need
        let [fx, fy] = stick.now.friction;
        let needed = (fx * fx + fy * fy).sqrt();
        let least = SEED * self.settings.stick_speed;
        if slip < RESEED * least && needed > 0.0 {
            let seed = -least / needed;
            let gives = |gx, gy| phase(change_slip(self.law, &state, gx, gy), Mode::Slip);
            let slips = gives(seed * fx, seed * fy);
            // at high friction sliding one way may jam where sliding the other way does not
            return if slips.now.yields < YIELD {
                gives(-seed * fx, seed * fy)
            } else {
                slips
            };
        }
        phase(state, Mode::Slip)
    }

    /// Whether a coin in contact in this state presses, and tilts away from its side.
    pub(super) fn leans(&self, state: RimState<f64>) -> bool {
        let now = self.enter(state).now;
        now.press > 0.0 && now.state[OMEGA_Y] < 0.0
    }

    /// Whether no step leads on from here, and what does.
    fn blocked(&mut self, phase: &mut Phase) -> Option<Next> {
        if phase.state[TILT] <= FLAT && phase.state[OMEGA_Y] < 0.0 {
            Some(Next::End(Leave::Upright))
        } else if phase.now.press <= 0.0 {
            Some(Next::End(Leave::LiftOff))
        } else if phase.mode == Mode::Slip && phase.now.yields < YIELD {
            Some(self.jammed(phase))
        } else {
            None
        }
    }

    /// What follows an attempt that may not be made.
    pub(crate) fn give_up(
        &mut self,
        phase: &mut Phase,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
    ) -> Next {
        self.move_on(phase, 0.0, motion, spin);
        Next::End(Leave::Lost)
    }

    /// One step of the integration; the time it took.
    fn advance(&mut self, phase: &mut Phase) -> (Next, f64) {
        let rates = &phase.now.state;
        let mut length = limit(self.law, phase.mode, &phase.state, rates, phase.length);
        let mut again = false;
        loop {
            if !self.spent.may_attempt(length, self.settings) {
                return (Next::End(Leave::Lost), 0.0);
            }
            let (trial, now) = self.attempt(phase, length);
            if is_accepted(trial.error) {
                let wanted = wanted(length, trial.error, again);
                return self.accept(phase, &trial, &now, length, wanted);
            }
            again = true;
            length = shorter(length, trial.error);
        }
    }

    pub(super) fn attempt(&self, phase: &Phase, length: f64) -> (Trial<f64, 6>, Rates<f64>) {
        let mut last = phase.now;
        let flow = RimFlow {
            law: self.law,
            mode: phase.mode,
            last: &mut last,
        };
        let rates = &phase.now.state;
        let trial = step(&phase.state, rates, length, self.tolerance, flow);
        (trial, last)
    }

    /// Painlevé's configuration: an impulse at the contact, without approach, ends the slip.
    pub(super) fn jammed(&mut self, phase: &mut Phase) -> Next {
        self.spent.jams += 1;
        self.spent.steps += 1;
        phase.state = kicked(self.law, &phase.state, |touch| {
            jam(&self.law.body, &self.law.friction, touch)
        });
        Next::Change
    }
}

fn kind(mode: Mode) -> EventKind {
    match mode {
        Mode::Stick => EventKind::Sticking,
        Mode::Slip => EventKind::Sliding,
    }
}
