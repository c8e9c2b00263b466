//! What a toss does next.

use crate::flight::Departure;
use coinmc_core::Ended;

/// What follows an impact or sustained contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Transition {
    Flight(Departure),
    /// Impact of the lowest point.
    Impact,
    /// Sustained contact of the lowest point.
    Contact,
    /// Sustained contact of the lowest point on rough ground, with the other rim near it.
    NearGround,
    End(Ended),
}
