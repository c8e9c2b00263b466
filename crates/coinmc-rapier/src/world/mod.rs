//! Rapier itself: one world with a half-space and a cylinder, in double or single precision.
//!
//! The two precisions are two crates with the same names in them, so one source serves both: `stage`
//! is compiled once for each.

#[cfg(not(all(feature = "f64", feature = "f32")))]
mod absent;
#[cfg(feature = "f64")]
mod double;
#[cfg(feature = "f32")]
mod single;

use crate::body::Scaled;
use crate::motion::Motion;
use crate::settings::{Precision, Settings};

/// What an engine asks of a world that a worker keeps: coins in numbered seats that do not touch one
/// another. Lengths in D, times in sqrt(D/g).
pub(crate) trait World {
    /// Puts the coin of a seat there, a new one if the seat is empty. What earlier contacts left
    /// behind is gone.
    fn place(&mut self, seat: usize, motion: &Motion);

    /// Empties a seat.
    fn leave(&mut self, seat: usize);

    /// Contacts of this coin that begin in the next step bounce with this restitution.
    fn set_restitution(&mut self, seat: usize, restitution: f64);

    /// The velocities of a coin, and nothing else, become these.
    fn set_velocities(&mut self, seat: usize, motion: &Motion);

    /// Makes one step of all coins.
    fn step(&mut self);

    /// A coin now; none of an empty seat.
    fn motion(&self, seat: usize) -> Motion;

    /// Sum of the normal impulses of the last step on a coin, in m sqrt(g D).
    fn impulse(&self, seat: usize) -> f64;
}

/// A world of one of the precisions that were built.
pub(crate) enum AnyWorld {
    #[cfg(feature = "f64")]
    Double(Box<double::Stage>),
    #[cfg(feature = "f32")]
    Single(Box<single::Stage>),
    /// That of an engine that cannot be had: no engine of a precision that was not built exists.
    #[cfg(not(all(feature = "f64", feature = "f32")))]
    Absent(absent::Nowhere),
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
            _ => Self::Absent(absent::Nowhere),
        }
    }
}
