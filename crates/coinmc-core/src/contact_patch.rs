//! Pivoting friction of a contact patch: what turns a friction coefficient into a friction length.
//!
//! A contact is no point but a small patch, and a coin that turns about the vertical scrubs on it. For a
//! circular Hertz patch of radius a the pressure is p(r) = p₀ sqrt(1 − r²/a²), and the normal force is
//!
//! ```text
//! N = ∫ p dA = 2π p₀ ∫₀ᵃ sqrt(1 − r²/a²) r dr = (2π/3) p₀ a².
//! ```
//!
//! While the whole patch slips about its centre, Coulomb friction has the torque
//!
//! ```text
//! T = ∫ μ p r dA = 2π μ p₀ ∫₀ᵃ sqrt(1 − r²/a²) r² dr = 2π μ p₀ a³ · π/16 = (3π/16) μ a N,
//! ```
//!
//! so the pivoting friction length is ρ_p = T/N = (3π/16) μ a (Johnson, Contact Mechanics, 1985; Leine
//! & Glocker, Eur. J. Mech. A 22 (2003) 193).

use std::f64::consts::PI;

/// Radius of the patch where neither it nor the pivoting friction length is known, m. An estimate: by
/// [`hertz_radius_m`] a euro coin (7.5 g, R = 11.6 mm, rim rounded with 0.3 mm) has 13 µm on glass,
/// 22 µm on hard plastic and 47 µm on wood across the grain. With μ = 0.3 ρ_p is then 5.3 µm.
pub(crate) const ESTIMATED_RADIUS_M: f64 = 3e-5;

/// Rolling friction length where it is not known, m. An estimate for hard and fairly flat surfaces: a
/// 24 mm coin that whirrs for some seconds before it lies flat has ρ_c/R of about 0.003, and the only
/// measured steel disc, on glass, 1e-4.
pub(crate) const ESTIMATED_ROLLING_M: f64 = 5e-5;

/// Pivoting friction length, m, of a circular Hertz patch of this radius, m, under Coulomb friction.
///
/// # Example
/// ```
/// let length = coinmc_core::pivoting_friction_of_patch_m(0.3, 3e-5);
/// assert!((length - 5.3e-6).abs() < 1e-8);
/// ```
pub fn pivoting_friction_of_patch_m(friction: f64, patch_radius_m: f64) -> f64 {
    3.0 * PI / 16.0 * friction * patch_radius_m
}

/// Radius, m, of the Hertz patch of a coin that stands on its rim under its own weight.
///
/// Where the rim is rounded with the radius r, the contact has the principal radii R and r. Their
/// geometric mean is the radius of the sphere with nearly the same patch area (Johnson 1985, § 4.2), so
/// a³ = 3 m g sqrt(R r)/(4 E*), with 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂ of coin and surface.
///
/// # Example
/// ```
/// // a euro on glass: E* = 44 GPa
/// let a = coinmc_core::hertz_radius_m(7.5e-3 * 9.81, 11.6e-3, 0.3e-3, 44e9);
/// assert!((a - 13.3e-6).abs() < 1e-7);
/// ```
pub fn hertz_radius_m(load_n: f64, radius_m: f64, rounding_m: f64, modulus_pa: f64) -> f64 {
    libm::cbrt(0.75 * load_n * (radius_m * rounding_m).sqrt() / modulus_pa)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The two integrals of the module's documentation, by midpoints.
    #[test]
    fn the_torque_is_that_of_the_integral_over_the_patch() {
        let (friction, a, cells) = (0.3, 2e-5, 100_000);
        let (mut force, mut torque) = (0.0, 0.0);
        for cell in 0..cells {
            let r = (f64::from(cell) + 0.5) / f64::from(cells) * a;
            let push = (1.0 - (r / a) * (r / a)).sqrt() * r;
            force += push;
            torque += friction * push * r;
        }
        let length = pivoting_friction_of_patch_m(friction, a);
        assert!((torque / force / length - 1.0).abs() < 1e-6);
    }
}
