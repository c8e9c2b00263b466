//! Tosses found by how they went.

use crate::condition::Condition;
use crate::error::TraceError;
use crate::replay::{engine_of, point_of, tosses_at_most};
use coinmc::plan::Plan;
use coinmc::run::stream;
use coinmc_core::{
    DynEngine, Engine, Event, EventKind, LaunchDistribution, Observer, Outcome, Scene, Stream,
};

/// What makes a toss long.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Length {
    /// Simulated time until its end.
    Time,
    /// Impacts.
    Impacts,
}

/// What is looked for, and where.
#[derive(Debug, Clone)]
pub struct Query<'a> {
    /// Points, in the order in which they are searched.
    pub points: &'a [usize],
    /// All of these must hold.
    pub conditions: &'a [Condition],
    /// The longest of all; `None` for the first.
    pub longest: Option<Length>,
    /// How many tosses are wanted.
    pub count: usize,
    /// Tosses looked at, at most.
    pub limit: u64,
}

/// A toss found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Its point.
    pub point: usize,
    /// Its number.
    pub toss: u64,
    /// How it ended.
    pub outcome: Outcome,
    /// When, s; known if the longest in time were looked for.
    pub time_s: f64,
}

/// What a search came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Findings {
    /// The tosses: the first in order, or the longest, the longest first.
    pub found: Vec<Found>,
    /// Tosses looked at.
    pub searched: u64,
    /// Whether it was ended before all that was asked for was found, and tosses are left.
    pub is_cut: bool,
}

/// Searches a plan's tosses, point by point and in order: the same query finds the same tosses.
/// `go_on` is told before each how many tosses have been looked at, and says whether to go on.
///
/// # Errors
/// [`TraceError`] if a point is not there or makes no tosses.
pub fn search(
    plan: &Plan,
    query: &Query<'_>,
    mut go_on: impl FnMut(u64) -> bool,
) -> Result<Findings, TraceError> {
    let mut best = Best {
        query,
        found: Vec::new(),
    };
    let (mut searched, mut is_cut) = (0, false);
    for &point in query.points {
        let found = point_of(plan, point)?;
        let tosses = tosses_at_most(plan).min(query.limit - searched);
        is_cut |= tosses < tosses_at_most(plan);
        let look = Look {
            scene: &found.scene,
            launches: &found.launches,
            stream: stream(plan, point),
            point,
            tosses,
            searched: &mut searched,
            best: &mut best,
            go_on: &mut go_on,
        };
        if !look.search(&engine_of(plan, point)?) {
            is_cut = true;
            break;
        }
        if best.is_full() {
            break;
        }
    }
    let is_cut = is_cut && !best.is_full();
    Ok(Findings {
        found: best.found,
        searched,
        is_cut,
    })
}

/// What has been found so far.
struct Best<'q> {
    query: &'q Query<'q>,
    found: Vec<Found>,
}

impl Best<'_> {
    /// No toss to come can change it.
    fn is_full(&self) -> bool {
        self.query.longest.is_none() && self.found.len() >= self.query.count
    }

    fn add(&mut self, toss: Found) {
        let holds = |condition: &Condition| condition.holds(&toss.outcome);
        if !self.query.conditions.iter().all(holds) {
            return;
        }
        let place = match self.query.longest {
            None => self.found.len(),
            // behind those that are as long, so that the first stays first
            Some(length) => {
                let long = |found: &Found| key(found, length) >= key(&toss, length);
                self.found.partition_point(long)
            }
        };
        if place < self.query.count {
            self.found.insert(place, toss);
            self.found.truncate(self.query.count);
        }
    }
}

fn key(found: &Found, length: Length) -> f64 {
    match length {
        Length::Time => found.time_s,
        Length::Impacts => f64::from(found.outcome.impacts),
    }
}

/// Looks at the tosses of a point; whether it may go on with the next.
struct Look<'a, 'q, F> {
    scene: &'a Scene,
    launches: &'a LaunchDistribution,
    stream: Stream,
    point: usize,
    tosses: u64,
    searched: &'a mut u64,
    best: &'a mut Best<'q>,
    go_on: &'a mut F,
}

impl<F: FnMut(u64) -> bool> Look<'_, '_, F> {
    fn search(self, engine: &DynEngine) -> bool {
        let by_time = self.best.query.longest == Some(Length::Time);
        for toss in 0..self.tosses {
            if !(self.go_on)(*self.searched) {
                return false;
            }
            let uniforms = &mut self.stream.toss(toss);
            let launch = self.launches.launch(&self.scene.coin, uniforms);
            let mut clock = Clock(f64::NAN);
            // a watched toss takes longer
            let outcome = if by_time {
                engine.toss(&mut (), &launch, &mut clock)
            } else {
                engine.toss(&mut (), &launch, &mut ())
            };
            *self.searched += 1;
            self.best.add(Found {
                point: self.point,
                toss,
                outcome,
                time_s: clock.0,
            });
            if self.best.is_full() {
                return true;
            }
        }
        true
    }
}

/// Looks at the end alone.
struct Clock(f64);

impl Observer for Clock {
    fn event(&mut self, event: &Event) {
        if event.kind == EventKind::Ended {
            self.0 = event.state.time_s;
        }
    }
}
