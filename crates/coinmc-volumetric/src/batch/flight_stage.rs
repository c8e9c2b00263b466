//! Eight flights on the search for their first contact.
//!
//! The search has two parts: safe steps that pass no root, of which a flight takes one to hundreds,
//! and then Newton's method in a bracket, which takes a few steps. A [`FlightStage`] takes the safe
//! steps. A flight that is done leaves its lane to another one. The second part runs once several
//! flights have been collected (see [`Arrivals::close_in`]).

use super::arrivals::Arrivals;
use super::columns::{ORBIT, SEARCH, START, SlotNumbers, load, store};
use super::departures::Departures;
use crate::body::Body;
use crate::drag::Drag;
use crate::flight::{Extent, MAX_EVALUATIONS, Orbit, Search, least_time};
use coinmc_lanes::{Bits, Block, Mask, Route, Wide};

/// Columns of an extent.
const EXTENT: usize = Extent::<f64>::COLUMNS;

/// One flight in each lane.
#[derive(Debug, Clone, Default)]
#[repr(C, align(64))]
pub(super) struct FlightStage {
    orbit: [Block; ORBIT],
    extent: [Block; EXTENT],
    search: [Block; SEARCH],
    /// The bracket of a flight whose safe steps are over.
    bracket: [Block; 2],
    /// The motion with which the flight began.
    start: [Block; START],
    slots: SlotNumbers,
    /// The search begins at the start of the flight.
    departs: Bits,
    launched: Bits,
    /// Lanes on search.
    active: Bits,
    /// Lanes whose safe steps are over: with the root in the bracket, or with the search given up.
    bracketed: Bits,
    gave_up: Bits,
    /// Lanes whose safe steps ended in the last step.
    pub(super) finished: Bits,
}

impl FlightStage {
    /// Prepares the search of eight new flights, and takes its first step where that does not end
    /// it.
    #[inline(always)]
    pub(super) fn begin<L: Wide>(&mut self, departures: &Departures, body: &Body, drag: Drag) {
        let (motion, _) = departures.load::<L>();
        let mut orbit = Orbit::new(&motion, drag);
        let least = least_time(&orbit, &motion, L::mask(departures.lifts_off));
        let extent = orbit.extent(body);
        let first = Search::new(&mut orbit, &extent, L::mask(departures.launched), least);
        let mut search = first;
        let gap = orbit.first_gap(body);
        search.approach(&orbit, body, &orbit.bounds(&extent), &gap);
        // a search that ends here or finds its bracket is repeated by the next step, which handles
        // both cases
        let goes_on = search.active & !search.bracketed;
        let columns = [
            L::select(goes_on, search.time, first.time),
            L::select(goes_on, search.least, first.least),
            L::select(goes_on, L::splat(1.0), L::splat(0.0)),
        ];
        store(&mut self.orbit, &orbit.state.columns());
        store(&mut self.extent, &extent.columns());
        store(&mut self.search, &columns);
        self.departs = L::bits(first.departs);
        self.launched = departures.launched;
    }

    /// Takes over flights from a stage that has begun with `departures`.
    #[inline(always)]
    pub(super) fn take<L: Wide>(&mut self, from: &Self, departures: &Departures, route: &Route) {
        L::follow(route, &from.orbit, &mut self.orbit);
        L::follow(route, &from.extent, &mut self.extent);
        L::follow(route, &from.search, &mut self.search);
        L::follow(route, &departures.start, &mut self.start);
        self.slots.follow::<L>(route, &departures.slots);
        self.departs = L::follow_bits(route, from.departs, self.departs);
        self.launched = L::follow_bits(route, from.launched, self.launched);
        let taken = route.to();
        self.active |= taken;
        self.bracketed &= !taken;
        self.gave_up &= !taken;
    }

    /// Hands over flights whose safe steps are over.
    #[inline(always)]
    pub(super) fn hand_over<L: Wide>(&self, to: &mut Arrivals, route: &Route) {
        L::follow(route, &self.orbit, &mut to.orbit);
        L::follow(route, &self.search, &mut to.search);
        L::follow(route, &self.bracket, &mut to.bracket);
        L::follow(route, &self.start, &mut to.start);
        to.slots.follow::<L>(route, &self.slots);
        to.bracketed = L::follow_bits(route, self.bracketed, to.bracketed);
        to.gave_up = L::follow_bits(route, self.gave_up, to.gave_up);
    }

    /// Whether any flight is on search.
    pub(super) fn is_active(&self) -> bool {
        self.active != 0
    }

    /// One step of every flight.
    #[inline(always)]
    pub(super) fn step<L: Wide>(&mut self, body: &Body, drag: Drag) {
        let orbit = Orbit::resumed(&load::<L, ORBIT>(&self.orbit), drag);
        let bounds = orbit.bounds(&Extent::from_columns(&load::<L, EXTENT>(&self.extent)));
        let [time, least, before] = load::<L, SEARCH>(&self.search);
        let mut search = Search {
            time,
            low: L::splat(0.0),
            high: L::splat(0.0),
            bracketed: L::Mask::splat(false),
            active: L::mask(self.active),
            least,
            departs: L::mask(self.departs),
            launched: L::mask(self.launched),
        };
        let gap = orbit.gap(body, time);
        search.approach(&orbit, body, &bounds, &gap);
        search.close_in(&orbit, &gap);
        let evaluations = before + L::splat(1.0);
        let over_limit = L::splat(f64::from(MAX_EVALUATIONS)).le(evaluations);
        self.keep(&search, evaluations, over_limit);
    }

    /// Stores what a step found. Lanes that are free, or wait to be collected, keep what they have.
    #[inline(always)]
    fn keep<L: Wide>(&mut self, search: &Search<L>, evaluations: L, over_limit: L::Mask) {
        let was_active = L::mask(self.active);
        let [time, least, before] = load::<L, SEARCH>(&self.search);
        let columns = [
            L::select(was_active, search.time, time),
            L::select(was_active, search.least, least),
            L::select(was_active, evaluations, before),
        ];
        store(&mut self.search, &columns);
        let [low, high] = load::<L, 2>(&self.bracket);
        let bracket = [
            L::select(was_active, search.low, low),
            L::select(was_active, search.high, high),
        ];
        store(&mut self.bracket, &bracket);
        let was = self.active;
        let bracketed = L::bits(search.bracketed & search.active & !over_limit);
        let gave_up = L::bits(search.active & over_limit) & was;
        self.bracketed = (self.bracketed & !was) | (bracketed & was);
        self.gave_up = (self.gave_up & !was) | gave_up;
        self.active = was & L::bits(search.active) & !bracketed & !gave_up;
        self.finished = was & !self.active;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_lanes::{Lanes, Work};

    /// Stores a step in which every search still runs, has its bracket in the lanes of `bracketed`,
    /// and has taken too many evaluations in those of `over_limit`. `at` marks what the step found.
    struct Keep<'a> {
        stage: &'a mut FlightStage,
        bracketed: Bits,
        over_limit: Bits,
        at: f64,
    }

    impl Work for Keep<'_> {
        type Output = ();

        #[inline(always)]
        fn run<L: Wide>(self) {
            let search = Search {
                time: L::splat(self.at),
                low: L::splat(self.at),
                high: L::splat(self.at),
                bracketed: L::mask(self.bracketed),
                active: L::Mask::splat(true),
                least: L::splat(0.0),
                departs: L::Mask::splat(false),
                launched: L::Mask::splat(false),
            };
            let over_limit = L::mask(self.over_limit);
            self.stage.keep(&search, L::splat(1.0), over_limit);
        }
    }

    /// How a search ended, and where, stays in its lane until it is collected, whatever the other
    /// lanes do meanwhile. Only the step that ended it says that it is finished.
    #[test]
    fn flights_that_wait_keep_how_their_search_ended() {
        for lanes in Lanes::wide() {
            let mut stage = FlightStage {
                active: 0b0111,
                ..FlightStage::default()
            };
            let steps = [
                (0b1000, 0b0001, 0b0001, 0b0110),
                (0b1010, 0b1000, 0b0010, 0b0100),
                (0b0000, 0b1111, 0b0100, 0b0000),
            ];
            for ((bracketed, over_limit, finished, active), at) in
                steps.into_iter().zip([1., 2., 3.])
            {
                let stage = &mut stage;
                lanes.enter(Keep {
                    stage,
                    bracketed,
                    over_limit,
                    at,
                });
                assert_eq!(
                    (stage.finished, stage.active),
                    (finished, active),
                    "{lanes}: step {at}"
                );
            }
            assert_eq!(
                (stage.gave_up, stage.bracketed),
                (0b0101, 0b0010),
                "{lanes}"
            );
            for found in [stage.search[0], stage.bracket[0], stage.bracket[1]] {
                assert_eq!(found[..4], [1.0, 2.0, 3.0, 0.0], "{lanes}");
            }
        }
    }
}
