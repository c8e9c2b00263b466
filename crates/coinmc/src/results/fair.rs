//! The ratio at which P(side) hits a target, between the points of a sweep.
//!
//! # Method
//! The points of a sweep that differ in nothing but the ratio make a curve. Between two
//! neighbours, P(side) is interpolated by the polynomial through the two points on either side
//! (at the ends of the sweep through the nearest three). The curve has a band around it,
//!
//! * the arms of the points' own intervals, weighted like the points: added in quadrature, since
//!   their errors are independent, or linearly where the points share random numbers;
//! * and the distance between that polynomial and the straight line between the neighbours: the
//!   error of interpolation by a straight line, and so more than that of the polynomial. It
//!   vanishes at the points. With only two points nothing is known about the curve between them,
//!   and the band has no ends there.
//!
//! The interval of the ratio is the stretch around the crossing on which the target lies within
//! the band. It misses the true ratio only where the band misses the true curve, so it inherits
//! the confidence of the points' intervals. Where the band still holds the target at the end of
//! the sweep the interval is open.
//!
//! Crossings that the band cannot tell apart (noise makes a curve cross to and fro) are one, the
//! middle of them, if their number is odd; if it is even the first and the last are given, with
//! the same interval.

use super::{Results, Row};
use coinmc_core::Face;
use std::cmp::Ordering;

/// Steps in which a band is searched between two points.
const STEPS: u32 = 64;

/// A ratio (or another swept parameter) at which P(side) (or another face's) crosses the target.
#[derive(Debug, Clone, PartialEq)]
pub struct FairRatio {
    /// The other swept parameters.
    pub at: Vec<(String, f64)>,
    /// Name of the engine.
    pub engine: &'static str,
    /// Name of its law.
    pub law: &'static str,
    /// H/R, or the parameter asked for, at which the interpolated curve crosses.
    pub ratio: f64,
    /// Lower end of the interval; `None` if it reaches below the sweep.
    pub lo: Option<f64>,
    /// Upper end of the interval; `None` if it reaches above the sweep.
    pub hi: Option<f64>,
    /// Confidence of the interval, that of the points' intervals.
    pub confidence: f64,
    /// Whether P(side) rises there.
    pub rising: bool,
}

/// The ratios at which P(side) crosses `target`, for every combination of the other swept
/// parameters: none, one or several each. See the module for the method.
///
/// # Example
/// ```no_run
/// # fn example(results: &coinmc::results::Results) {
/// for fair in coinmc::results::fair_ratios(results, 1.0 / 3.0) {
///     println!("{:?}: {} in [{:?}, {:?}]", fair.at, fair.ratio, fair.lo, fair.hi);
/// }
/// # }
/// ```
pub fn fair_ratios(results: &Results, target: f64) -> Vec<FairRatio> {
    fair_values(results, Face::Side, "ratio", target)
}

/// The same for any face along any swept parameter, by the name of its column; none if there is no
/// such parameter.
pub fn fair_values(results: &Results, face: Face, along: &str, target: f64) -> Vec<FairRatio> {
    groups(results, face, along)
        .into_iter()
        .flat_map(|group| {
            let Group {
                at,
                engine,
                law,
                confidence,
                knots,
            } = group;
            let curve = Curve::new(knots, results.paired);
            curve
                .crossings(target)
                .into_iter()
                .map(move |crossing| FairRatio {
                    at: at.clone(),
                    engine,
                    law,
                    ratio: crossing.at,
                    lo: crossing.lo,
                    hi: crossing.hi,
                    confidence,
                    rising: crossing.rising,
                })
        })
        .collect()
}

/// Rows that differ in nothing but one parameter.
struct Group {
    /// The other parameters.
    at: Vec<(String, f64)>,
    engine: &'static str,
    law: &'static str,
    confidence: f64,
    knots: Vec<Knot>,
}

/// The groups, in the order of their first row. No row is kept: there may be a million.
fn groups(results: &Results, face: Face, along: &str) -> Vec<Group> {
    let others: Vec<&String> = results.axes.iter().filter(|name| *name != along).collect();
    let mut order = std::collections::HashMap::new();
    let mut groups: Vec<Group> = Vec::new();
    for row in results.rows.each() {
        let value = |name: &&String| row.parameter(name).unwrap_or(f64::NAN);
        let values: Vec<f64> = others.iter().map(value).collect();
        let bits: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
        let index = *order.entry((row.engine, row.law, bits)).or_insert_with(|| {
            let names = others.iter().map(|name| (*name).clone());
            groups.push(Group {
                at: names.zip(values).collect(),
                engine: row.engine,
                law: row.law,
                confidence: row.side.confidence,
                knots: Vec::new(),
            });
            groups.len() - 1
        });
        groups[index].knots.extend(Knot::of(&row, face, along));
    }
    groups
}

#[derive(Debug, Clone, Copy)]
struct Knot {
    x: f64,
    p: f64,
    /// Arms of the interval below and above p.
    below: f64,
    above: f64,
}

impl Knot {
    /// The knot of a row; `None` where it shows nothing.
    fn of(row: &Row, face: Face, along: &str) -> Option<Self> {
        let (x, seen) = (row.parameter(along)?, row.estimate(face));
        let (below, above) = (seen.p - seen.lo, seen.hi - seen.p);
        let all = [x, seen.p, below, above];
        all.iter().all(|v| v.is_finite()).then_some(Self {
            x,
            p: seen.p,
            below,
            above,
        })
    }
}

/// The probability of a face over a parameter, with its band.
#[derive(Debug)]
struct Curve {
    knots: Vec<Knot>,
    paired: bool,
}

struct Crossing {
    at: f64,
    lo: Option<f64>,
    hi: Option<f64>,
    rising: bool,
}

/// The curve at one place.
struct Value {
    p: f64,
    lo: f64,
    hi: f64,
}

impl Value {
    fn holds(&self, target: f64) -> bool {
        self.lo <= target && target <= self.hi
    }
}

impl Curve {
    fn new(mut knots: Vec<Knot>, paired: bool) -> Self {
        knots.sort_by(|a, b| a.x.total_cmp(&b.x));
        knots.dedup_by(|a, b| a.x == b.x);
        Self { knots, paired }
    }

    fn crossings(&self, target: f64) -> Vec<Crossing> {
        let mut crossings: Vec<Crossing> = Vec::new();
        // those that the band cannot tell from the last one
        let mut together: Vec<Crossing> = Vec::new();
        for (at, rising) in self.roots(target) {
            let last = together.last();
            let within = last.filter(|last| last.hi.is_none_or(|hi| at <= hi));
            // one band holds both: among noise there may be thousands of crossings in it
            let band = within.map(|last| (last.lo, last.hi));
            let (lo, hi) = band.unwrap_or_else(|| {
                crossings.extend(settle(std::mem::take(&mut together)));
                let end = |side| self.end_of_band(at, target, side);
                (end(Ordering::Less), end(Ordering::Greater))
            });
            together.push(Crossing { at, lo, hi, rising });
        }
        crossings.extend(settle(together));
        crossings
    }

    /// Where the interpolated curve itself crosses, and whether it rises there.
    fn roots(&self, target: f64) -> Vec<(f64, bool)> {
        let mut roots = Vec::new();
        // the last point off the target: one that lies on it is neither above nor below
        let mut last: Option<(usize, bool)> = None;
        for (index, knot) in self.knots.iter().enumerate() {
            if knot.p == target {
                continue;
            }
            let above = knot.p > target;
            if let Some((from, was_above)) = last
                && was_above != above
            {
                let root = if index == from + 1 {
                    let is_past = |x| (self.value(from, x).p > target) == above;
                    bisect(self.knots[from].x, knot.x, is_past)
                } else {
                    // the points between lie on the target
                    f64::midpoint(self.knots[from + 1].x, self.knots[index - 1].x)
                };
                roots.push((root, above));
            }
            last = Some((index, above));
        }
        roots
    }

    /// Where the band around a crossing lets go of the target, on one side of it.
    fn end_of_band(&self, at: f64, target: f64, side: Ordering) -> Option<f64> {
        let last = self.knots.len() - 1;
        let mut segment = self
            .knots
            .partition_point(|knot| knot.x <= at)
            .clamp(1, last)
            - 1;
        let mut inside = at;
        loop {
            let (left, right) = (self.knots[segment].x, self.knots[segment + 1].x);
            let end = if side == Ordering::Less { left } else { right };
            let from = inside;
            for step in 1..=STEPS {
                let t = f64::from(step) / f64::from(STEPS);
                let x = if step == STEPS {
                    end
                } else {
                    from + (end - from) * t
                };
                if !self.value(segment, x).holds(target) {
                    return Some(bisect(inside, x, |x| !self.value(segment, x).holds(target)));
                }
                inside = x;
            }
            segment = match side {
                Ordering::Less => segment.checked_sub(1)?,
                _ if segment + 1 < last => segment + 1,
                _ => return None,
            };
        }
    }

    /// The curve and its band at x between points `segment` and `segment + 1`.
    fn value(&self, segment: usize, x: f64) -> Value {
        let (left, right) = (&self.knots[segment], &self.knots[segment + 1]);
        if x == left.x || x == right.x {
            let knot = if x == left.x { left } else { right };
            return Value {
                p: knot.p,
                lo: knot.p - knot.below,
                hi: knot.p + knot.above,
            };
        }
        let from = segment.saturating_sub(1);
        let near = &self.knots[from..self.knots.len().min(segment + 3)];
        let (mut p, mut below, mut above) = (0.0, 0.0, 0.0);
        for (i, knot) in near.iter().enumerate() {
            let weight = lagrange(near, i, x);
            // a negative weight turns the interval round
            let (down, up) = if weight < 0.0 {
                (knot.above, knot.below)
            } else {
                (knot.below, knot.above)
            };
            p += weight * knot.p;
            below = self.add(below, weight.abs() * down);
            above = self.add(above, weight.abs() * up);
        }
        let (below, above) = if self.paired {
            (below, above)
        } else {
            (below.sqrt(), above.sqrt())
        };
        let line = left.p + (right.p - left.p) * (x - left.x) / (right.x - left.x);
        let bend = if near.len() > 2 {
            (p - line).abs()
        } else {
            f64::INFINITY
        };
        Value {
            p,
            lo: p - below - bend,
            hi: p + above + bend,
        }
    }

    fn add(&self, sum: f64, arm: f64) -> f64 {
        if self.paired {
            sum + arm
        } else {
            sum + arm * arm
        }
    }
}

/// The weight of point `i` at x in the polynomial through all of `knots`.
fn lagrange(knots: &[Knot], i: usize, x: f64) -> f64 {
    let others = knots.iter().enumerate().filter(|(j, _)| *j != i);
    others
        .map(|(_, knot)| (x - knot.x) / (knots[i].x - knot.x))
        .product()
}

/// The border between `from`, where `is_past` is false, and `to`, where it is true.
fn bisect(from: f64, to: f64, is_past: impl Fn(f64) -> bool) -> f64 {
    let (mut before, mut past) = (from, to);
    loop {
        let middle = f64::midpoint(before, past);
        if middle == before || middle == past {
            return past;
        }
        if is_past(middle) {
            past = middle;
        } else {
            before = middle;
        }
    }
}

/// What to say about crossings that cannot be told apart.
fn settle(mut together: Vec<Crossing>) -> Vec<Crossing> {
    let Some(last) = together.len().checked_sub(1) else {
        return together;
    };
    let (lo, hi) = (together[0].lo, together[last].hi);
    if together.len() % 2 == 1 {
        together = vec![together.swap_remove(last / 2)];
    } else {
        together = vec![together.remove(0), together.pop().expect("at least two")];
    }
    for crossing in &mut together {
        (crossing.lo, crossing.hi) = (lo, hi);
    }
    together
}
