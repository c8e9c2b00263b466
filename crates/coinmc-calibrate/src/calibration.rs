//! A calibration: from measurements to what they say.

use crate::conflicts::{self, Conflict};
use crate::fair::FairRatio;
use crate::information::{self, Suggestion};
use crate::model::Model;
use crate::observations::Counted;
use crate::posterior::Posterior;
use crate::prediction::{self, Prediction};
use crate::{CalibrationError, Reading, remarks};
use coinmc_questions::Workers;

/// What measurements say of a coin and a surface.
#[derive(Debug, Clone)]
pub struct Calibration {
    /// What is known of the parameters.
    pub posterior: Posterior,
    /// The probabilities of the faces.
    pub prediction: Prediction,
    /// How thick a fair coin is; `None` if none from H/R = 0.2 to 4 is.
    pub fair: Option<FairRatio>,
    /// Which further measurement would sharpen P(side), the best first.
    pub suggestions: Vec<Suggestion>,
    /// Measurements that hardly agree with the prior or the others.
    pub conflicts: Vec<Conflict>,
    /// What the measurements leave open, in words.
    pub remarks: Vec<String>,
    /// All tosses that were made.
    pub tosses: u64,
}

impl Calibration {
    /// Calibrates a surface.
    ///
    /// # Errors
    /// [`CalibrationError`] if a measurement contradicts its prior, or tosses fail or are stopped.
    pub fn of(model: &Model, workers: &Workers<'_>) -> Result<Self, CalibrationError> {
        let mut conflicts = conflicts::refuse(model)?;
        let posterior = Posterior::of(model)?;
        conflicts.extend(conflicts::between(model)?);
        let prediction = Prediction::of(model, &posterior, workers)?
            .with_numerical(model, &posterior, workers)?;
        let fair = FairRatio::of(model, &posterior, &prediction, workers)?;
        let of_fair = fair.map_or(0, |fair| fair.tosses);
        let (suggestions, rolls) = information::suggestions(model, &posterior, workers)?;
        Ok(Self {
            suggestions,
            remarks: remarks::remarks(model, &posterior),
            tosses: model.tosses + prediction.tosses + 2 * prediction.pairs + of_fair + rolls,
            posterior,
            prediction,
            fair,
            conflicts,
        })
    }

    /// The probabilities of heads, tails and side for each draw of the posterior, by the fit.
    pub fn faces(&self, model: &Model) -> Vec<[f64; 3]> {
        prediction::fitted(model, &self.posterior.scores)
    }

    /// ln of the probability of each of the measurements, for each draw.
    pub fn log_likelihoods(&self, model: &Model) -> Vec<Vec<f64>> {
        let scores = self.posterior.scores.iter();
        scores.map(|scores| model.terms(scores).collect()).collect()
    }
}

impl Model {
    /// Tosses that were made to fit the probabilities.
    pub fn tosses(&self) -> u64 {
        self.tosses
    }

    /// The counts with the name, the tosses and the root mean square error of their fit.
    pub fn fits(&self) -> impl Iterator<Item = FitOf<'_>> {
        let predicted = FitOf {
            counted: None,
            error: self.predicted.error(),
            degree: self.predicted.degree(),
            tosses: self.predicted.tosses(),
        };
        let counts = self.observed.counts.iter().zip(&self.counted);
        let counts = counts.map(|(counted, chances)| FitOf {
            counted: Some(counted),
            error: chances.error(),
            degree: chances.degree(),
            tosses: chances.tosses(),
        });
        std::iter::once(predicted).chain(counts)
    }

    /// The measured numbers.
    pub fn readings(&self) -> &[Reading] {
        &self.observed.readings
    }
}

/// How well the probabilities of a scene are fitted.
#[derive(Debug, Clone, Copy)]
pub struct FitOf<'a> {
    /// The counts that the scene is for; `None` for the scene to predict.
    pub counted: Option<&'a Counted>,
    /// Root mean square error of a probability, by what was left out of the fit.
    pub error: f64,
    /// Degree of the polynomials.
    pub degree: usize,
    /// Tosses that showed a face.
    pub tosses: u64,
}
