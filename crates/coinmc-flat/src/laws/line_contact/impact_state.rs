//! The state of one impact, and the errors of its integration.

use super::equations::{Body, CORNERS, LOST, State};
use super::scale::Scale;
use crate::dormand_prince::Step;
use crate::impact_law::ImpactRecord;

/// Rounding of the energy balance.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// One impact in progress.
pub(super) struct ImpactState {
    pub(super) body: Body,
    pub(super) y: State,
    pub(super) time: f64,
    pub(super) record: ImpactRecord,
    pub(super) scale: Scale,
    pub(super) tolerance: f64,
    /// Kinetic energy before the impact plus its normal part: the tolerance is a share of this.
    energy: f64,
    /// The present energy balance: see [`ImpactState::balance`].
    pub(super) balance: f64,
    /// The balance at the touch.
    initial_balance: f64,
    /// d of the damping.
    pub(super) strength: f64,
    /// Least speed for which damping is set: that of the first touch.
    pub(super) slowest: f64,
}

impl ImpactState {
    /// The lowest corner (number 0) touches at the speed `approach`; `mass` is the inverse of K_zz
    /// there. Sets the body's tangential stiffness to `ratio` of the secant stiffness at full
    /// depth.
    pub(super) fn new(
        mut body: Body,
        velocity: [f64; 3],
        (approach, mass): (f64, f64),
        (strength, ratio): (f64, f64),
        tolerance: f64,
    ) -> Self {
        let scale = Scale::new(body.stiffness, mass, approach);
        body.tangential = ratio * body.stiffness * libm::pow(scale.length, 1.0 / 9.0);
        let mut y = [0.0; 11];
        y[3..6].copy_from_slice(&velocity);
        let kinetic = kinetic(&body, &y);
        Self {
            body,
            y,
            time: 0.0,
            record: ImpactRecord::default(),
            scale,
            tolerance,
            energy: kinetic + 0.5 * mass * scale.speed * scale.speed,
            balance: kinetic,
            initial_balance: kinetic,
            strength,
            slowest: scale.speed,
        }
    }

    /// Energy that the integration has lost or gained. Changes of grip leave the balance unchanged.
    pub(super) fn imbalance(&self) -> f64 {
        self.initial_balance - self.balance
    }

    /// The energy of the motion, the energy stored in the corners, and the energy that damping and
    /// friction have taken (that of the tangential springs counts as taken). The sum is constant,
    /// but for the error of the integration.
    pub(super) fn balance(&self, y: &State) -> f64 {
        let stored = |which| self.body.stored(&self.body.place(y, which));
        kinetic(&self.body, y) + y[1] + (0..CORNERS).map(stored).sum::<f64>() + y[LOST]
    }

    /// The drift of the balance that is allowed in a time: in the duration of one impact, the
    /// tolerance times the energy; at least rounding.
    pub(super) fn allowed_drift(&self, time: f64) -> f64 {
        self.energy * (self.tolerance * time / self.scale.time).max(ROUNDING)
    }

    /// The step's error in units of the allowed error.
    pub(super) fn error(&self, step: &Step<11>) -> f64 {
        let Scale { length, speed, .. } = self.scale;
        let energy = speed * speed;
        let mut worst: f64 = 0.0;
        for (i, error) in step.error.iter().enumerate() {
            let unit = match i {
                3..6 => speed,
                LOST => energy,
                _ => length,
            };
            // smaller errors are rounding
            let allowed = (self.tolerance * unit).max(4.0 * f64::EPSILON * step.end[i].abs());
            let share = error.abs() / allowed;
            // NaN stays NaN
            worst = if share > worst || share.is_nan() {
                share
            } else {
                worst
            };
        }
        worst
    }
}

fn kinetic(body: &Body, y: &State) -> f64 {
    let [_, _, _, vx, vz, omega, ..] = *y;
    0.5 * (vx * vx + vz * vz + body.inertia * omega * omega)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dormand_prince::System;
    use crate::laws::line_contact::equations::Grip;
    use crate::laws::line_contact::equations::tests::body;

    /// A coin that turns above the surface, at the scales of an impact at speed 1.
    fn state(tolerance: f64) -> ImpactState {
        let corners = [(-0.6, -0.8), (0.6, -0.8), (-0.6, 0.8), (0.6, 0.8)];
        let body = body(0.3, corners, 1.0, Grip::Apart);
        ImpactState::new(body, [0.0, -1.0, 0.5], (1.0, 0.4), (0.1, 0.8), tolerance)
    }

    /// The allowed error of a displacement is the tolerance times the depth of the impact, of a velocity
    /// times the speed, of the lost energy times the speed's square; the worst counts.
    #[test]
    fn errors_are_in_units_of_depth_speed_and_energy() {
        let tolerance = 1e-6;
        let state = state(tolerance);
        let Scale { length, speed, .. } = state.scale;
        let units = [
            length,
            length,
            length,
            speed,
            speed,
            speed,
            length,
            length,
            length,
            length,
            speed * speed,
        ];
        let rates = state.body.rates(&state.y);
        let step = |errors: [f64; 11]| {
            let mut step = Step::take(&state.body, &state.y, &rates, 1e-9);
            step.error = errors;
            step
        };
        for (which, unit) in units.into_iter().enumerate() {
            let mut errors = units.map(|unit| 0.1 * tolerance * unit);
            errors[which] = -3.0 * tolerance * unit;
            let found = state.error(&step(errors));
            assert!((found - 3.0).abs() < 1e-12, "component {which}: {found}");
            errors[which] = f64::NAN;
            assert!(state.error(&step(errors)).is_nan(), "component {which}");
        }
        assert_eq!(state.error(&step([0.0; 11])), 0.0);
    }

    /// No step is asked for more than rounding leaves.
    #[test]
    fn errors_below_rounding_are_allowed() {
        let mut state = state(1e-12);
        state.y[3] = 1e9;
        let rates = state.body.rates(&state.y);
        let mut step = Step::take(&state.body, &state.y, &rates, 1e-9);
        step.error = [0.0; 11];
        step.error[3] = 2.0 * f64::EPSILON * 1e9;
        assert!((state.error(&step) - 0.5).abs() < 1e-6);
    }

    /// In the duration of one impact the balance may drift by the tolerance times the energy, in half of it by half
    /// as much; the energy is that of the motion and once more its normal part.
    #[test]
    fn the_balance_may_drift_by_the_tolerance_in_one_duration() {
        let state = state(1e-6);
        let energy = 0.5 * (1.0 + 0.3 * 0.25) + 0.5 * 0.4;
        for share in [0.5, 1.0, 2.0] {
            let allowed = state.allowed_drift(share * state.scale.time);
            assert!((allowed / (1e-6 * share * energy) - 1.0).abs() < 1e-12);
        }
        // rounding is always allowed
        assert_eq!(state.allowed_drift(0.0), energy * ROUNDING);
    }

    /// What the balance has lost since the touch is the imbalance.
    #[test]
    fn the_imbalance_is_what_the_balance_has_lost() {
        let mut state = state(1e-6);
        assert_eq!(state.imbalance(), 0.0);
        let lost = 0.125;
        state.balance -= lost;
        assert!((state.imbalance() - lost).abs() < 1e-15);
    }
}
