//! Questions: a fair coin to print.

use crate::errors;
use crate::plan::parsed;
use crate::question::{self, Source};
use coinmc_questions::{
    Design, DesignError, DesignFile, Designed, PRINTED_DIAMETER_M, PrintedCoin, design as answer,
    diameter_told, document_of_design,
};
use coinmc_solid::{Edge, Infill};
use pyo3::prelude::*;
use std::num::NonZeroUsize;

/// What is asked, as Python says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AskedDesign {
    source: Source,
    overrides: Vec<String>,
    /// `None`: that of the config, or of prints for an everyday scene.
    diameter_m: Option<f64>,
    target: f64,
    rim_m: Option<f64>,
    chamfer_m: Option<f64>,
    draft_deg: Option<f64>,
    marks: bool,
    density_kg_m3: f64,
    /// Thickness of the walls, and the share of the inside that is full.
    infill: Option<(f64, f64)>,
    half_width: f64,
    threads: Option<NonZeroUsize>,
}

impl AskedDesign {
    /// The question, of a coin of this diameter.
    fn question(&self, diameter_m: f64) -> Design {
        let edge = match (self.rim_m, self.chamfer_m) {
            (Some(radius_m), _) => Edge::Rounded { radius_m },
            (None, Some(size_m)) => Edge::Chamfered { size_m },
            (None, None) => Edge::Sharp,
        };
        Design {
            coin: PrintedCoin {
                diameter_m,
                edge,
                draft_deg: self.draft_deg,
                marks: self.marks,
                density_kg_m3: self.density_kg_m3,
                infill: self.infill.map(|(walls_m, density_fraction)| Infill {
                    walls_m,
                    density_fraction,
                }),
            },
            target: self.target,
            half_width: self.half_width,
        }
    }
}

/// Names, by their endings, and contents of the files of a design.
type Contents = Vec<(&'static str, Vec<u8>)>;

/// Designs a coin; returns the JSON document, and the files.
#[pyfunction]
#[pyo3(signature = (asked, progress=None))]
pub(crate) fn design(
    py: Python<'_>,
    asked: AskedDesign,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, Contents)> {
    let (scene, template) = question::template(&asked.source, &asked.overrides)?;
    let overrides = parsed(&asked.overrides)?;
    let diameter_m = match asked.diameter_m {
        Some(diameter_m) => diameter_m,
        None => diameter_told(&template, scene, &overrides)
            .map_err(|error| errors::question(&error))?
            .unwrap_or(PRINTED_DIAMETER_M),
    };
    let question = asked.question(diameter_m);
    question::answered(py, asked.threads, progress, |workers| {
        let designed = answer(&template, scene, &overrides, &question, workers)?;
        let document = document_of_design(&designed).to_string();
        Ok::<_, DesignError>((document, contents(&designed)))
    })
}

fn contents(designed: &Designed) -> Contents {
    let written = |file: DesignFile| {
        let mut bytes = vec![];
        designed
            .write(file, &mut bytes)
            .expect("a vector takes all bytes");
        (file.ending(), bytes)
    };
    DesignFile::ALL.map(written).into()
}
