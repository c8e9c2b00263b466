//! The flight of a coin with a conical edge: to the first contact of either rim.

use super::Conical;
use crate::contact::Usage;
use crate::flight::{Departure, OneRim, Orbit, first_contact, least_time};
use crate::model::Model;
use crate::motion::Motion;
use crate::toss::Toss;
use coinmc_core::Observer;

/// The first contact of one rim.
struct RimContact {
    orbit: Orbit<f64>,
    time: f64,
    /// Time from the start of the flight.
    duration: f64,
}

impl<L> Conical<L> {
    /// Flies to the next contact. Returns `false` if the search for it was given up.
    pub(super) fn fly<O: Observer>(
        &self,
        toss: &mut Toss,
        usage: &mut Usage,
        departure: Departure,
        observer: &mut O,
    ) -> bool {
        let whole = Orbit::new(&toss.motion, self.model(toss).dynamics.drag);
        let own = self.contact_of(toss, 1.0, departure, &whole);
        // the other rim has not just rebounded: it touches as soon as it is at the surface and sinks
        let other = self.contact_of(toss, -1.0, Departure::Launched, &whole);
        let (Some(own), Some(other)) = (own, other) else {
            return false;
        };
        let (found, turns) = if other.duration < own.duration {
            (other, true)
        } else {
            (own, false)
        };
        let model = self.model(toss);
        if O::ACTIVE {
            model.show_flight(toss, &whole, found.duration, observer);
            let (dx, dy) = whole.drift(&toss.motion, found.duration);
            toss.place.shift(dx, dy);
        }
        self.land(toss, &found, turns);
        usage.time += found.duration;
        toss.place.time = usage.time;
        true
    }

    /// The first contact of the rim at the end `end` of the frame's axis (1: the lower one); `None` if the
    /// search was given up.
    fn contact_of(
        &self,
        toss: &Toss,
        end: f64,
        departure: Departure,
        whole: &Orbit<f64>,
    ) -> Option<RimContact> {
        let lower = if end > 0.0 {
            toss.heads_up
        } else {
            !toss.heads_up
        };
        let body = &self.models[usize::from(!lower)].dynamics.body;
        let rim = OneRim {
            radius: body.radius,
            half: body.half,
            end,
        };
        // of one rim only the opposite point may touch soon: the tilt's sine is what counts
        let sooner = Motion {
            cos: 1.0,
            ..toss.motion
        };
        let least = least_time(whole, &sooner, departure == Departure::LiftOff);
        let mut orbit = *whole;
        let found = first_contact(&mut orbit, &rim, departure, least);
        (!found.gave_up).then(|| RimContact {
            duration: orbit.since_start(found.time),
            time: found.time,
            orbit,
        })
    }

    /// Ends a flight with the contact of the frame's lower rim or, if it `turns`, of the other one.
    fn land(&self, toss: &mut Toss, found: &RimContact, turns: bool) {
        let axial_factor = self.model(toss).dynamics.axial_factor;
        let (motion, [nx, ny], folded) = found.orbit.at(&toss.motion, found.time);
        // ω_a is an integral of motion: see `flight_phase::land`
        let axial = toss.spin.axial * found.orbit.spin_left(found.time);
        toss.motion = motion;
        toss.spin = motion.spin(axial_factor);
        toss.spin.axial = if folded { -axial } else { axial };
        toss.heads_up ^= folded;
        toss.place.align(nx, ny);
        if folded != turns {
            toss.turn_over();
        }
        let Model { dynamics, .. } = self.model(toss);
        toss.motion.z = toss.motion.rest_height(&dynamics.body);
        toss.motion.set_spin(&toss.spin, axial_factor);
    }
}
