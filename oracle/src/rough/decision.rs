//! When a toss onto rough ground is over.
//!
//! *By energy.* To pass between face and side the centre has to pass above the point of the rim that
//! the tilt has made the lowest, at a distance of 1 from it; and that point is at the ground or above.
//! The ground hardly ever lies deeper than 5σ below its mean (1 in 3.5 million places), so with an
//! energy of less than 1 − 5σ above the mean height the coin stays in the well it is in.
//!
//! *At rest.* The well of a thin coin on its side may be less deep than 5σ, and a coin that rolls on
//! its side may come to a place where it falls. So it is followed until it rests: until its kinetic
//! energy has stayed below a thousandth of the barrier where it stands for some time. That barrier
//! is the height to the balance over the nearer of its two rims, the point of contact fixed.

use crate::rough::rim::Minimum;
use crate::{Model, Motion};
use coinmc_core::Face;

/// Depth in σ below which no ground lies.
const DEEPEST: f64 = 5.0;
/// Share of the barrier below which kinetic energy counts as rest.
const QUIET: f64 = 1e-3;
/// Time for which it has to be quiet, sqrt(D/g).
const REST: f64 = 5.0;

/// How a toss ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// With too little energy to leave its well.
    Energy,
    /// At rest on its side.
    Rest,
    /// At the limit of time or steps, undecided.
    Limit,
}

/// The face, if energy decides it.
pub(crate) fn decided(model: &Model, deviation: f64, motion: &Motion) -> Option<Face> {
    let c = motion.axis.z;
    (motion.energy(model) < 1.0 - DEEPEST * deviation).then(|| match () {
        () if c.abs() < model.half => Face::Side,
        () if c > 0.0 => Face::Heads,
        () => Face::Tails,
    })
}

/// Since when the coin has been quiet on its side.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Quiet {
    since: Option<f64>,
    barrier: f64,
}

impl Quiet {
    /// Whether it has come to rest, given the points that carry it.
    pub(crate) fn settled<'a>(
        &mut self,
        model: &Model,
        motion: &Motion,
        carrying: impl Iterator<Item = &'a Minimum>,
        time: f64,
    ) -> bool {
        let mut heights = [f64::INFINITY; 2];
        for contact in carrying {
            let height = motion.position.z + contact.arm.z;
            let rim = usize::from(contact.end > 0.0);
            heights[rim] = heights[rim].min(height);
        }
        let lower = heights[0].min(heights[1]);
        let stands = heights[0].max(heights[1]).is_finite();
        if stands && motion.axis.z.abs() < model.half {
            self.barrier = 1.0 + lower - motion.position.z;
        }
        if motion.kinetic(model) < QUIET * self.barrier {
            let since = *self.since.get_or_insert(time);
            stands && time - since >= REST
        } else {
            self.since = None;
            false
        }
    }
}
