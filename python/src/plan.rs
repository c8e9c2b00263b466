//! Configs and their plans.

use crate::errors;
use crate::supervise::wait_for;
use coinmc::config::{self, Override};
use coinmc::plan::{Plan as Planned, Point, Stop, Targets};
use coinmc_core::Face;
use pyo3::exceptions::{PyIndexError, PyTypeError};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A checked config.
#[pyclass(frozen, module = "coinmc._lib")]
pub(crate) struct Plan(pub(crate) Arc<Planned>);

/// The coin and gravity at a point: ratio, radius, height, mass, gravity.
type Scene = (f64, f64, f64, f64, f64);
/// The solid and its weight at a point: radius and distance from the centre of heads and of tails, I_a/m,
/// and the weight per mass in axes of the table.
type Solid = ([(f64, f64); 2], f64, [f64; 3]);

#[pymethods]
impl Plan {
    /// Reads a file.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        let overrides = parsed(&overrides)?;
        let plan = wait_for(py, move || config::load(&path, &overrides))?;
        plan.map(Self::from).map_err(|found| errors::config(&found))
    }

    /// Reads a text; `name` is its name in messages.
    #[staticmethod]
    fn parse(py: Python<'_>, name: String, text: String, overrides: Vec<String>) -> PyResult<Self> {
        let overrides = parsed(&overrides)?;
        let plan = wait_for(py, move || config::parse(&name, &text, &overrides))?;
        plan.map(Self::from).map_err(|found| errors::config(&found))
    }

    #[new]
    fn new() -> PyResult<Self> {
        Err(PyTypeError::new_err("use Plan.load or Plan.parse"))
    }

    #[getter]
    fn hash(&self) -> String {
        self.0.hash()
    }

    #[getter]
    fn resolved(&self) -> &str {
        &self.0.resolved_toml
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.0.seed
    }

    #[getter]
    fn paired(&self) -> bool {
        self.0.paired
    }

    #[getter]
    fn axes(&self) -> Vec<String> {
        self.0.axes.clone()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.0.notes.clone()
    }

    #[getter]
    fn confidence(&self) -> f64 {
        self.0.confidence
    }

    #[getter]
    fn interval(&self) -> &'static str {
        self.0.interval.name()
    }

    /// The half width at which a point stops, if there is one.
    #[getter]
    fn half_width(&self) -> Option<f64> {
        self.targets()?.half_width
    }

    /// The same as a share of the probability.
    #[getter]
    fn relative_error(&self) -> Option<f64> {
        self.targets()?.relative_error
    }

    /// Tosses that must show each face.
    #[getter]
    fn events(&self) -> Option<u64> {
        self.targets()?.events
    }

    /// Limit of the tosses of all points.
    #[getter]
    fn total_tosses(&self) -> Option<u64> {
        self.targets()?.total_tosses
    }

    /// Limit of the computing time of a point.
    #[getter]
    fn max_core_seconds(&self) -> Option<f64> {
        self.targets()?.max_core_seconds
    }

    /// Limit of the computing time of all points.
    #[getter]
    fn total_core_seconds(&self) -> Option<f64> {
        self.targets()?.total_core_seconds
    }

    /// The face that the targets are of.
    #[getter]
    fn face(&self) -> Option<&'static str> {
        self.targets()?.face.map(Face::name)
    }

    /// Largest number of tosses of a point.
    #[getter]
    fn tosses(&self) -> u64 {
        match self.0.stop {
            Stop::Tosses(tosses) => tosses,
            Stop::Targets(targets) => targets.max_tosses,
        }
    }

    #[getter]
    fn tosses_planned(&self) -> u64 {
        self.0.tosses_planned()
    }

    fn __len__(&self) -> usize {
        self.0.points.len()
    }

    /// Name and value of every parameter of a point.
    fn parameters(&self, point: usize) -> PyResult<Vec<(String, f64)>> {
        let parameters = self.point(point)?.parameters.iter();
        Ok(parameters
            .map(|(name, value)| (name.to_string(), *value))
            .collect())
    }

    /// Name of the engine of a point.
    fn engine(&self, point: usize) -> PyResult<&'static str> {
        Ok(self.point(point)?.engine.name())
    }

    /// Whether the engine of a point makes tosses: a closed form makes none.
    fn makes_tosses(&self, point: usize) -> PyResult<bool> {
        Ok(self.point(point)?.engine.makes_tosses())
    }

    /// Ratio, radius, height, mass and gravity of a point, SI.
    fn scene(&self, point: usize) -> PyResult<Scene> {
        let scene = &self.point(point)?.scene;
        let coin = &scene.coin;
        Ok((
            coin.ratio(),
            coin.radius_m(),
            coin.height_m(),
            coin.mass_kg(),
            scene.gravity_m_s2(),
        ))
    }

    /// Radius and distance from the centre of mass of heads and of tails (m), I_a/m (m²), and the weight per
    /// mass in axes of the table (m/s²) at a point.
    fn solid(&self, point: usize) -> PyResult<Solid> {
        let scene = &self.point(point)?.scene;
        let coin = &scene.coin;
        let rims = coin.outer_rims().map(|rim| (rim.radius_m, rim.distance_m));
        let weight = scene.weight_m_s2();
        Ok((
            rims,
            coin.axial_gyration_m2(),
            [weight.x, weight.y, weight.z],
        ))
    }

    /// For each group of points: their number, what is computed, and what is skipped and why.
    fn explain(&self) -> Vec<(usize, String, Vec<String>)> {
        let groups = self.0.explain().into_iter();
        groups
            .map(|group| (group.points, group.computed, group.skipped))
            .collect()
    }
}

impl From<Planned> for Plan {
    fn from(plan: Planned) -> Self {
        Self(Arc::new(plan))
    }
}

impl Plan {
    /// What points are to reach, if they stop at targets.
    fn targets(&self) -> Option<Targets> {
        match self.0.stop {
            Stop::Tosses(_) => None,
            Stop::Targets(targets) => Some(targets),
        }
    }

    /// The point with this index, or an `IndexError`.
    pub(crate) fn point(&self, point: usize) -> PyResult<&Point> {
        let points = self.0.points.len();
        self.0.points.get(point).ok_or_else(|| {
            PyIndexError::new_err(format!(
                "there is no point {point}: this config has {points}, numbered from 0"
            ))
        })
    }

    /// The point with this index, if its engine makes tosses, or an error.
    pub(crate) fn tossed_point(&self, point: usize) -> PyResult<&Point> {
        let found = self.point(point)?;
        if found.engine.makes_tosses() {
            return Ok(found);
        }
        Err(errors::value(format!(
            "point {point} is computed by a closed form, which makes no tosses: use an engine that \
             does, such as engine.flat"
        )))
    }
}

pub(crate) fn parsed(overrides: &[String]) -> PyResult<Vec<Override>> {
    overrides
        .iter()
        .map(|text| text.parse::<Override>())
        .collect::<Result<_, _>>()
        .map_err(errors::overriding)
}
