//! The coin that stands on one point of its rim and spins.
//!
//! Without gyroscopic torque (PhysX's way) a coin that spins fast enough about the vertical stands
//! upright on its rim, its centre above the contact, and nothing but angular drag slows it: tens of
//! seconds of steps in which only ω_z changes. Here ω_z falls by 30 % at once, as Rapier's own drag
//! would have it in those steps, and the steps that follow show whether the coin still stands.
//!
//! This is a choice of the model and no skip: in the steps that are not made the solver's own error
//! settles which way the coin leans in the end, and statistics are others with them (`docs/methods/rapier.md`).

use crate::body::Scaled;
use crate::motion::Motion;

/// Speed, in sqrt(g D), and rate of tilting, in sqrt(g/D), of a coin that stands.
const STILL: f64 = 1e-2;
/// How long it must have stood before, in sqrt(D/g).
const LASTS: f64 = 2.0;
/// What is left of ω_z.
const LEFT: f64 = 0.7;

/// Watches for a coin that stands.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Standing {
    since: Option<f64>,
}

/// Steps that are not made.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pause {
    pub(crate) duration: f64,
    /// What is left of ω_z.
    pub(crate) left: f64,
    /// Rate of its decay.
    pub(crate) decay: f64,
}

impl Standing {
    /// How far to go on at `time` without steps, if at all; `pushed` if the last step had contact.
    pub(crate) fn pause(
        &mut self,
        motion: &Motion,
        scaled: &Scaled,
        pushed: bool,
        time: f64,
        step: f64,
    ) -> Option<Pause> {
        let spin = &motion.spin;
        let tilting = (spin.x * spin.x + spin.y * spin.y).sqrt();
        let still = pushed && tilting < STILL && motion.velocity.norm() < STILL;
        // flat on a face or on the side it would be settled: on its rim it is
        if !still || spin.z.abs() < STILL {
            self.since = None;
            return None;
        }
        if time - *self.since.get_or_insert(time) < LASTS {
            return None;
        }
        self.since = None;
        // Rapier's drag divides by this in every step
        let slower = libm::log1p(scaled.angular_drag * step);
        let steps = (-libm::log(LEFT) / slower).floor();
        (steps >= 1.0).then(|| Pause {
            duration: steps * step,
            left: libm::exp(-steps * slower),
            decay: slower / step,
        })
    }
}
