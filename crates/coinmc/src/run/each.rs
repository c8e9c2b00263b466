//! Individual tosses of a point, for callers that need each toss and not only the counts.

use crate::plan::Point;
use coinmc_core::{
    Engine, EngineError, Event, EventKind, Launch, LaunchSource, Observer, Outcome, OutcomeSink,
    Starts, State, Stream,
};
use nalgebra::Vector3;
use std::ops::{ControlFlow, Range};

/// Where the launches of tosses come from.
#[derive(Clone, Copy)]
pub enum TossSource<'a> {
    /// Drawn from the distribution of the point with the random numbers of this
    /// [`stream`](super::stream): the tosses of a run.
    Drawn(&'a Stream),
    /// Given by a function of the number of the toss.
    Given(&'a (dyn Fn(u64) -> Launch + Sync)),
}

impl TossSource<'_> {
    /// The launch of toss number `toss`.
    pub fn launch(&self, point: &Point, toss: u64) -> Launch {
        match self {
            Self::Drawn(stream) => point
                .launches
                .launch(&point.scene.coin, &mut stream.toss(toss)),
            Self::Given(launch) => launch(toss),
        }
    }
}

/// A toss that has ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FinishedToss {
    /// Its number.
    pub toss: u64,
    /// Its outcome.
    pub outcome: Outcome,
    /// State of the coin when the engine stopped.
    pub end: State,
}

/// Computes tosses and calls `visit` with the number and the outcome of each, in any order (an
/// engine may compute several at a time), until it returns false. Returns false if the point has a
/// closed form and so makes no tosses.
///
/// # Errors
/// [`EngineError`] if the engine rejects its settings.
///
/// # Example
/// ```
/// use coinmc::run::{TossSource, for_each_outcome, stream};
/// let plan = coinmc::config::parse(
///     "inline",
///     "coin.ratio = 1\nsurface = { restitution = 0.5, friction = 0.3 }\n\
///      launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 100",
///     &[],
/// ).unwrap();
/// let stream = stream(&plan, 0);
/// let mut most = 0;
/// for_each_outcome(&plan.points[0], TossSource::Drawn(&stream), 0..100, |_, outcome| {
///     most = most.max(outcome.impacts);
///     true
/// })?;
/// assert!(most > 1);
/// # Ok::<(), coinmc::engines::EngineError>(())
/// ```
pub fn for_each_outcome(
    point: &Point,
    source: TossSource<'_>,
    tosses: Range<u64>,
    mut visit: impl FnMut(u64, &Outcome) -> bool,
) -> Result<bool, EngineError> {
    let first = tosses.start;
    for_some_outcomes(point, source, tosses, None, &mut |outcomes| {
        let mut outcomes = outcomes.iter();
        if outcomes.all(|(number, outcome)| visit(first + number, outcome)) {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    })
}

/// Like [`for_each_outcome`], several outcomes at a time, with the numbers counted from 0; notes
/// which face is up at each launch.
pub(super) fn for_some_outcomes(
    point: &Point,
    source: TossSource<'_>,
    tosses: Range<u64>,
    starts: Option<&Starts>,
    sink: &mut OutcomeSink<'_>,
) -> Result<bool, EngineError> {
    let Some(engine) = point.build_engine()? else {
        return Ok(false);
    };
    match source {
        TossSource::Drawn(stream) => {
            let (coin, lanes) = (&point.scene.coin, engine.lanes());
            let launches = point.launches.launches(coin, stream, tosses, lanes);
            toss_noting(&engine, launches.into(), starts, sink);
        }
        TossSource::Given(launch) => {
            let mut launches = tosses.map(launch);
            toss_noting(&engine, LaunchSource::new(&mut launches), starts, sink);
        }
    }
    Ok(true)
}

fn toss_noting<'a>(
    engine: &impl Engine<Workspace = ()>,
    launches: LaunchSource<'a>,
    starts: Option<&'a Starts>,
    sink: &mut OutcomeSink<'_>,
) {
    let launches = match starts {
        Some(starts) => launches.noting(starts),
        None => launches,
    };
    engine.toss_many(&mut (), launches, sink);
}

/// Like [`for_each_outcome`], with the final state of the coin. Tosses use the scalar path, which
/// is a few times slower for engines with batches.
///
/// # Errors
/// As [`for_each_outcome`].
pub fn for_each_end(
    point: &Point,
    source: TossSource<'_>,
    tosses: Range<u64>,
    visit: &mut dyn FnMut(&FinishedToss) -> bool,
) -> Result<bool, EngineError> {
    let Some(engine) = point.build_engine()? else {
        return Ok(false);
    };
    for toss in tosses {
        let launch = source.launch(point, toss);
        let mut last = Last::new(&launch);
        let outcome = engine.toss(&mut (), &launch, &mut last);
        let end = last.0;
        if !visit(&FinishedToss { toss, outcome, end }) {
            break;
        }
    }
    Ok(true)
}

/// Observer that keeps the last state.
struct Last(State);

impl Last {
    fn new(launch: &Launch) -> Self {
        Self(State {
            time_s: 0.0,
            position_m: Vector3::new(0.0, 0.0, launch.height_m),
            velocity_m_s: launch.velocity_m_s,
            axis: launch.axis,
            spin_rad_s: launch.spin_rad_s,
        })
    }
}

impl Observer for Last {
    fn event(&mut self, event: &Event) {
        if event.kind == EventKind::Ended {
            self.0 = event.state;
        }
    }
}
