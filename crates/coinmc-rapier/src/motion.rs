//! How a coin moves, in the engine's units.

use crate::scaled::Scaled;
use coinmc_core::{Body, DecisionState, Launch, State, Units};
use nalgebra::{UnitVector3, Vector3};

/// Position, velocity, axis and angular velocity; lengths in D, times in sqrt(D/g).
///
/// The phase about the coin's own axis never matters, and heads and tails are alike: `axis` is the
/// normal of the face that was up at launch, so launches with u and −u are bit-identical.
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
        let nan = Vector3::new(f64::NAN, f64::NAN, f64::NAN);
        Self {
            position: nan,
            velocity: nan,
            axis: nan,
            spin: nan,
        }
    };

    /// The motion at launch, and whether `axis` is u (−u otherwise). A coin that would begin inside
    /// the surface is lifted until it touches.
    pub(crate) fn launched(launch: &Launch, scaled: &Scaled) -> (Self, bool) {
        let units = &scaled.units;
        let axis = launch.axis.into_inner();
        let heads_up = axis.z.is_sign_positive();
        let axis = if heads_up { axis } else { -axis };
        let height = (launch.height_m / units.length_m).max(scaled.rest_height(axis.z));
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

    /// s, the sine of the axis' tilt from the vertical.
    pub(crate) fn tilt_sine(&self) -> f64 {
        (self.axis.x * self.axis.x + self.axis.y * self.axis.y).sqrt()
    }

    /// Mechanical energy per m g D, potential zero at the surface.
    pub(crate) fn energy(&self, body: &Body) -> f64 {
        let axial = self.axial();
        let across = (self.spin - self.axis * axial).norm_squared();
        0.5 * (self.velocity.norm_squared() + body.kt * across + body.ka * axial * axial)
            + self.position.z
    }

    /// What the decision depends on, for the coin lifted by `depth` out of the surface.
    pub(crate) fn decision_state(&self, scaled: &Scaled, depth: f64) -> DecisionState<f64> {
        // of the two ends of the axis, the one that points up
        let up = 1.0_f64.copysign(self.axis.z);
        let [nx, ny] = self.lean_direction().map(|n| up * n);
        let velocity = &self.velocity;
        let axial = self.axial();
        DecisionState {
            energy: self.energy(&scaled.body) + depth,
            sin: self.tilt_sine(),
            cos: self.axis.z.abs(),
            vx: velocity.x * nx + velocity.y * ny,
            vy: velocity.y * nx - velocity.x * ny,
            axial: up * axial,
            // of Ω = L/I_t, which differs from ω along the axis only
            vertical: self.spin.z + (scaled.axial_factor - 1.0) * axial * self.axis.z,
        }
    }

    /// Height of the lowest point above the surface.
    pub(crate) fn gap(&self, scaled: &Scaled) -> f64 {
        self.position.z - scaled.rest_height(self.axis.z)
    }

    /// Unit vector of the horizontal direction the axis leans to; x for an upright axis.
    fn lean_direction(&self) -> [f64; 2] {
        let sine = self.tilt_sine();
        if sine > 0.0 {
            [self.axis.x / sine, self.axis.y / sine]
        } else {
            [1.0, 0.0]
        }
    }

    /// From the centre to the lowest point; with the axis exactly vertical, some point of the rim.
    pub(crate) fn lever(&self, body: &Body) -> Vector3<f64> {
        let (x, y, z) = (self.axis.x, self.axis.y, self.axis.z);
        let [nx, ny] = self.lean_direction();
        // e_θ = (c n, −s) with u = (s n, c); below is the rim on the side of −u if u points up
        let (across, along) = (body.radius * z, -body.half.copysign(z));
        Vector3::new(
            across * nx + along * x,
            across * ny + along * y,
            -body.radius * self.tilt_sine() + along * z,
        )
    }

    /// Velocity of the lowest point.
    pub(crate) fn contact_velocity(&self, body: &Body) -> Vector3<f64> {
        self.velocity + self.spin.cross(&self.lever(body))
    }

    /// Turns the part of ω across the axis by `factor`·ω_a, as that of a free top turns in its own
    /// frame: energy and ω_a stay.
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
