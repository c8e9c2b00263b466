//! One line of a trace.

use coinmc_core::{EventKind, State};
use nalgebra::UnitQuaternion;

/// The coin at one instant of a toss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record {
    /// Why it was recorded.
    pub kind: RecordKind,
    /// How the coin moves from here.
    pub mode: Mode,
    /// The coin, as the engine has it.
    pub state: State,
    /// Turns the body's axes to the laboratory's; the body's z is u. The rotation about u does not
    /// influence the toss; it is computed for pictures, see docs/guide/traces.md.
    pub orientation: UnitQuaternion<f64>,
    /// Mechanical energy per unit mass, J/kg, with the potential zero at the surface.
    pub energy_j_kg: f64,
}

/// Why a record was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RecordKind {
    /// Something happened.
    Event(EventKind),
    /// The observer asked for this time.
    Sample,
}

impl RecordKind {
    /// The name used in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Event(EventKind::Launched) => "launched",
            Self::Event(EventKind::Touching) => "touching",
            Self::Event(EventKind::Impact) => "impact",
            Self::Event(EventKind::Sticking) => "sticking",
            Self::Event(EventKind::Sliding) => "sliding",
            Self::Event(EventKind::LiftOff) => "lift_off",
            Self::Event(EventKind::Ended) => "ended",
            Self::Sample => "sample",
        }
    }
}

/// How the coin moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// It touches nothing.
    Flight,
    /// In sustained contact, the contact point stands still.
    Sticking,
    /// In sustained contact, the contact point slides.
    Sliding,
    /// The toss is over.
    Ended,
}

impl Mode {
    /// All modes, in the order of their codes in files.
    pub const ALL: [Self; 4] = [Self::Flight, Self::Sticking, Self::Sliding, Self::Ended];

    /// The name used in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flight => "flight",
            Self::Sticking => "sticking",
            Self::Sliding => "sliding",
            Self::Ended => "ended",
        }
    }
}
