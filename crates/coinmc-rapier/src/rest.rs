//! Coming to rest, for the decision `rest`: slow for as long as the coin takes to topple.

use crate::motion::Motion;
use coinmc_core::Body;

/// Kinetic energy below which a coin counts as still, as a fraction of the depth of its shallower
/// well.
const STILL: f64 = 1e-4;
/// How long it must be still, in sqrt(D/g).
const DURATION: f64 = 1.0;

/// Watches for rest.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RestDetector {
    still_since: Option<f64>,
}

impl RestDetector {
    /// Whether the coin, which moves like this at `time`, has come to rest. To be asked after every
    /// step.
    pub(crate) fn is_at_rest(&mut self, motion: &Motion, body: &Body, time: f64) -> bool {
        let kinetic = motion.energy(body) - motion.position.z;
        if kinetic >= STILL * body.shallower_well() {
            self.still_since = None;
            return false;
        }
        time - *self.still_since.get_or_insert(time) >= DURATION
    }
}
