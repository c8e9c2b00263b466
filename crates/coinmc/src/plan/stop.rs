//! When a point has enough tosses.

/// When a point has enough tosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stop {
    /// After this many.
    Tosses(u64),
    /// When every face's interval is no wider than ± `half_width`, looked at only at toss counts
    /// fixed beforehand (doubling), with the confidence shared out over all looks.
    HalfWidth {
        /// Longest arm allowed.
        half_width: f64,
        /// Tosses at which the point stops short of its target.
        max_tosses: u64,
    },
}

/// Tosses at the first look at a point that stops at a half width: some 30 ms of work in the plane,
/// more in space.
pub(crate) const FIRST_LOOK: u64 = 1 << 14;

/// Toss counts at which a point that stops at a half width is looked at: [`FIRST_LOOK`], twice and
/// four times that … below `max_tosses`, then `max_tosses`.
pub(crate) fn looks(max_tosses: u64) -> impl Iterator<Item = u64> {
    let doubling = std::iter::successors(Some(FIRST_LOOK), |n| n.checked_mul(2));
    doubling
        .take_while(move |&n| n < max_tosses)
        .chain([max_tosses])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_double_and_end_at_the_largest_number() {
        assert_eq!(looks(100).collect::<Vec<_>>(), [100]);
        assert_eq!(looks(16_384).collect::<Vec<_>>(), [16_384]);
        assert_eq!(looks(40_000).collect::<Vec<_>>(), [16_384, 32_768, 40_000]);
        assert_eq!(looks(u64::MAX).last(), Some(u64::MAX));
    }
}
