//! The scalar driver: one toss from its launch to its end, with an observer.

use crate::decision::EarlyDecision;
use crate::flight::fly_to_contact;
use crate::impact_law::ImpactLaw;
use crate::motion::Motion;
use crate::observer_adapter::ObserverAdapter;
use crate::parameters::Parameters;
use crate::toss::Toss;
use crate::transition::Transition;
use coinmc_core::{Ended, EventKind, Launch, Observer, Outcome};

impl<L: ImpactLaw> Parameters<L> {
    /// The outcome of one toss.
    pub(crate) fn toss<O: Observer>(&self, launch: &Launch, observer: &mut O) -> Outcome {
        let mut toss = self.launched(launch);
        let energy = toss.motion.energy(self.shape.k);
        let mut early = EarlyDecision::new(self.settings.decision, energy);
        let mut adapter = self.adapter(observer);
        adapter.event(EventKind::Launched, &toss.motion);
        let last = match self.ends_at_launch(&toss.motion, launch) {
            Some(ended) => ended,
            None => self.run(&mut toss, &mut early, &mut adapter),
        };
        adapter.event(EventKind::Ended, &toss.motion);
        let ended = early.face().map_or(last, Ended::Decided);
        Outcome {
            ended,
            overruled: ended != last,
            ..toss.counters.outcome(last)
        }
    }

    /// Flies and bounces until the toss ends.
    fn run<O: Observer>(
        &self,
        toss: &mut Toss,
        early: &mut EarlyDecision,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Ended {
        let mut departing = false;
        loop {
            if !self.fly(&mut toss.motion, departing, adapter) {
                return self.out_of_steps(&toss.motion);
            }
            if let Some(ended) = self.adhesive_end(&toss.motion) {
                return ended;
            }
            departing = true;
            if let Some(ended) = self.bounce(toss, early, adapter) {
                return ended;
            }
        }
    }

    /// Impacts and sustained contact, from corner to corner, until the coin flies again (`None`) or
    /// the toss ends.
    fn bounce<O: Observer>(
        &self,
        toss: &mut Toss,
        early: &mut EarlyDecision,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Option<Ended> {
        let mut transition = self.after_touch(toss, early, adapter);
        loop {
            transition = match transition {
                Transition::Fly => return None,
                Transition::End(ended) => return Some(ended),
                Transition::Slide(state) => {
                    let mut sliding = self.contact.slide(&toss.motion, &toss.counters, state);
                    let end = sliding.phase.run(&mut toss.motion, adapter);
                    self.after_sliding(toss, &sliding, end, early, adapter)
                }
            };
        }
    }

    /// Flies to the first contact; `false` if the search for it ran out of steps.
    #[inline]
    fn fly<O: Observer>(
        &self,
        motion: &mut Motion,
        departing: bool,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> bool {
        let start = *motion;
        let found = fly_to_contact(motion, &self.shape, departing);
        adapter.passed(start.time, motion.time, |t| {
            let mut motion = start;
            motion.fly(&self.shape, t);
            motion
        });
        found
    }
}
