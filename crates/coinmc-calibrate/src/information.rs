//! Which further measurement would sharpen the answer most.
//!
//! Before a measurement is made its information can be expected: that about the surface is
//! ½ log₂(1 + Var f/σ²) bits for a quantity f with the standard error σ, and it takes the variance of P(side)
//! from V to V (1 − r² Var f/(Var f + σ²)), with r the correlation of f and P(side) over the posterior; both are
//! exact for normal distributions.

use crate::measured::{Kind, Law, whirr_rate};
use crate::model::Model;
use crate::posterior::{Posterior, correlation, moments};
use crate::rolls::{ROLLS, Rolls};
use crate::{CalibrationError, Parameter, prediction};
use coinmc_questions::Workers;

/// A measurement that could be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Suggestion {
    /// Of which kind.
    pub kind: Kind,
    /// What to do.
    pub what: String,
    /// Expected information about the surface, bits.
    pub bits: f64,
    /// Expected standard deviation of P(side) by its parameters afterwards.
    pub side_after: f64,
}

/// A measurement of a number, as a person can make it in some minutes.
struct Candidate {
    kind: Kind,
    what: &'static str,
    law: Law,
    absolute: f64,
    relative: f64,
}

/// Numbers of further tosses.
const TOSSES: [u64; 2] = [100, 1000];

/// All measurements that could be made, the one that sharpens P(side) most first, and how many tosses were
/// made to know that.
///
/// # Errors
/// [`CalibrationError`] if tosses fail or are stopped.
pub(crate) fn suggestions(
    model: &Model,
    posterior: &Posterior,
    workers: &Workers<'_>,
) -> Result<(Vec<Suggestion>, u64), CalibrationError> {
    let faces = prediction::fitted(model, &posterior.scores);
    let side: Vec<f64> = faces.iter().map(|faces| faces[2]).collect();
    let (_, now) = moments(&side);
    let known = model.parameters();
    let candidates = candidates(model);
    let possible = candidates
        .iter()
        .filter(|candidate| known.contains(&candidate.law.parameter()));
    let mut all: Vec<Suggestion> = possible
        .map(|candidate| of_number(candidate, model, posterior, &side, now))
        .collect();
    let worth = |tosses: u64| model.predicted.worth(tosses);
    let counted = counted_already(model);
    let so_far = if counted > 0 { worth(counted) } else { 0.0 };
    all.extend(TOSSES.map(|tosses| {
        let gained = worth(counted + tosses) - so_far;
        of_tosses(tosses, gained, &faces, now)
    }));
    let rough = known.contains(&Parameter::RoughnessSlope);
    let (rolls, tosses) = if rough {
        Rolls::of(model, posterior, &side, workers)?
    } else {
        (None, 0)
    };
    all.extend(rolls.map(|rolls| of_rolls(&rolls, now)));
    all.sort_by(|a, b| {
        let by_side = a.side_after.total_cmp(&b.side_after);
        by_side.then(b.bits.total_cmp(&a.bits))
    });
    Ok((all, tosses))
}

fn of_number(
    candidate: &Candidate,
    model: &Model,
    posterior: &Posterior,
    side: &[f64],
    now: f64,
) -> Suggestion {
    let place = model.place(candidate.law.parameter());
    let values: Vec<f64> = posterior
        .draws
        .iter()
        .map(|draw| candidate.law.at(draw[place]))
        .collect();
    let (mean, sd) = moments(&values);
    let relative = candidate.relative * mean;
    let error = candidate.absolute * candidate.absolute + relative * relative;
    let gained = sd * sd / error;
    let r = correlation(&values, side);
    Suggestion {
        kind: candidate.kind,
        what: candidate.what.to_owned(),
        bits: 0.5 * libm::log2(1.0 + gained),
        side_after: now * (1.0 - r * r * gained / (1.0 + gained)).max(0.0).sqrt(),
    }
}

/// Tosses that are counted in the scene to predict: more of them share the error of its fit.
fn counted_already(model: &Model) -> u64 {
    let scene = &model.observed.predicted.resolved_toml;
    let same = model.observed.counts.iter();
    let same = same.filter(|counted| counted.plan.resolved_toml == *scene);
    same.flat_map(|counted| counted.faces).sum()
}

/// Further tosses, worth `n` with exact probabilities, measure P(heads) and P(side), with the covariance of multinomial shares.
fn of_tosses(tosses: u64, n: f64, faces: &[[f64; 3]], now: f64) -> Suggestion {
    let column = |face: usize| faces.iter().map(|faces| faces[face]).collect::<Vec<_>>();
    let (heads, side) = (column(0), column(2));
    let ((h, sd_h), (s, sd_s)) = (moments(&heads), moments(&side));
    let r = correlation(&heads, &side);
    // I + Σ⁻¹V of the two shares, by its determinant
    let noise = [
        [h * (1.0 - h) / n, -h * s / n],
        [-h * s / n, s * (1.0 - s) / n],
    ];
    let spread = [
        [sd_h * sd_h, r * sd_h * sd_s],
        [r * sd_h * sd_s, sd_s * sd_s],
    ];
    let determinant = |m: [[f64; 2]; 2]| m[0][0] * m[1][1] - m[0][1] * m[1][0];
    let sum = [0, 1].map(|i| [0, 1].map(|j| noise[i][j] + spread[i][j]));
    let whole = determinant(noise);
    let bits = if whole > 0.0 {
        0.5 * libm::log2((determinant(sum) / whole).max(1.0))
    } else {
        0.0
    };
    let own = noise[1][1];
    let share = if own > 0.0 {
        now * now / (now * now + own)
    } else {
        1.0
    };
    Suggestion {
        kind: Kind::Counts,
        what: format!("count {tosses} tosses more"),
        bits,
        side_after: now * (1.0 - share).max(0.0).sqrt(),
    }
}

/// Coins that roll upright measure how often they stay up.
fn of_rolls(rolls: &Rolls, now: f64) -> Suggestion {
    let whole = rolls.variance + rolls.noise;
    let (bits, explained) = if rolls.noise > 0.0 {
        let bits = 0.5 * libm::log2(whole / rolls.noise);
        (bits, rolls.covariance * rolls.covariance / whole)
    } else {
        (0.0, 0.0)
    };
    Suggestion {
        kind: Kind::Counts,
        what: format!("set the coin rolling upright {ROLLS} times and count how often it stays up"),
        bits,
        side_after: (now * now - explained).max(0.0).sqrt(),
    }
}

/// Measurements that take some minutes, with the errors that their tables have by default.
fn candidates(model: &Model) -> [Candidate; 5] {
    let scene = &model.observed.predicted.points[0].scene;
    let times = |parameter, factor| Law::Times(parameter, factor);
    [
        Candidate {
            kind: Kind::Bounces,
            what: "drop the coin flat from 10 cm three times and time the first two bounces",
            law: Law::LogRestitution,
            absolute: 0.035,
            relative: 0.0,
        },
        Candidate {
            kind: Kind::Tilt,
            what: "tilt the surface until the coin slides, three times",
            law: Law::SlidingAngle,
            absolute: 0.6,
            relative: 0.0,
        },
        Candidate {
            kind: Kind::RollOut,
            what: "let the coin roll down a ramp of 1 cm, three times each way",
            law: times(Parameter::RollingFriction, 1.0 / scene.coin.radius_m()),
            absolute: 0.0,
            relative: 0.065,
        },
        Candidate {
            kind: Kind::Whirr,
            what: "record how the coin whirrs and read its pitch at five times",
            law: times(Parameter::RollingFriction, whirr_rate(scene)),
            absolute: 0.0,
            relative: 0.08,
        },
        Candidate {
            kind: Kind::SpinDown,
            what: "film how the coin, spinning on the spot, loses 20 rad/s",
            law: times(
                Parameter::PivotingFriction,
                scene.gravity_m_s2() / scene.coin.transverse_gyration_m2(),
            ),
            absolute: 0.0,
            relative: 0.07,
        },
    ]
}
