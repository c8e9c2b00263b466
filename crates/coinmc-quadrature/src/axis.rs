//! How the axis turns in flight.

use coinmc_core::{Launch, Scene};

/// u_z = `along` + `across`·cos(`phase` + `rate`·τ), τ the turning time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turning {
    pub(crate) along: f64,
    pub(crate) across: f64,
    pub(crate) phase: f64,
    /// rad/s, not negative.
    pub(crate) rate: f64,
}

impl Turning {
    /// The turning of a launch.
    ///
    /// u turns about Ω = ω + (I_a/I_t − 1)(ω·u)u, the angular momentum over I_t, or without
    /// gyroscopic torque about ω. With e = Ω/|Ω|, c = e·u:
    /// u_z(φ) = c e_z + (u_z − c e_z) cos φ + (e × u)_z sin φ.
    pub(crate) fn of(launch: &Launch, scene: &Scene) -> Self {
        let (u, spin) = (launch.axis.into_inner(), launch.spin_rad_s);
        let omega = spin + u * ((axial_factor(scene) - 1.0) * spin.dot(&u));
        let rate = omega.norm();
        if rate == 0.0 {
            let (along, across, phase) = (u.z, 0.0, 0.0);
            return Self {
                along,
                across,
                phase,
                rate,
            };
        }
        let e = omega / rate;
        let along = e.dot(&u) * e.z;
        let (cos, sin) = (u.z - along, e.x * u.y - e.y * u.x);
        Self {
            along,
            across: libm::hypot(cos, sin),
            phase: -libm::atan2(sin, cos),
            rate,
        }
    }
}

/// I_a/I_t, or 1 without gyroscopic torque: the coin then turns about its angular velocity, as one
/// with equal moments does.
pub(crate) fn axial_factor(scene: &Scene) -> f64 {
    if scene.has_gyroscopic_torque() {
        scene.coin.axial_gyration_m2() / scene.coin.transverse_gyration_m2()
    } else {
        1.0
    }
}
