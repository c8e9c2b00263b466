//! The points of the rims that may touch.

use crate::coulomb::Touch;
use crate::{Model, Motion};
use nalgebra::Vector3;

/// Candidates: the lowest point of either rim, and of the lower rim the point opposite and the two
/// between. Of a tilted coin only the first two can touch; flat on a face all of the lower rim
/// does, and four points of it carry the coin as the whole ring would.
pub(crate) const POINTS: usize = 5;

/// Index of the point opposite to the lowest.
pub(crate) const OPPOSITE: usize = 2;

/// Sine of the tilt below which it has no direction.
const NO_TILT: f64 = 1e-150;

/// A point of the rim.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point {
    /// From the centre.
    pub(crate) arm: Vector3<f64>,
    /// x/s, x the unit horizontal projection of u: ψ' = wander·ω is the rate at which the lowest
    /// point moves along the rim. 0 for the other points, which stay where they are on the rim.
    pub(crate) wander: Vector3<f64>,
}

impl Point {
    /// Height above the surface.
    pub(crate) fn gap(&self, motion: &Motion) -> f64 {
        motion.position.z + self.arm.z
    }

    /// The contact of this point with a horizontal surface.
    pub(crate) fn touch(&self) -> Touch {
        let steepness = self.wander.norm();
        Touch {
            arm: self.arm,
            normal: Vector3::z(),
            tangents: [Vector3::x(), Vector3::y()],
            rolling: self.wander / steepness.max(f64::MIN_POSITIVE),
            steepness,
        }
    }

    /// Velocity of the material point that is there.
    pub(crate) fn velocity(&self, motion: &Motion) -> Vector3<f64> {
        motion.velocity + motion.spin.cross(&self.arm)
    }
}

/// The candidates of a motion: lowest of the heads rim, of the tails rim, and of the lower rim
/// opposite, left and right.
pub(crate) fn points(model: &Model, motion: &Motion) -> [Point; POINTS] {
    let (u, sine) = (motion.axis, motion.sine());
    let wander = wander(&u, sine);
    let down = down(&u, sine);
    let [(heads, above), (tails, below)] = model.rims;
    let is_tails = tails * sine + below * u.z > heads * sine - above * u.z;
    let lower = if is_tails { -1.0 } else { 1.0 };
    let across = u.cross(&down);
    let still = Vector3::zeros();
    let place = |end: f64, along: Vector3<f64>, wander| {
        let (radius, half) = if end > 0.0 {
            (heads, above)
        } else {
            (tails, below)
        };
        Point {
            arm: u * (end * half) + along * radius - Vector3::z() * model.rim,
            wander,
        }
    };
    [
        place(1.0, down, wander),
        place(-1.0, down, wander),
        place(lower, -down, still),
        place(lower, across, still),
        place(lower, -across, still),
    ]
}

/// The unit vector of the coin's plane that points down most steeply.
fn down(u: &Vector3<f64>, sine: f64) -> Vector3<f64> {
    if sine > NO_TILT {
        (u * u.z - Vector3::z()) / sine
    } else {
        Vector3::x()
    }
}

/// The lowest point turns with the vertical plane through u, whose horizontal normal stays
/// horizontal: it turns against the coin about u at the rate ψ' that takes from ω its component
/// along the projection x of u, (ω − ψ'u)·x = 0. Hence ψ' = ω·x/(u·x), and u·x = s.
fn wander(u: &Vector3<f64>, sine: f64) -> Vector3<f64> {
    if sine > NO_TILT {
        Vector3::new(u.x, u.y, 0.0) / (sine * sine)
    } else {
        Vector3::zeros()
    }
}
