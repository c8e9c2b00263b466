//! A filter matched to the sound of this coin on this table.
//!
//! A coin rings at a few frequencies. Measure the magnitude at each frequency in units of the noise there: of all
//! weighted sums of these, the one weighted by the sound's own magnitudes stands out most (the matched filter; Turin,
//! IRE Trans. Inf. Theory 6 (1960) 311). The loudest impact says what they are; all others of a recording ring alike.
//!
//! # What noise reaches
//! The magnitude R of Gaussian noise has a Rayleigh distribution. In units of its mean, R² has the mean 4/π, and the
//! smaller of two the mean 1/√2. So its rise (R₁ − R₂)₊ from one window to the next but one, which is nearly
//! independent, has the mean m = ½ E|R₁ − R₂| = 1 − 1/√2 and the variance ½ E(R₁ − R₂)² − m² = 4/π − 1 − m². In Hann
//! windows neighbouring frequencies have the correlation 2/3, the next 1/6, and their powers the squares of these;
//! rises are correlated about as powers are.

use crate::spectrum::Spectra;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// The mean square of the magnitude of noise, in units of its mean.
pub(crate) const NOISE_SQUARE: f64 = 4.0 / PI;
/// The mean of its rise.
pub(crate) const NOISE_RISE: f64 = 1.0 - FRAC_1_SQRT_2;
/// Correlations of the rises at one frequency, the next and the next but one, in Hann windows; those of two
/// frequencies twice, as the square of a sum has each pair twice.
const CORRELATIONS: [f64; 3] = [1.0, 2.0 * 4.0 / 9.0, 2.0 / 36.0];

/// What each frequency of the spectra counts for.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Filter {
    /// Of magnitudes in units of the noise; they add up to 1.
    weights: Vec<f32>,
    /// Of the magnitudes themselves: weight over noise.
    gains: Vec<f32>,
}

impl Filter {
    /// All frequencies count alike.
    pub(crate) fn even(noise: &[f32]) -> Self {
        Self::of(vec![1.0; noise.len()], noise)
    }

    /// Each counts as it rises in one window.
    pub(crate) fn matched(spectra: &Spectra, noise: &[f32], window: usize) -> Self {
        Self::of(spectra.rises(window, noise).collect(), noise)
    }

    fn of(mut weights: Vec<f32>, noise: &[f32]) -> Self {
        let sum: f32 = weights.iter().sum();
        if sum > 0.0 {
            for weight in &mut weights {
                *weight /= sum;
            }
        }
        let gains = weights.iter().zip(noise).map(|(w, noise)| w / noise);
        Self {
            gains: gains.collect(),
            weights,
        }
    }

    /// The weighted mean of values at each frequency.
    pub(crate) fn mean(&self, values: impl Iterator<Item = f32>) -> f64 {
        let weighted = values.zip(&self.weights);
        weighted.map(|(x, w)| f64::from(x * w)).sum()
    }

    /// The weighted root mean square of the magnitudes of a window, in units of the noise.
    pub(crate) fn level(&self, frame: &[f32], noise: &[f32]) -> f64 {
        let ratios = frame.iter().zip(noise).map(|(x, noise)| x / noise);
        self.mean(ratios.map(|x| x * x)).sqrt()
    }

    /// The mean of the rises of noise, and so many standard deviations more.
    pub(crate) fn most_of_noise(&self, deviations: f64) -> f64 {
        let product = |apart: usize| -> f64 {
            let pairs = self.weights.iter().zip(self.weights.iter().skip(apart));
            pairs.map(|(a, b)| f64::from(a * b)).sum()
        };
        let shared = CORRELATIONS.iter().enumerate();
        let shared: f64 = shared.map(|(apart, c)| c * product(apart)).sum();
        let variance = NOISE_SQUARE - 1.0 - NOISE_RISE * NOISE_RISE;
        NOISE_RISE + deviations * (variance * shared).sqrt()
    }

    /// The amplitude of samples behind this filter, which delays nothing: the absolute value of the analytic signal,
    /// in arbitrary units.
    pub(crate) fn amplitudes(
        &self,
        samples: &[f32],
        spectra: &Spectra,
        planner: &mut FftPlanner<f32>,
    ) -> Vec<f64> {
        let length = (2 * samples.len()).next_power_of_two();
        let mut buffer = vec![Complex::new(0.0_f32, 0.0); length];
        for (slot, sample) in buffer.iter_mut().zip(samples) {
            slot.re = *sample;
        }
        planner.plan_fft_forward(length).process(&mut buffer);
        let finer = length as f64 / spectra.length as f64;
        for (place, slot) in buffer.iter_mut().enumerate() {
            *slot *= self.gain(place as f64 / finer - spectra.first as f64);
        }
        planner.plan_fft_inverse(length).process(&mut buffer);
        let amplitude = |c: &Complex<f32>| f64::from(c.norm_sqr().sqrt());
        buffer[..samples.len()].iter().map(amplitude).collect()
    }

    /// The gain between two frequencies of the spectra; none beyond them.
    fn gain(&self, place: f64) -> f32 {
        if place < 0.0 {
            return 0.0;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within a buffer
        let below = place as usize;
        #[allow(clippy::cast_possible_truncation)]
        let share = (place - below as f64) as f32;
        let at = |place: usize| self.gains.get(place).copied().unwrap_or(0.0);
        (1.0 - share) * at(below) + share * at(below + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const RATE_HZ: f64 = 44_100.0;

    /// A tone that begins in the middle, and what is to be heard beside it.
    fn sound(tone_hz: f64, beside: impl Fn(f64) -> f64) -> Vec<f32> {
        let at = |n: i32| {
            let t = f64::from(n) / RATE_HZ;
            let tone = if n < 1024 {
                0.0
            } else {
                libm::sin(TAU * tone_hz * t)
            };
            #[allow(clippy::cast_possible_truncation)]
            let sample = (tone + beside(t)) as f32;
            sample
        };
        (0..2048).map(at).collect()
    }

    /// A filter that is matched to one tone hears it, when it begins, and not a tone three times as loud elsewhere.
    #[test]
    fn a_matched_filter_hears_one_tone() {
        let alone = sound(8000.0, |_| 0.0);
        let spectra = Spectra::of(&alone, RATE_HZ, 1500.0, 0.005_8);
        let noise = vec![1.0; spectra.frames[0].len()];
        let window = (1024 + spectra.length / 2 - spectra.length) / spectra.hop;
        let filter = Filter::matched(&spectra, &noise, window);
        let total = filter.mean(std::iter::repeat(1.0));
        assert!((total - 1.0).abs() < 1e-6, "{total}");
        let both = sound(8000.0, |t| 3.0 * libm::sin(TAU * 3000.0 * t));
        let amplitudes = filter.amplitudes(&both, &spectra, &mut FftPlanner::new());
        let steady = amplitudes[1400];
        let half = amplitudes.iter().position(|a| *a > 0.5 * steady).unwrap();
        assert!((half as f64 - 1024.0).abs() < 0.001 * RATE_HZ, "{half}");
        assert!(
            amplitudes[700] < 0.1 * steady,
            "{}",
            amplitudes[700] / steady
        );
    }

    /// The even filter is the mean, and the root mean square, in units of the noise.
    #[test]
    fn the_even_filter_is_the_mean() {
        let noise = vec![0.5_f32, 2.0, 1.0];
        let even = Filter::even(&noise);
        let mean = even.mean([3.0_f32, 6.0, 9.0].into_iter());
        assert!((mean - 6.0).abs() < 1e-6, "{mean}");
        let level = even.level(&[0.5, 4.0, 2.0], &noise);
        assert!((level - 3.0_f64.sqrt()).abs() < 1e-6, "{level}");
    }

    /// Between two frequencies the gain is that of the line between them, and beyond the last it falls to none.
    #[test]
    fn gains_lie_on_lines() {
        let filter = Filter {
            weights: vec![],
            gains: vec![1.0, 3.0],
        };
        for (place, gain) in [
            (-0.5, 0.0),
            (0.0, 1.0),
            (0.25, 1.5),
            (1.0, 3.0),
            (1.5, 1.5),
            (7.0, 0.0),
        ] {
            assert!((filter.gain(place) - gain).abs() < 1e-6, "{place}");
        }
    }

    /// In white noise the mean and the deviation of the flux are those of the module's text, behind an even filter
    /// and behind those of one and of four frequencies.
    #[test]
    fn noise_reaches_what_is_derived() {
        let stream = coinmc_core::Philox4x64::new([5, 6]);
        let at = |n: u64| {
            let word = stream.block([n, 0, 0, 0])[0];
            #[allow(clippy::cast_possible_truncation)]
            let sample = coinmc_core::inverse_normal_cdf(coinmc_core::unit_interval(word)) as f32;
            sample
        };
        let samples: Vec<f32> = (0..200_000).map(at).collect();
        let spectra = Spectra::of(&samples, RATE_HZ, 1500.0, 0.005_8);
        let bins = spectra.frames[0].len();
        let count = spectra.frames.len() as f64;
        let mean = |bin: usize| {
            let all = spectra.frames.iter().map(|frame| f64::from(frame[bin]));
            #[allow(clippy::cast_possible_truncation)]
            let mean = (all.sum::<f64>() / count) as f32;
            mean
        };
        let noise: Vec<f32> = (0..bins).map(mean).collect();
        for wide in [bins, 1, 4] {
            let weights = (0..bins).map(|bin| if bin < wide { 1.0 } else { 0.0 });
            let filter = Filter::of(weights.collect(), &noise);
            let flux = (2..spectra.frames.len()).map(|n| filter.mean(spectra.rises(n, &noise)));
            let flux: Vec<f64> = flux.collect();
            let middle = flux.iter().sum::<f64>() / flux.len() as f64;
            let squares = flux.iter().map(|x| (x - middle) * (x - middle));
            let deviation = (squares.sum::<f64>() / flux.len() as f64).sqrt();
            let derived = filter.most_of_noise(1.0) - NOISE_RISE;
            assert!((middle / NOISE_RISE - 1.0).abs() < 0.05, "{wide}: {middle}");
            assert!(
                (deviation / derived - 1.0).abs() < 0.12,
                "{wide}: {deviation} {derived}"
            );
        }
    }
}
