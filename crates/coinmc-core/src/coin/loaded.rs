//! A coin whose centre of mass is not in the middle: a cylinder that is loaded towards one face.
//!
//! With the centre at the distance d from the middle, towards heads, heads is h = H/2 − d from it, tails
//! h' = H/2 + d. The moments are about the centre of mass. Where the transverse one is not given, the coin is
//! one of two layers, each as thick as half of it and uniform, as of two metals: relative to the uniform coin
//! mass has moved from one half to the mirrored places of the other, which leaves ∫z² dm about the middle as it
//! is, so that
//!
//! I_t/m = R²/4 + H²/12 − d².
//!
//! The lighter layer has no mass left at d = H/4; a coin with its centre farther out must say its moment.
//!
//! On its side it touches with both rims, and rests there, as its centre is between them. It rolls straight on.

use super::{Coin, CoinError};
use crate::schema::Bounds;

impl Coin {
    /// Distances of the centre of mass from the middle over H in configs.
    pub const CENTRE_OVER_HEIGHT: Bounds = Bounds::open(-0.5, 0.5);
    /// The same, up to which the moment of a coin of two layers is known.
    const OF_TWO_LAYERS: f64 = 0.25;

    /// The same coin with its centre of mass at `over_height` times H from the middle, on the axis: above 0
    /// nearer to heads, below 0 nearer to tails. Principal moments about that centre are in kg m²; without
    /// them they are those of a coin of two layers of different density, I_t/m = R²/4 + H²/12 − d².
    ///
    /// # Errors
    /// [`CoinError::Centre`] unless the centre is between the faces; [`CoinError::LoadedShape`] if the edge is
    /// conical or the rims are rounded; [`CoinError::LoadedMoment`] without a transverse moment beyond H/4;
    /// [`CoinError::AxialMoment`] and [`CoinError::TransverseMoment`] as of
    /// [`with_moments`](Self::with_moments).
    ///
    /// # Example
    /// ```
    /// use coinmc_core::Coin;
    /// let coin = Coin::cylinder(1.0, 0.01)?;
    /// assert_eq!(coin.with_centre_of_mass(0.0, None, None)?, coin);
    /// let [heads, tails] = coin.with_centre_of_mass(0.1, None, None)?.rims();
    /// assert!((heads.distance_m - 0.004).abs() < 1e-15 && (tails.distance_m - 0.006).abs() < 1e-15);
    /// assert!(coin.with_centre_of_mass(0.3, None, None).is_err());
    /// # Ok::<(), coinmc_core::CoinError>(())
    /// ```
    pub fn with_centre_of_mass(
        self,
        over_height: f64,
        axial_kg_m2: Option<f64>,
        transverse_kg_m2: Option<f64>,
    ) -> Result<Self, CoinError> {
        let stays = over_height == 0.0 && self.centre_over_height == 0.0;
        if stays && axial_kg_m2.is_none() && transverse_kg_m2.is_none() {
            return Ok(self);
        }
        let coin = if stays {
            self
        } else {
            self.moved_to(over_height, transverse_kg_m2.is_none())?
        };
        coin.with_moments(axial_kg_m2, transverse_kg_m2)
    }

    /// The coin with another centre, and the moment of two layers if it `needs` one.
    fn moved_to(self, over_height: f64, needs: bool) -> Result<Self, CoinError> {
        if !Self::CENTRE_OVER_HEIGHT.contains(over_height) {
            return Err(CoinError::Centre(over_height));
        }
        if self.is_conical() || self.rim_radius_m != 0.0 {
            return Err(CoinError::LoadedShape);
        }
        if needs && over_height.abs() > Self::OF_TWO_LAYERS {
            return Err(CoinError::LoadedMoment(over_height));
        }
        let [before, after] = [self.centre_over_height, over_height].map(|c| c * self.height_m());
        Ok(Self {
            centre_over_height: over_height,
            transverse_gyration_m2: self.transverse_gyration_m2 + before * before - after * after,
            ..self
        })
    }

    /// Distance of the centre of mass from the middle over H, towards heads, of a cylinder that is loaded; of a
    /// coin with a conical edge 0: its [`rims`](Self::rims) say where its centre is.
    pub fn centre_over_height(&self) -> f64 {
        self.centre_over_height
    }

    /// Whether heads and tails are mirror images: the edge is not conical, and the centre of mass is in the
    /// middle.
    pub fn has_like_faces(&self) -> bool {
        !self.is_conical() && self.centre_over_height == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coin() -> Coin {
        Coin::cylinder(1.5, 0.01).expect("a good coin")
    }

    /// Slices of two densities.
    #[test]
    fn two_layers_have_the_moment_of_thin_slices() {
        let (height, share, slices) = (0.015, 0.8, 20_000);
        let [mut mass, mut first, mut second] = [0.0; 3];
        for slice in 0..slices {
            let z = height * ((f64::from(slice) + 0.5) / f64::from(slices) - 0.5);
            let density = if z > 0.0 { share } else { 1.0 - share };
            mass += density;
            first += density * z;
            second += density * z * z;
        }
        let centre = first / mass;
        let loaded = coin().with_centre_of_mass(centre / height, None, None);
        let transverse = loaded.expect("a loaded coin").transverse_gyration_m2();
        let expected = 0.25 * 1e-4 + second / mass - centre * centre;
        assert!((transverse / expected - 1.0).abs() < 1e-8);
    }

    #[test]
    fn centres_are_between_the_faces_and_turn_over() {
        for bad in [0.5, -0.5, 0.7, f64::NAN, f64::INFINITY] {
            let found = coin().with_centre_of_mass(bad, None, Some(1e-7));
            assert!(matches!(found, Err(CoinError::Centre(_))), "{bad}");
        }
        let of = |centre| coin().with_centre_of_mass(centre, None, None);
        assert!(matches!(of(-0.26), Err(CoinError::LoadedMoment(_))));
        let [one, other] = [0.25, -0.25].map(|centre| of(centre).expect("two layers"));
        let [heads, tails] = one.rims();
        assert!(
            heads.distance_m < tails.distance_m,
            "heads is the heavier face"
        );
        assert_eq!(other.rims(), [tails, heads]);
        assert_eq!(one.transverse_gyration_m2(), other.transverse_gyration_m2());
        // moved back it is the coin of before, but for rounding
        let back = one.with_centre_of_mass(0.0, None, None).expect("a coin");
        assert!(back.has_like_faces() && !one.has_like_faces());
        let gyrations = [back, coin()].map(|coin| coin.transverse_gyration_m2());
        assert!((gyrations[0] / gyrations[1] - 1.0).abs() < 1e-15);
    }

    /// All mass on the axis at the faces: I_t = m h h'.
    #[test]
    fn moments_are_bounded_by_the_faces() {
        let far = |transverse| coin().with_centre_of_mass(0.4, Some(1e-12), Some(transverse));
        let most = 0.01 * (0.1 * 0.9) * 0.015 * 0.015;
        assert!(far(most * 0.999).is_ok());
        let beyond = far(most * 1.001);
        assert!(matches!(beyond, Err(CoinError::TransverseMoment { .. })));
    }

    #[test]
    fn other_shapes_are_not_loaded() {
        let conical = coin().with_draft(5.0).expect("a cone");
        let rounded = coin().with_rim_radius(1e-3).expect("rounded rims");
        for shape in [conical, rounded] {
            let found = shape.with_centre_of_mass(0.1, None, None);
            assert_eq!(found, Err(CoinError::LoadedShape));
            assert_eq!(shape.with_centre_of_mass(0.0, None, None), Ok(shape));
        }
        let loaded = coin().with_centre_of_mass(0.1, None, None).expect("loaded");
        assert_eq!(loaded.with_draft(5.0), Err(CoinError::LoadedShape));
        assert_eq!(loaded.with_rim_radius(1e-3), Err(CoinError::LoadedShape));
    }

    /// 10 g: I = 0.01 kg times the gyration.
    #[test]
    fn either_moment_may_be_given_alone() {
        let [plain, axial, transverse] = [(None, None), (Some(6e-7), None), (None, Some(5e-7))]
            .map(|(axial, transverse)| coin().with_centre_of_mass(0.1, axial, transverse))
            .map(|found| found.expect("a loaded coin"));
        assert!((axial.axial_gyration_m2() / 6e-5 - 1.0).abs() < 1e-14);
        assert_eq!(
            axial.transverse_gyration_m2(),
            plain.transverse_gyration_m2()
        );
        assert!((transverse.transverse_gyration_m2() / 5e-5 - 1.0).abs() < 1e-14);
        assert_eq!(transverse.axial_gyration_m2(), plain.axial_gyration_m2());
        for loaded in [plain, axial, transverse] {
            assert_eq!(loaded.centre_over_height(), 0.1);
        }
    }

    /// A moment about the middle that is too small for the new centre leaves none about that.
    #[test]
    fn a_centre_that_the_moments_do_not_allow_is_refused() {
        let coin =
            Coin::cylinder(4.0, 0.01).and_then(|coin| coin.with_moments(Some(5e-7), Some(2.5e-7)));
        let moved = coin
            .expect("a thin rod")
            .with_centre_of_mass(0.25, None, None);
        assert!(
            matches!(moved, Err(CoinError::TransverseMoment { .. })),
            "{moved:?}"
        );
    }
}
