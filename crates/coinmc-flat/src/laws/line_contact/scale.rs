//! How large things are in an impact.

use crate::laws::palmgren::{deepest, duration};

/// What errors are measured against: the compression of one corner without losses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// How deep it gets.
    pub(super) length: f64,
    /// How fast it begins.
    pub(super) speed: f64,
    /// How long it lasts.
    pub(super) time: f64,
    /// How hard it presses.
    pub(super) force: f64,
}

impl Scale {
    /// A corner touches at `approach`, with this mass along the normal.
    pub(super) fn new(stiffness: f64, mass: f64, approach: f64) -> Self {
        // static depth under the own weight, and the speed at which a fall by it ends: slower
        // impacts are no impacts but a loading
        let resting = libm::pow(1.0 / stiffness, 0.9);
        let speed = approach.max(resting.sqrt());
        let length = deepest(stiffness, mass, speed).max(resting);
        Self {
            length,
            speed,
            time: duration(stiffness, mass, speed),
            force: stiffness * libm::pow(length, 10.0 / 9.0),
        }
    }
}
