//! Tosses of a point one by one, for who wants each of them and not their counts.

use super::{SettingsError, Task, with_engine};
use crate::plan::Point;
use coinmc_core::{Engine, Event, EventKind, Launch, Observer, Outcome, State, Stream};
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
/// [`SettingsError`] if the engine refuses its settings.
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
/// # Ok::<(), coinmc::run::SettingsError>(())
/// ```
pub fn for_each_outcome(
    point: &Point,
    begin: Begin<'_>,
    tosses: Range<u64>,
    see: impl FnMut(u64, &Outcome) -> bool,
) -> Result<bool, SettingsError> {
    let follow = Follow {
        point,
        begin,
        tosses,
        see,
    };
    Ok(with_engine(point, follow)?.is_some())
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
) -> Result<bool, SettingsError> {
    let watch = Watch {
        point,
        begin,
        tosses,
        see,
    };
    Ok(with_engine(point, watch)?.is_some())
}

struct Follow<'a, F> {
    point: &'a Point,
    begin: Begin<'a>,
    tosses: Range<u64>,
    see: F,
}

impl<F: FnMut(u64, &Outcome) -> bool> Task for Follow<'_, F> {
    type Output = ();

    fn with<E: Engine>(self, engine: &E) {
        let Self {
            point,
            begin,
            tosses,
            mut see,
        } = self;
        let first = tosses.start;
        let see = |number, outcome: &Outcome| {
            if see(first + number, outcome) {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        let workspace = &mut engine.workspace();
        match begin {
            Begin::Drawn(stream) => {
                let (coin, lanes) = (&point.scene.coin, engine.lanes());
                let launches = point.launches.launches(coin, stream, tosses, lanes);
                engine.toss_all(workspace, launches, see);
            }
            Begin::Given(launch) => engine.toss_all(workspace, tosses.map(launch), see),
        }
    }
}

struct Watch<'a> {
    point: &'a Point,
    begin: Begin<'a>,
    tosses: Range<u64>,
    see: &'a mut dyn FnMut(&Seen) -> bool,
}

impl Task for Watch<'_> {
    type Output = ();

    fn with<E: Engine>(self, engine: &E) {
        let mut workspace = engine.workspace();
        for toss in self.tosses {
            let launch = self.begin.launch(self.point, toss);
            let mut last = Last::new(&launch);
            let outcome = engine.toss(&mut workspace, &launch, &mut last);
            let end = last.0;
            if !(self.see)(&Seen { toss, outcome, end }) {
                return;
            }
        }
    }
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
