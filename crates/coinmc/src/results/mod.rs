//! The results of a run: one row per point, the same table as CSV, Parquet and JSON.

mod csv;
mod estimates;
mod fair;
mod json;
#[cfg(feature = "parquet")]
mod parquet;
mod schema;
#[cfg(feature = "parquet")]
mod tables;

pub use coinmc_table::{Cell, Field, Kind};
pub use csv::{write_csv, write_csv_row};
pub(crate) use estimates::integrated;
pub use fair::{FairRatio, fair_ratios, fair_values};
#[cfg(feature = "parquet")]
pub use parquet::write_parquet;
pub use schema::{Column, FORMAT, columns, columns_of, metadata};
#[cfg(feature = "parquet")]
pub(crate) use tables::{Table, write_tables};

use crate::OnDemand;
use crate::plan::{Looks, Plan, StoppedBy};
use crate::published::Published;
use coinmc_core::{Estimate, Face, Tally};
use coinmc_quadrature::Integral;
use std::sync::Arc;

/// All points of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Results {
    /// Hash of the plan.
    pub plan_hash: String,
    /// Version of the program that computed them.
    pub program_version: String,
    /// The resolved config, TOML.
    pub config: String,
    /// Names of the swept parameters; the first varies slowest.
    pub axes: Vec<String>,
    /// Whether all points shared their random numbers: their errors are then correlated.
    pub paired: bool,
    /// The points, in order. Those of a large sweep are made when they are asked for.
    pub rows: OnDemand<Row>,
}

/// One point.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Index of the point.
    pub point: usize,
    /// Its parameters.
    pub parameters: Vec<(Arc<str>, f64)>,
    /// Name of the engine.
    pub engine: &'static str,
    /// Name of the law of impact, or of the closed form.
    pub law: &'static str,
    /// Whether the gyroscopic torque acts.
    pub gyroscopic_torque: bool,
    /// The counts.
    pub tally: Tally,
    /// Probability of heads.
    pub heads: Estimate,
    /// Probability of tails.
    pub tails: Estimate,
    /// Probability of the side.
    pub side: Estimate,
    /// Probability of the face that was up at the launch; `None` where tosses do not tell it.
    pub same: Option<Estimate>,
    /// Probability that the coin leaves the table; `None` where the table has no edge.
    pub left: Option<Estimate>,
    /// How the intervals were computed: `wilson`, `clopper-pearson`, `sequential-clopper-pearson`
    /// where the point stopped at targets, `student-t` of an integral, `exact` for a closed
    /// form.
    pub interval: &'static str,
    /// How the launches were drawn: `random`, `quasi-random`, or `closed-form` where there was
    /// nothing to draw.
    pub sampling: &'static str,
    /// Evaluations of a point that was integrated, else 0.
    pub evaluations: u64,
    /// The rule that ended the point.
    pub stopped_by: StoppedBy,
    /// Tosses of the pilot, which only say how many were to follow and are not counted.
    pub pilot_tosses: u64,
    /// Published counts for the same launch and ratio; not a column of the table.
    pub published: Option<Published>,
}

impl Results {
    /// The results of a plan.
    pub fn new(plan: &Plan, rows: OnDemand<Row>) -> Self {
        Self {
            plan_hash: plan.hash(),
            program_version: env!("CARGO_PKG_VERSION").to_owned(),
            config: plan.resolved_toml.clone(),
            axes: plan.axes.clone(),
            paired: plan.paired,
            rows,
        }
    }
}

impl Row {
    /// The row of point `index`, given all its tosses, whose number nothing seen has decided.
    ///
    /// # Panics
    /// If the plan has no such point.
    pub fn new(plan: &Plan, index: usize, tally: Tally, stopped_by: StoppedBy) -> Self {
        Self::with_confidence(plan, index, tally, stopped_by, plan.confidence)
    }

    /// The row of point `index`, given the tosses that count at the end of the present stage of its looks.
    ///
    /// # Panics
    /// If the plan has no such point.
    pub fn at_look(
        plan: &Plan,
        index: usize,
        tally: Tally,
        stopped_by: StoppedBy,
        looks: &Looks,
    ) -> Self {
        Self {
            pilot_tosses: looks.pilot(),
            ..Self::with_confidence(plan, index, tally, stopped_by, looks.confidence())
        }
    }

    pub(crate) fn with_confidence(
        plan: &Plan,
        index: usize,
        tally: Tally,
        stopped_by: StoppedBy,
        at_look: f64,
    ) -> Self {
        let point = &*plan.points.at(index);
        let [heads, tails, side] = estimates::estimates(plan, point, &tally, at_look);
        let tossed = point.engine.makes_tosses();
        let share = |count| estimates::of_count(plan, &tally, count, at_look);
        let has_edge = point.scene.surface.table_radius_m().is_some();
        Self {
            point: index,
            parameters: point.parameters.clone(),
            engine: point.engine.name(),
            law: point.engine.law(),
            gyroscopic_torque: point.scene.has_gyroscopic_torque(),
            tally,
            heads,
            tails,
            side,
            same: tossed.then(|| share(tally.same)),
            left: (tossed && has_edge).then(|| share(tally.left)),
            interval: estimates::interval_name(plan, point),
            sampling: if tossed {
                estimates::RANDOM
            } else {
                estimates::CLOSED_FORM
            },
            evaluations: 0,
            stopped_by,
            pilot_tosses: 0,
            published: Published::of(point),
        }
    }

    /// The row of point `index` that was integrated.
    ///
    /// # Panics
    /// If the plan has no such point.
    pub fn integrated(
        plan: &Plan,
        index: usize,
        integral: &Integral,
        stopped_by: StoppedBy,
    ) -> Self {
        let [heads, tails, side] = estimates::integrated(plan, integral);
        let (interval, sampling) = if integral.exact {
            (estimates::EXACT, estimates::CLOSED_FORM)
        } else {
            (estimates::STUDENT, estimates::QUASI_RANDOM)
        };
        Self {
            heads,
            tails,
            side,
            interval,
            sampling,
            evaluations: integral.evaluations,
            same: None,
            left: None,
            // published counts are compared with counts
            published: None,
            ..Self::new(plan, index, Tally::default(), stopped_by)
        }
    }

    /// The method of intervals of this name, as in [`interval`](Self::interval).
    pub fn interval_named(name: &str) -> Option<&'static str> {
        estimates::INTERVALS
            .into_iter()
            .find(|known| *known == name)
    }

    /// The way of drawing launches of this name, as in [`sampling`](Self::sampling).
    pub fn sampling_named(name: &str) -> Option<&'static str> {
        estimates::SAMPLINGS
            .into_iter()
            .find(|known| *known == name)
    }

    /// The parameter of this name.
    pub fn parameter(&self, name: &str) -> Option<f64> {
        self.parameters
            .iter()
            .find(|(there, _)| **there == *name)
            .map(|(_, value)| *value)
    }

    /// The estimate of a face.
    pub fn estimate(&self, face: Face) -> &Estimate {
        match face {
            Face::Heads => &self.heads,
            Face::Tails => &self.tails,
            Face::Side => &self.side,
        }
    }

    /// The widest arm of the three intervals: 0 for a closed form, 1 before the first toss.
    pub fn half_width(&self) -> f64 {
        if self.interval == estimates::EXACT {
            // no tosses, and no length unless some launch has no face
            return Face::ALL
                .iter()
                .map(|&face| self.estimate(face).hi - self.estimate(face).p)
                .fold(0.0, f64::max);
        }
        Face::ALL
            .iter()
            .map(|&face| self.estimate(face).half_width())
            .fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::IntervalMethod;

    #[test]
    fn methods_are_known_by_the_names_that_rows_have() {
        for method in [IntervalMethod::Wilson, IntervalMethod::ClopperPearson] {
            let name = method.name();
            assert_eq!(Row::interval_named(name), Some(name));
        }
        for name in ["sequential-clopper-pearson", "student-t", "exact"] {
            assert_eq!(Row::interval_named(name), Some(name));
            assert_eq!(Row::sampling_named(name), None);
        }
        for name in ["random", "quasi-random", "closed-form"] {
            assert_eq!(Row::sampling_named(name), Some(name));
            assert_eq!(Row::interval_named(name), None);
        }
    }
}
