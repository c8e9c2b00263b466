//! Flights side by side on the search for their first contact.
//!
//! The search has two parts: steps that no root is passed by, of which a flight takes from one to
//! hundreds, and Newton's method in a bracket, a few steps each. The first is a step of a
//! [`Group`]; a flight that is done leaves, and another may take its lane. The second
//! ([`close_in`](Leavers::close_in)) follows where flights that have left are gathered.

use super::orbit::{Drag, Extent, Orbit};
use super::search::{MAX_EVALUATIONS, Search, least_time};
use crate::body::Body;
use crate::motion::{Motion, Spin};
use coinmc_lanes::{Bits, Block, Mask, Route, Wide};

/// Numbers of a flight on search beside its orbit and bounds: time, least, evaluations.
const SEARCH: usize = 3;
const ORBIT: usize = Orbit::<f64>::NUMBERS;
const EXTENT: usize = 3;
/// Of a motion: its own, and the axial spin.
pub(crate) const MOTION: usize = 10;

/// Whose lanes they are. Numbers of tosses travel as the bits of an `f64`, like all that a lane has:
/// no arithmetic is done with them.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
pub(crate) struct Owners([Block; 1]);

impl Owners {
    #[inline]
    pub(crate) fn of(&self, lane: usize) -> usize {
        // what `set` was given
        #[allow(clippy::cast_possible_truncation)]
        let owner = self.0[0][lane].to_bits() as usize;
        owner
    }

    #[inline]
    pub(crate) fn set(&mut self, lane: usize, owner: usize) {
        self.0[0][lane] = f64::from_bits(owner as u64);
    }

    #[inline(always)]
    fn follow<L: Wide>(&mut self, route: &Route, from: &Self) {
        L::follow(route, &from.0, &mut self.0);
    }
}

/// Flights about to begin.
#[derive(Debug, Clone, Default)]
#[repr(C, align(64))]
pub(crate) struct Departing {
    pub(crate) motion: [Block; MOTION],
    pub(crate) owners: Owners,
    pub(crate) launched: Bits,
    pub(crate) parting: Bits,
}

impl Departing {
    /// Takes over a coin.
    #[inline]
    pub(crate) fn put(
        &mut self,
        lane: usize,
        owner: usize,
        motion: &Motion<f64>,
        spin: &Spin<f64>,
    ) {
        let [blocks @ .., axial] = &mut self.motion;
        for (block, number) in blocks.iter_mut().zip(motion.numbers()) {
            block[lane] = number;
        }
        axial[lane] = spin.axial;
        self.owners.set(lane, owner);
    }

    /// The motions and their axial spins.
    #[inline(always)]
    pub(crate) fn load<L: Wide>(&self) -> (Motion<L>, L) {
        split(&load::<L, MOTION>(&self.motion))
    }
}

/// Flights on search, one a lane.
#[derive(Debug, Clone, Default)]
#[repr(C, align(64))]
pub(super) struct Group {
    orbit: [Block; ORBIT],
    extent: [Block; EXTENT],
    search: [Block; SEARCH],
    /// The bracket of a flight that has left.
    bracket: [Block; 2],
    /// The motion with which the flight began.
    motion: [Block; MOTION],
    owners: Owners,
    departs: Bits,
    launched: Bits,
    /// On search.
    active: Bits,
    /// Of those that have left: the root is yet to be found in the bracket; the search was given up.
    bracketed: Bits,
    lost: Bits,
    /// Those that have left with the last step.
    pub(super) left: Bits,
}

/// Flights at the end of their search.
#[derive(Debug, Clone, Default)]
#[repr(C, align(64))]
pub(crate) struct Leavers {
    orbit: [Block; ORBIT],
    search: [Block; SEARCH],
    bracket: [Block; 2],
    motion: [Block; MOTION],
    pub(crate) owners: Owners,
    bracketed: Bits,
    lost: Bits,
}

/// The columns of a block each, in registers.
#[inline(always)]
pub(crate) fn load<L: Wide, const N: usize>(blocks: &[Block; N]) -> [L; N] {
    let mut lanes = [L::splat(0.0); N];
    for (lanes, block) in lanes.iter_mut().zip(blocks) {
        *lanes = L::load(block);
    }
    lanes
}

/// And back.
#[inline(always)]
pub(crate) fn store<L: Wide, const N: usize>(blocks: &mut [Block; N], from: &[L; N]) {
    for (block, lanes) in blocks.iter_mut().zip(from) {
        *block = lanes.store();
    }
}

/// A motion and its axial spin.
#[inline(always)]
fn split<L: Wide>(numbers: &[L; MOTION]) -> (Motion<L>, L) {
    let [sin, cos, ox, oy, oz, vx, vy, vz, z, axial] = *numbers;
    (Motion::of(&[sin, cos, ox, oy, oz, vx, vy, vz, z]), axial)
}

impl Group {
    /// All of a group sets out: its flights are ready for their search, and have taken the first step
    /// of it where that does not end it.
    #[inline(always)]
    pub(super) fn set_out<L: Wide>(&mut self, begin: &Departing, body: &Body, drag: Drag) {
        let (motion, _) = begin.load::<L>();
        let mut orbit = Orbit::new(&motion, drag);
        let least = least_time(&orbit, &motion, L::mask(begin.parting));
        let extent = orbit.extent(body);
        let begins = Search::new(&mut orbit, &extent, L::mask(begin.launched), least);
        let mut search = begins;
        let gap = orbit.first_gap(body);
        search.approach(&orbit, body, &orbit.bounds(&extent), &gap);
        // what ends here, or is bracketed, is done again by the next step, which sees to its end
        let goes_on = search.active & !search.bracketed;
        let numbers = [
            L::select(goes_on, search.time, begins.time),
            L::select(goes_on, search.least, begins.least),
            L::select(goes_on, L::splat(1.0), L::splat(0.0)),
        ];
        store(&mut self.orbit, &orbit.numbers());
        store(&mut self.extent, &extent.numbers());
        store(&mut self.search, &numbers);
        self.departs = L::bits(begins.departs);
        self.launched = begin.launched;
    }

    /// Takes over flights of a group that has set out with `begin`.
    #[inline(always)]
    pub(super) fn take<L: Wide>(&mut self, from: &Self, begin: &Departing, route: &Route) {
        L::follow(route, &from.orbit, &mut self.orbit);
        L::follow(route, &from.extent, &mut self.extent);
        L::follow(route, &from.search, &mut self.search);
        L::follow(route, &begin.motion, &mut self.motion);
        self.owners.follow::<L>(route, &begin.owners);
        self.departs = L::follow_bits(route, from.departs, self.departs);
        self.launched = L::follow_bits(route, from.launched, self.launched);
        let taken = route.to();
        self.active |= taken;
        self.bracketed &= !taken;
        self.lost &= !taken;
    }

    /// Hands over flights that have left.
    #[inline(always)]
    pub(super) fn hand_over<L: Wide>(&self, to: &mut Leavers, route: &Route) {
        L::follow(route, &self.orbit, &mut to.orbit);
        L::follow(route, &self.search, &mut to.search);
        L::follow(route, &self.bracket, &mut to.bracket);
        L::follow(route, &self.motion, &mut to.motion);
        to.owners.follow::<L>(route, &self.owners);
        to.bracketed = L::follow_bits(route, self.bracketed, to.bracketed);
        to.lost = L::follow_bits(route, self.lost, to.lost);
    }

    /// Whether any flight is on search.
    pub(super) fn is_active(&self) -> bool {
        self.active != 0
    }

    /// One step of every flight.
    #[inline(always)]
    pub(super) fn step<L: Wide>(&mut self, body: &Body, drag: Drag) {
        let group = self;
        let orbit = Orbit::of(&load::<L, ORBIT>(&group.orbit), drag);
        let bounds = orbit.bounds(&Extent::of(&load::<L, EXTENT>(&group.extent)));
        let [time, least, before] = load::<L, SEARCH>(&group.search);
        let mut search = Search {
            time,
            low: L::splat(0.0),
            high: L::splat(0.0),
            bracketed: L::Mask::splat(false),
            active: L::mask(group.active),
            least,
            departs: L::mask(group.departs),
            launched: L::mask(group.launched),
        };
        let gap = orbit.gap(body, time);
        search.approach(&orbit, body, &bounds, &gap);
        search.close_in(&orbit, &gap);
        let evaluations = before + L::splat(1.0);
        let out = L::splat(f64::from(MAX_EVALUATIONS)).le(evaluations);
        let lost = search.active & out;
        // lanes that are free, or wait to be gathered, keep what they have
        let was_active = L::mask(group.active);
        let numbers = [
            L::select(was_active, search.time, time),
            L::select(was_active, search.least, least),
            L::select(was_active, evaluations, before),
        ];
        store(&mut group.search, &numbers);
        let [low, high] = load::<L, 2>(&group.bracket);
        let bracket = [
            L::select(was_active, search.low, low),
            L::select(was_active, search.high, high),
        ];
        store(&mut group.bracket, &bracket);
        let bracketed = search.bracketed & search.active & !out;
        let (was, bracketed) = (group.active, L::bits(bracketed));
        let lost = L::bits(lost) & was;
        group.bracketed = (group.bracketed & !was) | (bracketed & was);
        group.lost = (group.lost & !was) | lost;
        group.active = was & L::bits(search.active) & !bracketed & !lost;
        group.left = was & !group.active;
    }
}

impl Leavers {
    /// Ends the search of each: its time, and whether it is lost.
    #[inline(always)]
    pub(crate) fn close_in<L: Wide>(&self, orbit: &Orbit<L>, body: &Body) -> (L, L::Mask) {
        let [low, high] = load::<L, 2>(&self.bracket);
        let [time, _, mut evaluations] = load::<L, SEARCH>(&self.search);
        let bracketed = L::mask(self.bracketed);
        let mut search = Search {
            time,
            low,
            high,
            bracketed,
            active: bracketed,
            least: L::splat(0.0),
            departs: L::Mask::splat(false),
            launched: L::Mask::splat(false),
        };
        let most = L::splat(f64::from(MAX_EVALUATIONS));
        let mut lost = L::mask(self.lost);
        while search.active.any() {
            let gap = orbit.gap(body, search.time);
            search.touch(&gap);
            search.close_in(orbit, &gap);
            evaluations += L::splat(1.0);
            let out = search.active & most.le(evaluations);
            lost = lost | out;
            search.active = search.active & !out;
        }
        (search.time, lost)
    }

    /// The motion with which a flight began.
    pub(crate) fn start(&self, lane: usize) -> Motion<f64> {
        let [motion @ .., _] = &self.motion;
        Motion::of(&motion.map(|block| block[lane]))
    }

    /// The motions with which the flights began, and their axial spins.
    #[inline(always)]
    pub(crate) fn motion<L: Wide>(&self) -> (Motion<L>, L) {
        split(&load::<L, MOTION>(&self.motion))
    }

    /// The flights.
    #[inline(always)]
    pub(crate) fn orbit<L: Wide>(&self, drag: Drag) -> Orbit<L> {
        Orbit::of(&load::<L, ORBIT>(&self.orbit), drag)
    }
}
