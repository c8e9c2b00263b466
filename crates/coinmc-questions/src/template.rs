//! A config in which numbers are replaced: the scene of a question.

use crate::QuestionError;
use coinmc::config::{self, Override};
use coinmc::plan::Plan;
use std::f64::consts::PI;

/// A config in which a question replaces numbers. Its ratio, and what it says of stopping, may be
/// anything or absent.
#[derive(Debug, Clone)]
pub struct Template {
    name: String,
    text: String,
    overrides: Vec<Override>,
    size: Size,
}

/// The size of a coin, whatever its ratio H/R.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Size {
    /// That of the config.
    #[default]
    OfConfig,
    /// A coin of this diameter, m.
    Diameter(f64),
    /// A coin of this volume, m³, such as its mass divided by its density. The radius follows from
    /// V = πR²H = πR³ (H/R).
    Volume(f64),
}

impl Size {
    /// The radius of a coin of this size and ratio, m; `None` for that of the config.
    fn radius_m(self, ratio: f64) -> Option<f64> {
        match self {
            Self::OfConfig => None,
            Self::Diameter(diameter) => Some(0.5 * diameter),
            Self::Volume(volume) => Some(libm::cbrt(volume / (PI * ratio))),
        }
    }

    fn check(self) -> Result<(), QuestionError> {
        let (what, given) = match self {
            Self::OfConfig => return Ok(()),
            Self::Diameter(diameter) => ("diameter", diameter),
            Self::Volume(volume) => ("volume", volume),
        };
        if given > 0.0 && given.is_finite() {
            Ok(())
        } else {
            Err(QuestionError::Size { what, given })
        }
    }
}

impl Template {
    /// A template by the text of a config; `name` is its name in messages.
    pub fn new(name: impl Into<String>, text: impl Into<String>, overrides: &[Override]) -> Self {
        Self {
            name: name.into(),
            text: text.into(),
            overrides: overrides.to_vec(),
            size: Size::OfConfig,
        }
    }

    /// The same with a coin of this size.
    ///
    /// # Errors
    /// [`QuestionError::Size`] if it is not positive and finite.
    pub fn with_size(self, size: Size) -> Result<Self, QuestionError> {
        size.check()?;
        Ok(Self { size, ..self })
    }

    /// Whether the size of the coin is not that of the config.
    pub(crate) fn is_sized(&self) -> bool {
        self.size != Size::OfConfig
    }

    /// The plan with these values, TOML by dotted key, in place of those of the config.
    ///
    /// # Errors
    /// [`QuestionError::Config`].
    pub(crate) fn plan(&self, values: &[(&str, String)]) -> Result<Plan, QuestionError> {
        let plan = self.parse(values)?;
        let ratio = plan.points[0].scene.coin.ratio();
        let Some(radius) = self.size.radius_m(ratio) else {
            return Ok(plan);
        };
        let mut values = values.to_vec();
        values.push(("coin.radius_m", format!("{radius:?}")));
        self.parse(&values)
    }

    fn parse(&self, values: &[(&str, String)]) -> Result<Plan, QuestionError> {
        // a run's stop is not a question's, but a plan must have one
        let stop = ("stop", "{ tosses = 1 }".to_owned());
        let mut overrides = self.overrides.clone();
        for (key, value) in values.iter().chain([&stop]) {
            let text = format!("{key}={value}");
            overrides.push(text.parse().map_err(QuestionError::Key)?);
        }
        Ok(config::parse(&self.name, &self.text, &overrides)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_gives_the_radius() {
        let text = "surface.material = 'wood'\nlaunch.preset = 'hand'\nengine.volumetric = {}\n\
                    stop.half_width = 0.1";
        let radius = |size, ratio: f64| {
            let template = Template::new("inline", text, &[]);
            let template = template.with_size(size).expect("a size");
            let values = [("coin.ratio", format!("{ratio:?}"))];
            let plan = template.plan(&values).expect("a plan");
            plan.points[0].scene.coin.radius_m()
        };
        assert_eq!(radius(Size::Diameter(0.024), 1.2), 0.012);
        let of_volume = radius(Size::Volume(1e-6), 0.5);
        assert!((PI * of_volume.powi(3) * 0.5 - 1e-6).abs() < 1e-18);
    }
}
