//! The launch of a config, in which numbers are read and replaced.
//!
//! The tree is that of `[launch]` in a resolved config, where presets and defaults are spelled out,
//! and is written back as one inline table.

use std::fmt::{self, Write};
use toml::de::{DeTable, DeValue};

/// Names of the components of a list of three, in keys.
const COMPONENTS: [&str; 3] = ["x", "y", "z"];

/// The key of the standard deviation of each component of a spin whose axis has any direction.
const ISOTROPIC: &str = "isotropic_sd_rad_s";

/// A launch, or a part of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Launch {
    Number(f64),
    /// Any other value without parts, as it is written.
    Word(String),
    List(Vec<Launch>),
    Table(Vec<(String, Launch)>),
}

impl Launch {
    /// The launch of a resolved config; `None` if it has none.
    pub(super) fn of(resolved_toml: &str) -> Option<Self> {
        let mut table = DeTable::parse(resolved_toml).ok()?.into_inner();
        Self::read(table.remove("launch")?.into_inner())
    }

    fn read(value: DeValue<'_>) -> Option<Self> {
        Some(match value {
            DeValue::Float(number) => Self::Number(number.as_str().parse().ok()?),
            DeValue::Integer(number) => {
                Self::Number(number.as_str().replace('_', "").parse().ok()?)
            }
            DeValue::String(word) => Self::Word(format!("{word:?}")),
            DeValue::Boolean(holds) => Self::Word(holds.to_string()),
            DeValue::Datetime(time) => Self::Word(time.to_string()),
            DeValue::Array(items) => {
                let items = items.into_iter().map(|item| Self::read(item.into_inner()));
                Self::List(items.collect::<Option<_>>()?)
            }
            DeValue::Table(table) => {
                let entries = table.into_iter().map(|(key, value)| {
                    Some((
                        key.into_inner().into_owned(),
                        Self::read(value.into_inner())?,
                    ))
                });
                Self::Table(entries.collect::<Option<_>>()?)
            }
        })
    }

    /// The number under a dotted key that begins with `launch`.
    pub(super) fn number(&mut self, key: &str) -> Option<&mut f64> {
        let mut path = key.split('.');
        let mut part = (path.next() == Some("launch")).then_some(self)?;
        for step in path {
            part = match part {
                Self::Table(entries) => &mut entries.iter_mut().find(|(name, _)| name == step)?.1,
                Self::List(items) => {
                    let index = COMPONENTS.iter().position(|name| *name == step)?;
                    items.get_mut(index)?
                }
                Self::Number(_) | Self::Word(_) => return None,
            };
        }
        match part {
            Self::Number(number) => Some(number),
            _ => None,
        }
    }

    /// The keys of all numbers.
    pub(super) fn keys(&self) -> Vec<String> {
        let mut keys = vec![];
        self.collect_keys("launch", &mut keys);
        keys
    }

    fn collect_keys(&self, key: &str, keys: &mut Vec<String>) {
        match self {
            Self::Number(_) => keys.push(key.to_owned()),
            Self::Word(_) => {}
            Self::List(items) => {
                for (name, item) in COMPONENTS.iter().zip(items) {
                    item.collect_keys(&format!("{key}.{name}"), keys);
                }
            }
            Self::Table(entries) => {
                for (name, item) in entries {
                    item.collect_keys(&format!("{key}.{name}"), keys);
                }
            }
        }
    }

    /// Multiplies the spread of every distribution: the standard deviation of a normal one, and the
    /// width of a uniform one about its middle. Whether there is any spread.
    pub(super) fn spread(&mut self, factor: f64) -> bool {
        match self {
            Self::Number(_) | Self::Word(_) => false,
            Self::List(items) => spread_each(items.iter_mut(), factor),
            Self::Table(entries) => match &mut entries[..] {
                [(name, parameters)] if name == "normal" => parameters.stretch("sd", factor),
                [(name, _)] if name == ISOTROPIC => self.stretch(ISOTROPIC, factor),
                [(name, parameters)] if name == "uniform" => {
                    let Some([from, to]) = parameters.ends() else {
                        return false;
                    };
                    *self = uniform([from, to], factor);
                    true
                }
                entries => spread_each(entries.iter_mut().map(|(_, part)| part), factor),
            },
        }
    }

    fn entry(&mut self, key: &str) -> Option<&mut f64> {
        match self {
            Self::Table(entries) => {
                match &mut entries.iter_mut().find(|(name, _)| name == key)?.1 {
                    Self::Number(number) => Some(number),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// Multiplies the standard deviation under a key; whether it is any.
    fn stretch(&mut self, key: &str, factor: f64) -> bool {
        let Some(sd) = self.entry(key) else {
            return false;
        };
        let spread = *sd > 0.0;
        *sd *= factor;
        spread
    }

    fn ends(&mut self) -> Option<[f64; 2]> {
        Some([*self.entry("from")?, *self.entry("to")?])
    }
}

fn spread_each<'a>(parts: impl Iterator<Item = &'a mut Launch>, factor: f64) -> bool {
    let mut spread = false;
    for part in parts {
        spread |= part.spread(factor);
    }
    spread
}

/// A uniform distribution of another width about the same middle; without any width a number.
fn uniform([from, to]: [f64; 2], factor: f64) -> Launch {
    let (middle, half) = (0.5 * (from + to), 0.5 * factor * (to - from));
    // the ends as they were, without rounding
    let [low, high] = if factor == 1.0 {
        [from, to]
    } else {
        [middle - half, middle + half]
    };
    if low == high {
        return Launch::Number(middle);
    }
    let ends = [("from", low), ("to", high)];
    let ends = ends.map(|(key, end)| (key.to_owned(), Launch::Number(end)));
    Launch::Table(vec![("uniform".to_owned(), Launch::Table(ends.to_vec()))])
}

/// An inline table of TOML.
impl fmt::Display for Launch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number:?}"),
            Self::Word(word) => f.write_str(word),
            Self::List(items) => {
                f.write_char('[')?;
                for (index, item) in items.iter().enumerate() {
                    let comma = if index == 0 { "" } else { ", " };
                    write!(f, "{comma}{item}")?;
                }
                f.write_char(']')
            }
            Self::Table(entries) => {
                f.write_char('{')?;
                for (index, (key, item)) in entries.iter().enumerate() {
                    let comma = if index == 0 { "" } else { "," };
                    write!(f, "{comma} {key} = {item}")?;
                }
                f.write_str(" }")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Template;
    use coinmc::plan::Plan;
    use coinmc_core::{Marginal, Preset, Spin};

    const HAND: &str = "coin.ratio = 1\nsurface.material = 'wood'\nlaunch.preset = 'hand'\n\
                        engine.volumetric = {}";

    /// The plan of a config, the config spelled out, and its launch.
    fn spelled(text: &str) -> (Plan, Template, Launch) {
        let template = Template::new("inline", text, &[]);
        let (plan, spelled) = template.spelled_out().expect("a plan");
        let launch = Launch::of(&plan.resolved_toml).expect("a launch");
        (plan, spelled, launch)
    }

    #[test]
    fn a_launch_is_read_and_written() {
        for preset in Preset::ALL {
            let text = HAND.replace("hand", preset.name());
            let (plan, spelled, launch) = spelled(&text);
            let again = spelled
                .plan(&[("launch", launch.to_string())])
                .expect("a plan");
            assert_eq!(again.points, plan.points);
            assert_eq!(again.hash(), plan.hash());
        }
    }

    #[test]
    fn numbers_are_found_by_their_keys() {
        let (_, _, mut launch) = spelled(HAND);
        let mut number = |key: &str| launch.number(key).copied();
        assert_eq!(number("launch.height_m"), Some(1.0));
        assert_eq!(number("launch.velocity_m_s.z.normal.mean"), Some(2.4));
        assert_eq!(number("launch.velocity_m_s.z"), None);
        assert_eq!(number("launch.velocity_m_s.w"), None);
        assert_eq!(number("coin.ratio"), None);
        for key in launch.clone().keys() {
            assert!(launch.number(&key).is_some(), "{key}");
        }
    }

    /// Wherever a distribution stands, its spread is multiplied: in a list, deep in a table, or of a
    /// uniform one about its middle.
    #[test]
    fn a_clumsier_hand_spreads_more() {
        let text = HAND.replace(
            "'hand'",
            "'hand'\nlaunch.height_m.uniform = { from = 1, to = 2 }",
        );
        let (_, spelled, mut launch) = spelled(&text);
        assert!(launch.spread(1.5));
        let plan = spelled
            .plan(&[("launch", launch.to_string())])
            .expect("a plan");
        let found = &plan.points[0].launches;
        assert_eq!(
            found.height_m,
            Marginal::Uniform {
                from: 0.75,
                to: 2.25
            }
        );
        let upwards = Marginal::Normal {
            mean: 2.4,
            sd: 1.5 * 0.24,
        };
        assert_eq!(found.velocity_m_s[2], upwards);
        let Spin::Precessing {
            rate_rad_s: Marginal::Normal { mean, sd },
            ..
        } = found.spin
        else {
            panic!("{:?}", found.spin);
        };
        assert_eq!((mean, sd), (238.6, 1.5 * 23.86));
    }

    /// A spin about any axis has its standard deviation under a key of its own.
    #[test]
    fn a_spin_about_any_axis_is_spread_too() {
        let text = HAND.replace(
            "launch.preset = 'hand'",
            "launch = { height_m = 1, velocity_m_s = [0, 0, 0], orientation = 'isotropic', spin.isotropic_sd_rad_s = 8 }",
        );
        let (_, spelled, mut launch) = spelled(&text);
        let (mean, sd) = (0.0, 12.0);
        let cases = [
            (1.5, Marginal::Normal { mean, sd }),
            (0.0, Marginal::Constant(0.0)),
        ];
        for (factor, component) in cases {
            assert!(launch.spread(factor));
            let plan = spelled
                .plan(&[("launch", launch.to_string())])
                .expect("a plan");
            let Spin::Components(components) = plan.points[0].launches.spin else {
                panic!("{:?}", plan.points[0].launches.spin);
            };
            assert_eq!(components, [component; 3]);
        }
        assert!(!launch.spread(2.0));
    }

    #[test]
    fn a_hand_without_spread_is_certain() {
        let mut launch = uniform([1.0, 2.0], 1.0);
        assert!(launch.spread(0.0));
        assert_eq!(launch, Launch::Number(1.5));
        assert!(!launch.spread(2.0));
    }
}
