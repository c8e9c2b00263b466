//! Random numbers for faults, reproducible by seed.

use coinmc_core::{Philox4x64, unit_interval};

/// A sequence of random numbers that depends only on its seed and purpose.
#[derive(Debug, Clone)]
pub struct Dice {
    philox: Philox4x64,
    block: [u64; 4],
    next: u64,
}

impl Dice {
    /// The sequence of a seed and purpose; different purposes are independent.
    pub fn new(seed: u64, purpose: u64) -> Self {
        Self {
            // the high word of the key separates them from the launches of the same seed
            philox: Philox4x64::new([seed, purpose.wrapping_add(1)]),
            block: [0; 4],
            next: 0,
        }
    }

    /// 64 random bits.
    pub fn word(&mut self) -> u64 {
        if self.next.is_multiple_of(4) {
            self.block = self.philox.block([self.next / 4, 0, 0, 0]);
        }
        let word = self.block[(self.next % 4) as usize];
        self.next += 1;
        word
    }

    /// Uniform in (0, 1).
    pub fn uniform(&mut self) -> f64 {
        unit_interval(self.word())
    }

    /// True with this probability.
    pub fn chance(&mut self, p: f64) -> bool {
        // an impossible event draws no number
        p > 0.0 && self.uniform() < p
    }

    /// Exponential waiting time with this mean.
    pub fn wait(&mut self, mean: f64) -> f64 {
        -mean * libm::log(self.uniform())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sequences_repeat_and_differ_by_seed_and_purpose() {
        let first = |seed, purpose| {
            let mut dice = Dice::new(seed, purpose);
            [(); 9].map(|()| dice.word())
        };
        assert_eq!(first(1, 2), first(1, 2));
        assert!(first(1, 2) != first(2, 2) && first(1, 2) != first(1, 3));
        let mut dice = Dice::new(1, 0);
        let mean = (0..10_000).map(|_| dice.wait(3.0)).sum::<f64>() / 1e4;
        assert!((mean - 3.0).abs() < 0.15, "{mean}"); // five standard errors
    }
}
