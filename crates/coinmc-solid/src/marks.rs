//! The marks that tell heads from tails, and why they change neither the centre nor the symmetry.
//!
//! Each face has a ring of n recesses, n = 3 on heads and 6 on tails. All reach from the radius r1 to r2
//! and to the depth d, and each spans the angle π/n: half of the ring, on either face.
//!
//! With the ring's area A = (π/2)(r2² − r1²), what a face loses depends on n nowhere below.
//!
//! * Volume: A d. The first moments ∫z dV are A d (H/2 − d/2) on heads and its negative on tails; they
//!   cancel, and the centre stays in the middle plane.
//! * In the plane, write ρ e^{iφ} for x + iy. The n sectors are one of them turned by 2πk/n, so the
//!   integral of ρ e^{iφ} over all is that over one times Σ_k e^{2πik/n} = 0 for n ≥ 2: the centre
//!   stays on the axis. As z does not depend on φ, ∫xz dV = ∫yz dV = 0 for the same reason.
//! * ∫(x² − y² + 2ixy) dV = ∫ρ² e^{2iφ} dV has the factor Σ_k e^{4πik/n}, which is 0 unless n divides
//!   2. So for n ≥ 3 ∫x² dV = ∫y² dV and ∫xy dV = 0: the two transverse moments are equal, whatever
//!   the diameter, and the axis is a principal one.
//! * ∫ρ² dV = d (π/4)(r2⁴ − r1⁴) and ∫z² dV = A (h³ − (h − d)³)/3 with h = H/2, on each face.
//!
//! A marked coin so spins like a body of revolution, and the faces differ only in what is seen and felt.
//! The ring of the face outside r2 stays flat: a marked coin lies and tips as a plain one.

use crate::moments::Moments;
use crate::shape::Shape;
use std::f64::consts::PI;

/// Recesses on both faces: a ring of three on heads, of six narrower ones on tails, half of the ring each.
///
/// They move neither the centre of mass nor the axis, and the moments of inertia about all diameters
/// stay equal: each face loses the same volume at the same distances, in a pattern that three or more
/// turns bring back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marks {
    /// Inner radius of the rings, m.
    pub inner_m: f64,
    /// Outer radius of the rings, m.
    pub outer_m: f64,
    /// Depth of the recesses, m.
    pub depth_m: f64,
}

impl Marks {
    /// Number of recesses on heads.
    pub const HEADS: u32 = 3;
    /// Number of recesses on tails.
    pub const TAILS: u32 = 6;

    /// Marks that fit the coin: from 0.4 to 0.8 of the flat face's radius, and a fifth of the thickness
    /// deep, at most 0.6 mm.
    ///
    /// A face that its edge leaves nearly nothing of has no room for marks; then
    /// [`Shape::with_marks`] refuses these.
    pub fn fitting(shape: &Shape) -> Self {
        let face = shape.face_radius_m();
        Self {
            inner_m: 0.4 * face,
            outer_m: 0.8 * face,
            depth_m: (shape.thickness_m() / 5.0).min(6e-4),
        }
    }

    /// What the recesses of both faces take from a coin of half the thickness `half_m`.
    pub(crate) fn moments(&self, half_m: f64) -> Moments {
        let (r1, r2, d) = (self.inner_m, self.outer_m, self.depth_m);
        let area = 0.5 * PI * (r2 * r2 - r1 * r1);
        let axial = 2.0 * d * 0.25 * PI * (r2.powi(4) - r1.powi(4));
        let height = 2.0 * area * (half_m.powi(3) - (half_m - d).powi(3)) / 3.0;
        Moments {
            volume_m3: 2.0 * area * d,
            axial_m5: axial,
            transverse_m5: 0.5 * axial + height,
        }
    }
}
