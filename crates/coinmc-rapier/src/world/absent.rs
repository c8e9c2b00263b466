//! Stands in for the world in a build without Rapier, which rejects every scene: no method is ever
//! called.

// The signatures are those of the real world.
#![allow(clippy::unused_self)]

use crate::motion::Motion;
use crate::scaled::Scaled;
use crate::settings::Settings;

pub(crate) struct World;

impl World {
    pub(crate) fn new(_: &Scaled, _: &Settings, _: f64) -> Self {
        Self
    }

    pub(crate) fn place(&mut self, _: usize, _: &Motion) {}

    pub(crate) fn clear(&mut self, _: usize) {}

    pub(crate) fn set_velocities(&mut self, _: usize, _: &Motion) {}

    pub(crate) fn set_restitution(&mut self, _: usize, _: f64) {}

    pub(crate) fn step(&mut self) {}

    pub(crate) fn motion(&self, _: usize) -> Motion {
        Motion::NAN
    }

    pub(crate) fn normal_impulse(&self, _: usize) -> f64 {
        0.0
    }
}
