//! Pages of runs and of tosses.

use crate::errors;
use crate::launch::{check, launch};
use crate::plan::Plan;
use crate::results::Results;
use crate::supervise::{supervise, wait_for};
use coinmc::config;
use coinmc_report::{Map, Quantity, Run, Samples, inner, map, report as page, tosses};
use coinmc_trace::{MAX_RECORDS, default_rate_hz, launch as launch_of, record, replay};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use std::path::PathBuf;

/// The page of runs: each is named, and either a run directory or results in memory.
#[pyfunction]
pub(crate) fn report(
    py: Python<'_>,
    runs: Vec<(String, Option<PathBuf>, Option<Py<Results>>)>,
    title: Option<String>,
    point: Option<usize>,
    of: Vec<u64>,
) -> PyResult<String> {
    let mut found = Vec::with_capacity(runs.len());
    for (name, path, results) in runs {
        found.push(match (path, results) {
            (Some(path), _) => {
                wait_for(py, move || Run::open(&path, &()))?.map_err(|error| errors::run(&error))?
            }
            (None, Some(results)) => in_memory(&name, results.get())?,
            (None, None) => return Err(errors::value("a run is a directory or a result")),
        });
    }
    let samples = Samples { point, tosses: of };
    let made = wait_for(py, move || page(&found, title.as_deref(), &samples))?;
    made.map_err(|error| errors::trace(&error))
}

fn in_memory(name: &str, results: &Results) -> PyResult<Run> {
    let report = results.report();
    let plan = config::parse(name, &report.results.config, &[]);
    let plan = plan.map_err(|problems| errors::value(problems.to_string()))?;
    Ok(Run::in_memory(name, plan, report))
}

/// A toss: its plan and point, and its number or its launch as a row.
type Asked<'py> = (
    PyRef<'py, Plan>,
    usize,
    u64,
    Option<PyReadonlyArray1<'py, f64>>,
);

/// The page of tosses in three dimensions.
#[pyfunction]
pub(crate) fn toss_page(py: Python<'_>, asked: Vec<Asked<'_>>) -> PyResult<String> {
    let mut plans = Vec::with_capacity(asked.len());
    let mut traces = Vec::with_capacity(asked.len());
    for (plan, point, toss, row) in asked {
        let scene = plan.tossed_point(point)?.scene;
        let row = row.as_ref().map(PyReadonlyArray1::as_slice).transpose()?;
        if let Some(row) = row {
            check(plan.point(point)?, row).map_err(errors::value)?;
        }
        let (shared, own) = (std::sync::Arc::clone(&plan.0), row.map(launch));
        plans.push(std::sync::Arc::clone(&shared));
        let trace = wait_for(py, move || {
            if let Some(launch) = own {
                let rate = default_rate_hz(&scene, &launch);
                record(&shared, point, &launch, rate, MAX_RECORDS)
            } else {
                let rate = default_rate_hz(&scene, &launch_of(&shared, point, toss)?);
                replay(&shared, point, toss, rate)
            }
        })?;
        traces.push(trace.map_err(|error| errors::trace(&error))?);
    }
    let pairs: Vec<_> = plans.iter().map(AsRef::as_ref).zip(&traces).collect();
    Ok(tosses(&pairs))
}

/// A side of a map: quantity, first and last value, pixels.
type Side = (String, f64, f64, usize);

/// The page of a map of basins around a toss.
#[pyfunction]
pub(crate) fn map_page(
    py: Python<'_>,
    plan: &Plan,
    point: usize,
    toss: u64,
    sides: [Side; 2],
) -> PyResult<String> {
    let [x, y] = sides.map(|(name, from, to, pixels)| {
        let quantity = name
            .parse::<Quantity>()
            .map_err(|error| errors::value(error.to_string()));
        quantity.map(|quantity| (quantity, from, to, pixels))
    });
    let (sides, shared) = ([x?, y?], std::sync::Arc::clone(&plan.0));
    let (made, _) = supervise(py, None, |supervision| {
        Map::toss(&shared, point, toss, sides, |_| supervision.may_continue())
    })?;
    let made = made.map_err(|error| errors::value(error.to_string()))?;
    made.map(|made| map(&shared, &made))
        .ok_or_else(|| errors::value("the map was stopped"))
}

/// A page in a frame, for notebooks.
#[pyfunction]
pub(crate) fn frame(page: &str, height_px: u32) -> String {
    inner(page, height_px)
}
