//! What a config means.

use coinmc::config;
use coinmc::plan::{Plan, Stop};
use serde_json::{Map, Value, json};

/// The name of the config in messages.
const NAME: &str = "config";

/// The plan of a config, or all its problems as text.
pub(crate) fn plan(text: &str) -> Result<Plan, String> {
    config::parse(NAME, text, &[]).map_err(|problems| problems.render(false))
}

pub(crate) fn check(text: &str) -> Value {
    let plan = match config::parse(NAME, text, &[]) {
        Ok(plan) => plan,
        Err(problems) => {
            let found = problems.problems().iter().map(|problem| {
                json!({
                    "line": problem.line,
                    "column": problem.column,
                    "message": problem.message,
                    "help": problem.help,
                })
            });
            return json!({ "problems": found.collect::<Vec<_>>() });
        }
    };
    let points = plan.points.iter().map(|point| {
        let parameters = point.parameters.iter();
        let parameters = parameters.map(|(name, value)| (name.to_string(), json!(value)));
        json!({
            "engine": point.engine.name(),
            "law": point.engine.law(),
            "tosses": point.engine.makes_tosses(),
            "parameters": parameters.collect::<Map<_, _>>(),
        })
    });
    let tosses = match plan.stop {
        Stop::Tosses(tosses) => tosses,
        Stop::Targets(targets) => targets.max_tosses,
    };
    json!({
        "seed": plan.seed,
        "tosses": tosses,
        "confidence": plan.confidence,
        "hash": plan.hash(),
        "notes": plan.notes,
        "points": points.collect::<Vec<_>>(),
    })
}
