//! Time and angle of a pivoting phase. Only observers need them.

/// The angle after time `t` of a phase that turns from one angle to another in time `took`.
///
/// The inverse of [`duration`]: Newton's method, whose slope is the slowness itself, kept within
/// the bracket by bisection, until the time is met to rounding or the bracket closes.
pub(crate) fn angle_after(
    slowness: &impl Fn(f64) -> f64,
    (from, to): (f64, f64),
    t: f64,
    took: f64,
) -> f64 {
    const MET: f64 = 1e-13;
    let direction = 1.0_f64.copysign(to - from);
    let (mut low, mut high) = (from, to);
    let mut delta = from + (to - from) * (t / took).clamp(0.0, 1.0);
    for _ in 0..100 {
        let late = duration(slowness, from, delta) - t;
        if late.abs() <= MET * (1.0 + took) {
            break;
        }
        *(if late > 0.0 { &mut high } else { &mut low }) = delta;
        let newton = delta - direction * late / slowness(delta);
        let inside = (newton - low) * (high - newton) > 0.0;
        let next = if inside {
            newton
        } else {
            f64::midpoint(low, high)
        };
        if next == delta {
            break;
        }
        delta = next;
    }
    delta
}

/// |∫ slowness dδ| by adaptive Simpson quadrature to 1e-12.
pub(crate) fn duration(slowness: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let (at_start, at_end) = (slowness(from), slowness(to));
    let middle = slowness(f64::midpoint(from, to));
    // the whole is refined, so its own estimate does not count
    refine(slowness, (from, at_start), (to, at_end), middle, 0.0, 30).abs()
}

/// The integral over a panel whose estimate is `whole`, refined until its halves agree with it.
fn refine(
    f: &impl Fn(f64) -> f64,
    (a, fa): (f64, f64),
    (b, fb): (f64, f64),
    middle: f64,
    whole: f64,
    depth: u32,
) -> f64 {
    let m = f64::midpoint(a, b);
    let (left, right) = (f(f64::midpoint(a, m)), f(f64::midpoint(m, b)));
    let h = (b - a) / 12.0;
    let (first, second) = (
        h * (fa + 4.0 * left + middle),
        h * (middle + 4.0 * right + fb),
    );
    let error = first + second - whole;
    // two coarse panels may agree by chance, so at least 16 are used
    if depth == 0 || depth < 27 && error.abs() <= 15e-12 * (1.0 + whole.abs()) {
        return first + second + error / 15.0;
    }
    refine(f, (a, fa), (m, middle), left, first, depth - 1)
        + refine(f, (m, middle), (b, fb), right, second, depth - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// Newton's method takes a few times as long as one duration; bisection would take forty times.
    #[test]
    fn angles_are_found_in_a_few_durations() {
        let calls = Cell::new(0);
        let slowness = |d: f64| {
            calls.set(calls.get() + 1);
            libm::exp(d)
        };
        let took = duration(&slowness, 0.0, 1.0);
        assert!((took - (std::f64::consts::E - 1.0)).abs() < 1e-12);
        let one = calls.replace(0);
        let angle = angle_after(&slowness, (0.0, 1.0), 0.5 * took, took);
        assert!((angle - libm::log(1.0 + 0.5 * took)).abs() < 1e-12);
        assert!(calls.get() < 10 * one, "{} and {one}", calls.get());
    }

    /// A long time is measured relative to itself.
    #[test]
    fn long_durations_take_no_more_panels() {
        let calls = Cell::new(0);
        let slowness = |d: f64| {
            calls.set(calls.get() + 1);
            assert!(calls.get() < 100_000, "refined without end");
            1e6 * (2.0 + libm::sin(d))
        };
        let exact = 1e6 * (2.0 + 1.0 - libm::cos(1.0));
        assert!((duration(&slowness, 0.0, 1.0) / exact - 1.0).abs() < 1e-12);
    }
}
