//! The whirr of a coin that settles on a face: its pitch at several times.

use crate::chirp::Bent;
use crate::envelope::Envelope;
use crate::recording::Recording;
use thiserror::Error;

/// Rates F = (3/2) c^(−1/3) that are tried: rolling friction lengths from about 1e-6 to 1e-3 m.
const RATES: [f64; 2] = [8.0, 85.0];
/// How finely, and by which factor the rates of a group differ, which share their windows.
const RATE_STEP: f64 = 1.02;
const GROUP_STEP: f64 = 1.4;
/// Ends are tried from so long before the end of the sound, s …
const EARLIER_S: f64 = 0.3;
/// … to so long after it, s, …
const LATER_S: f64 = 0.1;
/// … in so many steps.
const ENDS: u32 = 40;
/// The last moment, in which air brakes and the rattle is one sound, is left out, s.
const LAST_S: f64 = 0.06;
/// Windows of the first search, and the most of the readings …
const COARSE: usize = 6;
const FINE: usize = 12;
/// … of which each holds so many rounds at least.
const ROUNDS_EACH: f64 = 4.0;
/// How far from the common rate a window's own is sought, as a share.
const SLACK: f64 = 0.12;
/// A whirr is at least so long, s.
const SHORTEST_S: f64 = 0.3;
/// Mean score below which there is no rattle with a pitch: noise has 2.5.
const LEAST_SCORE: f64 = 5.5;
/// Power of the pitch itself in a window, in medians, below which it is not a reading.
const LEAST_POWER: f64 = 6.0;
/// Readings that are needed, and the rise of pitch between the first and the last.
const LEAST_READINGS: usize = 4;
const LEAST_RISE: f64 = 1.25;
/// Rounds in which the end follows from the readings and the readings from the end.
const ROUNDS: usize = 4;
/// Greatest scatter of the readings about the law, as a share of the pitch.
const MOST_SCATTER: f64 = 0.04;
/// Scatter that is believed at least.
const LEAST_SCATTER: f64 = 0.005;

/// The pitch at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pitch {
    /// Since the beginning of the recording, s.
    pub time_s: f64,
    /// Rounds of the contact in a second.
    pub frequency_hz: f64,
}

/// A whirr.
#[derive(Debug, Clone, PartialEq)]
pub struct Whirr {
    /// Pitch at several times.
    pub readings: Vec<Pitch>,
    /// How the readings scatter about f⁻³ = c (t_e − t), as a share of f.
    pub scatter: f64,
    /// c, s².
    pub rate_s2: f64,
    /// Standard error of c as a share of it.
    pub rate_error: f64,
    /// t_e, when the pitch would be infinite, s since the beginning of the recording.
    pub end_s: f64,
    /// How clear the pitch is: noise has 2.5.
    pub score: f64,
}

/// Why no whirr is heard.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum NoWhirr {
    /// Nothing is louder than the quietest moments.
    #[error("no sound of {SHORTEST_S} s rises above the room's noise")]
    Quiet,
    /// No pitch.
    #[error(
        "the sound has no pitch that rises as a coin's (clarity {0:.1}, {LEAST_SCORE} are needed)"
    )]
    NoPitch(f64),
    /// Too few readings.
    #[error("the pitch can be read only {0} times, {LEAST_READINGS} are needed")]
    FewReadings(usize),
    /// It does not rise.
    #[error("the pitch does not rise as a settling coin's")]
    NoRise,
    /// It is not a line.
    #[error("the pitch scatters by {:.0} % about the law of a settling coin", 100.0 * .0)]
    Scatters(f64),
}

impl Whirr {
    /// Finds it. Pitches below `least_hz` are left out: there the coin leans too much for the law.
    ///
    /// # Errors
    /// [`NoWhirr`] with why there is none.
    pub fn of(recording: &Recording, least_hz: f64) -> Result<Self, NoWhirr> {
        let envelope = Envelope::of(recording);
        let [from, to] = envelope.active_s.ok_or(NoWhirr::Quiet)?;
        if to - from < SHORTEST_S {
            return Err(NoWhirr::Quiet);
        }
        let (mut rate, mut end, score) = search(&envelope, [from, to], least_hz);
        if score < LEAST_SCORE {
            return Err(NoWhirr::NoPitch(score));
        }
        let mut found = Err(NoWhirr::NoRise);
        for _ in 0..ROUNDS {
            let readings = readings(&envelope, [from, end], rate, least_hz);
            let fitted = Self::fitted(readings, score)?;
            (rate, end) = (fitted.bent_rate(), fitted.end_s);
            if !(end > from + SHORTEST_S && (end - to).abs() < 1.5 * EARLIER_S) {
                return Err(NoWhirr::NoRise);
            }
            found = Ok(fitted);
        }
        let found = found?;
        if found.scatter > MOST_SCATTER {
            return Err(NoWhirr::Scatters(found.scatter));
        }
        Ok(found)
    }

    /// F of its c.
    fn bent_rate(&self) -> f64 {
        1.5 / libm::cbrt(self.rate_s2)
    }

    /// The line f⁻³ = c (t_e − t) through readings whose errors are the same share of f.
    fn fitted(readings: Vec<Pitch>, score: f64) -> Result<Self, NoWhirr> {
        if readings.len() < LEAST_READINGS {
            return Err(NoWhirr::FewReadings(readings.len()));
        }
        let [first, last] = [readings[0], readings[readings.len() - 1]];
        if last.frequency_hz < LEAST_RISE * first.frequency_hz {
            return Err(NoWhirr::NoRise);
        }
        let cube = |pitch: &Pitch| libm::pow(pitch.frequency_hz, -3.0);
        let mut fit: Vec<f64> = readings.iter().map(cube).collect();
        let mut line = None;
        for _ in 0..20 {
            let weights: Vec<f64> = readings
                .iter()
                .zip(&fit)
                .map(|(pitch, fit)| {
                    let error = 3.0 * fit.max(0.2 * cube(pitch));
                    1.0 / (error * error)
                })
                .collect();
            let total: f64 = weights.iter().sum();
            let mean = |of: &dyn Fn(&Pitch) -> f64| {
                let each = readings.iter().zip(&weights);
                each.map(|(pitch, weight)| weight * of(pitch)).sum::<f64>() / total
            };
            let [t, y] = [mean(&|p| p.time_s), mean(&cube)];
            let spread = mean(&|p| (p.time_s - t) * (p.time_s - t));
            let slope = mean(&|p| (p.time_s - t) * (cube(p) - y)) / spread;
            if slope.is_nan() || slope >= 0.0 {
                return Err(NoWhirr::NoRise);
            }
            fit = readings
                .iter()
                .map(|p| y + slope * (p.time_s - t))
                .collect();
            line = Some((slope, t - y / slope, (1.0 / (total * spread)).sqrt()));
        }
        let (slope, end_s, unit) = line.ok_or(NoWhirr::NoRise)?;
        let off = readings.iter().zip(&fit).map(|(pitch, fit)| {
            let share = (cube(pitch) - fit) / (3.0 * fit.max(0.2 * cube(pitch)));
            share * share
        });
        let degrees = (readings.len() - 2) as f64;
        let scatter = (off.sum::<f64>() / degrees).sqrt().max(LEAST_SCATTER);
        Ok(Self {
            readings,
            scatter,
            rate_s2: -slope,
            rate_error: scatter * unit / -slope,
            end_s,
            score,
        })
    }
}

/// The common rate F and the end t_e that fit the sound between two times best, and how well.
fn search(envelope: &Envelope, [from, to]: [f64; 2], least_hz: f64) -> (f64, f64, f64) {
    let mut best = (0.0, to, 0.0);
    let groups = steps(RATES, GROUP_STEP);
    for step in 0..=ENDS {
        let share = f64::from(step) / f64::from(ENDS);
        let end = to - EARLIER_S + (EARLIER_S + LATER_S) * share;
        for group in groups.clone() {
            let start = from.max(end - longest_s(group * GROUP_STEP.sqrt(), least_hz));
            if end - start < SHORTEST_S {
                continue;
            }
            let bent = Bent::new(envelope, start, end, LAST_S, COARSE);
            for rate in steps([group, group * GROUP_STEP], RATE_STEP) {
                let score = bent.total(rate);
                if score > best.2 {
                    best = (rate, end, score);
                }
            }
        }
    }
    best
}

/// Numbers from one to another, each by a factor more than the last.
fn steps([least, most]: [f64; 2], factor: f64) -> impl Iterator<Item = f64> + Clone {
    let next = move |number: &f64| (number * factor <= most).then_some(number * factor);
    std::iter::successors(Some(least), next)
}

/// How long before the end the pitch is the least: f = F (2/3) (t_e − t)^(−1/3).
fn longest_s(rate: f64, least_hz: f64) -> f64 {
    libm::pow(2.0 * rate / (3.0 * least_hz), 3.0)
}

/// Readings of the pitch from about the common rate.
fn readings(envelope: &Envelope, [from, end]: [f64; 2], rate: f64, least_hz: f64) -> Vec<Pitch> {
    let from = from.max(end - longest_s(rate, least_hz));
    let bend = |left: f64| libm::pow(left, 2.0 / 3.0);
    let rounds = rate * (bend((end - from).max(LAST_S)) - bend(LAST_S));
    // windows that half overlap: n of them hold twice the rounds over n + 1 each
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
    let windows = (2.0 * rounds / ROUNDS_EACH - 1.0).clamp(1.0, FINE as f64) as usize;
    let bent = Bent::new(envelope, from, end, LAST_S, windows);
    let mut readings = vec![];
    for (window, left) in bent.left_s.iter().enumerate() {
        let own = bent.refined(window, rate, SLACK);
        let at_edge = (own / rate - 1.0).abs() > 0.98 * SLACK;
        if at_edge || bent.fundamental(window, own) < LEAST_POWER {
            continue;
        }
        readings.push(Pitch {
            time_s: end - left,
            frequency_hz: own * 2.0 / (3.0 * libm::cbrt(*left)),
        });
    }
    readings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::struck::Strike;
    use crate::synthetic::Synthetic;
    use coinmc_core::Coin;

    /// A coin whose dent strikes once a round, with f⁻³ = c (end − t), from 15 rounds a second on.
    fn settling(c: f64, signal_to_noise_db: f64) -> Recording {
        let coin = Coin::cylinder(0.16, 0.0116).unwrap();
        let end = 1.0 / (c * 15.0 * 15.0 * 15.0);
        let bent = 1.5 / libm::cbrt(c);
        let rounds = bent * libm::pow(end, 2.0 / 3.0);
        let strike = |round: u32| Strike {
            time_s: end - libm::pow((rounds - f64::from(round)) / bent, 1.5),
            speed_m_s: 0.02,
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let strikes: Vec<Strike> = (0..rounds as u32).map(strike).collect();
        let synthetic = Synthetic {
            signal_to_noise_db,
            ..Synthetic::default()
        };
        synthetic.of_strikes(&coin, &strikes, [0.0, end])
    }

    #[test]
    fn the_rate_of_a_settling_coin_is_heard_through_noise() {
        for c in [4e-5, 1.5e-4] {
            let whirr = Whirr::of(&settling(c, 10.0), 15.0).unwrap();
            let off = whirr.rate_s2 / c - 1.0;
            assert!(
                off.abs() < 0.05 && off.abs() < 4.0 * whirr.rate_error,
                "{c}: {off} {whirr:?}"
            );
        }
    }

    /// Zeros before the recording, of which a program or a microphone makes some tenths of a second, move all times and
    /// change nothing else: neither a short silence, nor one that fills a fifth of the whole, nor one longer than all means.
    #[test]
    fn digital_silence_before_a_whirr_changes_nothing() {
        let plain = settling(1.5e-4, 10.0);
        let heard = Whirr::of(&plain, 15.0).unwrap();
        let whole = plain.samples.len() as f64 / plain.rate_hz;
        for silence_s in [0.11, 0.2 * whole, 1.0] {
            let mut recording = plain.clone();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let zeros = vec![0.0; (silence_s * plain.rate_hz) as usize];
            recording.samples.splice(0..0, zeros);
            let later = Whirr::of(&recording, 15.0).unwrap();
            let off = later.rate_s2 / heard.rate_s2 - 1.0;
            assert!(off.abs() < heard.rate_error, "{silence_s}: {later:?}");
        }
    }

    #[test]
    fn noise_and_a_steady_beat_have_no_whirr() {
        let coin = Coin::cylinder(0.16, 0.0116).unwrap();
        let beat: Vec<Strike> = (0..60_u32)
            .map(|k| Strike {
                time_s: 0.05 * f64::from(k),
                speed_m_s: 0.02,
            })
            .collect();
        let steady = Synthetic::default().of_strikes(&coin, &beat, [0.0, 3.0]);
        let noise = settling(1e-4, -40.0);
        for recording in [steady, noise] {
            let heard = Whirr::of(&recording, 15.0);
            assert!(heard.is_err(), "{heard:?}");
        }
    }
}
