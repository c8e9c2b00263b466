//! The toss: flight, impact, sustained contact, decision.

use crate::batch::Batch;
use crate::bounce::After;
use crate::contact::{Contact, Hold, Leave, Poised, Slider};
use crate::flight::fly_to_contact;
use crate::impact_law::ImpactLaw;
use crate::motion::{Motion, Units};
use crate::observer_adapter::ObserverAdapter;
use crate::settings::{Decision, Settings, SettingsError};
use crate::shape::Shape;
use crate::slide::SlideEnd;
use coinmc_core::{
    Breaks, Ended, Engine, EventKind, Face, Landing, Launch, Observer, Outcome, Scene, TossBatch,
    toss_sequential,
};
use coinmc_lanes::{Lanes, NoSuchLanes};
use std::ops::ControlFlow;

/// Follows flat tosses of one scene under one law of impact.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, Domain, Engine, Preset, Scene, Stream, Surface};
/// use coinmc_flat::{FlatEngine, Moreau, Settings};
/// let coin = Coin::cylinder(1.5, 0.01)?;
/// let scene = Scene::new(coin, Surface::new(0.5, 0.3)?, 9.81)?;
/// let engine = FlatEngine::new(&scene, &Settings::default(), Moreau)?;
/// let launch = Preset::Robot
///     .distribution()
///     .launch(&coin, &mut Stream::new(1, Domain::Launch, 0).toss(0));
/// let outcome = engine.toss(&mut (), &launch, &mut ());
/// assert!(outcome.face().is_some() && outcome.impacts > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct FlatEngine<L> {
    pub(crate) law: L,
    pub(crate) settings: Settings,
    pub(crate) units: Units,
    pub(crate) shape: Shape,
    pub(crate) mass_kg: f64,
    pub(crate) restitution: f64,
    pub(crate) friction: f64,
    pub(crate) landing: Landing,
    pub(crate) lanes: Lanes,
    /// Half the width of the narrower edge, in D: the angle scale of everything near an edge.
    pub(crate) narrow: f64,
}

/// One toss on its way.
pub(crate) struct Toss<'a> {
    pub(crate) motion: Motion,
    pub(crate) contact: Contact<'a>,
    pub(crate) impacts: u32,
    pub(crate) breaks: Breaks,
}

/// What follows a touch of the surface.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Onward {
    /// Flight.
    Fly,
    /// Contact that slides.
    Slide(Hold),
    End(Ended),
}

/// A decision by the user's stopping rule, waiting for the certain one.
pub(crate) struct Early {
    below: f64,
    face: Option<Face>,
}

impl<L: ImpactLaw> FlatEngine<L> {
    /// An engine for this scene. `settings.law` is not looked at: `law` is the law.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range.
    pub fn new(scene: &Scene, settings: &Settings, law: L) -> Result<Self, SettingsError> {
        settings.validate()?;
        let shape = Shape::new(&scene.coin);
        let (a, b) = shape.base(0, true);
        Ok(Self {
            law,
            settings: *settings,
            units: Units::new(scene),
            shape,
            mass_kg: scene.coin.mass_kg(),
            restitution: scene.surface.restitution(),
            friction: scene.surface.friction(),
            landing: scene.surface.landing(),
            lanes: best_lanes(),
            narrow: a.min(b),
        })
    }

    /// The same with these lanes instead of the fastest of this processor, for [`Engine::toss_all`].
    ///
    /// # Errors
    /// [`NoSuchLanes`] if this processor has no such instructions.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{Coin, Scene, Surface};
    /// use coinmc_flat::{FlatEngine, Lanes, Moreau, Settings};
    /// let scene = Scene::new(Coin::cylinder(1.2, 0.01)?, Surface::new(0.5, 0.3)?, 9.81)?;
    /// let engine = FlatEngine::new(&scene, &Settings::default(), Moreau)?;
    /// assert_eq!(engine.with_lanes(Lanes::Portable)?.lanes(), Lanes::Portable);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_lanes(mut self, lanes: Lanes) -> Result<Self, NoSuchLanes> {
        self.lanes = lanes.available()?;
        Ok(self)
    }

    /// The lanes of [`Engine::toss_all`].
    pub fn lanes(&self) -> Lanes {
        self.lanes
    }

    /// Runs the toss to its end.
    fn follow<O: Observer>(
        &self,
        toss: &mut Toss,
        early: &mut Early,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Ended {
        let mut departing = false;
        loop {
            if !self.fly(&mut toss.motion, departing, adapter) {
                return self.lost(&toss.motion);
            }
            if self.landing == Landing::Adhesive {
                return certain(&toss.motion);
            }
            departing = true;
            if let Some(ended) = self.bounce(toss, early, adapter) {
                return ended;
            }
        }
    }

    /// Impacts and sustained contact, which goes on from corner to corner, until the coin flies
    /// again (`None`) or the toss ends.
    fn bounce<O: Observer>(
        &self,
        toss: &mut Toss,
        early: &mut Early,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Option<Ended> {
        let mut onward = self.touch(toss, early, adapter);
        loop {
            onward = match onward {
                Onward::Fly => return None,
                Onward::End(ended) => return Some(ended),
                Onward::Slide(hold) => {
                    let mut slider = toss.contact.slider(&toss.motion, hold);
                    let end = slider.phase.follow(&mut toss.motion, adapter);
                    self.slid(toss, &slider, end, early, adapter)
                }
            };
        }
    }

    /// Impacts, and sustained contact until it slides.
    pub(crate) fn touch<O: Observer>(
        &self,
        toss: &mut Toss,
        early: &mut Early,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Onward {
        loop {
            if toss.impacts == self.settings.max_impacts {
                return Onward::End(Ended::ImpactLimit);
            }
            toss.impacts += 1;
            adapter.event(EventKind::Touching, &toss.motion);
            let touching = toss.motion;
            let after = self.impact(toss);
            adapter.passed(touching.time, toss.motion.time, |t| {
                self.resolve_until(touching, t)
            });
            adapter.event(EventKind::Impact, &toss.motion);
            early.look(&toss.motion, self.shape.k);
            let slip = match after {
                After::Decided(face) => return Onward::End(Ended::Decided(face)),
                _ if toss.contact.is_certain(&toss.motion) => {
                    return Onward::End(certain(&toss.motion));
                }
                After::Flight => return Onward::Fly,
                After::Contact(slip) => slip,
            };
            let leave = match toss
                .contact
                .poise(&mut toss.motion, Hold::new(slip), adapter)
            {
                Poised::Slides(hold) => return Onward::Slide(hold),
                Poised::Leaves(leave) => leave,
            };
            if let Some(onward) = self.leave(toss, leave, early, adapter) {
                return onward;
            }
        }
    }

    /// What follows a sliding phase.
    pub(crate) fn slid<O: Observer>(
        &self,
        toss: &mut Toss,
        slider: &Slider,
        end: SlideEnd,
        early: &mut Early,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Onward {
        let leave = match toss.contact.slid(&mut toss.motion, slider, end) {
            Err(leave) => leave,
            Ok(hold) => match toss.contact.poise(&mut toss.motion, hold, adapter) {
                Poised::Slides(hold) => return Onward::Slide(hold),
                Poised::Leaves(leave) => leave,
            },
        };
        match self.leave(toss, leave, early, adapter) {
            Some(onward) => onward,
            None => self.touch(toss, early, adapter),
        }
    }

    /// What follows sustained contact; `None`: the impact of the next corner.
    fn leave<O: Observer>(
        &self,
        toss: &Toss,
        leave: Leave,
        early: &mut Early,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Option<Onward> {
        early.look(&toss.motion, self.shape.k);
        match leave {
            Leave::NextCorner => None,
            Leave::LiftOff => {
                adapter.event(EventKind::LiftOff, &toss.motion);
                Some(Onward::Fly)
            }
            Leave::Certain => Some(Onward::End(certain(&toss.motion))),
            Leave::Balanced => Some(Onward::End(Ended::NeverSettles)),
            Leave::Lost => Some(Onward::End(self.lost(&toss.motion))),
        }
    }

    pub(crate) fn lost(&self, motion: &Motion) -> Ended {
        if motion.energy(self.shape.k).is_finite() {
            Ended::ImpactLimit
        } else {
            Ended::Failed
        }
    }

    /// Flies to the first contact; `false` if the search for it was lost.
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

/// [`Lanes::best`], but that portable lanes are no faster than one toss after the other (0.8 to 1
/// times, measured on x86-64).
fn best_lanes() -> Lanes {
    match Lanes::best() {
        Lanes::Portable => Lanes::Scalar,
        best => best,
    }
}

/// The face of the well that the coin is in.
pub(crate) fn certain(motion: &Motion) -> Ended {
    Ended::Decided(Shape::face(motion.quadrant, motion.delta))
}

impl Early {
    /// No rule but the certain one.
    pub(crate) fn never() -> Self {
        Self {
            below: f64::NEG_INFINITY,
            face: None,
        }
    }

    fn new(decision: Decision, energy: f64) -> Self {
        match decision {
            Decision::Energy => Self::never(),
            Decision::EnergyFraction(fraction) => Self {
                below: fraction * energy,
                face: None,
            },
        }
    }

    #[inline]
    fn look(&mut self, motion: &Motion, k: f64) {
        if self.below > 0.0 && self.face.is_none() && motion.energy(k) <= self.below {
            self.face = Some(Shape::face(motion.quadrant, motion.delta));
        }
    }
}

impl<L: ImpactLaw> Engine for FlatEngine<L> {
    type Workspace = ();

    fn workspace(&self) {}

    fn lanes(&self) -> Lanes {
        self.lanes
    }

    fn toss(&self, (): &mut (), launch: &Launch, observer: &mut impl Observer) -> Outcome {
        self.toss_observed(launch, observer)
    }

    fn toss_all(
        &self,
        (): &mut (),
        launches: impl Iterator<Item = Launch>,
        each: impl FnMut(u64, &Outcome) -> ControlFlow<()>,
    ) {
        match Batch::of(self) {
            Some(batch) => batch.toss_all_in_batch(launches, each),
            None => toss_sequential(self, &mut (), launches, each),
        }
    }
}

impl<L: ImpactLaw> FlatEngine<L> {
    pub(crate) fn toss_observed<O: Observer>(&self, launch: &Launch, observer: &mut O) -> Outcome {
        let mut toss = self.launched(launch);
        let energy = toss.motion.energy(self.shape.k);
        let mut early = Early::new(self.settings.decision, energy);
        let mut adapter = ObserverAdapter {
            observer,
            units: &self.units,
            shape: &self.shape,
        };
        adapter.event(EventKind::Launched, &toss.motion);
        let last = match self.ends_at_launch(&toss, launch) {
            Some(ended) => ended,
            None => self.follow(&mut toss, &mut early, &mut adapter),
        };
        adapter.event(EventKind::Ended, &toss.motion);
        let ended = early.face.map_or(last, Ended::Decided);
        Outcome {
            ended,
            overruled: ended != last,
            ..toss.outcome(last)
        }
    }

    /// The toss at its launch.
    #[inline]
    pub(crate) fn launched(&self, launch: &Launch) -> Toss<'_> {
        Toss {
            motion: Motion::new(launch, &self.units, &self.shape),
            contact: self.contact(),
            impacts: 0,
            breaks: Breaks::default(),
        }
    }

    /// Sustained contact of a toss that has had none.
    #[inline]
    pub(crate) fn contact(&self) -> Contact<'_> {
        Contact {
            shape: &self.shape,
            mu: self.friction,
            tolerance: self.settings.tolerance,
            max_steps: self.settings.max_impacts,
            steps: 0,
            jams: 0,
        }
    }

    /// How a toss ends that is not followed at all.
    #[inline]
    pub(crate) fn ends_at_launch(&self, toss: &Toss, launch: &Launch) -> Option<Ended> {
        let motion = &toss.motion;
        let energy = motion.energy(self.shape.k);
        if !(energy.is_finite() && launch.height_m.is_finite() && motion.delta.is_finite()) {
            return Some(Ended::Failed);
        }
        let decided = self.landing == Landing::Bouncing && toss.contact.is_certain(motion);
        decided.then(|| certain(motion))
    }
}

impl Toss<'_> {
    /// What came of it, if it ended so.
    pub(crate) fn outcome(&self, ended: Ended) -> Outcome {
        Outcome {
            ended,
            impacts: self.impacts,
            contact_steps: self.contact.steps,
            jams: self.contact.jams,
            overruled: false,
            breaks: self.breaks,
        }
    }
}
