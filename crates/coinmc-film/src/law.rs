//! The laws that can be fitted, and their parameters.
//!
//! A law that joins the flat engine is one more arm in [`parameters`] and in [`Model::follow`]; a
//! number of its own is one more [`Parameter`].

use coinmc_core::{Coin, Engine, Launch, Observer, Outcome, Scene, Surface};
use coinmc_flat::{AnyFlatEngine, Law, Settings};

/// A number that all drops of a fit share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// Coefficient of restitution e.
    Restitution,
    /// Coefficient of Coulomb friction μ.
    Friction,
    /// Height of the surface in the film's coordinates, m: nobody places the origin exactly.
    Floor,
}

impl Parameter {
    /// All parameters, in the order of every table.
    pub const ALL: [Self; 3] = [Self::Restitution, Self::Friction, Self::Floor];

    /// The name used on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Restitution => "restitution",
            Self::Friction => "friction",
            Self::Floor => "floor_m",
        }
    }

    /// The values it may take.
    pub fn range(self) -> (f64, f64) {
        match self {
            Self::Restitution => (0.0, 1.0),
            // beyond this no impact of a coin slides
            Self::Friction => (0.0, 10.0),
            Self::Floor => (f64::NEG_INFINITY, f64::INFINITY),
        }
    }

    /// Where a search begins; empty: at the value given.
    pub(crate) fn grid(self) -> &'static [f64] {
        match self {
            Self::Restitution => &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9],
            Self::Friction => &[
                0.02, 0.05, 0.08, 0.12, 0.16, 0.21, 0.27, 0.35, 0.45, 0.6, 0.9,
            ],
            Self::Floor => &[],
        }
    }

    /// What a change by one means: the unit of the search.
    pub(crate) fn scale(self, coin: &Coin) -> f64 {
        match self {
            Self::Restitution | Self::Friction => 1.0,
            Self::Floor => coin.rim_distance_m(),
        }
    }
}

/// The parameters a law depends on, and the floor on which all do.
pub fn parameters(law: Law) -> &'static [Parameter] {
    match law {
        // the paper's law has no friction; its own numbers are given, not fitted
        Law::Paper(_) => &[Parameter::Restitution, Parameter::Floor],
        Law::Moreau | Law::ChatterjeeRuina | Law::HalfSine(_) | Law::LineContact(_) => {
            &Parameter::ALL
        }
    }
}

/// A value for every parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shared {
    /// Coefficient of restitution e.
    pub restitution: f64,
    /// Coefficient of Coulomb friction μ.
    pub friction: f64,
    /// Height of the surface in the film's coordinates, m.
    pub floor_m: f64,
}

impl Shared {
    /// The value of a parameter.
    pub fn get(&self, parameter: Parameter) -> f64 {
        match parameter {
            Parameter::Restitution => self.restitution,
            Parameter::Friction => self.friction,
            Parameter::Floor => self.floor_m,
        }
    }

    /// The same with another value of a parameter.
    pub fn with(mut self, parameter: Parameter, value: f64) -> Self {
        match parameter {
            Parameter::Restitution => self.restitution = value,
            Parameter::Friction => self.friction = value,
            Parameter::Floor => self.floor_m = value,
        }
        self
    }

    /// The same with every parameter within its range.
    pub(crate) fn clamped(self) -> Self {
        Parameter::ALL.into_iter().fold(self, |shared, parameter| {
            let (low, high) = parameter.range();
            shared.with(parameter, shared.get(parameter).clamp(low, high))
        })
    }
}

/// What is known about the drops beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// The law of impact.
    pub law: Law,
    /// What was dropped.
    pub coin: Coin,
    /// Acceleration of gravity, m/s².
    pub gravity_m_s2: f64,
}

impl Model {
    /// Follows one drop; `None` where the numbers are beyond every range.
    pub(crate) fn follow(
        &self,
        shared: &Shared,
        launch: &Launch,
        observer: &mut impl Observer,
    ) -> Option<Outcome> {
        let friction = match self.law {
            Law::Paper(_) => 0.0,
            _ => shared.friction,
        };
        let surface = Surface::new(shared.restitution, friction).ok()?;
        let scene = Scene::new(self.coin, surface, self.gravity_m_s2).ok()?;
        let engine = AnyFlatEngine::new(&scene, &self.settings()).ok()?;
        Some(engine.toss(&mut (), launch, observer))
    }

    /// Finer than the default: derivatives are taken by differences, and what the engine cuts off
    /// must stay below them.
    fn settings(&self) -> Settings {
        Settings {
            law: self.law,
            zeno: 1e-3,
            tolerance: 1e-10,
            max_impacts: 10_000,
            ..Settings::default()
        }
    }
}
