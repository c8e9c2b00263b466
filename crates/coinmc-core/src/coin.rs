//! The coin: a body of revolution, in most cases a cylinder with its centre of mass in the middle.

mod conical;
mod keys;
mod loaded;
mod rounded;

pub use conical::Rim;

use nalgebra::Vector3;
use thiserror::Error;

/// Default mass. No outcome depends on it: under gravity, contact and Coulomb friction the mass cancels.
const DEFAULT_MASS_KG: f64 = 0.01;

/// A cylinder of height H, radius R and mass m, symmetric about its axis.
///
/// Moments of inertia are those of a uniform solid,
/// I_a = m R²/2 about the axis and I_t = m (3R² + H²)/12 about a diameter through the centre,
/// unless overridden for hollow or loaded coins.
///
/// # Example
/// ```
/// use coinmc_core::Coin;
/// let coin = Coin::cylinder(2.0, 0.01)?.with_mass(0.02)?;
/// assert_eq!(coin.ratio(), 2.0);
/// // mass-normalised, in units of R²: (3 + 4)/12
/// assert!((coin.transverse_gyration_m2() / 1e-4 - 7.0 / 12.0).abs() < 1e-15);
/// # Ok::<(), coinmc_core::CoinError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coin {
    ratio: f64,
    radius_m: f64,
    mass_kg: f64,
    /// Radius r of the rounding of both rims; 0: sharp edges.
    rim_radius_m: f64,
    /// Angle of the edge with the axis; 0: a cylinder.
    draft_deg: f64,
    /// Distance of the centre of mass from the middle of a cylinder, towards heads, over H.
    centre_over_height: f64,
    /// I_t/m and I_a/m.
    transverse_gyration_m2: f64,
    axial_gyration_m2: f64,
}

/// Why a coin cannot be built.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum CoinError {
    /// H/R is not a positive finite number.
    #[error("ratio H/R must be positive and finite, not {0}")]
    Ratio(f64),
    /// R is not a positive finite length.
    #[error("radius must be positive and finite, not {0} m")]
    Radius(f64),
    /// m is not a positive finite mass.
    #[error("mass must be positive and finite, not {0} kg")]
    Mass(f64),
    /// The rims' rounding does not leave a cylinder inside: 0 <= r < min(R, H/2).
    #[error(
        "rim radius must be at least 0 and below both R and H/2, here below {most} m, not {found} m"
    )]
    RimRadius {
        /// The requested radius, m.
        found: f64,
        /// min(R, H/2), m.
        most: f64,
    },
    /// The coin would not rest on its conical edge, or has no narrower face.
    #[error(
        "draft must be below {most:.3}° to either side with this ratio, not {found}°: beyond, a coin does \
         not rest on its edge, but tips onto its narrower face"
    )]
    Draft {
        /// The requested angle, degrees.
        found: f64,
        /// The largest angle, degrees.
        most: f64,
    },
    /// A conical edge with rounded rims.
    #[error("a coin with a conical edge has sharp rims: its rim radius must be 0")]
    RoundedDraft,
    /// The centre of mass is not between the faces.
    #[error(
        "the centre of mass must lie between the faces, at above -0.5 and below 0.5 of H from the middle, \
         not at {0}"
    )]
    Centre(f64),
    /// A centre of mass that is not in the middle, of a coin that is no sharp cylinder.
    #[error(
        "a coin with its centre of mass off the middle is a cylinder with sharp rims: its draft and rim radius \
         must be 0"
    )]
    LoadedShape,
    /// A centre of mass for which the transverse moment has no default.
    #[error(
        "with the centre of mass at {0} of H from the middle `transverse_moment_kg_m2` must be given: without it \
         the coin is of two uniform layers, which puts the centre at most 0.25 of H from the middle"
    )]
    LoadedMoment(f64),
    /// No body inside the cylinder has this axial moment: 0 < I_a <= m R².
    #[error(
        "axial moment {found:e} kg m² is impossible: a body inside the cylinder has 0 < I_a <= {most:e}"
    )]
    AxialMoment {
        /// The requested moment, kg m².
        found: f64,
        /// m R², kg m².
        most: f64,
    },
    /// No body inside the cylinder has this transverse moment: I_a/2 <= I_t <= I_a/2 + m H²/4.
    #[error(
        "transverse moment {found:e} kg m² is impossible: with this axial moment a body inside the cylinder has {least:e} <= I_t <= {most:e}"
    )]
    TransverseMoment {
        /// The requested moment, kg m².
        found: f64,
        /// I_a/2, kg m².
        least: f64,
        /// I_a/2 + m H²/4, kg m².
        most: f64,
    },
}

impl Coin {
    /// A uniform solid cylinder of ratio H/R and radius `radius_m`, 10 g unless
    /// [`with_mass`](Self::with_mass) says otherwise.
    ///
    /// # Errors
    /// [`CoinError::Ratio`] or [`CoinError::Radius`] unless both are positive and finite.
    pub fn cylinder(ratio: f64, radius_m: f64) -> Result<Self, CoinError> {
        if !(ratio > 0.0 && ratio.is_finite()) {
            return Err(CoinError::Ratio(ratio));
        }
        if !(radius_m > 0.0 && radius_m.is_finite()) {
            return Err(CoinError::Radius(radius_m));
        }
        let r2 = radius_m * radius_m;
        Ok(Self {
            ratio,
            radius_m,
            mass_kg: DEFAULT_MASS_KG,
            rim_radius_m: 0.0,
            draft_deg: 0.0,
            centre_over_height: 0.0,
            transverse_gyration_m2: r2 * (3.0 + ratio * ratio) / 12.0,
            axial_gyration_m2: r2 / 2.0,
        })
    }

    /// The same shape and mass distribution with total mass `mass_kg`.
    ///
    /// # Errors
    /// [`CoinError::Mass`] unless positive and finite.
    pub fn with_mass(self, mass_kg: f64) -> Result<Self, CoinError> {
        if mass_kg > 0.0 && mass_kg.is_finite() {
            Ok(Self { mass_kg, ..self })
        } else {
            Err(CoinError::Mass(mass_kg))
        }
    }

    /// The same coin, uniform and solid, with both rims rounded with the radius r: every point within
    /// r of a cylinder of radius R − r and height H − 2r. R and H stay the outer measures.
    ///
    /// # Errors
    /// [`CoinError::RimRadius`] unless 0 <= r < min(R, H/2); [`CoinError::RoundedDraft`] if the edge is
    /// conical, [`CoinError::LoadedShape`] if the centre of mass is off the middle.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::Coin;
    /// let euro = Coin::cylinder(0.2, 0.0116)?.with_rim_radius(3e-4)?;
    /// // it balances where its centre is above the inner cylinder's edge
    /// assert!((euro.inner_ratio() - (0.00232 - 0.0006) / 0.0113).abs() < 1e-12);
    /// assert!(Coin::cylinder(0.2, 0.0116)?.with_rim_radius(0.0012).is_err());
    /// # Ok::<(), coinmc_core::CoinError>(())
    /// ```
    pub fn with_rim_radius(self, rim_radius_m: f64) -> Result<Self, CoinError> {
        let most = self.radius_m.min(self.height_m() / 2.0);
        if !(rim_radius_m >= 0.0 && rim_radius_m < most) {
            return Err(CoinError::RimRadius {
                found: rim_radius_m,
                most,
            });
        }
        if rim_radius_m != 0.0 && self.is_conical() {
            return Err(CoinError::RoundedDraft);
        }
        if rim_radius_m != 0.0 && self.centre_over_height != 0.0 {
            return Err(CoinError::LoadedShape);
        }
        let coin = Self {
            rim_radius_m,
            ..self
        };
        if rim_radius_m == self.rim_radius_m {
            return Ok(coin);
        }
        let (transverse, axial) =
            rounded::gyrations(self.ratio / 2.0, rim_radius_m / self.radius_m);
        let r2 = self.radius_m * self.radius_m;
        Ok(Self {
            transverse_gyration_m2: transverse * r2,
            axial_gyration_m2: axial * r2,
            ..coin
        })
    }

    /// The same coin with other principal moments about its centre, in kg m², as a hollow or
    /// loaded coin has. `None` keeps a moment.
    ///
    /// For mass anywhere inside the cylinder, spread evenly around the axis,
    /// I_a = ∫ρ² dm <= m R² and I_t = I_a/2 + ∫z² dm <= I_a/2 + m H²/4. (With the centre at h and h' from
    /// the faces ∫z² dm <= m h h'. That of a conical coin stays that of the uniform solid; a cylinder's may be
    /// [elsewhere](Self::with_centre_of_mass).)
    ///
    /// # Errors
    /// [`CoinError::AxialMoment`] or [`CoinError::TransverseMoment`] outside those bounds.
    pub fn with_moments(
        self,
        axial_kg_m2: Option<f64>,
        transverse_kg_m2: Option<f64>,
    ) -> Result<Self, CoinError> {
        // The bounds are met to round-off by a thin ring and a bar: allow that much.
        const SLACK: f64 = 1.0 + 1e-12;
        let axial = axial_kg_m2.map_or(self.axial_gyration_m2, |i| i / self.mass_kg);
        let transverse = transverse_kg_m2.map_or(self.transverse_gyration_m2, |i| i / self.mass_kg);
        let most_axial = self.radius_m * self.radius_m;
        if !(axial > 0.0 && axial <= most_axial * SLACK) {
            return Err(CoinError::AxialMoment {
                found: axial * self.mass_kg,
                most: most_axial * self.mass_kg,
            });
        }
        let spread = if self.has_like_faces() {
            self.height_m().powi(2) / 4.0
        } else {
            let [heads, tails] = self.rims();
            heads.distance_m * tails.distance_m
        };
        let (least, most) = (axial / 2.0, axial / 2.0 + spread);
        if !(transverse * SLACK >= least && transverse <= most * SLACK) {
            return Err(CoinError::TransverseMoment {
                found: transverse * self.mass_kg,
                least: least * self.mass_kg,
                most: most * self.mass_kg,
            });
        }
        Ok(Self {
            transverse_gyration_m2: transverse,
            axial_gyration_m2: axial,
            ..self
        })
    }

    /// H/R, height over radius.
    pub fn ratio(&self) -> f64 {
        self.ratio
    }

    /// Radius R, m.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Height (thickness) H, m.
    pub fn height_m(&self) -> f64 {
        self.ratio * self.radius_m
    }

    /// Mass m, kg.
    pub fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// Radius r of the rounding of both rims, m; 0: sharp edges.
    pub fn rim_radius_m(&self) -> f64 {
        self.rim_radius_m
    }

    /// Height over radius of the cylinder to which the rims' rounding adds a layer of thickness r:
    /// (H − 2r)/(R − r). H/R for sharp edges.
    pub fn inner_ratio(&self) -> f64 {
        let rim = self.rim_radius_m / self.radius_m;
        (self.ratio - 2.0 * rim) / (1.0 - rim)
    }

    /// The coin's lowest point relative to its centre, m, where its axis points along the unit vector
    /// `axis`. Of a coin that is level on its face or side, the middle of what is lowest.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::Coin;
    /// use nalgebra::Vector3;
    /// let coin = Coin::cylinder(2.0, 0.01)?;
    /// assert_eq!(coin.lowest_point_m(&Vector3::z()), Vector3::new(0.0, 0.0, -0.01));
    /// let tilted = Vector3::new(0.6, 0.0, 0.8);
    /// assert!((coin.lowest_point_m(&tilted).z + 0.01 * (0.8 + 0.6)).abs() < 1e-15);
    /// # Ok::<(), coinmc_core::CoinError>(())
    /// ```
    pub fn lowest_point_m(&self, axis: &Vector3<f64>) -> Vector3<f64> {
        /// Sine of a tilt that counts as none.
        const LEVEL: f64 = 1e-9;
        if !self.has_like_faces() {
            return self.lowest_of_rims_m(axis, LEVEL);
        }
        let rim = self.rim_radius_m;
        let half = 0.5 * self.height_m() - rim;
        let mut point = Vector3::new(0.0, 0.0, -rim);
        if axis.z != 0.0 {
            point -= axis * half.copysign(axis.z);
        }
        let across = (axis.x * axis.x + axis.y * axis.y).sqrt();
        if across >= LEVEL {
            point += (axis * axis.z - Vector3::z()) * ((self.radius_m - rim) / across);
        }
        point
    }

    /// [`lowest_point_m`](Self::lowest_point_m) of a coin whose faces are not alike.
    fn lowest_of_rims_m(&self, axis: &Vector3<f64>, level: f64) -> Vector3<f64> {
        let across = (axis.x * axis.x + axis.y * axis.y).sqrt();
        let down = if across >= level {
            (axis * axis.z - Vector3::z()) / across
        } else {
            Vector3::zeros()
        };
        let [heads, tails] = self.rims();
        let heads = axis * heads.distance_m + down * heads.radius_m;
        let tails = -axis * tails.distance_m + down * tails.radius_m;
        if (heads.z - tails.z).abs() < level * self.radius_m {
            (heads + tails) / 2.0
        } else if heads.z < tails.z {
            heads
        } else {
            tails
        }
    }

    /// D = sqrt(R² + H²/4), the distance from the centre to the rim, m: the centre's height when
    /// the coin balances on its rim, hence the barrier m g D between face and side. With rounded rims
    /// the distance to the edge of the cylinder inside, sqrt((R − r)² + (H/2 − r)²): then the coin
    /// balances with its centre at D + r. With a conical edge, or the centre off the
    /// middle, that of the farther rim.
    pub fn rim_distance_m(&self) -> f64 {
        if !self.has_like_faces() {
            let [heads, tails] = self.rims();
            return heads.reach_m().max(tails.reach_m());
        }
        let half = self.inner_ratio() / 2.0;
        (self.radius_m - self.rim_radius_m) * (1.0 + half * half).sqrt()
    }

    /// (R/D, H/2D) with D the [rim distance](Self::rim_distance_m), of the cylinder inside if the rims
    /// are rounded: the coin's shape in units in which its rim is at distance 1 from the centre.
    /// Computed from ratios alone, so that a coin at another scale has bit-identical values and no ratio
    /// overflows.
    pub fn shape_by_rim_distance(&self) -> (f64, f64) {
        let half = self.inner_ratio() / 2.0;
        if half <= 1.0 {
            let hypotenuse = (1.0 + half * half).sqrt();
            (1.0 / hypotenuse, half / hypotenuse)
        } else {
            let hypotenuse = (1.0 + 1.0 / (half * half)).sqrt();
            (1.0 / half / hypotenuse, 1.0 / hypotenuse)
        }
    }

    /// I_t/m about a diameter through the centre, m² ((3R² + H²)/12 when uniform).
    pub fn transverse_gyration_m2(&self) -> f64 {
        self.transverse_gyration_m2
    }

    /// I_a/m about the coin's own axis, m² (R²/2 when uniform).
    pub fn axial_gyration_m2(&self) -> f64 {
        self.axial_gyration_m2
    }
}

#[cfg(test)]
mod tests;
