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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LaunchSource;
    use nalgebra::{UnitVector3, Vector3};

    /// Tosses of one run come from several sources, and an engine need not take all of a source.
    #[test]
    fn each_launch_that_was_taken_has_its_face_by_its_number() {
        let launch = |axis: [f64; 3]| Launch {
            height_m: 1.0,
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_normalize(axis.into()),
            spin_rad_s: Vector3::zeros(),
        };
        let [heads, tails, upright] = [[3.0, 0.0, 0.1], [0.0, 3.0, -0.1], [1.0, 1.0, 0.0]];
        let starts = Starts::default();
        for (axes, taken) in [
            ([heads, tails], 2),
            ([upright, tails], 2),
            ([tails, heads], 1),
        ] {
            let mut launches = axes.into_iter().map(launch);
            let source = LaunchSource::new(&mut launches).noting(&starts);
            assert_eq!(source.take(taken).count(), taken);
        }
        let up: Vec<Option<Face>> = (0..6).map(|number| starts.up(number)).collect();
        let (heads, tails) = (Some(Face::Heads), Some(Face::Tails));
        assert_eq!(up, [heads, tails, None, tails, tails, None]);
    }
}
