//! The toss: flight, impact, sustained contact, decision.

use crate::batch::Batch;
use crate::body::{Body, Friction, Units};
use crate::contact::{self, Contact, Leave, Spent};
use crate::flight::{Departure, Drag};
use crate::impact::ImpactLaw;
use crate::rest;
use crate::settings::{Decision, Settings, SettingsError};
use crate::toss::Toss;
use coinmc_core::{
    Breaks, Decided, DecisionRule, Ended, Engine, Event, EventKind, Landing, Launch, Observer,
    Outcome, Scene, TossBatch, toss_sequential,
};
use coinmc_lanes::{Lanes, NoSuchLanes};
use std::ops::ControlFlow;

/// Follows tosses of one scene under one law of impact.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, Domain, Engine, Preset, Scene, Stream, Surface};
/// use coinmc_volumetric::{Moreau, Settings, VolumetricEngine};
/// let coin = Coin::cylinder(0.85, 0.01)?;
/// let surface = Surface::new(0.5, 0.3)?.with_friction_lengths(1e-4, 1e-4)?;
/// let scene = Scene::new(coin, surface, 9.81)?;
/// let engine = VolumetricEngine::new(&scene, &Settings::default(), Moreau)?;
/// let launch = Preset::Clean
///     .distribution()
///     .launch(&coin, &mut Stream::new(1, Domain::Launch, 0).toss(0));
/// let outcome = engine.toss(&mut (), &launch, &mut ());
/// assert!(outcome.face().is_some() && outcome.impacts > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct VolumetricEngine<L> {
    pub(crate) impact: L,
    pub(crate) settings: Settings,
    pub(crate) units: Units,
    pub(crate) contact: contact::Law,
    pub(crate) rule: DecisionRule,
    /// [`Settings::tolerance`], in sqrt(g D).
    pub(crate) tolerance: f64,
    pub(crate) restitution: f64,
    /// Approach below which e = 0, in sqrt(g D).
    pub(crate) threshold: f64,
    pub(crate) landing: Landing,
    pub(crate) lanes: Lanes,
    /// Nothing is ever lost.
    conserves: bool,
}

/// What follows an impact or sustained contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Onward {
    /// Flight; `true` if the contact point parts by its acceleration alone.
    Fly(bool),
    /// Impact of the lowest point.
    Strike,
    /// Sustained contact of the lowest point.
    Sustain,
    End(Ended),
}

/// The integrator's rounding: no step can be asked to err less.
const LEAST_TOLERANCE: f64 = 1e-13;
/// Impacts of one rim and the other in turn, without flight, after which the coin lies on its side.
const ALTERNATIONS: u32 = 100;

impl<L: ImpactLaw> VolumetricEngine<L> {
    /// An engine for this scene. `settings.law` is not looked at: `law` is the law.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range.
    pub fn new(scene: &Scene, settings: &Settings, law: L) -> Result<Self, SettingsError> {
        settings.validate()?;
        let units = Units::new(scene);
        let body = Body::new(&scene.coin);
        let friction = Friction::new(scene);
        let drag = Drag {
            linear: scene.drag().linear_per_s() * units.time_s,
            angular: scene.drag().angular_per_s() * units.time_s,
        };
        let axial_factor = body.axial_factor(scene.has_gyroscopic_torque());
        let tilting = settings.decision == Decision::Tilting;
        let rule = DecisionRule::new(scene, tilting, rest::ROCKING * settings.zeno);
        let restitution = scene.surface.restitution();
        let threshold = scene.surface.restitution_threshold_m_s() / units.speed_m_s();
        Ok(Self {
            impact: law,
            settings: *settings,
            units,
            contact: contact::Law::new(body, friction, drag, axial_factor, settings.smoothing_time),
            rule,
            tolerance: (settings.tolerance * body.escape_speed()).max(LEAST_TOLERANCE),
            restitution,
            threshold,
            landing: scene.surface.landing(),
            lanes: Lanes::best(),
            conserves: rule.loses_nothing(restitution) && threshold == 0.0,
        })
    }

    /// The same with these lanes instead of [`Lanes::best`], for [`Engine::toss_all`].
    ///
    /// # Errors
    /// [`NoSuchLanes`] if this processor has no such instructions.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{Coin, Scene, Surface};
    /// use coinmc_volumetric::{Lanes, Moreau, Settings, VolumetricEngine};
    /// let scene = Scene::new(Coin::cylinder(0.85, 0.01)?, Surface::new(0.5, 0.3)?, 9.81)?;
    /// let engine = VolumetricEngine::new(&scene, &Settings::default(), Moreau)?;
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
        contact: &mut Contact<'_>,
        observer: &mut O,
    ) -> Ended {
        let mut departure = Departure::Launched;
        let mut parting = false;
        loop {
            if !self.fly(toss, contact, departure, parting, observer) {
                return self.lost(toss);
            }
            if contact.spent.time > self.settings.time_limit {
                return Ended::TimeLimit;
            }
            if self.landing == Landing::Adhesive {
                return self.stuck(toss);
            }
            departure = Departure::Leaving;
            match self.bounce(toss, contact, observer) {
                Ok(by_acceleration) => parting = by_acceleration,
                Err(ended) => return ended,
            }
        }
    }

    /// Where a surface lets go of nothing.
    pub(crate) fn stuck(&self, toss: &Toss) -> Ended {
        toss.ended(self.rule.well(toss.motion.cos))
    }

    /// Impacts and sustained contact until the coin flies again (`Ok`) or the toss ends.
    fn bounce<O: Observer>(
        &self,
        toss: &mut Toss,
        contact: &mut Contact<'_>,
        observer: &mut O,
    ) -> Result<bool, Ended> {
        toss.in_turn = 0;
        loop {
            let mut onward = self.impact(toss, contact, observer);
            if onward == Onward::Sustain {
                onward = self.sustain(toss, contact, observer);
            }
            match onward {
                Onward::Fly(parting) => return Ok(parting),
                Onward::Strike | Onward::Sustain => {}
                Onward::End(ended) => return Err(ended),
            }
        }
    }

    /// One impact of the lowest point.
    pub(crate) fn impact<O: Observer>(
        &self,
        toss: &mut Toss,
        contact: &mut Contact<'_>,
        observer: &mut O,
    ) -> Onward {
        if toss.impacts == self.settings.max_impacts {
            return Onward::End(Ended::ImpactLimit);
        }
        toss.impacts += 1;
        toss.level(self.contact.axial_factor);
        self.notify(toss, EventKind::Touching, observer);
        let mut struck = self.strike(&toss.motion, &toss.spin, true);
        if struck.again {
            struck = self.strike(&toss.motion, &toss.spin, false);
        }
        (toss.motion, toss.spin) = (struck.motion, struck.spin);
        self.notify(toss, EventKind::Impact, observer);
        let decided = self.decide(toss);
        if decided != Decided::Open {
            return Onward::End(toss.ended(decided));
        }
        let after = if struck.sustains {
            Onward::Sustain
        } else {
            Onward::Fly(struck.parts)
        };
        self.after_impact(toss, after, contact, observer)
    }

    /// What follows an impact that leaves the face open: `after`, unless the coin comes to lie, to
    /// stand, or comes down elsewhere at once.
    #[inline]
    pub(crate) fn after_impact<O: Observer>(
        &self,
        toss: &mut Toss,
        after: Onward,
        contact: &mut Contact<'_>,
        observer: &mut O,
    ) -> Onward {
        if self.rocks_out(toss) || toss.in_turn > ALTERNATIONS {
            toss.in_turn = 0;
            self.lie(toss, contact, observer)
        } else if self.stands(toss) {
            toss.in_turn = 0;
            self.trip(toss)
        } else if self.other_rim_approaches(toss) {
            toss.change_rim();
            toss.in_turn += 1;
            Onward::Strike
        } else if self.comes_down_level(toss) {
            Onward::Strike
        } else {
            toss.in_turn = 0;
            after
        }
    }

    /// Whether the coin, exactly on its side, goes on to the other rim rather than up.
    fn other_rim_approaches(&self, toss: &Toss) -> bool {
        let m = &toss.motion;
        m.cos == 0.0 && approaches(m.vz, toss.spin.tilt * self.contact.body.half)
    }

    /// Whether another point of the rim of a level coin comes down next.
    fn comes_down_level(&self, toss: &mut Toss) -> bool {
        let law = &self.contact;
        toss.level(law.axial_factor) && {
            let (vz, tilt) = (toss.motion.vz, toss.spin.tilt);
            approaches(vz, vz - toss.motion.touch(&law.body, &toss.spin).approach) && tilt > 0.0
        }
    }

    /// Follows sustained contact on the lowest point.
    pub(crate) fn sustain<O: Observer>(
        &self,
        toss: &mut Toss,
        contact: &mut Contact<'_>,
        observer: &mut O,
    ) -> Onward {
        let (motion, spin, mut adapter) = toss.watched(&self.units, observer);
        let leave = contact.follow(motion, spin, &mut adapter);
        if leave == Leave::LiftOff {
            self.notify(toss, EventKind::LiftOff, observer);
        }
        self.onward(toss, leave)
    }

    pub(crate) fn onward(&self, toss: &mut Toss, leave: Leave) -> Onward {
        match leave {
            Leave::LiftOff => return Onward::Fly(true),
            Leave::OtherRim => {
                toss.motion.lay_down();
                toss.change_rim();
                return Onward::Strike;
            }
            Leave::Upright => return Onward::Strike,
            _ => {}
        }
        Onward::End(match leave {
            Leave::Decided(decided) => toss.ended(decided),
            Leave::NeverSettles => Ended::NeverSettles,
            Leave::Late => Ended::TimeLimit,
            _ => self.lost(toss),
        })
    }

    /// A toss that is given up: out of work, which counts as the limit of impacts whatever kind of
    /// work it was, or no longer a number.
    pub(crate) fn lost(&self, toss: &Toss) -> Ended {
        let energy = toss.motion.energy(&self.contact.body, &toss.spin);
        if energy.is_finite() {
            Ended::ImpactLimit
        } else {
            Ended::Failed
        }
    }

    #[inline]
    fn decide(&self, toss: &Toss) -> Decided {
        let (motion, body) = (&toss.motion, &self.contact.body);
        self.rule.decide(&motion.decision_state(body, &toss.spin))
    }

    fn notify<O: Observer>(&self, toss: &Toss, kind: EventKind, observer: &mut O) {
        if O::ACTIVE {
            observer.event(&Event {
                kind,
                state: toss.state(&self.units),
            });
        }
    }

    pub(crate) fn run<O: Observer>(&self, launch: &Launch, observer: &mut O) -> Finished {
        let mut toss = self.launched(launch);
        let mut contact = self.contact_of(Spent::default());
        self.notify(&toss, EventKind::Launched, observer);
        let ended = match self.ends_at_launch(&toss, launch) {
            Some(ended) => ended,
            None => self.follow(&mut toss, &mut contact, observer),
        };
        self.notify(&toss, EventKind::Ended, observer);
        Finished::new(ended, &toss, &contact.spent)
    }

    /// The toss at its launch.
    pub(crate) fn launched(&self, launch: &Launch) -> Toss {
        let law = &self.contact;
        Toss::new(launch, &self.units, &law.body, law.axial_factor)
    }

    /// How a toss ends that is not followed at all.
    pub(crate) fn ends_at_launch(&self, toss: &Toss, launch: &Launch) -> Option<Ended> {
        let energy = toss.motion.energy(&self.contact.body, &toss.spin);
        let decided = self.decide(toss);
        if !(energy.is_finite() && is_finite(launch)) {
            Some(Ended::Failed)
        } else if self.landing == Landing::Adhesive {
            None
        } else if decided != Decided::Open {
            Some(toss.ended(decided))
        } else {
            self.conserves.then_some(Ended::NeverSettles)
        }
    }

    /// Contact of a toss on which so much is spent.
    #[inline]
    pub(crate) fn contact_of(&self, spent: Spent) -> Contact<'_> {
        Contact {
            law: &self.contact,
            rule: &self.rule,
            settings: &self.settings,
            tolerance: self.tolerance,
            spent,
        }
    }
}

/// A toss that has ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Finished {
    pub(crate) outcome: Outcome,
    /// Time since launch.
    pub(crate) time: f64,
}

impl Finished {
    pub(crate) fn new(ended: Ended, toss: &Toss, spent: &Spent) -> Self {
        let outcome = Outcome {
            ended,
            impacts: toss.impacts,
            contact_steps: spent.steps,
            jams: spent.jams,
            overruled: false,
            breaks: Breaks::default(),
        };
        let time = spent.time;
        Self { outcome, time }
    }
}

/// Comparisons drop what is not a number: the launch itself is asked.
fn is_finite(launch: &Launch) -> bool {
    let vectors = [
        launch.velocity_m_s,
        launch.axis.into_inner(),
        launch.spin_rad_s,
    ];
    launch.height_m.is_finite() && vectors.iter().flatten().all(|x| x.is_finite())
}

/// Whether a point that sinks at `down` relative to a centre that rises at `up` comes down, by more
/// than rounding.
fn approaches(up: f64, down: f64) -> bool {
    up - down < -1e-13 * (up.abs() + down.abs())
}

impl<L: ImpactLaw> Engine for VolumetricEngine<L> {
    type Workspace = ();

    fn workspace(&self) {}

    fn lanes(&self) -> Lanes {
        self.lanes
    }

    fn toss(&self, (): &mut (), launch: &Launch, observer: &mut impl Observer) -> Outcome {
        self.run(launch, observer).outcome
    }

    fn toss_all(
        &self,
        (): &mut (),
        launches: impl Iterator<Item = Launch>,
        mut each: impl FnMut(u64, &Outcome) -> ControlFlow<()>,
    ) {
        match Batch::of(self) {
            Some(batch) => {
                batch.toss_all_in_batch(launches, |number, end| each(number, &end.outcome));
            }
            None => toss_sequential(self, &mut (), launches, each),
        }
    }
}
