//! From the checked config to the points of a plan.

use super::diagnostics::Problems;
use super::engines;
use super::form::{Form, What};
use super::launch;
use super::source::Span;
use super::sweep::Sweep;
use crate::engines::{EngineDescriptor, EngineKind, engine};
use crate::plan::{Point, Sampling, Stop};
use coinmc_core::{
    Coin, CoinError, Drag, IntervalMethod, Landing, LaunchDistribution, Preset, Scene, Surface,
};
use std::collections::HashSet;
use std::sync::Arc;

/// Why something cannot be built.
#[derive(Debug)]
pub(super) enum Fault {
    /// A part is invalid, and that has been said.
    Reported,
    /// Parts that are right by themselves do not fit.
    Problem {
        span: Span,
        message: String,
        help: Option<String>,
    },
}

impl Fault {
    pub(super) fn problem(span: Span, message: String, help: Option<&str>) -> Self {
        Self::Problem {
            span,
            message,
            help: help.map(str::to_owned),
        }
    }
}

/// One point of a sweep: which value each axis has.
pub(super) struct At<'a> {
    sweep: Option<&'a Sweep>,
    indices: Vec<usize>,
}

impl At<'_> {
    /// The only point of a config that sweeps nothing.
    #[cfg(test)]
    pub(super) fn single() -> Self {
        Self {
            sweep: None,
            indices: vec![],
        }
    }

    pub(super) fn number(&self, form: &Form) -> Result<f64, Fault> {
        match (&form.what, self.sweep) {
            (What::Number(_, Some(axis)), Some(sweep)) => {
                Ok(sweep.axes[*axis].values[self.indices[*axis]])
            }
            (What::Number(super::quantity::Quantity::Constant(value), None), _) => Ok(*value),
            _ => Err(Fault::Reported),
        }
    }

    /// The number under a key; `None` if the key is absent and may be.
    pub(super) fn optional(&self, form: &Form, key: &str) -> Result<Option<f64>, Fault> {
        form.get(key).map(|form| self.number(form)).transpose()
    }

    pub(super) fn required(&self, form: &Form, key: &str) -> Result<f64, Fault> {
        self.number(get(form, key)?)
    }
}

/// The value of a key that must be there unless its absence has been reported.
pub(super) fn get<'f>(form: &'f Form, key: &str) -> Result<&'f Form, Fault> {
    form.get(key).ok_or(Fault::Reported)
}

/// Every point of the sweep. Each problem is reported once, at the first point that has it.
pub(super) fn points(root: &Form, sweep: &Sweep, problems: &mut Problems) -> Vec<Point> {
    let mut at = At {
        sweep: Some(sweep),
        indices: vec![],
    };
    let mut points = Vec::new();
    let mut blamed = HashSet::new();
    let sound = problems.is_empty();
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
    /// Whether `last` is what came of an attempt.
    tried: bool,
    last: Option<T>,
}

impl<T: Clone> Part<T> {
    fn new(root: &Form, tables: &[&str]) -> Self {
        let swept = tables
            .iter()
            .filter_map(|table| root.get(table))
            .any(Form::is_swept);
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

/// A column that is always there, and where its value is.
type Always = (&'static str, fn(&Scene) -> f64);

/// What every result names, swept or not: the physics of a toss is not defined without it.
const ALWAYS: [Always; 9] = [
    ("ratio", |scene| scene.coin.ratio()),
    ("radius_m", |scene| scene.coin.radius_m()),
    ("restitution", |scene| scene.surface.restitution()),
    ("friction", |scene| scene.surface.friction()),
    ("rolling_friction_m", |scene| {
        scene.surface.rolling_friction_m()
    }),
    ("pivoting_friction_m", |scene| {
        scene.surface.pivoting_friction_m()
    }),
    ("restitution_threshold_m_s", |scene| {
        scene.surface.restitution_threshold_m_s()
    }),
    ("linear_drag_per_s", |scene| scene.drag().linear_per_s()),
    ("angular_drag_per_s", |scene| scene.drag().angular_per_s()),
];

/// The columns that tell points apart: those that are always there, then every other axis. All
/// points share the names.
struct Columns {
    always: [Arc<str>; ALWAYS.len()],
    /// The other axes: number and name.
    swept: Vec<(usize, Arc<str>)>,
}

impl Columns {
    fn new(sweep: &Sweep) -> Self {
        let is_always = |name: &str| ALWAYS.iter().any(|(there, _)| *there == name);
        let swept = sweep.axes.iter().enumerate();
        Self {
            always: ALWAYS.map(|(name, _)| name.into()),
            swept: swept
                .filter(|(_, axis)| !is_always(&axis.name))
                .map(|(number, axis)| (number, axis.name.as_str().into()))
                .collect(),
        }
    }

    fn parameters(&self, scene: &Scene, sweep: &Sweep, indices: &[usize]) -> Vec<(Arc<str>, f64)> {
        let always = self.always.iter().zip(ALWAYS);
        let swept = self.swept.iter().map(|(number, name)| {
            let value = sweep.axes[*number].values[indices[*number]];
            (Arc::clone(name), value)
        });
        always
            .map(|(name, (_, value))| (Arc::clone(name), value(scene)))
            .chain(swept)
            .collect()
    }
}

fn scene(root: &Form, at: &At<'_>) -> Result<Scene, Fault> {
    let environment = get(root, "environment")?;
    let gravity = get(environment, "gravity_m_s2")?;
    let coin = coin(get(root, "coin")?, at)?;
    let surface = match root.get("surface") {
        Some(form) => surface(form, at)?,
        // only a closed form does without, and it assumes that the first contact decides
        None => sticky(),
    };
    let drag = Drag::new(
        at.required(environment, "linear_drag_per_s")?,
        at.required(environment, "angular_drag_per_s")?,
    )
    .map_err(|error| Fault::problem(environment.span, error.to_string(), None))?;
    let gyroscopic_torque = boolean(environment, "gyroscopic_torque").ok_or(Fault::Reported)?;
    Scene::new(coin, surface, at.number(gravity)?)
        .map(|scene| scene.with_drag(drag))
        .map(|scene| scene.with_gyroscopic_torque(gyroscopic_torque))
        .map_err(|error| Fault::problem(gravity.span, error.to_string(), None))
}

fn sticky() -> Surface {
    Surface::new(0.0, 0.0).map_or_else(
        |_| unreachable!("0 is in range"),
        |s| s.with_landing(Landing::Adhesive),
    )
}

fn coin(form: &Form, at: &At<'_>) -> Result<Coin, Fault> {
    let blame = |error: CoinError| {
        let key = match error {
            CoinError::Ratio(_) => "ratio",
            CoinError::Radius(_) => "radius_m",
            CoinError::Mass(_) => "mass_kg",
            CoinError::AxialMoment { .. } => "axial_moment_kg_m2",
            CoinError::TransverseMoment { .. } => "transverse_moment_kg_m2",
        };
        let place = form
            .get(key)
            // an axial moment alone can rule out the uniform cylinder's transverse one
            .or_else(|| form.get("axial_moment_kg_m2"))
            .unwrap_or(form);
        Fault::problem(place.span, error.to_string(), None)
    };
    let (ratio, radius) = (at.required(form, "ratio")?, at.required(form, "radius_m")?);
    let axial = at.optional(form, "axial_moment_kg_m2")?;
    let transverse = at.optional(form, "transverse_moment_kg_m2")?;
    let mass = at.required(form, "mass_kg")?;
    let coin = Coin::cylinder(ratio, radius)
        .and_then(|coin| coin.with_mass(mass))
        .map_err(blame)?;
    if axial.is_none() && transverse.is_none() {
        return Ok(coin);
    }
    coin.with_moments(axial, transverse).map_err(blame)
}

fn surface(form: &Form, at: &At<'_>) -> Result<Surface, Fault> {
    let landing = match get(form, "landing")?.word() {
        Some("adhesive") => Landing::Adhesive,
        Some(_) => Landing::Bouncing,
        None => return Err(Fault::Reported),
    };
    let (contour, pivoting) = (
        at.required(form, "rolling_friction_m")?,
        at.required(form, "pivoting_friction_m")?,
    );
    let threshold = at.required(form, "restitution_threshold_m_s")?;
    Surface::new(
        at.required(form, "restitution")?,
        at.required(form, "friction")?,
    )
    .and_then(|surface| surface.with_friction_lengths(contour, pivoting))
    .and_then(|surface| surface.with_restitution_threshold(threshold))
    .map(|surface| surface.with_landing(landing))
    .map_err(|error| Fault::problem(form.span, error.to_string(), None))
}

fn launches(root: &Form, at: &At<'_>) -> Result<LaunchDistribution, Fault> {
    let Some(form) = root.get("launch") else {
        // only a closed form does without; no launch is ever drawn
        return Ok(Preset::Robot.distribution());
    };
    let launches = launch::distribution(form, at)?;
    launches
        .validate()
        .map_err(|error| Fault::problem(form.span, error.to_string(), None))?;
    if let Some(engine) = engine_of(root)
        && engine.kind == EngineKind::Planar
    {
        launch::require_planar(form, &launches, engine.name)?;
    }
    Ok(launches)
}

fn engine_of(root: &Form) -> Option<&'static EngineDescriptor> {
    engine(root.get("engine")?.tag()?)
}

/// When to stop; a closed form has nothing to stop.
pub(super) fn stop(root: &Form) -> Option<Stop> {
    if engine_of(root)?.kind == EngineKind::ClosedForm {
        return Some(Stop::Tosses(0));
    }
    let form = root.get("stop")?;
    if let Some(tosses) = integer(form, "tosses") {
        return Some(Stop::Tosses(tosses));
    }
    let half_width = real(form, "half_width")?;
    Some(Stop::HalfWidth {
        half_width,
        max_tosses: integer(form, "max_tosses")?,
    })
}

/// How launches are drawn.
pub(super) fn sampling(root: &Form) -> Option<Sampling> {
    let name = root.get("sampling")?.get("method")?.word()?;
    Sampling::ALL.into_iter().find(|known| known.name() == name)
}

/// Confidence and method of the intervals.
pub(super) fn estimate(root: &Form) -> Option<(f64, IntervalMethod)> {
    let form = root.get("estimate")?;
    let name = form.get("interval")?.word()?;
    let method = [IntervalMethod::Wilson, IntervalMethod::ClopperPearson]
        .into_iter()
        .find(|method| method.name() == name)?;
    Some((real(form, "confidence")?, method))
}

pub(super) fn integer(form: &Form, key: &str) -> Option<u64> {
    match form.get(key)?.what {
        What::Integer(value) => Some(value),
        _ => None,
    }
}

pub(super) fn boolean(form: &Form, key: &str) -> Option<bool> {
    match form.get(key)?.what {
        What::Boolean(value) => Some(value),
        _ => None,
    }
}

fn real(form: &Form, key: &str) -> Option<f64> {
    match form.get(key)?.what {
        What::Real(value) => Some(value),
        _ => None,
    }
}
