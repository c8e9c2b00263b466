//! Lengths, volumes, masses and densities with their units.

use std::str::FromStr;

/// A length, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Length(pub(crate) f64);

/// A volume, m³.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Volume(pub(crate) f64);

/// A mass, kg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mass(pub(crate) f64);

/// A density, kg/m³.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Density(pub(crate) f64);

const LENGTHS: &[(&str, f64)] = &[("mm", 1e-3), ("cm", 1e-2), ("m", 1.0), ("in", 0.0254)];
const VOLUMES: &[(&str, f64)] = &[("mm3", 1e-9), ("cm3", 1e-6), ("ml", 1e-6), ("m3", 1.0)];
const MASSES: &[(&str, f64)] = &[("g", 1e-3), ("kg", 1.0), ("oz", 0.028_349_523_125)];
const DENSITIES: &[(&str, f64)] = &[("g/cm3", 1e3), ("kg/m3", 1.0)];

/// A number followed by one of the units, in SI units.
fn read(text: &str, units: &[(&str, f64)]) -> Result<f64, String> {
    let names: Vec<&str> = units.iter().map(|(name, _)| *name).collect();
    let wrong = || format!("expected a number above 0 and a unit: {}", names.join(", "));
    let split = text
        .find(|c: char| !(c.is_ascii_digit() || ".+-".contains(c)))
        .ok_or_else(wrong)?;
    let (number, unit) = text.split_at(split);
    let number: f64 = number.parse().map_err(|_| wrong())?;
    let (_, factor) = units
        .iter()
        .find(|(name, _)| *name == unit.trim())
        .ok_or_else(wrong)?;
    let value = number * factor;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(wrong())
    }
}

macro_rules! from_str {
    ($($quantity:ident: $units:ident),*) => {$(
        impl FromStr for $quantity {
            type Err = String;

            fn from_str(text: &str) -> Result<Self, String> {
                read(text, $units).map(Self)
            }
        }
    )*};
}

from_str!(Length: LENGTHS, Volume: VOLUMES, Mass: MASSES, Density: DENSITIES);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_converted() {
        assert_eq!("24mm".parse(), Ok(Length(0.024)));
        assert_eq!("2 in".parse(), Ok(Length(0.0508)));
        assert_eq!("2cm3".parse(), Ok(Volume(2e-6)));
        assert_eq!("7.5g".parse(), Ok(Mass(0.0075)));
        assert_eq!("1.24g/cm3".parse(), Ok(Density(1240.0)));
    }

    #[test]
    fn anything_else_is_refused_with_the_units() {
        for text in [
            "", "24", "mm", "24km", "-3mm", "0mm", "1e999mm", "2 4mm", "nanmm",
        ] {
            let error = text.parse::<Length>().expect_err(text);
            assert!(error.ends_with("mm, cm, m, in"), "{error}");
        }
    }
}
