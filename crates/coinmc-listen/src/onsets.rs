//! When something strikes: onsets in a recording.
//!
//! Spectral flux (Bello et al., IEEE Trans. Speech Audio Process. 13 (2005) 1035; Dixon, DAFx 2006) of
//! magnitudes in units of the room's noise at each frequency: noise, whatever its colour, has the same flux
//! everywhere, and a click stands out at all frequencies at once. A peak of the flux is an onset; where the
//! sound rises within it is then sought sample by sample.

use crate::recording::Recording;
use crate::spectrum::Spectra;

/// Frequencies below this are left out: voices, steps and hum are there, coins are not.
const LEAST_HZ: f64 = 1500.0;
/// Length of a window, s: the least that tells a click's frequencies apart.
const WINDOW_S: f64 = 0.005_8;
/// An onset's flux is above the median by so many typical deviations …
const DEVIATIONS: f64 = 8.0;
/// … and by so much at least, in units of the noise.
const LEAST_FLUX: f64 = 1.0;
/// Onsets nearer than this are one, s.
pub(crate) const RESOLUTION_S: f64 = 0.004;
/// After an onset a weaker one is not told from its ring and its echoes, unless it is stronger than this share
/// of it, which falls to a tenth in the time below.
const MASK: f64 = 0.5;
/// The time in which masking falls by e, s.
const MASK_S: f64 = 0.025;
/// How finely the rise is sought, s.
const RISE_S: f64 = 0.000_25;

/// One onset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Onset {
    /// When, s since the beginning of the recording.
    pub time_s: f64,
    /// Standard error of the time, s.
    pub error_s: f64,
    /// Amplitude above 1.5 kHz, in units of the loudest onset.
    pub strength: f64,
    /// The flux over what noise reaches: above 1.
    pub prominence: f64,
}

/// The onsets of a recording, and what of it is noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Onsets {
    /// In order of time.
    pub onsets: Vec<Onset>,
    /// The weakest strength that would have been told from noise, in units of the loudest onset.
    pub threshold: f64,
    /// Amplitude of the loudest onset over that of the noise, dB.
    pub signal_to_noise_db: f64,
}

impl Onsets {
    /// Finds them.
    pub fn of(recording: &Recording) -> Self {
        let spectra = Spectra::of(&recording.samples, recording.rate_hz, LEAST_HZ, WINDOW_S);
        let noise = spectra.noise();
        let flux = flux(&spectra, &noise);
        let bar = bar(&flux);
        let levels: Vec<f64> = spectra.frames.iter().map(|frame| level(frame)).collect();
        let quiet = level(&noise);
        let step = spectra.hop as f64 / recording.rate_hz;
        let reach = steps(RESOLUTION_S / step);
        let mut found = vec![];
        for n in 1..flux.len() {
            let around = &flux[n.saturating_sub(reach)..(n + reach + 1).min(flux.len())];
            if flux[n] < bar || around.iter().any(|other| *other > flux[n]) {
                continue;
            }
            let ahead = &levels[n..(n + 4).min(levels.len())];
            let loud = ahead.iter().copied().fold(0.0, f64::max);
            let strength = (loud * loud - quiet * quiet).max(0.0).sqrt();
            let (time_s, error_s) = rise(recording, n * spectra.hop, spectra.length);
            found.push(Onset {
                time_s,
                error_s,
                strength,
                prominence: flux[n] / bar,
            });
        }
        let onsets = unmasked(found);
        let loudest = onsets.iter().map(|o| o.strength).fold(0.0, f64::max);
        // the flux of a click is in proportion to its strength
        let per_flux = onsets.iter().map(|o| o.strength / o.prominence);
        let weakest = median(&mut per_flux.collect::<Vec<_>>());
        let scaled = |strength: f64| {
            if loudest > 0.0 {
                strength / loudest
            } else {
                0.0
            }
        };
        Self {
            threshold: scaled(weakest).min(1.0),
            signal_to_noise_db: 20.0 * libm::log10((loudest / quiet).max(1e-3)),
            onsets: onsets
                .into_iter()
                .map(|onset| Onset {
                    strength: scaled(onset.strength),
                    ..onset
                })
                .collect(),
        }
    }
}

/// Keeps what is not masked by what came before, and the stronger of two that are too near.
fn unmasked(found: Vec<Onset>) -> Vec<Onset> {
    let mut kept: Vec<Onset> = vec![];
    for onset in found {
        let masks =
            |last: &Onset| is_masked(onset.time_s - last.time_s, onset.strength / last.strength);
        if !kept.iter().rev().take(8).any(masks) {
            kept.push(onset);
        }
    }
    kept
}

/// Whether a sound so long after another, and so much weaker, is not told from it. Sounds that the engine
/// foretells are judged by the same rule.
pub(crate) fn is_masked(later_s: f64, ratio: f64) -> bool {
    later_s < RESOLUTION_S || ratio < MASK * libm::exp(-later_s / MASK_S)
}

/// The mean rise of the magnitudes from each window to the next but one, in units of the noise.
fn flux(spectra: &Spectra, noise: &[f32]) -> Vec<f64> {
    let frames = &spectra.frames;
    let rise = |n: usize| {
        if n < 2 {
            return 0.0;
        }
        let pairs = frames[n].iter().zip(&frames[n - 2]).zip(noise);
        let sum: f64 = pairs
            .map(|((now, before), noise)| f64::from(((now - before) / noise).max(0.0)))
            .sum();
        sum / noise.len() as f64
    };
    (0..frames.len()).map(rise).collect()
}

/// The flux that noise does not reach.
fn bar(flux: &[f64]) -> f64 {
    let middle = median(&mut flux.to_vec());
    let mut off: Vec<f64> = flux.iter().map(|x| (x - middle).abs()).collect();
    middle + (DEVIATIONS * 1.4826 * median(&mut off)).max(LEAST_FLUX)
}

fn level(magnitudes: &[f32]) -> f64 {
    let squares = magnitudes.iter().map(|x| f64::from(*x) * f64::from(*x));
    squares.sum::<f64>().sqrt()
}

/// When the sound rises in the windows around one, and how sure that is: where the amplitude, without low
/// frequencies, first passes half of its greatest.
fn rise(recording: &Recording, start: usize, length: usize) -> (f64, f64) {
    let from = start.saturating_sub(length / 2);
    let to = (start + length + length / 2).min(recording.samples.len());
    let part = &recording.samples[from..to];
    let rate = recording.rate_hz;
    let width = steps(RISE_S * rate).max(1);
    let sharp: Vec<f64> = part
        .windows(3)
        .map(|w| f64::from(w[0]) - 2.0 * f64::from(w[1]) + f64::from(w[2]))
        .collect();
    let smooth: Vec<f64> = sharp
        .windows(width)
        .map(|w| (w.iter().map(|x| x * x).sum::<f64>() / width as f64).sqrt())
        .collect();
    let (place, most) = greatest(&smooth);
    let passes = |share: f64| {
        let before = smooth[..=place].iter().rposition(|x| *x < share * most);
        before.map_or(0, |at| at + 1)
    };
    if smooth.is_empty() {
        return (start as f64 / rate, length as f64 / rate);
    }
    let [early, half, late] = [0.25, 0.5, 0.75].map(passes);
    let time = (from + half + width) as f64 / rate;
    let spread = (late.saturating_sub(early)) as f64 / rate;
    (time, (0.5 * spread).max(0.5 * RISE_S))
}

fn greatest(values: &[f64]) -> (usize, f64) {
    let each = values.iter().copied().enumerate();
    each.fold(
        (0, 0.0),
        |most, now| if now.1 > most.1 { now } else { most },
    )
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small and positive
fn steps(number: f64) -> usize {
    number.round().max(0.0) as usize
}

/// The median; 0 without values.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let place = values.len() / 2;
    *values.select_nth_unstable_by(place, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::struck::Strike;
    use crate::synthetic::Synthetic;
    use coinmc_core::Coin;

    #[test]
    fn strikes_are_heard_when_they_are_and_echoes_are_not() {
        let coin = Coin::cylinder(0.16, 0.0116).unwrap();
        let times = [0.0, 0.18, 0.29, 0.355];
        let strikes: Vec<Strike> = times
            .iter()
            .map(|time_s| Strike {
                time_s: *time_s,
                speed_m_s: 1.0 - time_s,
            })
            .collect();
        for signal_to_noise_db in [30.0, 10.0] {
            let synthetic = Synthetic {
                echo: 0.6,
                signal_to_noise_db,
                ..Synthetic::default()
            };
            let recording = synthetic.of_strikes(&coin, &strikes, [0.0, 0.4]);
            let heard = Onsets::of(&recording);
            assert_eq!(heard.onsets.len(), times.len(), "{heard:?}");
            for (onset, time) in heard.onsets.iter().zip(times) {
                assert!(
                    (onset.time_s - 0.5 - time).abs() < 0.001,
                    "{onset:?} {time}"
                );
            }
            let ratio = heard.onsets[3].strength / heard.onsets[0].strength;
            assert!((ratio - 0.645).abs() < 0.15, "{ratio}");
        }
    }

    #[test]
    fn noise_has_no_onsets() {
        let coin = Coin::cylinder(0.16, 0.0116).unwrap();
        for seed in 0..4 {
            let synthetic = Synthetic {
                seed,
                signal_to_noise_db: -60.0,
                ..Synthetic::default()
            };
            let strikes = [Strike {
                time_s: 0.0,
                speed_m_s: 1.0,
            }];
            let recording = synthetic.of_strikes(&coin, &strikes, [0.0, 1.0]);
            assert!(Onsets::of(&recording).onsets.is_empty());
        }
    }
}
