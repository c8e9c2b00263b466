//! A phase of contact on one rim point, and how it ends.

use super::rim::{Mode, Rates, RimState};
use coinmc_core::Decided;

/// How sustained contact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Exit {
    /// The normal force has vanished: flight.
    LiftOff,
    /// The other rim has come down, and the tilt still changes: the coin is on its side or its conical edge, or the other
    /// rim is on the rough ground.
    OtherRim,
    /// The tilt has vanished: the opposite point of the rim has come down.
    Level,
    /// The face is decided.
    Decided(Decided),
    /// The motion repeats itself without loss.
    NeverSettles,
    /// The time limit has passed.
    TimeLimit,
    /// No step is left, or the state is NaN.
    GivenUp,
}

/// What a phase does next.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PhaseTransition {
    /// The phase goes on with another step.
    Stay,
    /// The mode no longer holds: the next phase is chosen anew.
    ChangeMode,
    /// Contact ends.
    Leave(Exit),
}

/// [`Phase::tilts`] before the first turning point.
const NO_TILTS: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// Contact on one rim point in one mode.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Phase {
    pub(crate) state: RimState<f64>,
    pub(crate) mode: Mode,
    /// Forces and rates of `state`.
    pub(crate) now: Rates<f64>,
    /// Length of the next step, before the limits that the state sets.
    pub(crate) length: f64,
    /// Turning points of the tilt so far.
    pub(super) turning_points: u32,
    /// The smallest and the largest tilt at a turning point, rad.
    pub(super) tilts: [f64; 2],
    /// Energy at the start of the phase. Truncation errors within the phase may have either sign,
    /// but the energy never exceeds this.
    pub(crate) ceiling: f64,
}

/// Where a step starts.
pub(super) struct StepStart {
    pub(super) state: RimState<f64>,
    pub(super) rates: RimState<f64>,
    pub(super) mode: Mode,
}

impl Phase {
    /// A placeholder.
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

    /// Counts a turning point of the tilt.
    pub(super) fn count_turning_point(&mut self, tilt: f64) {
        self.turning_points += 1;
        self.tilts = [self.tilts[0].min(tilt), self.tilts[1].max(tilt)];
    }

    pub(super) fn step_start(&self) -> StepStart {
        StepStart {
            state: self.state,
            rates: self.now.state,
            mode: self.mode,
        }
    }
}
