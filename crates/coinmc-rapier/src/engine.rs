//! The toss: flight in closed form, Rapier's steps at the surface, decision.

use crate::account::{Account, Flaw};
use crate::body::Scaled;
use crate::flight::{Bound, Flight};
use crate::resist;
use crate::settings::{Decision, Flight as Skip, Gyroscopic, Settings, SettingsError};
use crate::toss::Toss;
use crate::verdict::{Judge, Verdict};
use crate::world::{AnyWorld, World};
use coinmc_core::{Ended, Engine, Face, Landing, Launch, Observer, Outcome, Scene};

/// Everything that a toss of one scene needs but a world.
#[derive(Debug, Clone)]
struct Rules {
    scaled: Scaled,
    settings: Settings,
    judge: Judge,
    /// The step, in sqrt(D/g).
    step: f64,
    adhesive: bool,
    /// What is left for this engine to turn ω about the axis by, per step and rate about the axis.
    precession: f64,
    /// There is friction against rolling or pivoting.
    twists: bool,
    skips_standing: bool,
}

/// Depth, as a fraction of the smaller of R and H/2, from which on a coin counts as sunk.
const SUNK: f64 = 0.5;

impl Rules {
    fn new(scene: &Scene, settings: &Settings) -> Result<Self, SettingsError> {
        settings.validate()?;
        let scaled = Scaled::new(scene);
        let step = settings.step_s / scaled.units.time_s;
        let exact = settings.gyroscopic == Gyroscopic::Exact;
        let stands = scaled.axial_factor == 1.0 && scaled.angular_drag > 0.0;
        Ok(Self {
            twists: scaled.contour > 0.0 || scaled.pivoting > 0.0,
            skips_standing: settings.skip_standing && stands && scaled.pivoting == 0.0,
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

    fn toss<W: World, O: Observer>(
        &self,
        world: &mut W,
        launch: &Launch,
        observer: &mut O,
    ) -> Account {
        let mut toss = Toss::new(launch, &self.scaled, observer);
        let ended = if !(is_finite(launch) && toss.energy().is_finite()) {
            Err(Flaw::NotFinite)
        } else if self.adhesive {
            Ok(self.stick(&mut toss))
        } else {
            self.follow(world, &mut toss)
        };
        toss.end(ended)
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

    /// Flights and steps until the toss ends.
    fn follow<W: World, O: Observer>(
        &self,
        world: &mut W,
        toss: &mut Toss<'_, O>,
    ) -> Result<Ended, Flaw> {
        world.place(&toss.motion);
        loop {
            if let Some(ended) = self.decide(toss)? {
                return Ok(ended);
            }
            if toss.time > self.settings.time_limit {
                return Ok(Ended::TimeLimit);
            }
            if toss.steps == self.settings.max_steps {
                return Ok(Ended::ImpactLimit);
            }
            if self.fly(toss) {
                world.place(&toss.motion);
            } else if self.stands(toss) {
                world.set_velocities(&toss.motion);
            }
            self.advance(world, toss);
            if let Some(flaw) = toss.flaw(self.settings.max_gain) {
                return Err(flaw);
            }
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

    /// Leaves out steps in which the coin stands and spins.
    fn stands<O: Observer>(&self, toss: &mut Toss<'_, O>) -> bool {
        if !self.skips_standing {
            return false;
        }
        let (motion, time) = (toss.motion, toss.time);
        let pause = toss
            .standing
            .pause(&motion, &self.scaled, toss.pushed, time, self.step);
        pause.inspect(|pause| toss.pause(pause)).is_some()
    }

    /// One step of the world.
    fn advance<W: World, O: Observer>(&self, world: &mut W, toss: &mut Toss<'_, O>) {
        let scaled = &self.scaled;
        let slow = scaled.threshold > 0.0
            && -toss.motion.touch_velocity(&scaled.body).z < scaled.threshold;
        world.step(if slow { 0.0 } else { scaled.restitution });
        let (mut after, push) = (world.motion(), world.impulse());
        let brakes = self.twists && push > 0.0;
        if brakes {
            resist::brake(&mut after, scaled, push);
        }
        if self.precession != 0.0 {
            after.precess(self.precession);
        }
        if brakes || self.precession != 0.0 {
            world.set_velocities(&after);
        }
        toss.stepped(self.step, &after, push);
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

/// Follows tosses of one scene with Rapier's steps.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, Domain, Engine, Preset, Scene, Stream, Surface};
/// use coinmc_rapier::{RapierEngine, Settings};
/// let coin = Coin::cylinder(2.0, 0.01)?;
/// let scene = Scene::new(coin, Surface::new(0.5, 0.3)?, 9.81)?;
/// let engine = RapierEngine::new(&scene, &Settings::default())?;
/// let launch = Preset::Clean
///     .distribution()
///     .launch(&coin, &mut Stream::new(1, Domain::Launch, 0).toss(0));
/// let account = engine.examine(&mut engine.workspace(), &launch, &mut ());
/// assert!(account.outcome.face().is_some() && account.steps > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct RapierEngine(Rules);

/// A worker's world: a half-space and the coin.
pub struct Workspace(AnyWorld);

impl RapierEngine {
    /// An engine for this scene.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range or its precision was not built.
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self, SettingsError> {
        Rules::new(scene, settings).map(Self)
    }

    /// Follows one toss and gives a full account of it.
    pub fn examine(
        &self,
        workspace: &mut Workspace,
        launch: &Launch,
        observer: &mut impl Observer,
    ) -> Account {
        match &mut workspace.0 {
            #[cfg(feature = "f64")]
            AnyWorld::Double(world) => self.0.toss(&mut **world, launch, observer),
            #[cfg(feature = "f32")]
            AnyWorld::Single(world) => self.0.toss(&mut **world, launch, observer),
            #[cfg(not(all(feature = "f64", feature = "f32")))]
            AnyWorld::Absent => {
                Toss::new(launch, &self.0.scaled, observer).end(Err(Flaw::NotFinite))
            }
        }
    }
}

impl Engine for RapierEngine {
    type Workspace = Workspace;

    fn workspace(&self) -> Workspace {
        let Rules {
            scaled,
            settings,
            step,
            ..
        } = &self.0;
        Workspace(AnyWorld::new(settings.precision, scaled, settings, *step))
    }

    fn toss(
        &self,
        workspace: &mut Workspace,
        launch: &Launch,
        observer: &mut impl Observer,
    ) -> Outcome {
        self.examine(workspace, launch, observer).outcome
    }
}
