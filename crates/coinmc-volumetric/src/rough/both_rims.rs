//! A coin on its side on rough ground: both rims follow their tracks.
//!
//! The lean follows from the tracks, c = a = (ζ₂ − ζ₁)/2h (ζ₁ under the rim at −h u), and so do
//! ω_y = −a' and the height of the centre. What is left moves as on a plane (see `contact::line`).
//! At a node the rates of the tracks change, within about the time between nodes. With
//! N = 1 + z'' the normal forces that this takes obey
//!
//! h (N₁ − N₂) = k_t ω_y' − k_t G + R a N + R f_x,  f_x = f_x(line) + R ω_y',
//!
//! with G the gyroscopic part of ω_y'. While both are positive, both rims stay down. Otherwise one
//! rim lifts off.

use super::walk::{Next, Touch, Walk};
use crate::contact::{
    LineState, RollingStop, is_accepted, line_rates_on, next_length, shorter, step,
};
use crate::impact::ImpactLaw;
use crate::motion::{Motion, Spin};
use crate::transition::Transition;
use coinmc_core::{EventKind, Observer};

/// Which rims of a coin on its side stay down at a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Down {
    Nothing,
    Own,
    Other,
    Both,
}

impl<I: ImpactLaw, O: Observer> Walk<'_, I, O> {
    /// Puts both rims down. What is lost of the energy is that of rocking which the ground
    /// outweighs.
    pub(super) fn lie_down(&mut self) -> Next {
        let state = self.line_state();
        self.place_on_tracks(&state);
        self.budget = self.budget.min(self.energy());
        self.balance();
        Next::Goes(Touch::Both)
    }

    /// Follows contact of both rims to the next node or event.
    pub(super) fn roll_on_both(&mut self) -> Next {
        let dynamics = &self.model.dynamics;
        let mut state = self.line_state();
        let mut wanted = self.tracks.left;
        let tracks = [self.tracks.own, self.tracks.other];
        let slopes = tracks.map(|track| track.slopes(self.ground));
        let ahead = self.both_ahead(&state, slopes);
        self.notify_motion_of_both(&state);
        while !self.tracks.at_node() {
            let before = (self.toss.motion, self.toss.spin);
            let Some((next, time)) = self.step_of_line(&state, ahead, &mut wanted) else {
                return Next::Ends(Transition::End(self.model.end_given_up(self.toss)));
            };
            let energy = |s: &LineState| {
                let (body, [vx, vy, wa, wz]) = (&dynamics.body, *s);
                0.5 * (vx * vx + vy * vy + body.ka * wa * wa + body.kt * wz * wz)
            };
            let (had, has) = (energy(&state), energy(&next));
            let scale = if has > had { (had / has).sqrt() } else { 1.0 };
            state = next.map(|rate| rate * scale);
            self.budget -= (had - has).max(0.0);
            self.half_way(time);
            self.tracks.advance(time);
            self.place_on_tracks(&state);
            self.half_way(time);
            self.usage.time += time;
            self.show(before, time);
        }
        self.pass_node_on_both(&state, slopes, ahead)
    }

    /// Shows how a coin on both rims moves. Straight rolling is shown as sticking.
    fn notify_motion_of_both(&mut self, state: &LineState) {
        let kind = if self.model.contact_rules().rolls_straight(state) {
            EventKind::Sticking
        } else {
            EventKind::Sliding
        };
        self.model.notify(self.toss, kind, self.observer);
    }

    /// How far ahead of their lowest points both rims touch ground of these slopes; that of a coin that rolls
    /// straight does not matter.
    fn both_ahead(&self, state: &LineState, slopes: [[f64; 2]; 2]) -> [f64; 2] {
        if self.model.contact_rules().rolls_straight(state) {
            return [0.0; 2];
        }
        slopes.map(|slopes| self.ahead_with(slopes))
    }

    /// One step of the motion along the ground, and its duration; `None` at a limit.
    fn step_of_line(
        &mut self,
        state: &LineState,
        ahead: [f64; 2],
        wanted: &mut f64,
    ) -> Option<(LineState, f64)> {
        let model = self.model;
        let dynamics = &model.dynamics;
        let rules = model.contact_rules();
        if rules.rolls_straight(state) {
            self.usage.steps += 1;
            let time = self.tracks.left;
            let rolling = RollingStop::new(dynamics, state[1].abs());
            let left = if rolling.stops() {
                rolling.left(time)
            } else {
                1.0
            };
            return Some((state.map(|rate| rate * left), time));
        }
        let rates =
            |s: &LineState| line_rates_on::<true>(dynamics, s, rules.stick_speed, ahead).rates;
        let first = rates(state);
        loop {
            self.usage.steps += 1;
            let length = wanted.min(self.tracks.left);
            if !model.limits.allow_step(length, f64::from(self.usage.steps)) {
                return None;
            }
            let trial = step(state, &first, length, rules.tolerance, rates);
            if is_accepted(trial.error) {
                *wanted = next_length(length, trial.error);
                return Some((trial.state, length));
            }
            *wanted = shorter(length, trial.error);
        }
    }

    /// The next node, where the ground has these slopes: both tracks bend, and one or both rims may lift off.
    fn pass_node_on_both(
        &mut self,
        state: &LineState,
        slopes: [[f64; 2]; 2],
        ahead: [f64; 2],
    ) -> Next {
        let old = self.tracks;
        let state = self.descend_on_both(state, slopes, old.interval);
        self.place_on_tracks(&state);
        self.lead = 0.0;
        self.balance();
        let (after, energy) = (self.time_between_nodes(), self.energy());
        let state = self.descend_on_both(&self.line_state(), slopes, after);
        self.place_on_tracks(&state);
        self.lead = self.energy() - energy;
        self.lay_out_tracks_for(after);
        let new = &self.tracks;
        let time = 0.5 * (old.interval + new.interval);
        let bends = [new.own.rate - old.own.rate, new.other.rate - old.other.rate];
        let bend = match self.down_at(&state, bends, time, ahead) {
            Down::Nothing => return Next::Goes(Touch::Nothing),
            Down::Both => {
                self.place_on_tracks(&state);
                self.balance();
                return Next::Goes(Touch::Both);
            }
            Down::Own => bends[0],
            Down::Other => {
                self.switch_rim();
                bends[1]
            }
        };
        self.follow_bend(bend, 1.0, time)
    }

    /// What the normal forces keep down of a coin on both rims at a node, where the rates of the tracks grow by
    /// `bends` within `time`.
    fn down_at(&self, state: &LineState, bends: [f64; 2], time: f64, ahead: [f64; 2]) -> Down {
        let dynamics = &self.model.dynamics;
        let body = &dynamics.body;
        let (own, other) = (&self.tracks.own, &self.tracks.other);
        let lean = (other.height - own.height) / (2.0 * body.half);
        let tilting = (bends[0] - bends[1]) / (2.0 * body.half * time);
        let normal = 1.0 + 0.5 * (bends[0] + bends[1]) / time;
        let [_, vy, wa, wz] = *state;
        let mut along = line_rates_on::<true>(
            dynamics,
            state,
            self.model.contact_rules().stick_speed,
            ahead,
        )
        .rates[0]
            - wz * vy;
        if self.holds_across(state) {
            along -= self.pull()[0];
        }
        let gyroscopic = -wz * dynamics.axial_factor * wa;
        let moment = body.kt * (tilting - gyroscopic)
            + body.radius * lean * normal
            + body.outer_radius() * (along + body.outer_radius() * tilting);
        if normal <= 0.0 {
            Down::Nothing
        } else if moment.abs() <= body.half * normal {
            Down::Both
        } else if moment > 0.0 {
            Down::Own
        } else {
            Down::Other
        }
    }

    /// The motion along the ground of a coin on its side.
    fn line_state(&self) -> LineState {
        let (motion, spin) = (&self.toss.motion, &self.toss.spin);
        let lateral = motion.vx - self.body().outer_radius() * spin.tilt;
        [lateral, motion.vy, spin.axial, -spin.turn]
    }

    /// Sets the motion of a coin whose rims both follow their tracks.
    fn place_on_tracks(&mut self, state: &LineState) {
        let body = self.model.dynamics.body;
        let [vx, vy, axial, wz] = *state;
        let (own, other) = (self.tracks.own, self.tracks.other);
        let cos = (other.height - own.height) / (2.0 * body.half);
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let tilt = (own.rate - other.rate) / (2.0 * body.half);
        let spin = Spin {
            axial,
            turn: -wz,
            tilt,
        };
        let mut motion = Motion {
            sin,
            cos,
            vx: vx + body.outer_radius() * tilt,
            vy,
            vz: 0.5 * (own.rate + other.rate),
            z: 0.5 * (own.height + other.height) + body.radius * sin,
            ..self.toss.motion
        };
        motion.set_spin(&spin, self.model.dynamics.axial_factor);
        (self.toss.motion, self.toss.spin) = (motion, spin);
    }
}

#[cfg(test)]
mod tests;
