//! Sustained contact: the modes of a corner on the surface and the transitions between them.
//!
//! ```text
//!            ┌── cone reached ──▶
//!   sticking                      sliding ── slip reverses or stops ──▶ sticking or sliding
//!            ◀─── slip zero ────┘
//!   either ── force zero ──▶ flight        either ── next corner down ──▶ impact there
//!   sliding ── A → 0 (Painlevé) ──▶ tangential impact ──▶ sticking or flight
//! ```

use crate::contact_matrix::ContactMatrix;
use crate::counters::Counters;
use crate::dead_contact::DeadContact;
use crate::decision::decided_by_energy;
use crate::motion::Motion;
use crate::observer_adapter::ObserverAdapter;
use crate::pivot::{PivotEnd, slide_without_friction, stick, sticking_forces};
use crate::shape::Shape;
use crate::slide::{SlideEnd, SlidePhase, SlideStart};
use coinmc_core::{EventKind, Observer};
use coinmc_lanes::sin_cos;

/// Where the friction needed only grazes the cone, sticking finds the cone reached and sliding
/// finds that it is not left. A coin that stalls between the two is held sticking over this angle,
/// rad: meanwhile the friction it needs exceeds the cone by less than GRAZE².
const GRAZE: f64 = 1e-6;

/// How sustained contact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ContactEnd {
    /// The contact force has vanished: flight.
    LiftOff,
    /// The next corner has come down onto the surface; the motion is that of this corner.
    NextCorner,
    /// Energy decides the face.
    Decided,
    /// The coin stands on its corner, balanced and at rest.
    Balanced,
    OutOfSteps,
}

/// The state of sustained contact, beside the motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactState {
    /// Slip velocity of the corner; at 0 it may stick.
    slip: f64,
    /// The last sliding phase began at rest and ended at rest almost at once.
    stalled: bool,
    /// Angle at which the present mode began.
    start_delta: f64,
    /// Whether the corner was at rest then.
    started_at_rest: bool,
}

impl ContactState {
    /// Contact that begins with this slip of the corner.
    pub(crate) fn new(slip: f64) -> Self {
        Self {
            slip,
            stalled: false,
            start_delta: 0.0,
            started_at_rest: false,
        }
    }
}

/// A sliding phase, and the state of the contact at its start.
#[derive(Debug, Clone)]
pub(crate) struct SlidingContact {
    state: ContactState,
    pub(crate) phase: SlidePhase,
}

/// What sustained contact has led to.
pub(crate) enum ContactStep {
    /// A sliding phase begins.
    Slide(ContactState),
    End(ContactEnd),
}

/// The parameters of sustained contact.
#[derive(Debug, Clone)]
pub(crate) struct ContactParameters {
    pub(crate) shape: Shape,
    pub(crate) friction: f64,
    /// The decision on a coin in contact.
    pub(crate) dead: DeadContact,
    pub(crate) tolerance: f64,
    pub(crate) max_steps: u32,
}

impl ContactParameters {
    /// Whether energy alone decides the face.
    #[inline]
    pub(crate) fn is_decided(&self, motion: &Motion) -> bool {
        let without_sliding = motion.energy_without_sliding(self.shape.k);
        decided_by_energy(self.friction, without_sliding, motion.vx)
    }

    /// Advances sustained contact at the lowest corner until it slides or ends. Only an observer
    /// needs the time that the closed-form phases take, and is shown each mode.
    pub(crate) fn advance<O: Observer>(
        &self,
        motion: &mut Motion,
        counters: &mut Counters,
        mut state: ContactState,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> ContactStep {
        if self.is_decided(motion) || self.dead.decides(motion, self.shape.k) {
            return ContactStep::End(ContactEnd::Decided);
        }
        if counters.contact_steps >= self.max_steps {
            return ContactStep::End(ContactEnd::OutOfSteps);
        }
        counters.contact_steps += 1;
        let (gap, at_end) = self.shape.gap(motion.quadrant, motion.delta);
        if gap <= 0.0 && motion.omega != 0.0 && (motion.omega > 0.0) == at_end {
            return ContactStep::End(self.next_corner(motion));
        }
        (state.start_delta, state.started_at_rest) = (motion.delta, state.slip == 0.0);
        let sticks = || state.started_at_rest && self.can_stick(motion, state.stalled);
        if (self.friction == 0.0 || sticks())
            && let Some(end) = self.pivot(motion, state.stalled, adapter)
        {
            return ContactStep::End(end);
        }
        if state.slip == 0.0 {
            match self.slip_direction(motion) {
                Some(direction) => state.slip = 0.0_f64.copysign(direction),
                None => return ContactStep::End(ContactEnd::LiftOff),
            }
        }
        adapter.event(EventKind::Sliding, motion);
        ContactStep::Slide(state)
    }

    /// The state after a sliding phase.
    ///
    /// # Errors
    /// The end of the contact, if the phase has ended it.
    pub(crate) fn after_sliding(
        &self,
        motion: &mut Motion,
        counters: &mut Counters,
        sliding: &SlidingContact,
        end: SlideEnd,
    ) -> Result<ContactState, ContactEnd> {
        let mut state = sliding.state;
        counters.contact_steps += sliding.phase.steps;
        state.slip = sliding.phase.slip(end);
        match end {
            SlideEnd::Stops => {
                let turned = (motion.delta - state.start_delta).abs();
                state.stalled = state.started_at_rest && turned < GRAZE;
            }
            SlideEnd::LiftsOff => return Err(ContactEnd::LiftOff),
            SlideEnd::Flat => return Err(self.next_corner(motion)),
            SlideEnd::Jams => {
                counters.jams += 1;
                self.stop_jammed(motion, state.slip);
                state.slip = 0.0;
            }
            SlideEnd::Decided => return Err(ContactEnd::Decided),
            SlideEnd::OutOfSteps => return Err(ContactEnd::OutOfSteps),
        }
        Ok(state)
    }

    /// The sliding phase that begins here.
    pub(crate) fn slide(
        &self,
        motion: &Motion,
        counters: &Counters,
        state: ContactState,
    ) -> SlidingContact {
        let start = SlideStart {
            shape: &self.shape,
            friction: self.friction,
            dead: self.dead,
            slip: state.slip,
            tolerance: self.tolerance,
            max_steps: self.max_steps - counters.contact_steps,
        };
        SlidingContact {
            state,
            phase: SlidePhase::new(motion, &start),
        }
    }

    /// Follows a phase that conserves energy; `None` if the contact then slides.
    fn pivot<O: Observer>(
        &self,
        motion: &mut Motion,
        stalled: bool,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Option<ContactEnd> {
        if motion.omega == 0.0 && motion.delta == 0.0 {
            return Some(ContactEnd::Balanced);
        }
        let before = motion.energy(self.shape.k);
        let end = if self.friction == 0.0 {
            adapter.event(EventKind::Sliding, motion);
            slide_without_friction(motion, &self.shape, adapter)
        } else {
            adapter.event(EventKind::Sticking, motion);
            let unchecked = if stalled { GRAZE } else { 0.0 };
            stick(motion, &self.shape, self.friction, unchecked, adapter)
        };
        motion.cap_energy(self.shape.k, before);
        match end {
            PivotEnd::Flat => Some(self.next_corner(motion)),
            PivotEnd::LiftsOff => Some(ContactEnd::LiftOff),
            PivotEnd::Slips => None,
        }
    }

    fn can_stick(&self, motion: &Motion, stalled: bool) -> bool {
        let (sin, cos) = sin_cos(motion.delta);
        let (normal, friction) = sticking_forces(sin, cos, motion.omega, self.shape.k);
        // the edge of the cone belongs to sliding, lest both phases end at once
        normal > 0.0 && (stalled || friction.abs() < self.friction * normal)
    }

    /// The direction in which a corner at rest that cannot stick begins to slide: against the
    /// friction that sticking would need. `None` if nothing presses it down: the contact opens.
    ///
    /// Outside Painlevé's configurations exactly one of sticking, sliding either way and opening
    /// is consistent, so this is the one. The sign of the acceleration would not do: at the edge of
    /// the cone sliding begins with zero acceleration, and its sign is rounding noise.
    fn slip_direction(&self, motion: &Motion) -> Option<f64> {
        let (sin, cos) = sin_cos(motion.delta);
        if motion.omega * motion.omega * cos >= 1.0 {
            return None;
        }
        let (_, friction) = sticking_forces(sin, cos, motion.omega, self.shape.k);
        Some(-1.0_f64.copysign(friction))
    }

    /// Painlevé's configuration: no finite force lets the corner keep sliding (A <= 0), so an
    /// impulse stops it, an impact without collision (Lecornu 1905; Génot & Brogliato 1999).
    /// p = K⁻¹(−γ, 0) has p_z = K_xz γ/det K > 0 and needs the friction K_zz/|K_xz| <= μ, which
    /// is A <= 0 itself; it takes γ²/(2(K⁻¹)_xx) of energy.
    fn stop_jammed(&self, motion: &mut Motion, slip: f64) {
        let (sin, cos) = sin_cos(motion.delta);
        let matrix = ContactMatrix::new(sin, cos, self.shape.k);
        let (x, z) = matrix.solve(-slip, 0.0);
        let omega = motion.omega + (sin * z - cos * x) / self.shape.k;
        motion.set_on_corner(sin, cos, omega, 0.0);
    }

    fn next_corner(&self, motion: &mut Motion) -> ContactEnd {
        let forwards = motion.delta > 0.0;
        motion.cross_flat(&self.shape, forwards);
        ContactEnd::NextCorner
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::FlatEngine;
    use crate::laws::moreau::Moreau;
    use crate::motion::tests::on_corner;
    use crate::settings::Settings;
    use coinmc_testkit::scene;

    fn contact(mu: f64) -> ContactParameters {
        let scene = scene(1.0, 0.0, mu);
        let engine = FlatEngine::new(&scene, &Settings::default(), Moreau).expect("valid");
        engine.parameters.contact
    }

    fn turning(delta: f64, omega: f64) -> Motion {
        on_corner(0, delta, omega, 0.0)
    }

    /// A coin at rest that leans on its corner pulls with s c/(1 + k) and presses with 1 − s²/(1 + k).
    #[test]
    fn a_leaning_coin_sticks_if_friction_suffices() {
        let delta = 0.4;
        let (sin, cos) = sin_cos(delta);
        let k = contact(0.1).shape.k;
        let needed = sin * cos / (1.0 + k - sin * sin);
        for sign in [1.0, -1.0] {
            let motion = turning(sign * delta, 0.0);
            assert!(contact(1.001 * needed).can_stick(&motion, false));
            assert!(!contact(0.999 * needed).can_stick(&motion, false));
            // held where it has stalled
            assert!(contact(0.999 * needed).can_stick(&motion, true));
        }
        // nothing holds a corner that leaves
        assert!(!contact(10.0).can_stick(&turning(delta, 2.0), true));
    }

    /// A corner at rest opens where its own turning lifts it, ω² cos δ >= 1; else friction pulls a leaning
    /// coin's corner back from the side to which the centre leans, and without it the corner slides off there.
    #[test]
    fn a_corner_at_rest_slides_away_from_the_lean_or_opens() {
        let contact = contact(0.01);
        let (_, cos) = sin_cos(0.4);
        for sign in [1.0, -1.0] {
            let away = contact.slip_direction(&turning(sign * 0.4, 0.0));
            assert_eq!(away, Some(-sign));
            let critical = 1.0 / cos.sqrt();
            let slower = turning(sign * 0.4, 0.999 * critical);
            assert!(contact.slip_direction(&slower).is_some());
            let faster = turning(sign * 0.4, 1.001 * critical);
            assert_eq!(contact.slip_direction(&faster), None);
        }
    }

    /// An impulse at the corner leaves the angular momentum about it, and stops it.
    #[test]
    fn a_jammed_corner_stops_and_keeps_its_angular_momentum() {
        let contact = contact(3.0);
        let k = contact.shape.k;
        for (delta, slip) in [(0.3, -0.7), (-0.5, 0.4), (0.6, 1.3)] {
            let (sin, cos) = sin_cos(delta);
            let mut motion = turning(delta, -0.2);
            motion.set_on_corner(sin, cos, -0.2, slip);
            let momentum = |m: &Motion| k * m.omega + cos * m.vx - sin * m.vz;
            let before = momentum(&motion);
            contact.stop_jammed(&mut motion, slip);
            assert!((momentum(&motion) - before).abs() < 1e-14);
            assert!((motion.vx - motion.omega * cos).abs() < 1e-15);
            assert!((motion.vz + motion.omega * sin).abs() < 1e-15);
        }
    }

    /// What is left of the steps bounds a sliding phase.
    #[test]
    fn sliding_gives_up_after_the_steps_that_are_left() {
        let contact = ContactParameters {
            max_steps: 7,
            tolerance: 1e-12,
            dead: DeadContact::NONE,
            ..contact(0.3)
        };
        let counters = Counters {
            contact_steps: 5,
            ..Counters::default()
        };
        // far from every event for many steps
        let mut motion = turning(-0.4, 0.9);
        let (sin, cos) = sin_cos(motion.delta);
        motion.set_on_corner(sin, cos, 0.9, 50.0);
        let mut sliding = contact.slide(&motion, &counters, ContactState::new(50.0));
        let scene = scene(1.0, 0.0, 0.3);
        let engine = FlatEngine::new(&scene, &Settings::default(), Moreau).expect("valid");
        let mut unobserved = ();
        let mut adapter = engine.parameters.adapter(&mut unobserved);
        let end = sliding.phase.run(&mut motion, &mut adapter);
        assert_eq!((end, sliding.phase.steps), (SlideEnd::OutOfSteps, 2));
    }

    /// Only a coin at rest right above its corner stays there; one that leans at rest falls on, and one that turns
    /// passes its balance.
    #[test]
    fn only_a_coin_at_rest_on_its_corner_is_balanced() {
        for mu in [0.0, 3.0] {
            let scene = scene(1.0, 0.0, mu);
            let engine = FlatEngine::new(&scene, &Settings::default(), Moreau).expect("valid");
            let balanced = |delta, omega| {
                let mut unobserved = ();
                let mut adapter = engine.parameters.adapter(&mut unobserved);
                let end = contact(mu).pivot(&mut turning(delta, omega), false, &mut adapter);
                matches!(end, Some(ContactEnd::Balanced))
            };
            assert!(balanced(0.0, 0.0), "{mu}");
            for (delta, omega) in [(0.3, 0.0), (-0.3, 0.0), (0.0, 0.1), (0.3, 0.1)] {
                assert!(!balanced(delta, omega), "{mu}: {delta} {omega}");
            }
        }
    }
}
