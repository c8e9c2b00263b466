//! The scene in the engine's units, those of [`Body`].
//!
//! Rapier's own lengths and frequencies (its allowed error, its contact springs) are made for metres
//! and seconds and do not scale with the bodies. In these units they mean the same for every coin.

use coinmc_core::{Body, Scene, Units};

/// A scene in the engine's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scaled {
    pub(crate) units: Units,
    pub(crate) body: Body,
    pub(crate) restitution: f64,
    pub(crate) friction: f64,
    /// Approach speed below which restitution is 0.
    pub(crate) threshold: f64,
    /// Friction lengths.
    pub(crate) rolling_friction: f64,
    pub(crate) pivoting_friction: f64,
    pub(crate) linear_drag: f64,
    pub(crate) angular_drag: f64,
    /// Ω_a/ω_a: I_a/I_t of a free top, 1 without gyroscopic torque.
    pub(crate) axial_factor: f64,
}

impl Scaled {
    pub(crate) fn new(scene: &Scene) -> Self {
        let (surface, drag) = (&scene.surface, scene.drag());
        let units = Units::new(scene);
        let body = Body::new(&scene.coin);
        Self {
            units,
            body,
            restitution: surface.restitution(),
            friction: surface.friction(),
            threshold: surface.restitution_threshold_m_s() / units.speed_m_s(),
            rolling_friction: surface.rolling_friction_m() / units.length_m,
            pivoting_friction: surface.pivoting_friction_m() / units.length_m,
            linear_drag: drag.linear_per_s() * units.time_s,
            angular_drag: drag.angular_per_s() * units.time_s,
            axial_factor: body.axial_factor(scene.has_gyroscopic_torque()),
        }
    }

    /// Height of the centre when the lowest point touches, for an axis with this vertical component.
    pub(crate) fn rest_height(&self, up: f64) -> f64 {
        let sine = ((1.0 - up) * (1.0 + up)).max(0.0).sqrt();
        self.body.half * up.abs() + self.body.radius * sine
    }
}
