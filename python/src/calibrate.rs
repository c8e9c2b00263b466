//! Calibrations: surfaces from measurements, and their likelihood for any sampler.

use crate::errors;
use crate::plan::parsed;
use crate::question::{Source, working};
use coinmc_calibrate::{
    Calibration, CalibrationError, Model, Observations, Settings, columns, document,
};
use coinmc_questions::Workers;
use numpy::{PyReadonlyArray2, PyReadwriteArray1, PyReadwriteArray2};
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;

/// What is asked, as Python says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AskedCalibration {
    source: Source,
    overrides: Vec<String>,
    /// Folder from which the files of filmed drops are sought.
    folder: String,
    points: u64,
    tosses: u64,
    draws: u64,
    predicted: u64,
    threads: Option<NonZeroUsize>,
}

/// A scene with its measurements; `folder` is where the files of filmed drops are sought.
pub(crate) fn observations(
    (kind, source): &Source,
    overrides: &[String],
    folder: &str,
) -> Result<Observations, CalibrationError> {
    let overrides = parsed(overrides).unwrap_or_default();
    let parse = |name| Observations::parse(name, source, &overrides, Path::new(folder));
    match kind.as_str() {
        "path" => Observations::load(Path::new(source), &overrides),
        "text" => parse("TOML text"),
        _ => parse("config from a dict"),
    }
}

impl AskedCalibration {
    fn settings(&self) -> Settings {
        Settings {
            points: self.points,
            tosses: self.tosses,
            draws: self.draws,
            predicted: self.predicted,
            ..Settings::default()
        }
    }
}

/// The probability of what was measured, as a function of the parameters.
#[pyclass(frozen)]
pub(crate) struct CalibrationModel {
    model: Arc<Model>,
    threads: Option<NonZeroUsize>,
}

/// The document of a calibration, and the names and values of the columns of its draws.
type Calibrated = (String, Vec<(String, Vec<f64>)>, Vec<Vec<f64>>);

#[pymethods]
impl CalibrationModel {
    #[new]
    #[pyo3(signature = (asked, progress=None))]
    fn new(py: Python<'_>, asked: AskedCalibration, progress: Option<Py<PyAny>>) -> PyResult<Self> {
        parsed(&asked.overrides)?;
        let threads = asked.threads;
        let model = calibrating(py, threads, progress, |workers| {
            let observed = observations(&asked.source, &asked.overrides, &asked.folder)?;
            Model::new(observed, asked.settings(), workers)
        })?;
        let model = Arc::new(model);
        Ok(Self { model, threads })
    }

    /// Calibrates: the JSON document, the columns of the draws, and ln of the likelihood of each
    /// measurement for each draw.
    #[pyo3(signature = (progress=None))]
    fn calibrate(&self, py: Python<'_>, progress: Option<Py<PyAny>>) -> PyResult<Calibrated> {
        calibrating(py, self.threads, progress, |workers| {
            let calibration = Calibration::of(&self.model, workers)?;
            let columns = columns(&self.model, &calibration).into_iter();
            let columns = columns.map(|column| (column.name.to_owned(), column.values));
            Ok((
                document(&self.model, &calibration).to_string(),
                columns.collect(),
                calibration.log_likelihoods(&self.model),
            ))
        })
    }

    /// Keys of the parameters.
    #[getter]
    fn parameters(&self) -> Vec<&'static str> {
        let parameters = self.model.parameters().into_iter();
        parameters.map(coinmc_calibrate::Parameter::key).collect()
    }

    /// Ends of the central 95 % of each prior, and its source.
    #[getter]
    fn priors(&self) -> Vec<(f64, f64, String)> {
        let priors = self.model.observed().priors.iter();
        priors
            .map(|prior| (prior.low, prior.high, prior.source.clone()))
            .collect()
    }

    /// What was measured, and the names of these numbers.
    #[getter]
    fn measured(&self) -> (Vec<f64>, Vec<String>) {
        (self.model.measured(), self.model.measured_names())
    }

    /// Writes ln of the posterior (`what` = "prob"), the prior or the likelihood of each row of `theta`.
    fn log(
        &self,
        py: Python<'_>,
        what: &str,
        theta: PyReadonlyArray2<'_, f64>,
        mut out: PyReadwriteArray1<'_, f64>,
    ) -> PyResult<()> {
        let of: fn(&Model, &[f64]) -> f64 = match what {
            "prior" => Model::log_prior,
            "likelihood" => Model::log_likelihood,
            _ => Model::log_prob,
        };
        let (rows, out) = (theta.as_slice()?, out.as_slice_mut()?);
        let width = self.model.parameters().len();
        py.detach(|| {
            for (row, out) in rows.chunks_exact(width).zip(out) {
                *out = of(&self.model, row);
            }
        });
        Ok(())
    }

    /// Writes the parameters of each row of uniform numbers.
    fn of_uniforms(
        &self,
        uniforms: PyReadonlyArray2<'_, f64>,
        mut out: PyReadwriteArray2<'_, f64>,
    ) -> PyResult<()> {
        let (rows, out) = (uniforms.as_slice()?, out.as_slice_mut()?);
        let width = self.model.parameters().len();
        let rows = rows.chunks_exact(width).zip(out.chunks_exact_mut(width));
        for (uniforms, out) in rows {
            out.copy_from_slice(&self.model.of_uniforms(uniforms));
        }
        Ok(())
    }

    /// Synthetic measurements for each row of parameters.
    fn simulate(
        &self,
        py: Python<'_>,
        theta: PyReadonlyArray2<'_, f64>,
        seed: u64,
    ) -> PyResult<Vec<Vec<f64>>> {
        let width = self.model.parameters().len();
        let rows = theta.as_slice()?.chunks_exact(width).map(<[f64]>::to_vec);
        let rows: Vec<_> = rows.collect();
        calibrating(py, self.threads, None, |workers| {
            self.model.simulate(&rows, seed, workers)
        })
    }
}

/// Works on other threads while Python may stop it and is told how far it is.
fn calibrating<T: Send>(
    py: Python<'_>,
    threads: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Workers<'_>) -> Result<T, CalibrationError> + Send,
) -> PyResult<T> {
    working(py, threads, progress, work)?.map_err(raised)
}

/// The exception for what is wrong with a calibration.
pub(crate) fn raised(error: CalibrationError) -> PyErr {
    match error {
        CalibrationError::Config(found) => errors::config(&found),
        CalibrationError::Question(error) => errors::question(&error),
        error => errors::value(error),
    }
}
