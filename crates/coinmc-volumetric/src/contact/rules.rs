//! What governs sustained contact, and what a toss has used.

use super::dynamics::Dynamics;
use super::line::LineState;
use crate::limits::Limits;
use crate::motion::{Motion, Spin};
use coinmc_core::{Decided, DecisionRule};

/// What governs sustained contact.
#[derive(Clone, Copy)]
pub(crate) struct ContactRules<'a> {
    pub(crate) dynamics: &'a Dynamics,
    pub(crate) rule: &'a DecisionRule,
    pub(crate) limits: &'a Limits,
    /// The tilt, rad, at which the other rim touches: π/2; on rough ground a little less, where the
    /// ground under that rim begins to matter.
    pub(crate) side: f64,
    /// Slip below which a contact point may stick.
    pub(crate) stick_speed: f64,
    /// Slip below which a coin on its side rolls straight: that of its creep.
    pub(crate) creep: f64,
    /// Error allowed per step, absolute and relative.
    pub(crate) tolerance: f64,
}

impl ContactRules<'_> {
    /// Which face is decided by the motion now.
    #[inline(always)]
    pub(crate) fn decide(&self, motion: &Motion<f64>, spin: &Spin<f64>) -> Decided {
        let body = &self.dynamics.body;
        self.rule.decide(&motion.decision_state(body, spin))
    }

    /// Whether only straight rolling and a creep are left to a coin on its side.
    pub(crate) fn rolls_straight(&self, state: &LineState) -> bool {
        let [vx, vy, wa, wz] = *state;
        let body = &self.dynamics.body;
        let slip = (vy + body.outer_radius() * wa).abs() + (body.half * wz).abs() + vx.abs();
        self.dynamics.friction.mu > 0.0 && slip < self.creep
    }
}

/// What a toss has used so far.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Usage {
    /// Tries at steps of contact.
    pub(crate) steps: u32,
    pub(crate) jams: u32,
    /// Time since the launch, in flight and in contact.
    pub(crate) time: f64,
}

#[cfg(test)]
mod tests {
    use crate::toss::tests::model;

    /// A coin rolls straight, however fast, as long as what slips or turns at its rims is slower than the creep; on
    /// a surface without friction nothing makes it roll.
    #[test]
    fn a_coin_rolls_straight_while_its_rims_slip_less_than_the_creep() {
        let mut model = model();
        model.dynamics.body.rim = 0.07;
        let body = model.dynamics.body;
        let mut rules = model.contact_rules();
        rules.creep = 0.013;
        let fast = -0.83;
        let rolling = [0.0, -(body.radius + 0.07) * fast, fast, 0.0];
        assert!(rules.rolls_straight(&rolling));
        for way in [1.0, -1.0] {
            let slips = |share: f64| {
                let slip = share * 0.013 * way;
                let mut states = [rolling; 5];
                states[0][0] += slip;
                states[1][1] += slip;
                states[2][2] += slip / (body.radius + 0.07);
                states[3][3] += slip / body.half;
                for (i, part) in [0.3, 0.3, 0.0, 0.4 / body.half].into_iter().enumerate() {
                    states[4][i] += part * slip;
                }
                states
            };
            assert!(slips(0.99).iter().all(|state| rules.rolls_straight(state)));
            assert!(!slips(1.01).iter().any(|state| rules.rolls_straight(state)));
        }
        let mut smooth = model.dynamics;
        smooth.friction.mu = 0.0;
        rules.dynamics = &smooth;
        assert!(!rules.rolls_straight(&rolling));
    }
}
