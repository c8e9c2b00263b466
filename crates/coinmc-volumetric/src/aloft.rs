//! The toss in flight: to the next contact, and at the instants before it that an observer wants.

use crate::contact::{Contact, Law};
use crate::engine::VolumetricEngine;
use crate::flight::{Departure, Orbit, first_contact, least_time};
use crate::impact::ImpactLaw;
use crate::motion::{Motion, Spin};
use crate::toss::Toss;
use coinmc_core::{Observer, sample_between};
use coinmc_lanes::Lane;

/// The coin where a flight has ended.
pub(crate) struct Landed<L: Lane> {
    pub(crate) motion: Motion<L>,
    pub(crate) spin: Spin<L>,
    /// The new frame's x axis in that of the flight.
    heading: [L; 2],
    /// The other face is up.
    pub(crate) reflected: L::Mask,
}

/// The end, at `time` of the orbit, of a flight that began with `motion` and the axial spin
/// `axial`.
#[inline(always)]
pub(crate) fn land<L: Lane>(
    law: &Law,
    orbit: &Orbit<L>,
    motion: &Motion<L>,
    axial: L,
    time: L,
) -> Landed<L> {
    let (mut motion, heading, reflected) = orbit.land(motion, &law.body, time);
    // ω_a is the integral of motion that rounding of u would blur: it is I_t/I_a times Ω_a
    let axial = axial * orbit.spin_left(time);
    let mut spin = motion.spin(law.axial_factor);
    spin.axial = L::select(reflected, -axial, axial);
    motion.set_spin(&spin, law.axial_factor);
    Landed {
        motion,
        spin,
        heading,
        reflected,
    }
}

impl<L: ImpactLaw> VolumetricEngine<L> {
    /// Flies to the next contact; `false` if the search for it was lost.
    #[inline]
    pub(crate) fn fly<O: Observer>(
        &self,
        toss: &mut Toss,
        contact: &mut Contact<'_>,
        departure: Departure,
        parting: bool,
        observer: &mut O,
    ) -> bool {
        let law = &self.contact;
        let mut orbit = Orbit::new(&toss.motion, law.drag);
        let least = least_time(&orbit, &toss.motion, parting);
        let whole = orbit;
        let found = first_contact(&mut orbit, &law.body, departure, least);
        if found.lost {
            return false;
        }
        let took = orbit.since_start(found.time);
        if O::ACTIVE {
            self.show_flight(toss, &whole, took, observer);
        }
        if O::ACTIVE {
            let (dx, dy) = orbit.drift(&toss.motion, took);
            toss.place.shift(dx, dy);
        }
        let landed = land(law, &orbit, &toss.motion, toss.spin.axial, found.time);
        (toss.motion, toss.spin) = (landed.motion, landed.spin);
        toss.heads_up ^= landed.reflected;
        contact.spent.time += took;
        if O::ACTIVE {
            let [nx, ny] = landed.heading;
            toss.place.align(nx, ny);
            toss.place.time = contact.spent.time;
        }
        true
    }

    /// Shows a flight of length `took` that begins with `toss` at the instants asked for.
    fn show_flight<O: Observer>(
        &self,
        toss: &Toss,
        orbit: &Orbit<f64>,
        took: f64,
        observer: &mut O,
    ) {
        let unit = self.units.time_s;
        let start = toss.place.time;
        sample_between(observer, start * unit, (start + took) * unit, |time_s| {
            // the two roundings of the unit may lead just beyond
            let after = (time_s / unit - start).clamp(0.0, took);
            let mut state = self.flown(toss, orbit, after).state(&self.units);
            state.time_s = time_s;
            state
        });
    }

    /// The toss after a flight of `t`.
    fn flown(&self, toss: &Toss, orbit: &Orbit<f64>, t: f64) -> Toss {
        let law = &self.contact;
        let (motion, [nx, ny], reflected) = orbit.at(&toss.motion, t);
        let mut after = Toss { motion, ..*toss };
        let (dx, dy) = orbit.drift(&toss.motion, t);
        after.place.shift(dx, dy);
        after.place.align(nx, ny);
        // as where the flight ends: the axial spin is what drag left of it
        let axial = toss.spin.axial * orbit.spin_left(t);
        after.spin = motion.spin(law.axial_factor);
        after.spin.axial = if reflected { -axial } else { axial };
        after.heads_up ^= reflected;
        after
    }
}
