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

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::body::Body;
    use crate::settings::Settings;
    use crate::toss::tests::{agree, generic_scene, launch, model, model_of};
    use coinmc_core::State;
    use coinmc_testkit::Dice;
    use nalgebra::{Rotation3, UnitVector3, Vector3};

    /// Height of the lowest point of the coin, a time `t` into the flight that begins with `start`.
    pub(crate) fn height_of_rim(
        orbit: &Orbit<f64>,
        start: &Motion<f64>,
        body: &Body,
        t: f64,
    ) -> f64 {
        let (motion, _, _) = orbit.at(start, t);
        orbit.fall(t).0 - motion.rest_height(body)
    }

    /// Between two contacts an observer sees the coin where Euler's equations of a symmetric body take it: its axis
    /// turns about the angular momentum at the rate L/I_t, its spin is L/I_t + (1 − I_a/I_t) ω_a u, and its
    /// centre falls.
    #[test]
    fn a_coin_in_flight_turns_about_its_angular_momentum() {
        let model = model();
        // of a cylinder with H/R = .4
        let ratio_of_moments = 0.5 / ((3.0 + 0.4 * 0.4) / 12.0);
        let mut seen_reflected = 0;
        for number in 0..200 {
            let mut dice = Dice::new(517, number);
            let launched = launch(&mut dice, None);
            let toss = model.launch(&launched);
            let orbit = Orbit::new(&toss.motion, model.dynamics.drag);
            let t_s = dice.between(0.0, 0.1);
            let seen = model.in_flight(&toss, &orbit, t_s / model.units.time_s);
            seen_reflected += i32::from(seen.heads_up != toss.heads_up);

            let axis = launched.axis.into_inner();
            let axial = launched.spin_rad_s.dot(&axis) * (1.0 - ratio_of_moments);
            let steady = launched.spin_rad_s - axis * axial;
            let turned = Rotation3::new(steady * t_s) * axis;
            let fall = Vector3::new(0.0, 0.0, -9.81 * t_s);
            let mut position_m = (launched.velocity_m_s + fall * 0.5) * t_s;
            position_m.z += launched.height_m;
            let expected = State {
                time_s: 0.0,
                position_m,
                velocity_m_s: launched.velocity_m_s + fall,
                axis: UnitVector3::new_normalize(turned),
                spin_rad_s: steady + turned * axial,
            };
            agree(&seen.state(&model.units), &expected, 1e-11);
        }
        assert!(seen_reflected > 20);
    }

    /// A flight ends when the lowest point of the coin touches, and not before or after: at 2,000 instants before it
    /// the coin is clear of the surface.
    #[test]
    fn a_flight_ends_at_the_first_contact() {
        let model = model();
        let body = &model.dynamics.body;
        for number in 0..300 {
            let toss = model.launch(&launch(&mut Dice::new(523, number), None));
            let mut orbit = Orbit::new(&toss.motion, model.dynamics.drag);
            let least = least_time(&orbit, &toss.motion, false);
            let whole = orbit;
            let gap = |t: f64| height_of_rim(&whole, &toss.motion, body, t);
            let found = first_contact(&mut orbit, body, Departure::Launched, least);
            let end = orbit.since_start(found.time);
            assert!(!found.gave_up && gap(end).abs() < 1e-12, "{}", gap(end));
            let clear = (0..2_000).all(|i| gap(end * f64::from(i) / 2_000.0) > 0.0);
            assert!(clear);
        }
    }

    /// In a flight with drag the angular momentum keeps its direction and falls exponentially at its rate, whichever
    /// face is up; so does the horizontal velocity at its own.
    #[test]
    fn drag_takes_angular_momentum_at_its_rate() {
        let scene = generic_scene(|plane| plane);
        let model = model_of(&scene, &Settings::default());
        let (axial, transverse) = (
            scene.coin.axial_gyration_m2(),
            scene.coin.transverse_gyration_m2(),
        );
        let momentum = |state: &State| {
            let axis = state.axis.into_inner();
            let along = axis * state.spin_rad_s.dot(&axis);
            along * axial + (state.spin_rad_s - along) * transverse
        };
        let mut seen_reflected = 0;
        for number in 0..100 {
            let mut dice = Dice::new(545, number);
            let toss = model.launch(&launch(&mut dice, None));
            let orbit = Orbit::new(&toss.motion, model.dynamics.drag);
            let t_s = dice.between(0.05, 0.4);
            let seen = model.in_flight(&toss, &orbit, t_s / model.units.time_s);
            seen_reflected += i32::from(seen.heads_up != toss.heads_up);
            let [before, after] = [&toss, &seen].map(|toss| toss.state(&model.units));
            let expected = momentum(&before) * libm::exp(-1.3 * t_s);
            let off = (momentum(&after) - expected).norm() / expected.norm();
            assert!(off < 1e-11, "{off:e}");
            let expected = before.velocity_m_s.xy() * libm::exp(-0.8 * t_s);
            assert!((after.velocity_m_s.xy() - expected).norm() < 1e-12);
        }
        assert!(seen_reflected > 20);
    }
}
