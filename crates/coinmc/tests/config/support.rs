//! Helpers of the tests of configs.

use coinmc::config::{self, Override};
use coinmc::plan::Plan;
use std::sync::Arc;

/// A small flat run: all that a config needs.
pub(crate) const SMALL: &str = "\
[coin]
ratio = 1.2
[surface]
restitution = 0.5
friction = 0.3
[launch]
preset = 'robot'
[engine.flat]
[stop]
tosses = 1000
";

/// The plan of a config with `--set` options; panics with the problems of a bad one.
pub(crate) fn parse(text: &str, sets: &[&str]) -> Plan {
    let overrides: Vec<Override> = sets.iter().map(|set| set.parse().unwrap()).collect();
    config::parse("test.toml", text, &overrides).unwrap_or_else(|problems| panic!("{problems}"))
}

/// A parameter's value at every point.
pub(crate) fn column(plan: &Plan, name: &str) -> Vec<f64> {
    let value = |(key, value): &(Arc<str>, f64)| (**key == *name).then_some(*value);
    plan.points
        .iter()
        .map(|point| point.parameters.iter().find_map(value).unwrap())
        .collect()
}
