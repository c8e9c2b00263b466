//! Random numbers of a trial.

use crate::stream;
use coinmc_core::{TossUniforms, UniformSource};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// The random numbers of one trial, in sequence.
pub struct Dice {
    uniforms: TossUniforms,
    next: u32,
}

impl Dice {
    /// The same sequence for the same seed and trial.
    pub fn new(seed: u64, trial: u64) -> Self {
        Self {
            uniforms: stream(seed).toss(trial),
            next: 0,
        }
    }

    /// Uniform.
    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        self.next += 1;
        from + (to - from) * self.uniforms.uniform(self.next - 1)
    }

    /// Log-uniform.
    pub fn scale(&mut self, from: f64, to: f64) -> f64 {
        libm::exp(self.between(libm::log(from), libm::log(to)))
    }

    /// One of the choices, each equally likely.
    pub fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        // the share lies in (0, 1): the index within the slice
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let index = (self.between(0.0, 1.0) * choices.len() as f64) as usize;
        choices[index.min(choices.len() - 1)]
    }

    /// True half of the time.
    pub fn chance(&mut self) -> bool {
        self.between(0.0, 1.0) < 0.5
    }

    /// Uniform on the sphere.
    pub fn direction(&mut self) -> Vector3<f64> {
        let z = self.between(-1.0, 1.0);
        let (sin, cos) = libm::sincos(self.between(0.0, TAU));
        let s = ((1.0 - z) * (1.0 + z)).sqrt();
        Vector3::new(s * cos, s * sin, z)
    }

    /// Uniform in the cube of half width `size`.
    pub fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.between(-size, size))
    }
}
