//! Residuals as a table.

use crate::fit::Fit;
use coinmc_core::csv_cell;
use std::fmt::Write as _;

/// Every residual of every fit as CSV: law, drop, frame (from 0), time, coordinate, observed value,
/// residual (m or rad), and the residual in standard deviations.
pub fn residuals_csv(fits: &[Fit]) -> String {
    let mut text = String::from("law,drop,frame,time_s,coordinate,seen,residual,standardised\n");
    for fit in fits {
        let law = fit.model.law.name();
        for residual in &fit.residuals {
            let name = csv_cell(&fit.drops[residual.drop].name);
            // writing to a string cannot fail
            let _ = writeln!(
                text,
                "{law},{name},{},{},{},{},{:.6e},{:.4}",
                residual.frame,
                residual.time_s,
                residual.coordinate.name(),
                residual.seen,
                residual.residual,
                residual.standardised,
            );
        }
    }
    text
}
