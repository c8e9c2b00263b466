//! Volume and moments of inertia in closed form.
//!
//! The radius of a section of the coin at the height z is ρ = R up to |z| = b = H/2 − e, where e is the
//! edge's size, and a + w(t) at |z| = b + t, with a = R − e and
//!
//! w(t) = sqrt(e² − t²) for a rounded edge, e − t for a chamfer.
//!
//! A slice of thickness dz has the volume πρ² dz, the axial moment (π/2)ρ⁴ dz, and half of this plus
//! z² πρ² dz about a diameter. So, with the integrals ∫ over t from 0 to e, for both halves,
//!
//! V = 2π (R² b + ∫ρ²),  I_a = π (R⁴ b + ∫ρ⁴),  I_t = I_a/2 + 2π (R² b³/3 + ∫(b + t)² ρ²).
//!
//! Expanding ρ = a + w leaves integrals of w^p t^q, which are pure numbers times e^{p+q+1}.
//!
//! A conical edge: ρ = m + s z with m = (R₊ + R₋)/2 and s = (R₊ − R₋)/H, R₊ the radius of heads. All odd powers
//! of z drop out of ∫ρ^p dz from −h to h = H/2, so with t = s h
//!
//! V = 2πh (m² + t²/3),  I_a = πh (m⁴ + 2 m² t² + t⁴/5),
//! ∫z dV = (4π/3) m t h²,  ∫z² dV = 2πh³ (m²/3 + t²/5).

use crate::shape::{Edge, Shape};
use std::f64::consts::PI;
use std::ops::Sub;

/// Volume, and moments of inertia about the centre of mass per unit of density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Volume, m³.
    pub volume_m3: f64,
    /// Moment of inertia about the axis over density, m⁵.
    pub axial_m5: f64,
    /// Moment of inertia about any diameter through the centre over density, m⁵.
    pub transverse_m5: f64,
}

impl Moments {
    /// Those of a sharp cylinder about its centre.
    pub(crate) fn cylinder(radius_m: f64, height_m: f64) -> Self {
        let (r2, h2) = (radius_m * radius_m, height_m * height_m);
        let volume = PI * r2 * height_m;
        Self {
            volume_m3: volume,
            axial_m5: volume * r2 / 2.0,
            transverse_m5: volume * (3.0 * r2 + h2) / 12.0,
        }
    }

    /// Those of a body that has the given fraction of the density.
    pub(crate) fn scaled(self, fraction: f64) -> Self {
        Self {
            volume_m3: fraction * self.volume_m3,
            axial_m5: fraction * self.axial_m5,
            transverse_m5: fraction * self.transverse_m5,
        }
    }
}

/// Cuts a body out of another with the same centre.
impl Sub for Moments {
    type Output = Self;

    fn sub(self, cut: Self) -> Self {
        Self {
            volume_m3: self.volume_m3 - cut.volume_m3,
            axial_m5: self.axial_m5 - cut.axial_m5,
            transverse_m5: self.transverse_m5 - cut.transverse_m5,
        }
    }
}

impl Shape {
    /// Volume and moments of inertia, exact but for rounding.
    ///
    /// ```
    /// use coinmc_solid::{Edge, Shape};
    /// let moments = Shape::new(0.02, 0.002, Edge::Sharp)?.moments();
    /// assert!((moments.axial_m5 / moments.volume_m3 - 0.01 * 0.01 / 2.0).abs() < 1e-18);
    /// # Ok::<(), coinmc_solid::ShapeError>(())
    /// ```
    pub fn moments(&self) -> Moments {
        let half = self.thickness_m() / 2.0;
        let body = if self.draft_deg() == 0.0 {
            turned(self.radius_m(), half, self.edge())
        } else {
            frustum(self.face_radii_m(), half).0
        };
        match self.marks() {
            Some(marks) => body - marks.moments(half),
            None => body,
        }
    }

    /// Height of the centre of mass above the middle between the faces, towards heads, m: 0 unless there is a
    /// draft.
    pub fn centre_m(&self) -> f64 {
        if self.draft_deg() == 0.0 {
            return 0.0;
        }
        frustum(self.face_radii_m(), self.thickness_m() / 2.0).1
    }

    /// Volume in m³, exact but for rounding.
    pub fn volume_m3(&self) -> f64 {
        self.moments().volume_m3
    }
}

/// Moments about the centre of mass of a frustum with these radii of heads and tails, and the height of that
/// centre above the middle.
fn frustum([heads, tails]: [f64; 2], half: f64) -> (Moments, f64) {
    let (mean, tilt) = (0.5 * (heads + tails), 0.5 * (heads - tails));
    let (m2, t2) = (mean * mean, tilt * tilt);
    let volume = 2.0 * PI * half * (m2 + t2 / 3.0);
    let axial = PI * half * (m2 * m2 + 2.0 * m2 * t2 + t2 * t2 / 5.0);
    let centre = 4.0 / 3.0 * PI * mean * tilt * half * half / volume;
    let height = 2.0 * PI * half.powi(3) * (m2 / 3.0 + t2 / 5.0) - volume * centre * centre;
    let moments = Moments {
        volume_m3: volume,
        axial_m5: axial,
        transverse_m5: 0.5 * axial + height,
    };
    (moments, centre)
}

/// ∫w^p t^q dt over the edge, in e^{p+q+1}.
struct EdgeIntegrals {
    /// q = 0; p = 1, 2, 3, 4.
    w: [f64; 4],
    /// q = 1; p = 1, 2.
    wt: [f64; 2],
    /// q = 2; p = 1, 2.
    wtt: [f64; 2],
}

/// t = e sin θ: ∫ cos^{p+1} θ sin^q θ dθ over a quarter turn.
const ROUNDED: EdgeIntegrals = EdgeIntegrals {
    w: [PI / 4.0, 2.0 / 3.0, 3.0 * PI / 16.0, 8.0 / 15.0],
    wt: [1.0 / 3.0, 1.0 / 4.0],
    wtt: [PI / 16.0, 2.0 / 15.0],
};

/// ∫ (1 − t)^p t^q dt = p! q!/(p + q + 1)!
const CHAMFERED: EdgeIntegrals = EdgeIntegrals {
    w: [1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0],
    wt: [1.0 / 6.0, 1.0 / 12.0],
    wtt: [1.0 / 12.0, 1.0 / 30.0],
};

/// Moments of the coin without marks.
fn turned(radius: f64, half: f64, edge: Edge) -> Moments {
    let integrals = match edge {
        Edge::Sharp => return Moments::cylinder(radius, 2.0 * half),
        Edge::Rounded { .. } => ROUNDED,
        Edge::Chamfered { .. } => CHAMFERED,
    };
    let e = edge.size_m();
    let EdgeIntegrals {
        w: [w1, w2, w3, w4],
        wt: [w1t, w2t],
        wtt: [w1tt, w2tt],
    } = integrals;
    let (a, b) = (radius - e, half - e);
    // in units of e, so that every integral is a pure number
    let (u, v) = (a / e, b / e);
    let rho2 = u * u + 2.0 * u * w1 + w2;
    let rho2_t = u * u / 2.0 + 2.0 * u * w1t + w2t;
    let rho2_tt = u * u / 3.0 + 2.0 * u * w1tt + w2tt;
    let rho4 = u.powi(4) + 4.0 * u.powi(3) * w1 + 6.0 * u * u * w2 + 4.0 * u * w3 + w4;
    let r2 = (u + 1.0) * (u + 1.0);
    let axial = PI * (r2 * r2 * v + rho4);
    let height = 2.0 * PI * (r2 * v.powi(3) / 3.0 + v * v * rho2 + 2.0 * v * rho2_t + rho2_tt);
    Moments {
        volume_m3: 2.0 * PI * (r2 * v + rho2) * e.powi(3),
        axial_m5: axial * e.powi(5),
        transverse_m5: (0.5 * axial + height) * e.powi(5),
    }
}
