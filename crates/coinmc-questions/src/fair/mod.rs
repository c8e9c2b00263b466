//! The value of a parameter at which a face has a given probability: how thick is a fair coin?
//!
//! # Method
//! The whole range is scanned coarsely (`scan`), so that several roots, no root and plateaus are
//! seen. Each crossing is then refined (`refine`) with fresh tosses near the root only, until the
//! interval is as narrow as asked for. Where closed forms or integrals give the probabilities, the
//! roots are those of the curve itself (`known`).
//!
//! Modules, each above those it uses: `solve` · `scan`, `refine` · `fit` · `axis`, `tosses`.

mod axis;
mod curve;
mod fit;
mod known;
mod numerical;
mod refine;
mod scan;
mod solve;
mod tosses;

pub use numerical::{Numerical, finer_settings};
pub use refine::Round;

use crate::span::Span;
use crate::{QuestionError, Template, Workers};
use axis::Axis;
use coinmc_core::{Coin, Face};

/// Least number of tosses of a search.
pub const LEAST_TOSSES: u64 = 4096;

/// A question: at which value of a parameter does a face have this probability?
///
/// # Example
/// ```
/// use coinmc_questions::{Question, Template, Workers, fair};
/// use std::sync::atomic::AtomicBool;
/// let text = "surface = { restitution = 0.5, friction = 0.3 }\n\
///             launch.preset = 'robot'\nengine.flat = {}";
/// let question = Question { half_width: 0.03, ..Question::default() };
/// let cancel = AtomicBool::new(false);
/// let workers = Workers { threads: None, cancel: &cancel, made: &|_| () };
/// let answer = fair(&Template::new("inline", text, &[]), &question, &workers)?;
/// let root = answer.curves[0].roots().next().unwrap();
/// assert!((root.value - 1.5).abs() < 0.2);
/// assert!(root.half_width() <= 0.03 && root.slope > 0.0);
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// The key of the parameter in configs.
    pub key: String,
    /// Where to search; `None` for the natural range of the parameter.
    pub range: Option<[f64; 2]>,
    /// The face.
    pub face: Face,
    /// Its probability.
    pub target: f64,
    /// Half width asked for of the interval of the parameter.
    pub half_width: f64,
    /// Tosses per root at which the search stops short of it.
    pub max_tosses: u64,
    /// Tosses of the comparison with finer numerical settings; 0 for none.
    pub numerical_tosses: u64,
}

impl Default for Question {
    /// How thick is a coin that lands on its side in a third of the tosses, to ± 0.005?
    fn default() -> Self {
        Self {
            key: "coin.ratio".to_owned(),
            range: None,
            face: Face::Side,
            target: 1.0 / 3.0,
            half_width: 0.005,
            max_tosses: 10_000_000,
            numerical_tosses: 4096,
        }
    }
}

/// The answer to a [`Question`].
#[derive(Debug, Clone)]
pub struct Fair {
    /// The question, its range filled in.
    pub question: Question,
    /// One curve for each combination of the other parameters that the config sweeps.
    pub curves: Vec<Curve>,
    /// Confidence of all intervals.
    pub confidence: f64,
    /// Name of the engine.
    pub engine: &'static str,
    /// Name of its law of impact, or of the closed form.
    pub law: &'static str,
    /// Whether the curve is known without tosses.
    pub known: bool,
    /// All tosses that were made.
    pub tosses: u64,
}

/// What was found along one curve.
#[derive(Debug, Clone)]
pub struct Curve {
    /// The other swept parameters.
    pub at: Vec<(String, f64)>,
    /// The values of the scan.
    pub scan: Vec<Scanned>,
    /// Roots and near misses, in order of the parameter.
    pub findings: Vec<Finding>,
}

/// One value of the scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scanned {
    /// The parameter.
    pub value: f64,
    /// Share of the tosses that showed the face, or its probability.
    pub p: f64,
    /// Lower end of the interval of the probability.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
    /// Tosses; 0 where none are needed.
    pub tosses: u64,
}

/// What was found somewhere along a curve.
#[derive(Debug, Clone)]
pub enum Finding {
    /// The probability crosses the target.
    Root(Root),
    /// It comes too near to the target between these values to be told from it, and was not seen to
    /// cross.
    Near {
        /// First value.
        from: f64,
        /// Last value.
        to: f64,
    },
}

/// A value at which the face has the probability asked for.
#[derive(Debug, Clone)]
pub struct Root {
    /// The value.
    pub value: f64,
    /// Lower end of its interval; `None` if it is open.
    pub lo: Option<f64>,
    /// Upper end.
    pub hi: Option<f64>,
    /// dP/d(parameter) there.
    pub slope: f64,
    /// Its standard error.
    pub slope_error: f64,
    /// Whether the interval is as narrow as asked for.
    pub reached: bool,
    /// Fresh tosses of this root.
    pub tosses: u64,
    /// Those without a face; the interval is wide enough for any they would have shown.
    pub undecided: u64,
    /// How the search went.
    pub rounds: Vec<Round>,
    /// How far finer numerical settings would move it.
    pub numerical: Option<Numerical>,
    /// The coin there.
    pub coin: Coin,
}

impl Root {
    /// The longer arm of the interval; infinite if an end is open.
    pub fn half_width(&self) -> f64 {
        match (self.lo, self.hi) {
            (Some(lo), Some(hi)) => (self.value - lo).max(hi - self.value),
            _ => f64::INFINITY,
        }
    }

    /// Whether the slope cannot be told from 0: the face's probability hardly depends on the
    /// parameter here.
    pub fn is_on_plateau(&self) -> bool {
        self.slope.abs() <= 2.0 * self.slope_error
    }
}

impl Curve {
    /// The roots.
    pub fn roots(&self) -> impl Iterator<Item = &Root> {
        self.findings.iter().filter_map(|finding| match finding {
            Finding::Root(root) => Some(root),
            Finding::Near { .. } => None,
        })
    }

    /// The smallest and the largest probability of the scan.
    pub fn extremes(&self) -> [Scanned; 2] {
        let by_p = |a: &&Scanned, b: &&Scanned| a.p.total_cmp(&b.p);
        let none = Scanned {
            value: f64::NAN,
            p: f64::NAN,
            lo: f64::NAN,
            hi: f64::NAN,
            tosses: 0,
        };
        [
            self.scan.iter().min_by(by_p).copied().unwrap_or(none),
            self.scan.iter().max_by(by_p).copied().unwrap_or(none),
        ]
    }
}

/// Answers a question.
///
/// # Errors
/// [`QuestionError`] if the question or the config at a value has problems, or it was stopped.
pub fn fair(
    template: &Template,
    question: &Question,
    workers: &Workers<'_>,
) -> Result<Fair, QuestionError> {
    let range = checked(template, question)?;
    let question = Question {
        range: Some(range),
        ..question.clone()
    };
    curve::answer(template, &question, Axis::new(range[0], range[1]), workers)
}

/// The range to search, or everything that is wrong with the question.
fn checked(template: &Template, question: &Question) -> Result<[f64; 2], QuestionError> {
    let mut refused = refused_numbers(question);
    if template.is_sized() && question.key == "coin.radius_m" {
        let key = question.key.clone();
        refused.push(QuestionError::SizeIsSought { key });
    }
    let range = checked_range(template, question).map_err(|error| refused.push(error));
    match (range, QuestionError::of_all(refused)) {
        (Ok(range), None) => Ok(range),
        (_, Some(error)) => Err(error),
        (Err(()), None) => unreachable!("why there is no range was noted"),
    }
}

/// What is wrong with the numbers of a question, whatever the config.
fn refused_numbers(question: &Question) -> Vec<QuestionError> {
    let Question {
        target,
        half_width,
        max_tosses,
        ..
    } = *question;
    let mut refused = vec![];
    if !(target > 0.0 && target < 1.0) {
        refused.push(QuestionError::Target(target));
    }
    if !(half_width > 0.0 && half_width.is_finite()) {
        refused.push(QuestionError::HalfWidth(half_width));
    }
    if max_tosses < LEAST_TOSSES {
        refused.push(QuestionError::TooFewTosses {
            least: LEAST_TOSSES,
            given: max_tosses,
        });
    }
    refused
}

/// The range to search: the one asked for, or the natural one.
fn checked_range(template: &Template, question: &Question) -> Result<[f64; 2], QuestionError> {
    let [from, to] = match question.range {
        Some(range) => range,
        None => natural_range(template, &question.key)?,
    };
    Span { from, to }.check()?;
    check_ends(template, &question.key, [from, to])?;
    Ok([from, to])
}

/// The range in which [`fair`] searches the parameter of this key if no other is asked for.
///
/// # Errors
/// [`QuestionError::NoRange`] if it has none; [`QuestionError`] if the config has problems.
///
/// # Example
/// ```
/// use coinmc_questions::{Template, natural_range};
/// let text = "
///     coin.ratio = 1
///     surface = { restitution = 0.5, friction = 0.3 }
///     launch.preset = 'robot'
///     engine.flat = {}
/// ";
/// let template = Template::new("inline", text, &[]);
/// assert_eq!(natural_range(&template, "surface.friction")?, [0.0, 1.0]);
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
pub fn natural_range(template: &Template, key: &str) -> Result<[f64; 2], QuestionError> {
    match key {
        "coin.ratio" => ratios(template),
        "surface.restitution" => Ok([0.0, 0.95]),
        "surface.friction" => Ok([0.0, 1.0]),
        _ => {
            // a key that does not exist is reported as such
            template.plan(&[(key, "1.0".to_owned())])?;
            Err(QuestionError::NoRange {
                key: key.to_owned(),
            })
        }
    }
}

/// Refuses an end at which there is no such scene, before any toss. What is the same at both ends is wrong with the
/// key, or with the config itself, and is told as such.
fn check_ends(template: &Template, key: &str, ends: [f64; 2]) -> Result<(), QuestionError> {
    let at = |value: f64| template.plan(&[(key, format!("{value:?}"))]);
    let refused = |end, value, problems| QuestionError::RangeEnd {
        end,
        value,
        problems,
    };
    match ends.map(at) {
        [Err(QuestionError::Config(problems)), Ok(_)] => Err(refused("from", ends[0], problems)),
        [Ok(_), Err(QuestionError::Config(problems))] => Err(refused("to", ends[1], problems)),
        [
            Err(QuestionError::Config(from)),
            Err(QuestionError::Config(to)),
        ] if from.problems() != to.problems() => Err(QuestionError::Several(vec![
            refused("from", ends[0], from),
            refused("to", ends[1], to),
        ])),
        [from, to] => from.and(to).map(|_| ()),
    }
}

/// The natural range of the ratio: no coin thinner than its own rims, or that would not rest on its edge.
fn ratios(template: &Template) -> Result<[f64; 2], QuestionError> {
    const RANGE: [f64; 2] = [0.05, 4.0];
    /// A thickness above that of both rims, H = 2r.
    const CLEAR: f64 = 1.1;
    /// The same above the least ratio at which a coin rests on its conical edge.
    const RESTS: f64 = 1.02;
    /// A thickness below that at which a conical edge leaves no narrower face.
    const POINTED: f64 = 0.95;
    let [from, to] = RANGE;
    let at = |ratio: f64| template.plan(&[("coin.ratio", format!("{ratio:?}"))]);
    // where the radius depends on the ratio, it is the least for the thickest coin; a cone with much draft
    // has no coin so thick, but always one that is as thick as its radius
    let plan = at(to).or_else(|error| at(1.0).map_err(|_| error))?;
    let apex = plan.points.iter().map(|point| {
        let [_, apex] = Coin::ratios_with_draft(point.scene.coin.draft_deg());
        POINTED * apex
    });
    let to = apex.fold(to, f64::min);
    let least = plan.points.iter().map(|point| {
        let coin = &point.scene.coin;
        let [resting, _] = Coin::ratios_with_draft(coin.draft_deg());
        (CLEAR * 2.0 * coin.rim_radius_m() / coin.radius_m()).max(RESTS * resting)
    });
    Ok([least.fold(from, f64::max), to])
}
