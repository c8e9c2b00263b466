//! Numbers as people read them.

use coinmc_core::Estimate;
use coinmc_questions::number::grouped;
use std::time::Duration;

/// With its sign and so many decimals; 0 has no sign.
pub(crate) fn signed(x: f64, decimals: usize) -> String {
    let text = format!("{x:+.decimals$}");
    if text.contains(|c: char| c.is_ascii_digit() && c != '0') || !x.is_finite() {
        text
    } else {
        text[1..].to_owned()
    }
}

/// `1 point`, `7 points`: a count and its noun.
pub(crate) fn count(n: u64, noun: &str) -> String {
    format!("{} {noun}{}", grouped(n), if n == 1 { "" } else { "s" })
}

/// `1 toss`, `20 000 tosses`.
pub(crate) fn tosses(n: u64) -> String {
    format!("{} toss{}", grouped(n), if n == 1 { "" } else { "es" })
}

/// Decimals that show an error to two digits, three at least and seven at most.
pub(crate) fn decimals_for(error: f64) -> usize {
    if !(error > 0.0 && error < 1.0) {
        return 3;
    }
    let leading = -libm::floor(libm::log10(error));
    // 1 <= leading, since error < 1; far more than seven digits saturate
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let decimals = leading as usize + 1;
    decimals.clamp(3, 7)
}

/// So many decimals, or as many more as an error above 0 needs for a digit other than 0; fifteen at most.
pub(crate) fn decimals_that_show(error: f64, decimals: usize) -> usize {
    const MOST: usize = 15;
    let shows = |decimals: &usize| {
        let text = format!("{error:.decimals$}");
        text.contains(|c: char| c.is_ascii_digit() && c != '0')
    };
    if !(error > 0.0 && error.is_finite()) {
        return decimals;
    }
    (decimals..MOST).find(shows).unwrap_or(MOST)
}

/// As [`decimals_for`] an error, but four at most if these show it.
pub(crate) fn four_decimals_for(error: f64) -> usize {
    decimals_that_show(error, decimals_for(error).min(4))
}

/// `0.250 ± 0.007`, or the interval, `0.000 [0.000, 0.793]`, where that arm would leave 0 to 1; with more decimals where
/// the arm would read 0.
pub(crate) fn with_interval(p: &Estimate, decimals: usize, plus_minus: &str) -> String {
    let arm = p.half_width();
    let decimals = decimals_that_show(arm, decimals);
    if p.p - arm < 0.0 || p.p + arm > 1.0 {
        let Estimate { p, lo, hi, .. } = p;
        return format!("{p:.decimals$} [{lo:.decimals$}, {hi:.decimals$}]");
    }
    format!("{:.decimals$} {plus_minus} {arm:.decimals$}", p.p)
}

/// `850 ms`, `12.3 s`, `4 min 05 s`, `3 h 20 min`, `12 d`.
pub(crate) fn duration(time: Duration) -> String {
    let seconds = time.as_secs();
    if time < Duration::from_secs(1) {
        format!("{} ms", time.as_millis())
    } else if seconds < 60 {
        format!("{:.1} s", time.as_secs_f64())
    } else if seconds < 3600 {
        format!("{} min {:02} s", seconds / 60, seconds % 60)
    } else if seconds < 48 * 3600 {
        format!("{} h {:02} min", seconds / 3600, seconds / 60 % 60)
    } else {
        format!("{} d", grouped(seconds / 86400))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(signed(-0.000_01, 3), "0.000");
        assert_eq!(signed(-0.01, 3), "-0.010");
        assert_eq!(signed(0.0, 1), "0.0");
        assert_eq!(signed(0.25, 2), "+0.25");
        assert_eq!(signed(f64::INFINITY, 2), "+inf");
    }

    #[test]
    fn counts_are_grouped_and_agree_with_their_noun() {
        assert_eq!(count(1, "point"), "1 point");
        assert_eq!(count(0, "point"), "0 points");
        assert_eq!(tosses(1), "1 toss");
        assert_eq!(tosses(20_000), "20 000 tosses");
    }

    #[test]
    fn no_arm_leaves_0_to_1() {
        let of = |count, n| {
            let p = Estimate::new(count, 0, n, 0.95, coinmc_core::IntervalMethod::Wilson);
            with_interval(&p, 3, "±")
        };
        assert_eq!(of(0, 1), "0.000 [0.000, 0.793]");
        assert_eq!(of(1, 1), "1.000 [0.207, 1.000]");
        assert_eq!(of(50, 100), "0.500 ± 0.096");
    }

    #[test]
    fn no_error_reads_zero() {
        assert_eq!(decimals_that_show(0.000_4, 3), 4);
        assert_eq!(decimals_that_show(0.000_6, 3), 3);
        assert_eq!(decimals_that_show(3e-9, 4), 9);
        assert_eq!(decimals_that_show(0.0, 4), 4);
        assert_eq!(decimals_that_show(1e-30, 4), 15);
        let of = |count| {
            let n = 100_000_000;
            let p = Estimate::new(count, 0, n, 0.95, coinmc_core::IntervalMethod::Wilson);
            with_interval(&p, 3, "±")
        };
        assert_eq!(of(1_000_000), "0.01000 ± 0.00002");
        assert_eq!(of(100_000_000), "1.00000000 [0.99999996, 1.00000000]");
    }

    #[test]
    fn two_digits_of_the_error_show() {
        assert_eq!(decimals_for(0.012), 3);
        assert_eq!(decimals_for(0.000_97), 5);
        assert_eq!(decimals_for(1e-12), 7);
        assert_eq!(decimals_for(0.0), 3);
        assert_eq!(decimals_for(f64::NAN), 3);
    }

    #[test]
    fn durations_read_naturally() {
        for (seconds, text) in [
            (0.85, "850 ms"),
            (12.34, "12.3 s"),
            (245.0, "4 min 05 s"),
            (12_000.0, "3 h 20 min"),
            (1e6, "11 d"),
        ] {
            assert_eq!(duration(Duration::from_secs_f64(seconds)), text);
        }
    }
}
