//! The toss in flight: to the next contact, and at the instants before it that an observer wants.

use crate::contact::Contact;
use crate::engine::VolumetricEngine;
use crate::flight::{Departure, Orbit, first_contact};
use crate::impact::ImpactLaw;
use crate::toss::Toss;
use coinmc_core::{Observer, sample_between};

/// A short time against every motion of the coin, times its fastest rate: a point that parts from
/// the surface by acceleration is followed from there.
const PARTING: f64 = 1e-4;
/// The same for one that was thrown back.
const THROWN: f64 = 1e-12;
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
        let least = if parting { PARTING } else { THROWN } / orbit.fastest(&toss.motion);
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
        let (motion, [nx, ny], reflected) = orbit.land(&toss.motion, &law.body, found.time);
        toss.motion = motion;
        // ω_a is the integral of motion that rounding of u would blur: it is I_t/I_a times Ω_a
        let axial = toss.spin.axial * orbit.spin_left(found.time);
        toss.spin = motion.spin(law.axial_factor);
        toss.spin.axial = if reflected { -axial } else { axial };
        toss.motion.set_spin(&toss.spin, law.axial_factor);
        toss.heads_up ^= reflected;
        contact.time += took;
        if O::ACTIVE {
            toss.place.align(nx, ny);
            toss.place.time = contact.time;
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
