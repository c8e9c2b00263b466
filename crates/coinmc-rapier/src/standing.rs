//! The coin that stands on one point of its rim and spins.
//!
//! Without gyroscopic torque (PhysX's way) a coin that spins fast enough about the vertical stands
//! upright on its rim, its centre above the contact, and nothing but angular drag slows it: tens of
//! seconds of steps in which only ω_z changes. Here ω_z falls by 30 % at once, as Rapier's own drag
//! would slow it in those steps, and the steps that follow show whether the coin still stands.
//!
//! This is a choice of the model and changes results: in the skipped steps the solver's own error
//! would decide which way the coin leans in the end, and that changes statistics
//! (`docs/methods/rapier.md`).

use crate::motion::Motion;
use crate::scaled::Scaled;

/// Speed, in sqrt(g D), and rate of tilting, in sqrt(g/D), below which a coin stands still.
const STILL: f64 = 1e-2;
/// How long it must have stood, in sqrt(D/g).
const DURATION: f64 = 2.0;
/// The fraction of ω_z that remains.
const REMAINING: f64 = 0.7;

/// Watches for a coin that stands.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StandingDetector {
    still_since: Option<f64>,
}

/// Steps of a standing coin that are skipped.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StandingSkip {
    pub(crate) duration: f64,
    /// The fraction of ω_z that remains.
    pub(crate) remaining: f64,
    /// Rate at which ω_z decays.
    pub(crate) decay_rate: f64,
}

impl StandingDetector {
    /// The steps to skip at `time`, if any; `pushed` if the last step had contact. To be asked
    /// before every step.
    pub(crate) fn skip(
        &mut self,
        motion: &Motion,
        scaled: &Scaled,
        pushed: bool,
        time: f64,
        step: f64,
    ) -> Option<StandingSkip> {
        let spin = &motion.spin;
        let tilting = (spin.x * spin.x + spin.y * spin.y).sqrt();
        let still = pushed && tilting < STILL && motion.velocity.norm() < STILL;
        // flat on a face or on the side it would be decided, so it is on its rim
        if !still || spin.z.abs() < STILL {
            self.still_since = None;
            return None;
        }
        if time - *self.still_since.get_or_insert(time) < DURATION {
            return None;
        }
        self.still_since = None;
        // Rapier's drag divides by this in every step
        let slower = libm::log1p(scaled.angular_drag * step);
        let steps = (-libm::log(REMAINING) / slower).floor();
        (steps >= 1.0).then(|| StandingSkip {
            duration: steps * step,
            remaining: libm::exp(-steps * slower),
            decay_rate: slower / step,
        })
    }
}
