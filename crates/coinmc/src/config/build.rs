//! From the checked config to the points of a plan.

use super::at::{At, Fault};
use super::checked::{Checked, CheckedValue};
use super::columns::Columns;
use super::diagnostics::Problems;
use super::engines;
use super::launch;
use super::notes::Notes;
use super::sweep::Sweep;
use super::values::{read, read_on};
use crate::OnDemand;
use crate::engines::EngineKind;
use crate::on_demand::WHOLE;
use crate::plan::{EngineChoice, Point, Points, Sampling, Stop, Targets, Way};
use coinmc_core::{Coin, Face, IntervalMethod, LaunchDistribution, Preset, Scene, Surface};
use std::collections::HashSet;
use std::sync::Arc;

/// The points of a sweep, and what was seen in a pass over them.
pub(super) struct Built {
    /// Incomplete after a problem.
    pub(super) list: Points,
    pub(super) notes: Notes,
    pub(super) sweep: Arc<Sweep>,
}

impl Built {
    /// Names of the swept parameters.
    pub(super) fn axes(&self) -> Vec<String> {
        let axes = self.sweep.axes.iter();
        axes.map(|axis| axis.name.clone()).collect()
    }
}

/// Every point of the sweep. Each problem is reported once, at the first point that has it. Long lists
/// are not kept: their points are built again when they are asked for.
pub(super) fn points(root: &Checked, sweep: Sweep, problems: &mut Problems) -> Built {
    let sweep = Arc::new(sweep);
    let (mut points, mut ways, mut notes) = (Vec::new(), Vec::new(), Notes::default());
    let mut blamed = HashSet::new();
    let sound = problems.is_empty();
    let is_long = sweep.points > WHOLE;
    let mut builder = Builder::new(root, Arc::clone(&sweep), sound);
    for index in 0..sweep.points {
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
        if let Some(point) = builder.point(root, index, &mut report).filter(|_| sound) {
            ways.push(Way::of(&point));
            notes.see(&point);
            if !is_long {
                points.push(point);
            }
        }
    }
    let list = if is_long && sound && ways.len() == sweep.points {
        let root = root.clone();
        OnDemand::made(sweep.points, move |index| {
            // it holds what the sweep does not touch
            let mut builder = builder.clone();
            let point = builder.point(&root, index, &mut |_| {});
            point.unwrap_or_else(|| unreachable!("it was built before"))
        })
    } else {
        ways.truncate(points.len());
        OnDemand::from(points)
    };
    Built {
        list: Points::new(list, ways),
        notes,
        sweep,
    }
}

/// Builds points, and keeps what the sweep does not touch.
#[derive(Clone)]
struct Builder {
    sweep: Arc<Sweep>,
    sound: bool,
    columns: Arc<Columns>,
    scenes: Part<Scene>,
    launches: Part<LaunchDistribution>,
    engines: Part<EngineChoice>,
}

impl Builder {
    fn new(root: &Checked, sweep: Arc<Sweep>, sound: bool) -> Self {
        Self {
            sound,
            columns: Arc::new(Columns::new(&sweep)),
            scenes: Part::new(root, &["coin", "surface", "environment"]),
            launches: Part::new(root, &["launch"]),
            engines: Part::new(root, &["engine"]),
            sweep,
        }
    }

    fn point(
        &mut self,
        root: &Checked,
        index: usize,
        report: &mut impl FnMut(Fault),
    ) -> Option<Point> {
        let mut at = At::new(&self.sweep, self.sound);
        self.sweep.indices(index, &mut at.indices);
        let scene = self.scenes.at(|| scene(root, &at), report);
        let one = |fault| vec![fault];
        let launches = self
            .launches
            .at(|| launches(root, &at).map_err(one), report);
        let engine = self
            .engines
            .at(|| engines::choice(root, &at).map_err(one), report);
        let scene = scene?;
        Some(Point {
            parameters: self.columns.parameters(&scene, &self.sweep, &at.indices),
            scene,
            launches: launches?,
            engine: engine?,
        })
    }
}

/// A part of a point, built once if the sweep does not touch it.
#[derive(Clone)]
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
        build: impl FnOnce() -> Result<T, Vec<Fault>>,
        report: &mut impl FnMut(Fault),
    ) -> Option<T> {
        if self.swept || !self.tried {
            self.tried = true;
            self.last = build()
                .map_err(|faults| faults.into_iter().for_each(report))
                .ok();
        }
        self.last.clone()
    }
}

/// The scene, or all that is wrong with it.
fn scene(root: &Checked, at: &At<'_>) -> Result<Scene, Vec<Fault>> {
    let mut faults = Vec::new();
    match scene_despite(root, at, &mut faults) {
        Some(scene) if faults.is_empty() => Ok(scene),
        _ => Err(faults),
    }
}

fn scene_despite(root: &Checked, at: &At<'_>, faults: &mut Vec<Fault>) -> Option<Scene> {
    let coin = read_on(root.get("coin")?, at, faults, Coin::read)?;
    let surface = match root.get("surface") {
        Some(checked) => read_on(checked, at, faults, |surface| Surface::read(surface, &coin))?,
        // only closed forms need no surface
        None => Surface::adhesive(),
    };
    read_on(root.get("environment")?, at, faults, |environment| {
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
        face: checked
            .get("face")
            .and_then(Checked::word)
            .and_then(Face::named),
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
