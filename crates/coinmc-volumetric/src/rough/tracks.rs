//! The two tracks: the height of the ground under the lowest point of either rim, along the way.
//!
//! Each track is a polyline in time. At a *node* the places that the two points will have reached a
//! short time later are predicted, and the tracks lead from their present heights to the ground's
//! heights there; so they return to the ground at every node, and errors of the prediction do not
//! add up.

use super::ground::{Ground, Support};
use super::rims_in_flight::Rim;
use crate::body::Body;
use crate::motion::{Motion, Spin};
use crate::place::Place;
use crate::series::sin_cos;

/// Longest time between nodes, in sqrt(D/g).
const LONGEST: f64 = 0.1;
/// Largest turn of the coin's frame between nodes, rad.
const LARGEST_TURN: f64 = 0.2;
/// A share of the time between nodes that counts as none.
const INSTANT: f64 = 1e-9;

/// The ground under one rim: its height, and the rate at which that changes until the next node.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Track {
    pub(super) height: f64,
    pub(super) rate: f64,
    /// What carries the rim at the next node; none if the track does not follow the ground.
    pub(super) footing: Option<Footing>,
    /// Whether the track follows the ground.
    pub(super) near: bool,
}

/// What carries a rim at a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Footing {
    /// The place of the ground that carries the rim.
    place: [f64; 2],
    /// The horizontal direction along the rim, y of the coin's frame.
    along: [f64; 2],
    /// The slope along the rim, of a rim that bridges hollows.
    bridge: Option<f64>,
}

/// The tracks of the rim at −h u, the lower one of an upright axis, and of the rim at +h u.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tracks {
    pub(super) own: Track,
    pub(super) other: Track,
    /// Time to the next node.
    pub(super) left: f64,
    /// Time from the last node to the next.
    pub(super) interval: f64,
}

/// The lowest point of a rim relative to the centre, in the coin's frame, and how it moves.
#[derive(Debug, Clone, Copy)]
pub(super) struct RimPoint {
    /// Along x and z.
    pub(super) rx: f64,
    pub(super) rz: f64,
    /// How it moves over the ground.
    wx: f64,
    wy: f64,
}

impl RimPoint {
    /// Velocity over the ground.
    pub(super) fn velocity(&self) -> [f64; 2] {
        [self.wx, self.wy]
    }

    /// Speed over the ground.
    pub(super) fn speed(&self) -> f64 {
        (self.wx * self.wx + self.wy * self.wy).sqrt()
    }
}

/// The lowest points of both rims: own, other.
pub(super) fn rim_points(body: &Body, motion: &Motion<f64>, spin: &Spin<f64>) -> [RimPoint; 2] {
    let turn = -spin.turn / motion.sin;
    [-body.half, body.half].map(|half| {
        let rx = body.radius * motion.cos + half * motion.sin;
        let rz = half * motion.cos - body.radius * motion.sin;
        RimPoint {
            rx,
            rz,
            wx: motion.vx + rz * spin.tilt,
            wy: motion.vy + rx * turn,
        }
    })
}

/// What carries a rim now: its height, and where. The lowest point of the rim is at `reach` from the centre,
/// along x of the coin's frame.
pub(super) fn carried_now(
    ground: &Ground,
    body: &Body,
    motion: &Motion<f64>,
    place: &Place,
    reach: f64,
) -> (f64, Footing) {
    let (at, along) = (place.point(reach, 0.0), place.direction(0.0, 1.0));
    let support = ground.under_rim(at, along, motion.sin / body.outer_radius());
    (support.height, Footing::new(&support, at, along))
}

impl Footing {
    pub(super) fn new(support: &Support, point: [f64; 2], along: [f64; 2]) -> Self {
        Self {
            place: support.bridge.map_or(point, |(_, place)| place),
            along,
            bridge: support.bridge.map(|(slope, _)| slope),
        }
    }

    /// The slopes of the ground, along x and y of the coin's frame at the node.
    pub(super) fn slopes(&self, ground: &Ground) -> [f64; 2] {
        let ([gx, gy], [ax, ay]) = (ground.gradient(self.place), self.along);
        let steep = self.bridge.unwrap_or(gx * ax + gy * ay);
        [gx * ay - gy * ax, steep]
    }

    /// The same in the frame turned by half a turn.
    fn reversed(self) -> Self {
        Self {
            along: self.along.map(|component| -component),
            bridge: self.bridge.map(|slope| -slope),
            ..self
        }
    }
}

impl Track {
    /// Level ground at this height.
    pub(super) fn level(height: f64) -> Self {
        Self {
            height,
            ..Self::default()
        }
    }

    /// The track of a rim that is too far above the ground to touch it, beside this one: only heights
    /// relative to this track matter then.
    pub(super) fn alongside(&self) -> Self {
        Self {
            height: self.height,
            rate: self.rate,
            footing: None,
            near: false,
        }
    }

    /// The slopes of the ground at the next node, along x and y of the coin's frame there. 0 if the
    /// track does not follow the ground. (Most nodes are passed in flight and need none.)
    pub(super) fn slopes(&self, ground: &Ground) -> [f64; 2] {
        let Some(footing) = &self.footing else {
            return [0.0; 2];
        };
        footing.slopes(ground)
    }
}

impl Tracks {
    /// Moves along both tracks.
    pub(super) fn advance(&mut self, time: f64) {
        self.own.height += self.own.rate * time;
        self.other.height += self.other.rate * time;
        self.left -= time;
    }

    /// Lowers both tracks by `excess`, and stops them until the next node.
    pub(super) fn stop(&mut self, excess: f64) {
        for track in [&mut self.own, &mut self.other] {
            track.height -= excess;
            track.rate = 0.0;
        }
    }

    /// Tracks at level ground of the height 0, up to a node in `time` from now.
    pub(super) fn level(time: f64) -> Self {
        Self {
            left: time,
            interval: time,
            ..Self::default()
        }
    }

    /// Lets the own rim go on to the next node at the height and the rate with which it has landed.
    pub(super) fn keep_landing(&mut self, landed: &Track) {
        (self.own.height, self.own.rate) = (landed.height, landed.rate);
        if !self.other.near {
            self.other = self.own.alongside();
        }
    }

    pub(super) fn of(&self, rim: Rim) -> &Track {
        match rim {
            Rim::Own => &self.own,
            Rim::Other => &self.other,
        }
    }

    pub(super) fn of_mut(&mut self, rim: Rim) -> &mut Track {
        match rim {
            Rim::Own => &mut self.own,
            Rim::Other => &mut self.other,
        }
    }

    /// Whether the next node is reached, apart from a time too short to step over.
    pub(super) fn at_node(&self) -> bool {
        self.left <= INSTANT * self.interval
    }

    /// Exchanges the rims, and reverses the frame.
    pub(super) fn switch(&mut self) {
        std::mem::swap(&mut self.own, &mut self.other);
        for track in [&mut self.own, &mut self.other] {
            track.footing = track.footing.map(Footing::reversed);
        }
    }

    /// The time to the next node. `step` is the longest way of a point between nodes.
    pub(super) fn time_between_nodes(
        step: f64,
        body: &Body,
        motion: &Motion<f64>,
        spin: &Spin<f64>,
    ) -> f64 {
        let points = rim_points(body, motion, spin);
        let turn = -spin.turn / motion.sin;
        Self::time_at_pace(step, points[0].speed().max(points[1].speed()), turn)
    }

    /// The same at the speed of the faster point, and at the rate at which the frame turns.
    pub(super) fn time_at_pace(step: f64, fastest: f64, turn: f64) -> f64 {
        LONGEST
            .min(step / fastest.max(f64::MIN_POSITIVE))
            .min(LARGEST_TURN / turn.abs().max(f64::MIN_POSITIVE))
    }

    /// Lays out the tracks up to the next node, in `time` from now.
    pub(super) fn lay_out(
        &mut self,
        ground: &Ground,
        time: f64,
        body: &Body,
        motion: &Motion<f64>,
        spin: &Spin<f64>,
        place: &Place,
    ) {
        let points = rim_points(body, motion, spin);
        let turn = -spin.turn / motion.sin;
        (self.left, self.interval) = (time, time);
        let thickness = 2.0 * body.half;
        // a rim that is lower than the own one is near, however far the coin leans on a steep slope
        let near = motion.cos < ground.near + spin.tilt.abs() * time;
        let curvature = motion.sin / body.outer_radius();
        let (sin, cos) = sin_cos(turn * time);
        let along = place.direction(-sin, cos);
        let lead = |track: &mut Track, point: &RimPoint| {
            let x = point.rx * cos + (motion.vx + point.rz * spin.tilt) * time;
            let y = point.rx * sin + motion.vy * time;
            let at = place.point(x, y);
            let support = ground.under_rim(at, along, curvature);
            track.rate = (support.height - track.height) / time;
            track.footing = Some(Footing::new(&support, at, along));
        };
        lead(&mut self.own, &points[0]);
        if near {
            if !self.other.near {
                // the rim is still above the ground
                let highest = self.own.height + thickness * motion.cos;
                let (height, _) = carried_now(ground, body, motion, place, points[1].rx);
                self.other.height = height.min(highest);
            }
            lead(&mut self.other, &points[1]);
            self.other.near = true;
        } else {
            self.other = self.own.alongside();
        }
    }

    /// At a node, with the own rim on the ground under it.
    pub(super) fn begin(
        ground: &Ground,
        body: &Body,
        motion: &Motion<f64>,
        spin: &Spin<f64>,
        place: &Place,
    ) -> Self {
        let mut tracks = Self::default();
        let [own, _] = rim_points(body, motion, spin);
        (tracks.own.height, _) = carried_now(ground, body, motion, place, own.rx);
        tracks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The node counts as reached where the rest of the way takes a billionth of its whole time.
    #[test]
    fn level_tracks_lead_to_a_node_that_is_reached_in_time() {
        for (share, reached) in [(0.0, false), (1.0 - 2e-9, false), (1.0 - 5e-10, true)] {
            let mut tracks = Tracks::level(0.02);
            tracks.advance(share * 0.02);
            assert_eq!(tracks.at_node(), reached, "{share}");
        }
    }

    /// The other rim has a track of its own near upright; and wherever it is the lower one, however far the coin leans.
    #[test]
    fn a_rim_below_the_own_one_is_near_the_ground_whatever_the_lean() {
        let model = crate::rough::test_scenes::Rough::of(0.7, 0.02).model();
        let ground = model.ground.expect("a rough ground");
        let body = model.dynamics.body;
        let place = Place::at([0.3, 0.2], [1.0, 0.0]);
        for (cos, near) in [(0.6, false), (0.5 * ground.near, true), (-0.6_f64, true)] {
            let mut motion = Motion::still();
            (motion.sin, motion.cos) = ((1.0 - cos * cos).sqrt(), cos);
            let spin = Spin::still();
            let mut tracks = Tracks::begin(&ground, &body, &motion, &spin, &place);
            tracks.lay_out(&ground, 0.01, &body, &motion, &spin, &place);
            assert_eq!(tracks.other.near, near, "{cos}");
        }
    }
}
