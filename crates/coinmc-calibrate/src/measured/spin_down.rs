//! How a coin that spins upright on the spot slows down: ω' = −g ρ_p/k_t.

use super::readings::{error, readings, repeated};
use super::{Kind, Law, Reduce, Reduced};
use crate::Parameter;
use coinmc_core::Scene;
use coinmc_core::schema::{Bounds, ReadError, TableKind, Values, fields};

/// Rates of spin before and after some time.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SpinDown {
    /// From, to, rad/s, and the time between, s.
    spins: Vec<[f64; 3]>,
    rate_error_rad_s: f64,
    time_error_s: f64,
}

impl SpinDown {
    pub(crate) fn schema() -> TableKind {
        let rate = Bounds::above_zero(1e4);
        fields(vec![
            readings(
                "from_rad_s",
                "Rate of spin about the vertical at first.",
                rate,
            ),
            readings("to_rad_s", "Rate of spin later.", rate),
            readings("time_s", "Time between the two.", Bounds::above_zero(1e4)),
            error("rate_error_rad_s", "Standard error of a rate.", 1e3, 1.0),
            error("time_error_s", "Standard error of the time.", 100.0, 0.05),
        ])
    }

    pub(crate) fn read(values: &Values) -> Result<Self, ReadError> {
        let times = values.numbers("time_s")?;
        let from = repeated(values, "from_rad_s", times.len())?;
        let to = repeated(values, "to_rad_s", times.len())?;
        let spins = from.into_iter().zip(to).zip(times);
        let spins: Vec<_> = spins.map(|((from, to), time)| [from, to, *time]).collect();
        if spins.iter().any(|[from, to, _]| to >= from) {
            return Err(ReadError::new(
                "a coin that slows down has a lower rate later: `to_rad_s` must be below `from_rad_s`",
            )
            .at("to_rad_s"));
        }
        Ok(Self {
            spins,
            rate_error_rad_s: values.number("rate_error_rad_s")?,
            time_error_s: values.number("time_error_s")?,
        })
    }
}

impl Reduce for SpinDown {
    const KIND: Kind = Kind::SpinDown;

    /// The total loss of spin over the total time.
    fn reduce(&self, scene: &Scene) -> Vec<Reduced> {
        let n = self.spins.len() as f64;
        let time: f64 = self.spins.iter().map(|[.., time]| time).sum();
        let lost: f64 = self.spins.iter().map(|[from, to, _]| from - to).sum();
        vec![Reduced {
            law: Law::Times(
                Parameter::PivotingFriction,
                scene.gravity_m_s2() / scene.coin.transverse_gyration_m2(),
            ),
            value: lost / time,
            absolute: self.rate_error_rad_s * (2.0 * n).sqrt() / time,
            relative: self.time_error_s * n.sqrt() / time,
        }]
    }
}
