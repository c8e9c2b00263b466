//! The model of the drops: law, coin and gravity.
//!
//! A new law of the flat engine needs an arm in [`parameters`](crate::parameters) and where
//! [`Shared`] takes its parameters; each new parameter is a variant of
//! [`Parameter`](crate::Parameter).

use crate::parameter::Shared;
use coinmc_core::{Coin, Engine, Launch, Observer, Outcome, Scene, Surface};
use coinmc_flat::{Law, Settings, SettingsError};

/// The model of the drops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// The impact law, with the initial or fixed values of its own parameters.
    pub law: Law,
    /// The coin. Its mass matters for laws that involve forces.
    pub coin: Coin,
    /// Acceleration of gravity, m/s².
    pub gravity_m_s2: f64,
}

impl Model {
    /// Checks the parameters of the law.
    ///
    /// # Errors
    /// [`SettingsError`] if one is out of range.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let settings = Settings {
            law: self.law,
            ..Settings::default()
        };
        settings.validate()
    }

    /// Simulates one drop; `None` if the values are far out of range.
    pub(crate) fn simulate(
        &self,
        shared: &Shared,
        launch: &Launch,
        observer: &mut impl Observer,
    ) -> Option<Outcome> {
        let friction = match self.law {
            Law::GaekSukhov(_) => 0.0,
            _ => shared.friction,
        };
        let surface = Surface::new(shared.restitution, friction).ok()?;
        let scene = Scene::new(self.coin, surface, self.gravity_m_s2).ok()?;
        let engine = self.settings(shared).engine(&scene).ok()?;
        Some(engine.toss(&mut (), launch, observer))
    }

    /// Finer than the default: derivatives are computed from differences, so the engine's
    /// truncation must be much smaller. (The error of an impact resolved in time is less than its
    /// tolerance: 1e-9 is 1e-4 of the step of the differences.)
    fn settings(&self, shared: &Shared) -> Settings {
        let tolerance = match self.law {
            Law::LineContact(_) => 1e-9,
            _ => 1e-10,
        };
        Settings {
            law: shared.applied(self.law),
            zeno: 1e-3,
            tolerance,
            max_impacts: 10_000,
            ..Settings::default()
        }
    }

    /// Whether its impacts cost a hundred times as much as those of other laws.
    pub(crate) fn is_costly(&self) -> bool {
        matches!(self.law, Law::LineContact(_))
    }
}
