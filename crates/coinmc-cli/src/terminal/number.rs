//! Numbers as people read them.

use std::time::Duration;

/// Up to six significant digits, without trailing zeros: 0.30000000000000004 reads 0.3.
pub(crate) fn compact(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if !x.is_finite() {
        return x.to_string();
    }
    // The exponent after rounding to six digits, so that 0.9999999 counts as 1.
    let scientific = format!("{x:.5e}");
    let (mantissa, exponent) = scientific.split_once('e').expect("`e` format writes an e");
    let exponent: i32 = exponent
        .parse()
        .expect("`e` format writes an integer exponent");
    if !(-4..6).contains(&exponent) {
        return format!("{}e{exponent}", trimmed(mantissa));
    }
    let decimals = usize::try_from(5 - exponent).unwrap_or(0);
    trimmed(&format!("{x:.decimals$}")).to_owned()
}

/// Drops zeros at the end of a decimal fraction.
fn trimmed(number: &str) -> &str {
    if number.contains('.') {
        number.trim_end_matches('0').trim_end_matches('.')
    } else {
        number
    }
}

/// With its sign and so many decimals; 0 has no sign.
pub(crate) fn signed(x: f64, decimals: usize) -> String {
    let text = format!("{x:+.decimals$}");
    if text.contains(|c: char| c.is_ascii_digit() && c != '0') || !x.is_finite() {
        text
    } else {
        text[1..].to_owned()
    }
}

/// A whole number in groups of three: 1_234_567 reads `1 234 567`.
pub(crate) fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// `1 point`, `7 points`: a count and its noun.
pub(crate) fn count(n: u64, noun: &str) -> String {
    format!("{} {noun}{}", grouped(n), if n == 1 { "" } else { "s" })
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
    fn compact_keeps_six_digits_and_no_noise() {
        for (x, text) in [
            (0.1 + 0.2, "0.3"),
            (1.0, "1"),
            (0.0, "0"),
            (-0.0, "0"),
            (100.0, "100"),
            (999_999.6, "1e6"),
            (123_456.0, "123456"),
            (1e-4, "0.0001"),
            (1e-5, "1e-5"),
            (2.5e12, "2.5e12"),
            (-1.25, "-1.25"),
            (1.0 / 3.0, "0.333333"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(compact(x), text);
        }
    }

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
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_000), "1 000");
        assert_eq!(grouped(u64::MAX), "18 446 744 073 709 551 615");
        assert_eq!(count(1, "point"), "1 point");
        assert_eq!(count(0, "point"), "0 points");
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
