//! Configs of the engine in time steps: what they come to mean, and that they run.

use crate::support::parse;
use coinmc::plan::EngineChoice;
use coinmc::run::{Chunk, run_chunk};
use coinmc_rapier::{Decision, Flight, FrictionModel, Gyroscopic, Settings, Standing};
use std::collections::HashSet;

const IN_STEPS: &str = "
[coin]
ratio = 2.0
[surface]
restitution = 0.5
friction = 0.3
rolling_friction_m = 0.0
pivoting_friction_m = 0.0
[launch]
preset = 'clean'
[engine.rapier]
[stop]
tosses = 20
";

#[test]
fn the_engine_has_the_defaults_of_its_crate() {
    let plan = parse(IN_STEPS, &[]);
    let points: Vec<_> = plan.points.iter().collect();
    let [point] = points[..] else {
        panic!("one point")
    };
    assert_eq!(point.engine, EngineChoice::new(Settings::default()));
    assert_eq!(plan.tosses_planned(), 20);
    // its error is not in the intervals
    assert!(matches!(&plan.notes[..], [note] if note.contains("docs/methods/rapier.md")));
    assert_eq!(parse(&plan.resolved_toml, &[]), plan);
    let [explanation] = &plan.explain()[..] else {
        panic!("one treatment")
    };
    assert!(explanation.computed.contains("steps of Rapier, 4 substeps"));
    assert!(explanation.skipped.iter().any(|s| s.starts_with("drag")));
}

#[test]
fn every_setting_of_the_engine_can_be_given() {
    let sets = [
        "engine.rapier={step_s=5e-4, substeps=2, friction_model='simplified', \
                 prediction=0.01, ccd=true, gyroscopic='rapier', flight='steps', \
                 standing='rapier', tosses_at_once=8, decision='energy', max_gain=0.1, \
                 max_steps=9, time_limit=50}",
    ];
    let chosen = Settings {
        step_s: 5e-4,
        substeps: 2,
        friction_model: FrictionModel::Simplified,
        prediction: 0.01,
        ccd: true,
        gyroscopic: Gyroscopic::Rapier,
        flight: Flight::Steps,
        standing: Standing::Rapier,
        tosses_at_once: 8,
        decision: Decision::Energy,
        max_gain: 0.1,
        max_steps: 9,
        time_limit: 50.0,
    };
    let plan = parse(IN_STEPS, &sets);
    assert_eq!(plan.points[0].engine, EngineChoice::new(chosen));
    assert_eq!(parse(&plan.resolved_toml, &[]), plan);
}

/// A step is an axis like any other.
#[test]
fn a_step_can_be_swept() {
    let plan = parse(IN_STEPS, &["engine.rapier.step_s=[2e-3, 1e-3]"]);
    assert_eq!(plan.axes, ["engine.rapier.step_s"]);
    let steps: HashSet<u64> = plan
        .points
        .iter()
        .map(|point| match point.engine.settings::<Settings>() {
            Some(settings) => settings.step_s.to_bits(),
            None => panic!("another engine"),
        })
        .collect();
    assert_eq!(steps.len(), 2);
}

/// Chunks of any cut come to the same tally.
#[test]
fn chunks_add_up() {
    let plan = parse(IN_STEPS, &["engine.rapier.step_s=2e-3"]);
    let chunk = |tosses| run_chunk(&plan, &Chunk { point: 0, tosses }).unwrap();
    let whole = chunk(0..20);
    let mut parts = chunk(13..20);
    parts.merge(&chunk(0..13));
    assert_eq!(whole, parts);
    assert_eq!(whole.tosses(), 20);
    assert!(whole.side > 10);
}
