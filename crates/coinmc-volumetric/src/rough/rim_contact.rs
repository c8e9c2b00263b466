//! Sustained contact of one rim on rough ground.

use super::tracks::rim_points;
use super::walk::{FLATTEST, Next, Touch, Walk};
use crate::contact::{
    LEAST_JAM_MARGIN, Mode, RESTART_SLIP, Rates, RimState, ScalarStep, Trial, can_stick, holds,
    is_accepted, next_length, place_unfolded, rim_state, shorter, slip_speed, step_limit,
};
use crate::contact::{OMEGA_Y, SLIP_X, SLIP_Y, TILT};
use crate::impact::{ImpactLaw, Impulse, jam_impulse};
use crate::motion::{Motion, Spin};
use crate::transition::Transition;
use coinmc_core::{EventKind, Observer};

/// Shortest step that is repeated because the mode does not hold at its end, as a share of the time
/// between nodes.
const LEAST_STEP: f64 = 0.02;
/// The other rim touches within this gap.
const TOUCH: f64 = 1e-10;
/// Rocking over a gap smaller than this share of how much the ground differs under both rims counts as contact
/// of both.
const NO_ROCKING: f64 = 0.05;
/// A kink is real where it exceeds the concave curve that the rim can follow by this share of it.
const KINK: f64 = 1e-3;

/// Contact in one mode.
pub(super) struct Contact {
    pub(super) state: RimState<f64>,
    pub(super) mode: Mode,
    pub(super) now: Rates<f64>,
}

impl<I: ImpactLaw, O: Observer> Walk<'_, I, O> {
    /// Follows contact of the own rim to the next node or event.
    pub(super) fn roll_on_rim(&mut self) -> Next {
        let slopes = self.tracks.own.slopes(self.ground);
        self.ahead = self.ahead_with(slopes);
        let mut contact = self.contact();
        if contact.now.press <= 0.0 {
            return Next::Goes(Touch::Nothing);
        }
        if self.tracks.at_node() {
            return self.pass_node(&contact, slopes);
        }
        if self.is_clear() {
            return Next::Ends(Transition::Contact);
        }
        if self.barely_rocks(&contact) {
            return self.lie_down();
        }
        self.notify_mode(&contact);
        let mut wanted = self.tracks.left;
        loop {
            match self.step_on_rim(&mut contact, &mut wanted) {
                Some(Next::Goes(Touch::Rim)) => contact = self.contact(),
                Some(next) => return next,
                None => {}
            }
            if self.tracks.at_node() {
                return self.pass_node(&contact, slopes);
            }
        }
    }

    /// One accepted step; what follows if it meets an event. `Goes(Rim)`: the mode changes.
    fn step_on_rim(&mut self, contact: &mut Contact, wanted: &mut f64) -> Option<Next> {
        let model = self.model;
        let dynamics = &model.dynamics;
        let rules = model.contact_rules();
        let least = LEAST_STEP * self.tracks.interval;
        loop {
            self.usage.steps += 1;
            let limited = step_limit(
                dynamics,
                contact.mode,
                &contact.state,
                &contact.now.state,
                *wanted,
            );
            let length = limited.min(self.tracks.left);
            if !model.limits.allow_step(length, f64::from(self.usage.steps)) {
                return Some(Next::Ends(Transition::End(model.end_given_up(self.toss))));
            }
            let step = ScalarStep {
                state: &contact.state,
                now: &contact.now,
                mode: contact.mode,
                length,
                tolerance: rules.tolerance,
            };
            let (trial, now) = step.run_ahead(dynamics, self.ahead);
            if !is_accepted(trial.error) {
                *wanted = shorter(length, trial.error);
                continue;
            }
            let grown = next_length(length, trial.error);
            if let Some(time) = self.touch_of_other(contact, &trial, length) {
                let state = trial.between(&contact.state, time / length);
                self.move_to(&state, time);
                self.switch_rim();
                return Some(Next::Impact);
            }
            if !holds(dynamics, contact.mode, &now) && length > least {
                *wanted = 0.5 * length;
                continue;
            }
            *wanted = grown;
            contact.state = trial.state;
            contact.now = now;
            self.move_to(&trial.state, length);
            return self.after_step(contact);
        }
    }

    /// What follows at the end of a step.
    fn after_step(&mut self, contact: &Contact) -> Option<Next> {
        let (dynamics, now) = (&self.model.dynamics, &contact.now);
        if self.toss.motion.sin < FLATTEST {
            return Some(Next::Ends(Transition::Contact));
        }
        if now.press <= 0.0 {
            self.balance();
            self.model
                .notify(self.toss, EventKind::LiftOff, self.observer);
            return Some(Next::Goes(Touch::Nothing));
        }
        let slows = contact.state[SLIP_X] * now.state[SLIP_X]
            + contact.state[SLIP_Y] * now.state[SLIP_Y]
            < 0.0;
        let slow = slip_speed(&contact.state) <= self.model.contact_rules().stick_speed;
        let ends = contact.mode == Mode::Slip && dynamics.friction.mu > 0.0 && slow && slows;
        (ends || !holds(dynamics, contact.mode, now)).then_some(Next::Goes(Touch::Rim))
    }

    /// When within a step the other rim touches its track, if it does.
    fn touch_of_other(&self, contact: &Contact, trial: &Trial<f64, 6>, length: f64) -> Option<f64> {
        let (tracks, half) = (&self.tracks, self.body().half);
        let gap = |tilt: f64, time: f64| {
            2.0 * half * libm::cos(tilt)
                + (tracks.own.height - tracks.other.height)
                + (tracks.own.rate - tracks.other.rate) * time
        };
        let end = gap(trial.state[TILT], length);
        if end > 0.0 {
            return None;
        }
        let start = gap(contact.state[TILT], 0.0);
        let closing = -2.0 * half * contact.state[OMEGA_Y] + tracks.own.rate - tracks.other.rate;
        if start <= TOUCH && closing < 0.0 {
            return Some(0.0);
        }
        let (mut low, mut high) = ((0.0, start.max(TOUCH)), (length, end));
        for _ in 0..60 {
            let chord = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
            let time = 0.5 * (chord + 0.5 * (low.0 + high.0));
            let state = trial.between(&contact.state, time / length);
            let here = gap(state[TILT], time);
            if here.abs() <= TOUCH || high.0 - low.0 <= 1e-12 * length {
                return Some(time);
            }
            if here > 0.0 {
                low = (time, here);
            } else {
                high = (time, here);
            }
        }
        Some(high.0)
    }

    /// Moves the coin to a state of contact, `time` later. Friction takes energy; the numerical
    /// error of a step may not add any.
    fn move_to(&mut self, state: &RimState<f64>, time: f64) {
        let dynamics = &self.model.dynamics.touching_ahead(self.ahead);
        let before = (self.toss.motion, self.toss.spin);
        let energy = self.relative_motion().energy(&dynamics.body, &before.1);
        self.half_way(time);
        self.tracks.advance(time);
        let (mut motion, mut spin) = (Motion::still(), Spin::still());
        place_unfolded(dynamics, state, &mut motion, &mut spin);
        motion.cap_energy(&dynamics.body, &mut spin, energy);
        motion.set_spin(&spin, dynamics.axial_factor);
        self.budget -= (energy - motion.energy(&dynamics.body, &spin)).max(0.0);
        self.set_relative(motion, spin);
        self.half_way(time);
        self.usage.time += time;
        self.show(before, time);
    }

    /// The contact of the own rim in the mode that its state allows.
    pub(super) fn contact(&mut self) -> Contact {
        let dynamics = &self.model.dynamics.touching_ahead(self.ahead);
        let stick_speed = self.model.contact_rules().stick_speed;
        let motion = self.relative_motion();
        let state = rim_state(dynamics, &motion, &self.toss.spin);
        let slipping = |state: RimState<f64>| Contact {
            state,
            mode: Mode::Slip,
            now: dynamics.rates(&state, Mode::Slip),
        };
        let slip = slip_speed(&state);
        if dynamics.friction.mu == 0.0 || slip > stick_speed {
            let contact = slipping(state);
            return if contact.now.jam_margin < LEAST_JAM_MARGIN && contact.now.press > 0.0 {
                self.end_jam()
            } else {
                contact
            };
        }
        let held = self.with_slip(0.0, 0.0);
        let now = dynamics.rates(&held, Mode::Stick);
        if can_stick(dynamics, &now) {
            return Contact {
                state: held,
                mode: Mode::Stick,
                now,
            };
        }
        let [fx, fy] = now.friction;
        let needed = (fx * fx + fy * fy).sqrt();
        if slip < RESTART_SLIP * stick_speed && needed > 0.0 {
            let scale = -stick_speed / needed;
            slipping(self.with_slip(scale * fx, scale * fy))
        } else {
            slipping(state)
        }
    }

    /// A jam (Painlevé's configuration): an impulse at the contact point ends the slip.
    fn end_jam(&mut self) -> Contact {
        self.usage.jams += 1;
        let dynamics = &self.model.dynamics.touching_ahead(self.ahead);
        self.push(|point| jam_impulse(&dynamics.body, &dynamics.friction, point));
        let motion = self.relative_motion();
        let state = rim_state(dynamics, &motion, &self.toss.spin);
        Contact {
            state,
            mode: Mode::Stick,
            now: dynamics.rates(&state, Mode::Stick),
        }
    }

    /// Applies an impulse at the lowest point of the own rim.
    pub(super) fn push(
        &mut self,
        impulse: impl FnOnce(&crate::impact::ContactPoint<f64>) -> Impulse<f64>,
    ) {
        let dynamics = &self.model.dynamics;
        let (mut motion, mut spin) = (self.relative_motion(), self.toss.spin);
        let point = motion.contact_point(&dynamics.body, &spin);
        motion.apply_impulse(&mut spin, &dynamics.body, &point, impulse(&point));
        motion.set_spin(&spin, dynamics.axial_factor);
        self.set_relative(motion, spin);
    }

    /// The state of contact after an impulse that changes the slip at a constant normal velocity.
    fn with_slip(&mut self, gx: f64, gy: f64) -> RimState<f64> {
        let dynamics = &self.model.dynamics.touching_ahead(self.ahead);
        let (mut motion, mut spin) = (self.relative_motion(), self.toss.spin);
        let point = motion.contact_point(&dynamics.body, &spin);
        let k = point.matrix(&dynamics.body);
        let drift = dynamics.drift(motion.sin, motion.cos, spin.axial, spin.turn);
        let x = (gx + drift - point.slip_x) * k.zz / (k.xx + k.zz - 1.0);
        let impulse = Impulse {
            x,
            y: (gy - point.slip_y) / k.yy,
            z: -(k.xz / k.zz) * x,
            contour: 0.0,
            pivoting: 0.0,
        };
        motion.apply_impulse(&mut spin, &dynamics.body, &point, impulse);
        let mut state = rim_state(dynamics, &motion, &spin);
        (state[SLIP_X], state[SLIP_Y]) = (gx, gy);
        state
    }

    /// The next node, where the ground has these slopes: the track bends.
    fn pass_node(&mut self, contact: &Contact, slopes: [f64; 2]) -> Next {
        let (old, before) = (self.tracks.own.rate, self.tracks.interval);
        self.descend_on_rim(contact, slopes, before);
        self.lead = 0.0;
        self.balance();
        let after = self.time_between_nodes();
        let energy = self.energy();
        self.descend_on_rim(contact, slopes, after);
        self.lead = self.energy() - energy;
        self.lay_out_tracks_for(after);
        let time = 0.5 * (before + after);
        self.follow_bend(self.tracks.own.rate - old, contact.now.press, time)
    }

    /// The own rim meets a bend of its track: the rate at which the track rises grows by `bend`,
    /// in a time of about `time`; without contact the rim would fall at `press`.
    pub(super) fn follow_bend(&mut self, bend: f64, press: f64, time: f64) -> Next {
        if bend < 0.0 {
            return if -bend <= press * time {
                self.change_normal_velocity(bend);
                self.balance();
                Next::Goes(Touch::Rim)
            } else {
                self.rise()
            };
        }
        let [own, _] = rim_points(self.body(), &self.toss.motion, &self.toss.spin);
        let speed = own.speed();
        let curvature = self.toss.motion.sin / self.body().outer_radius();
        let smooth = speed * speed * time * curvature;
        if bend <= (1.0 + KINK) * smooth {
            self.change_normal_velocity(bend);
            self.balance();
            return Next::Goes(Touch::Rim);
        }
        self.change_normal_velocity(smooth);
        Next::Impact
    }

    /// An impulse at the own rim that changes its normal velocity and not its slip.
    fn change_normal_velocity(&mut self, change: f64) {
        let dynamics = &self.model.dynamics;
        self.push(|point| {
            let k = point.matrix(&dynamics.body);
            let scale = change / (k.xx + k.zz - 1.0);
            Impulse {
                x: -k.xz * scale,
                y: 0.0,
                z: k.xx * scale,
                contour: 0.0,
                pivoting: 0.0,
            }
        });
    }

    /// Whether the other rim is down too, apart from rocking that the ground outweighs.
    fn barely_rocks(&self, contact: &Contact) -> bool {
        let (body, tracks) = (self.body(), &self.tracks);
        let gap = self.gap_of_other().max(0.0);
        let most = (NO_ROCKING * self.ground.unevenness())
            .max(2.0 * body.half * body.half * self.model.negligible_rocking);
        let rate = -2.0 * body.half * contact.state[OMEGA_Y] * self.toss.motion.sin
            + tracks.own.rate
            - tracks.other.rate;
        let fall = 2.0 * body.half * contact.now.state[OMEGA_Y] * self.toss.motion.sin;
        fall > 0.0 && gap + 0.5 * rate * rate / fall <= most
    }

    fn notify_mode(&mut self, contact: &Contact) {
        let kind = match contact.mode {
            Mode::Stick => EventKind::Sticking,
            Mode::Slip => EventKind::Sliding,
        };
        self.model.notify(self.toss, kind, self.observer);
    }

    /// Shows the way from an earlier motion to the present one, along a straight line in the space
    /// of states.
    pub(super) fn show(&mut self, before: (Motion<f64>, Spin<f64>), time: f64) {
        if !O::ACTIVE {
            return;
        }
        let after = (self.toss.motion, self.toss.spin);
        let blend = |t: f64| {
            let share = t / time;
            let mix = |a: f64, b: f64| a + share * (b - a);
            let (a, b) = (before.0.columns(), after.0.columns());
            let mut motion = Motion::from_columns(&std::array::from_fn(|i| mix(a[i], b[i])));
            // the axis stays a unit vector
            let length = (motion.sin * motion.sin + motion.cos * motion.cos).sqrt();
            (motion.sin, motion.cos) = (motion.sin / length, motion.cos / length);
            let (a, b) = (before.1.columns(), after.1.columns());
            let spin = Spin::from_columns(&std::array::from_fn(|i| mix(a[i], b[i])));
            (motion, spin)
        };
        let start = self.toss.place;
        let (_, _, mut adapter) = self.toss.observed(&self.model.units, self.observer);
        adapter.step(time, blend);
        self.descend_from(&start);
    }
}

#[cfg(test)]
mod tests;
