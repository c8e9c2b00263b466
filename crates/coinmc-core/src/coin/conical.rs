//! A coin with a conical edge: the frustum of a cone.
//!
//! Lengths in R, the radius of the wider face; z is the distance from that face, H the height, b the radius
//! of the narrower face. The section at z has the radius ρ = 1 − (1 − b) z/H. Per unit density,
//!
//! V = π ∫ρ² dz,  I_a = (π/2) ∫ρ⁴ dz,  ⟨z⟩ = π ∫z ρ² dz/V,  I_t/m = I_a/2m + ⟨z²⟩ − ⟨z⟩².
//!
//! With q = 1 + b + b² these are πHq/3 = V, I_a/m = (3/10)(1 + b + b² + b³ + b⁴)/q, ⟨z⟩ = (H/4)(1 + 2b +
//! 3b²)/q and ⟨z²⟩ = (H²/10)(1 + 3b + 6b²)/q.
//!
//! On its edge the coin touches along a line from rim to rim. It rests there if its centre of mass is
//! above that line: always so for the wider rim, for the narrower one if tan α < h/b, with α the draft and
//! h = H − ⟨z⟩ its distance from the centre. A coin with more draft has no side to rest on: it tips onto
//! its narrower face.

use super::{Coin, CoinError};
use crate::schema::Bounds;

/// One of the two rims of a coin, from its centre of mass.
///
/// # Example
/// ```
/// use coinmc_core::Coin;
/// let [heads, tails] = Coin::cylinder(1.0, 0.01)?.with_draft(10.0)?.rims();
/// assert_eq!(heads.radius_m, 0.01);
/// assert!((tails.radius_m - (0.01 - 0.01 * 10.0_f64.to_radians().tan())).abs() < 1e-15);
/// assert!(heads.distance_m < tails.distance_m);
/// # Ok::<(), coinmc_core::CoinError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rim {
    /// Radius, m; of the edge of the cylinder inside if the rims are rounded.
    pub radius_m: f64,
    /// Distance of its plane from the centre of mass, m.
    pub distance_m: f64,
}

impl Rim {
    /// Distance of the rim itself from the centre of mass, m.
    pub(super) fn reach_m(&self) -> f64 {
        libm::hypot(self.radius_m, self.distance_m)
    }
}

/// A frustum in R: what its moments are made of.
struct Frustum {
    narrow: f64,
    /// Distance of the centre of mass from the wider face.
    centre: f64,
    /// I_t/m and I_a/m, R².
    transverse: f64,
    axial: f64,
}

impl Frustum {
    /// Of height `height`, whose radius falls by `slope` in a unit of height.
    fn new(height: f64, slope: f64) -> Self {
        let b = 1.0 - slope * height;
        let q = 1.0 + b + b * b;
        let centre = 0.25 * height * (1.0 + b * (2.0 + 3.0 * b)) / q;
        let square = 0.1 * height * height * (1.0 + b * (3.0 + 6.0 * b)) / q;
        let axial = 0.3 * (1.0 + b * (1.0 + b * (1.0 + b * (1.0 + b)))) / q;
        Self {
            narrow: b,
            centre,
            transverse: 0.5 * axial + square - centre * centre,
            axial,
        }
    }

    /// Whether there is a narrower face, and the coin rests on its edge.
    fn rests_on_edge(height: f64, slope: f64) -> bool {
        let Self { narrow, centre, .. } = Self::new(height, slope);
        narrow > 0.0 && slope * narrow < height - centre
    }
}

impl Coin {
    /// Angles of the edge with the axis in configs, degrees.
    pub const DRAFT_DEG: Bounds = Bounds::open(-45.0, 45.0);

    /// The same coin, uniform and solid, with a conical edge at the angle `draft_deg` (degrees) to the
    /// axis. Above 0 the face heads is the wider one, below 0 tails. R is the radius of the wider face,
    /// H the distance of the faces.
    ///
    /// # Errors
    /// [`CoinError::Draft`] where no narrower face is left or the coin would not rest on its edge, and
    /// beyond 45 degrees; [`CoinError::RoundedDraft`] if the rims are rounded; [`CoinError::LoadedShape`] if the
    /// centre of mass is off the middle.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::Coin;
    /// let coin = Coin::cylinder(1.0, 0.01)?;
    /// assert_eq!(coin.with_draft(0.0)?, coin);
    /// assert!(coin.with_draft(10.0).is_ok());
    /// // half a millimetre high: it would tip off its edge
    /// assert!(Coin::cylinder(0.05, 0.01)?.with_draft(10.0).is_err());
    /// # Ok::<(), coinmc_core::CoinError>(())
    /// ```
    pub fn with_draft(self, draft_deg: f64) -> Result<Self, CoinError> {
        if draft_deg == 0.0 && self.draft_deg == 0.0 {
            return Ok(self);
        }
        if draft_deg != 0.0 && self.rim_radius_m != 0.0 {
            return Err(CoinError::RoundedDraft);
        }
        if draft_deg != 0.0 && self.centre_over_height != 0.0 {
            return Err(CoinError::LoadedShape);
        }
        let slope = libm::tan(draft_deg.abs().to_radians());
        let allowed = draft_deg.abs() < Self::DRAFT_DEG.high;
        if !(allowed && Frustum::rests_on_edge(self.ratio, slope)) {
            return Err(CoinError::Draft {
                found: draft_deg,
                most: most_draft_deg(self.ratio),
            });
        }
        let frustum = Frustum::new(self.ratio, slope);
        let r2 = self.radius_m * self.radius_m;
        Ok(Self {
            draft_deg,
            transverse_gyration_m2: frustum.transverse * r2,
            axial_gyration_m2: frustum.axial * r2,
            ..self
        })
    }

    /// The ratios H/R between which a coin with a conical edge rests on it.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::Coin;
    /// let [thin, _] = Coin::ratios_with_draft(5.0);
    /// let with = |ratio: f64| Coin::cylinder(ratio, 0.01).and_then(|coin| coin.with_draft(5.0));
    /// assert!(with(0.99 * thin).is_err() && with(1.01 * thin).is_ok());
    /// ```
    pub fn ratios_with_draft(draft_deg: f64) -> [f64; 2] {
        let slope = libm::tan(draft_deg.abs().to_radians());
        let apex = 1.0 / slope;
        if slope == 0.0 {
            return [0.0, apex];
        }
        // near the apex of the cone it rests on its edge
        let (mut low, mut high) = (0.0, 0.999 * apex);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if Frustum::rests_on_edge(middle, slope) {
                high = middle;
            } else {
                low = middle;
            }
        }
        [high, apex]
    }

    /// The angle of the edge with the axis, degrees: above 0 heads is the wider face, below 0 tails; 0 for
    /// a cylinder.
    pub fn draft_deg(&self) -> f64 {
        self.draft_deg
    }

    /// Whether the edge is conical.
    pub fn is_conical(&self) -> bool {
        self.draft_deg != 0.0
    }

    /// The rims of heads and of tails.
    pub fn rims(&self) -> [Rim; 2] {
        if self.centre_over_height != 0.0 {
            return [0.5 - self.centre_over_height, 0.5 + self.centre_over_height].map(|share| {
                Rim {
                    radius_m: self.radius_m,
                    distance_m: share * self.height_m(),
                }
            });
        }
        if !self.is_conical() {
            let rim = Rim {
                radius_m: self.radius_m - self.rim_radius_m,
                distance_m: 0.5 * self.height_m() - self.rim_radius_m,
            };
            return [rim; 2];
        }
        let slope = libm::tan(self.draft_deg.abs().to_radians());
        let Frustum { narrow, centre, .. } = Frustum::new(self.ratio, slope);
        let rim = |radius: f64, distance: f64| Rim {
            radius_m: radius * self.radius_m,
            distance_m: distance * self.radius_m,
        };
        let (wide, narrow) = (rim(1.0, centre), rim(narrow, self.ratio - centre));
        if self.draft_deg > 0.0 {
            [wide, narrow]
        } else {
            [narrow, wide]
        }
    }

    /// Radius and distance from the centre of mass of the faces of heads and of tails, by the outer measures:
    /// what a picture shows. Of a cylinder R and H/2, also where its rims are rounded; of a coin whose faces
    /// are not alike its [`rims`](Self::rims).
    pub fn outer_rims(&self) -> [Rim; 2] {
        if !self.has_like_faces() {
            return self.rims();
        }
        let rim = Rim {
            radius_m: self.radius_m,
            distance_m: 0.5 * self.height_m(),
        };
        [rim; 2]
    }
}

/// The draft, degrees, below which a coin of this ratio rests on its edge.
fn most_draft_deg(ratio: f64) -> f64 {
    let (mut low, mut high) = (0.0, Coin::DRAFT_DEG.high);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (low + high);
        if Frustum::rests_on_edge(ratio, libm::tan(middle.to_radians())) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments of many thin slices.
    fn sliced(ratio: f64, slope: f64) -> [f64; 3] {
        let slices = 20_000;
        let (mut mass, mut first, mut second, mut axial) = (0.0, 0.0, 0.0, 0.0);
        for slice in 0..slices {
            let z = ratio * (f64::from(slice) + 0.5) / f64::from(slices);
            let square = (1.0 - slope * z).powi(2);
            mass += square;
            first += z * square;
            second += z * z * square;
            axial += 0.5 * square * square;
        }
        let (centre, axial) = (first / mass, axial / mass);
        [centre, 0.5 * axial + second / mass - centre * centre, axial]
    }

    #[test]
    fn centre_and_moments_are_those_of_thin_slices() {
        for (ratio, draft_deg) in [(0.2, 4.0), (1.0, 12.0), (2.0, -20.0)] {
            let radius: f64 = 0.02;
            let coin = Coin::cylinder(ratio, radius).and_then(|coin| coin.with_draft(draft_deg));
            let coin = coin.expect("a coin that rests on its edge");
            let slope = libm::tan(draft_deg.abs().to_radians());
            let [heads, tails] = coin.rims();
            let wide = if draft_deg > 0.0 { heads } else { tails };
            let found = [
                wide.distance_m / radius,
                coin.transverse_gyration_m2 / radius.powi(2),
                coin.axial_gyration_m2 / radius.powi(2),
            ];
            for (found, expected) in found.iter().zip(sliced(ratio, slope)) {
                assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected}");
            }
        }
    }

    /// A cone of height H has its centre at H/4, I_a = 3/10 m R², I_t = 3/80 m (4R² + H²).
    #[test]
    fn a_pointed_coin_is_a_cone() {
        let cone = Frustum::new(2.0, 0.5);
        assert_eq!([cone.narrow, cone.centre, cone.axial], [0.0, 0.5, 0.3]);
        assert!((cone.transverse - 3.0 / 80.0 * 8.0).abs() < 1e-15);
    }

    #[test]
    fn the_draft_below_which_a_coin_rests_on_its_edge() {
        let coin = Coin::cylinder(0.2, 0.01).expect("a good coin");
        let Err(CoinError::Draft { most, .. }) = coin.with_draft(20.0) else {
            panic!("a thin coin with much draft")
        };
        assert!(coin.with_draft(0.999 * most).is_ok() && coin.with_draft(1.001 * most).is_err());
        let [_, narrow] = coin.with_draft(most - 1e-9).expect("just below").rims();
        let slope = libm::tan(most.to_radians());
        assert!((slope - narrow.distance_m / narrow.radius_m).abs() < 1e-6);
    }

    #[test]
    fn the_point_of_a_cone_is_no_face() {
        assert!(!Frustum::rests_on_edge(2.0, 0.5));
        assert!(Frustum::rests_on_edge(1.999, 0.5));
    }

    #[test]
    fn a_draft_of_0_gives_a_cylinder() {
        let cylinder = Coin::cylinder(1.0, 0.02).expect("a good coin");
        let conical = cylinder.with_draft(10.0).expect("a cone");
        assert_eq!([conical.draft_deg(), cylinder.draft_deg()], [10.0, 0.0]);
        let back = conical.with_draft(0.0).expect("a cylinder");
        assert!(conical.is_conical() && !back.is_conical());
        assert!((back.axial_gyration_m2 / cylinder.axial_gyration_m2 - 1.0).abs() < 1e-15);
        // of a coin that is none but a cylinder it changes nothing
        let hollow = cylinder.with_moments(Some(1.8e-6), None).expect("hollow");
        assert_eq!(hollow.with_draft(0.0), Ok(hollow));
    }

    #[test]
    fn a_draft_of_45_degrees_is_too_much() {
        let coin = Coin::cylinder(0.9, 0.02).expect("a good coin");
        for side in [1.0, -1.0] {
            assert!(coin.with_draft(side * 44.9).is_ok());
            let beyond = coin.with_draft(side * 45.0);
            assert!(matches!(beyond, Err(CoinError::Draft { .. })));
        }
    }

    /// The thickest coin is nearly the cone to its point, at H = R/tan α; the thinnest would tip.
    #[test]
    fn a_coin_rests_on_its_edge_between_two_ratios() {
        for draft_deg in [1.0_f64, -5.0, 20.0, 40.0] {
            let [thin, thick] = Coin::ratios_with_draft(draft_deg);
            let apex = 1.0 / libm::tan(draft_deg.abs().to_radians());
            assert!((thick / apex - 1.0).abs() < 1e-14);
            for (ratio, rests) in [
                (thin * (1.0 - 1e-9), false),
                (thin * (1.0 + 1e-9), true),
                (0.5 * (thin + thick), true),
                (thick * (1.0 - 1e-9), true),
                (thick * (1.0 + 1e-9), false),
            ] {
                let coin = Coin::cylinder(ratio, 0.02).expect("a good coin");
                assert_eq!(
                    coin.with_draft(draft_deg).is_ok(),
                    rests,
                    "{draft_deg} {ratio}"
                );
            }
        }
        assert_eq!(Coin::ratios_with_draft(0.0), [0.0, f64::INFINITY]);
    }

    /// R = 20 mm and H = 16 mm, in mm below.
    #[test]
    fn rims_are_those_of_the_cylinder_inside_and_pictures_show_the_outer_ones() {
        let coin = Coin::cylinder(0.8, 0.02).expect("a good coin");
        let in_mm = |rims: [Rim; 2]| rims.map(|rim| [1e3 * rim.radius_m, 1e3 * rim.distance_m]);
        let same = |found: [Rim; 2], expected: [[f64; 2]; 2]| {
            let pairs = in_mm(found).into_iter().zip(expected);
            pairs
                .flat_map(|(found, expected)| found.into_iter().zip(expected))
                .all(|(found, expected)| (found - expected).abs() < 1e-12)
        };
        let rounded = coin.with_rim_radius(3e-3).expect("rounded rims");
        assert!(same(rounded.rims(), [[17.0, 5.0]; 2]));
        assert!(same(rounded.outer_rims(), [[20.0, 8.0]; 2]));
        let loaded = coin.with_centre_of_mass(0.125, None, None).expect("loaded");
        assert!(same(loaded.outer_rims(), [[20.0, 6.0], [20.0, 10.0]]));
        let conical = coin.with_draft(-10.0).expect("a cone");
        let [heads, tails] = conical.outer_rims();
        let narrow = 0.02 - 0.016 * libm::tan(10_f64.to_radians());
        assert!((heads.radius_m - narrow).abs() < 1e-15 && tails.radius_m == 0.02);
        assert!((heads.distance_m + tails.distance_m - 0.016).abs() < 1e-15);
    }
}
