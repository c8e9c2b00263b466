//! A record of a trace.

use coinmc_core::{EventKind, State};
use nalgebra::UnitQuaternion;

/// The coin at one instant of a toss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record {
    /// Why it was recorded.
    pub kind: RecordKind,
    /// How the coin moves from this record on.
    pub mode: Mode,
    /// State of the coin, from the engine.
    pub state: State,
    /// Rotation from the body frame, whose z axis is u, to the laboratory frame. The rotation about
    /// u does not influence the toss and is computed separately; see docs/guide/traces.md.
    pub orientation: UnitQuaternion<f64>,
    /// Mechanical energy per unit mass, J/kg, with the potential zero at the surface.
    pub energy_j_kg: f64,
}

/// Why a record was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RecordKind {
    /// An event happened.
    Event(EventKind),
    /// A sample at a time that the observer requested.
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
    /// Without contact.
    Flight,
    /// In sustained contact, with the contact point at rest.
    Sticking,
    /// In sustained contact, with the contact point sliding.
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
