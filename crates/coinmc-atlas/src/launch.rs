//! The launches that the atlas knows.

use crate::AtlasError;
use std::str::FromStr;

/// How the coin is let go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Launch {
    /// Tossed by hand.
    Hand,
    /// Dropped.
    Dropped,
    /// Rolled on its rim.
    Rolled,
}

impl Launch {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Hand, Self::Dropped, Self::Rolled];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hand => "hand",
            Self::Dropped => "dropped",
            Self::Rolled => "rolled",
        }
    }

    /// What it is.
    pub const fn doc(self) -> &'static str {
        match self {
            Self::Hand => {
                "tossed by hand from 0.3 m above the table: heads up, 2.4 m/s upwards, 38 turns a second"
            }
            Self::Dropped => "dropped from rest at 1 m, any side up",
            Self::Rolled => "set rolling on its rim at 0.5 m/s, leaning by some 3 degrees",
        }
    }

    /// The config of which its part of the atlas is made: `coinmc run` tosses it.
    pub const fn design(self) -> &'static str {
        match self {
            Self::Hand => include_str!("../designs/hand.toml"),
            Self::Dropped => include_str!("../designs/dropped.toml"),
            Self::Rolled => include_str!("../designs/rolled.toml"),
        }
    }

    /// Its part of the atlas, as bytes of a file.
    pub(crate) const fn networks(self) -> &'static [u8] {
        match self {
            Self::Hand => include_bytes!("../networks/hand.atlas"),
            Self::Dropped => include_bytes!("../networks/dropped.atlas"),
            Self::Rolled => include_bytes!("../networks/rolled.atlas"),
        }
    }
}

impl FromStr for Launch {
    type Err = AtlasError;

    fn from_str(name: &str) -> Result<Self, AtlasError> {
        let found = Self::ALL.into_iter().find(|launch| launch.name() == name);
        found.ok_or_else(|| AtlasError::NoLaunch {
            name: name.to_owned(),
            known: Self::ALL.map(Self::name).join(", "),
        })
    }
}
