//! A low hop over rough ground.
//!
//! The coin follows one orbit from where it leaves the ground to where a rim touches its track, from
//! node to node. The ground under a rim is asked for only where the rim may come down to it: a rim that
//! stays above the highest top of the ground until the next node has no track, and while both do, there
//! are no nodes.

use super::rims_in_flight::{Rim, RimsInFlight};
use super::tracks::{Footing, Track, Tracks, rim_points};
use super::walk::{Next, Touch, Walk};
use crate::flight::{Bounds, Orbit};
use crate::impact::ImpactLaw;
use crate::motion::Motion;
use coinmc_core::Observer;

/// A rim touches when it is this close to its track and approaches it, by more than rounding.
const TOUCH: f64 = 1e-10;
const APPROACH: f64 = 1e-9;
/// Shortest step of a rim that leaves its track by its acceleration alone, as a share of the time
/// to the next node.
const LEAST_STEP: f64 = 1e-2;
/// Most steps of a search.
const MOST_STEPS: u32 = 200;
/// Most nodes that a hop passes before the limits of the toss are looked at.
const MOST_NODES: u32 = 1000;

/// A hop under way.
struct Hop {
    orbit: Orbit<f64>,
    bounds: Bounds<f64>,
    /// The time since the start at which the tracks have their heights: that of the last node.
    since: f64,
    /// Whether the own and the other rim have tracks up to the next node.
    tracked: [bool; 2],
}

impl<I: ImpactLaw, O: Observer> Walk<'_, I, O> {
    /// Flies to the first contact of a rim with its track.
    pub(super) fn hop(&mut self) -> Next {
        self.give_back_lead();
        let model = self.model;
        let body = &model.dynamics.body;
        let orbit = Orbit::new(&self.toss.motion, self.model.dynamics.drag);
        let mut hop = Hop {
            bounds: orbit.bounds(&orbit.extent(body)),
            orbit,
            since: 0.0,
            tracked: [true; 2],
        };
        let mut now = RimsInFlight::new(body, &hop.orbit, 0.0);
        let mut next = RimsInFlight::new(body, &hop.orbit, self.tracks.left);
        for _ in 0..MOST_NODES {
            self.usage.steps += 1;
            if let Some((at, rim)) = self.first_touch(&hop, now, &next) {
                return self.touch_down(&hop, at, rim, [&now, &next]);
            }
            now = next;
            next = self.pass_node_in_flight(&mut hop, &now);
        }
        self.fly_on(&hop.orbit, now.time, 0.0);
        self.begin_tracks();
        Next::Goes(Touch::Nothing)
    }

    /// Lays out the tracks from a node on, of the rims that may come down to them; the rims at the next
    /// node.
    fn pass_node_in_flight<'b>(
        &mut self,
        hop: &mut Hop,
        now: &RimsInFlight<'b>,
    ) -> RimsInFlight<'b> {
        let (orbit, highest) = (&hop.orbit, self.ground.highest);
        let velocity = [self.toss.motion.vx, self.toss.motion.vy];
        let step = self.model.ground_step * self.ground.length;
        let (speed, turn) = now.pace(velocity);
        let mut time = Tracks::time_at_pace(step, speed, turn);
        let mut next = now.at(orbit, now.time + time);
        // how much lower than at both ends a rim may be in between
        let dip = now.dip(orbit, &hop.bounds, time);
        let tracked = Rim::BOTH.map(|rim| now.height(rim).min(next.height(rim)) - dip <= highest);
        let left = self.tracks.left;
        for (i, rim) in Rim::BOTH.into_iter().enumerate() {
            let track = self.tracks.of_mut(rim);
            track.height += track.rate * left;
            if tracked[i] {
                let height = hop.tracked[i].then_some(track.height);
                *self.tracks.of_mut(rim) = self.track_in_flight(hop, rim, height, [now, &next]);
            }
        }
        if tracked == [false; 2] {
            let level = Track::level(highest);
            let bend = now.bend(&hop.bounds);
            let [own, other] =
                Rim::BOTH.map(|rim| now.gap_above(rim, &level, now.time).earliest(bend));
            if own.min(other) > time {
                time = own.min(other);
                next = now.at(orbit, now.time + time);
            }
        }
        (self.tracks.left, self.tracks.interval) = (time, time);
        (hop.since, hop.tracked) = (now.time, tracked);
        next
    }

    /// The track of a rim from a node to the next; `height` where it begins, if that is known.
    fn track_in_flight(
        &self,
        hop: &Hop,
        rim: Rim,
        height: Option<f64>,
        [now, next]: [&RimsInFlight<'_>; 2],
    ) -> Track {
        let outer_radius = self.body().outer_radius();
        let support = |at: &RimsInFlight<'_>| {
            let (centre, _) = self.model.glide(self.toss, &hop.orbit, at.time);
            let (point, along) = (at.point(&self.place, rim, centre), at.along(&self.place));
            let curvature = at.sin() / outer_radius;
            (self.ground.under_rim(point, along, curvature), point, along)
        };
        // the rim is above the ground
        let height = height.unwrap_or_else(|| support(now).0.height.min(now.height(rim)));
        let (ahead, point, along) = support(next);
        Track {
            rate: (ahead.height - height) / (next.time - now.time),
            height,
            footing: Some(Footing::new(&ahead, point, along)),
            near: true,
        }
    }

    /// Ends a hop where a rim touches, on whole tracks.
    fn touch_down(
        &mut self,
        hop: &Hop,
        at: RimsInFlight<'_>,
        rim: Rim,
        [now, next]: [&RimsInFlight<'_>; 2],
    ) -> Next {
        if hop.since > 0.0 {
            let (cos, rate) = now.lean();
            let is_upper = (rim == Rim::Own) == at.points_down();
            let near = is_upper
                || cos.abs() < self.ground.near + (rate / now.sin()).abs() * self.tracks.interval;
            for (i, side) in Rim::BOTH.into_iter().enumerate() {
                if near && !hop.tracked[i] {
                    *self.tracks.of_mut(side) = self.track_in_flight(hop, side, None, [now, next]);
                } else if !near && side != rim {
                    *self.tracks.of_mut(side) = self.tracks.of(rim).alongside();
                }
            }
        }
        self.fly_on(&hop.orbit, at.time, hop.since);
        if (rim == Rim::Other) != at.points_down() {
            self.switch_rim();
        }
        let [own, _] = rim_points(self.body(), &self.toss.motion, &self.toss.spin);
        self.toss.motion.z = self.tracks.own.height - own.rz;
        Next::Impact
    }

    /// The first contact before the next node, and which rim touches.
    fn first_touch<'b>(
        &self,
        hop: &Hop,
        mut now: RimsInFlight<'b>,
        next: &RimsInFlight<'b>,
    ) -> Option<(RimsInFlight<'b>, Rim)> {
        let end = self.tracks.left;
        let dip = now.dip(&hop.orbit, &hop.bounds, end);
        let gap = |at: &RimsInFlight<'_>, rim| at.gap_above(rim, self.tracks.of(rim), hop.since);
        let clear = |(tracked, rim): (bool, Rim)| {
            !tracked || gap(&now, rim).height.min(gap(next, rim).height) > dip + TOUCH
        };
        if hop.tracked.into_iter().zip(Rim::BOTH).all(clear) {
            return None;
        }
        for _ in 0..MOST_STEPS {
            let bend = now.bend(&hop.bounds);
            let mut step = f64::INFINITY;
            for (i, rim) in Rim::BOTH.into_iter().enumerate() {
                if !hop.tracked[i] {
                    continue;
                }
                let gap = gap(&now, rim);
                if gap.height <= TOUCH && gap.rate < -APPROACH {
                    return Some((now, rim));
                }
                let least = if gap.height <= TOUCH {
                    LEAST_STEP * end
                } else {
                    0.0
                };
                step = step.min(gap.earliest(bend).max(least));
            }
            if now.time + step >= next.time {
                return None;
            }
            now = now.at(&hop.orbit, now.time + step);
        }
        None
    }

    /// Moves the coin along its orbit; its tracks have their heights at the time `since`.
    fn fly_on(&mut self, orbit: &Orbit<f64>, time: f64, since: f64) {
        let ([dx, dy], start) = self.model.glide(self.toss, orbit, time);
        if O::ACTIVE {
            self.model
                .show_flight(self.toss, orbit, time, self.observer);
            let before = self.toss.place;
            self.toss.place.shift(dx, dy);
            self.toss.place.time += time;
            self.descend_from(&before);
        }
        let (mut motion, [nx, ny], reflected): (Motion<f64>, _, _) = orbit.at(&start, time);
        let axial_factor = self.model.dynamics.axial_factor;
        let axial = self.toss.spin.axial * orbit.spin_left(time);
        let mut spin = motion.spin(axial_factor);
        spin.axial = if reflected { -axial } else { axial };
        motion.set_spin(&spin, axial_factor);
        (self.toss.motion, self.toss.spin) = (motion, spin);
        self.toss.heads_up ^= reflected;
        self.toss.place.align(nx, ny);
        self.place.shift(dx, dy);
        self.place.align(nx, ny);
        self.tracks.advance(time - since);
        if reflected {
            self.tracks.switch();
        }
        self.usage.time += time;
        // drag takes energy in flight
        self.budget = self.budget.min(self.energy());
    }
}

#[cfg(test)]
mod tests;
