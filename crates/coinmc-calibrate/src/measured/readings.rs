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

/// The readings under each of these keys: as many under each, or one for all.
pub(super) fn together<const N: usize>(
    values: &Values,
    keys: [&'static str; N],
) -> Result<[Vec<f64>; N], ReadError> {
    let mut all = [const { vec![] }; N];
    for (readings, key) in all.iter_mut().zip(keys) {
        *readings = values.numbers(key)?.to_vec();
    }
    let wanted = all.iter().map(Vec::len).max().unwrap_or(0);
    for (readings, key) in all.iter_mut().zip(keys) {
        if let [one] = readings[..] {
            *readings = vec![one; wanted];
        } else if readings.len() < wanted {
            return Err(ReadError::new(format!(
                "`{key}` has {} readings, but another key of this table has {wanted}: give as many here, or one",
                readings.len()
            ))
            .at(key));
        }
    }
    Ok(all)
}
