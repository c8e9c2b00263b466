//! The driver: what happens to a toss between Rapier's steps. Flight in closed form, the decision,
//! limits, and the forces that Rapier does not have.

use crate::account::{Account, Flaw};
use crate::flight::{Bound, Flight};
use crate::rolling_friction;
use crate::scaled::Scaled;
use crate::settings::{
    Decision, Flight as FlightSetting, Gyroscopic, Settings, SettingsError, Standing,
};
use crate::toss::Toss;
use crate::world::World;
use coinmc_core::{Decided, DecisionRule, Ended, Landing, Launch, Observer, Scene};
use std::ops::ControlFlow;

/// How a toss ended, or what went wrong.
pub(crate) type End = Result<Ended, Flaw>;

/// Everything that the tosses of one scene need besides a world.
#[derive(Debug, Clone)]
pub(crate) struct Driver {
    pub(crate) scaled: Scaled,
    pub(crate) settings: Settings,
    rule: DecisionRule,
    /// The step, in sqrt(D/g).
    pub(crate) step: f64,
    /// The first contact decides.
    adhesive: bool,
    /// Angle by which this engine turns ω about the axis in a step, per rate about the axis.
    precession: f64,
    /// There is rolling or pivoting friction.
    rolling_friction: bool,
    /// A coin that stands and spins is slowed without steps.
    skips_standing: bool,
}

/// Depth, as a fraction of the smaller of R and H/2, from which on a coin counts as sunk.
const SUNK: f64 = 0.5;
/// Sine of the tilt below which a coin counts as flat on its face for the decision: that of the
/// event-driven engine with its default settings.
const FLAT_SINE: f64 = 2e-3;

impl Driver {
    pub(crate) fn new(scene: &Scene, settings: &Settings) -> Result<Self, SettingsError> {
        settings.validate()?;
        let scaled = Scaled::new(scene);
        let step = settings.step_s / scaled.units.time_s;
        let exact = settings.gyroscopic == Gyroscopic::Exact;
        let can_stand = scaled.axial_factor == 1.0
            && scaled.angular_drag > 0.0
            && scaled.pivoting_friction == 0.0;
        let tilting = settings.decision == Decision::Tilting;
        Ok(Self {
            rolling_friction: scaled.rolling_friction > 0.0 || scaled.pivoting_friction > 0.0,
            skips_standing: settings.standing == Standing::Drag && can_stand,
            scaled,
            settings: *settings,
            rule: DecisionRule::new(scene, tilting, FLAT_SINE).in_time_steps(),
            step,
            adhesive: scene.surface.landing() == Landing::Adhesive,
            precession: if exact {
                (scaled.axial_factor - 1.0) * step
            } else {
                0.0
            },
        })
    }

    /// Follows one toss to its end, in a world of its own.
    pub(crate) fn toss<O: Observer>(
        &self,
        world: &mut World,
        launch: &Launch,
        observer: O,
    ) -> Account {
        let (mut toss, mut next) = self.launch(world, 0, launch, observer);
        let end = loop {
            if next.is_continue() {
                next = self.before_step(world, 0, &mut toss);
            }
            if let ControlFlow::Break(end) = next {
                break end;
            }
            world.step();
            next = self.after_step(world, 0, &mut toss);
        };
        world.clear(0);
        toss.end(end)
    }

    /// Launches a toss in this slot of the world; it may end before its first step.
    pub(crate) fn launch<'a, O: Observer>(
        &'a self,
        world: &mut World,
        slot: usize,
        launch: &Launch,
        observer: O,
    ) -> (Toss<'a, O>, ControlFlow<End>) {
        let mut toss = Toss::new(launch, &self.scaled, observer);
        let next = if !(is_finite(launch) && toss.energy().is_finite()) {
            ControlFlow::Break(Err(Flaw::NotFinite))
        } else if self.adhesive {
            ControlFlow::Break(Ok(self.land_adhesively(&mut toss)))
        } else {
            world.place(slot, &toss.motion);
            ControlFlow::Continue(())
        };
        (toss, next)
    }

    /// Follows the flight to its first contact, which decides.
    fn land_adhesively<O: Observer>(&self, toss: &mut Toss<'_, O>) -> Ended {
        /// Gap that counts as touching, in D.
        const TOUCH: f64 = 1e-9;
        /// Progress that counts as none, in sqrt(D/g).
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
            if clear.end != Bound::Evaluations {
                return toss.ended(self.well(toss));
            }
        }
        Ended::ImpactLimit
    }

    /// Prepares the world's next step, unless the toss ends here.
    pub(crate) fn before_step<O: Observer>(
        &self,
        world: &mut World,
        slot: usize,
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
        if self.skip_flight(toss) {
            world.place(slot, &toss.motion);
        } else if self.skip_standing(toss) {
            world.set_velocities(slot, &toss.motion);
        }
        let scaled = &self.scaled;
        let slow = scaled.threshold > 0.0
            && -toss.motion.contact_velocity(&scaled.body).z < scaled.threshold;
        world.set_restitution(slot, if slow { 0.0 } else { scaled.restitution });
        ControlFlow::Continue(())
    }

    /// Takes over the result of the world's step, unless the toss fails there.
    pub(crate) fn after_step<O: Observer>(
        &self,
        world: &mut World,
        slot: usize,
        toss: &mut Toss<'_, O>,
    ) -> ControlFlow<End> {
        let (mut after, push) = (world.motion(slot), world.normal_impulse(slot));
        let slowed = self.rolling_friction && push > 0.0;
        if slowed {
            rolling_friction::apply(&mut after, &self.scaled, push);
        }
        if self.precession != 0.0 {
            after.precess(self.precession);
        }
        if slowed || self.precession != 0.0 {
            world.set_velocities(slot, &after);
        }
        toss.take_step(self.step, &after, push);
        match toss.flaw(self.settings.max_gain) {
            Some(flaw) => ControlFlow::Break(Err(flaw)),
            None => ControlFlow::Continue(()),
        }
    }

    /// The end of the toss, if its face is decided.
    fn decide<O: Observer>(&self, toss: &mut Toss<'_, O>) -> Result<Option<Ended>, Flaw> {
        let (motion, body) = (&toss.motion, &self.scaled.body);
        let depth = (-motion.gap(&self.scaled)).max(0.0);
        let decided = if self.settings.decision != Decision::Rest {
            self.rule
                .decide(&motion.decision_state(&self.scaled, depth))
        } else if toss.rest.is_at_rest(motion, body, toss.pushed, toss.time) {
            self.well(toss)
        } else {
            Decided::Open
        };
        if decided == Decided::Open {
            return Ok(None);
        }
        if depth > SUNK * body.radius.min(body.half) {
            return Err(Flaw::Sunk);
        }
        Ok(Some(toss.ended(decided)))
    }

    fn well<O: Observer>(&self, toss: &Toss<'_, O>) -> Decided {
        self.rule.well(toss.motion.axis.z.abs())
    }

    /// Flies as far as no contact is possible; `false` if that is too short to be worth it.
    fn skip_flight<O: Observer>(&self, toss: &mut Toss<'_, O>) -> bool {
        /// Gap that counts as touching, as a fraction of the one at which Rapier sees a contact.
        const TOUCH: f64 = 0.1;
        /// Progress that counts as none, in steps.
        const GRAIN: f64 = 1e-3;
        if self.settings.flight == FlightSetting::Off || toss.motion.gap(&self.scaled) <= 0.0 {
            return false;
        }
        let flight = Flight::new(&toss.motion, &self.scaled);
        // a step beyond the limit of time, so that the toss notices it
        let horizon = self.settings.time_limit - toss.time + self.step;
        let touch = TOUCH * self.settings.prediction;
        let clear = flight.clear_until(horizon, GRAIN * self.step, touch);
        // placing the coin anew costs more than a shorter flight saves
        if clear.time < self.step {
            return false;
        }
        let duration = match self.settings.flight {
            FlightSetting::Steps => (clear.time / self.step).floor() * self.step,
            _ => clear.time,
        };
        toss.fly(&flight, duration);
        toss.centre();
        true
    }

    /// Slows a coin that stands and spins, without steps; `false` if it does not stand.
    fn skip_standing<O: Observer>(&self, toss: &mut Toss<'_, O>) -> bool {
        if !self.skips_standing {
            return false;
        }
        let (motion, time) = (toss.motion, toss.time);
        let skip = toss
            .standing
            .skip(&motion, &self.scaled, toss.pushed, time, self.step);
        skip.inspect(|skip| toss.spin_on(skip)).is_some()
    }
}

/// Whether every number of a launch is finite. Comparisons in what follows would hide NaN.
fn is_finite(launch: &Launch) -> bool {
    let vectors = [
        launch.velocity_m_s,
        launch.axis.into_inner(),
        launch.spin_rad_s,
    ];
    launch.height_m.is_finite() && vectors.iter().flatten().all(|x| x.is_finite())
}
