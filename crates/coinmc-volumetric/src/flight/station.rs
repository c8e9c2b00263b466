//! Flights side by side on the search for their first contact.
//!
//! The search has two parts: steps that no root is passed by, of which a flight takes from one to
//! hundreds, and Newton's method in a bracket, a few steps each. The first is done here, step by
//! step for all flights there are; a flight that is done leaves, and another may take its lane. The
//! second ([`close_in`]) follows where flights that have left are gathered.

use super::orbit::{Drag, Extent, Orbit};
use super::search::{MAX_EVALUATIONS, Search};
use crate::body::Body;
use crate::motion::Motion;
use coinmc_lanes::{Bits, Block, WIDTH, Wide, Work};
use coinmc_lanes::{Lanes, Mask};

/// Numbers of a flight on search beside its orbit and bounds: time, least, evaluations.
const SEARCH: usize = 3;
const ORBIT: usize = Orbit::<f64>::NUMBERS;
const EXTENT: usize = 3;
/// Of a motion: its own, and the axial spin.
pub(crate) const MOTION: usize = 10;

/// Flights on search, one a lane.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct Group {
    orbit: [Block; ORBIT],
    extent: [Block; EXTENT],
    search: [Block; SEARCH],
    /// The bracket of a flight that has left.
    bracket: [Block; 2],
    /// The motion with which the flight began.
    motion: [Block; MOTION],
    departs: Bits,
    launched: Bits,
    /// On search.
    active: Bits,
    /// Of those that have left: the root is yet to be found in the bracket; the search was given up.
    bracketed: Bits,
    lost: Bits,
    /// Those that have left with the last step.
    pub(crate) left: Bits,
    /// Whose flight it is.
    pub(crate) owner: [usize; WIDTH],
}

/// Flights at the end of their search.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct Leavers {
    orbit: [Block; ORBIT],
    motion: [Block; MOTION],
    time: Block,
    bracket: [Block; 2],
    evaluations: Block,
    bracketed: Bits,
    lost: Bits,
}

impl Default for Leavers {
    fn default() -> Self {
        Self {
            orbit: [[0.0; WIDTH]; ORBIT],
            motion: [[0.0; WIDTH]; MOTION],
            time: [0.0; WIDTH],
            bracket: [[0.0; WIDTH]; 2],
            evaluations: [0.0; WIDTH],
            bracketed: 0,
            lost: 0,
        }
    }
}

impl Default for Group {
    fn default() -> Self {
        Self {
            orbit: [[0.0; WIDTH]; ORBIT],
            extent: [[0.0; WIDTH]; EXTENT],
            search: [[0.0; WIDTH]; SEARCH],
            bracket: [[0.0; WIDTH]; 2],
            motion: [[0.0; WIDTH]; MOTION],
            departs: 0,
            launched: 0,
            active: 0,
            left: 0,
            bracketed: 0,
            lost: 0,
            owner: [0; WIDTH],
        }
    }
}

/// Sets one bit.
fn set(bits: &mut Bits, lane: usize, value: bool) {
    *bits = (*bits & !(1 << lane)) | (Bits::from(value) << lane);
}

impl Group {
    /// Takes over a flight of another group.
    #[inline]
    pub(crate) fn take(
        &mut self,
        lane: usize,
        from: &Self,
        begin: &Departing,
        at: usize,
        owner: usize,
    ) {
        for (to, from) in self.orbit.iter_mut().zip(&from.orbit) {
            to[lane] = from[at];
        }
        for (to, from) in self.extent.iter_mut().zip(&from.extent) {
            to[lane] = from[at];
        }
        for (to, from) in self.search.iter_mut().zip(&from.search) {
            to[lane] = from[at];
        }
        for (to, from) in self.motion.iter_mut().zip(&begin.motion) {
            to[lane] = from[at];
        }
        set(&mut self.departs, lane, from.departs & (1 << at) != 0);
        set(&mut self.launched, lane, from.launched & (1 << at) != 0);
        set(&mut self.active, lane, true);
        set(&mut self.bracketed, lane, false);
        set(&mut self.lost, lane, false);
        self.owner[lane] = owner;
    }

    /// Hands over a flight that has left.
    #[inline]
    pub(crate) fn hand_over(&self, lane: usize, to: &mut Leavers, at: usize) {
        for (to, from) in to.orbit.iter_mut().zip(&self.orbit) {
            to[at] = from[lane];
        }
        for (to, from) in to.bracket.iter_mut().zip(&self.bracket) {
            to[at] = from[lane];
        }
        for (to, from) in to.motion.iter_mut().zip(&self.motion) {
            to[at] = from[lane];
        }
        to.time[at] = self.search[0][lane];
        to.evaluations[at] = self.search[2][lane];
        set(&mut to.bracketed, at, self.bracketed & (1 << lane) != 0);
        set(&mut to.lost, at, self.lost & (1 << lane) != 0);
    }

    /// One step of every flight of all groups.
    pub(crate) fn sweep(groups: &mut [Self], lanes: Lanes, body: &Body, drag: Drag) {
        if drag.acts() {
            lanes.enter(Sweep::<true> { groups, body, drag });
        } else {
            lanes.enter(Sweep::<false> { groups, body, drag });
        }
    }

    /// Flights that begin with `motion`, ready for their search. `least` is made of `parting`.
    pub(crate) fn depart(&mut self, lanes: Lanes, body: &Body, drag: Drag, begin: &Departing) {
        let group = self;
        if drag.acts() {
            lanes.enter(Depart::<true> {
                group,
                body,
                drag,
                begin,
            });
        } else {
            lanes.enter(Depart::<false> {
                group,
                body,
                drag,
                begin,
            });
        }
    }
}

/// Flights about to begin.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct Departing {
    pub(crate) motion: [Block; MOTION],
    pub(crate) launched: Bits,
    pub(crate) parting: Bits,
}

impl Departing {
    /// The motions and their axial spins.
    #[inline(always)]
    pub(crate) fn load<L: Wide>(&self) -> (Motion<L>, L) {
        split(&load::<L, MOTION>(&self.motion))
    }
}

impl Default for Departing {
    fn default() -> Self {
        Self {
            motion: [[0.0; WIDTH]; MOTION],
            launched: 0,
            parting: 0,
        }
    }
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

struct Sweep<'a, const DRAGS: bool> {
    groups: &'a mut [Group],
    body: &'a Body,
    drag: Drag,
}

impl<const DRAGS: bool> Work for Sweep<'_, DRAGS> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        for group in self.groups {
            group.left = 0;
            if group.active != 0 {
                group.step::<L>(self.body, self.drag.known::<DRAGS>());
            }
        }
    }
}

impl Group {
    /// One step of every flight.
    #[inline(always)]
    fn step<L: Wide>(&mut self, body: &Body, drag: Drag) {
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

struct Depart<'a, const DRAGS: bool> {
    group: &'a mut Group,
    body: &'a Body,
    drag: Drag,
    begin: &'a Departing,
}

impl<const DRAGS: bool> Work for Depart<'_, DRAGS> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let (motion, _) = self.begin.load::<L>();
        let mut orbit = Orbit::new(&motion, self.drag.known::<DRAGS>());
        let parting = L::mask(self.begin.parting);
        let least = super::least_time(&orbit, &motion, parting);
        let extent = orbit.extent(self.body);
        let launched = L::mask(self.begin.launched);
        let begins = Search::new(&mut orbit, &extent, launched, least);
        let mut search = begins;
        let gap = orbit.first_gap(self.body);
        search.approach(&orbit, self.body, &orbit.bounds(&extent), &gap);
        // what ends here, or is bracketed, is done again by the next sweep, which sees to its end
        let goes_on = search.active & !search.bracketed;
        let numbers = [
            L::select(goes_on, search.time, begins.time),
            L::select(goes_on, search.least, begins.least),
            L::select(goes_on, L::splat(1.0), L::splat(0.0)),
        ];
        let group = self.group;
        store(&mut group.orbit, &orbit.numbers());
        store(&mut group.extent, &extent.numbers());
        store(&mut group.search, &numbers);
        group.departs = L::bits(begins.departs);
        group.launched = self.begin.launched;
    }
}

impl Leavers {
    /// Ends the search of each: its time, and whether it is lost.
    #[inline(always)]
    pub(crate) fn close_in<L: Wide>(&self, orbit: &Orbit<L>, body: &Body) -> (L, L::Mask) {
        let [low, high] = load::<L, 2>(&self.bracket);
        let bracketed = L::mask(self.bracketed);
        let mut search = Search {
            time: L::load(&self.time),
            low,
            high,
            bracketed,
            active: bracketed,
            least: L::splat(0.0),
            departs: L::Mask::splat(false),
            launched: L::Mask::splat(false),
        };
        let mut evaluations = L::load(&self.evaluations);
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
