//! The command `coinmc`.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Does what a command line says, and returns the exit status.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| coinmc_cli::main(arguments))
}
