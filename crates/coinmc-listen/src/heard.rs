//! The bounces of a drop, as they are heard: from a recording, and from the strikes of a simulated toss by the
//! same rules.

use crate::onsets::{Onsets, is_masked};
use crate::struck::{Strike, Struck};
use coinmc_core::{UniformSource, inverse_normal_cdf};
use thiserror::Error;

/// Strikes within so long after an onset add to its strength, s.
const TOGETHER_S: f64 = 0.006;
const HALF: f64 = 0.5;
/// Impacts of the first contact may come so long before the loudest, s.
const FIRST_S: f64 = 0.03;
/// Strikes within so short a time are one push, s.
const AT_ONCE_S: f64 = 0.000_2;
/// Standard deviation of the logarithm of a strength: modes of strikes that are heard together interfere.
const INTERFERENCE: f64 = 0.3;
/// Onsets weaker than this share of the loudest are not counted.
const WEAKEST: f64 = 0.04;
/// A silence that ends the bounces, s, beside twice the longest flight.
const SILENCE_S: f64 = 0.2;
/// Shortest gap that counts, s.
const LEAST_GAP_S: f64 = 0.004;
/// Gaps that are features.
const GAPS: usize = 4;

/// The bounces that are heard of one drop.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounces {
    /// Their times since the first, s.
    pub times_s: Vec<f64>,
    /// Their strengths, in units of the loudest.
    pub strengths: Vec<f64>,
    /// The strength from which bounces count, in units of the loudest.
    pub least: f64,
    /// Onsets before the first and after the last that belong to something else.
    pub others: usize,
}

/// Why no bounces are heard.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum NoBounces {
    /// Nothing.
    #[error("no impact rises above the room's noise")]
    Nothing,
    /// One alone.
    #[error("only one impact is heard")]
    One,
    /// Not a dropped coin.
    #[error("the impacts do not come as those of a dropped coin: {0}")]
    NotADrop(&'static str),
}

impl Bounces {
    /// The bounces among the onsets of a recording.
    ///
    /// # Errors
    /// [`NoBounces`] if these are not the sounds of a dropped coin.
    pub fn of(onsets: &Onsets) -> Result<Self, NoBounces> {
        let least = onsets.threshold.max(WEAKEST);
        let all: Vec<(f64, f64)> = onsets
            .onsets
            .iter()
            .map(|o| (o.time_s, o.strength))
            .collect();
        let bounces = Self::among(&all, least).ok_or(NoBounces::Nothing)?;
        bounces.check()?;
        Ok(bounces)
    }

    /// The bounces of a simulated toss that would be heard; `uniforms` say how modes interfere.
    pub(crate) fn of_toss(
        struck: &Struck,
        least: f64,
        uniforms: &mut impl UniformSource,
    ) -> Option<Self> {
        let mut sounds: Vec<(f64, f64)> = vec![];
        for (place, strike) in struck.strikes.iter().enumerate() {
            let with = struck.strikes[place..].iter();
            let with = with.take_while(|other| other.time_s - strike.time_s < TOGETHER_S);
            let loudest = with
                .clone()
                .map(|other| other.speed_m_s)
                .fold(0.0, f64::max);
            // the rise is heard where the sound passes half of its greatest
            let mut rising = with.clone();
            let rise = rising
                .find(|other| other.speed_m_s >= HALF * loudest)
                .unwrap_or(strike);
            #[allow(clippy::cast_possible_truncation)] // at most a few thousand strikes
            let normal = inverse_normal_cdf(uniforms.uniform(place as u32));
            let strength = sum(with) * libm::exp(INTERFERENCE * normal);
            let masks = |last: &(f64, f64)| is_masked(rise.time_s - last.0, strength / last.1);
            if strength > 0.0 && !sounds.iter().rev().take(8).any(masks) {
                sounds.push((rise.time_s, strength));
            }
        }
        let loudest = sounds.iter().map(|sound| sound.1).fold(0.0, f64::max);
        let scaled: Vec<(f64, f64)> = sounds.iter().map(|(t, s)| (*t, s / loudest)).collect();
        Self::among(&scaled, least)
    }

    /// From the first contact, around the loudest sound, to a silence.
    fn among(sounds: &[(f64, f64)], least: f64) -> Option<Self> {
        let sure: Vec<(f64, f64)> = sounds.iter().copied().filter(|s| s.1 >= least).collect();
        let loudest = sure
            .iter()
            .copied()
            .reduce(|a, b| if b.1 > a.1 { b } else { a })?;
        let mut kept: Vec<(f64, f64)> = vec![];
        let mut longest: f64 = 0.0;
        for sound in sure.iter().filter(|sound| sound.0 >= loudest.0 - FIRST_S) {
            if let Some(last) = kept.last() {
                let gap = sound.0 - last.0;
                if kept.len() > 1 && gap > 2.0 * longest + SILENCE_S {
                    break;
                }
                longest = longest.max(gap);
            }
            kept.push(*sound);
        }
        let first = kept.first()?.0;
        Some(Self {
            others: sure.len() - kept.len(),
            times_s: kept.iter().map(|sound| sound.0 - first).collect(),
            strengths: kept.iter().map(|sound| sound.1).collect(),
            least,
        })
    }

    /// Whether a dropped coin can sound like this.
    fn check(&self) -> Result<(), NoBounces> {
        if self.times_s.len() < 2 {
            return Err(NoBounces::One);
        }
        let gaps = self.gaps();
        if !self.shrinks(&gaps) {
            return Err(NoBounces::NotADrop("their gaps do not shrink"));
        }
        if self.others > MOST_OTHERS {
            return Err(NoBounces::NotADrop(
                "there are as loud sounds before or after them",
            ));
        }
        if gaps.iter().any(|gap| *gap > LONGEST_FLIGHT_S) {
            return Err(NoBounces::NotADrop("seconds lie between them"));
        }
        Ok(())
    }

    /// Whether the gaps shrink on the whole. A single one may grow: a turning coin takes energy from one bounce and gives
    /// it to another.
    fn shrinks(&self, gaps: &[f64]) -> bool {
        if gaps.len() >= HALVES {
            let (early, late) = gaps.split_at(gaps.len() / 2);
            return late.iter().sum::<f64>() <= early.iter().sum::<f64>() * SHRINKS;
        }
        // Halves of so few say little, but not all may grow. The impacts of the first contact, of one rim and then of
        // the other, have no flights between them.
        let first = self.times_s.partition_point(|time| *time < FIRST_S);
        let flights = &gaps[first.saturating_sub(1)..];
        let mut pairs = flights.windows(2);
        flights.len() < 2 || pairs.any(|pair| pair[1] <= pair[0] * SHRINKS)
    }

    fn gaps(&self) -> Vec<f64> {
        self.times_s
            .windows(2)
            .map(|pair| pair[1] - pair[0])
            .collect()
    }

    /// What the comparison with simulated drops rests on: logarithms of the longest flights, longest first, of the
    /// time from the first bounce to the last, and of the number of bounces.
    pub(crate) fn features(&self) -> [f64; FEATURES] {
        let mut gaps = self.gaps();
        gaps.sort_by(|a, b| b.total_cmp(a));
        let mut features = [0.0; FEATURES];
        for (place, feature) in features.iter_mut().enumerate().take(GAPS) {
            let gap = gaps.get(place).copied().unwrap_or(0.0);
            *feature = libm::log(gap.max(LEAST_GAP_S));
        }
        let last = self.times_s.last().copied().unwrap_or(0.0);
        features[GAPS] = libm::log(last.max(LEAST_GAP_S));
        features[GAPS + 1] = libm::log(self.times_s.len() as f64);
        features
    }
}

/// The strength of strikes that are heard together: those at the same instant add, others in squares.
fn sum<'a>(strikes: impl Iterator<Item = &'a Strike>) -> f64 {
    let (mut squares, mut at_once, mut last_s) = (0.0, 0.0, f64::NEG_INFINITY);
    for strike in strikes {
        if strike.time_s - last_s > AT_ONCE_S {
            squares += at_once * at_once;
            at_once = 0.0;
        }
        at_once += strike.speed_m_s;
        last_s = strike.time_s;
    }
    (squares + at_once * at_once).sqrt()
}

/// How many features there are, and what they are.
pub(crate) const FEATURES: usize = GAPS + 2;
pub(crate) const FEATURE_NAMES: [&str; FEATURES] = [
    "longest flight",
    "second longest flight",
    "third longest flight",
    "fourth longest flight",
    "time from the first bounce to the last",
    "number of bounces",
];
/// From so many gaps on, their halves are compared.
const HALVES: usize = 4;
/// The later half of the gaps is no longer than this share of the earlier half; of fewer, one flight of the one before.
const SHRINKS: f64 = 0.9;
/// Other sounds as loud as bounces that are passed over.
const MOST_OTHERS: usize = 2;
/// Longest flight of a coin after a bounce, s.
const LONGEST_FLIGHT_S: f64 = 2.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::onsets::Onset;

    fn onsets(times: &[f64]) -> Onsets {
        let onset = |(place, time): (usize, &f64)| Onset {
            time_s: *time,
            error_s: 0.0005,
            strength: libm::pow(0.8, place as f64),
            prominence: 5.0,
        };
        Onsets {
            onsets: times.iter().enumerate().map(onset).collect(),
            threshold: 0.05,
            signal_to_noise_db: 40.0,
        }
    }

    #[test]
    fn bounces_come_faster_and_claps_do_not() {
        let drop = Bounces::of(&onsets(&[1.0, 1.2, 1.32, 1.39, 1.43])).unwrap();
        assert_eq!(
            (drop.times_s.len(), drop.times_s[0], drop.others),
            (5, 0.0, 0)
        );
        let longest = libm::exp(drop.features()[0]);
        assert!((longest - 0.2).abs() < 1e-9, "{longest}");
        let claps = Bounces::of(&onsets(&[1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.3]));
        assert!(matches!(claps, Err(NoBounces::NotADrop(_))), "{claps:?}");
        // few of them, too: growing, equal, and growing after the two rims of the first contact
        for times in [
            &[0.0, 0.05, 0.15, 0.35][..],
            &[0.0, 0.05, 0.15],
            &[0.0, 0.2, 0.4, 0.6],
            &[0.0, 0.01, 0.06, 0.16],
        ] {
            let grown = Bounces::of(&onsets(times));
            assert!(matches!(grown, Err(NoBounces::NotADrop(_))), "{grown:?}");
        }
        assert_eq!(Bounces::of(&onsets(&[1.0])), Err(NoBounces::One));
        assert_eq!(Bounces::of(&onsets(&[])), Err(NoBounces::Nothing));
    }

    /// A thin coin strikes with one rim and at once with the other, and may fly for longer once.
    #[test]
    fn irregular_bounces_are_a_drop() {
        for times in [
            &[0.0, 0.2][..],
            &[0.0, 0.01, 0.12],
            &[0.0, 0.013, 0.122, 0.169],
            &[0.0, 0.05, 0.15, 0.2],
            &[0.0, 0.01, 0.02, 0.12],
        ] {
            let drop = Bounces::of(&onsets(times));
            assert!(drop.is_ok(), "{times:?}: {drop:?}");
        }
    }
}
