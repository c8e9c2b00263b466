//! Formatting of numbers: round lengths and times with suitable units.

/// The largest of 1, 2 and 5 times a power of ten that is not above `limit`.
pub(super) fn nice_below(limit: f64) -> f64 {
    if !(limit.is_finite() && limit > 0.0) {
        return 1.0;
    }
    let decade = libm::pow(10.0, libm::floor(libm::log10(limit)));
    // rounding may move the power beyond the limit
    [5.0, 2.0, 1.0]
        .into_iter()
        .map(|digit| digit * decade)
        .find(|length| *length <= limit * (1.0 + 1e-12))
        .unwrap_or(decade)
}

/// The smallest of 1, 2 and 5 times a power of ten that is not below `least`.
pub(super) fn stride(least: f64) -> usize {
    let mut decade = 1;
    loop {
        for digit in [1, 2, 5] {
            if (digit * decade) as f64 >= least {
                return digit * decade;
            }
        }
        if decade > usize::MAX / 100 {
            return decade;
        }
        decade *= 10;
    }
}

/// "5 cm"
pub(super) fn length(metres: f64) -> String {
    with_unit(
        metres,
        &[
            (1e3, "km"),
            (1.0, "m"),
            (1e-2, "cm"),
            (1e-3, "mm"),
            (1e-6, "µm"),
        ],
    )
}

/// "20 ms"
pub(super) fn time(seconds: f64) -> String {
    with_unit(seconds, &[(1.0, "s"), (1e-3, "ms"), (1e-6, "µs")])
}

fn with_unit(value: f64, units: &[(f64, &str)]) -> String {
    let fits = |(unit, _): &&(f64, &str)| value.abs() >= 0.999 * unit;
    let unit = units.iter().find(fits).or(units.last());
    match unit {
        Some((unit, name)) => format!("{} {name}", digits(value / unit)),
        None => digits(value),
    }
}

/// At most four significant digits, without trailing zeros.
pub(super) fn digits(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() || size != 0.0 && !(1e-4..1e7).contains(&size) {
        return format!("{value:.2e}");
    }
    let decimals = match size {
        s if s >= 1000.0 => 0,
        s if s >= 100.0 => 1,
        s if s >= 10.0 => 2,
        s if s >= 1.0 => 3,
        s if s >= 0.1 => 4,
        s if s >= 0.01 => 5,
        _ => 6,
    };
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
