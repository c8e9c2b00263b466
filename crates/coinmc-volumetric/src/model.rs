//! The constants of all tosses of one scene: what the scalar path and the batch both work with.

use crate::body::{Body, Friction, Units};
use crate::contact::{ContactRules, ContactSolver, Dynamics, Usage};
use crate::drag::Drag;
use crate::limits::Limits;
use crate::pull::Pull;
use crate::restitution::Restitution;
use crate::rough::Ground;
use crate::settings::{Decision, Settings, SettingsError};
use crate::toss::Toss;
use coinmc_core::{DecisionRule, Event, EventKind, Landing, Launch, LowerRim, Observer, Scene};
use std::f64::consts::FRAC_PI_2;

/// Smallest error that the contact integrator may be asked for: its rounding.
const LEAST_TOLERANCE: f64 = 1e-13;
/// Rocking counts as negligible below this fraction of [`Settings::zeno`], in angle, speed and
/// angular velocity.
const NEGLIGIBLE_ROCKING: f64 = 0.1;

/// Where friction holds the rocking of a thin coin, the error allowed is smaller by this factor: it
/// adds up over the hundreds of swings for which such a coin rocks.
const HELD_TOLERANCE: f64 = 0.1;

/// A scene, an impact law and settings, in the kernel's units.
#[derive(Debug, Clone)]
pub(crate) struct Model<L> {
    pub(crate) impact: L,
    pub(crate) dynamics: Dynamics,
    pub(crate) units: Units,
    pub(crate) limits: Limits,
    pub(crate) rule: DecisionRule,
    pub(crate) restitution: Restitution,
    /// Whether the coin sticks where it first lands.
    pub(crate) adhesive: bool,
    /// The rough ground, if it is not a plane.
    pub(crate) ground: Option<Ground>,
    /// The pull of a tilted table.
    pub(crate) pull: Option<Pull>,
    /// [`ContactRules::side`].
    side: f64,
    /// [`Settings::ground_step`].
    pub(crate) ground_step: f64,
    /// Whether no toss ever loses energy.
    pub(crate) conserves: bool,
    /// [`Settings::zeno`].
    pub(crate) zeno: f64,
    /// Angle, rad, below which rocking is negligible; also a fraction of other quantities.
    pub(crate) negligible_rocking: f64,
    /// [`Settings::stick_speed`].
    stick_speed: f64,
    /// [`Settings::tolerance`] in sqrt(g D).
    tolerance: f64,
}

impl<L> Model<L> {
    /// The model of a scene. `settings.law` is not used: `impact` is the law.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range.
    pub(crate) fn new(
        scene: &Scene,
        settings: &Settings,
        impact: L,
    ) -> Result<Self, SettingsError> {
        settings.validate()?;
        let scene = &scene.pressed_onto_table();
        let units = Units::new(scene);
        let body = Body::new(&scene.coin);
        let friction = Friction::new(scene);
        let drag = Drag {
            linear: scene.drag().linear_per_s() * units.time_s,
            angular: scene.drag().angular_per_s() * units.time_s,
        };
        let axial_factor = body.axial_factor(scene.has_gyroscopic_torque());
        let negligible_rocking = NEGLIGIBLE_ROCKING * settings.zeno;
        let tilting = settings.decision == Decision::Tilting;
        let rule = DecisionRule::new(scene, tilting, negligible_rocking);
        let ground = scene.surface.roughness().map(|roughness| {
            let length = roughness.correlation_length_m() / units.length_m;
            Ground::new(roughness.slope(), length, &body)
        });
        let side = ground
            .as_ref()
            .map_or(FRAC_PI_2, |ground| libm::acos(ground.felt));
        let restitution = Restitution::new(&scene.surface, &units);
        let keeps = rule.loses_nothing(scene.surface.restitution()) && restitution.is_constant();
        let dynamics = Dynamics::new(body, friction, drag, axial_factor, settings.smoothing_time);
        let held = if dynamics.holds() {
            HELD_TOLERANCE
        } else {
            1.0
        };
        Ok(Self {
            impact,
            dynamics,
            units,
            limits: Limits::new(settings),
            rule,
            restitution,
            adhesive: scene.surface.landing() == Landing::Adhesive,
            ground,
            pull: scene.surface.tilt().as_ref().map(Pull::new),
            side,
            ground_step: settings.ground_step,
            conserves: keeps,
            zeno: settings.zeno,
            negligible_rocking,
            stick_speed: settings.stick_speed,
            tolerance: (settings.tolerance * held * body.escape_speed()).max(LEAST_TOLERANCE),
        })
    }

    /// The same model of a coin with a conical edge on this lower rim.
    pub(crate) fn on_lower_rim(self, scene: &Scene, settings: &Settings, rim: &LowerRim) -> Self {
        let (sin, cos) = rim.on_edge();
        let Dynamics {
            friction,
            drag,
            axial_factor,
            ..
        } = self.dynamics;
        let time = settings.smoothing_time;
        let dynamics = Dynamics::new(rim.body, friction, drag, axial_factor, time).on_rim(cos);
        let tilting = settings.decision == Decision::Tilting;
        let escape_speed = (2.0 * rim.shallowest_well()).sqrt();
        let held = if dynamics.holds() {
            HELD_TOLERANCE
        } else {
            1.0
        };
        Self {
            dynamics,
            rule: DecisionRule::on_lower_rim(scene, rim, tilting, self.negligible_rocking),
            side: libm::atan2(sin, cos),
            tolerance: (settings.tolerance * held * escape_speed).max(LEAST_TOLERANCE),
            ..self
        }
    }

    /// The tilt, rad, at which the other rim touches.
    pub(crate) fn edge_tilt(&self) -> f64 {
        self.side
    }

    /// A toss at its launch.
    pub(crate) fn launch(&self, launch: &Launch) -> Toss {
        let dynamics = &self.dynamics;
        Toss::new(launch, &self.units, &dynamics.body, dynamics.axial_factor)
    }

    /// What governs sustained contact.
    #[inline]
    pub(crate) fn contact_rules(&self) -> ContactRules<'_> {
        ContactRules {
            dynamics: &self.dynamics,
            rule: &self.rule,
            limits: &self.limits,
            side: self.side,
            stick_speed: self.stick_speed,
            creep: self.creep(),
            tolerance: self.tolerance,
        }
    }

    /// The slip of a coin on its side that friction holds: below `stick_speed`, or as much more as
    /// friction needs to hold it on a tilted table. With the creep γ friction is μ γ/sqrt(γ² + ε²) of the
    /// weight, which is the pull at γ = ε q/sqrt(1 − q²), q = tan β/μ.
    fn creep(&self) -> f64 {
        let Some(pull) = &self.pull else {
            return self.stick_speed;
        };
        let share = pull.slope / self.dynamics.friction.mu;
        self.stick_speed * (1.0 + 2.0 * share / (1.0 - share * share).sqrt())
    }

    /// A solver for the contact of a toss that has used this much so far.
    #[inline]
    pub(crate) fn contact_solver(&self, usage: Usage) -> ContactSolver<'_> {
        ContactSolver {
            rules: self.contact_rules(),
            usage,
        }
    }

    /// Reports an event to an observer.
    pub(crate) fn notify<O: Observer>(&self, toss: &Toss, kind: EventKind, observer: &mut O) {
        if O::ACTIVE {
            observer.event(&Event {
                kind,
                state: toss.state(&self.units),
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::contact::line_rates_on;
    use crate::settings::Settings;
    use crate::toss::tests::{generic_scene, model_of};
    use coinmc_core::{Drag, TableTilt};

    /// A coin that friction holds on its side of a tilted table creeps at the speed at which friction balances the
    /// pull. It counts as held up to twice that speed and the one of sticking; on a level table, up to the latter.
    #[test]
    fn a_coin_counts_as_held_up_to_twice_the_creep_that_the_pull_asks_for() {
        let settings = Settings {
            stick_speed: 3e-3,
            ..Settings::default()
        };
        let level = model_of(&generic_scene(|plane| plane), &settings);
        assert_eq!(level.contact_rules().creep, settings.stick_speed);
        for degrees in [2.0_f64, 7.0, 9.0] {
            let tilt = TableTilt::new(degrees, 20.0).expect("a valid tilt");
            let scene = generic_scene(|plane| plane.with_tilt(tilt).expect("a valid tilt"));
            let scene = scene.with_drag(Drag::new(0.0, 0.0).expect("no drag"));
            let model = model_of(&scene, &settings);
            let pulled = model
                .dynamics
                .pulled_by([libm::tan(degrees.to_radians()), 0.0]);
            // by halves: faster than this friction is more than the pull
            let (mut slow, mut fast) = (0.0, 1.0);
            for _ in 0..60 {
                let creep = 0.5 * (slow + fast);
                let state = [creep, 0.0, 0.0, 0.0];
                let now = line_rates_on::<false>(&pulled, &state, settings.stick_speed, [0.0; 2]);
                if now.rates[0] > 0.0 {
                    slow = creep;
                } else {
                    fast = creep;
                }
            }
            let held = settings.stick_speed + 2.0 * slow;
            let creep = model.contact_rules().creep;
            assert!((creep / held - 1.0).abs() < 1e-9, "{creep} {held}");
        }
    }
}
