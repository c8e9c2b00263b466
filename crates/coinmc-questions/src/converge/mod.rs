//! How far the engine's numerical settings move the probabilities of a config's points.
//!
//! The same tosses are made with the settings of the config and with tight ones: a tenth of every tolerance, and
//! half the time step where the engine goes in steps. Only tosses whose end changes contribute to the difference, so
//! it is known far better than the probabilities.

mod document;
mod paired;

pub use document::document_of_convergence;

use crate::changes::Changes;
use crate::interval::normal_quantile;
use crate::workers::At;
use crate::{Interval, QuestionError, Template, Workers};
use coinmc::plan::Plan;
use coinmc_core::{Estimate, Face, Finer};
use std::sync::Arc;

/// Least number of tosses of a point: with fewer the intervals mean nothing.
const LEAST: u64 = 256;
/// By what tolerances are multiplied.
const TENTH: f64 = 0.1;
/// By what a time step is multiplied: the time that a toss takes grows as much.
const HALF: f64 = 0.5;

/// A numerical setting and its two values.
#[derive(Debug, Clone, PartialEq)]
pub struct Tightened {
    /// Its key in configs.
    pub key: String,
    /// The value of the config.
    pub usual: f64,
    /// The tight one.
    pub tight: f64,
}

/// What tight settings do to a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Converged {
    /// Its index.
    pub point: usize,
    /// The swept parameters.
    pub parameters: Vec<(Arc<str>, f64)>,
    /// The probabilities of heads, tails and side with the settings of the config.
    pub p: [Estimate; 3],
    /// P with tight settings minus P with those of the config, of heads, tails and side. The interval holds whatever
    /// the undecided tosses would have shown.
    pub shifts: [Interval; 3],
    /// Whether the shift of each face is not 0, at the confidence of all intervals together.
    pub is_biased: [bool; 3],
    /// Tosses whose end changes.
    pub changed: u64,
    /// Undecided tosses, with the settings of the config and with tight ones.
    pub undecided: [u64; 2],
    /// Tosses with either settings.
    pub tosses: u64,
}

/// What tight settings do to all points.
#[derive(Debug, Clone, PartialEq)]
pub struct Convergence {
    /// The engine.
    pub engine: &'static str,
    /// The settings; none if the engine has none that are numbers.
    pub settings: Vec<Tightened>,
    /// The points that are tossed.
    pub points: Vec<Converged>,
    /// Points that are answered without tosses.
    pub without_tosses: usize,
    /// Confidence of each interval.
    pub confidence: f64,
}

impl Convergence {
    /// The points and faces whose shift is not 0.
    pub fn biased(&self) -> impl Iterator<Item = (&Converged, Face)> {
        self.points.iter().flat_map(|point| {
            let faces = Face::ALL.into_iter();
            let biased = faces.filter(|&face| point.is_biased[face as usize]);
            biased.map(move |face| (point, face))
        })
    }

    /// The largest shift that any interval allows, either way.
    pub fn at_most(&self) -> f64 {
        let shifts = self.points.iter().flat_map(|point| point.shifts);
        let ends = shifts.map(|shift| shift.hi.max(-shift.lo));
        ends.fold(0.0, f64::max)
    }
}

/// Tosses every point of a config with its numerical settings and with tight ones, by the same launches: those of
/// the first `tosses` tosses of a run.
///
/// # Errors
/// [`QuestionError`] if the config has problems, there are too few tosses, or it was stopped.
///
/// # Example
/// ```
/// use coinmc_questions::{Template, Workers, converge};
/// use std::sync::atomic::AtomicBool;
/// let text = "coin.ratio = 1.2\nsurface = { restitution = 0.5, friction = 0.3 }\n\
///             launch.preset = 'robot'\nengine.flat = {}";
/// let cancel = AtomicBool::new(false);
/// let workers = Workers { threads: None, cancel: &cancel, made: &|_| () };
/// let found = converge(&Template::new("inline", text, &[]), 1024, &workers)?;
/// assert!(found.points[0].changed < 5 && found.biased().count() == 0);
/// assert_eq!(found.settings[0].key, "engine.flat.zeno");
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
pub fn converge(
    template: &Template,
    tosses: u64,
    workers: &Workers<'_>,
) -> Result<Convergence, QuestionError> {
    if tosses < LEAST {
        let least = LEAST;
        let given = tosses;
        return Err(QuestionError::TooFewTosses { least, given });
    }
    let (usual, spelled) = template.spelled_out()?;
    let settings = tightened(&usual);
    let values: Vec<_> = settings
        .iter()
        .map(|setting| (setting.key.as_str(), format!("{:?}", setting.tight)))
        .collect();
    let tight = spelled.plan(&values)?;
    let tossed: Vec<usize> = (0..usual.points.len())
        .filter(|&point| usual.makes_tosses(point))
        .collect();
    let at = |point| [&usual, &tight].map(|plan| At { plan, point });
    let pairs: Vec<_> = tossed.iter().map(|&point| at(point)).collect();
    let changes = if settings.is_empty() {
        vec![]
    } else {
        workers.compare_runs(&pairs, 0..tosses)?
    };
    let intervals = 3 * changes.len();
    let points = tossed.iter().zip(&changes);
    Ok(Convergence {
        engine: usual.points.at(0).engine.name(),
        points: points
            .map(|(&point, changes)| converged(&usual, point, changes, intervals))
            .collect(),
        without_tosses: usual.points.len() - tossed.len(),
        confidence: usual.confidence,
        settings,
    })
}

/// The numerical settings of a plan's engine that are single numbers, and their tight values.
fn tightened(plan: &Plan) -> Vec<Tightened> {
    let point = plan.points.at(0);
    let engine = point.engine.descriptor();
    let factor = if engine.stepped { HALF } else { TENTH };
    let numbers = engine.finer.iter().filter_map(|(key, finer)| {
        let key = format!("engine.{}.{key}", engine.name);
        match finer {
            Finer::Times(_) => plan.number(&key).map(|usual| (key, usual)),
            Finer::Word(_) => None,
        }
    });
    // what is 0 is switched off
    let numbers = numbers.filter(|(_, usual)| *usual > 0.0);
    numbers
        .map(|(key, usual)| Tightened {
            key,
            usual,
            tight: usual * factor,
        })
        .collect()
}

fn converged(plan: &Plan, point: usize, changes: &Changes, intervals: usize) -> Converged {
    let shift = |face, confidence| {
        let z = normal_quantile(confidence);
        let of = |(gained, lost)| paired::difference(gained, lost, changes.tosses(), z);
        let [least, most] = changes.extremes_of(face).map(of);
        Interval {
            lo: least.lo,
            hi: most.hi,
            ..of(changes.of(face))
        }
    };
    // among many intervals some miss by chance
    let of_all = 1.0 - (1.0 - plan.confidence) / intervals as f64;
    let is_biased = |face| {
        let Interval { lo, hi, .. } = shift(face, of_all);
        lo > 0.0 || hi < 0.0
    };
    let swept = |(name, _): &&(Arc<str>, f64)| plan.axes.iter().any(|axis| **axis == **name);
    let parameters = &plan.points.at(point).parameters;
    Converged {
        point,
        parameters: parameters.iter().filter(swept).cloned().collect(),
        p: Face::ALL.map(|face| changes.seen(face)[0].estimate(plan)),
        shifts: Face::ALL.map(|face| shift(face, plan.confidence)),
        is_biased: Face::ALL.map(is_biased),
        changed: changes.changed(),
        undecided: changes.undecided(),
        tosses: changes.tosses(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;

    fn found(engine: &str, tosses: u64) -> Convergence {
        let text = format!(
            "coin.ratio = [1.0, 1.5]\nsurface = {{ restitution = 0.1, friction = 0.6 }}\n\
             launch.preset = 'robot'\n{engine}"
        );
        let cancel = AtomicBool::new(false);
        let workers = Workers {
            threads: None,
            cancel: &cancel,
            made: &|_| (),
        };
        converge(&Template::new("inline", text, &[]), tosses, &workers).unwrap()
    }

    /// A Zeno threshold of a whole radian ends bounces that would still turn the coin.
    #[test]
    fn a_bias_that_is_there_is_found() {
        let coarse = found("engine.flat.zeno = 1.0", 20_000);
        assert!(coarse.biased().count() > 0, "{coarse:?}");
        let side = coarse.points[0].shifts[Face::Side as usize];
        assert!(side.value < -1e-3 && side.value > -3e-3, "{side:?}");
        for (point, face) in coarse.biased() {
            let shift = point.shifts[face as usize];
            assert!(shift.lo > 0.0 || shift.hi < 0.0);
        }
        let fine = found("engine.flat = {}", 4096);
        assert_eq!(fine.biased().count(), 0, "{fine:?}");
        assert!(fine.at_most() < 3e-3 && fine.points.len() == 2);
    }

    /// With nine impacts at most some tosses are undecided with either settings: no bound below their share.
    #[test]
    fn undecided_tosses_may_hide_a_shift() {
        let found = found("engine.flat.max_impacts = 9", 512);
        for point in &found.points {
            let open = point.undecided[0] as f64 / point.tosses as f64;
            assert!(open > 0.02, "{point:?}");
            for (shift, p) in point.shifts.iter().zip(&point.p) {
                assert!(shift.lo < -open && shift.hi > open, "{shift:?} {open}");
                assert!(p.hi > p.p + open, "{p:?}");
            }
            assert!(found.at_most() > open);
        }
        assert_eq!(found.biased().count(), 0);
    }

    #[test]
    fn tolerances_are_a_tenth() {
        let settings = found("engine.flat = {}", LEAST).settings;
        let keys: Vec<_> = settings.iter().map(|one| one.key.as_str()).collect();
        assert_eq!(keys, ["engine.flat.zeno", "engine.flat.tolerance"]);
        let is_tenth = |one: &Tightened| (one.tight / one.usual - 0.1).abs() < 1e-12;
        assert!(settings.iter().all(is_tenth));
    }
}
