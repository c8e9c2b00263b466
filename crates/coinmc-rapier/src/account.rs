//! The account of a toss: its outcome and what the steps did.

use coinmc_core::Outcome;

/// Why a toss failed: the errors a time-stepping engine can make. Such tosses end as
/// [`coinmc_core::Ended::Failed`]; they are counted but have no face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flaw {
    /// The centre went below the surface.
    Tunnelled,
    /// When the face was decided, the coin was too deep in the surface to tell which it was.
    Sunk,
    /// The energy rose above its value at launch by more than [`crate::Settings::max_gain`] of it.
    Exploded,
    /// A value is NaN or infinite, at launch or later.
    NotFinite,
}

/// The account of a toss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Account {
    /// How it ended.
    pub outcome: Outcome,
    /// Why it failed, if it did.
    pub flaw: Option<Flaw>,
    /// Steps that Rapier made.
    pub steps: u32,
    /// Pieces of the motion that were computed in closed form instead of in steps.
    pub jumps: u32,
    /// The largest excess of the energy over its value at launch, as a fraction of that; 0 or less
    /// if it never exceeded it.
    pub energy_gain: f64,
    /// The largest depth of a point of the coin below the surface, in D.
    pub depth: f64,
}
