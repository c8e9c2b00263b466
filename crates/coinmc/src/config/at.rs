//! One point of a sweep, and the errors that can occur there.

use super::checked::{Checked, CheckedValue};
use super::quantity::Quantity;
use super::source::Span;
use super::sweep::Sweep;

/// Why a part of a point cannot be built.
#[derive(Debug)]
pub(super) enum Fault {
    /// A value is invalid, which has been reported.
    Reported,
    /// Values that are individually valid contradict each other.
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

/// One point of a sweep: the value of each axis.
pub(super) struct At<'a> {
    sweep: &'a Sweep,
    pub(super) indices: Vec<usize>,
    /// Whether no problem of the config is known so far.
    pub(super) sound: bool,
}

impl<'a> At<'a> {
    pub(super) fn new(sweep: &'a Sweep, sound: bool) -> Self {
        Self {
            sweep,
            indices: vec![],
            sound,
        }
    }

    pub(super) fn number(&self, checked: &Checked) -> Result<f64, Fault> {
        match &checked.value {
            CheckedValue::Number(_, Some(axis)) => {
                Ok(self.sweep.axes[*axis].values[self.indices[*axis]])
            }
            CheckedValue::Number(Quantity::Constant(value), None) => Ok(*value),
            _ => Err(Fault::Reported),
        }
    }
}

/// The value of a key that must be there unless its absence has been reported.
pub(super) fn get<'f>(checked: &'f Checked, key: &str) -> Result<&'f Checked, Fault> {
    checked.get(key).ok_or(Fault::Reported)
}
