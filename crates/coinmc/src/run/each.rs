//! Tosses of a point one by one, for who wants each of them and not their counts.

use crate::plan::Point;
use coinmc_core::{
    Engine, EngineError, Event, EventKind, Launch, LaunchSource, Observer, Outcome, OutcomeSink,
    State, Stream,
};
use nalgebra::Vector3;
use std::ops::{ControlFlow, Range};

/// How the tosses begin.
#[derive(Clone, Copy)]
pub enum Begin<'a> {
    /// Drawn from the point's distribution with the random numbers of this
    /// [`stream`](super::stream): the tosses of a run.
    Drawn(&'a Stream),
    /// As somebody says of each, by its number.
    Given(&'a (dyn Fn(u64) -> Launch + Sync)),
}

impl Begin<'_> {
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

/// A toss as it ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Its number.
    pub toss: u64,
    /// How it ended.
    pub outcome: Outcome,
    /// The coin at the end, as far as the engine followed it.
    pub end: State,
}

/// Follows tosses and tells `see` the number and the outcome of each, in any order (an engine may
/// follow several at a time), as long as it says to go on. A closed form makes no toss: then `false`.
///
/// # Errors
/// [`EngineError`] if the engine refuses its settings.
///
/// # Example
/// ```
/// use coinmc::run::{Begin, for_each_outcome, stream};
/// let plan = coinmc::config::parse(
///     "inline",
///     "coin.ratio = 1\nsurface = { restitution = 0.5, friction = 0.3 }\n\
///      launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 100",
///     &[],
/// ).unwrap();
/// let begin = stream(&plan, 0);
/// let mut most = 0;
/// for_each_outcome(&plan.points[0], Begin::Drawn(&begin), 0..100, |_, outcome| {
///     most = most.max(outcome.impacts);
///     true
/// })?;
/// assert!(most > 1);
/// # Ok::<(), coinmc::engines::EngineError>(())
/// ```
pub fn for_each_outcome(
    point: &Point,
    begin: Begin<'_>,
    tosses: Range<u64>,
    mut see: impl FnMut(u64, &Outcome) -> bool,
) -> Result<bool, EngineError> {
    let first = tosses.start;
    for_some_outcomes(point, begin, tosses, &mut |outcomes| {
        let mut outcomes = outcomes.iter();
        if outcomes.all(|(number, outcome)| see(first + number, outcome)) {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    })
}

/// [`for_each_outcome`], some outcomes at a time, with the numbers counted from 0.
pub(super) fn for_some_outcomes(
    point: &Point,
    begin: Begin<'_>,
    tosses: Range<u64>,
    sink: &mut OutcomeSink<'_>,
) -> Result<bool, EngineError> {
    let Some(engine) = point.build_engine()? else {
        return Ok(false);
    };
    match begin {
        Begin::Drawn(stream) => {
            let (coin, lanes) = (&point.scene.coin, engine.lanes());
            let launches = point.launches.launches(coin, stream, tosses, lanes);
            engine.toss_many(&mut (), launches.into(), sink);
        }
        Begin::Given(launch) => {
            engine.toss_many(&mut (), LaunchSource::new(&mut tosses.map(launch)), sink);
        }
    }
    Ok(true)
}

/// [`for_each_outcome`] with the coin as it was at the end, one toss after the other: an engine that
/// follows several at a time is a few times as fast without.
///
/// # Errors
/// Those of [`for_each_outcome`].
pub fn for_each_end(
    point: &Point,
    begin: Begin<'_>,
    tosses: Range<u64>,
    see: &mut dyn FnMut(&Seen) -> bool,
) -> Result<bool, EngineError> {
    let Some(engine) = point.build_engine()? else {
        return Ok(false);
    };
    for toss in tosses {
        let launch = begin.launch(point, toss);
        let mut last = Last::new(&launch);
        let outcome = engine.toss(&mut (), &launch, &mut last);
        let end = last.0;
        if !see(&Seen { toss, outcome, end }) {
            break;
        }
    }
    Ok(true)
}

/// Sees the end alone.
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
