//! The roughness of the surface: a random height field by two numbers.

use crate::Coin;
use std::f64::consts::TAU;
use thiserror::Error;

/// How rough the surface is.
///
/// The ground is z = h(x, y), a stationary, isotropic Gaussian random field with mean 0 and correlation
/// ⟨h(0) h(r)⟩ = σ² exp(−r²/(2ℓ²)). Both of its numbers can be measured on a profile, a straight cut
/// through the ground:
///
/// * the **slope** s, the root mean square of dh/dx along any direction: s² = −C''(0) = σ²/ℓ². It is the
///   Rdq of a profilometer, as a number and not in degrees.
/// * the **wavelength** λ, the mean distance between points where a profile crosses its mean upwards.
///   By Rice's formula there are sqrt(−C''(0)/C(0))/2π = 1/(2πℓ) of them per length, so λ = 2πσ/s.
///
/// Hence the height σ = sλ/2π (the Rq of a profilometer) and the correlation length ℓ = λ/2π.
///
/// Sources: Rice, Bell Syst. Tech. J. 24 (1945) 46; Longuet-Higgins, Phil. Trans. R. Soc. A 249 (1957)
/// 321 (random surfaces); ISO 4287 (Rq, Rdq, RSm).
///
/// # Example
/// ```
/// use coinmc_core::Roughness;
/// let wood = Roughness::new(0.03, 2e-3)?;
/// assert!((wood.height_m() - 9.55e-6).abs() < 1e-8);
/// assert!((wood.height_m() / wood.correlation_length_m() - 0.03).abs() < 1e-15);
/// assert!(Roughness::new(0.3, 2e-3).is_err());
/// # Ok::<(), coinmc_core::RoughnessError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roughness {
    slope: f64,
    wavelength_m: f64,
}

/// Why a roughness cannot be modelled.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum RoughnessError {
    /// The slope is negative or beyond [`Roughness::MAX_SLOPE`].
    #[error(
        "roughness slope must lie in [0, {most}], not {0}: the model is of first order in the slope",
        most = Roughness::MAX_SLOPE
    )]
    Slope(f64),
    /// The wavelength is not a positive finite length.
    #[error("roughness wavelength must be positive and finite, not {0} m")]
    Wavelength(f64),
    /// The wavelength is too short for the coin.
    #[error(
        "roughness wavelength {found_m:e} m is too short for a coin of this radius: at least {least_m:e} m \
         ({radii} R)",
        radii = Roughness::LEAST_WAVELENGTH_IN_RADII
    )]
    TooShort {
        /// The wavelength, m.
        found_m: f64,
        /// The shortest that the model of contact holds for with this coin, m.
        least_m: f64,
    },
}

impl Roughness {
    /// The steepest rms slope: contact is computed to first order in the slope, and beyond a fifth its
    /// square is no longer small.
    pub const MAX_SLOPE: f64 = 0.2;

    /// The shortest wavelength, in radii of the coin. The rim rides over shorter waves on their crests,
    /// in contact at several of them at once, where one contact point a rim is assumed.
    pub const LEAST_WAVELENGTH_IN_RADII: f64 = 0.005;

    /// A ground with this root mean square slope and this wavelength, m. With slope 0 it is a plane.
    ///
    /// # Errors
    /// [`RoughnessError`] unless 0 <= slope <= [`MAX_SLOPE`](Self::MAX_SLOPE) and the wavelength is
    /// positive and finite.
    pub fn new(slope: f64, wavelength_m: f64) -> Result<Self, RoughnessError> {
        if !(0.0..=Self::MAX_SLOPE).contains(&slope) {
            return Err(RoughnessError::Slope(slope));
        }
        if !(wavelength_m > 0.0 && wavelength_m.is_finite()) {
            return Err(RoughnessError::Wavelength(wavelength_m));
        }
        Ok(Self {
            slope,
            wavelength_m,
        })
    }

    /// Checks that the model holds for a coin on this ground.
    ///
    /// # Errors
    /// [`RoughnessError::TooShort`] if the ground is no plane and its wavelength is less than
    /// [`LEAST_WAVELENGTH_IN_RADII`](Self::LEAST_WAVELENGTH_IN_RADII) of the coin's radius.
    pub fn check_for(&self, coin: &Coin) -> Result<(), RoughnessError> {
        let least_m = Self::LEAST_WAVELENGTH_IN_RADII * coin.radius_m();
        if self.slope == 0.0 || self.wavelength_m >= least_m {
            return Ok(());
        }
        Err(RoughnessError::TooShort {
            found_m: self.wavelength_m,
            least_m,
        })
    }

    /// Root mean square slope s along any direction, dimensionless.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// Mean distance λ between upward crossings of the mean along a profile, m.
    pub fn wavelength_m(&self) -> f64 {
        self.wavelength_m
    }

    /// Root mean square height σ = sλ/2π, m.
    pub fn height_m(&self) -> f64 {
        self.slope * self.correlation_length_m()
    }

    /// Correlation length ℓ = λ/2π, m.
    pub fn correlation_length_m(&self) -> f64 {
        self.wavelength_m / TAU
    }

    /// Whether it is no roughness at all: a plane.
    pub(crate) fn is_plane(&self) -> bool {
        self.slope == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_each_range_are_in_and_beyond_is_out() {
        assert!(Roughness::new(0.0, 1e-9).is_ok() && Roughness::new(0.2, 1e6).is_ok());
        for slope in [-1e-9, 0.2 + 1e-9, f64::NAN] {
            let error = Roughness::new(slope, 1e-3).unwrap_err();
            assert!(matches!(error, RoughnessError::Slope(_)), "{slope}");
        }
        for wavelength in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
            let error = Roughness::new(0.1, wavelength).unwrap_err();
            assert!(
                matches!(error, RoughnessError::Wavelength(_)),
                "{wavelength}"
            );
        }
    }

    #[test]
    fn waves_are_compared_with_the_coin_unless_there_are_none() {
        let coin = Coin::cylinder(0.2, 0.01).unwrap();
        assert!(Roughness::new(0.1, 5e-5).unwrap().check_for(&coin).is_ok());
        assert!(Roughness::new(0.0, 4e-5).unwrap().check_for(&coin).is_ok());
        let error = Roughness::new(0.1, 4e-5).unwrap().check_for(&coin);
        assert_eq!(
            error.unwrap_err().to_string(),
            "roughness wavelength 4e-5 m is too short for a coin of this radius: at least 5e-5 m (0.005 R)"
        );
    }

    /// The profile a sin(2πx/L) crosses its mean upwards once per L. The mean square of a sine over whole
    /// waves is a half.
    #[test]
    fn height_and_slope_of_one_long_wave() {
        let (amplitude, length) = (2e-5, 3e-3);
        let slope = amplitude * TAU / length / 2.0_f64.sqrt();
        let wave = Roughness::new(slope, length).expect("a wave");
        assert_eq!((wave.slope(), wave.wavelength_m()), (slope, length));
        assert!((wave.height_m() / (amplitude / 2.0_f64.sqrt()) - 1.0).abs() < 1e-15);
    }

    /// s² = -C''(0) and, by Rice's formula, 1/λ = sqrt(-C''(0)/C(0))/2π, with C(r) = σ² exp(-r²/(2ℓ²)).
    #[test]
    fn slope_and_wavelength_follow_from_the_correlation() {
        let ground = Roughness::new(0.07, 4e-3).expect("rough ground");
        let (height, length) = (ground.height_m(), ground.correlation_length_m());
        let correlation = |r: f64| height * height * libm::exp(-r * r / (2.0 * length * length));
        // a second difference at h is off by h²/4ℓ² = 2.5e-7, and by round-off of some 1e-16 ℓ²/h² = 1e-10
        let h = 1e-3 * length;
        let curvature = 2.0 * (correlation(0.0) - correlation(h)) / (h * h);
        assert!((curvature.sqrt() / ground.slope() - 1.0).abs() < 1e-6);
        let crossings = (curvature / correlation(0.0)).sqrt() / TAU;
        assert!((crossings * ground.wavelength_m() - 1.0).abs() < 1e-6);
    }
}
