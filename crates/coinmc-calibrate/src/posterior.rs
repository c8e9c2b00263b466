//! What is known of the parameters after the measurements.

use crate::importance::{self, Weighted};
use crate::model::{Model, reached};
use crate::{CalibrationError, Parameter, prediction};
use coinmc_core::{Face, inverse_normal_cdf};

/// Fewer independent draws tell no interval.
pub(crate) const LEAST: f64 = 20.0;

/// What is known of a parameter after the measurements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// The parameter.
    pub parameter: Parameter,
    /// Its posterior mean.
    pub mean: f64,
    /// Its posterior standard deviation.
    pub sd: f64,
    /// Its posterior median.
    pub median: f64,
    /// Lower end of its central interval.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
    /// Its standard deviation on the scale of its prior, as a share of the prior's: 1 if nothing was learnt.
    pub contraction: f64,
}

/// What is known of the parameters after the measurements.
#[derive(Debug, Clone)]
pub struct Posterior {
    /// Scores of the draws.
    pub(crate) scores: Vec<Vec<f64>>,
    /// Draws of equal weight: the parameters of each.
    pub draws: Vec<Vec<f64>>,
    /// A summary of each parameter.
    pub summaries: Vec<Summary>,
    /// Correlations of the parameters on the scales of their priors.
    pub correlations: Vec<Vec<f64>>,
    /// How many independent draws the weighted points are worth.
    pub effective: f64,
    /// ln of the mean likelihood over the prior, but for a constant of the measurements.
    pub log_evidence: f64,
}

impl Posterior {
    /// The posterior of a model.
    ///
    /// # Errors
    /// [`CalibrationError::Contradiction`] if no surface agrees with all measurements,
    /// [`CalibrationError::Unresolved`] if hardly any of the draws does.
    pub fn of(model: &Model) -> Result<Self, CalibrationError> {
        let weighted = sample(model, &|scores| model.log_likelihood_of(scores))?;
        let effective = weighted.effective();
        if effective < LEAST {
            return Err(CalibrationError::Unresolved(effective));
        }
        let scores = weighted.resampled(model.settings.draws);
        let draws: Vec<Vec<f64>> = scores.iter().map(|scores| model.values(scores)).collect();
        let confidence = model.observed.plan.confidence;
        let parameters = model.parameters();
        let summaries = parameters.iter().enumerate().map(|(d, parameter)| {
            let column = |rows: &[Vec<f64>]| rows.iter().map(|row| row[d]).collect::<Vec<_>>();
            let values = column(&draws);
            let (mean, sd) = moments(&values);
            let [lo, median, hi] = quantiles(&values, confidence);
            Summary {
                parameter: *parameter,
                mean,
                sd,
                median,
                lo,
                hi,
                contraction: moments(&column(&scores)).1,
            }
        });
        Ok(Self {
            summaries: summaries.collect(),
            correlations: correlations(&scores),
            effective,
            log_evidence: weighted.log_evidence,
            draws,
            scores,
        })
    }

    /// Lower end, mean and upper end of the probability of a face in the scene to predict, by the fit: with
    /// the errors of parameters and of the fit, and without a further toss.
    pub fn face_interval(&self, model: &Model, face: Face) -> [f64; 3] {
        let faces = prediction::fitted(model, &self.scores).into_iter();
        let values: Vec<f64> = faces.map(|faces| faces[face as usize]).collect();
        let confidence = model.observed.predicted.confidence;
        let (mean, _) = moments(&values);
        let [lo, _, hi] = quantiles(&values, confidence);
        let error = model.predicted.whole_error_at(&reached(&self.centre()));
        widened([lo, mean, hi], error[face as usize], confidence)
    }

    /// Mean of the scores.
    pub(crate) fn centre(&self) -> Vec<f64> {
        let n = self.scores.len() as f64;
        let d = self.summaries.len();
        (0..d)
            .map(|d| self.scores.iter().map(|scores| scores[d]).sum::<f64>() / n)
            .collect()
    }
}

/// Weighted points for a likelihood of the model's scores.
pub(crate) fn sample(
    model: &Model,
    likelihood: &dyn Fn(&[f64]) -> f64,
) -> Result<Weighted, CalibrationError> {
    let seed = model.observed.plan.seed;
    let found = importance::sample(seed, model.observed.priors.len(), likelihood);
    found.ok_or_else(|| {
        let names = (0..model.observed.places.len()).map(|term| model.name(term));
        CalibrationError::Contradiction(names.collect::<Vec<_>>().join(", "))
    })
}

/// An interval widened by a further standard error: independent errors add up in squares, on each side.
pub(crate) fn widened([lo, middle, hi]: [f64; 3], error: f64, confidence: f64) -> [f64; 3] {
    let own = -inverse_normal_cdf(0.5 * (1.0 - confidence)) * error;
    let arm = |arm: f64| (arm * arm + own * own).sqrt();
    [middle - arm(middle - lo), middle, middle + arm(hi - middle)]
}

/// Mean and standard deviation.
pub(crate) fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values
        .iter()
        .map(|value| (value - mean) * (value - mean))
        .sum();
    (mean, (squares / (n - 1.0).max(1.0)).sqrt())
}

/// Lower end of the central interval, median and upper end.
pub(crate) fn quantiles(values: &[f64], confidence: f64) -> [f64; 3] {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let tail = 0.5 * (1.0 - confidence);
    [tail, 0.5, 1.0 - tail].map(|share| {
        let place = share * (sorted.len() - 1) as f64;
        // the place is within the list
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let below = place as usize;
        let above = (below + 1).min(sorted.len() - 1);
        sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
    })
}

fn correlations(scores: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let d = scores.first().map_or(0, Vec::len);
    let columns: Vec<Vec<f64>> = (0..d)
        .map(|d| scores.iter().map(|row| row[d]).collect())
        .collect();
    let of = |a: &[f64], b: &[f64]| correlation(a, b);
    columns
        .iter()
        .map(|a| columns.iter().map(|b| of(a, b)).collect())
        .collect()
}

/// Correlation of two columns; 0 if one is constant.
pub(crate) fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let ((mean_a, sd_a), (mean_b, sd_b)) = (moments(a), moments(b));
    if sd_a <= 0.0 || sd_b <= 0.0 {
        return 0.0;
    }
    let products: f64 = a
        .iter()
        .zip(b)
        .map(|(a, b)| (a - mean_a) * (b - mean_b))
        .sum();
    products / ((a.len() - 1) as f64 * sd_a * sd_b)
}
