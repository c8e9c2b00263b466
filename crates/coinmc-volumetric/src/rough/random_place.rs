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

#[cfg(test)]
mod tests {
    use super::super::test_scenes::Rough;
    use super::*;

    fn ground() -> Ground {
        Rough::of(0.7, 0.02).model().ground.expect("a rough ground")
    }

    fn motion(number: f64) -> Motion<f64> {
        let count = std::cell::Cell::new(0.0);
        let next = || {
            count.set(count.get() + 1.0);
            0.1 * count.get() + 1e-3 * number
        };
        Motion::from_columns(&std::array::from_fn(|_| next()))
    }

    /// Places are spread evenly over the whole field, headings over all directions, and the numbers from 0 to 1: means and mean
    /// squares of 4,000, each within four standard errors.
    #[test]
    fn places_and_headings_are_spread_evenly() {
        let (ground, count) = (ground(), 4_000);
        let side = HeightField::LENGTH * ground.length;
        let mut sums = [[0.0; 2]; 5];
        for number in 0..count {
            let (place, uniform) = ground.random_place(&motion(f64::from(number)), 0);
            let ([x, y], [cos, sin]) = (place.point(0.0, 0.0), place.direction(1.0, 0.0));
            assert!((cos * cos + sin * sin - 1.0).abs() < 1e-12);
            // all from −1 to 1 and even, with the variance 1/3, but for the heading's 1/2
            let even = [
                2.0 * x / side - 1.0,
                2.0 * y / side - 1.0,
                2.0 * uniform - 1.0,
            ];
            for (i, number) in [even[0], even[1], even[2], cos, sin]
                .into_iter()
                .enumerate()
            {
                assert!(number.abs() <= 1.0, "{number}");
                sums[i][0] += number;
                sums[i][1] += number * number;
            }
        }
        let error = 1.0 / f64::from(count).sqrt();
        for (i, sums) in sums.into_iter().enumerate() {
            let [mean, square] = sums.map(|sum| sum / f64::from(count));
            let variance: f64 = if i < 3 { 1.0 / 3.0 } else { 0.5 };
            assert!(mean.abs() < 4.0 * variance.sqrt() * error, "{i}: {mean}");
            // the fourth moments are 1/5 and 3/8
            assert!(
                (square - variance).abs() < 4.0 * 0.36 * error,
                "{i}: {square}"
            );
        }
    }

    /// The same motion lands at the same place; any other number of it, or another draw, elsewhere. The sign of a zero does not
    /// count.
    #[test]
    fn a_place_belongs_to_a_motion_and_a_draw() {
        let ground = ground();
        let at = |motion: &Motion<f64>, draw| ground.random_place(motion, draw).0.point(0.0, 0.0);
        let mut places = vec![
            at(&motion(0.0), 0),
            at(&motion(0.0), 1),
            at(&motion(0.0), 2),
        ];
        assert_eq!(at(&motion(0.0), 0), places[0]);
        let mut turned = motion(0.0);
        for i in 0..9 {
            let mut columns = motion(0.0).columns();
            columns[i] += 1e-12;
            turned = Motion::from_columns(&columns);
            places.push(at(&turned, 0));
        }
        // the height is that above the ground, which is not known yet
        let same = places.iter().filter(|place| **place == places[0]).count();
        assert_eq!(same, 2, "{places:?}");
        for (i, one) in places.iter().enumerate() {
            let twins = places[i + 1..].iter().filter(|other| *other == one).count();
            assert_eq!(twins, usize::from(i == 0), "{i}");
        }
        let [mut plus, mut minus] = [turned; 2];
        (plus.vx, minus.vx) = (0.0, -0.0);
        assert_eq!(at(&plus, 0), at(&minus, 0));
    }
}
