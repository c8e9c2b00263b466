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
