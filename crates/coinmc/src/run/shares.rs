//! How points share the tosses that a run may still make.

use crate::plan::StoppedBy;

/// What a point needs of what is left.
#[derive(Debug, Clone, Copy)]
pub(super) struct Need {
    /// Tosses that it may have.
    pub(super) most: u64,
    /// Tosses that would meet its targets; infinite if none would.
    pub(super) wanted: f64,
    /// Computing time of one of its tosses, s.
    pub(super) seconds: f64,
}

/// What the run may still spend; infinite if it has no such limit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Left {
    /// Tosses.
    pub(super) tosses: f64,
    /// Computing time, s.
    pub(super) seconds: f64,
}

/// Who gets how much.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shares {
    /// Tosses of each.
    pub(super) tosses: Vec<u64>,
    /// The limit that makes them fewer than were needed; `None` if there is enough.
    pub(super) by: Option<StoppedBy>,
}

/// Divides what is left among `needs` in proportion to what is wanted, whole if there is enough. Targets
/// that cannot be met count like the farthest of those that can; and no point gets next to nothing.
pub(super) fn shares(needs: &[Need], left: Left) -> Shares {
    /// Tosses that each gets beforehand, if there are as many.
    const LEAST: f64 = 256.0;
    let farthest = farthest(needs);
    let weight = |need: &Need| need.wanted.min(farthest);
    let sum = |of: &dyn Fn(&Need) -> f64| needs.iter().map(of).sum::<f64>();
    // each limit allows so many tosses to all alike, and then so many for each that is wanted
    let limit = |left: f64, cost: &dyn Fn(&Need) -> f64| {
        let alike = (left.max(0.0) / sum(cost)).min(LEAST).floor();
        let rest = (left - alike * sum(cost)).max(0.0);
        let part = rest / sum(&|need| weight(need) * cost(need));
        let is_enough = sum(&|need| need.most as f64 * cost(need)) <= left;
        (!is_enough).then_some((alike, part))
    };
    let by_tosses = limit(left.tosses, &|_| 1.0);
    let by_seconds = limit(left.seconds, &|need| need.seconds);
    let (by, (alike, part)) = match (by_tosses, by_seconds) {
        (None, None) => {
            let tosses = needs.iter().map(|need| need.most).collect();
            return Shares { tosses, by: None };
        }
        (Some(tosses), Some(seconds)) if seconds < tosses => (StoppedBy::TotalCoreSeconds, seconds),
        (Some(tosses), _) => (StoppedBy::TotalTosses, tosses),
        (None, Some(seconds)) => (StoppedBy::TotalCoreSeconds, seconds),
    };
    let share = |need: &Need| {
        // a last digit less, so that rounding never exceeds what is left
        let tosses = alike + part * (1.0 - 1e-12) * weight(need);
        // saturates, and is rounded down
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let tosses = tosses as u64;
        need.most.min(tosses)
    };
    Shares {
        tosses: needs.iter().map(share).collect(),
        by: Some(by),
    }
}

/// The most tosses that targets want which can be met; if none can, all are alike.
fn farthest(needs: &[Need]) -> f64 {
    let wanted = needs.iter().map(|need| need.wanted);
    let finite = wanted.filter(|wanted| wanted.is_finite());
    finite.max_by(f64::total_cmp).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const INFINITE: f64 = f64::INFINITY;

    fn needs(wanted: &[f64]) -> Vec<Need> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let need = |&wanted: &f64| Need {
            most: wanted as u64,
            wanted,
            seconds: 1e-3,
        };
        wanted.iter().map(need).collect()
    }

    fn of(wanted: &[f64], tosses: f64) -> Vec<u64> {
        let seconds = INFINITE;
        shares(&needs(wanted), Left { tosses, seconds }).tosses
    }

    #[test]
    fn what_is_left_is_shared_in_proportion_to_the_need() {
        assert_eq!(of(&[1000.0, 3000.0], 4000.0), [1000, 3000]);
        assert_eq!(of(&[10_000.0, 30_000.0], 20_513.0), [5256, 15_256]);
        // what cannot be met takes no more than what can
        assert_eq!(of(&[INFINITE, 20_000.0], 20_514.0), [10_256, 10_256]);
        assert_eq!(of(&[INFINITE; 2], 20_514.0), [10_256; 2]);
        assert_eq!(of(&[1000.0; 3], 100.0), [33; 3]);
        assert_eq!(of(&[5.0], 0.0), [0]);
        for (wanted, left) in [([7.0, 1e18, INFINITE], 1e15), ([1e6; 3], 999.0)] {
            let given = of(&wanted, left);
            assert!(given.iter().sum::<u64>() as f64 <= left);
            assert!(
                given
                    .iter()
                    .zip(wanted)
                    .all(|(given, most)| *given as f64 <= most)
            );
        }
    }

    #[test]
    fn time_is_shared_so_that_all_errors_end_equal() {
        let mut needs = needs(&[10_000.0, 30_000.0]);
        needs[1].seconds = 3e-3;
        let of = |tosses, seconds| shares(&needs, Left { tosses, seconds });
        let enough = of(INFINITE, 100.0);
        assert_eq!((enough.tosses, enough.by), (vec![10_000, 30_000], None));
        // 256 of each take 1.024 s, half of what is wanted 50 s
        let given = of(INFINITE, 51.024 + 1e-6);
        assert_eq!(given.tosses, [5256, 15_256]);
        assert_eq!(given.by, Some(StoppedBy::TotalCoreSeconds));
        // the scarcer of the two decides
        let by_tosses = of(20_513.0, 1e9);
        assert_eq!(by_tosses.tosses, given.tosses);
        assert_eq!(by_tosses.by, Some(StoppedBy::TotalTosses));
        assert_eq!(of(20_513.0, 30.0).by, Some(StoppedBy::TotalCoreSeconds));
        assert_eq!(of(1e9, -1.0).tosses, [0, 0]);
        // and where both are as scarce, the tosses: powers of two, for which all of this is exact
        for need in &mut needs {
            need.seconds = 1.0 / 1024.0;
        }
        let both = shares(
            &needs,
            Left {
                tosses: 20_480.0,
                seconds: 20.0,
            },
        );
        assert_eq!(both.by, Some(StoppedBy::TotalTosses));
    }
}
