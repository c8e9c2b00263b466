//! What an impact law is.

use super::contact_point::ContactPoint;
use super::impulse::Impulse;
use crate::body::{Body, Friction};
use coinmc_lanes::Lane;

/// An impact law.
///
/// Each law is a type of its own, documented with its citation and the argument why it never gains
/// energy. `docs/developer/add-a-law.md` shows how to add one.
pub trait ImpactLaw: Copy + Sync {
    /// Whether a batch computes impacts in lanes. The results are bit-identical either way. `false`
    /// suits a law whose impacts take different paths through many cases.
    const HAS_LANES: bool = true;

    /// The impulse of an impact with coefficient of restitution `e`, 0 to 1, at a contact point
    /// that does not recede (`point.approach` <= 0). It adds no energy: [`Impulse::work`] <= 0 but
    /// for rounding.
    fn impulse<L: Lane>(
        &self,
        body: &Body,
        friction: &Friction,
        point: &ContactPoint<L>,
        e: L,
    ) -> Impulse<L>;
}
