//! Strata of launches: by the rank of the inclination at first touch.

/// How often the launches are halved towards either end.
const HALVES: usize = 11;
/// From the middle outwards each stratum holds half of what is left, from a quarter of all launches to
/// 2^-11 of them; the outermost two at either end hold as many.
pub(super) const STRATA: usize = 2 * HALVES;

/// The limits between strata.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Strata {
    /// In ascending order; each belongs to the stratum above it.
    limits: Vec<f64>,
}

impl Strata {
    /// The limits by the ranks of these inclinations, a power of two of them and enough.
    pub(super) fn of(mut inclinations: Vec<f64>) -> Self {
        let n = inclinations.len();
        assert!(n >= 1 << HALVES);
        inclinations.sort_by(f64::total_cmp);
        let low = (2..=HALVES).rev().map(|halves| n >> halves);
        let high = (2..=HALVES).map(|halves| n - (n >> halves));
        let ranks = low.chain([n / 2]).chain(high);
        Self {
            limits: ranks.map(|rank| inclinations[rank]).collect(),
        }
    }

    /// The stratum of an inclination, from 0.
    pub(super) fn index(&self, inclination: f64) -> usize {
        self.limits.partition_point(|limit| *limit <= inclination)
    }

    /// The share of all launches that a stratum holds, if no two land exactly alike.
    pub(super) fn nominal_share(stratum: usize) -> f64 {
        let from_end = stratum.min(STRATA - 1 - stratum).max(1);
        libm::exp2(from_end as f64 - 1.0 - HALVES as f64)
    }

    /// From which inclination to which a stratum reaches.
    pub(super) fn range(&self, stratum: usize) -> [f64; 2] {
        let from = stratum
            .checked_sub(1)
            .map_or(0.0, |below| self.limits[below]);
        [from, self.limits.get(stratum).copied().unwrap_or(1.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strata_halve_towards_both_ends() {
        let n = 1 << 12;
        let strata = Strata::of(
            (0..n)
                .rev()
                .map(|i| (f64::from(i) + 0.5) / f64::from(n))
                .collect(),
        );
        let mut held = [0; STRATA];
        for i in 0..n {
            held[strata.index((f64::from(i) + 0.5) / f64::from(n))] += 1;
        }
        assert_eq!(held[0], n >> 11);
        assert_eq!(held[STRATA - 1], n >> 11);
        assert_eq!(held[1], n >> 11);
        assert_eq!(held[2], n >> 10);
        assert_eq!((held[STRATA / 2 - 1], held[STRATA / 2]), (n / 4, n / 4));
        assert_eq!(held.iter().sum::<i32>(), n);
        for (stratum, held) in held.iter().enumerate() {
            assert_eq!(
                f64::from(*held) / f64::from(n),
                Strata::nominal_share(stratum)
            );
        }
        for stratum in 0..STRATA {
            let [from, to] = strata.range(stratum);
            assert!(from < to);
            assert_eq!(strata.index(0.5 * (from + to)), stratum);
        }
    }

    /// Many coins that land exactly alike share one stratum.
    #[test]
    fn equal_inclinations_share_a_stratum() {
        let strata = Strata::of(vec![0.5; 1 << 12]);
        assert_eq!(strata.index(0.5), STRATA - 1);
        assert_eq!(strata.index(0.4), 0);
    }
}
