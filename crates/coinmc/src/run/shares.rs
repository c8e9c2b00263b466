//! How points share the tosses that a run may still make.

/// What a point needs of the tosses that are left.
#[derive(Debug, Clone, Copy)]
pub(super) struct Need {
    /// Tosses that it may have.
    pub(super) most: u64,
    /// Tosses that would meet its targets; infinite if none would.
    pub(super) wanted: f64,
}

/// Divides `left` among `needs` in proportion to what is wanted, whole if there is enough. Targets that
/// cannot be met count like the farthest of those that can; and no point gets next to nothing.
pub(super) fn shares(needs: &[Need], left: u64) -> Vec<u64> {
    /// Tosses that each gets beforehand.
    const LEAST: u64 = 256;
    let all: u128 = needs.iter().map(|need| u128::from(need.most)).sum();
    if all <= u128::from(left) {
        return needs.iter().map(|need| need.most).collect();
    }
    let finite = needs.iter().map(|need| need.wanted);
    let farthest = finite
        .filter(|wanted| wanted.is_finite())
        .fold(1.0, f64::max);
    let weight = |need: &Need| need.wanted.min(farthest);
    let sum: f64 = needs.iter().map(weight).sum();
    let least = LEAST.min(left / needs.len() as u64);
    let rest = (left - least * needs.len() as u64) as f64;
    needs
        .iter()
        .map(|need| {
            // rounded down, and by the last digit of a quotient, so that the sum is never above what is left
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let more = (rest * (weight(need) / sum) * (1.0 - 1e-12)) as u64;
            need.most.min(least + more)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(wanted: &[f64], left: u64) -> Vec<u64> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let need = |&wanted: &f64| Need {
            most: wanted as u64,
            wanted,
        };
        shares(&wanted.iter().map(need).collect::<Vec<_>>(), left)
    }

    #[test]
    fn what_is_left_is_shared_in_proportion_to_the_need() {
        assert_eq!(of(&[1000.0, 3000.0], 4000), [1000, 3000]);
        assert_eq!(of(&[10_000.0, 30_000.0], 20_513), [5256, 15_256]);
        // what cannot be met takes no more than what can
        assert_eq!(of(&[f64::INFINITY, 20_000.0], 20_514), [10_256, 10_256]);
        assert_eq!(of(&[f64::INFINITY; 2], 20_514), [10_256, 10_256]);
        assert_eq!(of(&[1000.0; 3], 100), [33; 3]);
        assert_eq!(of(&[5.0], 0), [0]);
        for (wanted, left) in [([7.0, 1e18, f64::INFINITY], 1 << 50), ([1e6; 3], 999)] {
            let given = of(&wanted, left);
            assert!(given.iter().sum::<u64>() <= left);
            assert!(
                given
                    .iter()
                    .zip(wanted)
                    .all(|(given, most)| *given as f64 <= most)
            );
        }
    }
}
