//! Which chunk comes next, and the sum of a point's chunks.

mod so_far;

use super::chunk_result::{ChunkResult, Tossed, whole};
use super::cut::Cut;
use super::finished::Finished;
use super::packed::{Counted, Packed};
use super::point_state::PointState;
use super::shares::{Left, Need, Shares, shares};
use super::states::States;
use super::{Chunk, Part, Progress};
use crate::plan::{Looks, Plan, Stop, StoppedBy, Targets, Verdict};
use crate::results::integrated;
use std::sync::Arc;

/// Hands out chunks and collects their results, in whatever order they arrive.
///
/// Points are opened in order, a stage at a time; the next stage of an open point comes before
/// the next point. Only the next stage of the same point waits for all chunks of a stage; where the tosses
/// of the whole run are limited, all points wait for each other after every stage that counts, as what is
/// left is shared among those that need more. Memory holds what is counted of each point, not of each chunk.
#[derive(Debug)]
pub(super) struct Schedule {
    plan: Arc<Plan>,
    cut: Cut,
    part: Part,
    finished: Finished,
    states: States,
    /// The first point of which no chunk has been handed out.
    unopened: usize,
    /// Open points whose next stage can be handed out.
    ready: Vec<usize>,
    /// Open points whose next stage waits for its share of the tosses of the whole run.
    waiting: Vec<usize>,
    /// The stage whose chunks are being handed out.
    current: Option<Stage>,
    in_flight: u64,
    progress: Progress,
    /// The point that was counted last.
    latest: Option<usize>,
    /// Tosses of all points, and their computing time in microseconds.
    made: u64,
    microseconds: u64,
    /// Points that are tossed.
    tossed: u64,
    /// Chunks of which a run that this one extends had all tosses.
    taken_over: Vec<(Chunk, Packed)>,
}

struct Stage {
    point: usize,
    chunks: Box<dyn Iterator<Item = Chunk> + Send>,
}

impl std::fmt::Debug for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Stage")
            .field("point", &self.point)
            .finish_non_exhaustive()
    }
}

/// What a worker does next.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// This chunk.
    Chunk(Job),
    /// Wait until a chunk is complete: it decides what is next.
    Wait,
    /// Nothing: the run is complete.
    Done,
}

/// A chunk to be computed.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Job {
    pub(super) chunk: Chunk,
    /// What an earlier run counted of it, from its first toss on.
    pub(super) begun: Option<Box<Tossed>>,
}

impl Schedule {
    /// The schedule of a part of a plan, given the chunks that an earlier run finished.
    pub(super) fn new(plan: &Arc<Plan>, part: Part, finished: Finished) -> Self {
        let cut = Cut::new(plan);
        let tossed = plan.points_tossed();
        let (looks, limited_by) = match plan.stop {
            Stop::Tosses(_) => (None, StoppedBy::Tosses),
            Stop::Targets(targets) => {
                let (looks, limited_by) = first_looks(plan, targets, tossed);
                (Some(looks), limited_by)
            }
        };
        // the other parts forecast their own share
        let forecast = match (&looks, plan.stop) {
            (None, Stop::Tosses(tosses)) => tosses / u64::from(part.of()),
            (Some(looks), _) => looks.stage().end,
            _ => 0,
        };
        let mut fresh = PointState::new(looks, limited_by);
        fresh.forecast = forecast;
        let reused = finished.tosses();
        let progress = Progress {
            points_done: 0,
            points: plan.points.len(),
            tosses_done: reused,
            tosses_planned: forecast.saturating_mul(tossed),
            tosses_reused: reused,
            reused_chunks: finished.left(),
            worst_half_width: None,
            latest: None,
        };
        Self {
            plan: Arc::clone(plan),
            cut,
            part,
            finished,
            states: States::new(plan.points.len(), fresh),
            unopened: 0,
            ready: Vec::new(),
            waiting: Vec::new(),
            current: None,
            in_flight: 0,
            progress,
            latest: None,
            made: 0,
            microseconds: 0,
            tossed,
            taken_over: Vec::new(),
        }
    }

    /// The next thing to do. Chunks that an earlier run finished are counted on the way.
    pub(super) fn next(&mut self) -> Next {
        loop {
            let Some(stage) = &mut self.current else {
                if self.open_stage() || self.share_out() {
                    continue;
                }
                return if self.in_flight == 0 {
                    Next::Done
                } else {
                    Next::Wait
                };
            };
            let point = stage.point;
            let Some(chunk) = stage.chunks.next() else {
                self.current = None;
                self.states.open(point).handed_out = true;
                self.close_stage_if_complete(point);
                continue;
            };
            if self.part != Part::WHOLE && !self.part.owns(self.cut.turn(&chunk)) {
                continue;
            }
            if self.take_finished(&chunk) {
                continue;
            }
            self.states.open(point).outstanding += 1;
            self.in_flight += 1;
            let begun = self.take_beginning(&chunk).map(Box::new);
            return Next::Chunk(Job { chunk, begun });
        }
    }

    /// Records the last of the results of a chunk that [`next`](Self::next) handed out.
    pub(super) fn complete(&mut self, chunk: &Chunk, result: &ChunkResult) {
        self.add(chunk.point, result);
        self.states.open(chunk.point).outstanding -= 1;
        self.in_flight -= 1;
        self.close_stage_if_complete(chunk.point);
    }

    /// Records a result of some of the tosses of a chunk that is handed out.
    pub(super) fn add(&mut self, point: usize, result: &ChunkResult) {
        assert!(self.count(point, result), "fewer than 2^64 tosses");
        self.progress.tosses_done = self.progress.tosses_done.saturating_add(result.tosses());
        self.seen(point);
    }

    /// Adds the result of a chunk to its point; false if a counter would overflow.
    fn count(&mut self, point: usize, result: &ChunkResult) -> bool {
        let state = self.states.open(point);
        match result {
            ChunkResult::Integrated(integral) => state.integral = Some(*integral),
            ChunkResult::Tossed(tossed) => {
                if !state.count(tossed) {
                    return false;
                }
                self.made = self.made.saturating_add(tossed.tally.tosses());
                self.microseconds = self.microseconds.saturating_add(tossed.microseconds);
            }
        }
        true
    }

    /// Whether the run is complete.
    pub(super) fn is_done(&self) -> bool {
        self.unopened == self.states.len()
            && self.ready.is_empty()
            && self.waiting.is_empty()
            && self.current.is_none()
            && self.in_flight == 0
    }

    /// What is counted of a point so far.
    pub(super) fn counted(&self, point: usize) -> Counted {
        self.states.counted(point)
    }

    /// Points.
    pub(super) fn points(&self) -> usize {
        self.states.len()
    }

    /// The states of all points, once nothing is to be scheduled any more.
    pub(super) fn into_states(self) -> States {
        self.states
    }

    fn open_stage(&mut self) -> bool {
        let point = match self.ready.pop() {
            Some(point) => point,
            None if self.unopened < self.states.len() => {
                self.unopened += 1;
                self.unopened - 1
            }
            None => return false,
        };
        if self.plan.integrates(point) {
            let chunks = Box::new(std::iter::once(whole(point)));
            self.current = Some(Stage { point, chunks });
        } else if self.plan.makes_tosses(point) {
            let stage = match (&self.states.open(point).looks, self.plan.stop) {
                (None, Stop::Tosses(tosses)) => 0..tosses,
                (Some(looks), _) => looks.stage(),
                (None, Stop::Targets(_)) => unreachable!("every such point has looks"),
            };
            let chunks = Box::new(self.cut.chunks(point, stage));
            self.current = Some(Stage { point, chunks });
        } else {
            let known = self.plan.known(point);
            self.states.open(point).integral = known;
            self.end(point, StoppedBy::ClosedForm);
        }
        true
    }

    /// Counts a chunk that an earlier run finished, if it did, and with as many tosses.
    fn take_finished(&mut self, chunk: &Chunk) -> bool {
        let Some(result) = self.finished.take(chunk.point, chunk.tosses.start) else {
            return self.take_over(chunk);
        };
        let is_whole = match &result {
            ChunkResult::Integrated(_) => true,
            ChunkResult::Tossed(_) => result.tosses() == chunk.tosses.end - chunk.tosses.start,
        };
        if !(is_whole && self.count(chunk.point, &result)) {
            // only forged counts are not whole or overflow: repeat the chunk
            self.forget_reused(&result);
            return false;
        }
        self.seen(chunk.point);
        true
    }

    /// Counts a chunk of which the run that this one extends has all tosses, if it has.
    fn take_over(&mut self, chunk: &Chunk) -> bool {
        let Some(tossed) = self.finished.take_over(chunk) else {
            return false;
        };
        let result = ChunkResult::Tossed(tossed);
        if !self.count(chunk.point, &result) {
            // only forged counts overflow: repeat the chunk
            return false;
        }
        self.taken_over.push((chunk.clone(), Packed::from(&result)));
        self.progress.tosses_done = self.progress.tosses_done.saturating_add(result.tosses());
        self.progress.tosses_reused = self.progress.tosses_reused.saturating_add(result.tosses());
        self.progress.reused_chunks += 1;
        self.seen(chunk.point);
        true
    }

    /// The chunks of which the run that this one extends had all tosses.
    pub(super) fn take_taken_over(&mut self) -> Vec<(Chunk, Packed)> {
        std::mem::take(&mut self.taken_over)
    }

    /// Counts what an earlier run has counted of a chunk.
    fn take_beginning(&mut self, chunk: &Chunk) -> Option<Tossed> {
        let begun = self.finished.take_beginning(chunk)?;
        let result = ChunkResult::Tossed(begun);
        if !self.count(chunk.point, &result) {
            // only forged counts overflow: repeat the chunk
            return None;
        }
        self.progress.tosses_done = self.progress.tosses_done.saturating_add(result.tosses());
        self.progress.tosses_reused = self.progress.tosses_reused.saturating_add(result.tosses());
        self.seen(chunk.point);
        Some(begun)
    }

    fn close_stage_if_complete(&mut self, index: usize) {
        let point = self.states.open(index);
        if !point.handed_out || point.outstanding > 0 {
            return;
        }
        point.handed_out = false;
        if let Some(integral) = &point.integral {
            let by = match self.plan.stop {
                Stop::Tosses(_) => StoppedBy::Tosses,
                Stop::Targets(targets) => {
                    // an integral shows no face
                    let targets = Targets {
                        events: None,
                        ..targets
                    };
                    if targets.are_met(&integrated(&self.plan, integral)) {
                        StoppedBy::Targets
                    } else {
                        StoppedBy::Evaluations
                    }
                }
            };
            self.end(index, by);
            return;
        }
        let of_whole = self.part == Part::WHOLE;
        let timed = self.targets().filter(Targets::is_timed);
        if let Some(targets) = timed {
            self.limit_pilot(index, &targets);
        }
        let verdict = self.states.open(index).look();
        let limited_by = self.states.open(index).stopped_short_by();
        match verdict {
            // the other parts have the other tosses
            None if of_whole => self.end(index, StoppedBy::Tosses),
            None => self.end(index, StoppedBy::Unfinished),
            Some(Verdict::Met) => self.end(index, StoppedBy::Targets),
            Some(Verdict::Short) => self.end(index, limited_by),
            Some(Verdict::More) => self.go_on(index),
        }
    }

    /// Hands out the next stage of a point, or lets it wait for its share.
    fn go_on(&mut self, index: usize) {
        let point = self.states.open(index);
        let counts = !point.is_in_pilot();
        let targets = match self.plan.stop {
            Stop::Targets(targets) if counts => targets,
            _ => {
                self.ready.push(index);
                return;
            }
        };
        point.limit_seconds(targets.max_core_seconds);
        let forecast = point.tosses() + point.next_tosses();
        if targets.total_tosses.is_some() || targets.total_core_seconds.is_some() {
            self.waiting.push(index);
        } else if point.next_tosses() == 0 {
            let by = point.limited_by;
            self.end(index, by);
            return;
        } else {
            self.ready.push(index);
        }
        self.set_forecast(index, forecast);
    }

    /// Lets a pilot be no more than a part of the time that the point may take.
    fn limit_pilot(&mut self, index: usize, targets: &Targets) {
        let points = self.tossed as f64;
        let of_run = targets.total_core_seconds.map(|total| total / points);
        let limits = [targets.max_core_seconds, of_run];
        let least = limits.into_iter().flatten().fold(f64::INFINITY, f64::min);
        self.states.open(index).limit_pilot(least);
    }

    fn end(&mut self, index: usize, by: StoppedBy) {
        let point = self.states.open(index);
        point.stopped_by = by;
        let tosses = point.tosses();
        self.progress.points_done += 1;
        if self.plan.makes_tosses(index) {
            self.set_forecast(index, tosses);
        }
        self.states.end(index);
    }

    /// What points are to reach, if they stop at targets.
    fn targets(&self) -> Option<Targets> {
        match self.plan.stop {
            Stop::Tosses(_) => None,
            Stop::Targets(targets) => Some(targets),
        }
    }

    /// Shares what the whole run may still spend among the points that need more, once all have been looked
    /// at. With all that they need their intervals shrink to the targets. If there is less, each gets the
    /// same part of its need, so that all intervals end as long in units of their targets, and the longest is
    /// as short as can be.
    fn share_out(&mut self) -> bool {
        let (Some(targets), 0, false) = (self.targets(), self.in_flight, self.waiting.is_empty())
        else {
            return false;
        };
        let mut waiting = std::mem::take(&mut self.waiting);
        // they came in the order in which threads were done
        waiting.sort_unstable();
        let left = self.left(&targets);
        let states = waiting.iter().map(|&point| self.states.opened(point));
        let needs: Vec<Need> = states
            .map(|point| Need {
                most: point.next_tosses(),
                wanted: point.wanted(),
                seconds: point.seconds_per_toss(),
            })
            .collect();
        let Shares { tosses, by } = shares(&needs, left);
        for (point, (need, share)) in waiting.into_iter().zip(needs.into_iter().zip(tosses)) {
            let state = self.states.open(point);
            if share < need.most
                && let Some(by) = by
            {
                state.limit(share, by);
            }
            let (by, forecast) = (state.limited_by, state.tosses() + share);
            if share == 0 {
                self.end(point, by);
            } else {
                self.set_forecast(point, forecast);
                self.ready.push(point);
            }
        }
        true
    }

    /// What the whole run may still spend.
    fn left(&self, targets: &Targets) -> Left {
        let (made, spent) = (self.made, 1e-6 * self.microseconds as f64);
        let left = |limit: Option<f64>, spent| limit.map_or(f64::INFINITY, |limit| limit - spent);
        Left {
            tosses: left(targets.total_tosses.map(|total| total as f64), made as f64),
            seconds: left(targets.total_core_seconds, spent),
        }
    }
}

/// The looks at a point before its first, and the rule that ends it without more tosses. Where the tosses
/// of the whole run are limited, no pilot may take more than a part of the point's equal share.
fn first_looks(plan: &Plan, targets: Targets, points: u64) -> (Looks, StoppedBy) {
    let each = targets.total_tosses.map(|total| total / points.max(1));
    match each {
        Some(each) if each < targets.max_tosses => {
            let looks = Looks::within(targets, plan.confidence, each);
            if looks.is_pilot() {
                (looks, StoppedBy::MaxTosses)
            } else {
                (looks, StoppedBy::TotalTosses)
            }
        }
        _ => (Looks::new(targets, plan.confidence), StoppedBy::MaxTosses),
    }
}

#[cfg(test)]
pub(super) mod tests;
