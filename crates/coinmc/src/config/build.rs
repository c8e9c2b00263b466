//! From the checked config to the points of a plan.

use super::diagnostics::Problems;
use super::form::{Form, What};
use super::launch;
use super::source::Span;
use super::sweep::Sweep;
use crate::plan::{EngineChoice, Point, Stop};
use coinmc_core::{
    Coin, CoinError, IntervalMethod, Landing, LaunchDistribution, Preset, Scene, Surface,
};
use coinmc_flat::{Decision, Law, Settings};
use std::collections::HashSet;

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
    fn optional(&self, form: &Form, key: &str) -> Result<Option<f64>, Fault> {
        form.get(key).map(|form| self.number(form)).transpose()
    }

    fn required(&self, form: &Form, key: &str) -> Result<f64, Fault> {
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
    let mut engines = Part::new(root, &["engine"]);
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
        let engine = engines.at(|| engine(root, &at), &mut report);
        if let (true, Some(scene), Some(launches), Some(engine)) = (sound, scene, launches, engine)
        {
            let parameters = parameters(&scene, sweep, &at.indices);
            points.push(Point {
                parameters,
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

impl<T: Copy> Part<T> {
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
        self.last
    }
}

/// The columns that tell points apart: four that are always there, then every other axis.
fn parameters(scene: &Scene, sweep: &Sweep, indices: &[usize]) -> Vec<(String, f64)> {
    let always = [
        ("ratio", scene.coin.ratio()),
        ("radius_m", scene.coin.radius_m()),
        ("restitution", scene.surface.restitution()),
        ("friction", scene.surface.friction()),
    ];
    let swept = sweep
        .axes
        .iter()
        .zip(indices)
        .filter(|(axis, _)| !always.iter().any(|(name, _)| *name == axis.name))
        .map(|(axis, index)| (axis.name.clone(), axis.values[*index]));
    always
        .iter()
        .map(|(name, value)| ((*name).to_owned(), *value))
        .chain(swept)
        .collect()
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
    Scene::new(coin, surface, at.number(gravity)?)
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
    Surface::new(
        at.required(form, "restitution")?,
        at.required(form, "friction")?,
    )
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
    if root.get("engine").and_then(Form::tag) == Some("flat") {
        launch::require_planar(form, &launches)?;
    }
    Ok(launches)
}

fn engine(root: &Form, at: &At<'_>) -> Result<EngineChoice, Fault> {
    let form = get(root, "engine")?;
    let What::Tagged(tag, inner) = &form.what else {
        return Err(Fault::Reported);
    };
    if *tag == "flat" {
        return Ok(EngineChoice::Flat(flat(inner, at)?));
    }
    let rule = get(inner, "rule")?
        .word()
        .and_then(|name| name.parse().ok());
    rule.map(EngineChoice::Analytic).ok_or(Fault::Reported)
}

fn flat(form: &Form, at: &At<'_>) -> Result<Settings, Fault> {
    let law = get(form, "law")?.word();
    let decision = match &get(form, "decision")?.what {
        What::Word(_) => Decision::Certain,
        What::Tagged(_, fraction) => Decision::EnergyFraction(at.number(fraction)?),
        _ => return Err(Fault::Reported),
    };
    let settings = Settings {
        law: Law::ALL
            .into_iter()
            .find(|l| Some(l.name()) == law)
            .ok_or(Fault::Reported)?,
        decision,
        zeno: at.required(form, "zeno")?,
        tolerance: at.required(form, "tolerance")?,
        max_impacts: integer(form, "max_impacts")
            .and_then(|n| n.try_into().ok())
            .unwrap_or(1),
    };
    settings
        .validate()
        .map_err(|error| Fault::problem(form.span, error.to_string(), None))?;
    Ok(settings)
}

/// When to stop; a closed form has nothing to stop.
pub(super) fn stop(root: &Form) -> Option<Stop> {
    if root.get("engine")?.tag()? == "analytic" {
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
