//! Residuals as a table.

use crate::fit::Fit;
use std::fmt::Write as _;

/// Every residual of every fit as CSV: law, drop, frame (from 0), time, coordinate, observed value,
/// residual (m or rad), and the residual in standard deviations.
pub fn residuals_csv(fits: &[Fit]) -> String {
    let mut text = String::from("law,drop,frame,time_s,coordinate,seen,residual,standardised\n");
    for fit in fits {
        let law = fit.model.law.name();
        for residual in &fit.residuals {
            let name = quoted(&fit.drops[residual.drop].name);
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

/// A CSV cell, in quotes if necessary.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}
