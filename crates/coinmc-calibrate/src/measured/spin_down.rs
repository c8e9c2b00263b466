//! How a coin that spins upright on the spot slows down: ω' = −g ρ_p/k_t.

use super::readings::{error, readings, together};
use super::scatter::excess;
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
        let [from, to, time] = together(values, ["from_rad_s", "to_rad_s", "time_s"])?;
        let spins = from.into_iter().zip(to).zip(time);
        let spins: Vec<_> = spins.map(|((from, to), time)| [from, to, time]).collect();
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

impl SpinDown {
    /// All the time, s, and all the spin that was lost in it, rad/s.
    fn sums(&self) -> [f64; 2] {
        let time = self.spins.iter().map(|[.., time]| time).sum();
        let lost = self.spins.iter().map(|[from, to, _]| from - to).sum();
        [time, lost]
    }
}

impl Reduce for SpinDown {
    const KIND: Kind = Kind::SpinDown;

    /// The total loss of spin over the total time.
    fn reduce(&self, scene: &Scene) -> Vec<Reduced> {
        let n = self.spins.len() as f64;
        let [time, lost] = self.sums();
        let excess = self.excess();
        vec![Reduced {
            law: Law::Times(
                Parameter::PivotingFriction,
                scene.gravity_m_s2() / scene.coin.transverse_gyration_m2(),
            ),
            value: lost / time,
            absolute: excess * self.rate_error_rad_s * (2.0 * n).sqrt() / time,
            relative: excess * self.time_error_s * n.sqrt() / time,
        }]
    }

    fn excess(&self) -> f64 {
        let [time, lost] = self.sums();
        let slowing = lost / time;
        let of_time = slowing * self.time_error_s;
        let variance = 2.0 * self.rate_error_rad_s * self.rate_error_rad_s + of_time * of_time;
        let square = |[from, to, time]: &[f64; 3]| (from - to - slowing * time).powi(2) / variance;
        excess(self.spins.iter().map(square).sum(), self.spins.len(), 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Surface};

    #[test]
    fn spins_that_exclude_each_other_widen_the_error() {
        let coin = Coin::cylinder(1.0, 0.01).unwrap();
        let scene = Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), 9.81).unwrap();
        let error = |to: [f64; 3]| {
            let spun = SpinDown {
                spins: to.map(|to| [40.0, to, 10.0]).to_vec(),
                rate_error_rad_s: 1.0,
                time_error_s: 1e-9,
            };
            spun.reduce(&scene)[0].absolute
        };
        let stated = 6.0_f64.sqrt() / 30.0;
        assert!((error([20.0, 21.0, 19.0]) - stated).abs() < 1e-9);
        // off by 0, 19 and -19, ± sqrt 2, of two degrees of freedom
        let wide = error([20.0, 1.0, 39.0]) / stated;
        assert!(
            (wide - (2.0 * 361.0 / 2.0 / 2.0_f64).sqrt()).abs() < 1e-6,
            "{wide}"
        );
    }
}
