//! The coin and the surface in the kernel's units: lengths in D = sqrt(R² + H²/4), times in
//! sqrt(D/g), masses in m. Then g = 1, the barrier m g D = 1, and only H/R, e, μ, the friction
//! lengths and drag are left.

pub use coinmc_core::Body;
use coinmc_core::Scene;
pub(crate) use coinmc_core::Units;
use coinmc_lanes::Lane;

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
    pub fn has_lengths(&self) -> bool {
        self.contour > 0.0 || self.pivoting > 0.0
    }
}

/// (R_c + s r, h_c + c r): the levers of a horizontal force across the coin at its lowest point, about
/// u and e_θ. R and H/2 with sharp rims.
#[inline(always)]
pub(crate) fn levers<L: Lane>(body: &Body, s: L, c: L) -> (L, L) {
    let (radius, half) = (L::splat(body.radius), L::splat(body.half));
    if body.rim == 0.0 {
        return (radius, half);
    }
    let rim = L::splat(body.rim);
    (radius + rim * s, half + rim * c)
}
