//! The coin, the surface and the step in the engine's frame.
//!
//! Froude scaling: lengths in D = sqrt(R² + H²/4), times in sqrt(D/g), masses in m. Then g = 1, the
//! barrier between face and side is 1, and a coin of 1 cm and one of 1 m are the same computation.
//! Rapier's own lengths and frequencies (its allowed error, its contact springs) are made for metres
//! and seconds and do not scale with the bodies; in this frame they mean the same for every coin.

use coinmc_core::Scene;

/// Shape and inertia; radius² + half² = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Body {
    /// R/D.
    pub(crate) radius: f64,
    /// H/(2D).
    pub(crate) half: f64,
    /// I_t/(m D²), about a diameter through the centre.
    pub(crate) kt: f64,
    /// I_a/(m D²), about the coin's axis.
    pub(crate) ka: f64,
}

impl Body {
    fn new(scene: &Scene) -> Self {
        let coin = &scene.coin;
        let (radius, half) = coin.shape_by_rim_distance();
        let r2 = coin.radius_m() * coin.radius_m();
        Self {
            radius,
            half,
            kt: coin.transverse_gyration_m2() / r2 * radius * radius,
            ka: coin.axial_gyration_m2() / r2 * radius * radius,
        }
    }

    /// Height of the centre when the lowest point touches, for an axis of this vertical component.
    pub(crate) fn rest_height(&self, up: f64) -> f64 {
        let across = ((1.0 - up) * (1.0 + up)).max(0.0).sqrt();
        self.half * up.abs() + self.radius * across
    }

    /// Depth of the shallower of the coin's wells, on its side and on a face: the energy that
    /// carries it over its rim from rest.
    pub(crate) fn shallower_well(&self) -> f64 {
        1.0 - self.radius.max(self.half)
    }
}

/// What one length and one time of the frame are in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Units {
    pub(crate) length_m: f64,
    pub(crate) time_s: f64,
}

impl Units {
    pub(crate) fn speed_m_s(&self) -> f64 {
        self.length_m / self.time_s
    }
}

/// A scene in the engine's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scaled {
    pub(crate) units: Units,
    pub(crate) body: Body,
    pub(crate) restitution: f64,
    pub(crate) friction: f64,
    /// Approach below which restitution is 0.
    pub(crate) threshold: f64,
    /// Contour and pivoting friction lengths.
    pub(crate) contour: f64,
    pub(crate) pivoting: f64,
    pub(crate) linear_drag: f64,
    pub(crate) angular_drag: f64,
    /// Ω_a/ω_a: I_a/I_t of a free top, 1 without gyroscopic torque.
    pub(crate) axial_factor: f64,
}

impl Scaled {
    pub(crate) fn new(scene: &Scene) -> Self {
        let (surface, drag) = (&scene.surface, scene.drag());
        let units = Units {
            length_m: scene.coin.rim_distance_m(),
            time_s: scene.time_scale_s(),
        };
        let body = Body::new(scene);
        Self {
            units,
            body,
            restitution: surface.restitution(),
            friction: surface.friction(),
            threshold: surface.restitution_threshold_m_s() / units.speed_m_s(),
            contour: surface.rolling_friction_m() / units.length_m,
            pivoting: surface.pivoting_friction_m() / units.length_m,
            linear_drag: drag.linear_per_s() * units.time_s,
            angular_drag: drag.angular_per_s() * units.time_s,
            axial_factor: if scene.has_gyroscopic_torque() {
                body.ka / body.kt
            } else {
                1.0
            },
        }
    }
}
