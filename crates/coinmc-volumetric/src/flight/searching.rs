//! All flights on search: groups of eight, whose lanes are given to the next as flights leave.

use super::orbit::Drag;
use super::station::{Departing, Group, Leavers};
use crate::body::Body;
use coinmc_lanes::{Bits, Lanes, Route, WIDTH, Wide, Work};

/// For half of the tosses under way, the others being at other stages.
const GROUPS: usize = 8;

/// A bit of every lane of every group, those of the first group lowest.
type Places = u64;

/// All flights on search.
#[derive(Debug, Clone)]
pub(crate) struct Searching {
    groups: [Group; GROUPS],
    /// Flights that set out, until they have their places.
    fresh: Group,
    /// Places that are free.
    vacant: Places,
    /// Places of flights whose search is over.
    landed: Places,
}

/// The first group that any of the places is in, and those of its lanes.
fn first_of(places: Places) -> (usize, Bits) {
    let group = places.trailing_zeros() as usize / WIDTH % GROUPS;
    (group, places.to_le_bytes()[group])
}

/// The places of lanes of a group.
fn places(group: usize, lanes: Bits) -> Places {
    Places::from(lanes) << (group * WIDTH)
}

impl Searching {
    pub(crate) fn none() -> Self {
        Self {
            groups: Default::default(),
            fresh: Group::default(),
            vacant: Places::MAX,
            landed: 0,
        }
    }

    /// How many places are free.
    pub(crate) fn vacant(&self) -> usize {
        self.vacant.count_ones() as usize
    }

    /// How many flights wait to be gathered.
    pub(crate) fn landed(&self) -> usize {
        self.landed.count_ones() as usize
    }

    /// Whether any flight is on search.
    pub(crate) fn is_any(&self) -> bool {
        self.vacant | self.landed != Places::MAX
    }

    /// Puts flights of those lanes on search; there must be places for them.
    pub(crate) fn depart(
        &mut self,
        lanes: Lanes,
        body: &Body,
        drag: Drag,
        begin: &Departing,
        flies: Bits,
    ) {
        let searching = self;
        if drag.acts() {
            lanes.enter(Depart::<true> {
                searching,
                body,
                drag,
                begin,
                flies,
            });
        } else {
            lanes.enter(Depart::<false> {
                searching,
                body,
                drag,
                begin,
                flies,
            });
        }
    }

    /// One step of every flight.
    pub(crate) fn sweep(&mut self, lanes: Lanes, body: &Body, drag: Drag) {
        let groups = &mut self.groups;
        if drag.acts() {
            lanes.enter(Sweep::<true> { groups, body, drag });
        } else {
            lanes.enter(Sweep::<false> { groups, body, drag });
        }
        for (i, group) in self.groups.iter().enumerate() {
            self.landed |= places(i, group.left);
        }
    }

    /// Gives flights that have set out their places.
    #[inline(always)]
    fn take<L: Wide>(&mut self, begin: &Departing, mut flies: Bits) {
        while flies != 0 && self.vacant != 0 {
            let (group, vacant) = first_of(self.vacant);
            let route = Route::between(flies, vacant);
            self.groups[group].take::<L>(&self.fresh, begin, &route);
            flies &= !route.from();
            self.vacant &= !places(group, route.to());
        }
    }

    /// Hands over up to eight flights that have left, at least one, and says how many. Lanes beyond the
    /// last do the same as it, for nothing.
    #[inline(always)]
    pub(crate) fn gather<L: Wide>(&mut self, to: &mut Leavers) -> usize {
        let mut free = Bits::MAX;
        while free != 0 && self.landed != 0 {
            let (group, landed) = first_of(self.landed);
            let route = Route::between(landed, free);
            self.groups[group].hand_over::<L>(to, &route);
            free &= !route.to();
            let left = places(group, route.from());
            self.landed &= !left;
            self.vacant |= left;
            if self.landed == 0 {
                let last = Route::to_all(route.from(), free);
                self.groups[group].hand_over::<L>(to, &last);
            }
        }
        free.count_zeros() as usize
    }
}

struct Depart<'a, const DRAGS: bool> {
    searching: &'a mut Searching,
    body: &'a Body,
    drag: Drag,
    begin: &'a Departing,
    flies: Bits,
}

impl<const DRAGS: bool> Work for Depart<'_, DRAGS> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let (searching, begin) = (self.searching, self.begin);
        let drag = self.drag.known::<DRAGS>();
        searching.fresh.set_out::<L>(begin, self.body, drag);
        searching.take::<L>(begin, self.flies);
    }
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
            if group.is_active() {
                group.step::<L>(self.body, self.drag.known::<DRAGS>());
            }
        }
    }
}
