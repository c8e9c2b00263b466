//! The pitch of a rattle that ends like Euler's disk, found with time bent so that it is constant.
//!
//! With f⁻³ = c (t_e − t) the contact has gone round −(3/2) c^(−1/3) (t_e − t)^(2/3) times: in the time
//! s = (t_e − t)^(2/3) the rattle repeats at the constant rate F = (3/2) c^(−1/3). In windows of s its spectrum
//! has peaks at F, 2F, 3F, …, whatever the pitch does in seconds.

use crate::envelope::Envelope;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Values in each window of s.
const VALUES: usize = 256;
/// Length of the transform: zeros after the values make the spectrum smooth.
const PADDED: usize = 2048;
/// Rates among which the median power is taken: those of coins and their harmonics.
const COMMON: [f64; 2] = [4.0, 250.0];
/// Harmonics that count.
pub(crate) const HARMONICS: usize = 3;

/// Windows of s, and the spectrum of the ripple in each.
pub(crate) struct Bent {
    /// The spectra, from early to late, in units of their medians.
    spectra: Vec<Vec<f64>>,
    /// Time before the end in the middle of each window, s.
    pub(crate) left_s: Vec<f64>,
    /// F from one value of a spectrum to the next.
    step: f64,
}

impl Bent {
    /// The ripple from `from_s` until `rest_s` before the end, in so many windows that half overlap.
    pub(crate) fn new(
        envelope: &Envelope,
        from_s: f64,
        end_s: f64,
        rest_s: f64,
        windows: usize,
    ) -> Self {
        let bend = |left: f64| libm::pow(left, 2.0 / 3.0);
        let [most, least] = [bend((end_s - from_s).max(2.0 * rest_s)), bend(rest_s)];
        let length = 2.0 * (most - least) / (windows + 1) as f64;
        let fft = FftPlanner::<f64>::new().plan_fft_forward(PADDED);
        let sums = sums(&envelope.ripple);
        let step = VALUES as f64 / (PADDED as f64 * length);
        let mut spectra = vec![];
        let mut left_s = vec![];
        for window in 0..windows {
            let first = most - 0.5 * length * window as f64;
            let at = |k: usize| libm::pow(first - length * k as f64 / VALUES as f64, 1.5);
            let mut values = vec![Complex::default(); PADDED];
            for (k, value) in values.iter_mut().enumerate().take(VALUES) {
                let mean = mean(envelope, &sums, [end_s - at(k), end_s - at(k + 1).max(0.0)]);
                let hann = 0.5 - 0.5 * libm::cos(TAU * (k as f64 + 0.5) / VALUES as f64);
                *value = Complex::new(hann * mean, 0.0);
            }
            fft.process(&mut values);
            spectra.push(in_medians(&values[..PADDED / 2], step));
            left_s.push(libm::pow(first - 0.5 * length, 1.5));
        }
        Self {
            spectra,
            left_s,
            step,
        }
    }

    pub(crate) fn windows(&self) -> usize {
        self.spectra.len()
    }

    /// How well a window fits a rattle at this rate: the logarithms of the power at its harmonics.
    pub(crate) fn score(&self, window: usize, rate: f64) -> f64 {
        let spectrum = &self.spectra[window];
        (1..=HARMONICS)
            .map(|harmonic| {
                let weight = 1.0 / (harmonic as f64).sqrt();
                weight * libm::log1p(power(spectrum, rate * harmonic as f64 / self.step))
            })
            .sum()
    }

    /// The power at the rate itself, in units of the window's median.
    pub(crate) fn fundamental(&self, window: usize, rate: f64) -> f64 {
        power(&self.spectra[window], rate / self.step)
    }

    /// The mean score of all windows.
    pub(crate) fn total(&self, rate: f64) -> f64 {
        let scores = (0..self.windows()).map(|window| self.score(window, rate));
        scores.sum::<f64>() / self.windows() as f64
    }

    /// The rate near one that fits a window best, within a share of it either way.
    pub(crate) fn refined(&self, window: usize, rate: f64, share: f64) -> f64 {
        const STEPS: u32 = 80;
        let mut best = (rate, f64::NEG_INFINITY);
        for step in 0..=STEPS {
            let tried = rate * (1.0 + share * (2.0 * f64::from(step) / f64::from(STEPS) - 1.0));
            let score = self.score(window, tried);
            if score > best.1 {
                best = (tried, score);
            }
        }
        best.0
    }
}

fn power(spectrum: &[f64], place: f64) -> f64 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // not negative
    let below = place as usize;
    let (Some(low), Some(high)) = (spectrum.get(below), spectrum.get(below + 1)) else {
        return 0.0;
    };
    let share = place - below as f64;
    low + share * (high - low)
}

/// The power of each value, in units of the median of those that may be a coin's.
fn in_medians(values: &[Complex<f64>], step: f64) -> Vec<f64> {
    let powers: Vec<f64> = values.iter().map(Complex::norm_sqr).collect();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
    let [from, to] =
        COMMON.map(|rate| (rate / step).clamp(0.0, (powers.len() - 1) as f64) as usize);
    let middle = crate::onsets::median(&mut powers[from..=to].to_vec()).max(f64::MIN_POSITIVE);
    powers.iter().map(|x| x / middle).collect()
}

fn sums(values: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0];
    for value in values {
        sums.push(sums[sums.len() - 1] + value);
    }
    sums
}

/// The mean ripple between two times; 0 outside the recording.
fn mean(envelope: &Envelope, sums: &[f64], [from_s, to_s]: [f64; 2]) -> f64 {
    let last = (sums.len() - 1) as f64;
    let place = |time: f64| ((time - envelope.start_s) / envelope.step_s + 0.5).clamp(0.0, last);
    let at = |place: f64| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // not negative
        let below = (place as usize).min(sums.len() - 2);
        sums[below] + (place - below as f64) * (sums[below + 1] - sums[below])
    };
    let [from, to] = [place(from_s), place(to_s)];
    if to <= from {
        return 0.0;
    }
    (at(to) - at(from)) / (to - from)
}
