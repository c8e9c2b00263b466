//! How far each assumption of a scene moves a root.
//!
//! At the root, tosses with the assumed number are compared with tosses with its least and its most
//! value, with the same random numbers. The change ΔP of the face's probability moves the root: with
//! the log odds η of the probability, linear in the parameter near the root, by −Δη/η'.

use crate::scenes::Assumption;
use crate::workers::At;
use crate::{Fair, Interval, QuestionError, Root, Template, Workers};

/// How far an assumption moves a root.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effect {
    /// The assumption.
    pub assumption: Assumption,
    /// The root with the least and with the most value.
    pub roots: [Moved; 2],
}

/// A root that an assumption has moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moved {
    /// About where it is.
    pub value: f64,
    /// Half width of the interval of its shift: that of chance, and of what undecided tosses would have shown.
    pub half_width: f64,
}

impl Effect {
    /// The longer of the two shifts of `root`.
    pub fn size(&self, root: &Root) -> f64 {
        let [low, high] = self.roots.map(|moved| (moved.value - root.value).abs());
        low.max(high)
    }
}

/// The effects of assumptions on a root, the strongest first, by `tosses` tosses of each.
///
/// # Errors
/// [`QuestionError`], as [`fair`](crate::fair()).
///
/// # Example
/// ```
/// use coinmc_questions::{Question, Workers, assumptions, fair, scenes::EverydayScene};
/// use std::sync::atomic::AtomicBool;
/// let scene = EverydayScene::named("felt")?;
/// let cancel = AtomicBool::new(false);
/// let workers = Workers { threads: None, cancel: &cancel, made: &|_| () };
/// let question = Question { half_width: 0.1, numerical_tosses: 0, ..Question::default() };
/// let answer = fair(&scene.template(&[]), &question, &workers)?;
/// let root = answer.curves[0].roots().next().unwrap();
/// let strongest = scene.assumptions().into_iter().take(1);
/// let effects = assumptions::effects(&scene.template(&[]), &answer, root, strongest, 512, &workers)?;
/// assert_eq!(effects[0].assumption.key, "surface.restitution");
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
pub fn effects(
    template: &Template,
    fair: &Fair,
    root: &Root,
    assumptions: impl IntoIterator<Item = Assumption>,
    tosses: u64,
    workers: &Workers<'_>,
) -> Result<Vec<Effect>, QuestionError> {
    let question = &fair.question;
    let sought = |assumption: &Assumption| assumption.key != question.key;
    let assumptions: Vec<Assumption> = assumptions.into_iter().filter(sought).collect();
    let at_root = (question.key.as_str(), format!("{:?}", root.value));
    let mut plans = vec![];
    for assumption in &assumptions {
        for number in [assumption.low, assumption.high] {
            let values = [at_root.clone(), (assumption.key, format!("{number:?}"))];
            plans.push(template.plan(&values)?);
        }
    }
    let usual = template.plan(&[at_root])?;
    let usual = At {
        plan: &usual,
        point: 0,
    };
    let others: Vec<_> = plans.iter().map(|plan| At { plan, point: 0 }).collect();
    let changes = workers.compare_with(usual, &others, 0..tosses)?;
    let moved: Vec<Moved> = changes
        .iter()
        .map(|changes| changes.interval(question.face, fair.confidence))
        .map(|change| moved(root, question.target, change))
        .collect();
    let mut effects: Vec<Effect> = assumptions
        .into_iter()
        .zip(moved.chunks_exact(2))
        .map(|(assumption, moved)| Effect {
            assumption,
            roots: [moved[0], moved[1]],
        })
        .collect();
    effects.sort_by(|a, b| b.size(root).total_cmp(&a.size(root)));
    Ok(effects)
}

/// Where a root is once the face's probability has changed by so much.
fn moved(root: &Root, target: f64, change: Interval) -> Moved {
    /// Probabilities this near to 0 and 1 have no log odds that a few tosses could tell.
    const LEAST: f64 = 1e-3;
    let odds = |p: f64| {
        let p = p.clamp(LEAST, 1.0 - LEAST);
        libm::log(p / (1.0 - p))
    };
    // dP/dx = P(1 − P) dη/dx
    let slope = root.slope / (target * (1.0 - target));
    let shift = -(odds(target + change.value) - odds(target)) / slope;
    let arm = (change.hi - change.value).max(change.value - change.lo);
    Moved {
        value: root.value + shift,
        half_width: arm / root.slope.abs(),
    }
}
