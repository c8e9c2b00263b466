//! All flights on the search for their first contact: eight stages of eight lanes. A lane whose
//! flight is done is given to the next flight.

use super::arrivals::Arrivals;
use super::departures::Departures;
use super::flight_stage::FlightStage;
use crate::body::Body;
use crate::drag::Drag;
use coinmc_lanes::{Bits, Lanes, Route, WIDTH, Wide, Work};

/// Room for half of the tosses in flight; the others are at other stages.
const STAGES: usize = 8;

/// One bit for each lane of each stage, the first stage lowest.
type LaneSet = u64;

/// All flights on search.
#[derive(Debug, Clone)]
pub(super) struct Flights {
    stages: [FlightStage; STAGES],
    /// New flights, until they are given their lanes.
    fresh: FlightStage,
    /// Free lanes.
    vacant: LaneSet,
    /// Lanes of flights whose safe steps are over.
    finished: LaneSet,
}

/// The first stage with a lane in the set, and its lanes in the set.
fn first_stage(set: LaneSet) -> (usize, Bits) {
    let stage = set.trailing_zeros() as usize / WIDTH % STAGES;
    (stage, set.to_le_bytes()[stage])
}

/// The set of some lanes of one stage.
fn lane_set(stage: usize, lanes: Bits) -> LaneSet {
    LaneSet::from(lanes) << (stage * WIDTH)
}

impl Flights {
    pub(super) fn none() -> Self {
        Self {
            stages: Default::default(),
            fresh: FlightStage::default(),
            vacant: LaneSet::MAX,
            finished: 0,
        }
    }

    /// How many lanes are free.
    pub(super) fn vacant(&self) -> usize {
        self.vacant.count_ones() as usize
    }

    /// How many flights wait to be collected.
    pub(super) fn finished(&self) -> usize {
        self.finished.count_ones() as usize
    }

    /// Whether any flight is on search.
    pub(super) fn any_on_search(&self) -> bool {
        self.vacant | self.finished != LaneSet::MAX
    }

    /// Puts the departures in the lanes of `flies` on search. There must be enough free lanes.
    pub(super) fn begin(
        &mut self,
        lanes: Lanes,
        body: &Body,
        drag: Drag,
        departures: &Departures,
        flies: Bits,
    ) {
        let flights = self;
        if drag.acts() {
            lanes.enter(Begin::<true> {
                flights,
                body,
                drag,
                departures,
                flies,
            });
        } else {
            lanes.enter(Begin::<false> {
                flights,
                body,
                drag,
                departures,
                flies,
            });
        }
    }

    /// One step of every flight.
    pub(super) fn step(&mut self, lanes: Lanes, body: &Body, drag: Drag) {
        let stages = &mut self.stages;
        if drag.acts() {
            lanes.enter(Step::<true> { stages, body, drag });
        } else {
            lanes.enter(Step::<false> { stages, body, drag });
        }
        for (i, stage) in self.stages.iter().enumerate() {
            self.finished |= lane_set(i, stage.finished);
        }
    }

    /// Gives new flights their lanes.
    #[inline(always)]
    fn assign_lanes<L: Wide>(&mut self, departures: &Departures, mut flies: Bits) {
        while flies != 0 && self.vacant != 0 {
            let (stage, vacant) = first_stage(self.vacant);
            let route = Route::between(flies, vacant);
            self.stages[stage].take::<L>(&self.fresh, departures, &route);
            flies &= !route.from();
            self.vacant &= !lane_set(stage, route.to());
        }
    }

    /// Collects up to eight flights whose safe steps are over (at least one), and returns how many.
    /// Unused lanes repeat the last one; their results are ignored.
    #[inline(always)]
    pub(super) fn collect<L: Wide>(&mut self, to: &mut Arrivals) -> usize {
        let mut free = Bits::MAX;
        while free != 0 && self.finished != 0 {
            let (stage, finished) = first_stage(self.finished);
            let route = Route::between(finished, free);
            self.stages[stage].hand_over::<L>(to, &route);
            free &= !route.to();
            let left = lane_set(stage, route.from());
            self.finished &= !left;
            self.vacant |= left;
            if self.finished == 0 {
                let last = Route::to_all(route.from(), free);
                self.stages[stage].hand_over::<L>(to, &last);
            }
        }
        free.count_zeros() as usize
    }
}

struct Begin<'a, const DRAGS: bool> {
    flights: &'a mut Flights,
    body: &'a Body,
    drag: Drag,
    departures: &'a Departures,
    flies: Bits,
}

impl<const DRAGS: bool> Work for Begin<'_, DRAGS> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let (flights, departures) = (self.flights, self.departures);
        let drag = self.drag.known::<DRAGS>();
        flights.fresh.begin::<L>(departures, self.body, drag);
        flights.assign_lanes::<L>(departures, self.flies);
    }
}

struct Step<'a, const DRAGS: bool> {
    stages: &'a mut [FlightStage],
    body: &'a Body,
    drag: Drag,
}

impl<const DRAGS: bool> Work for Step<'_, DRAGS> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        for stage in self.stages {
            stage.finished = 0;
            if stage.is_active() {
                stage.step::<L>(self.body, self.drag.known::<DRAGS>());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::Rigid;
    use nalgebra::Vector3;

    struct Collect<'a> {
        flights: &'a mut Flights,
        to: &'a mut Arrivals,
    }

    impl Work for Collect<'_> {
        type Output = usize;

        #[inline(always)]
        fn run<L: Wide>(self) -> usize {
            self.flights.collect::<L>(self.to)
        }
    }

    /// Eleven flights at a height, of slots 10 to 17 and three of them again.
    fn eleven(lanes: Lanes, body: &Body) -> Flights {
        let none = Drag {
            linear: 0.0,
            angular: 0.0,
        };
        let coin = Rigid::new(
            body,
            0.4,
            Vector3::new(0.3, -0.7, 2.0),
            Vector3::new(1.7, -2.3, 0.9),
        );
        let (motion, spin) = coin.folded(1.3, 9.0);
        let mut departures = Departures::default();
        for lane in 0..WIDTH {
            departures.put(lane, 10 + lane, &motion, &spin);
        }
        let mut flights = Flights::none();
        assert_eq!((flights.vacant(), flights.any_on_search()), (64, false));
        flights.begin(lanes, body, none, &departures, Bits::MAX);
        flights.begin(lanes, body, none, &departures, 0b1000_0110);
        flights
    }

    /// Finished flights are collected in the order of their lanes, which they leave. Lanes without a flight repeat a
    /// flight that has been collected.
    #[test]
    fn finished_flights_are_collected_and_leave_their_lanes() {
        let body = Rigid::generic_body(0.0);
        for lanes in Lanes::wide() {
            for (finished, slots) in [
                (0b0000_0001_0010, vec![11, 14]),
                (0b0101_0000_1000, vec![13, 11, 17]),
                (0b0001_1111_1111, vec![10, 11, 12, 13, 14, 15, 16, 17]),
            ] {
                let mut flights = eleven(lanes, &body);
                assert_eq!((flights.vacant(), flights.finished()), (53, 0), "{lanes}");
                flights.finished = finished;
                let mut arrivals = Arrivals::default();
                let (to, count) = (&mut arrivals, slots.len());
                let flights = &mut flights;
                assert_eq!(lanes.enter(Collect { flights, to }), count, "{lanes}");
                for lane in 0..WIDTH {
                    let slot = arrivals.slots.get(lane);
                    let expected = slots.get(lane);
                    assert!(expected.map_or(slots.contains(&slot), |expected| slot == *expected));
                }
                assert_eq!(flights.vacant(), 53 + count, "{lanes}");
                let left = usize::from(finished == 0b0001_1111_1111);
                assert_eq!(flights.finished(), left, "{lanes}");
            }
        }
    }
}
