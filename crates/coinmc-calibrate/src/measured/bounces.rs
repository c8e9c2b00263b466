//! When a coin that was dropped flat bounces: each flight takes e times as long as the one before.

use super::readings::{error, readings};
use super::{Kind, Law, Reduce, Reduced};
use coinmc_core::Scene;
use coinmc_core::schema::{
    Absent, Bounds, Kind as KeyKind, ReadError, TableKind, Values, field, fields,
};
use nalgebra::{DMatrix, DVector};

/// Most impacts of one coin: every error shared by two flights is counted.
const MOST_TIMES: usize = 200;

/// Times of impacts.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bounces {
    /// Durations of the flights between impacts, s.
    flights_s: Vec<f64>,
    drop_m: Option<f64>,
    time_error_s: f64,
    scatter: f64,
    height_error_m: f64,
}

/// A flight whose duration is not known: of its logarithm an error has no meaning then.
fn too_short(flights_s: &[f64], time_error_s: f64) -> Option<f64> {
    let error = 2.0_f64.sqrt() * time_error_s;
    flights_s.iter().copied().find(|flight| *flight <= error)
}

impl Bounces {
    pub(crate) fn schema() -> TableKind {
        fields(vec![
            readings(
                "time_s",
                "When the coin, dropped flat, hit the surface: the first impact and those after it.",
                Bounds::closed(-1e4, 1e4),
            ),
            field(
                "drop_height_m",
                "Height of the drop; without it three impacts are needed, with it two.",
                KeyKind::Real(Bounds::above_zero(100.0)),
                Absent::Omitted,
            ),
            error("time_error_s", "Standard error of a time.", 10.0, 0.002),
            error(
                "height_error_m",
                "Standard error of the height.",
                10.0,
                0.002,
            ),
            error(
                "scatter",
                "How e scatters from bounce to bounce, as a share of it: no coin stays flat.",
                1.0,
                0.05,
            ),
        ])
    }

    pub(crate) fn read(values: &Values) -> Result<Self, ReadError> {
        let times = values.numbers("time_s")?;
        if times.len() > MOST_TIMES {
            let message = format!(
                "at most {MOST_TIMES} impacts are allowed, found {}",
                times.len()
            );
            return Err(ReadError::new(message).at("time_s"));
        }
        let flights_s: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if flights_s.iter().any(|flight| *flight <= 0.0) {
            return Err(ReadError::new("the times must rise from impact to impact").at("time_s"));
        }
        let time_error_s = values.number("time_error_s")?;
        if let Some(short) = too_short(&flights_s, time_error_s) {
            let message = format!(
                "a flight of {short:.3} s is no longer than its times are known (± {time_error_s} s each)"
            );
            return Err(ReadError::new(message)
                .with_help("leave out the impacts from there on, or state a smaller `time_error_s`")
                .at("time_s"));
        }
        let drop_m = values.optional("drop_height_m")?;
        let needed = if drop_m.is_some() { 2 } else { 3 };
        if times.len() < needed {
            let message = format!(
                "{needed} impacts are needed, found {}{}",
                times.len(),
                if drop_m.is_some() {
                    ""
                } else {
                    ": or give `drop_height_m`"
                }
            );
            return Err(ReadError::new(message).at("time_s"));
        }
        Ok(Self {
            flights_s,
            drop_m,
            time_error_s,
            scatter: values.number("scatter")?,
            height_error_m: values.number("height_error_m")?,
        })
    }

    /// Covariance of the logarithms of the flights: neighbours share an impact, and what one bounce had
    /// less than e all later flights lack.
    fn covariance(&self, first_bounce: usize) -> DMatrix<f64> {
        let n = self.flights_s.len();
        DMatrix::from_fn(n, n, |i, j| {
            let shared = match i.abs_diff(j) {
                0 => 2.0,
                1 => -1.0,
                _ => 0.0,
            };
            let times = shared * self.time_error_s * self.time_error_s
                / (self.flights_s[i] * self.flights_s[j]);
            let bounces = (i.min(j) + first_bounce) as f64;
            times + bounces * self.scatter * self.scatter
        })
    }
}

impl Reduce for Bounces {
    const KIND: Kind = Kind::Bounces;

    /// ln T_i = ln T_0 + i ln e, by generalised least squares; a drop from the height h gives
    /// T_0 = 2 e sqrt(2h/g).
    fn reduce(&self, scene: &Scene) -> Vec<Reduced> {
        let n = self.flights_s.len();
        let logs = self.flights_s.iter().map(|flight| libm::log(*flight));
        let mut y = DVector::from_iterator(n, logs);
        let design = if let Some(drop) = self.drop_m {
            let start = libm::log(2.0 * (2.0 * drop / scene.gravity_m_s2()).sqrt());
            y.add_scalar_mut(-start);
            DMatrix::from_fn(n, 1, |i, _| (i + 1) as f64)
        } else {
            DMatrix::from_fn(n, 2, |i, j| if j == 0 { i as f64 } else { 1.0 })
        };
        let mut covariance = self.covariance(usize::from(self.drop_m.is_some()));
        if let Some(drop) = self.drop_m {
            let half = 0.5 * self.height_error_m / drop;
            covariance.add_scalar_mut(half * half);
        }
        // the covariance of independent errors is positive definite, and n is at least the unknowns
        let Some(cholesky) = covariance.cholesky() else {
            return vec![];
        };
        let weighed = cholesky.solve(&design);
        let Some(inverse) = (design.transpose() * &weighed).try_inverse() else {
            return vec![];
        };
        let solution = &inverse * weighed.transpose() * y;
        vec![Reduced {
            law: Law::LogRestitution,
            value: solution[0],
            absolute: inverse[(0, 0)].sqrt(),
            relative: 0.0,
        }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Surface};

    fn reduced(times_s: &[f64], drop_m: Option<f64>) -> Reduced {
        let bounces = Bounces {
            flights_s: times_s.windows(2).map(|pair| pair[1] - pair[0]).collect(),
            drop_m,
            time_error_s: 0.002,
            scatter: 0.05,
            height_error_m: 0.002,
        };
        let coin = Coin::cylinder(0.2, 0.0116).unwrap();
        let scene = Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), 9.81).unwrap();
        bounces.reduce(&scene)[0]
    }

    #[test]
    fn flights_shorter_than_the_error_of_their_times_are_not_known() {
        assert_eq!(too_short(&[0.1, 0.002], 0.05), Some(0.002));
        assert_eq!(too_short(&[0.1, 0.0029], 0.002), None);
        assert_eq!(too_short(&[0.1, 0.0028], 0.002), Some(0.0028));
    }

    #[test]
    fn exact_bounces_give_their_restitution() {
        let (e, drop) = (0.6_f64, 0.1_f64);
        let first = 2.0 * e * (2.0 * drop / 9.81).sqrt();
        let times = [0.0, first, first * (1.0 + e), first * (1.0 + e + e * e)];
        let free = reduced(&times, None);
        let dropped = reduced(&times, Some(drop));
        for found in [free, dropped] {
            assert!((found.value - libm::log(e)).abs() < 1e-9, "{found:?}");
        }
        // the height adds a bounce
        assert!(dropped.absolute < free.absolute && dropped.absolute > 0.02);
        // two impacts: the scatter of one bounce, the times and half the share of the height
        let one = reduced(&times[..2], Some(drop));
        let times = 2.0 * (0.002 / first) * (0.002 / first);
        let expected = (times + 0.05 * 0.05 + 0.01 * 0.01_f64).sqrt();
        assert!((one.absolute / expected - 1.0).abs() < 1e-9);
    }
}
