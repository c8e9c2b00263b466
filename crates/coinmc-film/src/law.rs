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

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Event, State};
    use coinmc_flat::{LineContact, Materials};
    use nalgebra::{UnitVector3, Vector3};

    /// States of a drop every millisecond, until its face is decided.
    #[derive(Default)]
    struct Film(Vec<State>);

    impl Observer for Film {
        fn event(&mut self, _: &Event) {}

        fn wants_at_s(&self) -> f64 {
            1e-3 * self.0.len() as f64
        }

        fn sample(&mut self, state: &State) {
            self.0.push(*state);
        }
    }

    fn film(settings: &Settings, scene: &Scene, theta: f64) -> Vec<State> {
        let (sin, cos) = libm::sincos(theta);
        let launch = Launch {
            height_m: 0.1,
            velocity_m_s: Vector3::new(0.1, 0.0, 0.0),
            axis: UnitVector3::new_unchecked(Vector3::new(sin, 0.0, cos)),
            spin_rad_s: Vector3::new(0.0, 2.0, 0.0),
        };
        let mut film = Film::default();
        let engine = settings.engine(scene).expect("valid settings");
        engine.toss(&mut (), &launch, &mut film);
        film.0
    }

    /// The longest way between the ends of two axes, at the same time.
    fn apart(some: &[State], others: &[State]) -> f64 {
        let pairs = some.iter().zip(others);
        pairs
            .map(|(a, b)| (*a.axis - *b.axis).norm())
            .fold(0.0, f64::max)
    }

    /// A path does not depend on where sustained contact replaces bounces, nor on the steps of an
    /// integration, within the step of the differences: less than a hundredth of that for most of these
    /// drops, and at most a quarter where many bounces follow. With the engine's defaults it does.
    #[test]
    fn paths_are_exact_enough_for_differences() {
        let materials = Materials {
            coin_young_pa: 3e9,
            coin_poisson: 0.35,
            surface_young_pa: 1e10,
            surface_poisson: 0.35,
            length_m: 0.02,
        };
        let coin = Coin::cylinder(1.0, 0.01).expect("a coin");
        let model = Model {
            law: Law::LineContact(LineContact {
                materials,
                tangential: LineContact::mindlin(0.35),
            }),
            coin: coin.with_mass(0.01).expect("a mass"),
            gravity_m_s2: 9.81,
        };
        let shared = Shared {
            friction: 0.1,
            ..Shared::default()
        }
        .of(model.law);
        let surface = Surface::new(shared.restitution, shared.friction).expect("a surface");
        let scene = Scene::new(model.coin, surface, model.gravity_m_s2).expect("a scene");
        let usual = model.settings(&shared);
        let exact = Settings {
            zeno: 1e-5,
            tolerance: 1e-12,
            ..usual
        };
        for number in 0..12 {
            let theta = 0.1 + 0.25 * f64::from(number);
            let [usual, exact] = [usual, exact].map(|settings| film(&settings, &scene, theta));
            let error = apart(&usual, &exact);
            assert!(error < 1e-5, "{theta}: {error:e}");
        }
    }
}
