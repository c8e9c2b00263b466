//! The toss: flight, impact, sustained contact, decision.

use crate::body::{Body, Friction, Units};
use crate::contact::{self, Contact, Leave};
use crate::flight::{Departure, Drag};
use crate::impact::{ChatterjeeRuina, ImpactLaw, Moreau, Stronge};
use crate::rest;
use crate::settings::{Decision, Law, Settings, SettingsError};
use crate::toss::Toss;
use crate::verdict::{Judge, Verdict};
use coinmc_core::{
    Breaks, Ended, Engine, Event, EventKind, Face, Landing, Launch, Observer, Outcome, Scene,
};

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
    impact: L,
    pub(crate) settings: Settings,
    pub(crate) units: Units,
    pub(crate) contact: contact::Law,
    judge: Judge,
    /// [`Settings::tolerance`], in sqrt(g D).
    tolerance: f64,
    restitution: f64,
    /// Approach below which e = 0, in sqrt(g D).
    threshold: f64,
    landing: Landing,
    /// Nothing is ever lost.
    conserves: bool,
}

/// What follows an impact.
enum After {
    /// Flight; `true` if the contact point parts by its acceleration alone.
    Flight(bool),
    /// Sustained contact.
    Contact,
}

/// What follows sustained contact.
pub(crate) enum Onward {
    Fly,
    Strike,
    End(Ended),
}

/// The integrator's rounding: no step can be asked to err less.
const LEAST_TOLERANCE: f64 = 1e-13;
/// Impacts of one rim and the other in turn, without flight, after which the coin lies on its side.
const ALTERNATIONS: u32 = 100;

/// An engine of any law, for callers that learn the law at run time: one `match`, then static
/// dispatch.
#[derive(Debug, Clone)]
pub enum AnyVolumetricEngine {
    /// [`Moreau`].
    Moreau(VolumetricEngine<Moreau>),
    /// [`ChatterjeeRuina`].
    ChatterjeeRuina(VolumetricEngine<ChatterjeeRuina>),
    /// [`Stronge`].
    Stronge(VolumetricEngine<Stronge>),
}

impl AnyVolumetricEngine {
    /// The engine of `settings.law`.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range.
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self, SettingsError> {
        Ok(match settings.law {
            Law::Moreau => Self::Moreau(VolumetricEngine::new(scene, settings, Moreau)?),
            Law::ChatterjeeRuina => {
                Self::ChatterjeeRuina(VolumetricEngine::new(scene, settings, ChatterjeeRuina)?)
            }
            Law::Stronge => Self::Stronge(VolumetricEngine::new(scene, settings, Stronge)?),
        })
    }
}

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
        let axial_factor = if scene.has_gyroscopic_torque() {
            body.ka / body.kt
        } else {
            1.0
        };
        let judge = Judge::new(
            body,
            &friction,
            axial_factor,
            drag.acts(),
            settings.decision == Decision::Tilting,
            rest::ROCKING * settings.zeno,
        );
        let restitution = scene.surface.restitution();
        let threshold = scene.surface.restitution_threshold_m_s() / units.speed_m_s();
        Ok(Self {
            impact: law,
            settings: *settings,
            units,
            contact: contact::Law::new(body, friction, drag, axial_factor, settings.fade),
            judge,
            tolerance: (settings.tolerance * body.escape_speed()).max(LEAST_TOLERANCE),
            restitution,
            threshold,
            landing: scene.surface.landing(),
            conserves: judge.conserves(restitution) && threshold == 0.0,
        })
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
            if contact.time > self.settings.time_limit {
                return Ended::TimeLimit;
            }
            if self.landing == Landing::Adhesive {
                let side = self.judge.on_side(&toss.motion);
                return decided(if side { Verdict::Side } else { Verdict::Face }, toss);
            }
            departure = Departure::Leaving;
            match self.bounce(toss, contact, observer) {
                Ok(by_acceleration) => parting = by_acceleration,
                Err(ended) => return ended,
            }
        }
    }

    /// Impacts and sustained contact until the coin flies again (`Ok`) or the toss ends.
    fn bounce<O: Observer>(
        &self,
        toss: &mut Toss,
        contact: &mut Contact<'_>,
        observer: &mut O,
    ) -> Result<bool, Ended> {
        let mut in_turn = 0;
        loop {
            if toss.impacts == self.settings.max_impacts {
                return Err(Ended::ImpactLimit);
            }
            toss.impacts += 1;
            toss.level(self.contact.axial_factor);
            self.notify(toss, EventKind::Touching, observer);
            let after = self.strike(toss);
            self.notify(toss, EventKind::Impact, observer);
            let verdict = self.judge.verdict(&toss.motion, &toss.spin);
            if verdict != Verdict::Open {
                return Err(decided(verdict, toss));
            }
            let onward = if self.rocks_out(toss) || in_turn > ALTERNATIONS {
                self.lie(toss, contact, observer)
            } else if self.stands(toss) {
                self.trip(toss, contact, observer)
            } else if self.other_rim_approaches(toss) {
                toss.change_rim();
                in_turn += 1;
                continue;
            } else if self.comes_down_level(toss) {
                continue;
            } else {
                match after {
                    After::Flight(parting) => return Ok(parting),
                    After::Contact => self.sustain(toss, contact, observer),
                }
            };
            in_turn = 0;
            match onward {
                Onward::Fly => return Ok(true),
                Onward::Strike => {}
                Onward::End(ended) => return Err(ended),
            }
        }
    }

    /// The impact of the lowest point, or, if the bounces that remain would all be over before the
    /// coin has turned noticeably, the end of them all at once.
    #[inline]
    fn strike(&self, toss: &mut Toss) -> After {
        let law = &self.contact;
        let (body, friction) = (&law.body, &law.friction);
        let before = toss.motion.energy(body, &toss.spin);
        let mut touch = toss.motion.touch(body, &toss.spin);
        // a point that is swapped in may leave already, by rounding
        touch.approach = touch.approach.min(0.0);
        let speed = -touch.approach;
        let e = if speed < self.threshold {
            0.0
        } else {
            self.restitution
        };
        // the bounces that remain take 2 e v/(a(1 − e)), a the acceleration that closes the gap
        let rest = 2.0 * e * speed;
        let quick = self.settings.zeno * (1.0 - e);
        if rest < quick * (2.0 + 2.0 * law.uplift(&toss.motion, &toss.spin)) || e == 0.0 {
            let p = self.impact.impulse(body, friction, &touch, 0.0);
            let (mut motion, mut spin) = (toss.motion, toss.spin);
            motion.strike(&mut spin, body, &touch, p);
            motion.cap_energy(body, &mut spin, before);
            let press = law.press(&motion, &spin);
            let ends = press > 0.0 && rest * contact::fastest(&motion, &spin) < quick * press;
            if ends || e == 0.0 {
                motion.set_spin(&spin, law.axial_factor);
                (toss.motion, toss.spin) = (motion, spin);
                return if ends {
                    After::Contact
                } else {
                    After::Flight(true)
                };
            }
        }
        let p = self.impact.impulse(body, friction, &touch, e);
        toss.motion.strike(&mut toss.spin, body, &touch, p);
        toss.motion.cap_energy(body, &mut toss.spin, before);
        toss.motion.set_spin(&toss.spin, law.axial_factor);
        After::Flight(false)
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
        let (motion, spin, mut watch) = toss.watched(&self.units, observer);
        let leave = contact.follow(motion, spin, &mut watch);
        if leave == Leave::LiftOff {
            self.notify(toss, EventKind::LiftOff, observer);
        }
        self.onward(toss, leave)
    }

    pub(crate) fn onward(&self, toss: &mut Toss, leave: Leave) -> Onward {
        match leave {
            Leave::LiftOff => return Onward::Fly,
            Leave::OtherRim => {
                toss.motion.lay_down();
                toss.change_rim();
                return Onward::Strike;
            }
            Leave::Upright => return Onward::Strike,
            _ => {}
        }
        Onward::End(match leave {
            Leave::Settled(verdict) => decided(verdict, toss),
            Leave::Endless => Ended::Endless,
            Leave::Late => Ended::TimeLimit,
            _ => self.lost(toss),
        })
    }

    /// A toss that is given up: out of work, which counts as the limit of impacts whatever kind of
    /// work it was, or no longer a number.
    fn lost(&self, toss: &Toss) -> Ended {
        let energy = toss.motion.energy(&self.contact.body, &toss.spin);
        if energy.is_finite() {
            Ended::ImpactLimit
        } else {
            Ended::Failed
        }
    }

    fn notify<O: Observer>(&self, toss: &Toss, kind: EventKind, observer: &mut O) {
        if O::ACTIVE {
            observer.event(&Event {
                kind,
                state: toss.state(&self.units),
            });
        }
    }

    fn run<O: Observer>(&self, launch: &Launch, observer: &mut O) -> Outcome {
        let law = &self.contact;
        let mut toss = Toss::new(launch, &self.units, &law.body, law.axial_factor);
        let mut contact = Contact {
            law,
            judge: &self.judge,
            settings: &self.settings,
            tolerance: self.tolerance,
            steps: 0,
            jams: 0,
            time: 0.0,
        };
        self.notify(&toss, EventKind::Launched, observer);
        let energy = toss.motion.energy(&law.body, &toss.spin);
        let verdict = self.judge.verdict(&toss.motion, &toss.spin);
        let ended = if !(energy.is_finite() && is_finite(launch)) {
            Ended::Failed
        } else if self.landing == Landing::Bouncing && verdict != Verdict::Open {
            decided(verdict, &toss)
        } else if self.landing == Landing::Bouncing && self.conserves {
            Ended::Endless
        } else {
            self.follow(&mut toss, &mut contact, observer)
        };
        self.notify(&toss, EventKind::Ended, observer);
        Outcome {
            ended,
            impacts: toss.impacts,
            contact_steps: contact.steps,
            jams: contact.jams,
            overruled: false,
            breaks: Breaks::default(),
        }
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

fn decided(verdict: Verdict, toss: &Toss) -> Ended {
    Ended::Decided(if verdict == Verdict::Side {
        Face::Side
    } else {
        toss.face()
    })
}

impl<L: ImpactLaw> Engine for VolumetricEngine<L> {
    type Workspace = ();

    fn workspace(&self) {}

    fn toss(&self, (): &mut (), launch: &Launch, observer: &mut impl Observer) -> Outcome {
        self.run(launch, observer)
    }
}
