//! Keys that several tables share.

use coinmc_core::schema::{Absent, Bounds, Field, Kind, ReadError, Values, default, field};

/// One or several readings.
pub(super) fn readings(name: &'static str, doc: &'static str, bounds: Bounds) -> Field {
    field(name, doc, Kind::Reals(bounds), Absent::Required)
}

/// Readings that may be absent.
pub(super) fn optional(name: &'static str, doc: &'static str, bounds: Bounds) -> Field {
    field(name, doc, Kind::Reals(bounds), Absent::Omitted)
}

/// A standard error with its default.
pub(super) fn error(name: &'static str, doc: &'static str, most: f64, usual: f64) -> Field {
    let bounds = Bounds::above_zero(most);
    field(name, doc, Kind::Real(bounds), default(usual))
}

/// As many readings under this key as under the others, or one for all of them.
pub(super) fn repeated(
    values: &Values,
    key: &'static str,
    wanted: usize,
) -> Result<Vec<f64>, ReadError> {
    let given = values.numbers(key)?;
    match given {
        [one] => Ok(vec![*one; wanted]),
        several if several.len() == wanted => Ok(several.to_vec()),
        several => Err(ReadError::new(format!(
            "`{key}` has {} readings, but {wanted} are expected: as many as under the other keys, or one",
            several.len()
        ))
        .at(key)),
    }
}
