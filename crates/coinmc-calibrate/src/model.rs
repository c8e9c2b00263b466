//! The probability of what was measured, as a function of the parameters.

use crate::chances::{Chances, Tossed};
use crate::observations::Observations;
use crate::points::{self, Use};
use crate::tosses::{At, Faces, count, launches, point_with};
use crate::{CalibrationError, Kind, Parameter, Settings};
use coinmc::plan::Plan;
use coinmc_questions::Workers;

/// The design reaches this much farther than the prior, so that the fit holds where the prior is thin.
const REACH: f64 = 1.25;
/// The least share of the tosses that must end with a face.
const LEAST_SHARE: f64 = 0.5;

/// The probability of what was measured, as a function of the parameters.
///
/// It is smooth and holds no random number: it is computed from a fit to tosses that were made once.
///
/// # Example
/// ```
/// use coinmc_calibrate::{Model, Observations, Settings};
/// use coinmc_questions::Workers;
/// use std::sync::atomic::AtomicBool;
/// let text = "coin.ratio = 1\nsurface.material = 'wood'\nlaunch.preset = 'hand'\n\
///             engine.flat = {}\n[counts]\nheads = 40\ntails = 38\nside = 12\n";
/// # let text = text.replace("'hand'", "'robot'");
/// let observed = Observations::parse("inline", &text, &[], "".as_ref())?;
/// let settings = Settings { points: 64, tosses: 32, ..Settings::default() };
/// let cancel = AtomicBool::new(false);
/// let workers = Workers { threads: None, cancel: &cancel, made: &|_| () };
/// let model = Model::new(observed, settings, &workers)?;
/// let density = model.log_prob(&[0.5, 0.3]);
/// assert!(density.is_finite());
/// assert_eq!(model.log_prob(&[1.5, 0.3]), f64::NEG_INFINITY);
/// # Ok::<(), coinmc_calibrate::CalibrationError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Model {
    pub(crate) observed: Observations,
    pub(crate) settings: Settings,
    /// The probabilities of the faces for each of the counts, and their fit for the prediction.
    pub(crate) counted: Vec<Chances>,
    pub(crate) predicted: Chances,
    /// Tosses that were made.
    pub(crate) tosses: u64,
}

impl Model {
    /// Tosses the design and fits the probabilities of the faces to it.
    ///
    /// # Errors
    /// [`CalibrationError`] if nothing was measured, the settings are out of range, or tosses fail or are
    /// stopped.
    pub fn new(
        observed: Observations,
        settings: Settings,
        workers: &Workers<'_>,
    ) -> Result<Self, CalibrationError> {
        settings.check()?;
        if observed.counts.is_empty() && observed.readings.is_empty() {
            return Err(CalibrationError::NothingMeasured);
        }
        let mut known: Vec<(Plan, Chances)> = vec![];
        let mut tosses = 0;
        let mut chances = |name: &str, plan: &Plan| -> Result<Chances, CalibrationError> {
            let same = known.iter().find(|(known, _)| is_same(known, plan));
            if let Some((_, chances)) = same {
                return Ok(chances.clone());
            }
            let tossed = design(&observed, plan, settings, workers)?;
            tosses += settings.points * settings.tosses;
            let chances = fitted(name, &tossed, settings)?;
            known.push((plan.clone(), chances.clone()));
            Ok(chances)
        };
        let predicted = chances("the scene", &observed.predicted)?;
        let counts = observed.counts.iter();
        let counted = counts
            .map(|counted| chances(&counted.name, &counted.plan))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            observed,
            settings,
            counted,
            predicted,
            tosses,
        })
    }

    /// The same model of other measurements in the same scenes: the counts and readings are replaced, in
    /// order. For studies with many synthetic coins.
    pub fn with_measured(&self, counts: &[Faces], readings: &[f64]) -> Self {
        let mut model = self.clone();
        for (counted, faces) in model.observed.counts.iter_mut().zip(counts) {
            counted.faces = *faces;
        }
        for (reading, value) in model.observed.readings.iter_mut().zip(readings) {
            reading.value = *value;
        }
        model
    }

    /// The same model with the measurements of some kinds only.
    pub fn with_kinds(&self, kinds: &[Kind]) -> Self {
        let mut model = self.clone();
        let observed = &mut model.observed;
        // places are those of the counts, and then of the readings
        let of_counts = observed.counts.iter().map(|_| Kind::Counts);
        let of_readings = observed.readings.iter().map(|reading| reading.kind);
        let kept: Vec<bool> = of_counts
            .chain(of_readings)
            .map(|kind| kinds.contains(&kind))
            .collect();
        let mut keeps = kept.into_iter();
        observed.places.retain(|_| keeps.next() == Some(true));
        if !kinds.contains(&Kind::Counts) {
            observed.counts.clear();
            model.counted.clear();
        }
        if !kinds.contains(&Kind::Film) {
            observed.film_remarks.clear();
        }
        let readings = &mut observed.readings;
        readings.retain(|reading| kinds.contains(&reading.kind));
        model
    }

    /// What was measured.
    pub fn observed(&self) -> &Observations {
        &self.observed
    }

    /// The parameters, in the order of `values` below.
    pub fn parameters(&self) -> Vec<Parameter> {
        self.observed.parameters()
    }

    /// ln of the prior density of parameters, per unit of each; −∞ where there is none.
    pub fn log_prior(&self, values: &[f64]) -> f64 {
        let priors = self.observed.priors.iter();
        priors
            .zip(values)
            .map(|(prior, value)| prior.log_density(*value))
            .sum()
    }

    /// ln of the probability of what was measured, but for a constant; −∞ where no surface has such
    /// parameters.
    pub fn log_likelihood(&self, values: &[f64]) -> f64 {
        self.scores(values)
            .map_or(f64::NEG_INFINITY, |scores| self.log_likelihood_of(&scores))
    }

    /// ln of the posterior density of parameters, but for a constant.
    pub fn log_prob(&self, values: &[f64]) -> f64 {
        let prior = self.log_prior(values);
        if prior == f64::NEG_INFINITY {
            return prior;
        }
        prior + self.log_likelihood(values)
    }

    /// Parameters from uniform numbers in (0, 1), for nested samplers.
    pub fn of_uniforms(&self, uniforms: &[f64]) -> Vec<f64> {
        let scores = uniforms.iter().map(|u| {
            // the ends themselves are at infinity
            coinmc_core::inverse_normal_cdf(u.clamp(1e-15, 1.0 - 1e-15))
        });
        self.values(&scores.collect::<Vec<_>>())
    }

    /// The probabilities of heads, tails and side in the scene to predict; `None` where no surface has such
    /// parameters.
    pub fn faces(&self, values: &[f64]) -> Option<[f64; 3]> {
        Some(self.predicted.at(&reached(&self.scores(values)?)))
    }

    /// The scores z of parameters.
    pub(crate) fn scores(&self, values: &[f64]) -> Option<Vec<f64>> {
        let priors = self.observed.priors.iter().zip(values);
        priors
            .map(|(prior, value)| {
                let allowed = prior.parameter.allows(*value);
                allowed.then(|| prior.z(*value))
            })
            .collect()
    }

    /// The parameters with these scores.
    pub(crate) fn values(&self, scores: &[f64]) -> Vec<f64> {
        let priors = self.observed.priors.iter().zip(scores);
        priors.map(|(prior, z)| prior.value(*z)).collect()
    }

    /// The same as [`log_likelihood`](Self::log_likelihood), of scores.
    pub(crate) fn log_likelihood_of(&self, scores: &[f64]) -> f64 {
        self.terms(scores).sum()
    }

    /// ln of the probability of each of the counts, and then of each of the readings.
    pub(crate) fn terms(&self, scores: &[f64]) -> impl Iterator<Item = f64> {
        let values = self.values(scores);
        let reached = reached(scores);
        let counts = self.counted.iter().zip(&self.observed.counts);
        let counts =
            counts.map(move |(chances, counted)| chances.log_likelihood(&reached, &counted.faces));
        let readings = self.observed.readings.iter().map(move |reading| {
            reading.log_likelihood(values[self.place(reading.law.parameter())])
        });
        counts.chain(readings)
    }

    /// The place of a parameter among the others.
    pub(crate) fn place(&self, parameter: Parameter) -> usize {
        let priors = &self.observed.priors;
        let place = priors.iter().position(|prior| prior.parameter == parameter);
        place.expect("readings of other parameters are refused")
    }

    /// The name of one of the [`terms`](Self::terms).
    pub(crate) fn name(&self, term: usize) -> &str {
        let counts = &self.observed.counts;
        match counts.get(term) {
            Some(counted) => &counted.name,
            None => &self.observed.readings[term - counts.len()].name,
        }
    }
}

/// The coordinates of scores in the fits: in units of the design's reach.
pub(crate) fn reached(scores: &[f64]) -> Vec<f64> {
    scores.iter().map(|z| z / REACH).collect()
}

/// Whether tosses of two plans are the same.
fn is_same(a: &Plan, b: &Plan) -> bool {
    let (a, b) = (&a.points[0], &b.points[0]);
    a.scene == b.scene && a.launches == b.launches && a.engine == b.engine
}

/// Tosses a design over the prior, each point with launches of its own.
fn design(
    observed: &Observations,
    plan: &Plan,
    settings: Settings,
    workers: &Workers<'_>,
) -> Result<Tossed, CalibrationError> {
    let parameters = observed.parameters();
    let points = points::normal(plan.seed, Use::Design, parameters.len(), settings.points);
    let mut work = vec![];
    for (k, point) in points.iter().enumerate() {
        let priors = observed.priors.iter().zip(point);
        let values: Vec<f64> = priors.map(|(prior, z)| prior.value(REACH * z)).collect();
        let first = if settings.paired {
            0
        } else {
            k as u64 * settings.tosses
        };
        work.push(At {
            point: point_with(plan, &parameters, &values)?,
            tosses: first..first + settings.tosses,
        });
    }
    let faces = count(&work, &launches(plan.seed), workers)?;
    Ok(Tossed { points, faces })
}

fn fitted(name: &str, tossed: &Tossed, settings: Settings) -> Result<Chances, CalibrationError> {
    let made = settings.points * settings.tosses;
    let shown: u64 = tossed.faces.iter().flatten().sum();
    if (shown as f64) < LEAST_SHARE * made as f64 {
        return Err(CalibrationError::Undecided(
            name.to_owned(),
            made - shown,
            made,
        ));
    }
    Chances::fit(tossed).ok_or_else(|| CalibrationError::Fit(name.to_owned()))
}
