//! From a data set to its p-value.

use super::published::{Number, Seen, numbers};
use super::{DataSet, Experiment, Line, Predicted, Predictor};
use crate::ValidateError;
use crate::predictive::{self, Model, Surprise};
use crate::prior::Draw;
use crate::tosser::{Scene, Tosser};
use coinmc_analytic::precession::thin::p_same_side;
use coinmc_core::inverse_normal_cdf;
use coinmc_core::{Estimate, IntervalMethod};
use std::collections::HashMap;

const FAIR: f64 = 1.0 / 3.0;
/// The angle of each toss of a person scatters about the person's own with this, degrees: as in the preset `hand`.
const PSI_SD_DEG: f64 = 5.0;
/// Places at which that scatter is averaged.
const PLACES: u32 = 64;

/// The draws of a validation, and the tosses of each experiment that several sets share.
pub(crate) struct Draws<'a> {
    pub(crate) tosser: Tosser<'a>,
    pub(crate) people: Vec<Draw>,
    /// Tosses of each draw and ratio.
    pub(crate) tosses: u64,
    /// Tosses of each ratio of a scene that is stated in full.
    pub(crate) stated_tosses: u64,
    known: HashMap<(&'static str, u64), Vec<Model>>,
}

impl<'a> Draws<'a> {
    pub(crate) fn new(tosser: Tosser<'a>, draws: Vec<Draw>, [tosses, stated]: [u64; 2]) -> Self {
        Self {
            tosser,
            people: draws,
            tosses,
            stated_tosses: stated,
            known: HashMap::new(),
        }
    }

    /// P(side) at each ratio, of each draw.
    fn of(
        &mut self,
        experiment: &'static Experiment,
        ratios: &[f64],
        stated: bool,
    ) -> Result<Vec<Vec<Model>>, ValidateError> {
        let key = |ratio: f64| (experiment.name, ratio.to_bits());
        let missing = |ratio: &f64| !self.known.contains_key(&key(*ratio));
        let missing: Vec<f64> = ratios.iter().copied().filter(missing).collect();
        if !missing.is_empty() {
            let scenes: Vec<_> = if stated {
                vec![scene(experiment, &missing, None)]
            } else {
                let of = |draw| scene(experiment, &missing, Some(draw));
                self.people.iter().map(of).collect()
            };
            let results = if stated {
                let tosses = self.stated_tosses;
                vec![self.tosser.toss(&scenes[0], tosses, tosses)?]
            } else {
                self.tosser.toss_each(&scenes, self.tosses)?
            };
            for (place, ratio) in missing.iter().enumerate() {
                let models = results.iter().map(|results| {
                    let tally = &results.rows[place].tally;
                    Model::Counted {
                        shown: tally.side,
                        // tosses without a face could not have been counted by anybody
                        tosses: tally.heads + tally.tails + tally.side,
                    }
                });
                self.known.insert(key(*ratio), models.collect());
            }
        }
        Ok(ratios
            .iter()
            .map(|ratio| self.known[&key(*ratio)].clone())
            .collect())
    }
}

/// An experiment as a config: with what it states, and the numbers of a draw.
fn scene(experiment: &Experiment, ratios: &[f64], draw: Option<&Draw>) -> Scene {
    let text = match (experiment.config, draw) {
        (Some(text), _) => text.to_owned(),
        (None, Some(draw)) => draw.scene.config(),
        (None, None) => unreachable!("an experiment without a config is drawn"),
    };
    let place = draw.map_or(String::new(), |draw| format!("-{:04}", draw.index));
    let mut scene = Scene::new(format!("sets/{}{place}", name(experiment, ratios)), text);
    for setting in experiment.settings {
        scene = scene.with(*setting);
    }
    for (key, number) in draw.iter().flat_map(|draw| &draw.numbers) {
        if experiment.drawn.iter().any(|start| key.starts_with(start)) {
            scene = scene.with(format!("{key}={number:?}"));
        }
    }
    scene.with(format!("coin.ratio={ratios:?}"))
}

/// Sets that share an experiment but not its ratios have directories of their own.
fn name(experiment: &Experiment, ratios: &[f64]) -> String {
    format!("{}-{:.3}", experiment.name, ratios[0])
}

/// Predicts a data set.
pub(crate) fn predict(
    set: &'static DataSet,
    draws: &mut Draws<'_>,
) -> Result<Predicted, ValidateError> {
    let numbers: Vec<_> = numbers(set.name).collect();
    let lines = match set.by {
        Predictor::Nothing(_) => vec![],
        Predictor::Prior(experiment) => tossed(&numbers, experiment, false, draws)?,
        Predictor::Stated(experiment) => tossed(&numbers, experiment, true, draws)?,
        Predictor::Caught => {
            let caught: Vec<_> = draws.people.iter().map(caught).collect();
            numbers.iter().map(|n| of_models(n, &caught)).collect()
        }
        Predictor::Even => {
            let even = [Model::Known(0.5)];
            numbers.iter().map(|n| of_models(n, &even)).collect()
        }
        Predictor::Arc => numbers.iter().map(|n| arc(n)).collect(),
    };
    // chosen after the fact, so each line counts as all that it was chosen from
    let tests: u64 = numbers.iter().map(|number| tests(number)).sum();
    let least = lines
        .iter()
        .min_by(|a: &&Line, b: &&Line| a.p_value.total_cmp(&b.p_value));
    Ok(Predicted {
        set,
        p_value: least.map(|line| (line.p_value * tests as f64).min(1.0)),
        p_error: least.map_or(0.0, |line| line.p_error * tests as f64),
        lines,
    })
}

fn tests(number: &Number) -> u64 {
    match number.seen {
        Seen::Count { chosen_from, .. } => chosen_from,
        Seen::Value(_) | Seen::FairRatio(_) => 1,
    }
}

/// Lines of a set whose coins are tossed by the engine.
fn tossed(
    numbers: &[&Number],
    experiment: &'static Experiment,
    stated: bool,
    draws: &mut Draws<'_>,
) -> Result<Vec<Line>, ValidateError> {
    // all ratios at once: they share a run
    let ratios_of = |number: &Number| {
        let ratio = number.ratio.expect("a coin that is tossed has a thickness");
        match number.seen {
            Seen::FairRatio(arm) if arm > 0.0 => vec![ratio, ratio - arm, ratio + arm],
            _ => vec![ratio],
        }
    };
    let all: Vec<f64> = numbers.iter().flat_map(|n| ratios_of(n)).collect();
    draws.of(experiment, &all, stated)?;
    let mut lines = vec![];
    for number in numbers {
        let models = draws.of(experiment, &ratios_of(number), stated)?;
        lines.push(match (&number.seen, &models[..]) {
            (Seen::FairRatio(_), [middle, low, high]) => {
                let ends = low.iter().zip(high).map(|(low, high)| [*low, *high]);
                let surprise = predictive::fair_ratio(&ends.collect::<Vec<_>>(), FAIR);
                let own = [middle, low, high].map(|models| own_tosses(models));
                Line {
                    own_tosses: own.iter().sum(),
                    ..line(number, FAIR, middle, surprise)
                }
            }
            (_, models) => of_models(number, &models[0]),
        });
    }
    Ok(lines)
}

/// A line by what each draw says of it.
fn of_models(number: &Number, models: &[Model]) -> Line {
    match number.seen {
        Seen::Count { shown, tosses, .. } => {
            let surprise = predictive::count(models, shown, tosses);
            line(number, shown as f64 / tosses as f64, models, surprise)
        }
        Seen::Value(p) => line(number, p, models, predictive::value(models, p)),
        Seen::FairRatio(_) => line(number, FAIR, models, predictive::value(models, FAIR)),
    }
}

fn arc(number: &Number) -> Line {
    let ratio = number.ratio.expect("a ratio");
    of_models(number, &[Model::Known(coinmc_analytic::arc::p_side(ratio))])
}

fn line(number: &Number, seen: f64, models: &[Model], surprise: Surprise) -> Line {
    let (quantity, tosses) = match number.seen {
        Seen::Count {
            face: "side",
            tosses,
            ..
        } => ("P(side)", tosses),
        Seen::Count {
            face: "heads",
            tosses,
            ..
        } => ("P(heads)", tosses),
        Seen::Count { tosses, .. } => ("P(same)", tosses),
        Seen::Value(_) | Seen::FairRatio(_) => ("P(side)", 0),
    };
    let mean = models.iter().map(Model::p).sum::<f64>() / models.len() as f64;
    Line {
        name: number.name.clone(),
        quantity,
        seen,
        tosses,
        predicted: mean,
        range: range(models),
        p_value: surprise.p_value,
        p_error: surprise.error,
        own_tosses: own_tosses(models),
    }
}

fn own_tosses(models: &[Model]) -> u64 {
    models.iter().map(Model::tosses).sum()
}

/// Where the middle 95 % of the draws lie; the interval of a single one.
fn range(models: &[Model]) -> [f64; 2] {
    if let [Model::Counted { shown, tosses }] = *models {
        let estimate = Estimate::new(shown, 0, tosses, 0.95, IntervalMethod::Wilson);
        return [estimate.lo, estimate.hi];
    }
    let mut sorted: Vec<f64> = models.iter().map(Model::p).collect();
    sorted.sort_by(f64::total_cmp);
    // some hundreds of draws
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a place in a list"
    )]
    let at = |share: f64| sorted[(share * (sorted.len() - 1) as f64).round() as usize];
    [at(0.025), at(0.975)]
}

/// The probability that a thin coin that a person catches shows the side that was up: that of Diaconis, Holmes
/// & Montgomery, averaged over the person's tosses.
fn caught(draw: &Draw) -> Model {
    let mean = draw
        .number("launch.spin.precessing.psi_deg.normal.mean")
        .expect("every hand has one");
    let places = (0..PLACES).map(|place| {
        let z = inverse_normal_cdf((f64::from(place) + 0.5) / f64::from(PLACES));
        // beyond 90° the motion is that of 180° − ψ
        let psi = (mean + PSI_SD_DEG * z).clamp(0.0, 180.0);
        p_same_side(psi.min(180.0 - psi).to_radians())
    });
    Model::Known(places.sum::<f64>() / f64::from(PLACES))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prior::draws;

    /// ψ of the preset `hand`, 81°, gives 0.508 without its scatter of 5°, and a little more with it.
    #[test]
    fn a_caught_coin_remembers_its_start() {
        let with = |psi| {
            let mut draw = draws(1, 1).remove(0);
            for (key, number) in &mut draw.numbers {
                if key.ends_with("psi_deg.normal.mean") {
                    *number = psi;
                }
            }
            caught(&draw).p()
        };
        assert!((0.508..0.515).contains(&with(81.0)), "{}", with(81.0));
        assert!((0.60..0.63).contains(&with(60.0)), "{}", with(60.0));
        assert!(with(90.0) < 0.504);
    }

    /// What a source states is not drawn, and what it does not state is.
    #[test]
    fn only_what_is_not_stated_is_drawn() {
        let draw = &draws(1, 1)[0];
        for set in &super::super::SETS {
            let Predictor::Prior(experiment) = set.by else {
                continue;
            };
            let scene = scene(experiment, &[1.0], Some(draw));
            let keys: Vec<&str> = scene
                .overrides
                .iter()
                .filter_map(|setting| setting.split_once('=').map(|(key, _)| key))
                .collect();
            let mut once = keys.clone();
            once.sort_unstable();
            once.dedup();
            assert_eq!(once.len(), keys.len(), "{}: {keys:?}", set.name);
            assert!(keys.len() > 2, "{}: {keys:?}", set.name);
        }
    }
}
