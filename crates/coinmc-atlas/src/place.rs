//! A coin and a surface, as the atlas is asked for them.

use crate::{AtlasError, Axis};
use coinmc_core::{Material, pivoting_friction_of_patch_m};

/// The numbers of a coin and a surface that the atlas varies.
///
/// # Example
/// ```
/// use coinmc_atlas::Place;
/// let mut place = Place::on(&"wood".parse()?, 0.8, 0.011_625);
/// assert_eq!(place.restitution, 0.5);
/// place.friction = 0.2;
/// # Ok::<(), coinmc_core::EngineError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Height over radius, H/R.
    pub ratio: f64,
    /// Coefficient of restitution e.
    pub restitution: f64,
    /// Coefficient of friction μ.
    pub friction: f64,
    /// Rolling friction length over radius, ρ_c/R.
    pub rolling_friction_over_radius: f64,
    /// Pivoting friction length over radius, ρ_p/R.
    pub pivoting_friction_over_radius: f64,
    /// Root mean square slope of the ground.
    pub roughness_slope: f64,
    /// Wavelength of the ground, m.
    pub roughness_wavelength_m: f64,
}

impl Place {
    /// A coin of this ratio and radius (m) on a material.
    pub fn on(material: &Material, ratio: f64, radius_m: f64) -> Self {
        let friction = material.friction.value;
        let pivoting_m = pivoting_friction_of_patch_m(friction, material.contact_patch_m.value);
        Self {
            ratio,
            restitution: material.restitution.value,
            friction,
            rolling_friction_over_radius: material.rolling_friction_m.value / radius_m,
            pivoting_friction_over_radius: pivoting_m / radius_m,
            roughness_slope: material.roughness_slope.value,
            roughness_wavelength_m: material.roughness_wavelength_m.value,
        }
    }

    /// A coin of this ratio and radius (m) on a material of which some numbers are replaced, by the keys of
    /// `[surface]`. Friction given without pivoting friction changes that of the contact patch, too; of two
    /// values of one key the last counts.
    ///
    /// # Errors
    /// [`AtlasError::Key`].
    pub fn with(
        material: &Material,
        ratio: f64,
        radius_m: f64,
        numbers: &[(String, f64)],
    ) -> Result<Self, AtlasError> {
        let mut place = Self::on(material, ratio, radius_m);
        let mut patch_m = Some(material.contact_patch_m.value);
        for (key, value) in numbers {
            let value = *value;
            match key.strip_prefix("surface.").unwrap_or(key) {
                "restitution" => place.restitution = value,
                "friction" => place.friction = value,
                "rolling_friction_m" => place.rolling_friction_over_radius = value / radius_m,
                "rolling_friction_over_radius" => place.rolling_friction_over_radius = value,
                "pivoting_friction_m" => {
                    (place.pivoting_friction_over_radius, patch_m) = (value / radius_m, None);
                }
                "pivoting_friction_over_radius" => {
                    (place.pivoting_friction_over_radius, patch_m) = (value, None);
                }
                "contact_patch_m" => patch_m = Some(value),
                "roughness_slope" => place.roughness_slope = value,
                "roughness_wavelength_m" => place.roughness_wavelength_m = value,
                _ => return Err(AtlasError::Key(key.clone())),
            }
        }
        if let Some(patch_m) = patch_m {
            let pivoting_m = pivoting_friction_of_patch_m(place.friction, patch_m);
            place.pivoting_friction_over_radius = pivoting_m / radius_m;
        }
        Ok(place)
    }

    /// The names of its numbers, which are those of the columns of results and of keys of configs.
    pub const NAMES: [&'static str; 7] = [
        "ratio",
        "restitution",
        "friction",
        "rolling_friction_over_radius",
        "pivoting_friction_over_radius",
        "roughness_slope",
        "roughness_wavelength_m",
    ];

    /// Its numbers, in the order of [`NAMES`](Self::NAMES).
    pub fn numbers(&self) -> [f64; 7] {
        [
            self.ratio,
            self.restitution,
            self.friction,
            self.rolling_friction_over_radius,
            self.pivoting_friction_over_radius,
            self.roughness_slope,
            self.roughness_wavelength_m,
        ]
    }

    /// The place with these numbers, in the same order.
    pub fn of(numbers: [f64; 7]) -> Self {
        let [
            ratio,
            restitution,
            friction,
            rolling_friction_over_radius,
            pivoting_friction_over_radius,
            roughness_slope,
            roughness_wavelength_m,
        ] = numbers;
        Self {
            ratio,
            restitution,
            friction,
            rolling_friction_over_radius,
            pivoting_friction_over_radius,
            roughness_slope,
            roughness_wavelength_m,
        }
    }

    /// Its numbers with their names.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, f64)> {
        Self::NAMES.into_iter().zip(self.numbers())
    }

    /// The inputs of a network.
    ///
    /// # Errors
    /// [`AtlasError::Outside`], with a sentence for each number that an axis does not hold.
    pub(crate) fn inputs(&self, axes: &[Axis], radius_m: f64) -> Result<Vec<f64>, AtlasError> {
        let outside = axes.iter().zip(self.named());
        let outside = outside.filter(|(axis, (_, value))| !axis.holds(*value));
        let outside = outside.map(|(Axis { from, to, .. }, (name, value))| {
            format!("the atlas holds {name} from {from} to {to}, not {value}")
        });
        let outside: Vec<String> = outside.collect();
        if outside.is_empty() {
            Ok(self.coordinates(axes, radius_m))
        } else {
            Err(AtlasError::Outside(outside))
        }
    }

    /// Coordinates from -1 to 1 along these axes, and then that of the lean.
    pub(crate) fn coordinates(&self, axes: &[Axis], radius_m: f64) -> Vec<f64> {
        let [thinnest, thickest] = Self::ends(axes);
        let lean = Axis {
            name: "lean".to_owned(),
            from: thickest.lean(radius_m),
            to: thinnest.lean(radius_m),
            log: true,
        };
        let along = axes.iter().zip(self.numbers());
        let along = along.map(|(axis, number)| axis.coordinate(number));
        along
            .chain([lean.coordinate(self.lean(radius_m))])
            .collect()
    }

    /// Where a coin leans most, the thinnest one on the steepest and longest waves, and where it leans least.
    fn ends(axes: &[Axis]) -> [Self; 2] {
        let [from, to] = [|axis: &Axis| axis.from, |axis: &Axis| axis.to]
            .map(|end| Self::of(std::array::from_fn(|i| end(&axes[i]))));
        let with = |ratio, place| Self { ratio, ..place };
        [with(from.ratio, to), with(to.ratio, from)]
    }

    /// How far a coin on its side leans on the ground, one standard deviation, over the lean at which it topples,
    /// H/2R. With the ground's correlation exp(-r²/2ℓ²) the heights under both rims differ by
    /// sℓ sqrt(2(1 - exp(-H²/2ℓ²))).
    fn lean(&self, radius_m: f64) -> f64 {
        let correlation_m = self.roughness_wavelength_m / std::f64::consts::TAU;
        let apart = self.ratio * radius_m / correlation_m;
        let contrast = (-2.0 * libm::expm1(-0.5 * apart * apart)).sqrt();
        self.roughness_slope * contrast / apart / (0.5 * self.ratio)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(numbers: &[(&str, f64)]) -> Result<Place, AtlasError> {
        let wood: Material = "wood".parse().expect("a material");
        let numbers = numbers
            .iter()
            .map(|(key, value)| ((*key).to_owned(), *value));
        Place::with(&wood, 0.8, 0.01, &numbers.collect::<Vec<_>>())
    }

    /// The patch law, (3π/16) μ a, holds with a friction that is given, until pivoting friction is.
    #[test]
    fn numbers_replace_those_of_the_material() {
        let patch = 3.0 * std::f64::consts::PI / 16.0;
        let place = with(&[("surface.friction", 0.2)]).unwrap();
        assert!((place.pivoting_friction_over_radius - patch * 0.2 * 4.7e-3).abs() < 1e-12);
        let place = with(&[("contact_patch_m", 1e-4), ("friction", 0.5)]).unwrap();
        assert!((place.pivoting_friction_over_radius - patch * 0.5 * 1e-2).abs() < 1e-12);
        let place = with(&[("pivoting_friction_m", 1e-5), ("friction", 0.5)]).unwrap();
        assert_eq!(place.pivoting_friction_over_radius, 1e-5 / 0.01);
        let place = with(&[("rolling_friction_m", 1e-4), ("roughness_slope", 0.01)]).unwrap();
        assert_eq!(place.rolling_friction_over_radius, 1e-4 / 0.01);
        assert_eq!((place.roughness_slope, place.ratio), (0.01, 0.8));
        assert!(with(&[("coin.ratio", 1.0)]).is_err());
    }

    #[test]
    fn every_number_beyond_the_atlas_is_named() {
        let axes = Place::NAMES.map(|name| Axis {
            name: name.to_owned(),
            from: 0.1,
            to: 0.2,
            log: true,
        });
        let inside = Place::of([0.15; 7]);
        assert_eq!(inside.inputs(&axes, 0.01).unwrap().len(), 8);
        let outside = Place {
            friction: 0.3,
            roughness_slope: f64::NAN,
            ..inside
        };
        let message = outside.inputs(&axes, 0.01).unwrap_err().to_string();
        assert_eq!(message.lines().count(), 2, "{message}");
        assert!(message.starts_with("the atlas holds friction from 0.1 to 0.2, not 0.3"));
    }

    /// On waves much longer than the coin is thick it leans by the slope; on much shorter ones by √2 σ/H.
    #[test]
    fn the_lean_is_that_of_the_ground_under_both_rims() {
        let lean = |wavelength_m: f64| {
            let place = Place {
                ratio: 0.8,
                roughness_slope: 0.02,
                roughness_wavelength_m: wavelength_m,
                ..Place::of([1.0; 7])
            };
            0.5 * place.ratio * place.lean(0.01)
        };
        assert!((lean(1e3) - 0.02).abs() < 1e-9);
        let short = 2.0_f64.sqrt() * 0.02 * 1e-3 / std::f64::consts::TAU / 0.008;
        assert!((lean(1e-3) - short).abs() < 1e-12);
    }

    /// The lean is largest for the thinnest coin on the steepest and longest waves: all coordinates but that of the
    /// ratio are 1 there, and the other way round.
    #[test]
    fn coordinates_reach_from_end_to_end() {
        let axes = crate::Atlas::of(crate::Launch::Hand).axes().to_vec();
        let [thinnest, thickest] = Place::ends(&axes).map(|end| end.coordinates(&axes, 0.011_625));
        let most = [-1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];
        assert_eq!(thinnest, most);
        assert_eq!(thickest, most.map(|end| -end));
    }
}
