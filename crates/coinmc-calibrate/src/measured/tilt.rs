//! The angle at which the coin, lying on a face, goes on sliding: μ = tan θ.

use super::readings::{error, readings};
use super::{Kind, Law, Reduce, Reduced};
use coinmc_core::Scene;
use coinmc_core::schema::{Bounds, ReadError, TableKind, Values, fields};

/// Angles of slides.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tilt {
    angles_deg: Vec<f64>,
    error_deg: f64,
}

impl Tilt {
    pub(crate) fn schema() -> TableKind {
        fields(vec![
            readings(
                "angle_deg",
                "Tilt of the surface at which the coin, lying on a face, goes on sliding.",
                Bounds::open(0.0, 90.0),
            ),
            error(
                "angle_error_deg",
                "Standard error of one reading.",
                45.0,
                1.0,
            ),
        ])
    }

    pub(crate) fn read(values: &Values) -> Result<Self, ReadError> {
        Ok(Self {
            angles_deg: values.numbers("angle_deg")?.to_vec(),
            error_deg: values.number("angle_error_deg")?,
        })
    }
}

impl Reduce for Tilt {
    const KIND: Kind = Kind::Tilt;

    fn reduce(&self, _: &Scene) -> Vec<Reduced> {
        let n = self.angles_deg.len() as f64;
        vec![Reduced {
            law: Law::SlidingAngle,
            value: self.angles_deg.iter().sum::<f64>() / n,
            absolute: self.error_deg / n.sqrt(),
            relative: 0.0,
        }]
    }
}
