//! All tosses in flight: their slots, the stages, and the queues between them.

use super::contact_stage::ContactStage;
use super::departures::Departures;
use super::flights::Flights;
use super::impact_stage::ImpactStage;
use super::slot::Slot;
use crate::contact::Mode;

/// Tosses in flight: enough that a stage nearly always finds eight. From 64 to 256 the speed is the
/// same within 5 %.
pub(super) const SLOTS: usize = 128;

/// All slots, the stages, and the queues between them. Queues hold numbers of slots.
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
