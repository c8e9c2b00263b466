//! Noise on the serial line.

use super::Dice;

/// Damages a fraction of the bytes: a third each get a flipped bit, are dropped, or are followed by
/// a random byte.
#[derive(Debug, Clone)]
pub struct Noise {
    share: f64,
    dice: Dice,
}

impl Noise {
    /// Noise on this fraction of bytes, 0 to 1.
    pub fn new(share: f64, seed: u64, purpose: u64) -> Self {
        Self {
            share,
            dice: Dice::new(seed, purpose),
        }
    }

    /// Appends the bytes that arrive.
    pub fn pass(&mut self, bytes: &[u8], arrived: &mut Vec<u8>) {
        for &byte in bytes {
            if !self.dice.chance(self.share) {
                arrived.push(byte);
                continue;
            }
            let word = self.dice.word();
            match word % 3 {
                0 => arrived.push(byte ^ (1 << (word >> 8 & 7))),
                1 => {}
                // insert a random byte
                _ => arrived.extend([byte, word.to_le_bytes()[2]]),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fraction_of_damaged_bytes_is_as_requested() {
        let sent: Vec<u8> = (0..=255).cycle().take(100_000).collect();
        let mut arrived = Vec::new();
        Noise::new(0.0, 1, 0).pass(&sent, &mut arrived);
        assert_eq!(arrived, sent);
        // ten bytes arrive intact with probability 0.99^10 = 0.904, ± 5 standard errors of 10 000
        let mut noise = Noise::new(0.01, 1, 0);
        let whole = sent.chunks(10).filter(|piece| {
            let mut arrived = Vec::new();
            noise.pass(piece, &mut arrived);
            arrived == *piece
        });
        let whole = whole.count() as f64 / 1e4;
        assert!((whole - 0.904).abs() < 0.015, "{whole}");
    }
}
