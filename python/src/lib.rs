//! The Rust part of the Python package `coinmc`: thin, typed functions over arrays that are
//! allocated and owned by Python. They are private: users call the Python part.
//!
//! # Files
//! `plan` configs · `supervise` long work, signals and progress · `share` threads · `launch`
//! launches as rows of numbers · `columns` and `toss` individual tosses · `run` estimates and runs
//! · `session` runs on other machines · `results` and `throws` tables, `arrow` tables for Python · `pickled` results
//! as plain values · `table` any columns as Arrow · `interval` intervals of proportions · `trace` recorded motion of a
//! toss · `question`, `ask`, `fair`, `design`, `aim`, `ranking`, `rare`, `compare` questions · `calibrate` surfaces from
//! measurements · `listen` recordings · `validate` verdicts · `report` pages · `analytic` closed forms · `film` drops on film · `command` the
//! command line · `errors` exceptions.

// Arguments converted from Python are owned.
#![allow(clippy::needless_pass_by_value)]

mod aim;
mod analytic;
mod arrow;
mod ask;
mod calibrate;
mod columns;
mod command;
mod compare;
mod converge;
mod design;
mod errors;
mod fair;
mod film;
mod interval;
mod launch;
mod listen;
mod merge;
mod pickled;
mod plan;
mod question;
mod ranking;
mod rare;
mod report;
mod results;
mod run;
mod session;
mod share;
mod supervise;
mod table;
#[cfg(unix)]
mod throws;
mod toss;
mod trace;
mod validate;

use pyo3::prelude::*;

/// The Rust part of coinmc.
#[pymodule]
mod _lib {
    #[pymodule_export]
    use super::aim::aim;
    #[pymodule_export]
    use super::analytic::{closed_form, no_bounce_rule};
    #[pymodule_export]
    use super::ask::{ask, ask_root};
    #[pymodule_export]
    use super::calibrate::CalibrationModel;
    #[pymodule_export]
    use super::command::main;
    #[pymodule_export]
    use super::compare::compare;
    #[pymodule_export]
    use super::converge::converge;
    #[pymodule_export]
    use super::design::design;
    #[pymodule_export]
    use super::fair::{fair, scenes};
    #[pymodule_export]
    use super::film::{fit_film, read_film};
    #[pymodule_export]
    use super::interval::{inverse_normal_cdf, wilson};
    #[pymodule_export]
    use super::listen::listen;
    #[pymodule_export]
    use super::merge::merge;
    #[pymodule_export]
    use super::pickled::unpickled;
    #[pymodule_export]
    use super::plan::Plan;
    #[pymodule_export]
    use super::ranking::rank;
    #[pymodule_export]
    use super::rare::rare;
    #[pymodule_export]
    use super::report::{frame, map_page, report, toss_page};
    #[pymodule_export]
    use super::results::Results;
    #[pymodule_export]
    use super::run::{estimate, open, run};
    #[pymodule_export]
    use super::session::{Session, chunk, chunk_of_number, chunk_with_note, tally_of};
    #[pymodule_export]
    use super::table::arrow_stream;
    #[cfg(unix)]
    #[pymodule_export]
    use super::throws::Throws;
    #[pymodule_export]
    use super::toss::{launches, toss};
    #[pymodule_export]
    use super::trace::{save_trace, trace};
    #[pymodule_export]
    use super::validate::validate;
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("__build__", coinmc_build::BUILD)
    }
}
