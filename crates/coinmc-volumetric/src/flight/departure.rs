//! How a flight begins.

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Departure {
    /// From a launch: clear of the surface, or anywhere.
    Launched,
    /// From a bounce: the lowest point recedes, or moves along the surface apart from rounding.
    Rebound,
    /// From sustained contact or a plastic impact: the lowest point separates by its acceleration
    /// alone.
    LiftOff,
}
