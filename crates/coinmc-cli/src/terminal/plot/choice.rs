//! What to plot: an axis and a face, from the command line.

use anyhow::{Error, anyhow};
use coinmc_core::Face;
use std::fmt;
use std::str::FromStr;

/// What to plot of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Plotted {
    Nothing,
    /// A face along an axis; the axis is the ratio, where that is swept, unless one is given.
    Face {
        face: Face,
        along: Option<String>,
    },
}

impl Default for Plotted {
    fn default() -> Self {
        Self::Face {
            face: Face::Side,
            along: None,
        }
    }
}

impl FromStr for Plotted {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "none" {
            return Ok(Self::Nothing);
        }
        let (mut face, mut along) = (None, None);
        for word in text.split(',').map(str::trim) {
            let taken = match Face::named(word) {
                Some(named) => face.replace(named).is_some(),
                None => word.is_empty() || along.replace(column(word)).is_some(),
            };
            if taken {
                return Err(
                    "expected a swept parameter, a face (heads, tails or side), both as in \
                     `friction,heads`, or `none`"
                        .to_owned(),
                );
            }
        }
        Ok(Self::Face {
            face: face.unwrap_or(Face::Side),
            along,
        })
    }
}

/// As it is given on the command line.
impl fmt::Display for Plotted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => f.write_str("none"),
            Self::Face { face, along: None } => f.write_str(face.name()),
            Self::Face {
                face,
                along: Some(along),
            } => write!(f, "{along},{}", face.name()),
        }
    }
}

impl Plotted {
    /// Whether a run with these axes can be plotted so.
    pub(crate) fn check(&self, axes: &[String]) -> Result<(), Error> {
        let Self::Face {
            along: Some(along), ..
        } = self
        else {
            return Ok(());
        };
        if axes.contains(along) {
            return Ok(());
        }
        let swept = if axes.is_empty() {
            "nothing".to_owned()
        } else {
            axes.join(", ")
        };
        Err(anyhow!(
            "nothing can be plotted along {along}, which is not swept: swept is {swept}"
        ))
    }
}

/// The column of a config key: without its table for coin, surface and environment.
fn column(word: &str) -> String {
    match word.split_once('.') {
        Some(("coin" | "surface" | "environment", key)) => key.to_owned(),
        _ => word.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axis_and_face_come_in_any_order() {
        let of = |text: &str| text.parse::<Plotted>();
        let heads = |along: Option<&str>| {
            Ok(Plotted::Face {
                face: Face::Heads,
                along: along.map(str::to_owned),
            })
        };
        assert_eq!(of("heads"), heads(None));
        assert_eq!(of("friction,heads"), heads(Some("friction")));
        assert_eq!(of("heads, surface.friction"), heads(Some("friction")));
        assert_eq!(of("none"), Ok(Plotted::Nothing));
        for bad in ["", "heads,tails", "a,b", "heads,"] {
            assert!(of(bad).is_err(), "{bad}");
        }
        for text in ["none", "side", "friction,tails"] {
            assert_eq!(of(text).unwrap().to_string(), text);
        }
    }

    #[test]
    fn an_axis_must_be_swept() {
        let plotted: Plotted = "friction".parse().unwrap();
        assert!(plotted.check(&["friction".to_owned()]).is_ok());
        let error = plotted
            .check(&["ratio".to_owned()])
            .unwrap_err()
            .to_string();
        assert!(error.ends_with("swept is ratio"), "{error}");
        // what is not asked for is no mistake, however it is spelled
        let default: Plotted = Plotted::default().to_string().parse().unwrap();
        assert_eq!(default, Plotted::default());
        assert!(default.check(&[]).is_ok());
    }
}
