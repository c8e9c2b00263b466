//! What can be asked.

use crate::{Answer, about, check, motion, ratio, tosses};
use serde::Deserialize;
use std::collections::BTreeMap;

/// A question. `config` is a config's text, TOML.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "ask", rename_all = "lowercase", deny_unknown_fields)]
pub enum Question {
    /// What there is to choose from: `version` and `build`, and the `materials` and `launches` with their numbers.
    About,
    /// What a config means: seed, tosses, engine, law, parameters, notes; or its `problems`.
    Check {
        /// The config.
        config: String,
    },
    /// The `tally` of a range of tosses: counts by the names of the results' columns.
    Toss {
        /// The config.
        config: String,
        /// Index of the point, from 0.
        #[serde(default)]
        point: usize,
        /// Number of the first toss.
        from: u64,
        /// Number after that of the last.
        to: u64,
    },
    /// The probabilities of the faces, with their intervals, from a tally.
    Estimate {
        /// The config, for its confidence and interval.
        config: String,
        /// The counts; those left out are 0.
        tally: BTreeMap<String, u64>,
    },
    /// One toss to draw: states over time, and the events.
    Motion {
        /// The config.
        config: String,
        /// Index of the point, from 0.
        #[serde(default)]
        point: usize,
        /// Number of the toss.
        toss: u64,
        /// Most states of the answer.
        most: usize,
    },
    /// The ratio at which the side comes up in a third of the tosses: the document of `coinmc fair`.
    Fair {
        /// The config.
        config: String,
        /// Half width asked for of its interval.
        half_width: f64,
        /// Tosses at which the search stops short of that.
        max_tosses: u64,
    },
}

impl Question {
    pub(crate) fn answer(&self) -> Answer {
        match self {
            Self::About => Ok(about::about()),
            Self::Check { config } => Ok(check::check(config)),
            Self::Toss {
                config,
                point,
                from,
                to,
            } => tosses::toss(config, *point, *from..*to),
            Self::Estimate { config, tally } => tosses::estimate(config, tally),
            Self::Motion {
                config,
                point,
                toss,
                most,
            } => motion::motion(config, *point, *toss, *most),
            Self::Fair {
                config,
                half_width,
                max_tosses,
            } => ratio::fair(config, *half_width, *max_tosses),
        }
    }
}
