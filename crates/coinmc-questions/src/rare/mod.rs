//! How rare is a face that hardly ever comes up?
//!
//! # Method
//! A probability P to a relative error of 10 % takes some 400/P tosses by brute force. Where little
//! bounces, the inclination with which the coin first touches the ground decides most: a thin coin
//! stands only if it lands nearly on its rim. That inclination follows from the launch by free flight,
//! at a hundredth of the cost of a toss. So many launches are drawn, divided into strata by the rank of
//! their inclination, and those of each stratum h are tossed with a chance q_h of their own; each toss counts
//! 1/q_h. That is unbiased whatever the chances are, since whether a launch is tossed does not depend on what
//! would come of it: also where the inclination decides nothing, or is a little wrong (a coin with rounded
//! rims, drag). Then nothing is gained, and all are tossed.
//!
//! A pilot learns the chances: first as many tosses in each stratum, then by what they showed, until it is a
//! sixteenth of the sample that is needed. The sample itself takes fresh launches with chances that are fixed.
//! Its interval is that of a weighted sum of counts (see `interval`). It grows until that is as short as
//! asked for. Stopping so does not reduce the coverage: a relative error fixes the number of tosses that show the
//! face, whatever P, and the moment at which a Poisson process has shown so many is as good a measure of its
//! rate as their number in a fixed time. Of 4,000 simulated samples each of four kinds of strata, for relative
//! errors of .05 to .5, 94.6 to 99.0 % of the intervals of 95 % hold P (with an error of .7 %).

mod chances;
mod document;
mod interval;
mod strata;
mod tosses;
mod touch;

pub use chances::Gain;
pub use document::document_of_rare;

use crate::{Interval, QuestionError, Template, Workers};
use chances::{Chances, Known};
use coinmc::plan::Plan;
use coinmc_core::Face;
use strata::{STRATA, Strata};
use tosses::{Launches, Tossed};

/// Launches by whose ranks the strata are divided.
const RANKED: u64 = 1 << 14;
/// Tosses of each stratum in the first round of the pilot, about.
const FIRST: f64 = 32.0;
/// The pilot ends when it is this part of the sample.
const PILOT: f64 = 16.0;
/// The sample is looked at this often, if it is as long as expected.
const STAGES: f64 = 32.0;
/// Largest relative error: with more the sample would be a handful of tosses that show the face.
const MOST_ERROR: f64 = 0.5;
/// Tosses that must show the face to tell what is gained.
const LEAST_SHOWN: u64 = 50;
/// Least number of tosses.
const LEAST_TOSSES: u64 = 4096;
/// Most launches drawn in one go.
const MOST_LAUNCHES: f64 = 1e13;

/// How likely is a rare face?
///
/// # Example
/// A coin twenty times as wide as thick that does not bounce stands in one of some thirty tosses.
/// ```
/// use coinmc_core::Face;
/// use coinmc_questions::{HowRare, Template, Workers, how_rare};
/// use std::sync::atomic::AtomicBool;
/// let text = "coin.ratio = 0.1\nsurface = { landing = 'adhesive', restitution = 0.0, friction = 0.3 }\n\
///             launch.preset = 'clean-flat'\nengine.flat = {}";
/// let question = HowRare { face: Face::Side, relative_error: 0.05, max_tosses: 1_000_000 };
/// let cancel = AtomicBool::new(false);
/// let workers = Workers { threads: None, cancel: &cancel, made: &|_| () };
/// let answer = how_rare(&Template::new("inline", text, &[]), &question, &workers)?;
/// let known = std::f64::consts::FRAC_2_PI * 0.05_f64.atan();
/// assert!(answer.reached && answer.p.lo < known && known < answer.p.hi);
/// assert!(answer.gain().tosses > 2.0);
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HowRare {
    /// The face.
    pub face: Face,
    /// Half width of the interval that is enough, as a share of the probability.
    pub relative_error: f64,
    /// Tosses after which the answer stops short of that.
    pub max_tosses: u64,
}

/// The answer to a [`HowRare`].
#[derive(Debug, Clone, PartialEq)]
pub struct Rareness {
    /// The question.
    pub question: HowRare,
    /// The probability of the face and its interval. Tosses without a face count at the upper end.
    pub p: Interval,
    /// Its interval if no undecided toss showed the face: what more tosses make shorter.
    pub without_undecided: Interval,
    /// Whether the interval is as short as asked for.
    pub reached: bool,
    /// Confidence of the interval.
    pub confidence: f64,
    /// Launches that were drawn for the answer.
    pub launches: u64,
    /// Those of them that were tossed.
    pub tosses: u64,
    /// Tosses that show the face.
    pub shown: u64,
    /// Tosses without a face.
    pub undecided: u64,
    /// Tosses of the pilot, which are in no other number but the work.
    pub pilot_tosses: u64,
    /// Impacts, steps in sustained contact and one for each toss, the pilot included: it goes with the time.
    pub work: u64,
    /// The same of a toss by brute force, estimated.
    pub work_of_a_toss: f64,
    /// The strata, from the rim to flat.
    pub strata: Vec<Stratum>,
    /// Name of the engine.
    pub engine: &'static str,
    /// Name of its law of impact.
    pub law: &'static str,
}

/// Launches that land alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stratum {
    /// Least |cos| of the angle between the axis and the vertical at first touch.
    pub from: f64,
    /// Most.
    pub to: f64,
    /// Launches that were drawn.
    pub launches: u64,
    /// The chance with which they were tossed.
    pub chance: f64,
    /// Those that were.
    pub tosses: u64,
    /// Those of them that show the face.
    pub shown: u64,
}

impl Rareness {
    /// Whether undecided tosses are why the interval is not as short as asked for: without them it would be, or
    /// most of its length is theirs. Then more tosses do not help.
    pub fn is_limited_by_undecided(&self) -> bool {
        let without = &self.without_undecided;
        let short = is_short(without, self.question.relative_error);
        !self.reached && (short || self.p.hi - without.hi > without.half_width())
    }

    /// What brute force takes for the same half width, but for undecided tosses, which it has as well, by what was
    /// done, the pilot included: how many times fewer tosses, and less work, it took. NaN if the face was not
    /// seen, or in all tosses, which leaves nothing to estimate.
    pub fn gain(&self) -> Gain {
        let z = crate::interval::normal_quantile(self.confidence);
        let arm = self.without_undecided.half_width() / z;
        let brute_force = self.p.value * (1.0 - self.p.value) / (arm * arm);
        let brute_force = if self.shown > 0 && 1.0 - self.p.value > ROUNDING {
            brute_force
        } else {
            f64::NAN
        };
        Gain {
            tosses: brute_force / (self.tosses + self.pilot_tosses) as f64,
            work: brute_force * self.work_of_a_toss / self.work as f64,
        }
    }
}

/// A probability that is no farther from 1 is 1: that of a face of all tosses, whose weights were rounded.
const ROUNDING: f64 = 1e-9;

/// Whether the interval of a face that was seen is no wider than ± this share of its probability.
fn is_short(p: &Interval, relative_error: f64) -> bool {
    p.value > 0.0 && p.half_width() <= relative_error * p.value
}

/// Answers a [`HowRare`]. The answer does not depend on the number of threads.
///
/// # Errors
/// [`QuestionError`] if the question or the config has problems, or it was stopped.
pub fn how_rare(
    template: &Template,
    question: &HowRare,
    workers: &Workers<'_>,
) -> Result<Rareness, QuestionError> {
    let plan = checked(template, question)?;
    let mut work = Work::begin(&plan, question, workers)?;
    let most = question.max_tosses as f64;
    work.pilot(|needed| needed.min(most) / PILOT)?;
    work.sample()
}

/// How many times fewer tosses, and less work, [`how_rare`] takes than brute force beside its pilot, by `tosses` tosses from
/// which it learns and about as many by which that is measured, to some 30 %; `None` if these show the face in
/// fewer than 50 tosses, which tell nothing.
///
/// # Errors
/// As [`how_rare`].
pub fn gain_expected(
    template: &Template,
    question: &HowRare,
    tosses: u64,
    workers: &Workers<'_>,
) -> Result<Option<Gain>, QuestionError> {
    let plan = checked(template, question)?;
    let mut work = Work::begin(&plan, question, workers)?;
    work.pilot(|_| tosses as f64)?;
    let wanted = work.wanted();
    // other tosses than those from which the chances were learnt: these fit themselves too well
    let part = work.learned.tosses() as f64 / wanted.tosses;
    let measured = work.toss(wanted.launches * part, &wanted.each)?;
    let shown: u64 = measured.counts.iter().map(|counted| counted.shown).sum();
    if shown < LEAST_SHOWN {
        return Ok(None);
    }
    let known = Known::of(measured.shares(), &measured.counts);
    Ok(Some(known.gain(&wanted.each)))
}

/// The plan, once question and config have been checked.
fn checked(template: &Template, question: &HowRare) -> Result<Plan, QuestionError> {
    let error = question.relative_error;
    if !(error > 0.0 && error <= MOST_ERROR) {
        return Err(QuestionError::RelativeError(error));
    }
    if question.max_tosses < LEAST_TOSSES {
        return Err(QuestionError::TooFewTosses {
            least: LEAST_TOSSES,
            given: question.max_tosses,
        });
    }
    let plan = template.plan(&[])?;
    if plan.points.len() > 1 {
        return Err(QuestionError::Swept(plan.axes.join(", ")));
    }
    if !plan.points[0].engine.makes_tosses() {
        return Err(QuestionError::NoLaunch);
    }
    Ok(plan)
}

/// An answer in the making.
struct Work<'a> {
    plan: &'a Plan,
    question: &'a HowRare,
    launches: Launches<'a>,
    strata: Strata,
    /// What the pilot showed.
    learned: Tossed,
    /// Number of the first launch that was not drawn yet.
    next: u64,
}

impl<'a> Work<'a> {
    fn begin(
        plan: &'a Plan,
        question: &'a HowRare,
        workers: &'a Workers<'a>,
    ) -> Result<Self, QuestionError> {
        let launches = Launches::new(plan, question.face, workers);
        let strata = Strata::of(launches.inclinations(0..RANKED)?);
        Ok(Self {
            plan,
            question,
            launches,
            strata,
            learned: Tossed::none(),
            next: RANKED,
        })
    }

    fn known(&self) -> Known {
        Known::of(self.learned.shares(), &self.learned.counts)
    }

    /// What the answer takes, by what the pilot showed.
    fn wanted(&self) -> Chances {
        let (error, confidence) = (self.question.relative_error, self.plan.confidence);
        self.known().chances(error, confidence)
    }

    /// Learns what the strata show, by as many tosses as are enough, which may depend on how many the answer needs.
    fn pilot(&mut self, enough: impl Fn(f64) -> f64) -> Result<(), QuestionError> {
        // as many tosses of each
        let smallest = Strata::nominal_share(0);
        let first: Vec<f64> = (0..STRATA)
            .map(|stratum| smallest / Strata::nominal_share(stratum))
            .collect();
        self.learn(FIRST / smallest, &first)?;
        loop {
            let made = self.learned.tosses();
            let needed = self.wanted();
            let enough = enough(needed.tosses);
            if made as f64 >= enough {
                return Ok(());
            }
            // twice as many in all, but no more than are enough
            let more = (made as f64).min(enough - made as f64 + 1.0);
            self.learn(needed.launches * more / needed.tosses, &needed.each)?;
        }
    }

    /// Tosses for the pilot.
    fn learn(&mut self, launches: f64, chances: &[f64]) -> Result<(), QuestionError> {
        let tossed = self.toss(launches, chances)?;
        self.learned.add(&tossed);
        Ok(())
    }

    fn toss(&mut self, launches: f64, chances: &[f64]) -> Result<Tossed, QuestionError> {
        // at most 1e13
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let launches = launches.clamp(1.0, MOST_LAUNCHES) as u64;
        let numbers = self.next..self.next + launches;
        self.next = numbers.end;
        self.launches.toss(numbers, &self.strata, chances)
    }

    /// The answer, by fresh launches: until the interval is as short as asked for.
    fn sample(mut self) -> Result<Rareness, QuestionError> {
        let wanted = self.wanted();
        let limit = self
            .question
            .max_tosses
            .saturating_sub(self.learned.tosses()) as f64;
        let stages = (wanted.tosses.min(limit) / STAGES).max(1.0);
        let mut sample = Tossed::none();
        loop {
            // no stage passes the limit by more than chance
            let room = limit - sample.tosses() as f64;
            let part = stages.min(room) / wanted.tosses;
            let tossed = self.toss(wanted.launches * part, &wanted.each)?;
            sample.add(&tossed);
            let answer = self.answer(&sample, &wanted.each);
            if answer.reached || room <= stages {
                return Ok(answer);
            }
        }
    }

    fn answer(&self, sample: &Tossed, chances: &[f64]) -> Rareness {
        let launches = sample.launches.iter().sum();
        let interval = |counts: &[interval::Counted]| {
            interval::interval(counts, chances, launches, self.plan.confidence)
        };
        let p = interval(&sample.counts);
        let decided = |counted: &interval::Counted| interval::Counted {
            undecided: 0,
            ..*counted
        };
        let decided: Vec<_> = sample.counts.iter().map(decided).collect();
        let point = &self.plan.points[0];
        let stratum = |index: usize| {
            let [from, to] = self.strata.range(index);
            Stratum {
                from,
                to,
                launches: sample.launches[index],
                chance: chances[index],
                tosses: sample.counts[index].tosses,
                shown: sample.counts[index].shown,
            }
        };
        let works = sample.counts.iter().zip(chances);
        let weighted_work: f64 = works.map(|(counted, q)| counted.work as f64 / q).sum();
        let sum = |of: fn(&interval::Counted) -> u64| sample.counts.iter().map(of).sum();
        Rareness {
            question: *self.question,
            p,
            without_undecided: interval(&decided),
            reached: is_short(&p, self.question.relative_error),
            confidence: self.plan.confidence,
            launches,
            tosses: sample.tosses(),
            shown: sum(|counted| counted.shown),
            undecided: sum(|counted| counted.undecided),
            pilot_tosses: self.learned.tosses(),
            work: sum(|counted| counted.work)
                + self
                    .learned
                    .counts
                    .iter()
                    .map(|counted| counted.work)
                    .sum::<u64>(),
            work_of_a_toss: weighted_work / launches as f64,
            strata: (0..STRATA).map(stratum).collect(),
            engine: point.engine.descriptor().name,
            law: point.engine.law(),
        }
    }
}
