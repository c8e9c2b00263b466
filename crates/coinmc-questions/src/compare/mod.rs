//! Counts of real tosses against the points of a run.

mod document;
mod evidence;
mod exact;
mod split;

pub use document::document_of_comparison;

use crate::{QuestionError, TEST, tosses_for_power};
use coinmc::results::Row;
use coinmc_core::{Estimate, Face, IntervalMethod};
use evidence::{ln_evidence, ln_uniform};
use exact::{Reference, p_value};
use libm::exp;
use split::most_favourable;

/// Most tosses that are compared.
pub const MOST_COUNTED: u64 = 1_000_000;
/// Most points that they are compared with.
pub const MOST_MODELS: usize = 10_000;

/// A point of a run as a model of real tosses.
#[derive(Debug, Clone)]
pub struct Model<'a> {
    /// The name of its run.
    pub run: &'a str,
    /// The point.
    pub row: &'a Row,
}

/// Counts and how well each model tells of them.
#[derive(Debug, Clone)]
pub struct Comparison<'a> {
    /// Heads, tails and side.
    pub counts: [u64; 3],
    /// The probabilities by the counts alone, with intervals of this confidence.
    pub seen: [Estimate; 3],
    /// Each model, the most likely first.
    pub models: Vec<Compared<'a>>,
    /// Points that are left out: without a closed form, and without tosses that showed a face.
    pub left_out: usize,
}

/// One model beside the counts.
#[derive(Debug, Clone)]
pub struct Compared<'a> {
    /// The model.
    pub model: Model<'a>,
    /// Its probability, if it is right, of counts that are no more probable than those seen, by an exact test that
    /// knows its own error.
    pub p_value: f64,
    /// The same if its undecided tosses had shown the faces with which it agrees best with the counts.
    pub p_value_at_best: f64,
    /// Logarithm to the base 10 of the Bayes factor for it, against a coin of which every triple of probabilities
    /// is equally likely.
    pub evidence: f64,
    /// Its probability if one of the models is right and none is more likely beforehand.
    pub share: f64,
    /// Tosses after which [`TEST`] rejects it, if the most likely model is right; for that model itself, if the
    /// shares seen are. `None` where nothing tells the two apart.
    pub tosses_to_tell: Option<u64>,
}

impl Compared<'_> {
    /// Tosses of the model without a face, which no number but the last p-value counts: undecided, or off the table.
    pub fn without_face(&self) -> u64 {
        let tally = &self.model.row.tally;
        tally.undecided() + tally.left
    }

    /// The probability of a face, among the tosses that did not leave the table, as the counts have it: the
    /// estimate for all tosses over the share of those. (Its interval is a little wide: it has the scatter of the larger
    /// number of tosses, which is more relative to p the smaller p is.)
    pub fn estimate(&self, face: Face) -> Estimate {
        let row = self.model.row;
        let whole = *row.estimate(face);
        if row.tally.left == 0 {
            return whole;
        }
        let (all, left) = (row.tally.tosses(), row.tally.left);
        let share = (all - left) as f64 / all as f64;
        Estimate {
            p: whole.p / share,
            lo: whole.lo / share,
            hi: (whole.hi / share).min(1.0),
            n: all - left,
            ..whole
        }
    }

    /// Whether a test at this level rejects it, whatever its undecided tosses would have shown.
    pub fn is_rejected(&self, level: f64) -> bool {
        self.p_value_at_best < level
    }

    /// Whether that test rejects it, but does not with some faces of its undecided tosses.
    pub fn is_open(&self, level: f64) -> bool {
        self.p_value < level && !self.is_rejected(level)
    }
}

impl Comparison<'_> {
    /// All tosses.
    pub fn tosses(&self) -> u64 {
        self.counts.iter().sum()
    }
}

/// Compares counts of heads, tails and side with models. Points without tosses or a closed form are left out and
/// counted; tosses of a model without a face (undecided, or off the table) are left out, too, but for a second p-value
/// that knows how they may have ended.
///
/// # Errors
/// [`QuestionError::NoCounts`], [`QuestionError::TooMany`] tosses or models, [`QuestionError::NoModel`],
/// [`QuestionError::NoFaces`].
///
/// # Example
/// ```
/// use coinmc::{config, results::{Results, Row}, plan::StoppedBy};
/// use coinmc_questions::{compare, Model};
/// let plan = config::parse("inline", "coin.ratio = [0.5, 1.5]\nengine.analytic.rule = 'cross-section'", &[])?;
/// let row = |index| Row::new(&plan, index, Default::default(), StoppedBy::Tosses);
/// let rows = [row(0), row(1)];
/// let models: Vec<_> = rows.iter().map(|row| Model { run: "rule", row }).collect();
/// let compared = compare([41, 38, 21], &models, 0.95)?;
/// // x/(2 + x) is 0.2 for the thinner coin and 0.43 for the thicker one
/// assert_eq!(compared.models[0].model.row.point, 0);
/// assert!(compared.models[0].p_value > 0.5 && compared.models[1].p_value < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare<'a>(
    counts: [u64; 3],
    models: &[Model<'a>],
    confidence: f64,
) -> Result<Comparison<'a>, QuestionError> {
    let tosses = counts
        .iter()
        .try_fold(0_u64, |sum, count| sum.checked_add(*count))
        .unwrap_or(u64::MAX);
    let too_many = |what, most: u64, given| Err(QuestionError::TooMany { what, most, given });
    if tosses == 0 {
        return Err(QuestionError::NoCounts);
    } else if tosses > MOST_COUNTED {
        return too_many("tosses", MOST_COUNTED, tosses);
    }
    let known: Vec<_> = models.iter().filter_map(reference).collect();
    if known.is_empty() {
        let is_tossed = |model: &Model<'_>| model.row.tally.tosses() > 0;
        return Err(if models.iter().any(is_tossed) {
            QuestionError::NoFaces
        } else {
            QuestionError::NoModel
        });
    } else if known.len() > MOST_MODELS {
        return too_many("points", MOST_MODELS as u64, known.len() as u64);
    }
    let left_out = models.len() - known.len();
    let compared = known
        .into_iter()
        .map(|(model, reference)| compared(model, &reference, counts));
    let mut models: Vec<Compared<'a>> = compared.collect();
    models.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    share_out(&mut models);
    let seen =
        counts.map(|count| Estimate::new(count, 0, tosses, confidence, IntervalMethod::Wilson));
    let best = of_model(models[0].model.row);
    for (place, compared) in models.iter_mut().enumerate() {
        let right = if place == 0 { shares(counts) } else { best };
        compared.tosses_to_tell = tosses_to_tell(of_model(compared.model.row), right);
    }
    Ok(Comparison {
        counts,
        seen,
        models,
        left_out,
    })
}

/// A model beside the counts, without what the others say of it.
fn compared<'a>(model: Model<'a>, reference: &Reference, counts: [u64; 3]) -> Compared<'a> {
    let p = p_value(reference, counts);
    let undecided = model.row.tally.undecided();
    let at_best = match reference {
        Reference::Counted(own) if undecided > 0 => {
            let shared = most_favourable(*own, undecided, counts);
            p.max(p_value(&Reference::Counted(shared), counts))
        }
        _ => p,
    };
    Compared {
        model,
        p_value: p,
        p_value_at_best: at_best,
        evidence: (ln_evidence(reference, counts) - ln_uniform(counts)) / std::f64::consts::LN_10,
        share: 0.0,
        tosses_to_tell: None,
    }
}

/// What a point says; `None` if it says nothing yet.
fn reference<'a>(model: &Model<'a>) -> Option<(Model<'a>, Reference)> {
    let row = model.row;
    let tally = &row.tally;
    let counts = [tally.heads, tally.tails, tally.side];
    let reference = if tally.tosses() > 0 {
        (counts.iter().any(|count| *count > 0)).then_some(Reference::Counted(counts))
    } else {
        let p = Face::ALL.map(|face| row.estimate(face).p);
        p.iter()
            .all(|p| p.is_finite())
            .then_some(Reference::Known(p))
    };
    reference.map(|reference| (model.clone(), reference))
}

/// Fills in each model's probability, the first being the most likely.
fn share_out(models: &mut [Compared<'_>]) {
    let best = models[0].evidence;
    let weight = |model: &Compared<'_>| {
        if model.evidence == best {
            1.0
        } else {
            exp((model.evidence - best) * std::f64::consts::LN_10)
        }
    };
    let all: f64 = models.iter().map(weight).sum();
    for model in models {
        model.share = weight(model) / all;
    }
}

/// Probabilities by counts, none of them 0.
fn shares(counts: [u64; 3]) -> [f64; 3] {
    let whole = counts.iter().sum::<u64>() as f64 + 1.5;
    counts.map(|count| (count as f64 + 0.5) / whole)
}

/// The probabilities of a point, of the faces alone.
fn of_model(row: &Row) -> [f64; 3] {
    let tally = &row.tally;
    if tally.tosses() > 0 {
        shares([tally.heads, tally.tails, tally.side])
    } else {
        Face::ALL.map(|face| row.estimate(face).p)
    }
}

fn tosses_to_tell(model: [f64; 3], right: [f64; 3]) -> Option<u64> {
    let told = model.iter().all(|p| *p > 0.0 && *p < 1.0);
    (told && model != right).then(|| tosses_for_power(model, right, TEST))
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc::plan::StoppedBy;
    use coinmc::{config, plan::Plan};
    use coinmc_core::Tally;

    fn plan() -> Plan {
        let text = "coin.ratio = 1.0\nsurface = { restitution = 0.5, friction = 0.3 }\n\
                    launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 2000";
        config::parse("inline", text, &[]).expect("a plan")
    }

    fn tally([heads, tails, side]: [u64; 3], impact_limit: u64) -> Tally {
        Tally {
            heads,
            tails,
            side,
            impact_limit,
            ..Tally::default()
        }
    }

    /// 680 of 2,000 tosses are undecided: as many sides as heads are possible, but not 30 sides of 30.
    #[test]
    fn only_what_no_face_of_undecided_tosses_agrees_with_is_a_contradiction() {
        let plan = plan();
        let row = Row::new(&plan, 0, tally([630, 640, 50], 680), StoppedBy::Tosses);
        let models = [Model {
            run: "run",
            row: &row,
        }];
        let found = compare([10, 10, 10], &models, 0.95).expect("an answer");
        let model = &found.models[0];
        assert!(
            model.p_value < 1e-3 && model.p_value_at_best > 0.5,
            "{model:?}"
        );
        assert!(model.is_open(0.05) && !model.is_rejected(0.05));
        assert_eq!(model.without_face(), 680);
        let document = document_of_comparison(&found, Some(3));
        assert_eq!(document["voids"], 3);
        assert_eq!(document["rows"][0]["undecided"], 680);
        assert_eq!(
            document["rows"][0]["p_value_at_best"],
            model.p_value_at_best
        );
        let contradicted = compare([0, 0, 30], &models, 0.95).expect("an answer");
        let model = &contradicted.models[0];
        assert!(model.is_rejected(0.05) && !model.is_open(0.05), "{model:?}");
        let agreed = compare([15, 15, 1], &models, 0.95).expect("an answer");
        assert!(!agreed.models[0].is_open(0.05) && !agreed.models[0].is_rejected(0.05));
    }

    /// Half of the tosses have left the table: of the others as many show heads as in the counts.
    #[test]
    fn probabilities_are_of_the_tosses_that_stay_on_the_table() {
        let plan = plan();
        let left = Tally {
            left: 1_000,
            ..tally([480, 470, 50], 0)
        };
        let row = Row::new(&plan, 0, left, StoppedBy::Tosses);
        let models = [Model {
            run: "run",
            row: &row,
        }];
        let found = compare([48, 47, 5], &models, 0.95).expect("an answer");
        for (face, (share, count)) in
            Face::ALL
                .into_iter()
                .zip([(0.48, 480), (0.47, 470), (0.05, 50)])
        {
            let Estimate { p, lo, hi, n, .. } = found.models[0].estimate(face);
            assert!((p - share).abs() < 1e-12 && lo < p && p < hi && n == 1_000);
            // no narrower than the interval of 1,000 tosses, and not by half wider
            let own = Estimate::new(count, 0, 1_000, 0.95, IntervalMethod::Wilson);
            let wider = (hi - lo) / (own.hi - own.lo);
            assert!((0.99..1.5).contains(&wider), "{wider}");
            let told = &document_of_comparison(&found, None)["rows"][0]["model"][face.name()]["p"];
            assert_eq!(told.as_f64(), Some(p));
        }
    }

    #[test]
    fn decided_tosses_have_one_p_value_and_points_without_any_are_counted() {
        let plan = plan();
        let row = |tally| Row::new(&plan, 0, tally, StoppedBy::Tosses);
        let rows = [row(tally([600, 600, 100], 0)), row(Tally::default())];
        let models = rows.each_ref().map(|row| Model { run: "run", row });
        let found = compare([10, 10, 10], &models, 0.95).expect("an answer");
        assert_eq!((found.models.len(), found.left_out), (1, 1));
        assert_eq!(found.models[0].p_value, found.models[0].p_value_at_best);
        assert_eq!(document_of_comparison(&found, None)["left_out"], 1);
    }
}
