//! Sustained contact: on one rim point, and on the side.
//!
//! # The state machine of a rim point
//! A toss in contact on one rim point is in a [`Phase`], in one of two modes: it sticks or it slips
//! ([`Mode`]). A phase is integrated step by step. The state at the start of a step and the step
//! itself lead to a [`PhaseTransition`]: stay in the phase, change the mode, or leave contact by an
//! [`Exit`].
//!
//! ```text
//!               ┌── friction cannot hold the point ──▶
//!    STICKING ──┤                                      SLIPPING ──┐ jam (Painlevé): a tangential
//!               ◀── slip vanishes, friction holds it ──┘    ◀─────┘ impulse changes the slip
//!
//!    either ── the normal force vanishes ─────▶ Exit::LiftOff      ▶ flight
//!    either ── the other rim touches ─────────▶ Exit::OtherRim     ▶ impact of that rim
//!    either ── the tilt vanishes ─────────────▶ Exit::Level        ▶ impact of the opposite point
//!    either ── the face is decided ───────────▶ Exit::Decided      ▶ end
//!    either ── the motion repeats itself ─────▶ Exit::NeverSettles ▶ end
//!    either ── a limit is reached ────────────▶ Exit::TimeLimit, Exit::GivenUp ▶ end
//! ```
//!
//! | function | from | to |
//! |---|---|---|
//! | `enter` | a motion | its first phase |
//! | `exit_now` | a phase before a step | an exit, if decided or at a limit |
//! | `immediate_transition` | a phase before a step | a transition that takes no time, if any |
//! | `exit_before_step` | a phase | an exit, or the start of its next step (by the two above) |
//! | `try_step` | the start of a step | its end, which may be rejected as inaccurate |
//! | `accept` | an accurate step | its end or its first event, and the transition there |
//! | `apply` | a transition | the same phase, the next phase, or the exit |
//! | `change_mode` | a phase whose mode no longer holds | the next phase |
//!
//! The scalar path (`follow`) and the batch both drive this machine.
//!
//! # Modules
//! - `dynamics` constants and friction moments · `held_friction` friction that holds at rest · `rim` equations of motion · `state` from motion to
//!   state and back · `integrator` Runge–Kutta step
//! - `rules` what governs contact · `phase` phase and exits · `step` one try of a step, of one toss
//!   or several; `scalar_step` the same of one
//! - `solver` the state machine · `tilt_search`, `margin_search`, `events` where in a step an event
//!   lies
//! - `follow` the scalar path · `tilted` the same on a tilted table
//! - `line`, `rolling_stop`, `on_side` the coin on its side

mod dynamics;
mod events;
mod follow;
mod held_friction;
mod integrator;
mod line;
mod margin_search;
mod on_side;
mod phase;
mod rim;
mod rolling_stop;
mod rules;
mod scalar_step;
mod solver;
mod state;
mod step;
mod tilt_search;
mod tilted;

pub(crate) use dynamics::{Dynamics, fastest_rate};
pub(crate) use integrator::{Trial, is_accepted, next_length, shorter, step};
pub(crate) use line::{LineState, line_rates_on};
pub(crate) use on_side::SideExit;
pub(crate) use phase::{Exit, Phase, PhaseTransition};
pub(crate) use rim::{Mode, OMEGA_Y, Rates, RimState, SLIP_X, SLIP_Y, TILT};
pub(crate) use rolling_stop::{RollingStop, way_to_rest};
pub(crate) use rules::{ContactRules, Usage};
pub(crate) use scalar_step::ScalarStep;
pub(crate) use solver::{ContactSolver, RESTART_SLIP};
pub(crate) use state::{place, place_unfolded, rim_state};
pub(crate) use step::{LEAST_JAM_MARGIN, StepTrial, can_stick, holds, slip_speed, step_limit};
pub(crate) use tilt_search::TiltSearch;

#[cfg(test)]
mod tests;
