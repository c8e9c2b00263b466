//! The result of a chunk, and the integration of a point.

use super::{Chunk, RunError};
use crate::plan::{Plan, Point};
use coinmc_core::{Domain, Stream, Tally};
use coinmc_quadrature::{Goal, Integral, integrate};

/// The result of a chunk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ChunkResult {
    /// The counts of a range of tosses.
    Tossed(Tossed),
    /// The integral of a whole point, whose chunk is an empty range.
    Integrated(Integral),
}

/// Tosses that were made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Tossed {
    pub(super) tally: Tally,
    /// Computing time, where it is limited, else 0: the same tosses never take exactly the same time.
    pub(super) microseconds: u64,
}

impl Tossed {
    /// The counts of no toss.
    pub(super) fn none() -> Self {
        Self {
            tally: Tally::default(),
            microseconds: 0,
        }
    }
}

impl ChunkResult {
    /// Number of tosses counted.
    pub(super) fn tosses(&self) -> u64 {
        match self {
            Self::Tossed(tossed) => tossed.tally.tosses(),
            Self::Integrated(_) => 0,
        }
    }
}

/// The only chunk of an integrated point.
pub(super) fn whole(point: usize) -> Chunk {
    Chunk {
        point,
        tosses: 0..0,
    }
}

/// Integrates a point on this thread; `None` if the point is tossed or has a closed form.
///
/// Stops at the goal of the plan, or after `evaluations` if that comes first (but not before the
/// first look). The result depends only on the plan and on that number.
///
/// # Errors
/// [`RunError::NoSuchChunk`] if there is no such point, [`RunError::Settings`] if its engine
/// rejects its settings.
///
/// # Example
/// ```
/// let plan = coinmc::config::parse(
///     "inline",
///     "coin.ratio = 1\nsurface.landing = 'adhesive'\nlaunch.preset = 'clean'\n\
///      engine.volumetric = {}\nstop.tosses = 1e6",
///     &[],
/// ).unwrap();
/// let integral = coinmc::run::integrate_point(&plan, 0, u64::MAX)?.unwrap();
/// assert!(integral.exact && (integral.side().p - 0.2_f64.sqrt()).abs() < 1e-15);
/// # Ok::<(), coinmc::run::RunError>(())
/// ```
pub fn integrate_point(
    plan: &Plan,
    point: usize,
    evaluations: u64,
) -> Result<Option<Integral>, RunError> {
    if point >= plan.points.len() {
        return Err(RunError::NoSuchChunk {
            chunk: whole(point),
            points: plan.points.len(),
        });
    }
    let goal = plan.goal();
    let goal = Goal {
        evaluations: goal.evaluations.min(evaluations),
        ..goal
    };
    integrate_while(plan, point, goal, || true)
}

/// Like [`integrate_point`], with its own goal; also `None` if `go_on` returned false.
pub(super) fn integrate_while(
    plan: &Plan,
    index: usize,
    goal: Goal,
    go_on: impl Fn() -> bool,
) -> Result<Option<Integral>, RunError> {
    let Some(method) = plan.method(index) else {
        return Ok(None);
    };
    let stream_point = if plan.paired { 0 } else { index as u64 };
    let point = &*plan.points.at(index);
    let engine = point.build_engine().map_err(|source| RunError::Settings {
        point: index,
        source,
    })?;
    let Point {
        scene, launches, ..
    } = point;
    let scrambles = Stream::new(plan.seed, Domain::Scramble, stream_point);
    Ok(engine
        .and_then(|engine| integrate(method, scene, launches, &engine, &scrambles, &goal, go_on)))
}
