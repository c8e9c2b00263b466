//! Counts as people write them, and numbers as tables show them.

/// Most of anything that may be asked for.
const MOST: f64 = 1e15;

/// A count of at least one: `250000`, `250_000` or `2.5e5`.
///
/// # Errors
/// If the text is not a whole number in range.
pub fn count(text: &str) -> Result<u64, String> {
    match count_or_zero(text) {
        Ok(0) => Err("at least 1 is needed".to_owned()),
        other => other,
    }
}

/// A count that may be zero.
///
/// # Errors
/// If the text is not a whole number in range.
pub fn count_or_zero(text: &str) -> Result<u64, String> {
    let value: f64 = text
        .replace('_', "")
        .parse()
        .map_err(|_| "not a number".to_owned())?;
    if value.fract() == 0.0 && (0.0..=MOST).contains(&value) {
        // whole and far below 2^53
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        Ok(value as u64)
    } else {
        Err(format!("not a whole number from 0 to {MOST:e}"))
    }
}

/// A probability or a difference of two.
pub fn probability(p: f64) -> String {
    format!("{p:.5}")
}

/// A difference, with its sign.
pub fn difference(d: f64) -> String {
    format!("{d:+.5}")
}

/// Something tiny; zero is written as such.
pub fn tiny(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:.1e}")
    }
}

/// The middle of the values; NaN without any.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[n / 2],
        n => f64::midpoint(sorted[n / 2 - 1], sorted[n / 2]),
    }
}

/// Median, lowest and highest of the values.
pub fn spread(values: &[f64]) -> [f64; 3] {
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [median(values), lowest, highest]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_whole_positive_and_bounded() {
        assert_eq!(count("250_000"), Ok(250_000));
        assert_eq!(count("2.5e5"), Ok(250_000));
        assert_eq!(count_or_zero("0"), Ok(0));
        for bad in ["0", "-1", "1.5", "1e16", "nan", "inf", "", "ten"] {
            assert!(count(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn the_median_of_an_even_number_lies_between_the_middle_two() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }
}
