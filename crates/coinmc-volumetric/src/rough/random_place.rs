//! Where on the field a coin is.

use super::field::HeightField;
use super::ground::Ground;
use crate::motion::Motion;
use crate::place::Place;
use coinmc_core::{Philox4x64, unit_interval};
use std::f64::consts::TAU;

/// The key of the random numbers.
const KEY: [u64; 2] = [0x706c_6163_6520_6f6e, 0x2067_726f_756e_6420];

impl Ground {
    /// A place anywhere on the field and a heading in any direction, drawn by a counter-based
    /// generator whose counter is the motion: the same motion gives the same place on any thread
    /// and in any lane, and mirror images give the same. Also a number from 0 to 1; every draw gives others.
    pub(super) fn random_place(&self, motion: &Motion<f64>, draw: u64) -> (Place, f64) {
        let bits = |number: f64| (number + 0.0).to_bits();
        let philox = Philox4x64::new([KEY[0], KEY[1].wrapping_add(draw)]);
        let [a, b, c, d] = philox.block([motion.vx, motion.vy, motion.vz, motion.sin].map(bits));
        let words = [motion.ox, motion.oy, motion.oz, motion.cos].map(bits);
        let mixed = [a ^ words[0], b ^ words[1], c ^ words[2], d ^ words[3]];
        let [x, y, angle, uniform] = philox.block(mixed).map(unit_interval);
        let (sin, cos) = libm::sincos(TAU * angle);
        let side = HeightField::LENGTH * self.length;
        (Place::at([x * side, y * side], [cos, sin]), uniform)
    }
}
