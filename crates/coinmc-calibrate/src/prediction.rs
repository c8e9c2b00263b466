//! The probabilities of the faces for this coin on this surface, with every error apart.

use crate::CalibrationError;
use crate::chances::jackknife;
use crate::model::{Model, reached};
use crate::posterior::{Posterior, moments, quantiles, widened};
use crate::prior::Z95;
use crate::tosses::{At, count, launches, pairs, point_with};
use coinmc::plan::{Plan, Point};
use coinmc_core::Face;
use coinmc_questions::{Template, Workers, finer_settings};

/// Draws of the posterior on whose surfaces coins are tossed.
const SURFACES: u64 = 256;

/// The probability of a face for this coin on this surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Predicted {
    /// The face.
    pub face: Face,
    /// Its probability, the mean over the posterior, by tosses on surfaces drawn from it.
    pub p: f64,
    /// Lower end of the interval by the errors of parameters and tosses.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
    /// Standard error because the parameters are known no better.
    pub parameter: f64,
    /// Standard error because tosses are few: of those here and of the design.
    pub statistical: f64,
    /// How far finer numerical settings move it, and the standard error of that; `None` if the engine
    /// has none, or it was not measured.
    pub numerical: Option<(f64, f64)>,
}

/// The prediction of all faces.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// Heads, tails and side.
    pub faces: [Predicted; 3],
    /// Tosses on surfaces drawn from the posterior, and those of them that showed a face.
    pub tosses: u64,
    /// Those of them that showed a face.
    pub shown: u64,
    /// Pairs of tosses for the numerical error.
    pub pairs: u64,
}

/// The probabilities of the faces at each of these scores, by the fit.
pub(crate) fn fitted(model: &Model, scores: &[Vec<f64>]) -> Vec<[f64; 3]> {
    let at = |scores: &Vec<f64>| model.predicted.at(&reached(scores));
    scores.iter().map(at).collect()
}

impl Prediction {
    /// Tosses coins on surfaces drawn from the posterior; the numerical error is not measured.
    ///
    /// # Errors
    /// [`CalibrationError`] if tosses fail, show no face, or are stopped.
    pub fn of(
        model: &Model,
        posterior: &Posterior,
        workers: &Workers<'_>,
    ) -> Result<Self, CalibrationError> {
        let plan = &model.observed.predicted;
        let faces = tossed(model, posterior, workers)?;
        let shown: u64 = faces.iter().sum();
        let draws = fitted(model, &posterior.scores);
        let centre = reached(&posterior.centre());
        let partial = model.predicted.partial_at(&centre);
        let predicted = Face::ALL.map(|face| {
            let f = face as usize;
            let p = faces[f] as f64 / shown as f64;
            let tosses = p * (1.0 - p) / shown as f64;
            let design = jackknife(partial.iter().map(|faces| faces[f]));
            let statistical = (tosses + design * design).sqrt();
            let values: Vec<f64> = draws.iter().map(|draw| draw[f]).collect();
            let (mean, parameter) = moments(&values);
            let [lo, _, hi] = quantiles(&values, plan.confidence);
            // the spread about the mean, moved to where the tosses are
            let moved = [lo - mean + p, p, hi - mean + p];
            let [lo, _, hi] = widened(moved, statistical, plan.confidence);
            Predicted {
                face,
                p,
                lo: lo.max(0.0),
                hi: hi.min(1.0),
                parameter,
                statistical,
                numerical: None,
            }
        });
        Ok(Self {
            faces: predicted,
            tosses: SURFACES * (model.settings.predicted / SURFACES),
            shown,
            pairs: 0,
        })
    }

    /// The same with the numerical error, if the engine has settings that can be finer: by pairs of tosses in
    /// the middle of the posterior.
    ///
    /// # Errors
    /// [`CalibrationError`] if tosses fail or are stopped.
    pub fn with_numerical(
        mut self,
        model: &Model,
        posterior: &Posterior,
        workers: &Workers<'_>,
    ) -> Result<Self, CalibrationError> {
        if let Some((changes, pairs)) = numerical(model, posterior, workers)? {
            for (predicted, change) in self.faces.iter_mut().zip(changes) {
                predicted.numerical = Some(change);
            }
            self.pairs = pairs;
        }
        Ok(self)
    }

    /// The side.
    pub fn side(&self) -> &Predicted {
        &self.faces[Face::Side as usize]
    }
}

impl Predicted {
    /// Whether finer settings move it by more than chance.
    pub fn is_moved_by_settings(&self) -> bool {
        self.numerical
            .is_some_and(|(shift, error)| shift.abs() > Z95 * error)
    }
}

/// Counts of tosses on surfaces drawn from the posterior.
fn tossed(
    model: &Model,
    posterior: &Posterior,
    workers: &Workers<'_>,
) -> Result<[u64; 3], CalibrationError> {
    let plan = &model.observed.predicted;
    let parameters = model.parameters();
    let each = model.settings.predicted / SURFACES;
    // numbers that the design has not used
    let from = model.settings.points * model.settings.tosses;
    let draws = posterior.draws.iter().cycle().zip(0..SURFACES);
    let work = draws.map(|(draw, k)| {
        Ok(At {
            point: point_with(plan, &parameters, draw)?,
            tosses: from + k * each..from + (k + 1) * each,
        })
    });
    let work: Vec<At> = work.collect::<Result<_, CalibrationError>>()?;
    let counted = count(&work, &launches(plan.seed), workers)?;
    let mut faces = [0; 3];
    for counted in counted {
        for (sum, count) in faces.iter_mut().zip(counted) {
            *sum += count;
        }
    }
    let shown: u64 = faces.iter().sum();
    if shown == 0 {
        let made = SURFACES * each;
        return Err(CalibrationError::Undecided(
            "the prediction".to_owned(),
            made,
            made,
        ));
    }
    Ok(faces)
}

/// How finer settings change the probability of each face in the middle of the posterior.
type Changes = ([(f64, f64); 3], u64);

fn numerical(
    model: &Model,
    posterior: &Posterior,
    workers: &Workers<'_>,
) -> Result<Option<Changes>, CalibrationError> {
    let plan = &model.observed.predicted;
    let Some(finer) = finer(plan)? else {
        return Ok(None);
    };
    let values = model.values(&posterior.centre());
    let usual: Point = point_with(plan, &model.parameters(), &values)?;
    let mut precise = usual.clone();
    precise.engine = finer;
    let tosses = model.settings.predicted / 4;
    let ends = pairs([&usual, &precise], &launches(plan.seed), tosses, workers)?;
    let n = ends.len() as f64;
    let changes = [0, 1, 2].map(|face| {
        let is = |end: Option<usize>| f64::from(u8::from(end == Some(face)));
        let change: f64 = ends.iter().map(|[a, b]| is(*b) - is(*a)).sum::<f64>() / n;
        let moved: f64 = ends.iter().map(|[a, b]| (is(*b) - is(*a)).abs()).sum();
        // one change more, so that none seen does not mean no error
        (
            change,
            ((moved + 1.0 - n * change * change) / (n * n)).sqrt(),
        )
    });
    Ok(Some((changes, tosses)))
}

/// The engine with finer settings.
fn finer(plan: &Plan) -> Result<Option<coinmc::plan::EngineChoice>, CalibrationError> {
    let settings = finer_settings(plan);
    if settings.is_empty() {
        return Ok(None);
    }
    let values: Vec<_> = settings
        .iter()
        .map(|(key, value)| (key.as_str(), value.clone()))
        .collect();
    let template = Template::new("scene", &*plan.resolved_toml, &[]);
    Ok(Some(template.plan(&values)?.points[0].engine.clone()))
}
