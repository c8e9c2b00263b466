//! What is known about the drops beforehand: the law, the coin and gravity.
//!
//! A law that joins the flat engine is one more arm in [`parameters`](crate::parameters) and where
//! [`Shared`] takes its numbers; a number of its own is one more [`Parameter`](crate::Parameter).

use crate::parameter::Shared;
use coinmc_core::{Coin, Engine, Launch, Observer, Outcome, Scene, Surface};
use coinmc_flat::{AnyFlatEngine, Law, Settings, SettingsError};

/// What is known about the drops beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// The law of impact, with the numbers of its own that a fit begins with or keeps.
    pub law: Law,
    /// What was dropped. Its mass matters for laws that name forces.
    pub coin: Coin,
    /// Acceleration of gravity, m/s².
    pub gravity_m_s2: f64,
}

impl Model {
    /// Checks the numbers of the law.
    ///
    /// # Errors
    /// [`SettingsError`] if one is out of its range.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let settings = Settings {
            law: self.law,
            ..Settings::default()
        };
        settings.validate()
    }

    /// Follows one drop; `None` where the numbers are beyond every range.
    pub(crate) fn follow(
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
        let engine = AnyFlatEngine::new(&scene, &self.settings(shared)).ok()?;
        Some(engine.toss(&mut (), launch, observer))
    }

    /// Finer than the default: derivatives are taken by differences, and what the engine cuts off
    /// must stay below them. (An impact resolved in time errs by less than its tolerance: 1e-9 is
    /// the 1e-4th part of what the differences step.)
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

    /// Whether its impacts cost a hundred times those of the others.
    pub(crate) fn is_costly(&self) -> bool {
        matches!(self.law, Law::LineContact(_))
    }
}
