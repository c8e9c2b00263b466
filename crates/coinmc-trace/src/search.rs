//! Searching for tosses.

use crate::condition::Condition;
use crate::error::TraceError;
use crate::replay::{engine_of, max_tosses, point_of};
use coinmc::plan::Plan;
use coinmc::run::stream;
use coinmc_core::{
    DynEngine, Engine, Event, EventKind, LaunchDistribution, Observer, Outcome, Scene, Stream,
};

/// The measure of a toss's length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Length {
    /// Simulated time until its end.
    Time,
    /// Number of impacts.
    Impacts,
}

/// A query: the tosses to find, and where to search.
#[derive(Debug, Clone)]
pub struct Query<'a> {
    /// Points, in the order in which they are searched.
    pub points: &'a [usize],
    /// Conditions, all of which must hold.
    pub conditions: &'a [Condition],
    /// Find the longest tosses by this measure; `None` for the first ones.
    pub longest: Option<Length>,
    /// Number of tosses to find.
    pub count: usize,
    /// Greatest number of tosses to search.
    pub limit: u64,
}

/// A found toss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Its point.
    pub point: usize,
    /// Its number.
    pub toss: u64,
    /// How it ended.
    pub outcome: Outcome,
    /// Time of its end, s; known if the search is for the longest in time, NaN otherwise.
    pub time_s: f64,
}

/// Result of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Findings {
    /// The tosses: the first ones in order, or the longest ones, the longest first.
    pub found: Vec<Found>,
    /// Number of tosses searched.
    pub searched: u64,
    /// Whether the search ended early: not enough tosses were found, but not all were searched.
    pub is_cut: bool,
}

/// Searches a plan's tosses, point by point and in order: the same query finds the same tosses.
/// `go_on` is called before each toss with the number searched so far; the search ends if it
/// returns false.
///
/// # Errors
/// [`TraceError`] if a point does not exist or its engine is a closed form.
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
        let tosses = max_tosses(plan).min(query.limit - searched);
        is_cut |= tosses < max_tosses(plan);
        let search = PointSearch {
            scene: &found.scene,
            launches: &found.launches,
            stream: stream(plan, point),
            point,
            tosses,
            searched: &mut searched,
            best: &mut best,
            go_on: &mut go_on,
        };
        if !search.run(&engine_of(plan, point)?) {
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

/// The best tosses found so far.
struct Best<'q> {
    query: &'q Query<'q>,
    found: Vec<Found>,
}

impl Best<'_> {
    /// Whether no further toss can change the result.
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
            // after those of equal length, so that the first stays first
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

/// The search in one point.
struct PointSearch<'a, 'q, F> {
    scene: &'a Scene,
    launches: &'a LaunchDistribution,
    stream: Stream,
    point: usize,
    tosses: u64,
    searched: &'a mut u64,
    best: &'a mut Best<'q>,
    go_on: &'a mut F,
}

impl<F: FnMut(u64) -> bool> PointSearch<'_, '_, F> {
    fn run(self, engine: &DynEngine) -> bool {
        let by_time = self.best.query.longest == Some(Length::Time);
        for toss in 0..self.tosses {
            if !(self.go_on)(*self.searched) {
                return false;
            }
            let uniforms = &mut self.stream.toss(toss);
            let launch = self.launches.launch(&self.scene.coin, uniforms);
            let mut end_time = EndTime(f64::NAN);
            // observing a toss takes longer
            let outcome = if by_time {
                engine.toss(&mut (), &launch, &mut end_time)
            } else {
                engine.toss(&mut (), &launch, &mut ())
            };
            *self.searched += 1;
            self.best.add(Found {
                point: self.point,
                toss,
                outcome,
                time_s: end_time.0,
            });
            if self.best.is_full() {
                return true;
            }
        }
        true
    }
}

/// Observes the time of the end.
struct EndTime(f64);

impl Observer for EndTime {
    fn event(&mut self, event: &Event) {
        if event.kind == EventKind::Ended {
            self.0 = event.state.time_s;
        }
    }
}
