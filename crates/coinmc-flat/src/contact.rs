//! Sustained contact: the modes of a corner on the surface and what leads from one to the next.
//!
//! ```text
//!            ┌── cone reached ──▶
//!   sticking                      sliding ── slip reverses or stops ──▶ sticking or sliding
//!            ◀─── slip zero ────┘
//!   either ── force zero ──▶ flight        either ── next corner down ──▶ impact there
//!   sliding ── A → 0 (Painlevé) ──▶ tangential impact ──▶ sticking or flight
//! ```

use crate::contact_matrix::ContactMatrix;
use crate::motion::Motion;
use crate::observer_adapter::ObserverAdapter;
use crate::pivot::{PivotEnd, glide, stick, stuck_forces};
use crate::shape::Shape;
use crate::slide::{SlideEnd, SlidePhase, SlideTask};
use coinmc_core::{EventKind, Observer};
use coinmc_lanes::sin_cos;

/// Where the friction needed only grazes the cone, sticking sees it reached and sliding sees it
/// not left. A coin that gets nowhere this way is stuck for this angle, rad: the friction it needs
/// exceeds the cone by less than GRAZE² meanwhile.
const GRAZE: f64 = 1e-6;

/// How sustained contact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Leave {
    /// The contact force has vanished: flight.
    LiftOff,
    /// The next corner has come down onto the surface, with this motion.
    NextCorner,
    /// The face is certain.
    Certain,
    /// The coin stands on its corner, balanced and at rest.
    Balanced,
    /// Out of steps.
    Lost,
}

/// What sustained contact knows beside the motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hold {
    /// Slip of the corner; 0: at rest, may stick.
    slip: f64,
    /// It has got nowhere.
    stalled: bool,
    /// Angle before the mode, and whether the corner was at rest then.
    delta: f64,
    at_rest: bool,
}

impl Hold {
    /// The beginning, with this slip of the corner.
    pub(crate) fn new(slip: f64) -> Self {
        Self {
            slip,
            stalled: false,
            delta: 0.0,
            at_rest: false,
        }
    }
}

/// A corner that slides.
#[derive(Debug, Clone)]
pub(crate) struct Slider {
    hold: Hold,
    pub(crate) phase: SlidePhase,
}

/// What sustained contact has come to.
pub(crate) enum Poised {
    Slides(Hold),
    Leaves(Leave),
}

/// The laws in force and the counters of one toss.
pub(crate) struct Contact<'a> {
    pub(crate) shape: &'a Shape,
    pub(crate) mu: f64,
    pub(crate) tolerance: f64,
    pub(crate) max_steps: u32,
    pub(crate) steps: u32,
    pub(crate) jams: u32,
}

impl Contact<'_> {
    /// Whether energy alone settles the face: below m g D no balance over a corner is reached.
    /// Without friction the energy of horizontal motion can never come back.
    #[inline]
    pub(crate) fn is_certain(&self, motion: &Motion) -> bool {
        let k = self.shape.k;
        let energy = if self.mu == 0.0 {
            motion.energy_without_sliding(k)
        } else {
            motion.energy(k)
        };
        energy < 1.0
    }

    /// Follows sustained contact at the lowest corner until it slides, or the contact ends. The time
    /// of closed-form phases is filled in for an observer alone, who is told of every mode.
    pub(crate) fn poise<O: Observer>(
        &mut self,
        motion: &mut Motion,
        mut hold: Hold,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Poised {
        if self.is_certain(motion) {
            return Poised::Leaves(Leave::Certain);
        }
        if self.steps >= self.max_steps {
            return Poised::Leaves(Leave::Lost);
        }
        self.steps += 1;
        let (gap, at_end) = self.shape.gap(motion.quadrant, motion.delta);
        if gap <= 0.0 && motion.omega != 0.0 && (motion.omega > 0.0) == at_end {
            return Poised::Leaves(self.next_corner(motion));
        }
        (hold.delta, hold.at_rest) = (motion.delta, hold.slip == 0.0);
        if self.mu == 0.0 || (hold.at_rest && self.can_stick(motion, hold.stalled)) {
            if motion.omega == 0.0 && motion.delta == 0.0 {
                return Poised::Leaves(Leave::Balanced);
            }
            match self.pivot(motion, hold.stalled, adapter) {
                PivotEnd::Flat => return Poised::Leaves(self.next_corner(motion)),
                PivotEnd::LiftsOff => return Poised::Leaves(Leave::LiftOff),
                PivotEnd::Slips => {}
            }
        }
        if hold.slip == 0.0 {
            match self.slip_direction(motion) {
                Some(direction) => hold.slip = 0.0_f64.copysign(direction),
                None => return Poised::Leaves(Leave::LiftOff),
            }
        }
        adapter.event(EventKind::Sliding, motion);
        Poised::Slides(hold)
    }

    /// What follows a sliding phase: contact goes on so (`Ok`) or ends.
    pub(crate) fn slid(
        &mut self,
        motion: &mut Motion,
        slider: &Slider,
        end: SlideEnd,
    ) -> Result<Hold, Leave> {
        let mut hold = slider.hold;
        self.steps += slider.phase.steps;
        hold.slip = slider.phase.slip(end);
        match end {
            SlideEnd::Stops => {
                let turned = (motion.delta - hold.delta).abs();
                hold.stalled = hold.at_rest && turned < GRAZE;
            }
            SlideEnd::LiftsOff => return Err(Leave::LiftOff),
            SlideEnd::Flat => return Err(self.next_corner(motion)),
            SlideEnd::Jams => hold.slip = self.jam(motion, hold.slip),
            SlideEnd::Certain => return Err(Leave::Certain),
            SlideEnd::Lost => return Err(Leave::Lost),
        }
        Ok(hold)
    }

    /// A phase that conserves energy.
    fn pivot<O: Observer>(
        &self,
        motion: &mut Motion,
        stalled: bool,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> PivotEnd {
        let before = motion.energy(self.shape.k);
        adapter.event(self.conserving_mode(), motion);
        let end = if self.mu == 0.0 {
            glide(motion, self.shape, adapter)
        } else {
            let blind = if stalled { GRAZE } else { 0.0 };
            stick(motion, self.shape, self.mu, blind, adapter)
        };
        motion.cap_energy(self.shape.k, before);
        end
    }

    fn conserving_mode(&self) -> EventKind {
        if self.mu == 0.0 {
            EventKind::Sliding
        } else {
            EventKind::Sticking
        }
    }

    fn can_stick(&self, motion: &Motion, stalled: bool) -> bool {
        let (sin, cos) = sin_cos(motion.delta);
        let (normal, friction) = stuck_forces(sin, cos, motion.omega, self.shape.k);
        // the cone's edge belongs to sliding, lest both phases end at once
        normal > 0.0 && (stalled || friction.abs() < self.mu * normal)
    }

    /// The direction in which a corner at rest that cannot stick begins to slide: against the
    /// friction that sticking would need. `None` if nothing presses it down: the contact opens.
    ///
    /// Outside Painlevé's configurations exactly one of sticking, sliding either way and opening
    /// is consistent, so this is the one; at the edge of the cone, where sliding begins with
    /// zero acceleration, the sign of that acceleration would be rounding noise.
    fn slip_direction(&self, motion: &Motion) -> Option<f64> {
        let (sin, cos) = sin_cos(motion.delta);
        if motion.omega * motion.omega * cos >= 1.0 {
            return None;
        }
        let (_, friction) = stuck_forces(sin, cos, motion.omega, self.shape.k);
        Some(-1.0_f64.copysign(friction))
    }

    /// The sliding phase that begins here.
    pub(crate) fn slider(&self, motion: &Motion, hold: Hold) -> Slider {
        let task = SlideTask {
            shape: self.shape,
            mu: self.mu,
            slip: hold.slip,
            tolerance: self.tolerance,
            max_steps: self.max_steps - self.steps,
        };
        Slider {
            hold,
            phase: SlidePhase::new(motion, &task),
        }
    }

    /// Painlevé's configuration: no finite force lets the corner go on sliding (A <= 0), so it is
    /// stopped by an impulse, an impact without collision (Lecornu 1905; Génot & Brogliato 1999).
    /// p = K⁻¹(−γ, 0) has p_z = K_xz γ/det K > 0 and needs the friction K_zz/|K_xz| <= μ, which
    /// is A <= 0 itself; it takes γ²/(2(K⁻¹)_xx) of energy.
    fn jam(&mut self, motion: &mut Motion, slip: f64) -> f64 {
        self.jams += 1;
        let (sin, cos) = sin_cos(motion.delta);
        let matrix = ContactMatrix::new(sin, cos, self.shape.k);
        let (x, z) = matrix.solve(-slip, 0.0);
        let omega = motion.omega + (sin * z - cos * x) / self.shape.k;
        motion.set_on_corner(sin, cos, omega, 0.0);
        0.0
    }

    fn next_corner(&self, motion: &mut Motion) -> Leave {
        let forwards = motion.delta > 0.0;
        motion.cross_flat(self.shape, forwards);
        Leave::NextCorner
    }
}
