//! What a toss does after it has touched the surface: both drivers, `scalar` and `batch`, ask here.

use crate::contact::{ContactEnd, ContactState, ContactStep, SlidingContact};
use crate::counters::Counters;
use crate::decision::{EarlyDecision, decided};
use crate::impact::AfterImpact;
use crate::impact_law::ImpactLaw;
use crate::motion::Motion;
use crate::observer_adapter::ObserverAdapter;
use crate::parameters::Parameters;
use crate::slide::SlideEnd;
use crate::toss::Toss;
use coinmc_core::{Ended, EventKind, Landing, Observer};

/// What a toss does next.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Transition {
    Fly,
    /// The lowest corner slides.
    Slide(ContactState),
    End(Ended),
}

impl<L: ImpactLaw> Parameters<L> {
    /// Counts an impact.
    ///
    /// # Errors
    /// The end of the toss, if it has reached the limit of impacts.
    #[inline]
    pub(crate) fn count_impact(&self, counters: &mut Counters) -> Result<(), Ended> {
        if counters.impacts == self.settings.max_impacts {
            return Err(Ended::ImpactLimit);
        }
        counters.impacts += 1;
        Ok(())
    }

    /// On an adhesive surface the first touch ends the toss, with this motion.
    #[inline]
    pub(crate) fn adhesive_end(&self, motion: &Motion) -> Option<Ended> {
        (self.landing == Landing::Adhesive).then(|| decided(motion))
    }

    /// The end of a toss whose flight or contact has run out of steps.
    pub(crate) fn out_of_steps(&self, motion: &Motion) -> Ended {
        if motion.energy(self.shape.k).is_finite() {
            Ended::ImpactLimit
        } else {
            Ended::Failed
        }
    }

    /// The lowest corner touches: impacts and sustained contact, from corner to corner, until the
    /// coin flies or slides or the toss ends.
    pub(crate) fn after_touch<O: Observer>(
        &self,
        toss: &mut Toss,
        early: &mut EarlyDecision,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Transition {
        loop {
            if let Err(ended) = self.count_impact(&mut toss.counters) {
                return Transition::End(ended);
            }
            let slip = match self.observed_impact(toss, early, adapter) {
                AfterImpact::Decided(face) => return Transition::End(Ended::Decided(face)),
                _ if self.contact.is_decided(&toss.motion) => {
                    return Transition::End(decided(&toss.motion));
                }
                AfterImpact::Flight => return Transition::Fly,
                AfterImpact::Contact { slip } => slip,
            };
            let state = ContactState::new(slip);
            if let Some(transition) = self.sustained_contact(toss, state, early, adapter) {
                return transition;
            }
        }
    }

    /// A sliding phase has ended: sustained contact and impacts, until the coin flies or slides or
    /// the toss ends.
    pub(crate) fn after_sliding<O: Observer>(
        &self,
        toss: &mut Toss,
        sliding: &SlidingContact,
        end: SlideEnd,
        early: &mut EarlyDecision,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Transition {
        let Toss { motion, counters } = toss;
        let transition = match self.contact.after_sliding(motion, counters, sliding, end) {
            Err(end) => self.after_contact(toss, end, early, adapter),
            Ok(state) => self.sustained_contact(toss, state, early, adapter),
        };
        transition.unwrap_or_else(|| self.after_touch(toss, early, adapter))
    }

    /// One impact, with its events.
    fn observed_impact<O: Observer>(
        &self,
        toss: &mut Toss,
        early: &mut EarlyDecision,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> AfterImpact {
        adapter.event(EventKind::Touching, &toss.motion);
        let touching = toss.motion;
        let after = self.impact(toss);
        adapter.passed(touching.time, toss.motion.time, |t| {
            self.motion_within_impact(touching, t)
        });
        adapter.event(EventKind::Impact, &toss.motion);
        early.check(&toss.motion, self.shape.k);
        after
    }

    /// What follows sustained contact that begins in this state; `None`: the impact of the next
    /// corner.
    fn sustained_contact<O: Observer>(
        &self,
        toss: &mut Toss,
        state: ContactState,
        early: &mut EarlyDecision,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Option<Transition> {
        let Toss { motion, counters } = toss;
        match self.contact.advance(motion, counters, state, adapter) {
            ContactStep::Slide(state) => Some(Transition::Slide(state)),
            ContactStep::End(end) => self.after_contact(toss, end, early, adapter),
        }
    }

    /// What follows the end of sustained contact; `None`: the impact of the next corner.
    fn after_contact<O: Observer>(
        &self,
        toss: &Toss,
        end: ContactEnd,
        early: &mut EarlyDecision,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Option<Transition> {
        early.check(&toss.motion, self.shape.k);
        match end {
            ContactEnd::NextCorner => None,
            ContactEnd::LiftOff => {
                adapter.event(EventKind::LiftOff, &toss.motion);
                Some(Transition::Fly)
            }
            ContactEnd::Decided => Some(Transition::End(decided(&toss.motion))),
            ContactEnd::Balanced => Some(Transition::End(Ended::NeverSettles)),
            ContactEnd::OutOfSteps => Some(Transition::End(self.out_of_steps(&toss.motion))),
        }
    }
}
