//! In a precision that was not built.

use super::World;
use crate::motion::Motion;

/// A world without a coin. Settings that ask for it are refused, so that no engine has one.
pub(crate) struct Nowhere;

impl World for Nowhere {
    fn place(&mut self, _: usize, _: &Motion) {}

    fn leave(&mut self, _: usize) {}

    fn set_restitution(&mut self, _: usize, _: f64) {}

    fn set_velocities(&mut self, _: usize, _: &Motion) {}

    fn step(&mut self) {}

    fn motion(&self, _: usize) -> Motion {
        Motion::NONE
    }

    fn impulse(&self, _: usize) -> f64 {
        0.0
    }
}
