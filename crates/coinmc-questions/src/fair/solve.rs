//! All roots within a range.

use super::axis::Axis;
use super::refine::{Goal, Refined, refine};
use super::scan::{self, Finding, Scanned};
use super::tosses::Tosses;

/// What was found in a range.
#[derive(Debug, Clone)]
pub(super) struct Solved {
    pub(super) scanned: Vec<Scanned>,
    pub(super) findings: Vec<(Finding, Option<Refined>)>,
}

/// Scans the range and refines every root.
pub(super) fn solve<T: Tosses>(
    tosses: &mut T,
    axis: Axis,
    goal: &Goal,
) -> Result<Solved, T::Error> {
    let scanned = scan::scan(tosses, axis, goal.target)?;
    let mut first = scan::MOST;
    let mut findings = vec![];
    for finding in scan::findings(&scanned, goal.target) {
        let refined = match finding {
            Finding::Crossing { from, to, .. } => {
                let refined = refine(tosses, axis, goal, (from, to), first)?;
                first += refined.rounds.last().map_or(0, |round| round.tosses);
                Some(refined)
            }
            Finding::Near { .. } => None,
        };
        findings.push((finding, refined));
    }
    Ok(Solved { scanned, findings })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fair::tosses::{Sample, Seen};
    use coinmc_core::{Philox4x64, unit_interval};
    use std::convert::Infallible;

    /// Tosses of a curve that is known: toss k shows the face if its random number is below P.
    struct Known<F> {
        curve: F,
        key: u64,
    }

    impl<F: Fn(f64) -> f64> Tosses for Known<F> {
        type Error = Infallible;

        fn count(&mut self, samples: &[Sample]) -> Result<Vec<Seen>, Infallible> {
            let philox = Philox4x64::new([self.key, 22]);
            let count = |sample: &Sample| {
                let p = (self.curve)(sample.value);
                // four tosses a block
                let blocks = sample.first / 4..(sample.first + sample.tosses).div_ceil(4);
                let shown = blocks
                    .flat_map(|block| philox.block([block, 0, 0, 0]))
                    .filter(|&bits| unit_interval(bits) < p)
                    .count() as u64;
                Seen {
                    tosses: sample.tosses.div_ceil(4) * 4,
                    shown,
                    undecided: 0,
                }
            };
            Ok(samples.iter().map(count).collect())
        }
    }

    /// The zone rule: P(side) = x/sqrt(x² + 4), and its root x = 2p/sqrt(1 − p²).
    fn zone(x: f64) -> f64 {
        x / (x * x + 4.0).sqrt()
    }

    fn goal(target: f64, half_width: f64) -> Goal {
        Goal {
            target,
            half_width,
            z: 1.959_964,
            tosses: 10_000_000,
        }
    }

    fn only_root(curve: impl Fn(f64) -> f64, key: u64, goal: &Goal) -> Refined {
        let mut known = Known { curve, key };
        let Ok(solved) = solve(&mut known, Axis::new(0.05, 4.0), goal);
        let mut roots = solved.findings.into_iter().filter_map(|(_, root)| root);
        let root = roots.next().expect("a root");
        assert!(roots.next().is_none());
        root
    }

    /// Of 400 intervals of 95 % about 380 ± 4.4 hold the root; fewer than 366 (the chance of which is
    /// 0.1 %, by the binomial distribution) means that the intervals are too short.
    #[test]
    fn the_intervals_hold_the_root_as_often_as_they_say() {
        let root = 2.0 / 8.0_f64.sqrt();
        let goal = goal(1.0 / 3.0, 0.01);
        let (mut held, mut tosses) = (0, 0);
        for key in 0..400 {
            let found = only_root(zone, key, &goal);
            let last = found.rounds.last().expect("a round");
            assert!(last.half_width() <= 0.01);
            held += u32::from(last.lo < Some(root) && Some(root) < last.hi);
            tosses += last.tosses;
        }
        assert!(held >= 366, "{held} of 400");
        // a fixed design at the root itself: n = z² P(1 − P)/(P' w)², P' = 4/(x² + 4)^1.5
        let slope = 4.0 / libm::pow(root * root + 4.0, 1.5);
        let least = (goal.z / (slope * goal.half_width)).powi(2) * 2.0 / 9.0;
        let mean = f64::from(u32::try_from(tosses / 400).expect("a small mean"));
        assert!(mean < 1.35 * least, "{mean} tosses, {least} at least");
    }

    /// The probability of a coin that hardly bounces: it rises by .08 within 2 % of H/R.
    fn stepped(x: f64) -> f64 {
        let logistic = |z: f64| 1.0 / (1.0 + libm::exp(-z));
        0.13 + 0.58 * (x - 1.1) - 0.16 * (x - 1.1) * (x - 1.1) + 0.06 * logistic((x - 1.34) / 0.006)
    }

    /// Just above such a step a smooth curve through wide windows misses the root by many of its errors. Of 20 intervals of
    /// 95 % fewer than 15 hold it for one set of keys in 3,000. Nearer to the step 11 hold it, and none without narrower windows.
    #[test]
    fn a_step_beside_the_root_does_not_move_it() {
        for (root, least) in [(1.383, 15), (1.353, 6)] {
            let mut held = 0;
            for key in 0..20 {
                let mut known = Known {
                    curve: stepped,
                    key,
                };
                let goal = goal(stepped(root), 0.005);
                let Ok(solved) = solve(&mut known, Axis::new(0.2, 2.5), &goal);
                let found = solved.findings.into_iter().find_map(|(_, found)| found);
                let last = *found.expect("a root").rounds.last().expect("a round");
                held += u32::from(last.lo < Some(root) && Some(root) < last.hi);
            }
            assert!(held >= least, "{root}: {held} of 20");
        }
    }

    /// A curve that crosses the target between all of the thirteen values of the scan.
    #[test]
    fn every_crossing_is_a_root() {
        let turns = |x: f64| 0.5 + 0.4 * libm::cos(std::f64::consts::PI * (x - 20.0));
        let (curve, key) = (turns, 9);
        let mut known = Known { curve, key };
        let Ok(solved) = solve(&mut known, Axis::new(20.0, 32.0), &goal(0.5, 0.05));
        assert_eq!(solved.findings.len(), 12);
        for (crossing, (_, root)) in (0..).zip(solved.findings) {
            let last = *root.expect("a root").rounds.last().expect("a round");
            let middle = 20.5 + f64::from(crossing);
            // known to .05 with 95 %; all twelve to 4 standard errors but for 1 in 1,300
            assert!((last.value - middle).abs() < 0.11, "{crossing}: {last:?}");
        }
    }

    /// A falling curve that bends, and a far target.
    #[test]
    fn a_bent_curve_gives_its_root() {
        let curve = |x: f64| 0.5 - 0.45 * x / (1.0 + x);
        let root = 0.4 / 0.05;
        let mut outside = 0;
        for key in 0..40 {
            let mut known = Known { curve, key };
            let Ok(solved) = solve(&mut known, Axis::new(1.0, 40.0), &goal(0.1, 0.2));
            let (_, found) = solved.findings.first().expect("a finding");
            let last = *found
                .as_ref()
                .expect("a root")
                .rounds
                .last()
                .expect("a round");
            outside += u32::from(last.lo > Some(root) || last.hi < Some(root));
        }
        // 2 are expected; more than 7 have a chance of 0.1 %
        assert!(outside <= 7, "{outside} of 40");
    }

    #[test]
    fn two_roots_are_two() {
        let hump = |x: f64| 0.5 * libm::exp(-(x - 1.0) * (x - 1.0) / 0.5);
        let mut known = Known {
            curve: hump,
            key: 1,
        };
        let Ok(solved) = solve(&mut known, Axis::new(0.05, 4.0), &goal(0.3, 0.02));
        let arm = (0.5 * libm::log(0.5 / 0.3)).sqrt();
        let roots = [1.0 - arm, 1.0 + arm];
        assert_eq!(solved.findings.len(), 2);
        for ((finding, refined), root) in solved.findings.iter().zip(roots) {
            let Finding::Crossing { rising, .. } = finding else {
                panic!("{finding:?}");
            };
            let refined = refined.as_ref().expect("a root");
            let last = refined.rounds.last().expect("a round");
            assert!((last.value - root).abs() < 0.05, "{} {root}", last.value);
            assert_eq!(*rising, root < 1.0);
            assert_eq!(refined.slope.0 > 0.0, *rising);
        }
    }

    #[test]
    fn a_curve_that_never_crosses_has_no_root() {
        let mut known = Known {
            curve: |_| 0.2,
            key: 3,
        };
        let Ok(solved) = solve(&mut known, Axis::new(0.05, 4.0), &goal(1.0 / 3.0, 0.01));
        assert!(solved.findings.is_empty());
    }

    /// On a plateau at the target nothing can be told apart: the interval stays open, or wide.
    #[test]
    fn a_plateau_is_near_the_target() {
        let mut known = Known {
            curve: |_| 1.0 / 3.0,
            key: 3,
        };
        let goal = Goal {
            tosses: 100_000,
            ..goal(1.0 / 3.0, 0.01)
        };
        let Ok(solved) = solve(&mut known, Axis::new(0.05, 4.0), &goal);
        assert!(matches!(
            solved.findings[..],
            [(Finding::Near { .. }, None)]
        ));
    }
}
