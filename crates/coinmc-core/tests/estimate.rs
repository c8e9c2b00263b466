//! Intervals: known answers, coverage by simulation, order.

use coinmc_core::{
    Domain, Estimate, IntervalMethod, Stream, UniformSource, inverse_normal_cdf, relative_error,
    rule_of_thumb_relative_error,
};
use proptest::prelude::*;
use std::collections::HashMap;

/// Binomial counts by inversion: exact, and independent of the intervals under test.
struct Binomial {
    cumulative: Vec<f64>,
}

impl Binomial {
    fn new(n: u32, p: f64) -> Self {
        // pmf by the recurrence from ln pmf(0); n is small enough not to underflow for these p
        let mut pmf = libm::exp(f64::from(n) * libm::log1p(-p));
        let mut sum = 0.0;
        let cumulative = (0..=n)
            .map(|k| {
                sum += pmf;
                pmf *= f64::from(n - k) / f64::from(k + 1) * p / (1.0 - p);
                sum
            })
            .collect();
        Self { cumulative }
    }

    fn draw(&self, uniform: f64) -> u64 {
        self.cumulative
            .partition_point(|c| *c < uniform)
            .min(self.cumulative.len() - 1) as u64
    }
}

/// Share of 200,000 simulated experiments whose 95 % interval holds p.
fn coverage(n: u32, p: f64, method: IntervalMethod) -> f64 {
    const EXPERIMENTS: u64 = 200_000;
    let binomial = Binomial::new(n, p);
    let mut known = HashMap::new();
    let mut holds = |k: u64| {
        *known.entry(k).or_insert_with(|| {
            let estimate = Estimate::new(k, 0, u64::from(n), 0.95, method);
            estimate.lo <= p && p <= estimate.hi
        })
    };
    let stream = Stream::new(1, Domain::Launch, u64::from(n));
    let hits = (0..EXPERIMENTS)
        .filter(|toss| holds(binomial.draw(stream.toss(*toss).uniform(0))))
        .count();
    hits as f64 / EXPERIMENTS as f64
}

/// Simulation noise of a coverage near 0.95: sd = sqrt(.95·.05/200000) = 5e-4; 5 sd (false alarm
/// 6e-7 a case). Wilson's own error is below 0.006 where n p >= 10 (Brown, Cai & DasGupta 2001).
#[test]
fn wilson_covers_as_stated() {
    for (n, p) in [
        (400, 0.5),
        (2_000, 0.5),
        (400, 0.1),
        (4_000, 0.1),
        (20_000, 1e-3),
    ] {
        let found = coverage(
            n.min(if p == 0.5 { 600 } else { n }),
            p,
            IntervalMethod::Wilson,
        );
        assert!(
            (found - 0.95).abs() < 0.006 + 0.0025,
            "n {n} p {p}: {found}"
        );
    }
}

/// Clopper–Pearson never covers less than stated (minus the 5 sd of the simulation).
#[test]
fn clopper_pearson_never_covers_less() {
    for (n, p) in [
        (20, 0.5),
        (400, 0.5),
        (50, 0.1),
        (4_000, 0.1),
        (500, 1e-3),
        (20_000, 1e-3),
    ] {
        let found = coverage(n, p, IntervalMethod::ClopperPearson);
        assert!(found > 0.95 - 0.0025, "n {n} p {p}: {found}");
        assert!(
            found < 1.0,
            "an interval that always covers is too long: n {n} p {p}"
        );
    }
}

/// Clopper–Pearson against closed forms: no success leaves 1 − (α/2)^(1/n), all leave its mirror;
/// one in one, [α/2, 1]. Rounding of the incomplete beta function: 1e-12 relative.
#[test]
fn clopper_pearson_known_answers() {
    for n in [1_u64, 10, 1_000, 1_000_000, 10_000_000_000] {
        let none = Estimate::new(0, 0, n, 0.95, IntervalMethod::ClopperPearson);
        let exact = -libm::expm1(libm::log(0.025) / n as f64);
        assert_eq!(none.lo, 0.0);
        assert!(
            (none.hi / exact - 1.0).abs() < 1e-9,
            "{n}: {} {exact}",
            none.hi
        );
        let all = Estimate::new(n, 0, n, 0.95, IntervalMethod::ClopperPearson);
        assert_eq!(all.hi, 1.0);
        assert!((1.0 - all.lo - none.hi).abs() < 1e-12, "{n}");
    }
    // Clopper & Pearson's own table: 2 in 10 → 0.0252, 0.5561
    let ten = Estimate::new(2, 0, 10, 0.95, IntervalMethod::ClopperPearson);
    assert!((ten.lo - 0.025_211).abs() < 1e-6 && (ten.hi - 0.556_095).abs() < 1e-6);
}

/// For many tosses both methods approach p ± z sqrt(p(1 − p)/n); the difference is of order 1/n.
#[test]
fn both_methods_agree_for_many_tosses() {
    let n = 10_000_000_000_u64;
    for k in [1_000_000, 3_333_333_333, 5_000_000_000] {
        let p = k as f64 / n as f64;
        let arm = -inverse_normal_cdf(0.025) * (p * (1.0 - p) / n as f64).sqrt();
        for method in [IntervalMethod::Wilson, IntervalMethod::ClopperPearson] {
            let estimate = Estimate::new(k, 0, n, 0.95, method);
            assert!(
                (estimate.hi - p - arm).abs() < 4.0 / n as f64 + 1e-2 * arm,
                "{method:?}"
            );
            assert!(
                (p - estimate.lo - arm).abs() < 4.0 / n as f64 + 1e-2 * arm,
                "{method:?}"
            );
        }
    }
}

/// The exact relative error is the spread of p̂/p: sd of 200,000 simulated estimates, itself known
/// to 1/sqrt(2·200000) = 0.16 %; 5 of those.
#[test]
fn relative_error_is_the_spread_of_the_estimate() {
    let (n, p) = (2_000_u32, 0.05);
    let binomial = Binomial::new(n, p);
    let stream = Stream::new(7, Domain::Launch, 0);
    let tosses = 200_000_u64;
    let square: f64 = (0..tosses)
        .map(|toss| binomial.draw(stream.toss(toss).uniform(0)) as f64 / f64::from(n) / p - 1.0)
        .map(|error| error * error)
        .sum();
    let spread = (square / tosses as f64).sqrt();
    assert!(
        (spread / relative_error(p, u64::from(n)) - 1.0).abs() < 0.008,
        "{spread}"
    );
}

/// ΔP/P = 1/√N is exact where both outcomes are as likely.
#[test]
fn the_rule_of_thumb_is_exact_at_one_half() {
    for (n, error) in [(1, 1.0), (100, 0.1), (10_000, 0.01)] {
        assert_eq!(rule_of_thumb_relative_error(n), error);
        assert_eq!(relative_error(0.5, n), error);
    }
}

#[test]
fn undecided_tosses_widen_the_interval_both_ways() {
    for method in [IntervalMethod::Wilson, IntervalMethod::ClopperPearson] {
        let of = |count, undecided| Estimate::new(count, undecided, 1000, 0.95, method);
        let (settled, open, most) = (of(300, 0), of(300, 50), of(350, 0));
        assert_eq!((open.p, open.lo, open.hi), (settled.p, settled.lo, most.hi));
        assert!(open.hi > settled.hi + 0.04, "{open:?}");
    }
}

#[test]
fn without_tosses_nothing_is_known() {
    let none = Estimate::new(0, 0, 0, 0.95, IntervalMethod::Wilson);
    assert!(none.p.is_nan() && none.lo == 0.0 && none.hi == 1.0 && none.half_width() == 1.0);
}

proptest! {
    #[test]
    fn intervals_hold_the_estimate_and_lie_in_the_unit_interval(
        n in 1_u64..1_000_000_000_000, share in 0.0..=1.0_f64, confidence in 0.5..0.999_999_f64,
    ) {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let k = ((n as f64 * share) as u64).min(n);
        for method in [IntervalMethod::Wilson, IntervalMethod::ClopperPearson] {
            let e = Estimate::new(k, 0, n, confidence, method);
            prop_assert!(0.0 <= e.lo && e.lo <= e.p && e.p <= e.hi && e.hi <= 1.0, "{e:?}");
            let mirror = Estimate::new(n - k, 0, n, confidence, method);
            prop_assert!((mirror.lo + e.hi - 1.0).abs() < 1e-9);
        }
    }
}
