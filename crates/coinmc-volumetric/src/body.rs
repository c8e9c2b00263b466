//! The coin and the surface in the kernel's units: lengths in D = sqrt(R² + H²/4), times in
//! sqrt(D/g), masses in m. Then g = 1, the barrier m g D = 1, and only H/R, e, μ, the friction
//! lengths and drag are left.

use coinmc_core::{Coin, Scene};

/// The coin's shape and inertia, per its mass m and in units of D = sqrt(R² + H²/4), the distance
/// of the rim from the centre: radius² + half² = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// R/D.
    pub radius: f64,
    /// H/(2D).
    pub half: f64,
    /// I_t/(m D²), about a diameter through the centre.
    pub kt: f64,
    /// I_a/(m D²), about the coin's axis.
    pub ka: f64,
}

impl Body {
    /// The body of a coin.
    pub fn new(coin: &Coin) -> Self {
        let (radius, half) = coin.shape_by_rim_distance();
        let r2 = coin.radius_m() * coin.radius_m();
        Self {
            radius,
            half,
            kt: coin.transverse_gyration_m2() / r2 * radius * radius,
            ka: coin.axial_gyration_m2() / r2 * radius * radius,
        }
    }
}

impl Body {
    /// sqrt(2 × depth) of the shallower of the coin's wells, on its side and on a face: the speed,
    /// in sqrt(g D), that just carries it over its rim. Thin coins have a shallow side.
    pub(crate) fn escape_speed(&self) -> f64 {
        (2.0 * (1.0 - self.radius.max(self.half))).sqrt()
    }
}

/// Friction of the contact; lengths in D = sqrt(R² + H²/4), as in [`Body`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Coulomb coefficient μ.
    pub mu: f64,
    /// Contour friction length ρ_c/D.
    pub contour: f64,
    /// Pivoting friction length ρ_p/D.
    pub pivoting: f64,
}

impl Friction {
    /// The friction of a scene.
    pub fn new(scene: &Scene) -> Self {
        let d = scene.coin.rim_distance_m();
        Self {
            mu: scene.surface.friction(),
            contour: scene.surface.rolling_friction_m() / d,
            pivoting: scene.surface.pivoting_friction_m() / d,
        }
    }

    /// Whether either friction length acts.
    pub fn twists(&self) -> bool {
        self.contour > 0.0 || self.pivoting > 0.0
    }
}

/// What one dimensionless length and time are in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Units {
    pub(crate) length_m: f64,
    pub(crate) time_s: f64,
}

impl Units {
    pub(crate) fn new(scene: &Scene) -> Self {
        Self {
            length_m: scene.coin.rim_distance_m(),
            time_s: scene.time_scale_s(),
        }
    }

    pub(crate) fn speed_m_s(&self) -> f64 {
        self.length_m / self.time_s
    }
}
