//! When the face of a toss is decided.

use crate::motion::Motion;
use crate::settings::Decision;
use crate::shape::Shape;
use coinmc_core::{Ended, Face};
use coinmc_lanes::Lane;

/// Whether energy alone decides the face: below m g D no balance over a corner can be reached.
/// Without friction the energy of horizontal motion cannot come back, so it does not count.
#[inline(always)]
pub(crate) fn decided_by_energy<L: Lane>(
    friction: f64,
    energy_without_sliding: L,
    vx: L,
) -> L::Mask {
    let energy = if friction == 0.0 {
        energy_without_sliding
    } else {
        energy_without_sliding + L::splat(0.5) * vx * vx
    };
    energy.lt(L::splat(1.0))
}

/// Ends the toss with the face on which the coin comes to rest from the well it is in.
pub(crate) fn decided(motion: &Motion) -> Ended {
    Ended::Decided(Shape::face(motion.quadrant, motion.delta))
}

/// The decision by a fraction of the initial energy, which may come before the decision by energy
/// alone.
pub(crate) struct EarlyDecision {
    /// Energy at which it is made.
    threshold: f64,
    face: Option<Face>,
}

impl EarlyDecision {
    /// No early decision.
    pub(crate) fn disabled() -> Self {
        Self {
            threshold: f64::NEG_INFINITY,
            face: None,
        }
    }

    pub(crate) fn new(decision: Decision, initial_energy: f64) -> Self {
        match decision {
            Decision::Energy => Self::disabled(),
            Decision::EnergyFraction(fraction) => Self {
                threshold: fraction * initial_energy,
                face: None,
            },
        }
    }

    /// Decides if the energy has fallen to the threshold.
    #[inline]
    pub(crate) fn check(&mut self, motion: &Motion, k: f64) {
        if self.threshold > 0.0 && self.face.is_none() && motion.energy(k) <= self.threshold {
            self.face = Some(Shape::face(motion.quadrant, motion.delta));
        }
    }

    /// The face, if it was decided early.
    pub(crate) fn face(&self) -> Option<Face> {
        self.face
    }
}
