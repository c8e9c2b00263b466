//! Sustained contact: on one rim point, and on the side.
//!
//! # The state machine of a rim point
//! A toss in contact on one rim point is in a [`Phase`]: it sticks or it slips ([`Mode`]). A phase is
//! integrated step by step. Each step, or the mere state at the start of one, leads to a
//! [`PhaseTransition`]: stay in the phase, change the mode, or leave contact by an [`Exit`].
//!
//! ```text
//! motion ── enter ──▶ phase in the mode that it can be in
//!
//!              ┌──── friction needed exceeds the cone ────▶┐
//!      STICKING                                            SLIPPING ◀─┐ jam (Painlevé):
//!              └◀─ slip below stick_speed, and can stick ──┘ └────────┘ tangential impact
//!
//! either ── exit_now ──────────────▶ Decided, TimeLimit, GivenUp (step limit)
//! either ── immediate_transition ──▶ Level, LiftOff; change of mode after a jam
//! either ── try_step, accept ──────▶ stay; change of mode; Exit:
//!           normal force vanishes       LiftOff     ▶ flight
//!           the other rim touches       OtherRim    ▶ impact there
//!           the tilt vanishes           Level       ▶ impact of the opposite rim point
//!           motion repeats for ever     Decided or NeverSettles
//! ```
//!
//! | function | from | to |
//! |---|---|---|
//! | `enter` | a motion | its first phase |
//! | `change_mode` | a phase that no longer holds | the next phase |
//! | `exit_now` | a phase before a step | an exit, if the face is decided or a limit is reached |
//! | `immediate_transition` | a phase before a step | a transition that takes no time, if there is one |
//! | `exit_before_step` | a phase | where its next step starts, or an exit |
//! | `try_step` | the start of a step | its end, which may be rejected |
//! | `accept` | an accepted step | its end, or the first event within it |
//! | `apply` | a transition | the phase after it, or the exit |
//!
//! The scalar path ([`ContactSolver::follow`]) and the batch drive this machine; they share all of
//! its functions.
//!
//! # Modules
//! `dynamics` constants and friction moments · `rim` equations of motion · `state` from motion to
//! state and back · `integrator` Runge–Kutta step · `step` one try of a step · `phase` phase, mode,
//! exits · `solver` the state machine · `tilt_search`, `margin_search` and `events` where in a step
//! something happens · `follow` the scalar path · `line`, `on_side`, `rolling_stop` the coin on its
//! side.

mod dynamics;
mod events;
mod follow;
mod integrator;
mod line;
mod margin_search;
mod on_side;
mod phase;
mod rim;
mod rolling_stop;
mod solver;
mod state;
mod step;
mod tilt_search;

pub(crate) use dynamics::{Dynamics, fastest_rate};
pub(crate) use integrator::Trial;
pub(crate) use on_side::SideExit;
pub(crate) use phase::{Exit, Phase, PhaseTransition};
pub(crate) use rim::{Mode, Rates};
pub(crate) use solver::{ContactRules, ContactSolver, Usage};
pub(crate) use state::place;
pub(crate) use step::StepTrial;
pub(crate) use tilt_search::TiltSearch;

#[cfg(test)]
mod tests;
