//! When something strikes: onsets in a recording.
//!
//! Spectral flux (Bello et al., IEEE Trans. Speech Audio Process. 13 (2005) 1035; Dixon, DAFx 2006) of
//! magnitudes in units of the room's noise at each frequency: noise, whatever its colour, has the same flux
//! everywhere, and a click stands out at all frequencies at once. The loudest peak of the flux says at which
//! frequencies this coin rings; with each weighted by that, peaks of the flux are onsets, many of which are too weak
//! to stand out at all frequencies. Where the sound rises within one is then sought sample by sample.

use crate::filter::{Filter, NOISE_RISE, NOISE_SQUARE};
use crate::recording::Recording;
use crate::spectrum::Spectra;
use rustfft::FftPlanner;

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
/// of it, which falls by e in the time below. (Echoes of a pure tone can add up, hence so large a share.)
const MASK: f64 = 0.7;
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
    /// Amplitude behind the filter matched to the loudest impact, in units of the loudest onset.
    pub strength: f64,
    /// The flux behind that filter over what noise reaches: at least 1.
    pub prominence: f64,
}

/// The onsets of a recording, and what of it is noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Onsets {
    /// In order of time.
    pub onsets: Vec<Onset>,
    /// The weakest strength that would have been told from noise, in units of the loudest onset.
    pub threshold: f64,
    /// Amplitude of the loudest window over that of the noise, all frequencies alike, dB.
    pub signal_to_noise_db: f64,
}

impl Onsets {
    /// Finds them: first the loudest at all frequencies alike, then all others at those of the loudest.
    pub fn of(recording: &Recording) -> Self {
        let slowed = recording.slowed();
        let recording = slowed.as_ref();
        let spectra = Spectra::of(&recording.samples, recording.rate_hz, LEAST_HZ, WINDOW_S);
        let noise = spectra.noise();
        let reach = steps(RESOLUTION_S * recording.rate_hz / spectra.hop as f64);
        let even = Filter::even(&noise);
        let flux = Flux::even(&spectra, &noise, &even);
        let most = loudest(&spectra.frames, &noise, &even);
        let signal_to_noise_db = 20.0 * libm::log10(most.max(1e-3));
        let level = |filter, n| loudest(spectra.after(n), &noise, filter);
        let loud = flux.peaks(reach).into_iter().map(|n| (n, level(&even, n)));
        let Some((first, _)) = loud.reduce(|a, b| if b.1 > a.1 { b } else { a }) else {
            return Self {
                onsets: vec![],
                threshold: 1.0,
                signal_to_noise_db,
            };
        };
        let matched = Filter::matched(&spectra, &noise, first);
        // where sounds beside the noise raise the bar for all frequencies, they raise this one, too
        let bar = matched.most_of_noise(DEVIATIONS) * flux.bar / (NOISE_RISE + LEAST_FLUX);
        let weak = Flux {
            values: rises(&spectra, &noise, &matched),
            bar,
        };
        let mut planner = FftPlanner::new();
        let found = weak.peaks(reach).into_iter().map(|n| {
            let rate_hz = recording.rate_hz;
            let half = spectra.length / 2;
            let (from, part) = spectra.around(n, half, &recording.samples);
            let (time_s, error_s) = if flux.passes_near(n, reach) {
                sharp_rise(part, rate_hz)
            } else {
                // where samples are cut off, hum is a step, which all frequencies have: so they are a window longer
                let (begin, longer) = spectra.around(n, half + spectra.length, &recording.samples);
                let amplitudes = matched.amplitudes(longer, &spectra, &mut planner);
                rise(&amplitudes[from - begin..][..part.len()], rate_hz)
            };
            Onset {
                time_s: from as f64 / rate_hz + time_s,
                error_s,
                strength: level(&matched, n),
                prominence: weak.values[n] / weak.bar,
            }
        });
        let onsets = unmasked(found.collect());
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
            signal_to_noise_db,
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

/// Keeps what is not masked by what came before.
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

/// The rise of the magnitudes from each window to the next but one, behind a filter.
fn rises(spectra: &Spectra, noise: &[f32], filter: &Filter) -> Vec<f64> {
    let windows = 0..spectra.frames.len();
    let rises = windows.map(|n| filter.mean(spectra.rises(n, noise)));
    rises.collect()
}

/// These rises, and what noise does not reach.
struct Flux {
    values: Vec<f64>,
    bar: f64,
}

impl Flux {
    /// All frequencies alike: above the median by eight typical deviations.
    fn even(spectra: &Spectra, noise: &[f32], filter: &Filter) -> Self {
        let values = rises(spectra, noise, filter);
        let middle = median(&mut values.clone());
        let mut off: Vec<f64> = values.iter().map(|x| (x - middle).abs()).collect();
        let bar = middle + (DEVIATIONS * 1.4826 * median(&mut off)).max(LEAST_FLUX);
        Self { values, bar }
    }

    /// The windows where it passes what noise reaches, and has no greater value near.
    fn peaks(&self, reach: usize) -> Vec<usize> {
        let is_peak = |n: &usize| {
            let around = self.near(*n, reach).iter();
            self.values[*n] >= self.bar && around.copied().all(|other| other <= self.values[*n])
        };
        (1..self.values.len()).filter(is_peak).collect()
    }

    fn passes_near(&self, window: usize, reach: usize) -> bool {
        let mut near = self.near(window, reach).iter();
        near.any(|value| *value >= self.bar)
    }

    fn near(&self, window: usize, reach: usize) -> &[f64] {
        &self.values[window.saturating_sub(reach)..(window + reach + 1).min(self.values.len())]
    }
}

/// The amplitude of the loudest of these windows, behind a filter, in units of the noise, with the noise taken off.
fn loudest(frames: &[Vec<f32>], noise: &[f32], filter: &Filter) -> f64 {
    let levels = frames.iter().map(|frame| filter.level(frame, noise));
    let most = levels.fold(0.0, f64::max);
    (most * most - NOISE_SQUARE).max(0.0).sqrt()
}

/// When a sound that is louder than the noise rises, and how sure that is, in s: by the amplitude of the second
/// difference, which leaves low frequencies out.
fn sharp_rise(part: &[f32], rate_hz: f64) -> (f64, f64) {
    let width = steps(RISE_S * rate_hz).max(1);
    let sharp: Vec<f64> = part
        .windows(3)
        .map(|w| f64::from(w[0]) - 2.0 * f64::from(w[1]) + f64::from(w[2]))
        .collect();
    let smooth: Vec<f64> = sharp
        .windows(width)
        .map(|w| (w.iter().map(|x| x * x).sum::<f64>() / width as f64).sqrt())
        .collect();
    let (time_s, error_s) = rise(&smooth, rate_hz);
    (time_s + width as f64 / rate_hz, error_s)
}

/// When an amplitude last rises through half of its maximum before reaching it, and how sure that is, in s.
fn rise(amplitudes: &[f64], rate_hz: f64) -> (f64, f64) {
    let (place, most) = greatest(amplitudes);
    let passes = |share: f64| {
        let mut before = amplitudes.iter().take(place + 1);
        let before = before.rposition(|x| *x < share * most);
        before.map_or(0, |at| at + 1)
    };
    let [early, half, late] = [0.25, 0.5, 0.75].map(passes);
    let spread = late.saturating_sub(early) as f64 / rate_hz;
    (half as f64 / rate_hz, (0.5 * spread).max(0.5 * RISE_S))
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

    fn coin() -> Coin {
        Coin::cylinder(0.16, 0.0116).unwrap()
    }

    fn strikes<const N: usize>(all: [(f64, f64); N]) -> [Strike; N] {
        all.map(|(time_s, speed_m_s)| Strike { time_s, speed_m_s })
    }

    #[test]
    fn strikes_are_heard_when_they_are_and_echoes_are_not() {
        let times = [0.0, 0.18, 0.29, 0.355];
        let strikes = strikes(times.map(|time_s| (time_s, 1.0 - time_s)));
        for signal_to_noise_db in [30.0, 10.0] {
            let synthetic = Synthetic {
                echo: 0.6,
                signal_to_noise_db,
                ..Synthetic::default()
            };
            let recording = synthetic.of_strikes(&coin(), &strikes, [0.0, 0.4]);
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

    /// A strike too weak to stand out at all frequencies is heard at those of the loudest.
    #[test]
    fn weak_strikes_are_heard_at_the_frequencies_of_the_loudest() {
        let strikes = strikes([(0.0, 1.0), (0.18, 0.15)]);
        let (mut even, mut matched) = (0, 0);
        for seed in 0..20 {
            let synthetic = Synthetic {
                seed,
                signal_to_noise_db: 5.0,
                ..Synthetic::default()
            };
            let recording = synthetic.of_strikes(&coin(), &strikes, [0.0, 0.4]);
            let spectra = Spectra::of(&recording.samples, recording.rate_hz, LEAST_HZ, WINDOW_S);
            let noise = spectra.noise();
            let flux = Flux::even(&spectra, &noise, &Filter::even(&noise));
            even += flux.peaks(3).len();
            let onsets = Onsets::of(&recording).onsets;
            matched += onsets.len();
            for (onset, strike) in onsets.iter().zip(&strikes) {
                let late_s = onset.time_s - 0.5 - strike.time_s;
                assert!(late_s.abs() < 0.002, "{onset:?} {strike:?}");
                assert!(
                    (onset.strength - strike.speed_m_s).abs() < 0.05,
                    "{onset:?}"
                );
            }
        }
        assert_eq!((even, matched), (20, 40));
    }

    #[test]
    fn noise_has_no_onsets() {
        for seed in 0..4 {
            let synthetic = Synthetic {
                seed,
                signal_to_noise_db: -60.0,
                ..Synthetic::default()
            };
            let strikes = strikes([(0.0, 1.0)]);
            let recording = synthetic.of_strikes(&coin(), &strikes, [0.0, 1.0]);
            assert!(Onsets::of(&recording).onsets.is_empty());
        }
    }

    /// Behind a filter for few frequencies noise has no onsets either: of a loud strike in five seconds of noise one
    /// onset is heard.
    #[test]
    fn a_strike_alone_is_heard_alone() {
        for seed in 0..20 {
            let synthetic = Synthetic {
                seed,
                signal_to_noise_db: -3.0,
                ..Synthetic::default()
            };
            let recording = synthetic.of_strikes(&coin(), &strikes([(1.0, 1.0)]), [0.0, 5.0]);
            let heard = Onsets::of(&recording).onsets;
            assert_eq!(heard.len(), 1, "{heard:?}");
            assert!(heard[0].prominence > 1.0);
        }
    }

    /// A recording without silence before and after tells as much.
    #[test]
    fn silence_is_not_needed() {
        let times = [0.0, 0.09, 0.15, 0.19, 0.215, 0.235];
        let bounces = strikes(times.map(|time_s| (time_s, libm::exp(-6.0 * time_s))));
        for silence_s in [0.5, 0.1, 0.04] {
            let synthetic = Synthetic {
                silence_s,
                ..Synthetic::default()
            };
            let recording = synthetic.of_strikes(&coin(), &bounces, [0.0, 0.28]);
            let heard = Onsets::of(&recording).onsets;
            assert_eq!(heard.len(), times.len(), "{silence_s}: {heard:?}");
        }
    }

    /// With more samples a second noise changes as much from one to the next, and a sound less: onsets stay where they
    /// are, at rates of recorders for bats, too.
    #[test]
    fn onsets_are_right_at_any_rate() {
        let struck = [
            (0.5, 0.7),
            (0.595, 0.5),
            (0.647, 0.4),
            (0.665, 0.3),
            (0.676, 0.25),
        ];
        let philox = coinmc_core::Philox4x64::new([11, 12]);
        for rate_hz in [44_100.0, 96_000.0, 176_400.0, 192_000.0, 384_000.0] {
            let ring = |t: f64| {
                if t < 0.0 {
                    return 0.0;
                }
                libm::exp(-t / 0.006) * libm::sin(std::f64::consts::TAU * 4000.0 * t)
            };
            let sample = |n: u64| {
                let t = n as f64 / rate_hz;
                let sound: f64 = struck.iter().map(|(at, loud)| loud * ring(t - at)).sum();
                let word = philox.block([n, 0, 0, 0])[0];
                let noise = coinmc_core::inverse_normal_cdf(coinmc_core::unit_interval(word));
                #[allow(clippy::cast_possible_truncation)]
                let sample = (sound + 0.001 * noise) as f32;
                sample
            };
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let samples = (0..(1.2 * rate_hz) as u64).map(sample).collect();
            let recording = Recording::of_samples("bats", rate_hz, samples);
            let heard = Onsets::of(&recording).onsets;
            assert_eq!(heard.len(), struck.len(), "{rate_hz}: {heard:?}");
            for (onset, (at, _)) in heard.iter().zip(struck) {
                assert!(
                    (onset.time_s - at).abs() < 0.0005,
                    "{rate_hz}: {onset:?} {at}"
                );
            }
        }
    }

    /// Hum as loud as the loudest strike moves no onset, not even of a strike that only the matched filter hears.
    #[test]
    fn hum_moves_no_onset() {
        for seed in 0..10 {
            let synthetic = Synthetic {
                seed,
                signal_to_noise_db: 5.0,
                ..Synthetic::default()
            };
            let quiet =
                synthetic.of_strikes(&coin(), &strikes([(0.0, 1.0), (0.18, 0.15)]), [0.0, 0.4]);
            let hum =
                |n: usize| libm::sin(std::f64::consts::TAU * 100.0 * n as f64 / quiet.rate_hz);
            #[allow(clippy::cast_possible_truncation)]
            let with = quiet
                .samples
                .iter()
                .enumerate()
                .map(|(n, x)| x + hum(n) as f32);
            let humming = Recording::of_samples("hum", quiet.rate_hz, with.collect());
            let [quiet, humming] = [quiet, humming].map(|recording| Onsets::of(&recording).onsets);
            assert_eq!(humming.len(), 2);
            for (one, other) in quiet.iter().zip(&humming) {
                assert!(
                    (one.time_s - other.time_s).abs() < 0.001,
                    "{one:?} {other:?}"
                );
            }
        }
    }

    /// With 10 dB less noise a sound is 10 dB farther above it, and the weakest strike that is heard weaker by as
    /// much: what is above the threshold is heard, and what is far below it is not.
    #[test]
    fn the_threshold_is_what_can_be_heard() {
        let of = |signal_to_noise_db: f64, weak: f64| {
            let synthetic = Synthetic {
                signal_to_noise_db,
                ..Synthetic::default()
            };
            let both = strikes([(0.0, 1.0), (0.3, weak)]);
            Onsets::of(&synthetic.of_strikes(&coin(), &both, [0.0, 0.6]))
        };
        let [far, near] = [10.0, 20.0].map(|ratio_db| of(ratio_db, 0.5));
        let louder = near.signal_to_noise_db - far.signal_to_noise_db;
        assert!((louder - 10.0).abs() < 1.0, "{louder}");
        let lower = far.threshold / near.threshold;
        assert!((lower / 10.0_f64.sqrt() - 1.0).abs() < 0.2, "{lower}");
        assert_eq!(of(10.0, 1.6 * far.threshold).onsets.len(), 2);
        assert_eq!(of(10.0, 0.4 * far.threshold).onsets.len(), 1);
    }

    /// No samples, whatever they are, make it fail.
    #[test]
    fn any_samples_are_heard_out() {
        let mut click = vec![0.0; 10_000];
        click[5000] = 1.0;
        for samples in [
            vec![],
            vec![1.0],
            vec![0.0; 5000],
            vec![f32::NAN; 5000],
            vec![f32::MAX; 5000],
            (0..5000)
                .map(|n| if n % 7 == 0 { f32::MIN } else { f32::INFINITY })
                .collect(),
            click,
        ] {
            let heard = Onsets::of(&Recording::of_samples("any", 44_100.0, samples));
            assert!((0.0..=1.0).contains(&heard.threshold), "{heard:?}");
            assert!(heard.signal_to_noise_db.is_finite(), "{heard:?}");
            assert!(heard.onsets.iter().all(|onset| onset.time_s.is_finite()));
        }
    }
}
