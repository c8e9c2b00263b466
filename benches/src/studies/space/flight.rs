//! Free flight in closed form, for any instant: the check of the engine's flights.
//!
//! In the laboratory frame and from the angular momentum alone: the axis goes round the fixed L at
//! the rate |L|/I_t. The engine's folded frame and its bounds have no part in it.

use super::angular_momentum;
use coinmc_core::{Scene, State};
use nalgebra::Vector3;

/// A flight without drag through a known state.
pub(in crate::studies) struct Flight {
    gravity: f64,
    radius: f64,
    half: f64,
    d: f64,
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    /// The part of u along L, the part across, and L̂ × u.
    along: Vector3<f64>,
    across: Vector3<f64>,
    ahead: Vector3<f64>,
    /// |L|/I_t.
    rate: f64,
}

impl Flight {
    pub(in crate::studies) fn new(scene: &Scene, state: &State) -> Self {
        let coin = &scene.coin;
        let axis = state.axis.into_inner();
        let momentum = angular_momentum(coin, state);
        let size = momentum.norm();
        let direction = if size > 0.0 { momentum / size } else { axis };
        let along = direction * direction.dot(&axis);
        Self {
            gravity: scene.gravity_m_s2(),
            radius: coin.radius_m(),
            half: 0.5 * coin.height_m(),
            d: coin.rim_distance_m(),
            position: state.position_m,
            velocity: state.velocity_m_s,
            along,
            across: axis - along,
            ahead: direction.cross(&axis),
            rate: size / coin.transverse_gyration_m2(),
        }
    }

    /// The axis `t` seconds later.
    pub(super) fn axis(&self, t: f64) -> Vector3<f64> {
        let (sin, cos) = libm::sincos(self.rate * t);
        self.along + self.across * cos + self.ahead * sin
    }

    /// The centre `t` seconds later.
    pub(super) fn position(&self, t: f64) -> Vector3<f64> {
        let mut position = self.position + self.velocity * t;
        position.z -= 0.5 * self.gravity * t * t;
        position
    }

    /// Height of the lowest point `t` seconds later, in D.
    pub(in crate::studies) fn gap(&self, t: f64) -> f64 {
        let u = self.axis(t);
        // from the horizontal part: 1 − u_z² has no digits left near 0
        let sine = (u.x * u.x + u.y * u.y).sqrt();
        let height = self.position.z + t * (self.velocity.z - 0.5 * self.gravity * t);
        (height - self.half * u.z.abs() - self.radius * sine) / self.d
    }
}
