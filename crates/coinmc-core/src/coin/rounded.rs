//! Moments of inertia of a uniform cylinder with rounded rims.
//!
//! Lengths in R. Let a = 1 − r and b = H/2R − r be the measures of the cylinder inside. The radius of
//! the section at the height z is ρ = 1 up to |z| = b, and a + w with w = sqrt(r² − t²) at |z| = b + t.
//! Per unit density and for both halves, with the integrals ∫ over t from 0 to r,
//!
//! V = 2π ∫ρ² dz,  I_a = π ∫ρ⁴ dz,  I_t = I_a/2 + 2π ∫z² ρ² dz.
//!
//! The powers of w and t that occur have the integrals
//!
//! ∫w = πr²/4, ∫w² = 2r³/3, ∫w³ = 3πr⁴/16, ∫w⁴ = 8r⁵/15,
//! ∫wt = r³/3, ∫w²t = r⁴/4, ∫wt² = πr⁴/16, ∫w²t² = 2r⁵/15.

use std::f64::consts::PI;

/// (I_t, I_a) per mass in R², of a coin with half the height `half` and rims rounded with the radius
/// `r`, both in R.
pub(super) fn gyrations(half: f64, r: f64) -> (f64, f64) {
    let (a, b) = (1.0 - r, half - r);
    let (r2, r3, r4, r5) = (r * r, r.powi(3), r.powi(4), r.powi(5));
    let (w1, w2, w3, w4) = (
        PI * r2 / 4.0,
        2.0 * r3 / 3.0,
        3.0 * PI * r4 / 16.0,
        8.0 * r5 / 15.0,
    );
    // ∫ρ², ∫ρ² t and ∫ρ² t² of the rounded part, ρ² = a² + 2aw + w²
    let rho2 = a * a * r + 2.0 * a * w1 + w2;
    let rho2_t = a * a * r2 / 2.0 + 2.0 * a * r3 / 3.0 + r4 / 4.0;
    let rho2_t2 = a * a * r3 / 3.0 + 2.0 * a * PI * r4 / 16.0 + 2.0 * r5 / 15.0;
    let rho4 = a.powi(4) * r + 4.0 * a.powi(3) * w1 + 6.0 * a * a * w2 + 4.0 * a * w3 + w4;
    let volume = b + rho2;
    let axial = 0.5 * (b + rho4) / volume;
    let height = (b.powi(3) / 3.0 + b * b * rho2 + 2.0 * b * rho2_t + rho2_t2) / volume;
    (0.5 * axial + height, axial)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sums of thin slices: the midpoint rule with n slices of a section like sqrt(t) at its end is
    /// off by some n^(−3/2).
    #[test]
    fn the_moments_are_those_of_thin_slices() {
        for (half, r) in [(0.1, 0.03), (0.5, 0.2), (1.3, 0.9), (0.4, 0.399)] {
            let (mut volume, mut axial, mut square) = (0.0, 0.0, 0.0);
            let slices = 400_000;
            for i in 0..slices {
                let z = half * (f64::from(i) + 0.5) / f64::from(slices);
                let t = (z - (half - r)).max(0.0);
                let rho = (1.0 - r) + (r * r - t * t).sqrt();
                volume += rho * rho;
                axial += 0.5 * rho.powi(4);
                square += z * z * rho * rho;
            }
            let (it, ia) = gyrations(half, r);
            assert!((ia - axial / volume).abs() < 1e-7, "{half} {r}");
            let expected = 0.5 * axial / volume + square / volume;
            assert!((it - expected).abs() < 1e-7, "{half} {r}");
        }
    }

    #[test]
    fn a_sphere_and_a_sharp_cylinder_are_the_limits() {
        let (it, ia) = gyrations(1.0, 1.0);
        assert!((it - 0.4).abs() < 1e-15 && (ia - 0.4).abs() < 1e-15);
        let (it, ia) = gyrations(0.1, 0.0);
        assert!((it - (3.0 + 0.04) / 12.0).abs() < 1e-15 && (ia - 0.5).abs() < 1e-15);
    }
}
