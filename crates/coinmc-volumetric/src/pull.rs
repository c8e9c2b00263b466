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
use crate::flight::velocity_left;
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
        let (p, q) = decay(drag.linear * t);
        let gained = t * p / velocity_left(drag.linear, t);
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

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_testkit::Dice;

    /// A tilt, a place whose frame looks anywhere, and the direction of that.
    fn somewhere(dice: &mut Dice) -> (TableTilt, Pull, Place, f64) {
        let tilt = TableTilt::new(dice.between(1.0, 8.0), dice.between(0.0, 360.0));
        let tilt = tilt.expect("a valid tilt");
        let heading = dice.between(-3.0, 3.0);
        let (sin, cos) = libm::sincos(heading);
        (tilt, Pull::new(&tilt), Place::origin([cos, sin]), heading)
    }

    /// tan β downhill, seen from a frame that has turned.
    #[test]
    fn the_pull_is_downhill_in_every_frame() {
        for toss in 0..100 {
            let mut dice = Dice::new(631, toss);
            let (tilt, pull, place, heading) = somewhere(&mut dice);
            let ahead = dice.between(-LARGEST_TURN, LARGEST_TURN);
            let [x, y] = pull.in_frame(&place, ahead);
            let [ex, ey] = tilt.downhill();
            let (sin, cos) = libm::sincos(heading + ahead);
            assert!((x * cos - y * sin - tilt.slope() * ex).abs() < 1e-14);
            assert!((x * sin + y * cos - tilt.slope() * ey).abs() < 1e-14);
            let mut there = place;
            let [dx, dy] = [dice.between(-1.0, 1.0), dice.between(-1.0, 1.0)];
            there.shift(dx, dy);
            let [px, py] = pull.in_frame(&place, 0.0);
            assert!((pull.work(&place, &there) - (px * dx + py * dy)).abs() < 1e-14);
        }
    }

    /// A flight under drag and pull, v' = −kv + p, against its exact solution with the pull's part by itself:
    /// p (t − (1 − e^(−kt))/k)/k, and p t²/2 without drag.
    #[test]
    fn a_flight_is_pulled_and_arrives_with_its_velocity() {
        for toss in 0..100 {
            let mut dice = Dice::new(632, toss);
            let (_, pull, place, _) = somewhere(&mut dice);
            let linear = if toss % 4 == 0 {
                0.0
            } else {
                dice.between(0.1, 2.0)
            };
            let drag = Drag {
                linear,
                angular: 0.3,
            };
            let motion = Motion {
                vx: dice.between(-1.0, 1.0),
                vy: dice.between(-1.0, 1.0),
                ..Motion::still()
            };
            let t = dice.between(0.1, 3.0);
            let (way, after) = pull.in_flight(&place, &drag, &motion, t);
            let left = libm::exp(-linear * t);
            let lasting = if linear > 0.0 {
                (1.0 - left) / linear
            } else {
                t
            };
            let far = if linear > 0.0 {
                (t - lasting) / linear
            } else {
                0.5 * t * t
            };
            let p = pull.in_frame(&place, 0.0);
            for (i, (v, arrives)) in [(motion.vx, after.vx), (motion.vy, after.vy)]
                .into_iter()
                .enumerate()
            {
                assert!((way[i] - p[i] * far).abs() < 1e-12);
                assert!((arrives * left - (v * left + p[i] * lasting)).abs() < 1e-12);
            }
        }
    }

    /// However long a flight in drag is, a coin arrives with a velocity: in the end the one at which drag balances
    /// the pull, p/k.
    #[test]
    fn a_long_flight_ends_at_the_speed_at_which_drag_balances_the_pull() {
        let (_, pull, place, _) = somewhere(&mut Dice::new(633, 0));
        let (linear, angular) = (2.0, 0.3);
        let drag = Drag { linear, angular };
        let motion = Motion {
            vx: 1.0,
            ..Motion::still()
        };
        let p = pull.in_frame(&place, 0.0);
        for t in [16.0, 20.0, 30.0, 100.0, 1e6] {
            let (_, after) = pull.in_flight(&place, &drag, &motion, t);
            let left = velocity_left(linear, t);
            for (arrives, p) in [(after.vx * left, p[0]), (after.vy * left, p[1])] {
                assert!((arrives - p / linear).abs() < 1e-13, "{t}: {arrives} {p}");
            }
        }
    }

    #[test]
    fn a_step_turns_by_no_more_than_is_allowed() {
        for turning in [0.5, -7.0] {
            let turned = longest_step(turning) * f64::abs(turning);
            assert!((turned - LARGEST_TURN).abs() < 1e-15);
        }
        assert!(longest_step(0.0) > 1e100);
    }
}
