//! A toss in flight, up to its next contact; and, for an observer, at the instants before it.

use crate::contact::{Dynamics, Usage};
use crate::flight::{Departure, Orbit, first_contact, least_time};
use crate::model::Model;
use crate::motion::{Motion, Spin};
use crate::toss::Toss;
use coinmc_core::{Observer, sample_between};
use coinmc_lanes::Lane;

/// The coin at the end of a flight.
pub(crate) struct Landed<L: Lane> {
    pub(crate) motion: Motion<L>,
    pub(crate) spin: Spin<L>,
    /// The x axis of the new folded frame, in the frame of the flight.
    heading: [L; 2],
    /// Whether the other face points up now.
    pub(crate) reflected: L::Mask,
}

/// Ends a flight at time `time` of its orbit. The flight began with `motion` and the axial angular
/// velocity `axial`.
#[inline(always)]
pub(crate) fn land<L: Lane>(
    dynamics: &Dynamics,
    orbit: &Orbit<L>,
    motion: &Motion<L>,
    axial: L,
    time: L,
) -> Landed<L> {
    let (mut motion, heading, reflected) = orbit.land(motion, &dynamics.body, time);
    // ω_a is an integral of motion: taken from the launch it is free of the rounding of u, which
    // would enter Ω_a multiplied by I_t/I_a
    let axial = axial * orbit.spin_left(time);
    let mut spin = motion.spin(dynamics.axial_factor);
    spin.axial = L::select(reflected, -axial, axial);
    motion.set_spin(&spin, dynamics.axial_factor);
    Landed {
        motion,
        spin,
        heading,
        reflected,
    }
}

impl<L> Model<L> {
    /// Flies to the next contact. Returns `false` if the search for it was given up.
    #[inline]
    pub(crate) fn fly<O: Observer>(
        &self,
        toss: &mut Toss,
        usage: &mut Usage,
        departure: Departure,
        observer: &mut O,
    ) -> bool {
        let dynamics = &self.dynamics;
        let mut orbit = Orbit::new(&toss.motion, dynamics.drag);
        let lifts_off = departure == Departure::LiftOff;
        let least = least_time(&orbit, &toss.motion, lifts_off);
        let whole = orbit;
        let found = first_contact(&mut orbit, &dynamics.body, departure, least);
        if found.gave_up {
            return false;
        }
        let duration = orbit.since_start(found.time);
        let mut motion = toss.motion;
        if O::ACTIVE {
            self.show_flight(toss, &whole, duration, observer);
            let ([dx, dy], pulled) = self.glide(toss, &orbit, duration);
            toss.place.shift(dx, dy);
            motion = pulled;
        }
        let landed = land(dynamics, &orbit, &motion, toss.spin.axial, found.time);
        (toss.motion, toss.spin) = (landed.motion, landed.spin);
        toss.heads_up ^= landed.reflected;
        usage.time += duration;
        if O::ACTIVE {
            let [nx, ny] = landed.heading;
            toss.place.align(nx, ny);
            toss.place.time = usage.time;
        }
        true
    }

    /// The way of the centre along the ground in a flight of time `t` that begins with `toss`, in the
    /// frame of the departure; and the motion from which `orbit` leads to the motion after it: that of
    /// `toss`, but for the pull of a tilted table.
    pub(crate) fn glide(&self, toss: &Toss, orbit: &Orbit<f64>, t: f64) -> ([f64; 2], Motion<f64>) {
        let (dx, dy) = orbit.drift(&toss.motion, t);
        let Some(pull) = &self.pull else {
            return ([dx, dy], toss.motion);
        };
        let ([px, py], motion) = pull.in_flight(&toss.place, &self.dynamics.drag, &toss.motion, t);
        ([dx + px, dy + py], motion)
    }

    /// Shows a flight of length `duration`, which begins with `toss`, at the requested instants.
    pub(crate) fn show_flight<O: Observer>(
        &self,
        toss: &Toss,
        orbit: &Orbit<f64>,
        duration: f64,
        observer: &mut O,
    ) {
        let unit = self.units.time_s;
        let start = toss.place.time;
        sample_between(
            observer,
            start * unit,
            (start + duration) * unit,
            |time_s| {
                // converting to seconds and back may round to just outside the flight
                let after = (time_s / unit - start).clamp(0.0, duration);
                let mut state = self.in_flight(toss, orbit, after).state(&self.units);
                state.time_s = time_s;
                state
            },
        );
    }

    /// The toss a time `t` into the flight that begins with `toss`.
    fn in_flight(&self, toss: &Toss, orbit: &Orbit<f64>, t: f64) -> Toss {
        let axial_factor = self.dynamics.axial_factor;
        let ([dx, dy], pulled) = self.glide(toss, orbit, t);
        let (motion, [nx, ny], reflected) = orbit.at(&pulled, t);
        let mut after = Toss { motion, ..*toss };
        after.place.shift(dx, dy);
        after.place.align(nx, ny);
        // as at the landing: the initial axial spin, less what drag took of it
        let axial = toss.spin.axial * orbit.spin_left(t);
        after.spin = motion.spin(axial_factor);
        after.spin.axial = if reflected { -axial } else { axial };
        after.heads_up ^= reflected;
        after
    }
}
