//! What the summary says of all points together, from one pass over them: there may be a million.

use super::published::MOST;
use crate::terminal::decimals_for;
use coinmc::results::{Results, Row};
use coinmc_core::Tally;

/// What the summary says of all points together.
pub(super) struct Totals {
    /// All counts.
    pub(super) tally: Tally,
    /// Decimals that show two digits of the narrowest interval's arm.
    pub(super) decimals: usize,
    /// Some table has an edge.
    pub(super) has_edge: bool,
    /// Every point was tossed.
    pub(super) is_tossed: bool,
    /// The first points with published counts.
    pub(super) published: Vec<Row>,
    /// How many there are.
    pub(super) published_points: u64,
    /// Keys in which their scenes differ from the published one.
    pub(super) differs: Vec<&'static str>,
}

impl Totals {
    pub(super) fn of(results: &Results) -> Self {
        let mut totals = Self {
            tally: Tally::default(),
            decimals: 6,
            has_edge: false,
            is_tossed: true,
            published: Vec::new(),
            published_points: 0,
            differs: Vec::new(),
        };
        let mut least = f64::INFINITY;
        for row in results.rows.each() {
            // only forged counts overflow
            let sum = totals.tally.checked_merge(&row.tally);
            totals.tally = sum.unwrap_or(totals.tally);
            let arm = row.half_width();
            if arm > 0.0 {
                least = least.min(arm);
            }
            totals.has_edge |= row.left.is_some();
            totals.is_tossed &= row.side.p.is_finite();
            totals.add_published(&row);
        }
        if least.is_finite() {
            totals.decimals = decimals_for(least);
        }
        totals
    }

    fn add_published(&mut self, row: &Row) {
        let Some(published) = &row.published else {
            return;
        };
        self.published_points += 1;
        if self.published.len() < MOST {
            self.published.push(row.clone());
        }
        for key in &published.differs {
            if !self.differs.contains(key) {
                self.differs.push(key);
            }
        }
    }
}
