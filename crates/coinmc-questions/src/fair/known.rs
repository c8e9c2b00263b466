//! Roots where closed forms or integrals give the probabilities: no tosses, and hardly any noise.

use super::axis::Axis;

/// Values of the scan.
const VALUES: u32 = 61;
/// Step of the difference that gives the slope, in u.
const STEP: f64 = 1e-2;
/// Most evaluations of one root.
const MOST: u32 = 60;

/// A probability and its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Probability {
    pub(super) p: f64,
    pub(super) lo: f64,
    pub(super) hi: f64,
}

/// A root of a known curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct KnownRoot {
    pub(super) value: f64,
    pub(super) lo: f64,
    pub(super) hi: f64,
    /// dP/d(parameter).
    pub(super) slope: f64,
}

/// The probabilities over the range, and the roots.
#[derive(Debug, Clone)]
pub(super) struct Known {
    pub(super) scanned: Vec<(f64, Probability)>,
    pub(super) roots: Vec<KnownRoot>,
}

/// Finds all roots that the scan separates.
pub(super) fn solve<E>(
    probability: &mut dyn FnMut(f64) -> Result<Probability, E>,
    axis: Axis,
    target: f64,
) -> Result<Known, E> {
    let [from, to] = axis.ends();
    let mut scanned: Vec<(f64, Probability)> = vec![];
    let mut roots = vec![];
    for i in 0..VALUES {
        let u = from + (to - from) * f64::from(i) / f64::from(VALUES - 1);
        let here = probability(axis.value(u))?;
        if let Some(&(before, at)) = scanned.last()
            && (at.p > target) != (here.p > target)
        {
            let ends = [(before, at.p - target), (u, here.p - target)];
            roots.push(root(probability, axis, target, ends)?);
        }
        scanned.push((u, here));
    }
    Ok(Known { scanned, roots })
}

/// The root between two values, by regula falsi (the Illinois algorithm: Dowell & Jarratt, BIT 11
/// (1971) 168).
fn root<E>(
    probability: &mut dyn FnMut(f64) -> Result<Probability, E>,
    axis: Axis,
    target: f64,
    [mut a, mut b]: [(f64, f64); 2],
) -> Result<KnownRoot, E> {
    let (mut u, mut here) = (a.0, probability(axis.value(a.0))?);
    for _ in 0..MOST {
        u = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
        here = probability(axis.value(u))?;
        let now = (u, here.p - target);
        if now.1.abs() <= 0.01 * (here.hi - here.lo) || (b.0 - a.0).abs() < 1e-14 || now.1 == 0.0 {
            break;
        }
        if (now.1 > 0.0) == (b.1 > 0.0) {
            a.1 *= 0.5;
        } else {
            a = b;
        }
        b = now;
    }
    let (value, below, above) = (axis.value(u), axis.value(u - STEP), axis.value(u + STEP));
    let slope = (probability(above)?.p - probability(below)?.p) / (above - below);
    let arm = (here.hi - here.p).max(here.p - here.lo) / slope.abs();
    Ok(KnownRoot {
        value,
        lo: value - arm,
        hi: value + arm,
        slope,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    #[test]
    fn the_root_of_a_closed_form_is_exact() {
        let mut evaluations = 0;
        let mut zone = |x: f64| {
            evaluations += 1;
            let p = x / (x * x + 4.0).sqrt();
            Ok::<_, Infallible>(Probability { p, lo: p, hi: p })
        };
        let Ok(known) = solve(&mut zone, Axis::new(0.05, 4.0), 1.0 / 3.0);
        let [root] = known.roots[..] else {
            panic!("{:?}", known.roots);
        };
        assert!((root.value - 0.5_f64.sqrt()).abs() < 1e-9, "{}", root.value);
        let slope = 4.0 / libm::pow(4.5, 1.5);
        assert!(
            (root.slope / slope - 1.0).abs() < 1e-4,
            "{} {slope}",
            root.slope
        );
        assert!(evaluations < 80);
    }
}
