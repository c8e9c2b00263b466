//! A config in which numbers are replaced: the scene of a question.

use crate::QuestionError;
use coinmc::config::{self, Override};
use coinmc::plan::Plan;
use coinmc_core::Coin;
use std::f64::consts::PI;
use std::fmt;
use std::sync::Arc;

/// Where a number comes from, in messages, that nobody typed anywhere.
const QUESTION: &str = "question";

/// Numbers of `[coin]`, by key.
pub type CoinNumbers = Vec<(&'static str, f64)>;
/// What else a coin of this ratio and radius has.
type Make = Arc<dyn Fn(&Coin) -> CoinNumbers + Send + Sync>;

/// A config in which a question replaces numbers. Its ratio, and what it says of stopping, may be
/// anything or absent.
#[derive(Clone)]
pub struct Template {
    name: String,
    text: String,
    overrides: Vec<Override>,
    values: Vec<(String, f64)>,
    typed: Vec<Typed>,
    size: Size,
    make: Option<Make>,
}

/// Where a user asked for the number under a key.
#[derive(Debug, Clone)]
struct Typed {
    key: String,
    name: String,
    words: String,
}

impl fmt::Debug for Template {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Template")
            .field("name", &self.name)
            .field("overrides", &self.overrides)
            .field("size", &self.size)
            .finish_non_exhaustive()
    }
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
            values: vec![],
            typed: vec![],
            size: Size::OfConfig,
            make: None,
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

    /// The same with this number under a dotted key, unless a question replaces it.
    #[must_use]
    pub fn with_value(mut self, key: &str, value: f64) -> Self {
        self.values.push((key.to_owned(), value));
        self
    }

    /// The same, whose messages about the number that a question puts under this key name where the user asked for it,
    /// such as `--vary`, and quote what was typed there. Without this they name the question and quote the key.
    ///
    /// # Example
    /// ```
    /// use coinmc_questions::Template;
    /// let text = "coin.ratio = 1\nsurface.material = 'wood'\nlaunch.preset = 'hand'\nengine.volumetric = {}";
    /// let template = Template::new("inline", text, &[]);
    /// let template = template.with_typed("surface.friction", "--over", "surface.friction=-1..1");
    /// let error = template.plan(&[("surface.friction", "-1.0".to_owned())]).unwrap_err();
    /// assert!(error.to_string().contains("--over:1:18"));
    /// ```
    #[must_use]
    pub fn with_typed(
        mut self,
        key: impl Into<String>,
        name: impl Into<String>,
        words: impl Into<String>,
    ) -> Self {
        self.typed.push(Typed {
            key: key.into(),
            name: name.into(),
            words: words.into(),
        });
        self
    }

    /// The same, whose messages about this key are about what was typed for another.
    pub(crate) fn told_as(mut self, key: &str, other: &str) -> Self {
        let typed = self.typed.iter().find(|typed| typed.key == other);
        let typed = typed.cloned().unwrap_or_else(|| Typed {
            key: String::new(),
            name: QUESTION.to_owned(),
            words: other.to_owned(),
        });
        let key = key.to_owned();
        self.typed.insert(0, Typed { key, ..typed });
        self
    }

    /// The same with coins that are made by a rule: `make` gives other numbers of `[coin]`, such as its
    /// moments of inertia, for the coin of each ratio and radius.
    pub fn with_coins_made(
        self,
        make: impl Fn(&Coin) -> CoinNumbers + Send + Sync + 'static,
    ) -> Self {
        Self {
            make: Some(Arc::new(make)),
            ..self
        }
    }

    /// The same scene spelled out, so that every number that it shows can be replaced: also those that
    /// the config leaves to presets, materials and defaults.
    ///
    /// # Errors
    /// [`QuestionError::Config`].
    pub fn resolved(&self) -> Result<Self, QuestionError> {
        Ok(self.spelled_out()?.1)
    }

    /// Whether the size of the coin is not that of the config.
    pub(crate) fn is_sized(&self) -> bool {
        self.size != Size::OfConfig
    }

    /// The plan with these values, TOML by dotted key, in place of those of the config.
    ///
    /// # Errors
    /// [`QuestionError::Config`].
    pub fn plan(&self, values: &[(&str, String)]) -> Result<Plan, QuestionError> {
        let mut plan = self.parse(values)?;
        let mut values = values.to_vec();
        let ratio = plan.points[0].scene.coin.ratio();
        if let Some(radius) = self.size.radius_m(ratio) {
            values.push(("coin.radius_m", format!("{radius:?}")));
            plan = self.parse(&values)?;
        }
        if let Some(make) = &self.make {
            let numbers = make(&plan.points[0].scene.coin);
            let keys: Vec<_> = numbers
                .iter()
                .map(|(key, value)| (format!("coin.{key}"), format!("{value:?}")))
                .collect();
            values.extend(
                keys.iter()
                    .map(|(key, value)| (key.as_str(), value.clone())),
            );
            return self.parse(&values);
        }
        Ok(plan)
    }

    /// The plan of the config itself, and a template in which all that the config leaves to presets
    /// and defaults is spelled out.
    ///
    /// # Errors
    /// [`QuestionError::Config`].
    pub(crate) fn spelled_out(&self) -> Result<(Plan, Self), QuestionError> {
        let plan = self.plan(&[])?;
        let spelled = Self {
            typed: self.typed.clone(),
            ..Self::new(&*self.name, &*plan.resolved_toml, &[])
        };
        Ok((plan, spelled))
    }

    fn parse(&self, values: &[(&str, String)]) -> Result<Plan, QuestionError> {
        // a run's stop is not a question's, but a plan must have one
        let stop = ("stop", "{ tosses = 1 }".to_owned());
        let mut overrides = self.overrides.clone();
        let own = self.values.iter();
        let own: Vec<_> = own
            .map(|(key, value)| (key.as_str(), format!("{value:?}")))
            .collect();
        for (key, value) in own.iter().chain(values).chain([&stop]) {
            overrides.push(self.made(key, value)?);
        }
        Ok(config::parse(&self.name, &self.text, &overrides)?)
    }

    /// What a question puts under a key.
    fn made(&self, key: &str, value: &str) -> Result<Override, QuestionError> {
        let text = format!("{key}={value}");
        let set: Override = text.parse().map_err(QuestionError::Key)?;
        let typed = self.typed.iter().find(|typed| typed.key == key);
        Ok(match typed {
            Some(typed) => set.made_of(&typed.name, &typed.words),
            None => set.made_of(QUESTION, key),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coins_are_made_by_their_rule() {
        let text = "coin.ratio = 1\nsurface.material = 'wood'\nlaunch.preset = 'hand'\n\
                    engine.volumetric = {}";
        let template = Template::new("inline", text, &[]);
        let rounded =
            template.with_coins_made(|coin| vec![("rim_radius_m", 0.1 * coin.height_m())]);
        let coin = rounded.plan(&[]).expect("a plan").points[0].scene.coin;
        assert_eq!(coin.rim_radius_m(), 0.1 * coin.height_m());
    }

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
