//! The coin's state in the engine's frame.

use crate::body::{Body, Scaled, Units};
use coinmc_core::{Launch, State};
use nalgebra::{UnitVector3, Vector3};

/// Position, velocity, axis and angular velocity; lengths in D, times in sqrt(D/g).
///
/// The phase about the coin's own axis never matters, and heads and tails are alike: `axis` is the
/// normal of the face that was up at launch, so u and −u give the same numbers to the last bit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Motion {
    pub(crate) position: Vector3<f64>,
    pub(crate) velocity: Vector3<f64>,
    pub(crate) axis: Vector3<f64>,
    pub(crate) spin: Vector3<f64>,
}

impl Motion {
    /// NaN placeholder: where there is no coin.
    pub(crate) const NAN: Self = {
        let none = Vector3::new(f64::NAN, f64::NAN, f64::NAN);
        Self {
            position: none,
            velocity: none,
            axis: none,
            spin: none,
        }
    };

    /// The launch, and whether `axis` is u (−u otherwise). A coin that would begin inside the
    /// surface is lifted until it touches.
    pub(crate) fn launched(launch: &Launch, scaled: &Scaled) -> (Self, bool) {
        let Scaled { units, body, .. } = scaled;
        let axis = launch.axis.into_inner();
        let heads_up = axis.z.is_sign_positive();
        let axis = if heads_up { axis } else { -axis };
        let height = (launch.height_m / units.length_m).max(body.rest_height(axis.z));
        let motion = Self {
            position: Vector3::new(0.0, 0.0, height),
            velocity: launch.velocity_m_s / units.speed_m_s(),
            axis,
            spin: launch.spin_rad_s * units.time_s,
        };
        (motion, heads_up)
    }

    /// Angular velocity about the axis.
    pub(crate) fn axial(&self) -> f64 {
        self.spin.dot(&self.axis)
    }

    /// Horizontal part of the axis: s.
    pub(crate) fn lean(&self) -> f64 {
        (self.axis.x * self.axis.x + self.axis.y * self.axis.y).sqrt()
    }

    /// Mechanical energy per m g D, potential zero at the surface.
    pub(crate) fn energy(&self, body: &Body) -> f64 {
        let axial = self.axial();
        let across = (self.spin - self.axis * axial).norm_squared();
        0.5 * (self.velocity.norm_squared() + body.kt * across + body.ka * axial * axial)
            + self.position.z
    }

    /// Height of the lowest point above the surface.
    pub(crate) fn gap(&self, body: &Body) -> f64 {
        self.position.z - body.rest_height(self.axis.z)
    }

    /// From the centre to the lowest point. Of a coin exactly upright, some point of the rim.
    pub(crate) fn lever(&self, body: &Body) -> Vector3<f64> {
        let (x, y, z) = (self.axis.x, self.axis.y, self.axis.z);
        let lean = self.lean();
        let (nx, ny) = if lean > 0.0 {
            (x / lean, y / lean)
        } else {
            (1.0, 0.0)
        };
        // e_θ = (c n, −s) with u = (s n, c); below is the rim on the side of −u if u points up
        let (across, along) = (body.radius * z, -body.half.copysign(z));
        Vector3::new(
            across * nx + along * x,
            across * ny + along * y,
            -body.radius * lean + along * z,
        )
    }

    /// Velocity of the lowest point.
    pub(crate) fn touch_velocity(&self, body: &Body) -> Vector3<f64> {
        self.velocity + self.spin.cross(&self.lever(body))
    }

    /// Turns the part of ω across the axis by `factor`·ω_a, as a free top's turns in its own frame:
    /// energy and ω_a stay.
    pub(crate) fn precess(&mut self, factor: f64) {
        let axial = self.axial();
        let across = self.spin - self.axis * axial;
        let (s, c) = libm::sincos(factor * axial);
        self.spin = self.axis * axial + across * c + self.axis.cross(&across) * s;
    }

    pub(crate) fn is_finite(&self) -> bool {
        let parts = [&self.position, &self.velocity, &self.axis, &self.spin];
        parts.into_iter().flatten().all(|x| x.is_finite())
    }

    /// In SI units, `time_s` after the launch.
    pub(crate) fn state(&self, units: &Units, time_s: f64, heads_up: bool) -> State {
        State {
            time_s,
            position_m: self.position * units.length_m,
            velocity_m_s: self.velocity * units.speed_m_s(),
            axis: UnitVector3::new_unchecked(if heads_up { self.axis } else { -self.axis }),
            spin_rad_s: self.spin / units.time_s,
        }
    }
}
