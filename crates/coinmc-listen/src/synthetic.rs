//! Recordings of simulated tosses, for trying and measuring what listens.
//!
//! Each strike rings the modes of the coin, a free round plate (Leissa 1969), and thuds the table, in
//! proportion to its impulse. A room answers with echoes, noise is added, and what is too loud is clipped.

use crate::rattle::rattle;
use crate::recording::Recording;
use crate::struck::{Strike, StruckError, Tosser};
use coinmc::plan::Point;
use coinmc_core::{Coin, Launch, Philox4x64, inverse_normal_cdf, unit_interval};
use rustfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Squares of the lowest eigenvalues of a free round plate with ν = 0.33.
const PLATE: [f64; 4] = [5.253, 9.084, 12.23, 20.52];
/// sqrt(E/(12 ρ (1 − ν²))) of brass, m/s.
const BRASS_M_S: f64 = 1107.0;
/// In which its modes decay by e, s: it touches the table now and then.
const COIN_DECAY_S: f64 = 0.012;
/// Modes of a table, Hz, and in which they decay by e, s.
const TABLE: [f64; 3] = [420.0, 1150.0, 2600.0];
const TABLE_DECAY_S: f64 = 0.005;
/// Delays, s, and shares of the echoes of a small room.
const ECHOES: [[f64; 2]; 4] = [[0.0071, 0.5], [0.0113, 0.35], [0.0187, 0.2], [0.031, 0.1]];
/// Longest sound, s.
const LONGEST_S: f64 = 60.0;
/// Second word of the key of the noise.
const KEY: u64 = 0x6e6f_6973;

/// How a toss is recorded. All noise is drawn from the seed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Synthetic {
    /// Seed of the noise.
    pub seed: u64,
    /// Samples a second.
    pub rate_hz: u32,
    /// Power of the toss, from its first sound until it rests, over that of the noise, dB.
    pub signal_to_noise_db: f64,
    /// How strong the room's echoes are: 0 for none, 1 for a bare room.
    pub echo: f64,
    /// Peak of the sound in units of the full scale: beyond 1 it is clipped.
    pub peak: f64,
    /// Silence before the first sound and after the last, s.
    pub silence_s: f64,
}

impl Default for Synthetic {
    fn default() -> Self {
        Self {
            seed: 1,
            rate_hz: 44_100,
            signal_to_noise_db: 30.0,
            echo: 0.3,
            peak: 0.7,
            silence_s: 0.5,
        }
    }
}

impl Synthetic {
    /// The sound of one toss of a point.
    ///
    /// # Errors
    /// [`StruckError`] if the scene makes no tosses.
    pub fn recording(&self, point: &Point, launch: &Launch) -> Result<Recording, StruckError> {
        let tosser = Tosser::new(point)?;
        let coin = &point.scene.coin;
        let (strikes, end_s) = rattle(&tosser, coin, launch, self.seed);
        let first = strikes.first().map_or(0.0, |strike| strike.time_s);
        let length = (end_s - first).min(LONGEST_S);
        Ok(self.of_strikes(coin, &strikes, [first, first + length]))
    }

    /// The sound of strikes between two times.
    pub(crate) fn of_strikes(
        &self,
        coin: &Coin,
        strikes: &[Strike],
        [from, to]: [f64; 2],
    ) -> Recording {
        let rate = f64::from(self.rate_hz);
        let total = samples((to - from + 2.0 * self.silence_s) * rate);
        let pushes = strikes.iter().map(|strike| {
            let at = (strike.time_s - from + self.silence_s) * rate;
            (at, strike.speed_m_s)
        });
        let dry = rung(coin, &pushes.collect::<Vec<_>>(), rate, total);
        let mut sound = self.with_echoes(&dry);
        let first = samples(self.silence_s * rate);
        let last = (total - first).max(first + 1).min(total);
        let power =
            |part: &[f64]| part.iter().map(|x| x * x).sum::<f64>() / part.len().max(1) as f64;
        let loud = power(&sound[first..last]);
        let noise = self.noise(total);
        let ratio = libm::pow(10.0, 0.1 * self.signal_to_noise_db);
        let scale = (loud / (ratio * power(&noise).max(f64::MIN_POSITIVE))).sqrt();
        for (sample, noise) in sound.iter_mut().zip(&noise) {
            *sample += scale * noise;
        }
        let most = sound
            .iter()
            .fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
        #[allow(clippy::cast_possible_truncation)]
        let level = |x: &f64| (x * self.peak / most).clamp(-1.0, 1.0) as f32;
        Recording::of_samples("synthetic", rate, sound.iter().map(level).collect())
    }

    fn with_echoes(&self, dry: &[f64]) -> Vec<f64> {
        let mut wet = dry.to_vec();
        for [delay, share] in ECHOES {
            let shift = samples(delay * f64::from(self.rate_hz));
            for (slot, sample) in wet.iter_mut().skip(shift).zip(dry) {
                *slot += self.echo * share * sample;
            }
        }
        wet
    }

    /// Noise of a room: white, and as much again at low frequencies.
    fn noise(&self, length: usize) -> Vec<f64> {
        let philox = Philox4x64::new([self.seed, KEY]);
        let normal = |k: usize, word: usize| {
            inverse_normal_cdf(unit_interval(philox.block([k as u64, 0, 0, 0])[word]))
        };
        // a pole at 200 Hz, which gives the power of the white noise
        let pole = libm::exp(-TAU * 200.0 / f64::from(self.rate_hz));
        let drive = (1.0 - pole * pole).sqrt();
        let mut low = 0.0;
        let sample = |k: usize| {
            low = pole * low + drive * normal(k, 1);
            normal(k, 0) + low
        };
        (0..length).map(sample).collect()
    }
}

/// Pushes, each at a number of samples, as a coin and a table answer them: the modes below the highest frequency that
/// the rate holds.
fn rung(coin: &Coin, pushes: &[(f64, f64)], rate: f64, total: usize) -> Vec<f64> {
    let plate = BRASS_M_S * coin.height_m() / (TAU * coin.radius_m() * coin.radius_m());
    let ring = PLATE.iter().map(|square| (square * plate, COIN_DECAY_S));
    let thud = TABLE.iter().map(|frequency| (*frequency, TABLE_DECAY_S));
    let mut sound = vec![0.0; total];
    for (frequency, decay_s) in ring.chain(thud).filter(|(f, _)| *f < 0.45 * rate) {
        // exp(−t/decay) sin(2π f t) from each push on, wherever it lies between two samples
        let after = |samples: f64| {
            let shrink = libm::exp(-samples / (decay_s * rate));
            let (sin, cos) = libm::sincos(TAU * frequency * samples / rate);
            Complex::new(shrink * cos, shrink * sin)
        };
        let mut begins = vec![Complex::new(0.0, 0.0); total];
        for (at, push) in pushes {
            if let Some(slot) = begins.get_mut(samples(at.ceil())) {
                *slot += after(at.ceil() - at) * *push;
            }
        }
        let step = after(1.0);
        let mut now = Complex::new(0.0, 0.0);
        for (slot, begin) in sound.iter_mut().zip(&begins) {
            now = now * step + begin;
            *slot += now.im;
        }
    }
    sound
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
fn samples(number: f64) -> usize {
    number.clamp(0.0, 1e9) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A push between two samples rings from its own instant on; one after the end is not heard.
    #[test]
    fn a_strike_between_samples_rings_from_its_instant() {
        let coin = Coin::cylinder(0.16, 0.0116).unwrap();
        let rate = 44_100.0;
        let sound = rung(&coin, &[(10.25, 2.0), (70.0, 1.0)], rate, 64);
        let plate = BRASS_M_S * coin.height_m() / (TAU * coin.radius_m() * coin.radius_m());
        let ring = PLATE.iter().map(|square| (square * plate, COIN_DECAY_S));
        let thud = TABLE.iter().map(|frequency| (*frequency, TABLE_DECAY_S));
        let modes: Vec<_> = ring.chain(thud).filter(|(f, _)| *f < 0.45 * rate).collect();
        assert_eq!(modes.len(), 1 + TABLE.len());
        for (n, sample) in sound.iter().enumerate() {
            let t = (n as f64 - 10.25) / rate;
            let of = |(f, decay_s): &(f64, f64)| libm::exp(-t / decay_s) * libm::sin(TAU * f * t);
            let exact = if t < 0.0 {
                0.0
            } else {
                2.0 * modes.iter().map(of).sum::<f64>()
            };
            assert!((sample - exact).abs() < 1e-12, "{n}: {sample} {exact}");
        }
    }
}
