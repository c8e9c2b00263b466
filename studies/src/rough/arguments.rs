//! Coins and grounds as people ask for them.

use super::RADIUS_M;
use coinmc_core::{Coin, Roughness};

/// H/R of a coin.
pub(super) fn ratio(text: &str) -> Result<f64, String> {
    let ratio = number(text)?;
    Coin::cylinder(ratio, RADIUS_M).map_err(|error| error.to_string())?;
    Ok(ratio)
}

/// The rms slope of a ground.
pub(super) fn slope(text: &str) -> Result<f64, String> {
    let slope = number(text)?;
    let any_wavelength_m = 1.0;
    Roughness::new(slope, any_wavelength_m).map_err(|error| error.to_string())?;
    Ok(slope)
}

/// The wavelength of a ground, mm, under the study's coin.
pub(super) fn wavelength_mm(text: &str) -> Result<f64, String> {
    let wavelength_mm = number(text)?;
    let coin = Coin::cylinder(1.0, RADIUS_M).expect("the constants are positive");
    Roughness::new(Roughness::MAX_SLOPE, 1e-3 * wavelength_mm)
        .and_then(|ground| ground.check_for(&coin))
        .map_err(|error| error.to_string())?;
    Ok(wavelength_mm)
}

fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "not a number".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_engine_can_follow_is_refused() {
        assert_eq!(ratio("0.6"), Ok(0.6));
        assert_eq!(slope("0.2"), Ok(0.2));
        assert_eq!(wavelength_mm("1e6"), Ok(1e6));
        for bad in ["0", "-1", "nan", "inf", "thick"] {
            assert!(ratio(bad).is_err(), "{bad}");
        }
        for bad in ["0.21", "-0.01", "nan", "steep"] {
            assert!(slope(bad).is_err(), "{bad}");
        }
        for bad in ["0", "-3", "inf", "0.05", "long"] {
            assert!(wavelength_mm(bad).is_err(), "{bad}");
        }
    }
}
