//! Measurements that contradict their prior, or all the others.

use crate::measured::Reading;
use crate::model::{Model, reached};
use crate::points::{self, Use};
use crate::posterior;
use crate::{CalibrationError, Parameter};
use coinmc::config::Diagnostics;
use coinmc_questions::number::compact;

/// Below this probability of something so extreme, a measurement is refused …
const REFUSED: f64 = 1e-6;
/// … and below this one, shared by all measurements, it is remarked on.
const REMARKED: f64 = 0.01;
/// Points of the prior.
const POINTS: u64 = 4096;

/// A measurement that the others, or its prior, hardly allow.
#[derive(Debug, Clone, PartialEq)]
pub struct Conflict {
    /// Its name.
    pub name: String,
    /// The probability, before it was made, of something at least so far off.
    pub p_value: f64,
    /// Whether all other measurements are the reason, or the prior alone.
    pub with_others: bool,
}

impl Conflict {
    /// In words.
    pub fn words(&self) -> String {
        let with = if self.with_others {
            "the other measurements and the prior"
        } else {
            "the prior"
        };
        format!(
            "{} hardly agrees with {with}: something so far off had a probability of {}",
            self.name,
            compact(rounded(self.p_value))
        )
    }
}

/// To two digits.
fn rounded(p: f64) -> f64 {
    format!("{p:.1e}").parse().unwrap_or(p)
}

/// Points with their weights.
type Points<'a> = (&'a [Vec<f64>], &'a [f64]);

/// Refuses measurements that contradict their prior.
///
/// # Errors
/// [`CalibrationError::Config`], with a caret at each such measurement.
pub(crate) fn refuse(model: &Model) -> Result<Vec<Conflict>, CalibrationError> {
    let dimensions = model.observed.priors.len();
    let prior = points::normal(model.observed.plan.seed, Use::Round(0), dimensions, POINTS);
    let weights = vec![1.0 / POINTS as f64; prior.len()];
    let terms = model.observed.places.len();
    let mut conflicts = vec![];
    let mut problems = vec![];
    for term in 0..terms {
        let p_value = p_value(model, term, (&prior, &weights));
        if p_value < REFUSED {
            let message = format!(
                "{} contradicts the prior: {}, and something so far off has a probability of {}",
                model.name(term),
                expected(model, term, &prior),
                if p_value < 1e-12 {
                    "less than 1e-12".to_owned()
                } else {
                    compact(rounded(p_value))
                }
            );
            let help = "check the reading, its unit and its error, or widen the prior in [prior]";
            let place = &model.observed.places[term];
            problems.push(place.problem(message, Some(help.to_owned())));
            continue;
        }
        conflicts.extend(conflict(model, term, p_value, false));
    }
    match problems.into_iter().reduce(Diagnostics::and) {
        Some(problems) => Err(problems.into()),
        None => Ok(conflicts),
    }
}

/// Measurements that all others together hardly allow: each is left out once.
///
/// # Errors
/// [`CalibrationError::Contradiction`].
pub(crate) fn between(model: &Model) -> Result<Vec<Conflict>, CalibrationError> {
    let terms = model.observed.places.len();
    let mut conflicts = vec![];
    if terms < 2 {
        return Ok(conflicts);
    }
    for left_out in 0..terms {
        let others = posterior::sample(model, &|scores| {
            let terms = model.terms(scores).enumerate();
            terms
                .filter(|(term, _)| *term != left_out)
                .map(|(_, log)| log)
                .sum()
        })?;
        let p_value = p_value(model, left_out, (&others.points, &others.weights));
        conflicts.extend(conflict(model, left_out, p_value, true));
    }
    Ok(conflicts)
}

/// What is remarked on of a measurement, if so small a probability is worth it.
fn conflict(model: &Model, term: usize, p_value: f64, with_others: bool) -> Option<Conflict> {
    let is_remarkable = p_value < REMARKED / model.observed.places.len() as f64;
    is_remarkable.then(|| Conflict {
        name: model.name(term).to_owned(),
        p_value,
        with_others,
    })
}

/// The probability of a measurement at least so far off, on either side, over weighted points.
fn p_value(model: &Model, term: usize, (points, weights): Points<'_>) -> f64 {
    let counts = &model.observed.counts;
    if let Some(counted) = counts.get(term) {
        let tosses: u64 = counted.faces.iter().sum();
        let chances = &model.counted[term];
        let faces: Vec<[f64; 3]> = points.iter().map(|z| chances.at(&reached(z))).collect();
        let tails = [0, 1, 2].map(|face| {
            // a continuity correction, so that 0 of a rare face is no surprise
            let share = |by: f64| (counted.faces[face] as f64 + by) / tosses as f64;
            let below = |share: f64| -> f64 {
                let of = |(p, weight): (&[f64; 3], &f64)| {
                    let error = chances.variance_of_share(p[face], tosses).sqrt();
                    weight * normal_cdf((share - p[face]) / error.max(1e-12))
                };
                faces.iter().zip(weights).map(of).sum()
            };
            let (low, high) = (below(share(0.5)), 1.0 - below(share(-0.5)));
            2.0 * low.min(high)
        });
        // one of three faces
        return tails.iter().map(|p| (3.0 * p).min(1.0)).fold(1.0, f64::min);
    }
    let reading = &model.observed.readings[term - counts.len()];
    let place = model.place(reading.law.parameter());
    let mut tails = [0.0, 0.0];
    for (z, weight) in points.iter().zip(weights) {
        let predicted = reading.law.at(model.observed.priors[place].value(z[place]));
        let off = (reading.value - predicted) / reading.error_at(predicted);
        tails[0] += weight * normal_cdf(off);
        tails[1] += weight * normal_cdf(-off);
    }
    (2.0 * tails[0].min(tails[1])).min(1.0)
}

/// What was measured and what was expected, in words.
fn expected(model: &Model, term: usize, prior: &[Vec<f64>]) -> String {
    let counts = &model.observed.counts;
    if let Some(counted) = counts.get(term) {
        let n = prior.len() as f64;
        let mut means = [0.0; 3];
        for z in prior {
            let faces = model.counted[term].at(&reached(z));
            for (mean, p) in means.iter_mut().zip(faces) {
                *mean += p / n;
            }
        }
        let [heads, tails, side] = counted.faces;
        let tosses = (heads + tails + side) as f64;
        let [a, b, c] = means.map(|p| (p * tosses).round());
        return format!(
            "{heads}, {tails} and {side} heads, tails and side were counted, about {a}, {b} and {c} expected"
        );
    }
    let reading: &Reading = &model.observed.readings[term - counts.len()];
    let parameter: Parameter = reading.law.parameter();
    let found = reading.law.inverse(reading.value);
    let prior = &model.observed.priors[model.place(parameter)];
    let three = |x: f64| format!("{x:.2e}").parse().unwrap_or(x);
    format!(
        "it gives {} = {}, expected from {} to {} ({})",
        parameter.key(),
        compact(three(found)),
        compact(three(prior.low)),
        compact(three(prior.high)),
        prior.source
    )
}

/// The standard normal distribution function.
fn normal_cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z / 2.0_f64.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Kind, Observations, Settings};
    use coinmc_questions::Workers;
    use std::sync::atomic::AtomicBool;

    /// Measurements that each contradict the prior are all refused at once, and those that agree are not.
    #[test]
    fn all_measurements_that_contradict_the_prior_are_told() {
        let text = "coin.ratio = 0.2\nsurface = { restitution = 0.5, friction = 0.3 }\n\
                    launch.preset = 'robot'\nengine.flat = {}\n\
                    [[tilt]]\nangle_deg = 80\n[[tilt]]\nangle_deg = 17\n\
                    [[bounces]]\ndrop_height_m = 0.1\ntime_s = [0, 0.28]\n";
        let observed = Observations::parse("inline", text, &[], "".as_ref()).unwrap();
        let settings = Settings {
            points: 64,
            tosses: 32,
            ..Settings::default()
        };
        let workers = Workers {
            threads: None,
            cancel: &AtomicBool::new(false),
            made: &|_| (),
        };
        let model = Model::new(observed, settings, &workers).unwrap();
        let message = refuse(&model).unwrap_err().to_string();
        for (name, told) in [("tilt 1", true), ("tilt 2", false), ("bounces 1", true)] {
            let refused = message.contains(&format!("{name} contradicts"));
            assert_eq!(refused, told, "{name}: {message}");
        }
        // of some kinds only, each still has its own place
        for (kind, name, line) in [(Kind::Tilt, "tilt 1", 5), (Kind::Bounces, "bounces 1", 9)] {
            let message = refuse(&model.with_kinds(&[kind])).unwrap_err().to_string();
            assert!(
                message.contains(&format!("{name} contradicts")),
                "{message}"
            );
            assert_eq!(message.matches("contradicts").count(), 1, "{message}");
            assert!(message.contains(&format!("inline:{line}:")), "{message}");
        }
        assert!(refuse(&model.with_kinds(&[])).is_ok());
    }
}
