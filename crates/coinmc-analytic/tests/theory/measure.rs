//! One-dimensional quadrature, of functions and of conditions.

/// The intervals of `[from, to]` in which `holds`, their ends found by bisection to the last bits.
/// Intervals and gaps narrower than one of the `cells` may be missed.
pub(crate) fn intervals(
    from: f64,
    to: f64,
    cells: usize,
    holds: impl Fn(f64) -> bool,
) -> Vec<(f64, f64)> {
    let node = |i: usize| from + (to - from) * i as f64 / cells as f64;
    let mut found = Vec::new();
    let mut start = holds(from).then_some(from);
    for i in 0..cells {
        let (a, b) = (node(i), node(i + 1));
        match (holds(a), holds(b)) {
            (false, true) => start = Some(bisect(a, b, |t| !holds(t))),
            (true, false) => found.extend(start.take().map(|s| (s, bisect(a, b, &holds)))),
            _ => {}
        }
    }
    found.extend(start.map(|s| (s, to)));
    found
}

/// Where `holds` turns from true (at `a`) to false (at `b`).
fn bisect(mut a: f64, mut b: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        if holds(middle) {
            a = middle;
        } else {
            b = middle;
        }
    }
    0.5 * (a + b)
}

/// `∫f` over `[from, to]` by Simpson's rule; its error is at most `(to −
/// from)⁵·max|f⁗|/(180·panels⁴)`.
pub(crate) fn simpson(from: f64, to: f64, panels: u32, f: impl Fn(f64) -> f64) -> f64 {
    assert!(panels.is_multiple_of(2));
    let step = (to - from) / f64::from(panels);
    let weight = |i| match i {
        0 => 1.0,
        i if i == panels => 1.0,
        i if i % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=panels)
        .map(|i| weight(i) * f(from + step * f64::from(i)))
        .sum::<f64>()
        * step
        / 3.0
}

/// Least value of a function with a single minimum in `[from, to]`, by golden section.
pub(crate) fn minimum(mut from: f64, mut to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    for _ in 0..80 {
        let (a, b) = (to - golden * (to - from), from + golden * (to - from));
        if f(a) < f(b) {
            to = b;
        } else {
            from = a;
        }
    }
    f(0.5 * (from + to))
}
