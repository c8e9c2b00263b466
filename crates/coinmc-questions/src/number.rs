//! Numbers as people read them.

/// Up to six significant digits, without trailing zeros: 0.30000000000000004 reads 0.3.
///
/// # Example
/// ```
/// assert_eq!(coinmc_questions::number::compact(0.1 + 0.2), "0.3");
/// ```
pub fn compact(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if !x.is_finite() {
        return x.to_string();
    }
    // The exponent after rounding to six digits, so that 0.9999999 counts as 1.
    let scientific = format!("{x:.5e}");
    let parts = scientific.split_once('e');
    let parts =
        parts.and_then(|(mantissa, exponent)| Some((mantissa, exponent.parse::<i32>().ok()?)));
    let Some((mantissa, exponent)) = parts else {
        return scientific;
    };
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

/// Rounded to three digits.
///
/// # Example
/// ```
/// assert_eq!(coinmc_questions::number::three_digits(0.012_345), 0.0123);
/// ```
pub fn three_digits(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

/// Rounded to two digits.
///
/// # Example
/// ```
/// assert_eq!(coinmc_questions::number::two_digits(0.012_345), 0.012);
/// ```
pub fn two_digits(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

/// A whole number in groups of three: 1_234_567 reads `1 234 567`.
///
/// # Example
/// ```
/// assert_eq!(coinmc_questions::number::grouped(1_234_567), "1 234 567");
/// ```
pub fn grouped(n: u64) -> String {
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
    fn digits_are_in_groups_of_three() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_000), "1 000");
        assert_eq!(grouped(u64::MAX), "18 446 744 073 709 551 615");
    }
}
