//! How far the coin rolls from a ramp: ρ_c/R = h/d.

use super::readings::{error, optional, readings, together};
use super::scatter::excess;
use super::{Kind, Law, Reduce, Reduced};
use crate::Parameter;
use coinmc_core::Scene;
use coinmc_core::schema::{Bounds, ReadError, TableKind, Values, fields};

/// Heights and distances of rolls.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RollOut {
    rolls: Vec<Roll>,
    height_error_m: f64,
    distance_error: f64,
    /// The unknown slope of the table along the roll, as a number.
    slope_error: f64,
}

/// Height of the ramp and distances there and back, m.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Roll {
    ramp: f64,
    there: f64,
    back: Option<f64>,
}

impl RollOut {
    pub(crate) fn schema() -> TableKind {
        let length = Bounds::above_zero(1000.0);
        fields(vec![
            readings(
                "ramp_height_m",
                "Height by which the coin comes down the ramp.",
                length,
            ),
            readings("distance_m", "How far it then rolls on the level.", length),
            optional(
                "distance_back_m",
                "How far it rolls the opposite way, which cancels a slope of the table.",
                length,
            ),
            error(
                "height_error_m",
                "Standard error of the height.",
                1.0,
                0.0005,
            ),
            error(
                "distance_error",
                "Standard error of a distance, as a share of it: how rolls scatter.",
                1.0,
                0.1,
            ),
            error(
                "level_error_deg",
                "Standard deviation of the slope of the table along the roll.",
                5.0,
                0.05,
            ),
        ])
    }

    pub(crate) fn read(values: &Values) -> Result<Self, ReadError> {
        let both_ways = values.get("distance_back_m").is_some();
        // without ways back any other key stands in for theirs
        let back = if both_ways {
            "distance_back_m"
        } else {
            "distance_m"
        };
        let [ramp, there, back] = together(values, ["ramp_height_m", "distance_m", back])?;
        let rolls = ramp.into_iter().zip(there).zip(back);
        let rolls = rolls.map(|((ramp, there), back)| Roll {
            ramp,
            there,
            back: both_ways.then_some(back),
        });
        Ok(Self {
            rolls: rolls.collect(),
            height_error_m: values.number("height_error_m")?,
            distance_error: values.number("distance_error")?,
            slope_error: libm::tan(values.number("level_error_deg")?.to_radians()),
        })
    }
}

impl Roll {
    /// h/d, the mean of both ways.
    fn slope(&self) -> f64 {
        match self.back {
            Some(back) => 0.5 * self.ramp * (1.0 / self.there + 1.0 / back),
            None => self.ramp / self.there,
        }
    }

    fn ways(&self) -> f64 {
        if self.back.is_some() { 2.0 } else { 1.0 }
    }
}

impl RollOut {
    fn mean_slope(&self) -> f64 {
        self.rolls.iter().map(Roll::slope).sum::<f64>() / self.rolls.len() as f64
    }
}

impl Reduce for RollOut {
    const KIND: Kind = Kind::RollOut;

    /// The mean of h/d over all rolls: the slope and the height's error are the same for all of them, the
    /// scatter is not.
    fn reduce(&self, scene: &Scene) -> Vec<Reduced> {
        let n = self.rolls.len() as f64;
        let heights = self.rolls.iter().map(|roll| roll.ramp);
        let height = self.height_error_m / (heights.sum::<f64>() / n);
        // each way of a roll scatters by itself
        let ways: f64 = self.rolls.iter().map(Roll::ways).sum();
        let one_way = 2.0 * n - ways;
        let scatter = self.excess() * self.distance_error / ways.sqrt();
        vec![Reduced {
            law: Law::Times(Parameter::RollingFriction, 1.0 / scene.coin.radius_m()),
            value: self.mean_slope(),
            absolute: self.slope_error * one_way / n,
            relative: (height * height + scatter * scatter).sqrt(),
        }]
    }

    fn excess(&self) -> f64 {
        let mean = self.mean_slope();
        let square = |roll: &Roll| {
            let off = (roll.slope() / mean - 1.0) / self.distance_error;
            roll.ways() * off * off
        };
        excess(self.rolls.iter().map(square).sum(), self.rolls.len(), 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Surface};

    /// Of rolls that scatter by a tenth the mean of four, both ways, is known to 3.5 %; of rolls that are three times as
    /// long or short, to far less.
    #[test]
    fn rolls_that_exclude_each_other_widen_the_error() {
        let coin = Coin::cylinder(1.0, 0.01).unwrap();
        let scene = Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), 9.81).unwrap();
        let share = |distances: [f64; 4]| {
            let rolls = distances.map(|there| Roll {
                ramp: 0.01,
                there,
                back: Some(there),
            });
            let rolled = RollOut {
                rolls: rolls.to_vec(),
                height_error_m: 1e-9,
                distance_error: 0.1,
                slope_error: 0.0,
            };
            rolled.reduce(&scene)[0].relative
        };
        assert!((share([3.0, 3.2, 2.9, 3.1]) - 0.1 / 8.0_f64.sqrt()).abs() < 1e-6);
        let wide = share([1.0, 3.0, 1.0, 3.0]);
        // h/d is 1 and 1/3, the mean 2/3, each off by half of it: 2 (5²) for each roll, over 3 degrees of freedom
        let expected = 0.1 / 8.0_f64.sqrt() * (4.0 * 2.0 * 25.0 / 3.0_f64).sqrt();
        assert!((wide - expected).abs() < 1e-6, "{wide} {expected}");
    }
}
