//! What could have been measured on a surface with given parameters.

use crate::CalibrationError;
use crate::model::Model;
use crate::tosses::{At, count, launches, point_with};
use coinmc_core::{Domain, Stream, UniformSource, inverse_normal_cdf};
use coinmc_questions::Workers;

impl Model {
    /// Measurements as they could have been on surfaces with these parameters: heads, tails and side of each
    /// of the counts, by real tosses, and then each of the readings, with its error. The same seed gives the same.
    ///
    /// # Errors
    /// [`CalibrationError`] if no surface has such parameters, or tosses fail or are stopped.
    pub fn simulate(
        &self,
        parameters: &[Vec<f64>],
        seed: u64,
        workers: &Workers<'_>,
    ) -> Result<Vec<Vec<f64>>, CalibrationError> {
        let known = self.parameters();
        let mut simulated = vec![vec![]; parameters.len()];
        for counted in &self.observed.counts {
            let tosses: u64 = counted.faces.iter().sum();
            let mut work = vec![];
            for (k, values) in parameters.iter().enumerate() {
                let first = k as u64 * tosses;
                work.push(At {
                    point: point_with(&counted.plan, &known, values)?,
                    tosses: first..first + tosses,
                });
            }
            let faces = count(&work, &launches(seed), workers)?;
            for (row, faces) in simulated.iter_mut().zip(faces) {
                row.extend(faces.map(|count| count as f64));
            }
        }
        let stream = Stream::new(seed, Domain::Parameters, 0);
        for (k, (row, values)) in simulated.iter_mut().zip(parameters).enumerate() {
            let mut uniforms = stream.toss(k as u64);
            for (dimension, reading) in (0..).zip(&self.observed.readings) {
                let predicted = reading.law.at(values[self.place(reading.law.parameter())]);
                let noise = inverse_normal_cdf(uniforms.uniform(dimension));
                row.push(predicted + noise * reading.error_at(predicted));
            }
        }
        Ok(simulated)
    }

    /// What was measured, in the order of [`simulate`](Self::simulate).
    pub fn measured(&self) -> Vec<f64> {
        let counts = self
            .observed
            .counts
            .iter()
            .flat_map(|counted| counted.faces);
        let readings = self.observed.readings.iter().map(|reading| reading.value);
        counts.map(|count| count as f64).chain(readings).collect()
    }

    /// The names of these numbers.
    pub fn measured_names(&self) -> Vec<String> {
        let counts = self.observed.counts.iter().flat_map(|counted| {
            ["heads", "tails", "side"].map(|face| format!("{} {face}", counted.name))
        });
        let readings = self
            .observed
            .readings
            .iter()
            .map(|reading| reading.name.clone());
        counts.chain(readings).collect()
    }
}
