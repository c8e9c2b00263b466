//! A low hop over rough ground.

use super::tracks::{Track, rim_points};
use super::walk::{Next, Touch, Walk};
use crate::body::Body;
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

/// Which rim, as seen at the start of a hop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rim {
    Own,
    Other,
}

/// The gap between a rim and its track, and its rate.
#[derive(Debug, Clone, Copy)]
struct RimGap {
    height: f64,
    rate: f64,
}

impl<I: ImpactLaw, O: Observer> Walk<'_, I, O> {
    /// Flies to the next node or to the first contact of a rim with its track.
    pub(super) fn hop(&mut self) -> Next {
        self.usage.steps += 1;
        self.give_back_lead();
        let orbit = Orbit::new(&self.toss.motion, self.model.dynamics.drag);
        if let Some(time) = self.time_above_all(&orbit) {
            self.fly_on(&orbit, time);
            self.begin_tracks();
            return Next::Goes(Touch::Nothing);
        }
        let (time, touches) = self.first_touch(&orbit);
        self.fly_on(&orbit, time);
        match touches {
            None => {
                self.lay_out_tracks();
                Next::Goes(Touch::Nothing)
            }
            Some((rim, reflected)) => {
                if (rim == Rim::Other) != reflected {
                    self.switch_rim();
                }
                let [own, _] = rim_points(self.body(), &self.toss.motion, &self.toss.spin);
                self.toss.motion.z = self.tracks.own.height - own.rz;
                Next::Impact
            }
        }
    }

    /// How long both rims are sure to stay above the highest top of the ground, if at least until the
    /// next node: so long the coin needs no tracks.
    fn time_above_all(&self, orbit: &Orbit<f64>) -> Option<f64> {
        /// The search ends where it gains less than this share of the time between nodes.
        const LEAST_GAIN: f64 = 0.2;
        let (body, motion) = (self.body(), &self.toss.motion);
        let top = Track::level(self.ground.highest());
        if motion.z - motion.rest_height(body) <= top.height {
            return None;
        }
        let bounds = orbit.bounds(&orbit.extent(body));
        let mut time = 0.0;
        for _ in 0..MOST_STEPS {
            let gaps = rim_gaps(body, orbit, &bounds, [&top, &top], time);
            let gain = gaps.earliest();
            time += gain;
            if gain < LEAST_GAIN * self.tracks.left {
                break;
            }
        }
        (time > self.tracks.left).then_some(time)
    }

    /// The time of the first contact before the next node, and which rim touches; also whether the
    /// axis then points down in the frame of the flight.
    fn first_touch(&self, orbit: &Orbit<f64>) -> (f64, Option<(Rim, bool)>) {
        let body = self.body();
        let end = self.tracks.left;
        let bounds = orbit.bounds(&orbit.extent(body));
        let mut time = 0.0;
        for _ in 0..MOST_STEPS {
            let tracks = [&self.tracks.own, &self.tracks.other];
            let gaps = rim_gaps(body, orbit, &bounds, tracks, time);
            for (rim, gap) in [(Rim::Own, gaps.own), (Rim::Other, gaps.other)] {
                if gap.height <= TOUCH && gap.rate < -APPROACH {
                    return (time, Some((rim, gaps.points_down)));
                }
            }
            let least = if gaps.own.height <= TOUCH || gaps.other.height <= TOUCH {
                LEAST_STEP * end
            } else {
                0.0
            };
            time += gaps.earliest().max(least);
            if time >= end {
                break;
            }
        }
        (end, None)
    }

    /// Moves the coin along its orbit.
    fn fly_on(&mut self, orbit: &Orbit<f64>, time: f64) {
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
        self.tracks.advance(time);
        if reflected {
            self.tracks.switch();
        }
        self.usage.time += time;
        // drag takes energy in flight
        self.budget = self.budget.min(self.energy());
    }
}

/// The gaps of both rims at one time of a flight.
struct RimGaps {
    own: RimGap,
    other: RimGap,
    /// What no rim's acceleration downwards exceeds.
    bend: f64,
    /// Whether the axis points down in the frame of the flight.
    points_down: bool,
}

/// The gaps above these tracks, of the own rim and of the other.
fn rim_gaps(
    body: &Body,
    orbit: &Orbit<f64>,
    bounds: &Bounds<f64>,
    [own, other]: [&Track; 2],
    time: f64,
) -> RimGaps {
    let now = orbit.gap(body, time);
    let gap = |half: f64, track: &Track| RimGap {
        height: now.z + half * now.uz - body.radius * now.sin - (track.height + track.rate * time),
        rate: now.vz + half * now.uz_rate - body.radius * now.sin_rate - track.rate,
    };
    RimGaps {
        own: gap(-body.half, own),
        other: gap(body.half, other),
        bend: 1.0 + body.half * bounds.swing + body.radius * bounds.spread / now.sin,
        points_down: now.uz < 0.0,
    }
}

impl RimGaps {
    /// The earliest time from now at which either gap may close.
    fn earliest(&self) -> f64 {
        self.own
            .earliest(self.bend)
            .min(self.other.earliest(self.bend))
    }
}

impl RimGap {
    /// The earliest time at which the gap may close: it never accelerates downwards by more than
    /// `bend`.
    fn earliest(&self, bend: f64) -> f64 {
        let height = self.height.max(0.0);
        let root = (self.rate * self.rate + 2.0 * bend * height).sqrt();
        if self.rate >= 0.0 {
            (self.rate + root) / bend
        } else {
            2.0 * height / (root - self.rate)
        }
    }
}
