//! The loudness of a rattle against time, in units of the room's noise.

use crate::filter::NOISE_SQUARE;
use crate::recording::Recording;
use crate::spectrum::Spectra;

/// Frequencies below this are left out.
const LEAST_HZ: f64 = 1000.0;
/// Length of a window, s: shorter than a round of the contact.
const WINDOW_S: f64 = 0.002_5;
/// Over which loudness is averaged where sound is told from silence, s.
const ACTIVE_S: f64 = 0.05;
/// Loudness of sound over that of noise.
const LOUDER: f64 = 1.2;
/// A silence that ends a sound, s.
const SILENCE_S: f64 = 0.25;
/// Over which slow changes of loudness are taken out, s.
const SLOW_S: f64 = 0.25;

/// Loudness at equal steps of time.
pub(crate) struct Envelope {
    /// Relative changes of loudness about its slow mean.
    pub(crate) ripple: Vec<f64>,
    /// Time of the first, s.
    pub(crate) start_s: f64,
    /// Time from one to the next, s.
    pub(crate) step_s: f64,
    /// Where the longest sound begins and ends, s.
    pub(crate) active_s: Option<[f64; 2]>,
}

impl Envelope {
    pub(crate) fn of(recording: &Recording) -> Self {
        let slowed = recording.slowed();
        let recording = slowed.as_ref();
        let spectra = Spectra::of(&recording.samples, recording.rate_hz, LEAST_HZ, WINDOW_S);
        let noise = spectra.noise();
        let loudness: Vec<f64> = spectra
            .frames
            .iter()
            .map(|frame| loud(frame, &noise))
            .collect();
        let step_s = spectra.hop as f64 / recording.rate_hz;
        let start_s = 0.5 * spectra.length as f64 / recording.rate_hz;
        // a click is much louder than a rattle, and says no more
        let even: Vec<f64> = loudness.iter().map(|x| libm::log1p(*x)).collect();
        let slow = smoothed(&even, width(SLOW_S, step_s));
        // nothing at all is heard where the mean is 0, and nothing changes there
        let ripple = even
            .iter()
            .zip(&slow)
            .map(|(x, slow)| if *slow > 0.0 { x / slow - 1.0 } else { 0.0 });
        let at = |place: usize| start_s + place as f64 * step_s;
        let active = longest(
            &smoothed(&loudness, width(ACTIVE_S, step_s)),
            width(SILENCE_S, step_s),
        );
        Self {
            ripple: ripple.collect(),
            start_s,
            step_s,
            active_s: active.map(|[from, to]| [at(from), at(to)]),
        }
    }
}

/// The root mean square of magnitudes in units of the noise's.
fn loud(magnitudes: &[f32], noise: &[f32]) -> f64 {
    let squares = magnitudes.iter().zip(noise).map(|(x, noise)| {
        let x = f64::from(x / noise);
        x * x
    });
    (squares.sum::<f64>() / noise.len() as f64).sqrt()
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small and positive
fn width(seconds: f64, step_s: f64) -> usize {
    ((seconds / step_s).round() as usize).max(1)
}

/// The mean of so many neighbours.
fn smoothed(values: &[f64], width: usize) -> Vec<f64> {
    let mut sums = vec![0.0];
    for value in values {
        sums.push(sums[sums.len() - 1] + value);
    }
    let of = |place: usize| {
        let from = place.saturating_sub(width / 2);
        let to = (place + width.div_ceil(2)).min(values.len());
        (sums[to] - sums[from]) / (to - from) as f64
    };
    (0..values.len()).map(of).collect()
}

/// The longest stretch of sound in which no silence is as long as this; its first and last place.
fn longest(loudness: &[f64], silence: usize) -> Option<[usize; 2]> {
    let mut best: Option<[usize; 2]> = None;
    let mut current: Option<[usize; 2]> = None;
    // noise alone has the root mean square of a Rayleigh distribution over its mean
    let bar = LOUDER * NOISE_SQUARE.sqrt();
    for place in (0..loudness.len()).filter(|place| loudness[*place] > bar) {
        let begun = current.filter(|[_, last]| place - last <= silence);
        let stretch = [begun.map_or(place, |[first, _]| first), place];
        current = Some(stretch);
        if best.is_none_or(|[from, to]| place - stretch[0] > to - from) {
            best = current;
        }
    }
    best
}
