//! The rules of a toss: flight in closed form, decision, and what is added to Rapier's steps.

use crate::account::Flaw;
use crate::body::Scaled;
use crate::flight::{Bound, Flight};
use crate::resist;
use crate::settings::{Decision, Flight as Skip, Gyroscopic, Settings, SettingsError, Standing};
use crate::toss::Toss;
use crate::verdict::{Judge, Verdict};
use crate::world::World;
use coinmc_core::{Ended, Face, Landing, Launch, Observer, Scene};
use std::ops::ControlFlow;

/// How a toss ended, or what went wrong.
pub(crate) type End = Result<Ended, Flaw>;

/// Everything that a toss of one scene needs but a world.
#[derive(Debug, Clone)]
pub(crate) struct Rules {
    pub(crate) scaled: Scaled,
    pub(crate) settings: Settings,
    judge: Judge,
    /// The step, in sqrt(D/g).
    pub(crate) step: f64,
    adhesive: bool,
    /// What is left for this engine to turn ω about the axis by, per step and rate about the axis.
    precession: f64,
    /// There is friction against rolling or pivoting.
    twists: bool,
    /// A coin that stands and spins is slowed without steps.
    slows_standing: bool,
}

/// Depth, as a fraction of the smaller of R and H/2, from which on a coin counts as sunk.
const SUNK: f64 = 0.5;

impl Rules {
    pub(crate) fn new(scene: &Scene, settings: &Settings) -> Result<Self, SettingsError> {
        settings.validate()?;
        let scaled = Scaled::new(scene);
        let step = settings.step_s / scaled.units.time_s;
        let exact = settings.gyroscopic == Gyroscopic::Exact;
        let stands = scaled.axial_factor == 1.0 && scaled.angular_drag > 0.0;
        Ok(Self {
            twists: scaled.contour > 0.0 || scaled.pivoting > 0.0,
            slows_standing: settings.standing == Standing::Drag && stands && scaled.pivoting == 0.0,
            scaled,
            settings: *settings,
            judge: Judge::new(&scaled, settings.decision),
            step,
            adhesive: scene.surface.landing() == Landing::Adhesive,
            precession: if exact {
                (scaled.axial_factor - 1.0) * step
            } else {
                0.0
            },
        })
    }

    /// A toss that begins in this seat of the world, or that ends before its first step.
    pub(crate) fn begin<'a, O: Observer>(
        &'a self,
        world: &mut World,
        seat: usize,
        launch: &Launch,
        observer: O,
    ) -> (Toss<'a, O>, ControlFlow<End>) {
        let mut toss = Toss::new(launch, &self.scaled, observer);
        let course = if !(is_finite(launch) && toss.energy().is_finite()) {
            ControlFlow::Break(Err(Flaw::NotFinite))
        } else if self.adhesive {
            ControlFlow::Break(Ok(self.stick(&mut toss)))
        } else {
            world.place(seat, &toss.motion);
            ControlFlow::Continue(())
        };
        (toss, course)
    }

    /// The first contact decides.
    fn stick<O: Observer>(&self, toss: &mut Toss<'_, O>) -> Ended {
        /// Gap that counts as touching, in D; progress that is none, in sqrt(D/g); attempts.
        const TOUCH: f64 = 1e-9;
        const GRAIN: f64 = 1e-12;
        const ATTEMPTS: u32 = 1000;
        for _ in 0..ATTEMPTS {
            let flight = Flight::new(&toss.motion, &self.scaled);
            let horizon = self.settings.time_limit - toss.time;
            let clear = flight.clear_until(horizon, GRAIN, TOUCH);
            toss.fly(&flight, clear.time);
            if clear.end == Bound::Horizon {
                return Ended::TimeLimit;
            }
            if clear.end != Bound::Spent {
                let side = self.judge.well(&toss.motion) == Verdict::Side;
                return Ended::Decided(if side { Face::Side } else { toss.face() });
            }
        }
        Ended::ImpactLimit
    }

    /// What there is to do before the world's next step, unless the toss ends here.
    pub(crate) fn before_step<O: Observer>(
        &self,
        world: &mut World,
        seat: usize,
        toss: &mut Toss<'_, O>,
    ) -> ControlFlow<End> {
        match self.decide(toss) {
            Err(flaw) => return ControlFlow::Break(Err(flaw)),
            Ok(Some(ended)) => return ControlFlow::Break(Ok(ended)),
            Ok(None) => {}
        }
        if toss.time > self.settings.time_limit {
            return ControlFlow::Break(Ok(Ended::TimeLimit));
        }
        if toss.steps == self.settings.max_steps {
            return ControlFlow::Break(Ok(Ended::ImpactLimit));
        }
        if self.fly(toss) {
            world.place(seat, &toss.motion);
        } else if self.stands(toss) {
            world.set_velocities(seat, &toss.motion);
        }
        let scaled = &self.scaled;
        let slow = scaled.threshold > 0.0
            && -toss.motion.touch_velocity(&scaled.body).z < scaled.threshold;
        world.set_restitution(seat, if slow { 0.0 } else { scaled.restitution });
        ControlFlow::Continue(())
    }

    /// Takes up what the world's step came to.
    pub(crate) fn after_step<O: Observer>(
        &self,
        world: &mut World,
        seat: usize,
        toss: &mut Toss<'_, O>,
    ) -> ControlFlow<End> {
        let (mut after, push) = (world.motion(seat), world.normal_impulse(seat));
        let brakes = self.twists && push > 0.0;
        if brakes {
            resist::brake(&mut after, &self.scaled, push);
        }
        if self.precession != 0.0 {
            after.precess(self.precession);
        }
        if brakes || self.precession != 0.0 {
            world.set_velocities(seat, &after);
        }
        toss.stepped(self.step, &after, push);
        match toss.flaw(self.settings.max_gain) {
            Some(flaw) => ControlFlow::Break(Err(flaw)),
            None => ControlFlow::Continue(()),
        }
    }

    /// Whether the face is settled.
    fn decide<O: Observer>(&self, toss: &mut Toss<'_, O>) -> Result<Option<Ended>, Flaw> {
        let (motion, body) = (&toss.motion, &self.scaled.body);
        let depth = (-motion.gap(body)).max(0.0);
        let verdict = if self.settings.decision == Decision::Rest {
            if !toss.rest.has_come(motion, body, toss.time) {
                return Ok(None);
            }
            self.judge.well(motion)
        } else {
            // lifted out of the surface
            self.judge.verdict(motion, toss.energy() + depth)
        };
        if verdict == Verdict::Open {
            return Ok(None);
        }
        if depth > SUNK * body.radius.min(body.half) {
            return Err(Flaw::Sunk);
        }
        Ok(Some(Ended::Decided(if verdict == Verdict::Side {
            Face::Side
        } else {
            toss.face()
        })))
    }

    /// Flies as far as no contact is possible; `false` if that is not far enough to be worth it.
    fn fly<O: Observer>(&self, toss: &mut Toss<'_, O>) -> bool {
        /// Gap that counts as touching, as a fraction of the one at which Rapier sees a contact.
        const TOUCH: f64 = 0.1;
        /// Progress that is given up, in steps.
        const GRAIN: f64 = 1e-3;
        if self.settings.flight == Skip::Off || toss.motion.gap(&self.scaled.body) <= 0.0 {
            return false;
        }
        let flight = Flight::new(&toss.motion, &self.scaled);
        // an end of time, so that the limit is noticed
        let horizon = self.settings.time_limit - toss.time + self.step;
        let touch = TOUCH * self.settings.prediction;
        let clear = flight.clear_until(horizon, GRAIN * self.step, touch);
        // a shorter flight is not worth setting the coin down anew
        if clear.time < self.step {
            return false;
        }
        let duration = match self.settings.flight {
            Skip::Steps => (clear.time / self.step).floor() * self.step,
            _ => clear.time,
        };
        toss.fly(&flight, duration);
        toss.centre();
        true
    }

    /// Slows a coin that stands and spins, without steps.
    fn stands<O: Observer>(&self, toss: &mut Toss<'_, O>) -> bool {
        if !self.slows_standing {
            return false;
        }
        let (motion, time) = (toss.motion, toss.time);
        let pause = toss
            .standing
            .pause(&motion, &self.scaled, toss.pushed, time, self.step);
        pause.inspect(|pause| toss.pause(pause)).is_some()
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
