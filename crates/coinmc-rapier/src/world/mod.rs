//! Rapier itself: one world with a half-space and a cylinder, in double or single precision.
//!
//! The two precisions are two crates with the same names in them, so one source serves both: `stage`
//! is compiled once for each.

#[cfg(feature = "f64")]
mod double;
#[cfg(feature = "f32")]
mod single;

use crate::body::Scaled;
use crate::motion::Motion;
use crate::settings::{Precision, Settings};

/// What an engine asks of a world that a worker keeps. Lengths in D, times in sqrt(D/g).
pub(crate) trait World {
    /// Puts the coin there. What earlier contacts left behind is gone.
    fn place(&mut self, motion: &Motion);

    /// Makes one step. Contacts that begin in it bounce with this restitution.
    fn step(&mut self, restitution: f64);

    /// The velocities, and nothing else, become these.
    fn set_velocities(&mut self, motion: &Motion);

    /// The coin now.
    fn motion(&self) -> Motion;

    /// Sum of the normal impulses of the last step, in m sqrt(g D).
    fn impulse(&self) -> f64;
}

/// A world of one of the precisions that were built.
pub(crate) enum AnyWorld {
    #[cfg(feature = "f64")]
    Double(Box<double::Stage>),
    #[cfg(feature = "f32")]
    Single(Box<single::Stage>),
    /// That of an engine that cannot be had: no engine of a precision that was not built exists.
    #[cfg(not(all(feature = "f64", feature = "f32")))]
    Absent,
}

impl AnyWorld {
    pub(crate) fn new(
        precision: Precision,
        scaled: &Scaled,
        settings: &Settings,
        step: f64,
    ) -> Self {
        // without either precision nothing is made of these
        let _ = (scaled, settings, step);
        match precision {
            #[cfg(feature = "f64")]
            Precision::F64 => Self::Double(Box::new(double::Stage::new(scaled, settings, step))),
            #[cfg(feature = "f32")]
            Precision::F32 => Self::Single(Box::new(single::Stage::new(scaled, settings, step))),
            #[cfg(not(all(feature = "f64", feature = "f32")))]
            _ => Self::Absent,
        }
    }
}
