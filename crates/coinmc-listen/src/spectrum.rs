//! Short-time spectra.

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Windows in the length of one.
const OVERLAP: usize = 4;
/// Quantile of magnitudes from which noise is taken: silence fills more than that of a recording.
const QUIET_SHARE: f64 = 0.05;
/// The mean of a Rayleigh distribution over that quantile.
const MEAN_OVER_QUIET: f64 = 3.914;
/// Noise of a digital silence, in units of the greatest magnitude.
const SILENCE: f32 = 1e-4;

/// Magnitudes of the short-time Fourier transform, in Hann windows.
pub(crate) struct Spectra {
    /// Magnitudes, window by window.
    pub(crate) frames: Vec<Vec<f32>>,
    /// Samples from one window to the next.
    pub(crate) hop: usize,
    /// Samples of a window.
    pub(crate) length: usize,
    /// The lowest frequency that is kept, in units of 1/(window's duration).
    pub(crate) first: usize,
}

impl Spectra {
    /// Of the frequencies from `least_hz` on, in windows of about this length, s.
    pub(crate) fn of(samples: &[f32], rate_hz: f64, least_hz: f64, window_s: f64) -> Self {
        let length = window_length(window_s * rate_hz);
        let hop = length / OVERLAP;
        let fft: Arc<dyn Fft<f32>> = FftPlanner::new().plan_fft_forward(length);
        let window = hann(length);
        let mut buffer = vec![Complex::default(); length];
        let mut scratch = vec![Complex::default(); fft.get_inplace_scratch_len()];
        let first = first_bin(least_hz, rate_hz, length);
        let mut frames = Vec::with_capacity(samples.len() / hop + 1);
        let mut start = 0;
        while start + length <= samples.len() {
            for ((slot, sample), weight) in buffer.iter_mut().zip(&samples[start..]).zip(&window) {
                *slot = Complex::new(sample * weight, 0.0);
            }
            fft.process_with_scratch(&mut buffer, &mut scratch);
            let magnitudes = buffer[first..length / 2]
                .iter()
                .map(|c| c.norm_sqr().sqrt());
            frames.push(magnitudes.collect());
            start += hop;
        }
        Self {
            frames,
            hop,
            length,
            first,
        }
    }

    /// By how much each frequency rises from the last window but one to this, in units of the noise; falls are 0.
    pub(crate) fn rises<'a>(
        &'a self,
        window: usize,
        noise: &'a [f32],
    ) -> impl Iterator<Item = f32> + 'a {
        // the first windows rise from themselves, that is not at all
        let before = if window < 2 { window } else { window - 2 };
        let pairs = self.frames[window].iter().zip(&self.frames[before]);
        pairs
            .zip(noise)
            .map(|((now, before), noise)| ((now - before) / noise).max(0.0))
    }

    /// A window and those that begin within its length.
    pub(crate) fn after(&self, window: usize) -> &[Vec<f32>] {
        &self.frames[window..(window + OVERLAP).min(self.frames.len())]
    }

    /// The samples of a window and so many more on each side, and where they begin.
    pub(crate) fn around<'a>(
        &self,
        window: usize,
        more: usize,
        samples: &'a [f32],
    ) -> (usize, &'a [f32]) {
        let start = window * self.hop;
        let from = start.saturating_sub(more);
        let to = (start + self.length + more).min(samples.len());
        (from, &samples[from..to])
    }

    /// Magnitude of the noise at each frequency: the mean of what the quietest windows have. Digital silence that a
    /// program adds, or a microphone begins with, tells nothing of it; where it is the most of a recording, the noise is
    /// left out there, and there is none.
    pub(crate) fn noise(&self) -> Vec<f32> {
        let bins = self.frames.first().map_or(0, Vec::len);
        let all = self.frames.iter().flatten();
        let least = SILENCE * all.fold(0.0_f32, |most, x| most.max(*x));
        let is_heard = |frame: &&Vec<f32>| frame.iter().any(|x| *x > 0.0);
        let mut heard: Vec<_> = self.frames.iter().filter(is_heard).collect();
        if 2 * heard.len() < self.frames.len() {
            heard = self.frames.iter().collect();
        }
        let of = |bin: usize| {
            let mut at: Vec<f32> = heard.iter().map(|frame| frame[bin]).collect();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let place = (QUIET_SHARE * at.len() as f64) as usize;
            let (_, quiet, _) = at.select_nth_unstable_by(place, f32::total_cmp);
            #[allow(clippy::cast_possible_truncation)]
            let noise = MEAN_OVER_QUIET as f32 * *quiet;
            noise.max(least).max(f32::MIN_POSITIVE)
        };
        (0..bins).map(of).collect()
    }
}

/// The power of two nearest to the length that is wanted, as a ratio.
fn window_length(wanted: f64) -> usize {
    let mut length = 32;
    while (length as f64) * std::f64::consts::SQRT_2 < wanted {
        length *= 2;
    }
    length
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small and positive
fn first_bin(least_hz: f64, rate_hz: f64, length: usize) -> usize {
    let bin = (least_hz * length as f64 / rate_hz).ceil() as usize;
    bin.clamp(1, length / 4)
}

#[allow(clippy::cast_possible_truncation)]
fn hann(length: usize) -> Vec<f32> {
    let at = |k: usize| 0.5 - 0.5 * libm::cos(TAU * (k as f64 + 0.5) / length as f64);
    (0..length).map(|k| at(k) as f32).collect()
}
