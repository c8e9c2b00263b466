//! What a run will compute: every point with its scene, launches and engine, and when to stop.
//!
//! A plan is derived from a config and is all that running needs. Two plans with the same
//! [`Plan::hash`] give the same results to the byte.

mod explain;
mod extension;
mod looks;
mod points;
mod sampling;
mod stop;

pub use coinmc_core::EngineChoice;
pub use coinmc_quadrature::{Goal, Integral, MAX_EVALUATIONS, Method};
pub use explain::Explanation;
pub(crate) use extension::Extension;
pub use extension::{Change, Obstacle};
pub(crate) use looks::PILOT;
pub use looks::{Looks, Verdict};
pub use points::Points;
pub(crate) use points::Way;
pub use sampling::Sampling;
pub use stop::{Stop, StoppedBy, Targets};

use coinmc_core::{Answer, DynEngine, EngineError, IntervalMethod, LaunchDistribution, Scene};
use sha2::{Digest, Sha256};
use std::fmt::Write;
use std::sync::Arc;
use toml::de::{DeTable, DeValue};

/// Most points of a plan.
pub const MAX_POINTS: u64 = 1_000_000;

/// Most tosses of a point.
pub const MAX_TOSSES: u64 = 1_000_000_000_000_000;

/// Version of the meaning of a resolved config. It changes when the same text gives other results.
const PLAN_FORMAT: u32 = 2;

/// Version of the rule by which points stop at targets.
const LOOKS_FORMAT: u32 = 3;

/// Everything a run will do.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Key of all random numbers.
    pub seed: u64,
    /// All points share their random numbers, so that differences between points are sharper
    /// than the points.
    pub paired: bool,
    /// When a point has enough tosses.
    pub stop: Stop,
    /// How launches are drawn where the first contact decides.
    pub sampling: Sampling,
    /// Confidence of every interval, in (0, 1).
    pub confidence: f64,
    /// How intervals are computed when the number of tosses is fixed.
    pub interval: IntervalMethod,
    /// Names of the swept parameters, in the order in which they were swept (first varies
    /// slowest). Each is a key of every point's `parameters`.
    pub axes: Vec<String>,
    /// The points, in order; a point's index is its place here.
    pub points: Points,
    /// The config as understood: every default, preset and material spelled out, overrides applied.
    /// TOML that parses to this same plan, but for the notes on what it spells out.
    pub resolved_toml: String,
    /// Remarks on the config that are not errors: keys without effect, possible surprises.
    pub notes: Vec<String>,
}

impl Plan {
    /// A name for the plan: SHA-256, in hex, of the resolved config and the version of its
    /// format. Plans have the same hash exactly when they are equal.
    pub fn hash(&self) -> String {
        let mut hasher = Sha256::new();
        hasher.update(format!("coinmc plan {PLAN_FORMAT}\n"));
        if matches!(self.stop, Stop::Targets(_)) {
            hasher.update(format!("looks {LOOKS_FORMAT}\n"));
        }
        hasher.update(&self.resolved_toml);
        hasher
            .finalize()
            .iter()
            .fold(String::new(), |mut hex, byte| {
                write!(hex, "{byte:02x}").expect("writing to a string cannot fail");
                hex
            })
    }

    /// The number of the resolved config under a dotted key such as `surface.friction`; `None` if
    /// there is none there, or a list or range.
    pub fn number(&self, key: &str) -> Option<f64> {
        let mut table = DeTable::parse(&self.resolved_toml).ok()?.into_inner();
        let mut path = key.split('.').peekable();
        loop {
            let value = table.remove(path.next()?)?.into_inner();
            match (value, path.peek()) {
                (DeValue::Table(inner), Some(_)) => table = inner,
                (DeValue::Float(number), None) => return number.as_str().parse().ok(),
                (DeValue::Integer(number), None) => {
                    return number.as_str().replace('_', "").parse().ok();
                }
                _ => return None,
            }
        }
    }

    /// Tosses that the run will make at most, over all points.
    pub fn tosses_planned(&self) -> u64 {
        let (each, total) = match self.stop {
            Stop::Tosses(tosses) => (tosses, None),
            Stop::Targets(targets) => (targets.max_tosses, targets.total_tosses),
        };
        // MAX_POINTS · MAX_TOSSES lies beyond u64
        let all = each.saturating_mul(self.points_tossed());
        total.map_or(all, |total| total.min(all))
    }
}

/// One point of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// The parameters that results show: always `ratio`, `radius_m`, `restitution`, `friction`,
    /// `rolling_friction_m`, `pivoting_friction_m` and the other [`Scene::PARAMETERS`], and every swept
    /// one, by the name of its column.
    pub parameters: Vec<(Arc<str>, f64)>,
    /// Coin, surface, gravity, drag.
    pub scene: Scene,
    /// How the coin is let go.
    pub launches: LaunchDistribution,
    /// Who follows the toss.
    pub engine: EngineChoice,
}

impl Point {
    /// The engine that tosses here; `None` if a closed form answers.
    ///
    /// # Errors
    /// [`EngineError`] if the engine refuses its settings.
    pub fn build_engine(&self) -> Result<Option<DynEngine>, EngineError> {
        Ok(match self.engine.build(&self.scene)? {
            Answer::Tosses(engine) => Some(engine),
            Answer::Exact(_) => None,
        })
    }

    /// The exact probabilities of heads, tails and side, if a closed form answers.
    pub(crate) fn exact(&self) -> Option<[f64; 3]> {
        if self.engine.makes_tosses() {
            return None;
        }
        match self.engine.build(&self.scene) {
            Ok(Answer::Exact(faces)) => Some(faces),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbers_of_the_config_are_found_under_their_keys() {
        let text = "seed = 7\ncoin.ratio = [1, 2]\nsurface = { restitution = 0.5, friction = 0.25 }\n\
                    launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 2_000_000";
        let plan = crate::config::parse("inline", text, &[]).unwrap();
        for (key, number) in [
            ("seed", 7.0),
            ("stop.tosses", 2e6),
            ("surface.friction", 0.25),
            ("engine.flat.zeno", coinmc_flat::Settings::default().zeno),
        ] {
            assert_eq!(plan.number(key), Some(number), "{key}");
        }
        for none in [
            "",
            "seed.ratio",
            "surface",
            "surface.wool",
            "surface.friction.static",
            "coin.ratio",
            "engine.flat.law",
        ] {
            assert_eq!(plan.number(none), None, "{none}");
        }
    }
}
