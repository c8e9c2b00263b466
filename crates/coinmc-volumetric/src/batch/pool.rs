//! All tosses in flight: their slots, and the queues between the stages.

use super::contact_stage::ContactStage;
use super::departures::Departures;
use super::flights::Flights;
use super::impact_stage::ImpactStage;
use crate::contact::{Mode, Phase, TiltSearch, Usage};
use crate::flight::Departure;
use crate::toss::Toss;

/// Tosses in flight: enough that a stage nearly always finds eight. From 64 to 256 the speed is the
/// same within 5 %.
pub(super) const SLOTS: usize = 128;

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
    fn empty() -> Self {
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

/// Queues hold the numbers of slots.
pub(super) struct Pool {
    pub(super) slots: Vec<Slot>,
    pub(super) free: Vec<usize>,
    /// Tosses that are about to fly.
    pub(super) departing: Vec<usize>,
    pub(super) flights: Flights,
    /// Landed tosses whose impact must be computed again: it was not the last bounce.
    pub(super) retrying: Vec<usize>,
    pub(super) stick_stage: ContactStage,
    pub(super) slip_stage: ContactStage,
    /// Tosses in contact that wait for a lane of one of these stages.
    pub(super) sticking: Vec<usize>,
    pub(super) slipping: Vec<usize>,
    /// Working memory.
    pub(super) departures: Departures,
    pub(super) impact_stage: ImpactStage,
}

impl Pool {
    pub(super) fn new() -> Self {
        Self {
            slots: vec![Slot::empty(); SLOTS],
            free: (0..SLOTS).rev().collect(),
            departing: Vec::with_capacity(SLOTS),
            flights: Flights::none(),
            retrying: Vec::with_capacity(SLOTS),
            stick_stage: ContactStage::new(),
            slip_stage: ContactStage::new(),
            sticking: Vec::with_capacity(SLOTS),
            slipping: Vec::with_capacity(SLOTS),
            departures: Departures::default(),
            impact_stage: ImpactStage::default(),
        }
    }

    /// Queues a toss for its next try at a step of contact.
    pub(super) fn queue_contact(&mut self, slot: usize) {
        match self.slots[slot].phase.mode {
            Mode::Stick => self.sticking.push(slot),
            Mode::Slip => self.slipping.push(slot),
        }
    }

    /// The stage of a mode of contact, the queue before it, and the slots.
    pub(super) fn contact_stage(
        &mut self,
        mode: Mode,
    ) -> (&mut ContactStage, &mut Vec<usize>, &mut Vec<Slot>) {
        match mode {
            Mode::Slip => (&mut self.slip_stage, &mut self.slipping, &mut self.slots),
            Mode::Stick => (&mut self.stick_stage, &mut self.sticking, &mut self.slots),
        }
    }
}
