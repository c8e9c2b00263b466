//! How far the coin rolls from a ramp: ρ_c/R = h/d.

use super::readings::{error, optional, readings, repeated};
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
        let distances = values.numbers("distance_m")?;
        let heights = repeated(values, "ramp_height_m", distances.len())?;
        let back = match values.get("distance_back_m") {
            Some(_) => repeated(values, "distance_back_m", distances.len())?
                .into_iter()
                .map(Some)
                .collect(),
            None => vec![None; distances.len()],
        };
        let rolls = heights.into_iter().zip(distances).zip(back);
        let rolls = rolls.map(|((ramp, there), back)| Roll {
            ramp,
            there: *there,
            back,
        });
        Ok(Self {
            rolls: rolls.collect(),
            height_error_m: values.number("height_error_m")?,
            distance_error: values.number("distance_error")?,
            slope_error: libm::tan(values.number("level_error_deg")?.to_radians()),
        })
    }
}

impl Reduce for RollOut {
    const KIND: Kind = Kind::RollOut;

    /// The mean of h/d over all rolls: the slope and the height's error are the same for all of them, the
    /// scatter is not.
    fn reduce(&self, scene: &Scene) -> Vec<Reduced> {
        let n = self.rolls.len() as f64;
        let slopes = self.rolls.iter().map(|roll| match roll.back {
            Some(back) => 0.5 * roll.ramp * (1.0 / roll.there + 1.0 / back),
            None => roll.ramp / roll.there,
        });
        let heights = self.rolls.iter().map(|roll| roll.ramp);
        let height = self.height_error_m / (heights.sum::<f64>() / n);
        let one_way = self.rolls.iter().filter(|roll| roll.back.is_none());
        let one_way = one_way.count() as f64;
        // each way of a roll scatters by itself
        let scatter = self.distance_error / (n + (n - one_way)).sqrt();
        vec![Reduced {
            law: Law::Times(Parameter::RollingFriction, 1.0 / scene.coin.radius_m()),
            value: slopes.sum::<f64>() / n,
            absolute: self.slope_error * one_way / n,
            relative: (height * height + scatter * scatter).sqrt(),
        }]
    }
}
