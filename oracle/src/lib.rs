//! Independent oracles of the toss in space: slow, plain, and sharing no formula with the engine.
//!
//! The engine works in a triad that turns with the coin, goes from event to event and integrates
//! contact with a Runge–Kutta pair. Here everything is a vector in the laboratory:
//!
//! * [`TimeStepper`] follows whole tosses in fixed steps, with the set-valued laws of contact
//!   solved implicitly (Moreau–Jean), without modes or equations of rolling, and decides
//!   by energy alone.
//! * [`RoughStepper`] does the same on an explicit [`Ground`], a random height field.
//! * [`newton_euler`] solves the six equations of motion and the contact's constraints as one
//!   linear system, with which the right-hand sides of sustained contact must agree.
//! * [`textbook`] holds the known answers: steady precession, Euler's disk, spun coins, wheels.
//!
//! # Units
//! Lengths in D = sqrt(R² + H²/4), times in sqrt(D/g), masses in m: g = 1 and the barrier between
//! face and side is an energy of 1. [`Model`] holds the scene in these units, [`Motion`] a state.
//!
//! # Example
//! ```
//! use coinmc_core::{Coin, Face, Launch, Scene, Surface};
//! use coinmc_oracle::{StepperSettings, TimeStepper};
//! use nalgebra::Vector3;
//!
//! let surface = Surface::new(0.0, 0.3)?;
//! let scene = Scene::new(Coin::cylinder(0.2, 0.01)?, surface, Scene::STANDARD_GRAVITY_M_S2)?;
//! let launch = Launch {
//!     height_m: 0.05,
//!     velocity_m_s: Vector3::zeros(),
//!     axis: Vector3::z_axis(),
//!     spin_rad_s: Vector3::zeros(),
//! };
//! let mut stepper = TimeStepper::new(&scene, StepperSettings::default());
//! assert_eq!(stepper.toss(&launch).face, Some(Face::Heads));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod coulomb;
mod decision;
mod ground;
mod impact;
mod model;
mod motion;
pub mod newton_euler;
mod points;
mod rough;
mod stepper;
pub mod textbook;
mod triad;

pub use ground::{Ground, Relief};
pub use model::Model;
pub use motion::Motion;
pub use rough::{Ending, RoughHistory, RoughSettings, RoughStepper, Start};
pub use stepper::{History, StepperSettings, TimeStepper};
pub use triad::{Triad, triad};
