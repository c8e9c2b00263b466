//! The toss: flight, impact, sustained contact, decision.

use crate::contact::{Contact, Leave};
use crate::flight::fly_to_contact;
use crate::impact::{Carried, ContactMatrix, ImpactLaw, Record, Strike};
use crate::motion::{Motion, Units};
use crate::settings::{Decision, Settings, SettingsError};
use crate::shape::Shape;
use crate::watch::Watch;
use coinmc_core::trig::sin_cos;
use coinmc_core::{
    Breaks, Ended, Engine, EventKind, Face, Landing, Launch, Observer, Outcome, Scene,
};

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
    law: L,
    settings: Settings,
    units: Units,
    shape: Shape,
    mass_kg: f64,
    restitution: f64,
    friction: f64,
    landing: Landing,
    /// Half the width of the narrower edge, in D: the angle scale of everything near an edge.
    narrow: f64,
}

/// One toss on its way.
struct Toss<'a> {
    motion: Motion,
    contact: Contact<'a>,
    impacts: u32,
    breaks: Breaks,
}

/// What follows an impact.
enum After {
    Flight,
    /// Sustained contact, with this slip of the corner.
    Contact(f64),
    Decided(Face),
}

/// A decision by the user's stopping rule, waiting for the certain one.
struct Early {
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
            narrow: a.min(b),
        })
    }

    pub(crate) fn units(&self) -> &Units {
        &self.units
    }

    pub(crate) fn shape(&self) -> &Shape {
        &self.shape
    }

    pub(crate) fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// Runs the toss to its end.
    fn follow<O: Observer>(
        &self,
        toss: &mut Toss,
        early: &mut Early,
        watch: &mut Watch<'_, O>,
    ) -> Ended {
        let mut departing = false;
        loop {
            if !self.fly(&mut toss.motion, departing, watch) {
                return self.lost(&toss.motion);
            }
            if self.landing == Landing::Adhesive {
                return Ended::Decided(Shape::face(toss.motion.quadrant, toss.motion.delta));
            }
            departing = true;
            // contact goes on from corner to corner until the coin flies again
            loop {
                if toss.impacts == self.settings.max_impacts {
                    return Ended::ImpactLimit;
                }
                toss.impacts += 1;
                watch.event(EventKind::Touching, &toss.motion);
                let touching = toss.motion;
                let after = self.impact(toss);
                watch.passed(touching.time, toss.motion.time, |t| {
                    self.look_into(touching, t)
                });
                watch.event(EventKind::Impact, &toss.motion);
                early.look(&toss.motion, self.shape.k);
                let slip = match after {
                    After::Decided(face) => return Ended::Decided(face),
                    _ if toss.contact.is_certain(&toss.motion) => {
                        return Ended::Decided(Shape::face(
                            toss.motion.quadrant,
                            toss.motion.delta,
                        ));
                    }
                    After::Flight => break,
                    After::Contact(slip) => slip,
                };
                let leave = toss.contact.follow(&mut toss.motion, slip, watch);
                early.look(&toss.motion, self.shape.k);
                match leave {
                    Leave::NextCorner => {}
                    Leave::LiftOff => {
                        watch.event(EventKind::LiftOff, &toss.motion);
                        break;
                    }
                    Leave::Certain => {
                        return Ended::Decided(Shape::face(
                            toss.motion.quadrant,
                            toss.motion.delta,
                        ));
                    }
                    Leave::Balanced => return Ended::Endless,
                    Leave::Lost => return self.lost(&toss.motion),
                }
            }
        }
    }

    fn lost(&self, motion: &Motion) -> Ended {
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
        watch: &mut Watch<'_, O>,
    ) -> bool {
        let start = *motion;
        let found = fly_to_contact(motion, &self.shape, departing);
        watch.passed(start.time, motion.time, |t| {
            let mut motion = start;
            motion.fly(&self.shape, t);
            motion
        });
        found
    }

    /// The impact of the lowest corner.
    #[inline]
    fn impact(&self, toss: &mut Toss) -> After {
        let motion = &mut toss.motion;
        let (sin, cos) = sin_cos(motion.delta);
        motion.z = cos;
        let k = self.shape.k;
        let matrix = ContactMatrix::new(sin, cos, k);
        let ux = motion.vx - motion.omega * cos;
        // a corner that is swapped in may leave already, by rounding
        let uz = (motion.vz + motion.omega * sin).min(0.0);
        let before = motion.energy(k);
        if let Some(slip) = self.plastic(motion, matrix, (ux, uz), (sin, cos)) {
            motion.cap_energy(k, before);
            return if self.is_rocking_out(motion) {
                self.lie_flat(motion)
            } else {
                After::Contact(slip)
            };
        }
        let (carried, _) = self.strike(motion, &mut toss.breaks);
        if carried == Carried::Presses {
            return self.settle(motion, before);
        }
        motion.cap_energy(k, before);
        if self.is_rocking_out(motion) {
            self.lie_flat(motion)
        } else {
            After::Flight
        }
    }

    /// The law's impact of the lowest corner.
    #[inline]
    pub(crate) fn strike(&self, motion: &mut Motion, breaks: &mut Breaks) -> (Carried, Record) {
        let mut strike = self.at_touch(motion, breaks);
        let carried = self.law.carry(&mut strike);
        let record = strike.record;
        if carried == Carried::ByImpulse {
            let (sin, cos) = sin_cos(motion.delta);
            let k = self.shape.k;
            let ux = motion.vx - motion.omega * cos;
            // a corner that is swapped in may leave already, by rounding
            let uz = (motion.vz + motion.omega * sin).min(0.0);
            let matrix = ContactMatrix::new(sin, cos, k);
            let p = self
                .law
                .impulse(matrix, ux, uz, self.restitution, self.friction);
            motion.vx += p.x;
            motion.vz += p.z;
            motion.omega += (sin * p.z - cos * p.x) / k;
        }
        (carried, record)
    }

    #[inline(always)]
    fn at_touch<'a>(&'a self, motion: &'a mut Motion, breaks: &'a mut Breaks) -> Strike<'a> {
        Strike {
            motion,
            shape: &self.shape,
            restitution: self.restitution,
            friction: self.friction,
            tolerance: self.settings.tolerance,
            breaks,
            record: Record::default(),
        }
    }

    /// The coin a time `t` into an impact that lasts longer, for observers: the law is followed
    /// again, so that tosses nobody looks at keep nothing of it.
    fn look_into(&self, touching: Motion, t: f64) -> Motion {
        let mut motion = touching;
        motion.z = sin_cos(motion.delta).1;
        let mut unseen = Breaks::default();
        self.law
            .look_into(&mut self.at_touch(&mut motion, &mut unseen), t);
        motion
    }

    /// Sustained contact of a corner whose law has carried it to where it stays on the surface.
    fn settle(&self, motion: &mut Motion, before: f64) -> After {
        let slip = self.press(motion, before);
        if self.is_rocking_out(motion) {
            self.lie_flat(motion)
        } else {
            After::Contact(slip)
        }
    }

    /// Puts a corner that stays on the surface to rest along the normal, by an impact with e = 0;
    /// returns its slip.
    pub(crate) fn press(&self, motion: &mut Motion, before: f64) -> f64 {
        let (sin, cos) = sin_cos(motion.delta);
        let k = self.shape.k;
        let ux = motion.vx - motion.omega * cos;
        let uz = (motion.vz + motion.omega * sin).min(0.0);
        let p = self
            .law
            .impulse(ContactMatrix::new(sin, cos, k), ux, uz, 0.0, self.friction);
        let omega = motion.omega + (sin * p.z - cos * p.x) / k;
        let slip = if p.sticks {
            0.0
        } else {
            ux + (1.0 + cos * cos / k) * p.x - sin * cos / k * p.z
        };
        motion.set_on_corner(sin, cos, omega, slip);
        motion.cap_energy(k, before);
        // the cap may have slowed it down
        if slip == 0.0 {
            0.0
        } else {
            motion.vx - motion.omega * cos
        }
    }

    /// If the bounces that remain would all be over before the coin has turned noticeably, ends
    /// them at once by an impact with e = 0; returns the slip after it.
    ///
    /// Between impacts the corner falls with a = 1 − ω²cos δ (its acceleration without contact),
    /// so the remaining bounces take 2 e v/(a(1 − e)), v the normal speed now.
    #[inline]
    fn plastic(
        &self,
        motion: &mut Motion,
        matrix: ContactMatrix,
        (ux, uz): (f64, f64),
        (sin, cos): (f64, f64),
    ) -> Option<f64> {
        let e = self.law.rebound(self.restitution);
        // a <= 1 and the rate >= 1: most impacts are told apart here
        if -uz * 2.0 * e >= self.settings.zeno * (1.0 - e) {
            return None;
        }
        let k = self.shape.k;
        let p = self.law.impulse(matrix, ux, uz, 0.0, self.friction);
        let omega = motion.omega + (sin * p.z - cos * p.x) / k;
        let press = 1.0 - omega * omega * cos;
        let rate = 1.0 + omega.abs() / self.narrow;
        if !(press > 0.0 && -uz * 2.0 * e * rate < self.settings.zeno * (1.0 - e) * press) {
            return None;
        }
        let slip = if p.sticks {
            0.0
        } else {
            ux + matrix.xx * p.x + matrix.xz * p.z
        };
        motion.set_on_corner(sin, cos, omega, slip);
        Some(slip)
    }

    /// Whether the coin rocks on an edge so little that it may be laid flat: turning, falling and
    /// gap all below zeno/10 of the edge, an energy below (zeno/10)² of the barrier's.
    #[inline]
    fn is_rocking_out(&self, motion: &Motion) -> bool {
        // without friction a coin this still is decided by its energy
        if self.friction == 0.0 || motion.vz.abs() > 0.1 * self.settings.zeno {
            return false;
        }
        let (gap, at_end) = self.shape.gap(motion.quadrant, motion.delta);
        let small = 0.1 * self.settings.zeno * self.shape.base(motion.quadrant, at_end).1;
        gap < small && motion.omega.abs() < small && motion.vz.abs() < small
    }

    /// Lays the coin flat: a plastic impact of the whole edge. It then slides, and either never
    /// tips (friction μN at the base against the lever of N: μ·height <= half width, certain), or
    /// trips over its leading corner.
    fn lie_flat(&self, motion: &mut Motion) -> After {
        let (gap, at_end) = self.shape.gap(motion.quadrant, motion.delta);
        let (height, half_width) = self.shape.base(motion.quadrant, at_end);
        motion.delta += if at_end { gap } else { -gap };
        let braking = (self.friction * motion.vz.abs()).min(motion.vx.abs());
        motion.vx -= braking.copysign(motion.vx);
        (motion.z, motion.vz, motion.omega) = (height, 0.0, 0.0);
        if self.friction * height <= half_width || motion.vx == 0.0 {
            return After::Decided(Shape::face(motion.quadrant, motion.delta));
        }
        // sliding to +x it trips forwards (ω > 0), from the start of a quadrant
        let forwards = motion.vx > 0.0;
        if forwards == at_end {
            motion.cross_flat(&self.shape, forwards);
        }
        After::Contact(motion.vx)
    }
}

impl Early {
    fn new(decision: Decision, energy: f64) -> Self {
        let below = match decision {
            Decision::Certain => f64::NEG_INFINITY,
            Decision::EnergyFraction(fraction) => fraction * energy,
        };
        Self { below, face: None }
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

    fn toss(&self, (): &mut (), launch: &Launch, observer: &mut impl Observer) -> Outcome {
        self.toss_observed(launch, observer)
    }
}

impl<L: ImpactLaw> FlatEngine<L> {
    fn toss_observed<O: Observer>(&self, launch: &Launch, observer: &mut O) -> Outcome {
        let mut toss = Toss {
            motion: Motion::new(launch, &self.units, &self.shape),
            contact: Contact {
                shape: &self.shape,
                mu: self.friction,
                tolerance: self.settings.tolerance,
                max_steps: self.settings.max_impacts,
                steps: 0,
                jams: 0,
            },
            impacts: 0,
            breaks: Breaks::default(),
        };
        let energy = toss.motion.energy(self.shape.k);
        let mut early = Early::new(self.settings.decision, energy);
        let mut watch = Watch {
            observer,
            units: &self.units,
            shape: &self.shape,
        };
        watch.event(EventKind::Launched, &toss.motion);
        let finite =
            energy.is_finite() && launch.height_m.is_finite() && toss.motion.delta.is_finite();
        let certain = if !finite {
            Ended::Failed
        } else if self.landing == Landing::Bouncing && toss.contact.is_certain(&toss.motion) {
            Ended::Decided(Shape::face(toss.motion.quadrant, toss.motion.delta))
        } else {
            self.follow(&mut toss, &mut early, &mut watch)
        };
        watch.event(EventKind::Ended, &toss.motion);
        let ended = early.face.map_or(certain, Ended::Decided);
        Outcome {
            ended,
            impacts: toss.impacts,
            contact_steps: toss.contact.steps,
            jams: toss.contact.jams,
            overruled: ended != certain,
            breaks: toss.breaks,
        }
    }
}
