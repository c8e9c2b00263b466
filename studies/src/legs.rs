//! The flights of a toss, from its events.

use coinmc_core::{Event, EventKind, State};

/// Pairs the state that a flight begins with and the one that it ends with.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Legs {
    start: Option<State>,
}

impl Legs {
    /// Takes an event; the two ends of the flight that it ends.
    pub(crate) fn see(&mut self, event: &Event) -> Option<(State, State)> {
        match event.kind {
            EventKind::Launched | EventKind::Impact | EventKind::LiftOff => {
                self.start = Some(event.state);
                None
            }
            EventKind::Touching => self.start.take().map(|start| (start, event.state)),
            EventKind::Sticking | EventKind::Sliding | EventKind::Ended => {
                self.start = None;
                None
            }
        }
    }
}
