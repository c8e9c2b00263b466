//! Which face is up at each launch.

use super::Launch;
use crate::Face;
use std::cell::RefCell;

/// Which face is up at each of the launches that a [`LaunchSource`](super::LaunchSource) hands to an
/// engine, noted while it does: a byte for each launch.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, Domain, Face, LaunchSource, Lanes, Preset, Starts, Stream};
/// let (coin, stream) = (Coin::cylinder(0.2, 0.01)?, Stream::new(1, Domain::Launch, 0));
/// let hand = Preset::Hand.distribution();
/// let starts = Starts::default();
/// let launches = hand.launches(&coin, &stream, 0..100, Lanes::best());
/// let tossed = LaunchSource::from(launches).noting(&starts).count();
/// assert_eq!((tossed, starts.up(99)), (100, Some(Face::Heads)));
/// # Ok::<(), coinmc_core::CoinError>(())
/// ```
#[derive(Debug, Default)]
pub struct Starts {
    up: RefCell<Vec<Option<Face>>>,
}

impl Starts {
    /// The face that was up at the launch of this number, from 0; `None` if it was not seen or the coin
    /// stood upright.
    pub fn up(&self, launch: u64) -> Option<Face> {
        let launch = usize::try_from(launch).ok()?;
        *self.up.borrow().get(launch)?
    }

    /// Notes the next launch.
    #[inline]
    pub(super) fn note(&self, launch: &Launch) {
        self.up.borrow_mut().push(launch.up());
    }
}

impl Launch {
    /// The face that is up; `None` if the coin stands upright.
    #[inline]
    pub fn up(&self) -> Option<Face> {
        let z = self.axis.z;
        if z > 0.0 {
            Some(Face::Heads)
        } else if z < 0.0 {
            Some(Face::Tails)
        } else {
            None
        }
    }
}
