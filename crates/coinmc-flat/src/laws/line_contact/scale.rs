//! The scales of an impact.

use crate::laws::palmgren::{duration, max_compression};

/// The units of errors: the lossless compression of one corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// Greatest depth.
    pub(super) length: f64,
    /// Initial speed.
    pub(super) speed: f64,
    /// Duration.
    pub(super) time: f64,
    /// Greatest force.
    pub(super) force: f64,
}

impl Scale {
    /// A corner with this effective mass touches at the speed `approach`.
    pub(super) fn new(stiffness: f64, mass: f64, approach: f64) -> Self {
        // static depth under the own weight, and the speed after a fall by that depth: anything
        // slower is a loading, not an impact
        let resting = libm::pow(1.0 / stiffness, 0.9);
        let speed = approach.max(resting.sqrt());
        let length = max_compression(stiffness, mass, speed).max(resting);
        Self {
            length,
            speed,
            time: duration(stiffness, mass, speed),
            force: stiffness * libm::pow(length, 10.0 / 9.0),
        }
    }
}
