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
