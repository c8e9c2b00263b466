//! From the checked config to the points of a plan.

use super::at::{At, Fault, get};
use super::checked::{Checked, CheckedValue};
use super::columns::Columns;
use super::diagnostics::Problems;
use super::engines;
use super::launch;
use super::sweep::Sweep;
use super::values::read;
use crate::engines::EngineKind;
use crate::plan::{Point, Sampling, Stop, Targets};
use coinmc_core::{Coin, IntervalMethod, LaunchDistribution, Preset, Scene, Surface};
use std::collections::HashSet;

/// Every point of the sweep. Each problem is reported once, at the first point that has it.
pub(super) fn points(root: &Checked, sweep: &Sweep, problems: &mut Problems) -> Vec<Point> {
    let mut points = Vec::new();
    let mut blamed = HashSet::new();
    let sound = problems.is_empty();
    let mut at = At::new(sweep, sound);
    if sound {
        points.reserve_exact(sweep.points);
    }
    let mut scenes = Part::new(root, &["coin", "surface", "environment"]);
    let mut all_launches = Part::new(root, &["launch"]);
    let mut all_engines = Part::new(root, &["engine"]);
    let columns = Columns::new(sweep);
    for index in 0..sweep.points {
        sweep.indices(index, &mut at.indices);
        let mut report = |fault| {
            if let Fault::Problem {
                span,
                message,
                help,
            } = fault
                && blamed.insert(span)
            {
                problems.push(span, message, help);
            }
        };
        let scene = scenes.at(|| scene(root, &at), &mut report);
        let launches = all_launches.at(|| launches(root, &at), &mut report);
        let engine = all_engines.at(|| engines::choice(root, &at), &mut report);
        if let (true, Some(scene), Some(launches), Some(engine)) = (sound, scene, launches, engine)
        {
            points.push(Point {
                parameters: columns.parameters(&scene, sweep, &at.indices),
                scene,
                launches,
                engine,
            });
        }
    }
    points
}

/// A part of a point, built once if the sweep does not touch it.
struct Part<T> {
    swept: bool,
    /// Whether `last` is the result of an attempt.
    tried: bool,
    last: Option<T>,
}

impl<T: Clone> Part<T> {
    fn new(root: &Checked, tables: &[&str]) -> Self {
        let swept = tables
            .iter()
            .filter_map(|table| root.get(table))
            .any(Checked::is_swept);
        Self {
            swept,
            tried: false,
            last: None,
        }
    }

    fn at(
        &mut self,
        build: impl FnOnce() -> Result<T, Fault>,
        report: &mut impl FnMut(Fault),
    ) -> Option<T> {
        if self.swept || !self.tried {
            self.tried = true;
            self.last = build().map_err(report).ok();
        }
        self.last.clone()
    }
}

fn scene(root: &Checked, at: &At<'_>) -> Result<Scene, Fault> {
    let coin = read(get(root, "coin")?, at, Coin::read)?;
    let surface = match root.get("surface") {
        Some(checked) => read(checked, at, |surface| Surface::read(surface, &coin))?,
        // only closed forms need no surface
        None => Surface::adhesive(),
    };
    read(get(root, "environment")?, at, |environment| {
        Scene::read(coin, surface, environment)
    })
}

fn launches(root: &Checked, at: &At<'_>) -> Result<LaunchDistribution, Fault> {
    let Some(checked) = root.get("launch") else {
        // only closed forms need no launch, and they draw none
        return Ok(Preset::Robot.distribution());
    };
    let launches = read(checked, at, LaunchDistribution::read)?;
    launches
        .validate()
        .map_err(|error| Fault::problem(checked.span, error.to_string(), None))?;
    if let Some(engine) = engines::descriptor(root)
        && engine.kind == EngineKind::Planar
    {
        launch::require_planar(checked, &launches, engine.name)?;
    }
    Ok(launches)
}

/// When to stop; `None` for a closed form.
pub(super) fn stop(root: &Checked) -> Option<Stop> {
    if engines::descriptor(root)?.kind == EngineKind::ClosedForm {
        return Some(Stop::Tosses(0));
    }
    let checked = root.get("stop")?;
    if let Some(tosses) = integer(checked, "tosses") {
        return Some(Stop::Tosses(tosses));
    }
    Some(Stop::Targets(Targets {
        half_width: real(checked, "half_width"),
        relative_error: real(checked, "relative_error"),
        events: integer(checked, "events"),
        max_tosses: integer(checked, "max_tosses")?,
        total_tosses: integer(checked, "total_tosses"),
        max_core_seconds: real(checked, "max_core_seconds"),
        total_core_seconds: real(checked, "total_core_seconds"),
    }))
}

/// Reports a limit of tosses for the whole run that leaves some point without any.
pub(super) fn refuse_small_total(root: &Checked, points: usize, problems: &mut Problems) {
    let total = root.get("stop").and_then(|stop| stop.get("total_tosses"));
    if let Some(found) = total
        && let CheckedValue::Integer(tosses) = found.value
        && tosses < points as u64
    {
        let message = format!("`total_tosses` is {tosses}, but there are {points} points");
        problems.push(found.span, message, None);
    }
}

/// How launches are drawn.
pub(super) fn sampling(root: &Checked) -> Option<Sampling> {
    let name = root.get("sampling")?.get("method")?.word()?;
    Sampling::ALL.into_iter().find(|known| known.name() == name)
}

/// Confidence and method of the intervals.
pub(super) fn estimate(root: &Checked) -> Option<(f64, IntervalMethod)> {
    let checked = root.get("estimate")?;
    let name = checked.get("interval")?.word()?;
    let method = [IntervalMethod::Wilson, IntervalMethod::ClopperPearson]
        .into_iter()
        .find(|method| method.name() == name)?;
    Some((real(checked, "confidence")?, method))
}

pub(super) fn integer(checked: &Checked, key: &str) -> Option<u64> {
    match checked.get(key)?.value {
        CheckedValue::Integer(value) => Some(value),
        _ => None,
    }
}

pub(super) fn boolean(checked: &Checked, key: &str) -> Option<bool> {
    match checked.get(key)?.value {
        CheckedValue::Boolean(value) => Some(value),
        _ => None,
    }
}

fn real(checked: &Checked, key: &str) -> Option<f64> {
    match checked.get(key)?.value {
        CheckedValue::Real(value) => Some(value),
        _ => None,
    }
}
