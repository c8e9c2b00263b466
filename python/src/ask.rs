//! Answers of the atlas over arrays.

use crate::errors;
use crate::supervise::wait_for;
use coinmc_atlas::{Atlas, AtlasError, Launch, Place};
use coinmc_core::Material;
use numpy::{PyArray2, PyReadonlyArray2, ToPyArray, ndarray::Array2};
use pyo3::prelude::*;

/// Which coins and surfaces, as Python says it: each row has the ratio, then a number for each key.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AskedAtlas<'py> {
    launch: String,
    material: String,
    keys: Vec<String>,
    rows: PyReadonlyArray2<'py, f64>,
}

impl AskedAtlas<'_> {
    /// A row of numbers for each coin and surface.
    fn answers<const N: usize>(
        self,
        py: Python<'_>,
        answer: impl Fn(&Atlas, &Place) -> Result<[f64; N], AtlasError> + Send + 'static,
    ) -> PyResult<Bound<'_, PyArray2<f64>>> {
        let launch: Launch = self.launch.parse().map_err(errors::value)?;
        let material: Material = self.material.parse().map_err(errors::value)?;
        let (rows, keys) = (self.rows.as_array().to_owned(), self.keys);
        let found = wait_for(py, move || {
            let atlas = Atlas::of(launch);
            let mut found = Vec::new();
            for row in rows.rows() {
                let given = keys.iter().zip(row.iter().skip(1));
                let numbers: Vec<(String, f64)> =
                    given.map(|(key, value)| (key.clone(), *value)).collect();
                let place = Place::with(&material, row[0], atlas.radius_m(), &numbers)?;
                found.extend(answer(&atlas, &place)?);
            }
            Ok::<_, AtlasError>(
                Array2::from_shape_vec((rows.nrows(), N), found).expect("N numbers a row"),
            )
        })?;
        Ok(found.map_err(errors::value)?.to_pyarray(py))
    }
}

/// P(heads), P(tails) and P(side) of each coin, then their standard errors.
#[pyfunction]
pub(crate) fn ask<'py>(
    py: Python<'py>,
    asked: AskedAtlas<'py>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    asked.answers(py, |atlas, place| {
        let faces = atlas.faces(place)?;
        let [[a, b, c], [d, e, f]] = [faces.p, faces.error];
        Ok([a, b, c, d, e, f])
    })
}

/// The ratio at which the side has a probability on each surface, and its standard error; NaN if there is none.
#[pyfunction]
pub(crate) fn ask_root<'py>(
    py: Python<'py>,
    asked: AskedAtlas<'py>,
    target: f64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    asked.answers(py, move |atlas, place| {
        let root = atlas.root(place, target)?;
        Ok(root.map_or([f64::NAN; 2], |root| [root.ratio, root.error]))
    })
}
