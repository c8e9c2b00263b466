//! The damping that gives a wanted restitution.
//!
//! Hunt & Crossley, J. Appl. Mech. 42 (1975) 440: N = K δⁿ (1 + c δ'). Along a line, with v = δ'
//! and mass M, M v dv/(1 + c v) = −K δⁿ dδ, so that F(v) = v/c − ln(1 + c v)/c² is the same at the
//! approach v = u and at the rebound v = −e u:
//!
//! (1 + e) d = ln[(1 + d)/(1 − e d)],  d = c u,
//!
//! whatever n, K and M. For e → 1, d = 3(1 − e)/2; for e → 0, e d → 1. This is exact for one corner
//! whose mass along the normal stays the same while it is down: without friction, or while it
//! slides one way. Elsewhere the restitution that results is measured, see
//! docs/methods/impact-laws.md.

/// Below this restitution an impact is not resolved in time: nothing rebounds.
pub(crate) const LEAST_RESTITUTION: f64 = 1e-3;

/// d for a restitution from [`LEAST_RESTITUTION`] to 1.
pub(crate) fn strength(e: f64) -> f64 {
    if e >= 1.0 {
        return 0.0;
    }
    let e = e.max(LEAST_RESTITUTION);
    // with d = w/e, w in (0, 1): negative below the root, positive above
    let excess = |w: f64| {
        let d = w / e;
        libm::log1p(d) - libm::log1p(-w) - (1.0 + e) * d
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        *(if excess(middle) < 0.0 {
            &mut low
        } else {
            &mut high
        }) = middle;
    }
    f64::midpoint(low, high) / e
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matches_the_limits_of_restitution() {
        assert_eq!(strength(1.0), 0.0);
        for e in [0.999, 0.99] {
            // the next term is of relative order 1 − e
            assert!((strength(e) / (1.5 * (1.0 - e)) - 1.0).abs() < 1.5 * (1.0 - e));
        }
        assert!((strength(0.01) * 0.01 - 1.0).abs() < 1e-12);
        let mut last = f64::INFINITY;
        for i in 1..100 {
            let d = strength(f64::from(i) / 100.0);
            assert!(d < last && d > 0.0);
            last = d;
        }
    }

    /// Integrated with 10⁵ steps of order 2: error 1e-6.
    #[test]
    fn a_damped_mass_rebounds_with_the_wanted_restitution() {
        for e in [0.2, 0.5, 0.9] {
            let c = strength(e);
            let force = |depth: f64, v: f64| -crate::laws::palmgren::power(depth) * (1.0 + c * v);
            let (mut depth, mut v, h) = (0.0_f64, 1.0_f64, 1e-4);
            while depth >= 0.0 {
                let (half, fast) = (depth + 0.5 * h * v, v + 0.5 * h * force(depth, v));
                depth += h * fast;
                v += h * force(half, fast);
            }
            assert!((v + e).abs() < 1e-4, "{e}: {v}");
        }
    }
}
