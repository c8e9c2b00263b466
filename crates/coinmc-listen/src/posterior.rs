//! Restitution, friction and rolling friction from the bounces of drops, without a likelihood.
//!
//! Surfaces are drawn from the prior, as many drops as there are recordings are simulated on each, and what would
//! be heard of them is compared with what is heard: approximate Bayesian computation with regression adjustment
//! (Beaumont, Zhang & Balding, Genetics 162 (2002) 2025) on summaries that a first regression finds (Fearnhead &
//! Prangle, J. R. Stat. Soc. B 74 (2012) 419).

use crate::error::ListenError;
use crate::heard::{Bounces, FEATURE_NAMES, FEATURES};
use crate::regression::{Regression, quadratic};
use crate::struck::Tosser;
use coinmc::plan::Point;
use coinmc_calibrate::{CalibrationError, Observations, OutOfRange, Parameter, Prior, point_with};
use coinmc_core::{Domain, Stream, inverse_normal_cdf, unit_interval};
use coinmc_quadrature::Sobol;
use coinmc_questions::{QuestionError, Workers};
use std::sync::atomic::Ordering;

/// Surfaces of one piece of work.
const PIECE: usize = 64;
/// How often a drop is simulated until more than one impact is heard.
const TRIES: u64 = 8;
/// Share of the surfaces whose drops are nearest to what is heard, on which the posterior rests.
const NEAREST: f64 = 0.02;
/// Share of simulated drops on each side beyond which what is heard is not of this scene.
const BEYOND: f64 = 0.001;
/// Share of those nearest below which what is heard is remarked on.
const ODD: f64 = 0.01;

/// How much work to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Surfaces drawn from the prior.
    pub surfaces: u64,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            surfaces: 20_000,
            seed: 1,
        }
    }
}

/// What is known of one parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimated {
    /// Its prior.
    pub prior: Prior,
    /// Posterior mean.
    pub mean: f64,
    /// Posterior median.
    pub median: f64,
    /// Ends of the central 95 %.
    pub interval: [f64; 2],
    /// Standard deviation of the posterior on the prior's scale, as a share of the prior's.
    pub spread_left: f64,
}

/// What drops tell of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct FromDrops {
    /// Each parameter.
    pub parameters: Vec<Estimated>,
    /// Surfaces on which the posterior rests.
    pub nearest: usize,
    /// Drops simulated, but for those of a single impact, which are made again.
    pub drops: u64,
    /// What is odd about what is heard; empty if nothing is.
    pub doubts: Vec<String>,
}

/// A surface and what is heard on it.
struct Simulated {
    z: Vec<f64>,
    features: Vec<f64>,
}

impl FromDrops {
    /// Compares what is heard of drops with simulated drops of the scene.
    ///
    /// # Errors
    /// [`ListenError`] if the scene makes no such tosses, or these are stopped.
    pub fn of(
        heard: &[Bounces],
        observed: &Observations,
        effort: Effort,
        workers: &Workers<'_>,
    ) -> Result<Self, ListenError> {
        if !(500..=10_000_000).contains(&effort.surfaces) {
            let beyond = OutOfRange {
                name: "surfaces",
                what: "the number of surfaces",
                least: 500,
                most: 10_000_000,
                given: effort.surfaces,
            };
            return Err(CalibrationError::OutOfRange(vec![beyond]).into());
        }
        if !observed.parameters().contains(&Parameter::RollingFriction) {
            return Err(ListenError::NotSpatial);
        }
        let simulated = simulate(heard, observed, effort, workers)?;
        let seen = mean_features(heard.iter().map(Bounces::features));
        let (nearest, doubts) = nearest(&simulated, &seen);
        Ok(Self {
            parameters: estimated(&observed.priors, &nearest),
            nearest: nearest.len(),
            drops: effort.surfaces * heard.len() as u64,
            doubts,
        })
    }
}

/// Drops on surfaces of the prior. Surfaces on which nothing would be heard are left out.
fn simulate(
    heard: &[Bounces],
    observed: &Observations,
    effort: Effort,
    workers: &Workers<'_>,
) -> Result<Vec<Simulated>, ListenError> {
    let mut words = Stream::new(effort.seed, Domain::Scramble, 0).toss(0);
    let sobol = Sobol::scrambled(observed.priors.len(), &mut words);
    let stream = Stream::new(effort.seed, Domain::Launch, 0);
    let loudness = Stream::new(effort.seed, Domain::Acceptance, 0);
    let pieces = usize::try_from(effort.surfaces)
        .unwrap_or(usize::MAX)
        .div_ceil(PIECE);
    let done = workers.each(pieces, &|piece| {
        let first = (piece * PIECE) as u64;
        let range = first..(first + PIECE as u64).min(effort.surfaces);
        let mut simulated = vec![];
        for (surface, point) in range.clone().zip(sobol.points(range)) {
            if workers.cancel.load(Ordering::Relaxed) {
                return Err(ListenError::Question(QuestionError::Stopped));
            }
            let z: Vec<f64> = point[..observed.priors.len()]
                .iter()
                .map(|word| inverse_normal_cdf(unit_interval(*word)))
                .collect();
            let tosser = Tosser::new(&on_surface(observed, &z)?)?;
            let scene = &observed.plan.points[0];
            let drops = heard.iter().enumerate().map(|(drop, like)| {
                let number = surface * heard.len() as u64 + drop as u64;
                // a recording with a single impact is none of a drop, so it is simulated again
                (0..TRIES).find_map(|again| {
                    let uniforms = &mut stream.toss(number * TRIES + again);
                    let launch = scene.launches.launch(&scene.scene.coin, uniforms);
                    let struck = tosser.strikes(&launch);
                    let uniforms = &mut loudness.toss(number * TRIES + again);
                    let bounces = Bounces::of_toss(&struck, like.least, uniforms)?;
                    (bounces.times_s.len() > 1).then(|| bounces.features())
                })
            });
            if let Some(features) = drops.collect::<Option<Vec<_>>>() {
                simulated.push(Simulated {
                    z,
                    features: mean_features(features.into_iter()),
                });
            }
        }
        (workers.made)(PIECE as u64 * heard.len() as u64);
        Ok(simulated)
    })?;
    Ok(done.into_iter().flatten().collect())
}

/// The scene on the surface with these scores of the priors.
pub(crate) fn on_surface(observed: &Observations, z: &[f64]) -> Result<Point, ListenError> {
    let known: Vec<Parameter> = observed
        .priors
        .iter()
        .map(|prior| prior.parameter)
        .collect();
    let priors = observed.priors.iter().zip(z);
    let values: Vec<f64> = priors.map(|(prior, z)| prior.value(*z)).collect();
    let point = point_with(&observed.plan, &known, &values);
    Ok(point.map_err(crate::struck::StruckError::Surface)?)
}

fn mean_features(each: impl Iterator<Item = [f64; FEATURES]>) -> Vec<f64> {
    let mut sums = [0.0; FEATURES];
    let mut count = 0.0;
    for features in each {
        count += 1.0;
        for (sum, feature) in sums.iter_mut().zip(features) {
            *sum += feature;
        }
    }
    sums.iter().map(|sum| sum / f64::max(count, 1.0)).collect()
}

/// The scores of the surfaces nearest to what is heard, moved to it, with their weights; and doubts.
fn nearest(simulated: &[Simulated], seen: &[f64]) -> (Vec<(Vec<f64>, f64)>, Vec<String>) {
    let mut doubts = beyond(simulated, seen);
    let rows: Vec<Vec<f64>> = simulated.iter().map(|s| quadratic(&s.features)).collect();
    let scores: Vec<Vec<f64>> = simulated.iter().map(|s| s.z.clone()).collect();
    let ones = vec![1.0; rows.len()];
    let Some(first) = Regression::fit(&rows, &scores, &ones) else {
        doubts.push("the simulated drops tell nothing apart".to_owned());
        return (scores.into_iter().map(|z| (z, 1.0)).collect(), doubts);
    };
    let summaries: Vec<Vec<f64>> = rows.iter().map(|row| first.at(row)).collect();
    let target = first.at(&quadratic(seen));
    let scale = spreads(&summaries);
    let distance = |summary: &Vec<f64>| -> f64 {
        let each = summary.iter().zip(&target).zip(&scale);
        each.map(|((s, t), scale)| ((s - t) / scale) * ((s - t) / scale))
            .sum::<f64>()
            .sqrt()
    };
    let mut order: Vec<(f64, usize)> = summaries.iter().map(distance).zip(0..).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let keep = ((NEAREST * order.len() as f64) as usize)
        .max(100)
        .min(order.len());
    order.truncate(keep);
    let width = order
        .last()
        .map_or(1.0, |last| last.0)
        .max(f64::MIN_POSITIVE);
    let weights: Vec<f64> = order
        .iter()
        .map(|(d, _)| (1.0 - (d / width) * (d / width)).max(1e-9))
        .collect();
    let near = |of: &dyn Fn(usize) -> Vec<f64>| -> Vec<Vec<f64>> {
        order.iter().map(|(_, place)| of(*place)).collect()
    };
    let with_one = |summary: &[f64]| [&[1.0], summary].concat();
    let local_rows = near(&|place| with_one(&summaries[place]));
    let local_scores = near(&|place| scores[place].clone());
    if let Some(doubt) = odd(&near(&|place| simulated[place].features.clone()), seen) {
        doubts.push(doubt);
    }
    let moved = match Regression::fit(&local_rows, &local_scores, &weights) {
        Some(local) => {
            let there = local.at(&with_one(&target));
            let each = local_rows.iter().zip(&local_scores);
            each.map(|(row, z)| {
                let here = local.at(row);
                z.iter()
                    .zip(&here)
                    .zip(&there)
                    .map(|((z, here), there)| z - here + there)
                    .collect()
            })
            .collect()
        }
        None => local_scores,
    };
    (moved.into_iter().zip(weights).collect(), doubts)
}

/// The standard deviation of each column.
fn spreads(rows: &[Vec<f64>]) -> Vec<f64> {
    let n = rows.len().max(1) as f64;
    let columns = rows.first().map_or(0, Vec::len);
    let of = |column: usize| {
        let mean = rows.iter().map(|row| row[column]).sum::<f64>() / n;
        let off = rows
            .iter()
            .map(|row| (row[column] - mean) * (row[column] - mean));
        (off.sum::<f64>() / n).sqrt().max(1e-9)
    };
    (0..columns).map(of).collect()
}

/// Features beyond nearly all that is simulated.
fn beyond(simulated: &[Simulated], seen: &[f64]) -> Vec<String> {
    let n = simulated.len() as f64;
    let mut doubts = vec![];
    for (place, name) in FEATURE_NAMES.iter().enumerate() {
        let share = |count: usize| count as f64 / n;
        let values = || simulated.iter().map(|s| s.features[place]);
        let below = share(values().filter(|value| *value < seen[place]).count());
        let above = share(values().filter(|value| *value > seen[place]).count());
        let sides = if name.starts_with("number") {
            ["larger", "smaller"]
        } else {
            ["longer", "shorter"]
        };
        let (side, share) = if above < below {
            (sides[0], above)
        } else {
            (sides[1], below)
        };
        let equal = values().any(|value| (value - seen[place]).abs() < 1e-9);
        if share < BEYOND && !equal {
            doubts.push(format!(
                "the {name} is {side} than in nearly all simulated drops: are height, coin and launch right?"
            ));
        }
    }
    doubts
}

/// Whether the features together are odd among those of the nearest surfaces.
fn odd(near: &[Vec<f64>], seen: &[f64]) -> Option<String> {
    let rank = Regression::share_farther(near, seen)?;
    (rank < ODD).then(|| {
        format!(
            "of the drops simulated on the nearest surfaces only {:.1} % are as unusual as what is heard",
            100.0 * rank
        )
    })
}

fn estimated(priors: &[Prior], nearest: &[(Vec<f64>, f64)]) -> Vec<Estimated> {
    let of = |(place, prior): (usize, &Prior)| {
        let mut draws: Vec<(f64, f64)> = nearest.iter().map(|(z, w)| (z[place], *w)).collect();
        draws.sort_by(|a, b| a.0.total_cmp(&b.0));
        let total: f64 = draws.iter().map(|draw| draw.1).sum();
        let quantile = |share: f64| {
            let mut sum = 0.0;
            let found = draws.iter().find(|draw| {
                sum += draw.1;
                sum >= share * total
            });
            prior.value(found.or(draws.last()).map_or(0.0, |draw| draw.0))
        };
        let mean =
            |of: &dyn Fn(f64) -> f64| draws.iter().map(|(z, w)| w * of(*z)).sum::<f64>() / total;
        let middle = mean(&|z| z);
        Estimated {
            prior: prior.clone(),
            mean: mean(&|z| prior.value(z)),
            median: quantile(0.5),
            interval: [quantile(0.025), quantile(0.975)],
            spread_left: mean(&|z| (z - middle) * (z - middle)).sqrt(),
        }
    };
    priors.iter().enumerate().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Heard, Kind, Synthetic};
    use std::sync::atomic::AtomicBool;

    /// A few drops tell the restitution, and drops from another height are doubted.
    #[test]
    fn restitution_comes_from_drops_and_a_wrong_height_is_doubted() {
        let scene = |height: f64| {
            let text = format!(
                "coin = {{ ratio = 0.16, radius_m = 0.0116 }}\nprior.material = 'wood'\n\
                 surface = {{ restitution = 0.58, friction = 0.3 }}\nengine.volumetric = {{}}\n\
                 launch = {{ height_m = {height}, spin.isotropic_sd_rad_s = 1,\n\
                 orientation.tilt_deg = {{ normal = {{ mean = 0, sd = 8 }} }} }}"
            );
            Observations::parse("inline", &text, &[], "".as_ref()).unwrap()
        };
        let observed = scene(0.15);
        let point = &observed.plan.points[0];
        let stream = Stream::new(5, Domain::Launch, 0);
        let heard = |toss: u64| {
            let uniforms = &mut stream.toss(toss);
            let launch = point.launches.launch(&point.scene.coin, uniforms);
            let recording = Synthetic::default().recording(point, &launch).unwrap();
            let heard = Heard::of(&recording, Some(&point.scene), Some(Kind::Drop));
            heard.bounces.unwrap()
        };
        let drops: Vec<Bounces> = (0..4).map(heard).collect();
        let cancel = AtomicBool::new(false);
        let workers = Workers {
            threads: None,
            cancel: &cancel,
            made: &|_| (),
        };
        let effort = Effort {
            surfaces: 2000,
            seed: 1,
        };
        let found = FromDrops::of(&drops, &observed, effort, &workers).unwrap();
        let e = &found.parameters[0];
        assert!((e.median - 0.58).abs() < 0.05, "{e:?}");
        assert!(
            e.interval[0] < 0.58 && e.interval[1] > 0.58 && e.spread_left < 0.6,
            "{e:?}"
        );
        assert!(found.doubts.is_empty(), "{:?}", found.doubts);
        let wrong = FromDrops::of(&drops, &scene(0.02), effort, &workers).unwrap();
        assert!(!wrong.doubts.is_empty());
        let few = Effort {
            surfaces: 10,
            seed: 1,
        };
        assert!(FromDrops::of(&drops, &observed, few, &workers).is_err());
    }

    /// Flights are longer or shorter than simulated ones, and numbers of bounces larger or smaller.
    #[test]
    fn a_doubt_says_to_which_side_something_is_odd() {
        let simulated: Vec<Simulated> = (0..1000_u32)
            .map(|k| Simulated {
                z: vec![],
                features: vec![f64::from(k); FEATURES],
            })
            .collect();
        let mut seen = vec![499.5; FEATURES];
        assert!(beyond(&simulated, &seen).is_empty());
        (seen[0], seen[1]) = (-1.0, 2000.0);
        seen[5] = 2000.0;
        let doubts = beyond(&simulated, &seen).join("\n");
        for told in [
            "the longest flight is shorter",
            "the second longest flight is longer",
            "the number of bounces is larger",
        ] {
            assert!(doubts.contains(told), "{doubts}");
        }
        assert_eq!(doubts.lines().count(), 3);
    }
}
