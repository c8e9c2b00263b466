//! What an impact law is.

use super::contact_point::ContactPoint;
use super::impulse::Impulse;
use crate::body::{Body, Friction};
use coinmc_lanes::Lane;

/// A law of impact.
///
/// A law is an own type with its citation and the argument why it never gains energy. To add one:
/// implement this trait, add a variant to [`Law`](crate::Law) and an arm where the engine is built.
pub trait ImpactLaw: Copy + Sync {
    /// Whether the engine does impacts side by side; the results are the same one after the other.
    /// `false` suits a law whose impacts each take their own path through many cases.
    const HAS_LANES: bool = true;

    /// The impulse of an impact with coefficient of restitution `e`, 0 to 1, of a contact that does
    /// not leave (`point.approach` <= 0). It adds no energy: [`Impulse::work`] <= 0 but for
    /// rounding.
    fn impulse<L: Lane>(
        &self,
        body: &Body,
        friction: &Friction,
        point: &ContactPoint<L>,
        e: L,
    ) -> Impulse<L>;
}
