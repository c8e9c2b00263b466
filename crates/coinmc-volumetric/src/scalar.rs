//! The scalar path: one toss from launch to end. The batch reproduces it bit for bit.

use crate::contact::{ContactSolver, Usage};
use crate::finished_toss::FinishedToss;
use crate::flight::Departure;
use crate::impact::ImpactLaw;
use crate::model::Model;
use crate::toss::Toss;
use crate::transition::Transition;
use coinmc_core::{Ended, EventKind, Launch, Observer};

impl<L: ImpactLaw> Model<L> {
    /// Simulates one toss.
    pub(crate) fn run<O: Observer>(&self, launch: &Launch, observer: &mut O) -> FinishedToss {
        self.run_from(self.launch(launch), launch, observer)
    }

    /// Simulates the toss that begins like this.
    pub(crate) fn run_from<O: Observer>(
        &self,
        mut toss: Toss,
        launch: &Launch,
        observer: &mut O,
    ) -> FinishedToss {
        let mut solver = self.contact_solver(Usage::default());
        self.notify(&toss, EventKind::Launched, observer);
        let ended = match self.end_at_launch(&toss, launch) {
            Some(ended) => ended,
            None => self.follow(&mut toss, &mut solver, observer),
        };
        self.notify(&toss, EventKind::Ended, observer);
        FinishedToss::new(self, ended, &toss, &solver.usage)
    }

    /// Alternates flight and contact with the surface until the toss ends.
    fn follow<O: Observer>(
        &self,
        toss: &mut Toss,
        solver: &mut ContactSolver<'_>,
        observer: &mut O,
    ) -> Ended {
        let mut departure = Departure::Launched;
        loop {
            let gave_up = !self.fly(toss, &mut solver.usage, departure, observer);
            if gave_up || (O::ACTIVE && observer.has_seen_enough()) {
                return self.end_given_up(toss);
            }
            if let Some(ended) = self.end_at_landing(toss, solver.usage.time) {
                return ended;
            }
            match self.on_surface(toss, solver, observer) {
                Ok(next) => departure = next,
                Err(ended) => return ended,
            }
        }
    }

    /// Impacts and sustained contact until the coin departs again, or the toss ends.
    fn on_surface<O: Observer>(
        &self,
        toss: &mut Toss,
        solver: &mut ContactSolver<'_>,
        observer: &mut O,
    ) -> Result<Departure, Ended> {
        toss.rim_changes = 0;
        loop {
            let mut next = self.impact(toss, solver, observer);
            loop {
                next = match next {
                    Transition::Contact => self.follow_contact(toss, solver, observer),
                    Transition::NearGround => self.near_ground(toss, solver, observer),
                    Transition::Flight(departure) => return Ok(departure),
                    Transition::Impact => break,
                    Transition::End(ended) => return Err(ended),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toss::tests::{launch, model};
    use coinmc_core::Event;
    use coinmc_testkit::Dice;

    /// Notes what happens, and looks no farther than `most` events.
    struct Looks {
        most: usize,
        seen: Vec<EventKind>,
    }

    impl Observer for Looks {
        fn event(&mut self, event: &Event) {
            self.seen.push(event.kind);
        }

        fn has_seen_enough(&self) -> bool {
            self.seen.len() >= self.most
        }
    }

    /// A toss is followed on from a flight only as long as its observer looks.
    #[test]
    fn a_toss_ends_after_the_flight_in_which_its_observer_has_seen_enough() {
        let model = model();
        let launch = launch(&mut Dice::new(557, 0), None);
        let seen = |most| {
            let mut looks = Looks {
                most,
                seen: Vec::new(),
            };
            model.run(&launch, &mut looks);
            looks.seen
        };
        let (all, flight) = (seen(usize::MAX), seen(1));
        assert_eq!(flight, [EventKind::Launched, EventKind::Ended]);
        assert!(all.len() > 4 && all.contains(&EventKind::Impact), "{all:?}");
    }
}
