//! The angle at which the coin, lying on a face, goes on sliding: μ = tan θ.

use super::readings::{error, readings};
use super::scatter::excess;
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
        let tilt = Self {
            angles_deg: values.numbers("angle_deg")?.to_vec(),
            error_deg: values.number("angle_error_deg")?,
        };
        let (mean, error) = (tilt.mean_deg(), tilt.mean_error_deg());
        if mean + error >= 90.0 {
            let message = format!(
                "the mean angle of {mean:.4} degrees and its standard error of {error:.2} reach 90 degrees, where no \
                 friction is large enough: its error must be smaller"
            );
            return Err(ReadError::new(message).at("angle_deg"));
        }
        Ok(tilt)
    }
}

impl Tilt {
    /// The standard error of the mean.
    fn mean_error_deg(&self) -> f64 {
        let n = self.angles_deg.len() as f64;
        self.excess() * self.error_deg / n.sqrt()
    }

    fn mean_deg(&self) -> f64 {
        self.angles_deg.iter().sum::<f64>() / self.angles_deg.len() as f64
    }
}

impl Reduce for Tilt {
    const KIND: Kind = Kind::Tilt;

    fn reduce(&self, _: &Scene) -> Vec<Reduced> {
        vec![Reduced {
            law: Law::SlidingAngle,
            value: self.mean_deg(),
            absolute: self.mean_error_deg(),
            relative: 0.0,
        }]
    }

    fn excess(&self) -> f64 {
        let mean = self.mean_deg();
        let off = |angle: &f64| (angle - mean) / self.error_deg;
        let squares = self.angles_deg.iter().map(|angle| off(angle).powi(2)).sum();
        excess(squares, self.angles_deg.len(), 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Surface};

    /// Readings of 10 and 20 degrees, ± 1, scatter by 5.8 times as much as they may.
    #[test]
    fn angles_that_exclude_each_other_widen_the_error() {
        let coin = Coin::cylinder(1.0, 0.01).unwrap();
        let scene = Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), 9.81).unwrap();
        let error = |angles_deg: &[f64]| {
            let angles_deg = angles_deg.to_vec();
            Tilt {
                angles_deg,
                error_deg: 1.0,
            }
            .reduce(&scene)[0]
                .absolute
        };
        assert_eq!(error(&[14.0, 15.0, 16.0, 15.0]), 0.5);
        let wide = error(&[10.0, 20.0, 10.0, 20.0]);
        assert!(
            (wide - 0.5 * (100.0_f64 / 3.0).sqrt()).abs() < 1e-12,
            "{wide}"
        );
    }
}
