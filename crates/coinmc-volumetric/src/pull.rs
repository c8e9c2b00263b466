//! The pull of a tilted table: the part of the weight along it.
//!
//! In axes of the table (`coinmc_core::TableTilt`) the weight is 1 towards the table and tan β along
//! the downhill direction ê, with g cos β for g. The pull has no moment about the centre, and impacts
//! do not know of it. In flight it is a constant acceleration; in contact it joins the horizontal
//! force b of the equations of motion.
//!
//! The kernel's frame turns with the coin at the rate φ', so the pull turns in it. Within a step of
//! contact it is taken as it is in the middle of the step, and no step turns by more than
//! [`LARGEST_TURN`]: a method of second order in that angle. How much energy the way down gives is
//! told by the place itself, so that a step never gives more.
//!
//! Only tosses with an observer know their place. So a tilted table follows every toss with one.

use crate::drag::Drag;
use crate::motion::Motion;
use crate::place::Place;
use crate::series::{decay, sin_cos};
use coinmc_core::TableTilt;

/// Largest turn of the frame within a step of contact, rad.
pub(crate) const LARGEST_TURN: f64 = 0.2;

/// The pull of a tilted table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pull {
    /// tan β.
    pub(crate) slope: f64,
    /// ê, in axes of the table.
    downhill: [f64; 2],
}

impl Pull {
    pub(crate) fn new(tilt: &TableTilt) -> Self {
        Self {
            slope: tilt.slope(),
            downhill: tilt.downhill(),
        }
    }

    /// The pull in the frame of a coin, after that has turned by `ahead`, rad.
    pub(crate) fn in_frame(&self, place: &Place, ahead: f64) -> [f64; 2] {
        let [x, y] = place.in_frame(self.downhill).map(|e| e * self.slope);
        let (sin, cos) = sin_cos(ahead);
        [x * cos + y * sin, y * cos - x * sin]
    }

    /// The work of the pull on a coin that has gone from one place to another.
    pub(crate) fn work(&self, from: &Place, to: &Place) -> f64 {
        let [x, y] = to.way_from(from);
        self.slope * (x * self.downhill[0] + y * self.downhill[1])
    }

    /// A flight of time `t` that begins with `motion` at `place`: the way that the pull adds, in the
    /// frame of the departure, and the motion from whose velocity the coin would arrive with the
    /// velocity that the pull gives it.
    ///
    /// v' = −kv + p has the solution v e^(−kt) + p t P(kt), with the way p t² Q(kt) (see [`decay`]).
    pub(crate) fn in_flight(
        &self,
        place: &Place,
        drag: &Drag,
        motion: &Motion<f64>,
        t: f64,
    ) -> ([f64; 2], Motion<f64>) {
        let pull = self.in_frame(place, 0.0);
        let x = drag.linear * t;
        let (p, q) = decay(x);
        let gained = t * p / (1.0 - x * p);
        let after = Motion {
            vx: motion.vx + pull[0] * gained,
            vy: motion.vy + pull[1] * gained,
            ..*motion
        };
        (pull.map(|pull| pull * t * t * q), after)
    }
}

/// The longest step of contact in which the frame, turning at this rate, turns by no more than
/// [`LARGEST_TURN`].
pub(crate) fn longest_step(turning: f64) -> f64 {
    LARGEST_TURN / turning.abs().max(f64::MIN_POSITIVE)
}
