//! One impact by itself: to look at a law, to compare it with film, to measure it.

use crate::engine::FlatEngine;
use crate::impact_law::{ImpactLaw, Resolution};
use crate::motion::Motion;
use crate::parameters::Parameters;
use crate::settings::{Settings, SettingsError};
use coinmc_core::{Breaks, Launch, Scene, State};

/// One impact: the coin just before and just after, and what happened between.
#[derive(Debug, Clone, Copy)]
pub struct SingleImpact {
    /// The coin with its lowest corner on the surface, just before.
    pub before: State,
    /// Just after; its time is that of the release, counted from the touch.
    pub after: State,
    /// The corner stays on the surface.
    pub stays: bool,
    /// Largest normal force, N: of all steps; 0 for laws without duration.
    pub peak_force_n: f64,
    /// Steps of the integration; 0 for laws without duration.
    pub steps: u32,
    /// Energy that the integration lost track of, J: before, less after, less what is stored, less
    /// what damping and friction took.
    pub imbalance_j: f64,
    /// Energy beyond that before, J, taken out of the velocities after; 0 where there was none.
    pub gain_j: f64,
    /// What broke.
    pub breaks: Breaks,
}

impl SingleImpact {
    /// [`FlatEngine::impact_once`] of the law of the settings.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range, or the law does not go with the scene.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{Coin, Launch, Scene, Surface};
    /// use coinmc_flat::{GaekSukhov, Law, Lever, Settings, SingleImpact};
    /// use nalgebra::{Unit, Vector3};
    /// let scene = Scene::new(Coin::cylinder(1.0, 0.01)?, Surface::new(0.5, 0.0)?, 9.81)?;
    /// let law = Law::GaekSukhov(GaekSukhov { eta_n_s: 1e-3, lever: Lever::Height });
    /// let settings = Settings { law, ..Settings::default() };
    /// let launch = Launch {
    ///     height_m: 0.0, // the coin is put onto the surface
    ///     velocity_m_s: Vector3::new(0.0, 0.0, -2.0),
    ///     axis: Unit::new_normalize(Vector3::new(0.5, 0.0, 1.0)),
    ///     spin_rad_s: Vector3::zeros(),
    /// };
    /// let impact = SingleImpact::new(&scene, &settings, &launch)?;
    /// assert!(impact.after.spin_rad_s.y != 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(scene: &Scene, settings: &Settings, launch: &Launch) -> Result<Self, SettingsError> {
        settings.law.impact_once(scene, settings, launch)
    }
}

impl<L: ImpactLaw> FlatEngine<L> {
    /// The impact of a coin with this velocity, spin and tilt whose lowest corner has just touched;
    /// the launch's height is not looked at. No bounces are summed up: this is the law alone.
    pub fn impact_once(&self, launch: &Launch) -> SingleImpact {
        let Parameters {
            units,
            shape,
            mass_kg,
            ..
        } = &self.parameters;
        let mut motion = Motion::new(launch, units, shape);
        motion.z = coinmc_lanes::sin_cos(motion.delta).1;
        let before = motion;
        let mut breaks = Breaks::default();
        let energy = before.energy(shape.k);
        let (resolution, record) = self.parameters.apply_law(&mut motion, &mut breaks);
        let gain = (motion.energy(shape.k) - energy).max(0.0);
        if resolution == Resolution::StaysInContact {
            self.parameters.stop_normal_motion(&mut motion, energy);
        }
        motion.cap_energy(shape.k, energy);
        let force = mass_kg * units.length_m / (units.time_s * units.time_s);
        SingleImpact {
            before: before.state(units, shape),
            after: motion.state(units, shape),
            stays: resolution == Resolution::StaysInContact,
            peak_force_n: record.peak_force * force,
            steps: record.steps,
            imbalance_j: record.imbalance * force * units.length_m,
            gain_j: gain * force * units.length_m,
            breaks,
        }
    }
}
