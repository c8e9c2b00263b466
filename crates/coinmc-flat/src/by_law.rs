//! Engines and single impacts of the law that the settings name.

use crate::engine::FlatEngine;
use crate::impact_law::PlanarLaw;
use crate::laws::{Law, each_law};
use crate::settings::Settings;
use crate::settings_error::SettingsError;
use crate::single::SingleImpact;
use coinmc_core::{DynEngine, Launch, Scene};

impl Settings {
    /// An engine for this scene with the law of the settings. The engines of all laws are compiled
    /// with this crate.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range, or the law does not apply to the scene.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{Coin, Engine, Scene, Surface};
    /// use coinmc_flat::{Lanes, Settings};
    /// let scene = Scene::new(Coin::cylinder(1.0, 0.01)?, Surface::new(0.5, 0.0)?, 9.81)?;
    /// let engine = Settings::default().engine(&scene)?.with_lanes(Lanes::Scalar)?;
    /// assert_eq!(engine.lanes(), Lanes::Scalar);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn engine(&self, scene: &Scene) -> Result<DynEngine, SettingsError> {
        Ok(each_law!(self.law, law => {
            DynEngine::new(FlatEngine::new(scene, self, law.impact(scene)?)?)
        }))
    }
}

impl SingleImpact {
    /// [`FlatEngine::impact_once`] with the law of the settings.
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range, or the law does not apply to the scene.
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
        Ok(each_law!(settings.law, law => {
            FlatEngine::new(scene, settings, law.impact(scene)?)?.impact_once(launch)
        }))
    }
}
