//! Where to look for roots: the whole range, coarsely.
//!
//! All values are tossed with the same random numbers (paired), so that the curve is smoother than
//! its points are accurate, and noise makes few crossings of its own. A value is *above* or *below*
//! the target once chance alone would put its count on that side with a probability under 0.1 %; the
//! others get more tosses, to a limit, and what is then still open lies *near* the target.

use super::axis::Axis;
use super::tosses::{Sample, Seen, Tosses};

/// Values of the scan, both ends of the range included.
const VALUES: u32 = 13;
/// Tosses of each value, at first and at most.
const FIRST: u64 = 512;
pub(super) const MOST: u64 = 8192;
/// Standard errors beyond which a value is above or below.
const SURE: f64 = 3.3;

/// What the scan found, in order of the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Finding {
    /// The face's probability crosses the target between these two, in u.
    Crossing { from: f64, to: f64, rising: bool },
    /// It comes near the target between these two, and was not seen to cross.
    Near { from: f64, to: f64 },
}

/// One value of the scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scanned {
    pub(super) u: f64,
    pub(super) seen: Seen,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Below,
    Above,
    Open,
}

/// Tosses the whole range.
pub(super) fn scan<T: Tosses>(
    tosses: &mut T,
    axis: Axis,
    target: f64,
) -> Result<Vec<Scanned>, T::Error> {
    let [from, to] = axis.ends();
    let u = |i: u32| from + (to - from) * f64::from(i) / f64::from(VALUES - 1);
    let mut scanned: Vec<Scanned> = (0..VALUES)
        .map(|i| Scanned {
            u: u(i),
            seen: Seen::default(),
        })
        .collect();
    let (mut first, mut more) = (0, FIRST);
    while first < MOST {
        let open: Vec<usize> = (0..scanned.len())
            .filter(|&i| side(&scanned[i].seen, target) == Side::Open)
            .collect();
        if open.is_empty() {
            break;
        }
        let sample = |&i: &usize| Sample {
            value: axis.value(scanned[i].u),
            first,
            tosses: more,
        };
        let samples: Vec<Sample> = open.iter().map(sample).collect();
        for (i, seen) in open.into_iter().zip(tosses.count(&samples)?) {
            scanned[i].seen.add(seen);
        }
        (first, more) = (first + more, first + more);
    }
    Ok(scanned)
}

/// What a scan says of the target.
pub(super) fn findings(scanned: &[Scanned], target: f64) -> Vec<Finding> {
    let mut findings = vec![];
    // the last value that is above or below
    let mut last: Option<(f64, Side)> = None;
    // the first value that is near the target since then
    let mut open: Option<f64> = None;
    for scanned in scanned {
        let (u, now) = (scanned.u, side(&scanned.seen, target));
        if now == Side::Open {
            open.get_or_insert(u);
            continue;
        }
        match last {
            Some((from, before)) if before != now => findings.push(Finding::Crossing {
                from,
                to: u,
                rising: now == Side::Above,
            }),
            _ => findings.extend(open.map(|from| Finding::Near { from, to: u })),
        }
        (last, open) = (Some((u, now)), None);
    }
    let end = scanned.last().map_or(0.0, |scanned| scanned.u);
    findings.extend(open.map(|from| Finding::Near { from, to: end }));
    findings
}

/// On which side of the target a value is, whatever the faces of its undecided tosses.
fn side(seen: &Seen, target: f64) -> Side {
    let n = seen.tosses as f64;
    let noise = SURE * (n * target * (1.0 - target)).sqrt();
    if seen.shown as f64 > n * target + noise {
        Side::Above
    } else if ((seen.shown + seen.undecided) as f64) < n * target - noise {
        Side::Below
    } else {
        Side::Open
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 10,000
    fn scanned(shares: &[f64]) -> Vec<Scanned> {
        let at = |(i, share): (usize, &f64)| Scanned {
            u: i as f64,
            seen: Seen {
                tosses: 10_000,
                shown: (share * 1e4) as u64,
                undecided: 0,
            },
        };
        shares.iter().enumerate().map(at).collect()
    }

    #[test]
    fn crossings_and_near_misses_are_told_apart() {
        let found = findings(&scanned(&[0.1, 0.33, 0.6, 0.7, 0.2, 0.335, 0.1]), 1.0 / 3.0);
        let expected = [
            Finding::Crossing {
                from: 0.0,
                to: 2.0,
                rising: true,
            },
            Finding::Crossing {
                from: 3.0,
                to: 4.0,
                rising: false,
            },
            Finding::Near { from: 5.0, to: 6.0 },
        ];
        assert_eq!(found, expected);
        let plateau = findings(&scanned(&[0.33, 0.335, 0.334]), 1.0 / 3.0);
        assert_eq!(plateau, [Finding::Near { from: 0.0, to: 2.0 }]);
        assert_eq!(findings(&scanned(&[0.1, 0.2]), 1.0 / 3.0), []);
    }

    /// Undecided tosses could show the face, so many of them leave the side open.
    #[test]
    fn undecided_tosses_are_counted_either_way() {
        let seen = Seen {
            tosses: 1000,
            shown: 200,
            undecided: 0,
        };
        assert_eq!(side(&seen, 0.5), Side::Below);
        let undecided = 300;
        assert_eq!(side(&Seen { undecided, ..seen }, 0.5), Side::Open);
    }
}
