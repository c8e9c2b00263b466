//! What a toss came to, beyond its outcome.

use coinmc_core::Outcome;

/// What a time-stepping engine may do to a coin. Such tosses end as
/// [`coinmc_core::Ended::Failed`]: counted, never classified.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flaw {
    /// The centre went below the surface.
    Tunnelled,
    /// The face was settled while the coin was sunk too deep in the surface to say which.
    Sunk,
    /// The energy rose above its value at launch by more than [`crate::Settings::max_gain`] of it.
    Exploded,
    /// A number is not finite, at launch or later.
    NotFinite,
}

/// What a toss came to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Account {
    /// How it ended.
    pub outcome: Outcome,
    /// Why it failed, if it did.
    pub flaw: Option<Flaw>,
    /// Steps that Rapier made.
    pub steps: u32,
    /// Flights, or parts of them, that were computed in closed form.
    pub jumps: u32,
    /// The most by which the energy was above its value at launch, as a fraction of that; 0 or less
    /// if it never was.
    pub energy_gain: f64,
    /// The deepest that a point of the coin was below the surface, in D.
    pub depth: f64,
}
