//! The recorded motion of one toss.

use crate::errors;
use crate::launch::{ROW, Start, check, launch, write_state};
use crate::plan::Plan;
use crate::supervise::wait_for;
use coinmc_core::EventKind;
use coinmc_recording::{Compression, Encoding, Error as RecordingError, NewFile};
use coinmc_trace::{
    FileKind, MAX_RECORDS, Record, RecordKind, Trace, default_rate_hz, launch as launch_of,
    outcome_name, record, replay,
};
use numpy::{IntoPyArray, PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// Replays a toss of a point, or tosses a launch given as a row, and records it with `rate_hz`
/// samples per second; None chooses a rate that suits the toss.
#[pyfunction]
#[pyo3(signature = (plan, point, toss, row=None, rate_hz=None))]
pub(crate) fn trace<'py>(
    py: Python<'py>,
    plan: &Plan,
    point: usize,
    toss: u64,
    row: Option<PyReadonlyArray1<'py, f64>>,
    rate_hz: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let row = row.as_ref().map(PyReadonlyArray1::as_slice).transpose()?;
    let trace = recorded(py, plan, (point, toss), row, rate_hz)?;
    as_dict(py, &trace)
}

/// Records a toss like [`trace`], into a new file whose extension says the format.
#[pyfunction]
#[pyo3(signature = (plan, point, toss, row, rate_hz, path, encoding))]
#[allow(clippy::too_many_arguments, reason = "Python gives them one by one")]
pub(crate) fn save_trace(
    py: Python<'_>,
    plan: &Plan,
    point: usize,
    toss: u64,
    row: Option<PyReadonlyArray1<'_, f64>>,
    rate_hz: Option<f64>,
    path: PathBuf,
    encoding: &str,
) -> PyResult<()> {
    let row = row.as_ref().map(PyReadonlyArray1::as_slice).transpose()?;
    let kind = FileKind::of(&path).map_err(errors::value)?;
    let encoding: Encoding = encoding.parse().map_err(errors::value)?;
    let trace = recorded(py, plan, (point, toss), row, rate_hz)?;
    let write = || -> Result<(), RecordingError> {
        let mut file = NewFile::begin(&path)?;
        kind.write(
            &plan.0,
            &[trace],
            encoding,
            Compression::default(),
            &mut file,
        )
        .map_err(|error| error.with_path(&path))?;
        file.finish()
    };
    py.detach(write).map_err(|error| errors::file(&error))
}

fn recorded(
    py: Python<'_>,
    plan: &Plan,
    (point, toss): (usize, u64),
    row: Option<&[f64]>,
    rate_hz: Option<f64>,
) -> PyResult<Trace> {
    let scene = plan.tossed_point(point)?.scene;
    if let Some(row) = row {
        if row.len() != ROW {
            return Err(errors::value("a launch is a row of twelve numbers"));
        }
        check(plan.point(point)?, row)
            .map_err(|fault| errors::value(format!("launch: {fault}")))?;
    }
    let (plan, own) = (Arc::clone(&plan.0), row.map(launch));
    let trace = wait_for(py, move || {
        let launch = match own {
            Some(launch) => launch,
            None => launch_of(&plan, point, toss)?,
        };
        let rate_hz = rate_hz.unwrap_or_else(|| default_rate_hz(&scene, &launch));
        match own {
            Some(launch) => record(&plan, point, &launch, rate_hz, MAX_RECORDS),
            None => replay(&plan, point, toss, rate_hz),
        }
    })?;
    let mut trace = trace.map_err(|error| errors::trace(&error))?;
    if let Some(row) = row {
        let start = Start::of(row);
        for record in &mut trace.records {
            start.apply(&mut record.state);
        }
    }
    Ok(trace)
}

fn as_dict<'py>(py: Python<'py>, trace: &Trace) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("engine", trace.engine)?;
    dict.set_item("rate_hz", trace.rate_hz)?;
    dict.set_item("outcome", outcome_name(&trace.outcome))?;
    dict.set_item("face", trace.outcome.face().map(coinmc_core::Face::name))?;
    dict.set_item("impacts", trace.outcome.impacts)?;
    dict.set_item("contact_steps", trace.outcome.contact_steps)?;
    dict.set_item("jams", trace.outcome.jams)?;
    dict.set_item("overruled", trace.outcome.overruled)?;
    dict.set_item("samples_until_s", trace.samples_until_s)?;
    dict.set_item("events_until_s", trace.events_until_s)?;
    let all: Vec<&Record> = trace.records.iter().collect();
    let samples: Vec<&Record> = all.iter().copied().filter(|r| is_sample(r)).collect();
    let events: Vec<&Record> = all.into_iter().filter(|r| is_event(r)).collect();
    dict.set_item("samples", columns(py, &samples)?)?;
    dict.set_item("events", columns(py, &events)?)?;
    Ok(dict)
}

/// Whether a record belongs to the samples: those at regular times, the launch and the end.
fn is_sample(record: &Record) -> bool {
    matches!(
        record.kind,
        RecordKind::Sample | RecordKind::Event(EventKind::Launched | EventKind::Ended)
    )
}

fn is_event(record: &Record) -> bool {
    matches!(record.kind, RecordKind::Event(_))
}

fn columns<'py>(py: Python<'py>, records: &[&Record]) -> PyResult<Bound<'py, PyDict>> {
    let numbers = |of: fn(&Record) -> f64| -> Bound<'py, PyArray1<f64>> {
        let values: Vec<f64> = records.iter().map(|record| of(record)).collect();
        values.into_pyarray(py)
    };
    let mut states = vec![0.0; records.len() * ROW];
    let mut turns = Vec::with_capacity(records.len() * 4);
    for (record, row) in records.iter().zip(states.chunks_exact_mut(ROW)) {
        write_state(&record.state, row);
        let q = &record.orientation;
        turns.extend([q.w, q.i, q.j, q.k]);
    }
    let names = |of: fn(&Record) -> &'static str| -> Vec<&'static str> {
        records.iter().map(|record| of(record)).collect()
    };
    let dict = PyDict::new(py);
    dict.set_item("time_s", numbers(|record| record.state.time_s))?;
    dict.set_item("energy_j_kg", numbers(|record| record.energy_j_kg))?;
    let rows = states.into_pyarray(py).reshape([records.len(), ROW])?;
    dict.set_item("state", rows)?;
    let rows = turns.into_pyarray(py).reshape([records.len(), 4])?;
    dict.set_item("quaternion", rows)?;
    dict.set_item("kind", names(|record| record.kind.name()))?;
    dict.set_item("mode", names(|record| record.mode.name()))?;
    Ok(dict)
}
