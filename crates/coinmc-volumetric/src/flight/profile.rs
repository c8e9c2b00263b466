//! What of a coin's shape the search for its first contact depends on: the height of the centre at which
//! the lowest point touches, as a function of u_z and of s.

use crate::body::Body;
use coinmc_lanes::Lane;

/// A shape that touches at the centre's height lift(u_z) + R s.
pub(crate) trait Profile {
    /// Whether this is one rim alone: there is no other that may touch first.
    const ALONE: bool;

    /// R.
    fn radius(&self) -> f64;

    /// h.
    fn half(&self) -> f64;

    /// h|u_z| of the lower rim, b h u_z of one rim.
    fn lift<L: Lane>(&self, uz: L) -> L;

    /// Its derivative with respect to u_z.
    fn lever<L: Lane>(&self, uz: L) -> L;
}

/// Both rims of a coin that is the same from both faces.
impl Profile for Body {
    const ALONE: bool = false;

    #[inline(always)]
    fn radius(&self) -> f64 {
        self.radius
    }

    #[inline(always)]
    fn half(&self) -> f64 {
        self.half
    }

    #[inline(always)]
    fn lift<L: Lane>(&self, uz: L) -> L {
        L::splat(self.half) * uz.abs()
    }

    #[inline(always)]
    fn lever<L: Lane>(&self, uz: L) -> L {
        L::splat(self.half).copysign(uz)
    }
}

/// One rim: below the centre if u points up, or above it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OneRim {
    pub(crate) radius: f64,
    pub(crate) half: f64,
    /// b: 1 for the rim away from which u points, −1 for the other one.
    pub(crate) end: f64,
}

impl Profile for OneRim {
    const ALONE: bool = true;

    fn radius(&self) -> f64 {
        self.radius
    }

    fn half(&self) -> f64 {
        self.half
    }

    #[inline(always)]
    fn lift<L: Lane>(&self, uz: L) -> L {
        L::splat(self.end * self.half) * uz
    }

    #[inline(always)]
    fn lever<L: Lane>(&self, _: L) -> L {
        L::splat(self.end * self.half)
    }
}
