//! Sustained contact: the modes of a corner on the surface and what leads from one to the next.
//!
//! ```text
//!            ┌── cone reached ──▶
//!   sticking                      sliding ── slip reverses or stops ──▶ sticking or sliding
//!            ◀─── slip zero ────┘
//!   either ── force zero ──▶ flight        either ── next corner down ──▶ impact there
//!   sliding ── A → 0 (Painlevé) ──▶ tangential impact ──▶ sticking or flight
//! ```

use crate::impact::ContactMatrix;
use crate::motion::Motion;
use crate::pivot::{PivotEnd, glide, stick, stuck_forces};
use crate::shape::Shape;
use crate::slide::{SlideEnd, SlideTask, slide};
use crate::watch::Watch;
use coinmc_core::trig::sin_cos;
use coinmc_core::{EventKind, Observer};

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

    /// Follows sustained contact at the lowest corner, which slides at `slip` (0: at rest, may
    /// stick). The time of closed-form phases is filled in for an observer alone, who is told of
    /// every mode.
    pub(crate) fn follow<O: Observer>(
        &mut self,
        motion: &mut Motion,
        mut slip: f64,
        watch: &mut Watch<'_, O>,
    ) -> Leave {
        let mut stalled = false;
        loop {
            if self.is_certain(motion) {
                return Leave::Certain;
            }
            if self.steps >= self.max_steps {
                return Leave::Lost;
            }
            self.steps += 1;
            let (gap, at_end) = self.shape.gap(motion.quadrant, motion.delta);
            if gap <= 0.0 && motion.omega != 0.0 && (motion.omega > 0.0) == at_end {
                return self.next_corner(motion);
            }
            let before = motion.energy(self.shape.k);
            let (delta, at_rest) = (motion.delta, slip == 0.0);
            if self.mu == 0.0 || (slip == 0.0 && self.can_stick(motion, stalled)) {
                if motion.omega == 0.0 && motion.delta == 0.0 {
                    return Leave::Balanced;
                }
                watch.event(self.conserving_mode(), motion);
                let end = if self.mu == 0.0 {
                    glide(motion, self.shape, watch)
                } else {
                    let blind = if stalled { GRAZE } else { 0.0 };
                    stick(motion, self.shape, self.mu, blind, watch)
                };
                motion.cap_energy(self.shape.k, before);
                match end {
                    PivotEnd::Flat => return self.next_corner(motion),
                    PivotEnd::LiftsOff => return Leave::LiftOff,
                    PivotEnd::Slips => {}
                }
            }
            if slip == 0.0 {
                match self.slip_direction(motion) {
                    Some(direction) => slip = 0.0_f64.copysign(direction),
                    None => return Leave::LiftOff,
                }
            }
            watch.event(EventKind::Sliding, motion);
            let (end, slip_after) = self.slide(motion, slip, watch);
            slip = slip_after;
            match end {
                SlideEnd::Stops => {
                    slip = 0.0;
                    stalled = at_rest && (motion.delta - delta).abs() < GRAZE;
                }
                SlideEnd::LiftsOff => return Leave::LiftOff,
                SlideEnd::Flat => return self.next_corner(motion),
                SlideEnd::Jams => slip = self.jam(motion, slip),
                SlideEnd::Certain => return Leave::Certain,
                SlideEnd::Lost => return Leave::Lost,
            }
        }
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

    fn slide<O: Observer>(
        &mut self,
        motion: &mut Motion,
        slip: f64,
        watch: &mut Watch<'_, O>,
    ) -> (SlideEnd, f64) {
        let task = SlideTask {
            shape: self.shape,
            mu: self.mu,
            slip,
            tolerance: self.tolerance,
            max_steps: self.max_steps - self.steps,
        };
        let (end, slip, steps) = slide(motion, &task, watch);
        self.steps += steps;
        (end, slip)
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
