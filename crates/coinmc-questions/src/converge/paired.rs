//! The interval of a difference of paired proportions.

use crate::Interval;

/// How far a share is higher after than before, if of `tosses` tosses so many gained it and so many lost it; with
/// an interval that reaches `z` standard errors of the score test (Tango, Statist. Med. 17 (1998) 891). Unlike that
/// of the normal distribution it holds with few changes, and without any.
pub(super) fn difference(gained: u64, lost: u64, tosses: u64, z: f64) -> Interval {
    let [gained, lost, tosses] = [gained, lost, tosses].map(|count| count as f64);
    Interval {
        value: (gained - lost) / tosses,
        lo: -upper(lost, gained, tosses, z),
        hi: upper(gained, lost, tosses, z),
    }
}

/// The largest difference that the counts do not reject.
fn upper(gained: f64, lost: f64, n: f64, z: f64) -> f64 {
    let (mut low, mut high) = ((gained - lost) / n, 1.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if score(gained, lost, n, middle) >= -z {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// How many standard errors the counts lie above a difference.
fn score(gained: f64, lost: f64, n: f64, difference: f64) -> f64 {
    // the share lost that makes the counts most likely, given the difference
    let a = 2.0 * n;
    let b = (2.0 * n - gained + lost) * difference - gained - lost;
    let c = -lost * difference * (1.0 - difference);
    let share = ((b * b - 4.0 * a * c).max(0.0).sqrt() - b) / (2.0 * a);
    let variance = n * (2.0 * share + difference * (1.0 - difference));
    let above = gained - lost - n * difference;
    if variance > 0.0 {
        above / variance.sqrt()
    } else {
        above.signum() * f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_change_still_has_an_error() {
        let none = difference(0, 0, 1000, 1.96);
        let expected = 1.96 * 1.96 / (1000.0 + 1.96 * 1.96);
        assert!(none.value == 0.0 && (none.hi - expected).abs() < 1e-9 && none.hi == -none.lo);
    }

    #[test]
    fn many_changes_have_the_interval_of_the_normal_distribution() {
        let found = difference(300, 100, 100_000, 1.96);
        let arm = 1.96 * (400.0_f64 - 0.4).sqrt() / 100_000.0;
        assert!((found.value - 0.002).abs() < 1e-12);
        assert!((found.half_width() - arm).abs() < 0.03 * arm, "{found:?}");
        assert!(found.lo > 0.0016 - 1e-5 && found.hi < 0.0024 + 2e-5);
        // the other way round it is the mirror image
        let other = difference(100, 300, 100_000, 1.96);
        assert!((other.lo + found.hi).abs() < 1e-12 && (other.hi + found.lo).abs() < 1e-12);
    }
}
