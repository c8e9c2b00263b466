//! Rows of a sweep as curves along an axis.

use crate::terminal::compact;
use crate::terminal::plot::{Curve, Mark};
use coinmc::results::Results;
use coinmc_core::Face;
use std::collections::HashMap;

/// A curve for each combination of the other axes, in the order in which they first appear.
///
/// In a zipped sweep every point has its own values of the axes; all points then make one curve.
pub(super) fn curves(results: &Results, along: &str, face: Face) -> Vec<Curve> {
    let others = others(results, along);
    let mut places = HashMap::new();
    let mut curves: Vec<Curve> = Vec::new();
    // a point that an interrupted run did not reach is not drawn
    for row in results.rows.each().filter(|row| row.side.p.is_finite()) {
        let Some(x) = row.parameter(along) else {
            continue;
        };
        let found = row.estimate(face);
        let mark = Mark {
            x,
            y: found.p,
            lo: found.lo,
            hi: found.hi,
        };
        let values = others
            .iter()
            .map(|name| row.parameter(name).map(f64::to_bits));
        let place = *places.entry(values.collect::<Vec<_>>()).or_insert_with(|| {
            let value = |name: &&str| Some(((*name).to_owned(), row.parameter(name)?));
            let at: Vec<(String, f64)> = others.iter().filter_map(value).collect();
            curves.push(Curve {
                label: label(&at),
                marks: Vec::new(),
            });
            curves.len() - 1
        });
        curves[place].marks.push(mark);
    }
    if curves.len() > 1 && curves.iter().all(|curve| curve.marks.len() == 1) {
        let marks = curves.into_iter().flat_map(|curve| curve.marks).collect();
        return vec![Curve {
            label: String::new(),
            marks,
        }];
    }
    curves
}

/// The axes that tell curves apart.
pub(super) fn others<'a>(results: &'a Results, along: &str) -> Vec<&'a str> {
    results
        .axes
        .iter()
        .map(String::as_str)
        .filter(|&axis| axis != along)
        .collect()
}

/// `restitution 0.3, friction 0.1`
pub(super) fn label(parameters: &[(String, f64)]) -> String {
    let value = |(name, value): &(String, f64)| format!("{name} {}", compact(*value));
    parameters.iter().map(value).collect::<Vec<_>>().join(", ")
}
