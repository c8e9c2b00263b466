//! The decision on a coin that slides on a surface without rebound (e = 0): the energy of sliding is
//! left out. The proof is in docs/methods/plane.md, "Sliding without rebound".

use crate::motion::Motion;
use crate::shape::Shape;

/// The energy, without that of sliding, below which a coin in contact cannot leave its well, whatever
/// friction does within its cone: on a face and on the side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DeadContact {
    barriers: [f64; 2],
}

impl DeadContact {
    /// No such decision.
    pub(crate) const NONE: Self = Self {
        barriers: [f64::NEG_INFINITY; 2],
    };

    /// The decision with friction `mu` and e = 0, in the wells where it is proven.
    pub(crate) fn new(shape: &Shape, mu: f64) -> Self {
        // quadrant 0 begins on a face and ends on the side
        let barriers = [false, true].map(|at_end| barrier(shape.k, mu, shape.base(0, at_end)));
        Self { barriers }
    }

    /// Whether it decides the face of a coin whose lowest corner stays on the surface.
    #[inline]
    pub(crate) fn decides(&self, motion: &Motion, k: f64) -> bool {
        let on_side = (motion.quadrant & 1 == 0) == (motion.delta >= 0.0);
        motion.energy_without_sliding(k) < self.barriers[usize::from(on_side)]
    }
}

/// The barrier of the well of an edge, with the centre at the height h when flat and half the width
/// w; −∞ where nothing is proven.
fn barrier(k: f64, mu: f64, (h, w): (f64, f64)) -> f64 {
    let steepest = (1.0 + mu * mu).sqrt();
    let barrier = (steepest - mu * w).min(1.0);
    // the share of the rotation that the impact of the other corner leaves
    let left = |friction: f64| {
        let lever = w * (w - friction * h);
        (k - lever) / (k + lever)
    };
    let share = left(mu).abs().max(left(-mu).abs());
    // the energy at the start of a fall less μ times the lever there, at most: that of a coin which turns
    // back at the steepest angle that friction may hold
    let fall = (1.0 - mu * mu) / steepest;
    // the most energy with which it comes down flat
    let most = fall + mu * w;
    let stays_down = steepest < 1.0 + 0.5 * k && fall * fall < 1.0 + k - mu;
    let loses = share * share * (most - h) <= barrier - h;
    if mu * h < w && stays_down && loses {
        barrier
    } else {
        f64::NEG_INFINITY
    }
}

#[cfg(test)]
mod tests;
