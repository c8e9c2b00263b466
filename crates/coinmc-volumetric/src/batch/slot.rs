//! The memory of one toss in flight.

use crate::contact::{Phase, TiltSearch, Usage};
use crate::flight::Departure;
use crate::toss::Toss;

/// The memory of one toss. What its flights and impacts need comes first, in one cache line.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Slot {
    pub(super) usage: Usage,
    /// The number of the launch.
    pub(super) number: u64,
    /// How the next flight begins.
    pub(super) departure: Departure,
    pub(super) toss: Toss,
    pub(super) phase: Phase,
    /// The search for the end of contact, while it is under way.
    pub(super) tilt_search: Option<TiltSearch>,
}

impl Slot {
    pub(super) fn empty() -> Self {
        Self {
            usage: Usage::default(),
            number: 0,
            departure: Departure::Launched,
            toss: Toss::still(),
            phase: Phase::none(),
            tilt_search: None,
        }
    }

    /// Reuses the slot for a new toss. (`phase` is set when contact begins.)
    #[inline]
    pub(super) fn reset(&mut self, number: u64, toss: Toss) {
        (self.number, self.toss) = (number, toss);
        self.usage = Usage::default();
        self.departure = Departure::Launched;
        self.tilt_search = None;
    }
}
