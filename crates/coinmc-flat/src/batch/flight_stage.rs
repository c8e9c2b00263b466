//! The stage of flight: eight tosses in search of their next contact.

use crate::flight::{FlightSegment, LEAST_DEPARTURE, MAX_EVALUATIONS};
use crate::motion::Motion;
use crate::shape::{Shape, as_quadrant};
use coinmc_lanes::{Bits, Block, Lanes, Wide, Work};

/// Eight flights, lane by lane. The sets of lanes say what each does next; a lane in none of them
/// is free or in contact.
#[derive(Debug, Clone, Default)]
pub(super) struct FlightStage {
    pub(super) segment: FlightSegment<Block>,
    pub(super) vx: Block,
    /// Time since the start of the segment.
    pub(super) t: Block,
    /// Evaluations since the start of the flight.
    pub(super) evaluations: Block,
    /// Least step of a departing corner.
    pub(super) least: Block,
    /// Lanes that search for their contact, …
    pub(super) searching: Bits,
    /// … have found it, …
    pub(super) touching: Bits,
    /// … are high above the surface, …
    pub(super) high: Bits,
    /// … have run out of evaluations.
    pub(super) lost: Bits,
}

impl FlightStage {
    /// Puts a toss that begins a flight into a lane. `departing`: from the surface.
    pub(super) fn insert(&mut self, lane: usize, motion: &Motion, shape: &Shape, departing: bool) {
        let mut segment = FlightSegment::of(motion, shape);
        let (mut t, mut least, mut evaluations) = (0.0, LEAST_DEPARTURE, 0.0);
        let mut high = segment.z > 1.0;
        if departing && !high {
            let evaluation = segment.evaluate(t, true, &mut least);
            evaluations = 1.0;
            // a departing corner does not approach, so it does not touch
            high = evaluation.high;
            if !high {
                t = evaluation.next;
                if t >= segment.end {
                    segment = segment.cross(shape);
                    (t, least) = (0.0, LEAST_DEPARTURE);
                    high = segment.z > 1.0;
                }
            }
        }
        self.segment.set(lane, &segment);
        self.vx[lane] = motion.vx;
        (self.t[lane], self.least[lane]) = (t, least);
        self.evaluations[lane] = evaluations;
        let set = if high {
            &mut self.high
        } else {
            &mut self.searching
        };
        *set |= 1 << lane;
    }

    /// Whether any lane is in flight.
    pub(super) fn has_work(&self) -> bool {
        self.searching | self.touching | self.high | self.lost != 0
    }

    /// Takes a toss out of its flight.
    pub(super) fn remove(&mut self, lane: usize) {
        let others: Bits = !(1 << lane);
        self.searching &= others;
        self.high &= others;
    }

    /// The motion of a lane's coin, without the position and time that only observers need.
    pub(super) fn motion(&self, lane: usize) -> Motion {
        let segment = &self.segment;
        Motion {
            quadrant: as_quadrant(segment.quadrant[lane]),
            delta: segment.delta[lane],
            omega: segment.omega[lane],
            x: 0.0,
            z: segment.z[lane],
            vx: self.vx[lane],
            vz: segment.vz[lane],
            time: 0.0,
        }
    }

    /// One step of every search.
    pub(super) fn search(stages: &mut [Self], lanes: Lanes, shape: &Shape) {
        lanes.enter(Search { stages, shape });
    }

    /// Jumps to where the coins that are high above the surface come down.
    pub(super) fn skip(&mut self, lanes: Lanes, shape: &Shape) {
        lanes.enter(Skip { stage: self, shape });
    }

    /// Brings the coins that touch down to the surface.
    pub(super) fn land(&mut self, lanes: Lanes) {
        lanes.enter(Land { stage: self });
    }

    #[inline(always)]
    fn step<L: Wide>(&mut self, shape: &Shape) {
        let segment: FlightSegment<L> = self.segment.load();
        let (t, mut least) = (L::load(&self.t), L::load(&self.least));
        let evaluations = L::load(&self.evaluations);
        let lost = L::splat(f64::from(MAX_EVALUATIONS)).le(evaluations);
        let searching = L::mask(self.searching) & !lost;
        self.lost |= self.searching & L::bits(lost);
        let counted = L::select(searching, evaluations + L::splat(1.0), evaluations);
        self.evaluations = counted.store();
        let evaluation = segment.evaluate(t, L::mask(0), &mut least);
        let touching = searching & evaluation.touches;
        let high = searching & evaluation.high;
        let continuing = searching & !(touching | high);
        self.touching |= L::bits(touching);
        self.high |= L::bits(high);
        self.searching = L::bits(continuing);
        self.continue_search(shape, &segment, (t, evaluation.next, least), continuing);
    }

    /// Moves the search of the `continuing` lanes from `t` to `next`, across the end of the
    /// quadrant where that is reached.
    #[inline(always)]
    pub(super) fn continue_search<L: Wide>(
        &mut self,
        shape: &Shape,
        segment: &FlightSegment<L>,
        (t, next, least): (L, L, L),
        continuing: L::Mask,
    ) {
        let crossing_bits = L::bits(continuing & segment.end.le(next));
        if crossing_bits == 0 {
            self.t = L::select(continuing, next, t).store();
            self.least = least.store();
            return;
        }
        let crossing = L::mask(crossing_bits);
        let crossed = FlightSegment::select(crossing, &segment.cross(shape), segment);
        self.segment.store(&crossed);
        let t = L::select(continuing, next, t);
        self.t = L::select(crossing, L::splat(0.0), t).store();
        self.least = L::select(crossing, L::splat(LEAST_DEPARTURE), least).store();
        let high = crossing_bits & L::bits(L::splat(1.0).lt(crossed.z));
        self.high |= high;
        self.searching &= !high;
    }
}

struct Search<'a> {
    stages: &'a mut [FlightStage],
    shape: &'a Shape,
}

impl Work for Search<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        for stage in self.stages {
            if stage.searching != 0 {
                stage.step::<L>(self.shape);
            }
        }
    }
}

struct Skip<'a> {
    stage: &'a mut FlightStage,
    shape: &'a Shape,
}

impl Work for Skip<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let stage = self.stage;
        let high = L::mask(stage.high);
        let before: FlightSegment<L> = stage.segment.load();
        let mut segment = before;
        segment.advance(L::load(&stage.t));
        let skipped = segment.skip_high(self.shape, segment.high_time());
        let after = FlightSegment::select(high, &skipped, &before);
        stage.segment.store(&after);
        stage.t = L::select(high, L::splat(0.0), L::load(&stage.t)).store();
        let least = L::load(&stage.least);
        stage.least = L::select(high, L::splat(LEAST_DEPARTURE), least).store();
        stage.searching |= stage.high;
        stage.high = 0;
    }
}

struct Land<'a> {
    stage: &'a mut FlightStage,
}

impl Work for Land<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let stage = self.stage;
        let touching = L::mask(stage.touching);
        let before: FlightSegment<L> = stage.segment.load();
        let mut landed = before;
        landed.advance(L::load(&stage.t));
        let after = FlightSegment::select(touching, &landed, &before);
        stage.segment.store(&after);
        stage.touching = 0;
    }
}
