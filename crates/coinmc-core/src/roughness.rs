//! How rough the ground is.

use std::f64::consts::TAU;
use thiserror::Error;

/// The roughness of a surface: a stationary, isotropic Gaussian random height field.
///
/// Heights have the correlation C(r) = σ² exp(−r²/2ℓ²). It is stated by two numbers that can be
/// measured with a profilometer along any straight line: the rms slope s, and the wavelength λ, the
/// mean distance between places where the profile rises through its mean. By Rice's formula
/// (Bell Syst. Tech. J. 24 (1945) 46) λ = 2π σ/s, so ℓ = λ/2π and σ = sλ/2π.
///
/// # Example
/// ```
/// use coinmc_core::Roughness;
/// let wood = Roughness::new(0.02, 3e-3)?;
/// assert!((wood.height_m() - 9.55e-6).abs() < 1e-8);
/// assert!(Roughness::new(0.5, 3e-3).is_err());
/// # Ok::<(), coinmc_core::RoughnessError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roughness {
    slope: f64,
    wavelength_m: f64,
}

/// Why a roughness is not valid.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum RoughnessError {
    /// The rms slope is negative, or too steep for a law of first order in it.
    #[error("rms slope must lie in (0, {most}], not {0}", most = Roughness::STEEPEST)]
    Slope(f64),
    /// The wavelength is not a positive finite length.
    #[error("wavelength must be positive and finite, not {0} m")]
    Wavelength(f64),
}

impl Roughness {
    /// Largest rms slope. The law of contact is of first order in the slope.
    pub const STEEPEST: f64 = 0.2;

    /// A ground of this rms slope along any direction, and this wavelength, m.
    ///
    /// # Errors
    /// [`RoughnessError`] unless 0 < slope <= [`STEEPEST`](Self::STEEPEST) and the wavelength is
    /// positive and finite.
    pub fn new(slope: f64, wavelength_m: f64) -> Result<Self, RoughnessError> {
        if !(slope > 0.0 && slope <= Self::STEEPEST) {
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

    /// Rms slope s along any direction, dimensionless.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// Wavelength λ, m: mean distance between up-crossings of a profile.
    pub fn wavelength_m(&self) -> f64 {
        self.wavelength_m
    }

    /// Correlation length ℓ = λ/2π, m.
    pub fn correlation_length_m(&self) -> f64 {
        self.wavelength_m / TAU
    }

    /// Rms height σ = sℓ, m.
    pub fn height_m(&self) -> f64 {
        self.slope * self.correlation_length_m()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_a_ground_is_refused() {
        for slope in [0.0, -0.1, 0.21, f64::NAN] {
            assert!(Roughness::new(slope, 1e-3).is_err(), "{slope}");
        }
        for wavelength in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            assert!(Roughness::new(0.1, wavelength).is_err(), "{wavelength}");
        }
    }
}
