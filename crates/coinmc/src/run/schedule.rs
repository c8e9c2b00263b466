//! Which chunk comes next, and the sum of a point's chunks.

use super::chunk_result::{ChunkResult, whole};
use super::cut::Cut;
use super::{Chunk, Part, Progress};
use crate::plan::{Plan, Stop, Targets};
use crate::results::{estimates, integrated};
use coinmc_core::{Estimate, Face, IntervalMethod, Tally};
use coinmc_quadrature::Integral;
use std::collections::HashMap;

/// Results of chunks that an earlier run finished, by point and first toss.
pub(super) type Finished = HashMap<(usize, u64), ChunkResult>;

/// Hands out chunks and collects their results, in whatever order they arrive.
///
/// Points are opened in order, a stage at a time; the next stage of an open point comes before
/// the next point. Only the next stage of the same point waits for all chunks of a stage. Memory
/// holds one tally per point, not per chunk.
#[derive(Debug)]
pub(super) struct Schedule<'a> {
    plan: &'a Plan,
    cut: Cut,
    part: Part,
    finished: Finished,
    points: Vec<PointState>,
    /// The first point of which no chunk has been handed out.
    unopened: usize,
    /// Open points whose next stage can be handed out.
    ready: Vec<usize>,
    /// The stage whose chunks are being handed out.
    current: Option<Stage>,
    in_flight: u64,
    progress: Progress,
    /// The point with the widest interval so far.
    worst: Option<usize>,
}

#[derive(Debug, Clone, Default)]
pub(super) struct PointState {
    /// All tosses so far.
    pub(super) tally: Tally,
    /// The result of a point without tosses.
    pub(super) integral: Option<Integral>,
    /// The stop rule is met.
    pub(super) reached: bool,
    stage: usize,
    /// Chunks of the stage that are handed out and not yet complete.
    outstanding: u64,
    /// All chunks of the stage are handed out.
    handed_out: bool,
    half_width: f64,
    /// Tosses that the point is expected to need.
    forecast: u64,
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
    Chunk(Chunk),
    /// Wait until a chunk is complete: it decides what is next.
    Wait,
    /// Nothing: the run is complete.
    Done,
}

impl<'a> Schedule<'a> {
    /// The schedule of a part of a plan, given the chunks that an earlier run finished.
    pub(super) fn new(plan: &'a Plan, part: Part, finished: Finished) -> Self {
        let cut = Cut::new(plan);
        let forecast = if part == Part::WHOLE {
            cut.stage(0).end
        } else {
            // the other parts forecast their own share
            cut.stage(0).end / u64::from(part.of())
        };
        let tossed = plan.points_tossed();
        let points = (0..plan.points.len()).map(|index| PointState {
            // such a point adds nothing to the sum, so nothing may be subtracted for it later
            forecast: if plan.makes_tosses(index) {
                forecast
            } else {
                0
            },
            ..PointState::default()
        });
        let points = points.collect();
        let reused = finished
            .values()
            .map(ChunkResult::tosses)
            .fold(0, u64::saturating_add);
        let progress = Progress {
            points_done: 0,
            points: plan.points.len(),
            tosses_done: reused,
            tosses_planned: forecast.saturating_mul(tossed),
            tosses_reused: reused,
            reused_chunks: finished.len() as u64,
            worst_half_width: None,
        };
        Self {
            plan,
            cut,
            part,
            finished,
            points,
            unopened: 0,
            ready: Vec::new(),
            current: None,
            in_flight: 0,
            progress,
            worst: None,
        }
    }

    /// The next thing to do. Chunks that an earlier run finished are counted on the way.
    pub(super) fn next(&mut self) -> Next {
        loop {
            let Some(stage) = &mut self.current else {
                if self.open_stage() {
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
                self.points[point].handed_out = true;
                self.close_stage_if_complete(point);
                continue;
            };
            if self.part != Part::WHOLE && !self.part.owns(self.cut.number(&chunk)) {
                continue;
            }
            if self.take_finished(&chunk) {
                continue;
            }
            self.points[point].outstanding += 1;
            self.in_flight += 1;
            return Next::Chunk(chunk);
        }
    }

    /// Records the result of a chunk that [`next`](Self::next) handed out.
    pub(super) fn complete(&mut self, chunk: &Chunk, result: &ChunkResult) {
        let point = &mut self.points[chunk.point];
        match result {
            ChunkResult::Tossed(tally) => point.tally.merge(tally),
            ChunkResult::Integrated(integral) => point.integral = Some(*integral),
        }
        point.outstanding -= 1;
        self.in_flight -= 1;
        self.progress.tosses_done += result.tosses();
        self.update_worst(chunk.point);
        self.close_stage_if_complete(chunk.point);
    }

    /// How far the run is.
    pub(super) fn progress(&self) -> Progress {
        // a forecast may be out of date
        let tosses_planned = self.progress.tosses_planned.max(self.progress.tosses_done);
        Progress {
            tosses_planned,
            ..self.progress
        }
    }

    /// Whether the run is complete.
    pub(super) fn is_done(&self) -> bool {
        self.unopened == self.points.len()
            && self.ready.is_empty()
            && self.current.is_none()
            && self.in_flight == 0
    }

    /// The points as counted so far.
    pub(super) fn points(&self) -> &[PointState] {
        &self.points
    }

    /// Removes and returns the results of an earlier run that this one did not need.
    pub(super) fn take_unneeded(&mut self) -> Vec<(usize, u64)> {
        let unneeded = std::mem::take(&mut self.finished);
        for result in unneeded.values() {
            self.forget_reused(result);
        }
        unneeded.into_keys().collect()
    }

    fn forget_reused(&mut self, result: &ChunkResult) {
        self.progress.tosses_done -= result.tosses();
        self.progress.tosses_reused -= result.tosses();
        self.progress.reused_chunks -= 1;
    }

    fn open_stage(&mut self) -> bool {
        let point = match self.ready.pop() {
            Some(point) => point,
            None if self.unopened < self.points.len() => {
                self.unopened += 1;
                self.unopened - 1
            }
            None => return false,
        };
        if self.plan.integrates(point) {
            let chunks = Box::new(std::iter::once(whole(point)));
            self.current = Some(Stage { point, chunks });
        } else if self.plan.makes_tosses(point) {
            let chunks = Box::new(self.cut.chunks(point, self.points[point].stage));
            self.current = Some(Stage { point, chunks });
        } else {
            self.points[point].integral = self.plan.known(point);
            self.points[point].reached = true;
            self.progress.points_done += 1;
        }
        true
    }

    fn take_finished(&mut self, chunk: &Chunk) -> bool {
        let Some(result) = self.finished.remove(&(chunk.point, chunk.tosses.start)) else {
            return false;
        };
        let point = &mut self.points[chunk.point];
        match result {
            ChunkResult::Integrated(integral) => point.integral = Some(integral),
            ChunkResult::Tossed(tally) => {
                let Some(sum) = point.tally.checked_merge(&tally) else {
                    // only forged counts overflow: repeat the chunk
                    self.forget_reused(&result);
                    return false;
                };
                point.tally = sum;
            }
        }
        self.update_worst(chunk.point);
        true
    }

    fn close_stage_if_complete(&mut self, index: usize) {
        let point = &mut self.points[index];
        if !point.handed_out || point.outstanding > 0 {
            return;
        }
        point.handed_out = false;
        let last = self.plan.integrates(index) || point.stage + 1 == self.cut.stages();
        point.reached = match (self.plan.stop, &point.integral) {
            // a single part integrates a point
            (Stop::Tosses(_), Some(_)) => true,
            (Stop::Tosses(_), None) => self.part == Part::WHOLE,
            (Stop::Targets(targets), Some(integral)) => {
                // an integral shows no face
                let targets = Targets {
                    events: None,
                    ..targets
                };
                targets.are_met(&integrated(self.plan, integral))
            }
            (Stop::Targets(targets), None) => {
                targets.are_met(&estimates(self.plan, index, &point.tally))
            }
        };
        if point.reached || last {
            self.progress.points_done += 1;
            self.set_forecast(index, self.points[index].tally.tosses());
        } else {
            point.stage += 1;
            self.ready.push(index);
            self.forecast(index);
        }
    }

    /// Predicts which of the remaining looks will be the last, as intervals shrink like 1/√N.
    fn forecast(&mut self, index: usize) {
        let Stop::Targets(targets) = self.plan.stop else {
            return;
        };
        let point = &self.points[index];
        let excess = targets
            .excess(&quick_estimates(self.plan, &point.tally))
            .max(1.0);
        let needed = point.tally.tosses() as f64 * excess;
        let mut looks = (point.stage..self.cut.stages()).map(|stage| self.cut.stage(stage).end);
        let look = looks.clone().find(|&end| end as f64 >= needed);
        let forecast = look.or(looks.next_back()).unwrap_or(point.forecast);
        self.set_forecast(index, forecast);
    }

    fn set_forecast(&mut self, index: usize, forecast: u64) {
        let point = &mut self.points[index];
        let others = self.progress.tosses_planned.saturating_sub(point.forecast);
        self.progress.tosses_planned = others.saturating_add(forecast);
        point.forecast = forecast;
    }

    fn update_worst(&mut self, index: usize) {
        let half_width = match &self.points[index].integral {
            Some(integral) => integral.half_width(),
            None => quick_half_width(self.plan, &self.points[index].tally),
        };
        self.points[index].half_width = half_width;
        self.worst = match self.worst {
            Some(worst) if worst != index && self.points[worst].half_width >= half_width => {
                Some(worst)
            }
            // the widest interval has shrunk: another may now be the widest
            Some(worst) if worst == index => {
                let arm = |&i: &usize| self.points[i].half_width;
                (0..self.points.len()).max_by(|a, b| arm(a).total_cmp(&arm(b)))
            }
            _ => Some(index),
        };
        self.progress.worst_half_width = self.worst.map(|worst| self.points[worst].half_width);
    }
}

/// The estimates of the three faces by Wilson's formula: good enough to display and to forecast.
fn quick_estimates(plan: &Plan, tally: &Tally) -> [Estimate; 3] {
    let confidence = crate::results::look_confidence(plan);
    let (undecided, n) = (tally.undecided(), tally.tosses());
    let method = IntervalMethod::Wilson;
    Face::ALL.map(|face| Estimate::new(tally.count(face), undecided, n, confidence, method))
}

/// The widest arm of these.
fn quick_half_width(plan: &Plan, tally: &Tally) -> f64 {
    let arms = quick_estimates(plan, tally).map(|face| face.half_width());
    arms.into_iter().fold(0.0, f64::max)
}
