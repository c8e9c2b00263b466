//! Sustained contact of one rim point: its two modes and what ends them.
//!
//! ```text
//!             ┌── cone reached ──▶
//!   sticking                       sliding ── no force holds it (Painlevé) ──▶ tangential impact
//!             ◀── slip vanishes ──┘
//!   either ── normal force vanishes ──▶ flight
//!   either ── the other rim comes down, or the tilt vanishes ──▶ impact there
//! ```

use super::integrator::{LEAST_STEP, Trial, is_accepted, next_length, shorter, step};
use super::rim::{Law, Mode, OMEGA_Y, Rates, RimState, SLIP_X, SLIP_Y, TILT};
use super::state::{change_slip, kicked, place, rim_state};
use crate::impact::jam;
use crate::motion::{Motion, Spin};
use crate::settings::Settings;
use crate::verdict::{Judge, Verdict};
use crate::watch::Watch;
use coinmc_core::{EventKind, Observer};
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
    /// The face is settled.
    Settled(Verdict),
    /// The motion repeats itself without loss.
    Endless,
    /// Out of time.
    Late,
    /// Out of steps, or not a number.
    Lost,
}

/// Angle within which the other rim has come down, rad; the rest is an energy of 1e-12 at most.
const DOWN: f64 = 1e-12;
/// Tilt at which the opposite point of the rim has come down, rad: a coin that does not roll round
/// the rim before comes down on all of it.
pub(crate) const FLAT: f64 = 1e-9;
/// A slip that brakes is followed to this fraction of itself in one step.
const BRAKE: f64 = 0.05;
/// Painlevé: K_zz − μ K_xz n_x below this (it is 1 + rx²/kt without friction) counts as 0.
const YIELD: f64 = 1e-3;
/// A contact that gives way starts to slide at this fraction of `stick`: its direction then
/// settles within a time of that order. One that slows down to `RESEED` of that starts anew.
const SEED: f64 = 1.0;
const RESEED: f64 = 0.1;
/// Turning points of the tilt after which a conserving motion is seen to repeat itself.
const TURNING_POINTS: u32 = 3;

/// Contact of one toss: the laws in force, and its counters.
pub(crate) struct Contact<'a> {
    pub(crate) law: &'a Law,
    pub(crate) judge: &'a Judge,
    pub(crate) settings: &'a Settings,
    /// Error allowed per step, absolute and relative.
    pub(crate) tolerance: f64,
    pub(crate) steps: u32,
    pub(crate) jams: u32,
    pub(crate) time: f64,
}

/// A phase on one rim point.
struct Phase {
    state: RimState<f64>,
    mode: Mode,
    now: Rates<f64>,
    /// Length of the next step.
    length: f64,
    turning_points: u32,
}

/// Where a step begins.
struct Start {
    state: RimState<f64>,
    rates: RimState<f64>,
    mode: Mode,
}

impl Phase {
    fn start(&self) -> Start {
        Start {
            state: self.state,
            rates: self.now.state,
            mode: self.mode,
        }
    }
}

/// What a step led to.
enum Next {
    Go,
    /// Sticking or sliding changes; decided anew.
    Change,
    End(Leave),
}

impl Contact<'_> {
    /// Follows sustained contact from `motion`, which is left where it ends. `watch` is told of
    /// every mode and every step.
    pub(crate) fn follow<O: Observer>(
        &mut self,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        watch: &mut Watch<'_, O>,
    ) -> Leave {
        let state = rim_state(self.law, motion, spin);
        let mut phase = self.enter(state);
        let rate = (1.0 + spin.tilt * spin.tilt + spin.axial * spin.axial).sqrt();
        phase.length = 0.1 / rate;
        // the energy at the mode's beginning: within it, truncation may err either way
        let mut ceiling = self.begin(&mut phase, motion, spin);
        watch.event(kind(phase.mode), motion, spin);
        loop {
            let verdict = self.judge.verdict(motion, spin);
            if verdict != Verdict::Open {
                return Leave::Settled(verdict);
            }
            if self.steps >= self.settings.max_steps {
                return Leave::Lost;
            }
            if self.time > self.settings.time_limit {
                return Leave::Late;
            }
            let before = O::ACTIVE.then(|| phase.start());
            let (next, length) = self.advance(&mut phase);
            self.time += length;
            self.cap(&mut phase.state, motion, spin, ceiling);
            if let Some(start) = before {
                watch.passed(length, |t| self.within(&start, t, ceiling));
            }
            match next {
                Next::Go => {}
                Next::Change => {
                    let length = phase.length;
                    phase = self.enter(phase.state);
                    phase.length = length;
                    ceiling = self.begin(&mut phase, motion, spin);
                    watch.event(kind(phase.mode), motion, spin);
                }
                Next::End(leave) => return leave,
            }
        }
    }

    /// Puts the motion where a mode begins, with no more energy than it had; the energy it has.
    fn begin(&self, phase: &mut Phase, motion: &mut Motion<f64>, spin: &mut Spin<f64>) -> f64 {
        let before = motion.energy(&self.law.body, spin);
        self.cap(&mut phase.state, motion, spin, before);
        motion.energy(&self.law.body, spin).min(before)
    }

    /// The motion of a phase's state, with no more energy than `ceiling`.
    #[inline]
    fn cap(
        &self,
        state: &mut RimState<f64>,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        ceiling: f64,
    ) {
        place(self.law, state, motion, spin);
        let body = &self.law.body;
        let kinetic = motion.kinetic(body, spin);
        let allowed = ceiling - motion.z;
        if kinetic > allowed {
            let scale = (allowed.max(0.0) / kinetic).sqrt();
            for component in &mut state[OMEGA_Y..=SLIP_Y] {
                *component *= scale;
            }
            place(self.law, state, motion, spin);
        }
    }

    /// The motion a time `t` into a step: by a shorter step from where it began.
    fn within(&self, start: &Start, t: f64, ceiling: f64) -> (Motion<f64>, Spin<f64>) {
        let mut state = step(&start.state, &start.rates, t, self.tolerance, |state| {
            self.law.rates(state, start.mode).state
        })
        .state;
        // a long step may go a little beyond the side and come back
        state[TILT] = state[TILT].clamp(0.0, FRAC_PI_2);
        let (mut motion, mut spin) = (Motion::still(), Spin::still());
        self.cap(&mut state, &mut motion, &mut spin, ceiling);
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
            length: 0.0,
            turning_points: 0,
        };
        if mu == 0.0 || slip > self.settings.stick {
            return phase(state, Mode::Slip);
        }
        let stick = phase(change_slip(self.law, &state, 0.0, 0.0), Mode::Stick);
        if self.can_stick(&stick.now) {
            return stick;
        }
        // it gives way against the friction that holding it would need
        let [fx, fy] = stick.now.friction;
        let needed = (fx * fx + fy * fy).sqrt();
        let least = SEED * self.settings.stick;
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

    /// Whether the forces of a held contact point are within the friction cone.
    fn can_stick(&self, held: &Rates<f64>) -> bool {
        let [fx, fy] = held.friction;
        let most = self.law.friction.mu * held.normal;
        held.normal > 0.0 && fx * fx + fy * fy < most * most
    }

    /// Whether a sliding phase has come to where it sticks, or its direction is lost.
    fn is_stopping(&self, phase: &Phase) -> bool {
        let state = &phase.state;
        let slip = slip_speed(state);
        let [.., gx, gy] = *state;
        let [.., ax, ay] = phase.now.state;
        if self.law.friction.mu == 0.0 || slip > self.settings.stick || gx * ax + gy * ay >= 0.0 {
            return false;
        }
        let held = change_slip(self.law, state, 0.0, 0.0);
        slip < RESEED * SEED * self.settings.stick
            || self.can_stick(&self.law.rates(&held, Mode::Stick))
    }

    /// One step of the integration; the time it took.
    fn advance(&mut self, phase: &mut Phase) -> (Next, f64) {
        if phase.state[TILT] <= FLAT && phase.state[OMEGA_Y] < 0.0 {
            return (Next::End(Leave::Upright), 0.0);
        }
        if phase.now.press <= 0.0 {
            return (Next::End(Leave::LiftOff), 0.0);
        }
        if phase.mode == Mode::Slip && phase.now.yields < YIELD {
            return (self.jammed(phase), 0.0);
        }
        let mut length = phase
            .length
            .min(self.braking_limit(phase))
            .min(flattening_limit(&phase.state));
        let mut rejected = false;
        loop {
            self.steps += 1;
            if length < LEAST_STEP || self.steps >= self.settings.max_steps {
                return (Next::End(Leave::Lost), 0.0);
            }
            let (trial, now) = self.attempt(phase, length);
            if !is_accepted(trial.error) {
                rejected = true;
                length = shorter(length, trial.error);
                continue;
            }
            // what made it too long is likely still ahead
            let wanted = if rejected {
                length.min(next_length(length, trial.error))
            } else {
                next_length(length, trial.error)
            };
            return self.accept(phase, &trial, &now, length, wanted);
        }
    }

    fn attempt(&self, phase: &Phase, length: f64) -> (Trial<f64, 6>, Rates<f64>) {
        let mut last = phase.now;
        let trial = step(
            &phase.state,
            &phase.now.state,
            length,
            self.tolerance,
            |state| {
                last = self.law.rates(state, phase.mode);
                last.state
            },
        );
        (trial, last)
    }

    /// Sees whether an accepted step passes an event; if so the phase goes to the event instead.
    fn accept(
        &mut self,
        phase: &mut Phase,
        trial: &Trial<f64, 6>,
        now: &Rates<f64>,
        length: f64,
        wanted: f64,
    ) -> (Next, f64) {
        let tilt = trial.state[TILT];
        let falls_on = tilt > FRAC_PI_2 - DOWN && trial.state[OMEGA_Y] > 0.0;
        // beyond, it has come down within the step, even if it has turned round since
        if falls_on || tilt > FRAC_PI_2 + DOWN {
            return self.reach(phase, trial, length, FRAC_PI_2, Leave::OtherRim);
        }
        if tilt < FLAT && phase.state[TILT] > FLAT {
            return self.reach(phase, trial, length, FLAT, Leave::Upright);
        }
        if self.holds(phase.mode, now) {
            if trial.state[OMEGA_Y] * phase.state[OMEGA_Y] < 0.0 {
                phase.turning_points += 1;
            }
            phase.state = trial.state;
            phase.now = *now;
            phase.length = wanted;
            return (self.after_step(phase), length);
        }
        let (fraction, state, now) = self.locate(phase, trial);
        phase.state = state;
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

    /// Whether the mode is still consistent.
    fn holds(&self, mode: Mode, now: &Rates<f64>) -> bool {
        if now.press <= 0.0 {
            return false;
        }
        match mode {
            Mode::Slip => now.yields >= YIELD,
            Mode::Stick => self.can_stick(now),
        }
    }

    /// The first moment of the step at which the mode no longer holds, by bisection of the dense
    /// output: its own error is that of the step, so a thousandth of the step is close enough.
    fn locate(&self, phase: &Phase, trial: &Trial<f64, 6>) -> (f64, RimState<f64>, Rates<f64>) {
        let (mut low, mut high) = (0.0, 1.0);
        let mut found = (trial.state, self.law.rates(&trial.state, phase.mode));
        while high - low > 1e-3 {
            let middle = 0.5 * (low + high);
            let state = trial.between(&phase.state, middle);
            let now = self.law.rates(&state, phase.mode);
            if self.holds(phase.mode, &now) {
                low = middle;
            } else {
                high = middle;
                found = (state, now);
            }
        }
        (high, found.0, found.1)
    }

    /// Ends the step where the tilt reaches `goal`.
    fn reach(
        &mut self,
        phase: &mut Phase,
        trial: &Trial<f64, 6>,
        length: f64,
        goal: f64,
        leave: Leave,
    ) -> (Next, f64) {
        let arrived = |state: &RimState<f64>| (state[TILT] - goal).abs() <= DOWN;
        // the side the phase is on: it may start at the goal itself, going away and coming back
        let before = if leave == Leave::OtherRim { -1.0 } else { 1.0 };
        let (mut low, mut high) = (0.0, length);
        let mut at = length;
        let mut state = trial.state;
        for _ in 0..40 {
            if arrived(&state) {
                break;
            }
            let gap = state[TILT] - goal;
            if gap * before > 0.0 {
                low = at;
            } else {
                high = at;
            }
            let newton = at - gap / state[OMEGA_Y];
            at = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            self.steps += 1;
            state = self.attempt(phase, at).0.state;
        }
        state[TILT] = goal;
        phase.state = state;
        (Next::End(leave), at)
    }

    fn after_step(&self, phase: &Phase) -> Next {
        let smooth = phase.mode == Mode::Stick || self.law.friction.mu == 0.0;
        let conserves = smooth && !self.law.friction.twists() && !self.law.drag.acts();
        if conserves && phase.turning_points >= TURNING_POINTS {
            return Next::End(Leave::Endless);
        }
        if phase.mode == Mode::Slip && self.is_stopping(phase) {
            Next::Change
        } else {
            Next::Go
        }
    }

    /// A braking slip is not stepped across: its direction would flip within the step.
    fn braking_limit(&self, phase: &Phase) -> f64 {
        if phase.mode == Mode::Stick || self.law.friction.mu == 0.0 {
            return f64::INFINITY;
        }
        let [.., gx, gy] = phase.state;
        let braking = -(gx * phase.now.state[SLIP_X] + gy * phase.now.state[SLIP_Y]);
        if braking <= 0.0 {
            return f64::INFINITY;
        }
        (1.0 - BRAKE) * (gx * gx + gy * gy) / braking
    }

    /// Painlevé's configuration: an impulse at the contact, without approach, ends the slip.
    fn jammed(&mut self, phase: &mut Phase) -> Next {
        self.jams += 1;
        self.steps += 1;
        phase.state = kicked(self.law, &phase.state, |touch| {
            jam(&self.law.body, &self.law.friction, touch)
        });
        Next::Change
    }
}

/// A falling coin is not stepped to where it would be flat: the rates grow like 1/θ there.
fn flattening_limit(state: &RimState<f64>) -> f64 {
    if state[OMEGA_Y] < 0.0 {
        -0.5 * state[TILT].max(2.0 * FLAT) / state[OMEGA_Y]
    } else {
        f64::INFINITY
    }
}

fn slip_speed(state: &RimState<f64>) -> f64 {
    let [.., gx, gy] = *state;
    (gx * gx + gy * gy).sqrt()
}

fn kind(mode: Mode) -> EventKind {
    match mode {
        Mode::Stick => EventKind::Sticking,
        Mode::Slip => EventKind::Sliding,
    }
}
