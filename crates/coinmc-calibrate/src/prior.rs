//! What is believed of the parameters before anything is measured.

use crate::Parameter;
use coinmc_core::{Material, Surface, pivoting_friction_of_patch_m};
use std::f64::consts::TAU;

/// How many standard deviations a central interval of 95 % reaches.
pub(crate) const Z95: f64 = 1.959_963_984_540_054;

/// Estimates of friction lengths and slopes may be wrong by this factor, where nothing bounds them.
const FACTOR: f64 = 3.0;
/// A friction coefficient is between these multiples of a typical one.
const FRICTION: [f64; 2] = [0.6, 1.6];
/// A restitution is this far from a typical one, but within the limits.
const RESTITUTION: f64 = 0.15;
const RESTITUTION_LIMITS: [f64; 2] = [0.05, 0.9];

/// The prior of a parameter: normal on its scale ([`Parameter::to_scale`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Prior {
    /// Of which parameter.
    pub parameter: Parameter,
    /// Lower end of its central interval of 95 %.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Where it comes from.
    pub source: String,
}

impl Prior {
    /// Mean and standard deviation on the scale.
    fn moments(&self) -> (f64, f64) {
        let [low, high] = [self.low, self.high].map(|end| self.parameter.to_scale(end));
        (f64::midpoint(low, high), (high - low) / (2.0 * Z95))
    }

    /// Its median.
    pub fn median(&self) -> f64 {
        self.parameter.from_scale(self.moments().0)
    }

    /// The number that is z standard deviations from the median.
    pub fn value(&self, z: f64) -> f64 {
        let (mean, sd) = self.moments();
        // at both ends of the floating-point range a number could leave what a surface allows
        let value = self.parameter.from_scale(mean + sd * z);
        match self.parameter {
            Parameter::Restitution => value.clamp(1e-6, 1.0 - 1e-6),
            other => value.clamp(1e-12, other.most().min(1e3)),
        }
    }

    /// How many standard deviations a number is from the median.
    pub fn z(&self, value: f64) -> f64 {
        let (mean, sd) = self.moments();
        (self.parameter.to_scale(value) - mean) / sd
    }

    /// ln of its density at a number, per unit of the number; −∞ where there is none.
    pub fn log_density(&self, value: f64) -> f64 {
        if !self.parameter.allows(value) {
            return f64::NEG_INFINITY;
        }
        let (z, (_, sd)) = (self.z(value), self.moments());
        let stretch = self.parameter.log_stretch(value);
        -0.5 * z * z - 0.5 * libm::log(TAU) - libm::log(sd) + stretch
    }

    /// The priors for a surface such as this one: its numbers are typical, and about as uncertain as those
    /// of [`Material`]. A number that a config leaves at 0 says nothing: it is as of any material.
    pub fn around(parameters: &[Parameter], surface: &Surface) -> Vec<Self> {
        if let Some(material) = named(parameters, surface) {
            let of = |parameter: &Parameter| Self::of_material(*parameter, material);
            return parameters.iter().map(of).collect();
        }
        let of = |parameter: &Parameter| {
            let parameter = *parameter;
            let number = parameter.of_surface(surface);
            if !parameter.allows(number) {
                return Self::of_any(parameter);
            }
            let (low, high) = spread(parameter, number);
            let source = format!("around the {} of the config", parameter.key());
            Self {
                parameter,
                low,
                high,
                source,
            }
        };
        parameters.iter().map(of).collect()
    }

    /// The prior for a material of the table.
    pub fn of_material(parameter: Parameter, material: &Material) -> Self {
        let (typical, source) = typical(parameter, material);
        let (low, high) = spread(parameter, typical);
        Self {
            parameter,
            low,
            high,
            source: format!("{}: {source}", material.name),
        }
    }

    /// The prior for any material of the table.
    pub fn of_any(parameter: Parameter) -> Self {
        let all = Material::ALL.iter();
        let (low, high) = all
            .map(|material| spread(parameter, typical(parameter, material).0))
            .fold((f64::INFINITY, 0.0_f64), |(low, high), (from, to)| {
                (low.min(from), high.max(to))
            });
        Self {
            parameter,
            low,
            high,
            source: "all materials of the table, from the least to the greatest".to_owned(),
        }
    }
}

/// The typical number of a material, with its source.
fn typical(parameter: Parameter, material: &Material) -> (f64, &'static str) {
    let sourced = match parameter {
        Parameter::Restitution => material.restitution,
        Parameter::Friction => material.friction,
        Parameter::RollingFriction => material.rolling_friction_m,
        Parameter::PivotingFriction => {
            let patch = material.contact_patch_m;
            let length = pivoting_friction_of_patch_m(material.friction.value, patch.value);
            return (length, patch.source);
        }
        Parameter::RoughnessSlope => material.roughness_slope,
    };
    (sourced.value, sourced.source)
}

/// The ends of the central 95 % around a typical number.
fn spread(parameter: Parameter, typical: f64) -> (f64, f64) {
    match parameter {
        Parameter::Restitution => {
            let [least, most] = RESTITUTION_LIMITS;
            let low = (typical - RESTITUTION).clamp(least, most - 0.1);
            (low, (typical + RESTITUTION).clamp(least + 0.1, most))
        }
        Parameter::Friction => (FRICTION[0] * typical, FRICTION[1] * typical),
        Parameter::RollingFriction => (typical / FACTOR, FACTOR * typical),
        Parameter::RoughnessSlope => (typical / FACTOR, (FACTOR * typical).min(parameter.most())),
        // (3π/16) μ a: the uncertainties of μ and of the patch's radius a
        Parameter::PivotingFriction => {
            let half = [FACTOR, (FRICTION[1] / FRICTION[0]).sqrt()].map(libm::log);
            let factor = libm::exp((half[0] * half[0] + half[1] * half[1]).sqrt());
            (typical / factor, factor * typical)
        }
    }
}

/// The material of which a surface has all numbers that are calibrated, the one with its ground if there is
/// one.
fn named(parameters: &[Parameter], surface: &Surface) -> Option<&'static Material> {
    let slope = surface.roughness().map(|roughness| roughness.slope());
    let is_of = |material: &&Material| {
        parameters.iter().all(|parameter| {
            let (typical, _) = typical(*parameter, material);
            (typical / parameter.of_surface(surface) - 1.0).abs() < 1e-9
        })
    };
    let same = || Material::ALL.iter().filter(is_of);
    let alike = same().find(|material| slope == Some(material.roughness_slope.value));
    alike.or_else(|| same().next())
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::Roughness;

    #[test]
    fn the_interval_of_a_prior_holds_95_percent() {
        let wood = Material::ALL[3];
        for parameter in Parameter::ALL {
            let prior = Prior::of_material(parameter, &wood);
            assert!(prior.low < prior.median() && prior.median() < prior.high);
            assert!((prior.z(prior.low) + Z95).abs() < 1e-9);
            assert!((prior.value(Z95) / prior.high - 1.0).abs() < 1e-9);
            // the density of numbers integrates to 95 % between the ends
            let n = 20_000;
            let step = (prior.high - prior.low) / f64::from(n);
            let density =
                |i: u32| libm::exp(prior.log_density(prior.low + step * (f64::from(i) + 0.5)));
            let share: f64 = (0..n).map(density).sum::<f64>() * step;
            assert!((share - 0.95).abs() < 1e-4, "{parameter:?} {share}");
            assert!(prior.source.starts_with("wood: "), "{}", prior.source);
            let any = Prior::of_any(parameter);
            assert!(any.low <= prior.low && prior.high <= any.high);
        }
    }

    #[test]
    fn a_material_is_named_only_for_all_of_its_numbers() {
        let source = |friction: f64, pivoting: f64, slope: Option<f64>| {
            let surface = Surface::new(0.5, friction).unwrap();
            let surface = surface.with_friction_lengths(5e-5, pivoting).unwrap();
            let ground = slope.and_then(|slope| Roughness::new(slope, 3e-3).ok());
            let surface = surface.with_roughness(ground);
            let known = if slope.is_some() { 5 } else { 4 };
            Prior::around(&Parameter::ALL[..known], &surface)[0]
                .source
                .clone()
        };
        let patch = pivoting_friction_of_patch_m(0.3, 4.7e-5);
        assert!(source(0.3, patch, None).starts_with("wood: "));
        assert!(source(0.3, patch, Some(0.05)).starts_with("wood: "));
        let config = "around the restitution of the config";
        assert_eq!(source(0.31, patch, None), config);
        assert_eq!(source(0.3, 0.0, None), config);
        assert_eq!(source(0.3, patch, Some(0.06)), config);
    }
}
