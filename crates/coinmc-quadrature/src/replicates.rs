//! Independent scrambles of a point set, and the interval of their mean.
//!
//! Each replicate's mean is unbiased, and the sixteen are independent, so their mean has a Student
//! interval with fifteen degrees of freedom, up to the shape of their distribution. P. L'Ecuyer,
//! M. Nakayama, A. Owen & B. Tuffin (Winter Simulation Conference 2023) found this plain interval
//! reliable; its coverage for this use is tested.
//!
//! There is a look at the replicates when they have 64, 128, 256, … points. With K possible looks
//! each has the confidence 1 − (1 − c)/K (Bonferroni), so that the look that stops keeps c.

use coinmc_core::{Estimate, IntervalMethod, student_t_quantile};

use crate::integral::Share;

/// The number of independent scrambles.
pub const REPLICATES: u32 = 16;
/// Points of a replicate at its first look.
const FIRST: u64 = 64;
/// Evaluations before the first look at an integral.
pub const MIN_EVALUATIONS: u64 = FIRST * REPLICATES as u64;
/// Evaluations at which every integral ends: seconds of work.
pub const MAX_EVALUATIONS: u64 = 1 << 22;
/// Error of a mean that is not random: rounding, and the tails cut off a normal distribution.
const ROUNDING: f64 = 1e-12;
/// Occurrences below which a face is a rare event.
const RARE: u64 = 64;

/// The goal of an integration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Confidence of the intervals, in (0, 1).
    pub confidence: f64,
    /// Largest allowed half width of an interval.
    pub half_width: f64,
    /// Largest number of evaluations, clamped to [`MIN_EVALUATIONS`] … [`MAX_EVALUATIONS`].
    pub evaluations: u64,
}

impl Goal {
    /// Points of a replicate at each look.
    pub(crate) fn looks(&self) -> Vec<u64> {
        let most = self.evaluations.clamp(MIN_EVALUATIONS, MAX_EVALUATIONS) / u64::from(REPLICATES);
        let doubling = std::iter::successors(Some(FIRST), |points| points.checked_mul(2));
        doubling.take_while(|&points| points <= most).collect()
    }

    /// Confidence of a single look.
    fn look_confidence(&self) -> f64 {
        1.0 - (1.0 - self.confidence) / self.looks().len() as f64
    }

    /// The intervals after `points` points of each replicate, given its sums of heads, tails and
    /// side. `counts`: some evaluations give one face or none instead of probabilities.
    pub(crate) fn shares(&self, sums: &[[f64; 3]], points: u64, counts: bool) -> [Share; 3] {
        let t = student_t_quantile(
            f64::from(REPLICATES - 1),
            (1.0 - self.look_confidence()) / 2.0,
        );
        let mean = |sum: f64| sum / points as f64;
        // counts have a grain: if only one dimension matters, all sixteen replicates may count the
        // same number next to the true share, less than half a point away (probability 2^-16)
        let grain = if counts { 0.5 / points as f64 } else { 0.0 };
        let systematic = grain + ROUNDING;
        let decided: Vec<f64> = sums.iter().map(|sum| mean(sum.iter().sum())).collect();
        [0, 1, 2].map(|face| {
            let least: Vec<f64> = sums.iter().map(|sum| mean(sum[face])).collect();
            // evaluations without a face may have been this face
            let most = least
                .iter()
                .zip(&decided)
                .map(|(p, decided)| p + (1.0 - decided));
            let most: Vec<f64> = most.collect();
            let ((p, below), (upper, above)) = (student(&least, t), student(&most, t));
            let share = Share {
                p,
                lo: p - below - systematic,
                hi: upper + above + systematic,
            };
            let share = self.widen_if_rare(share, upper, points, counts);
            Share {
                p,
                lo: share.lo.max(0.0),
                hi: share.hi.min(1.0),
            }
        })
    }

    /// Widens the interval of a face that few evaluations had, or all but few, because the spread
    /// of sixteen small counts says little. A replicate's count spreads less than a binomial one,
    /// so Clopper and Pearson's interval holds.
    fn widen_if_rare(&self, share: Share, upper: f64, points: u64, counts: bool) -> Share {
        let n = points * u64::from(REPLICATES);
        // both lie in [0, n]
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let count = |p: f64| (p * n as f64).round() as u64;
        let (successes, most) = (count(share.p), count(upper).min(n));
        let rare = |count: u64| count.min(n - count) < RARE;
        let never = share.p == 0.0 || upper == 1.0;
        if !(never || counts && (rare(successes) || rare(most))) {
            return share;
        }
        let undecided = most.saturating_sub(successes);
        let (confidence, method) = (self.look_confidence(), IntervalMethod::ClopperPearson);
        let counted = Estimate::new(successes.min(most), undecided, n, confidence, method);
        Share {
            p: share.p,
            lo: share.lo.min(counted.lo),
            hi: share.hi.max(counted.hi),
        }
    }
}

/// Mean of the replicates, and the half width of its Student interval.
fn student(means: &[f64], t: f64) -> (f64, f64) {
    let n = means.len() as f64;
    let mean = means.iter().sum::<f64>() / n;
    let square: f64 = means.iter().map(|x| (x - mean) * (x - mean)).sum();
    (mean, t * (square / (n * (n - 1.0))).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOAL: Goal = Goal {
        confidence: 0.95,
        half_width: 1e-5,
        evaluations: 1 << 16,
    };

    #[test]
    fn looks_double_within_their_limits() {
        let looks = |evaluations| {
            Goal {
                evaluations,
                ..GOAL
            }
            .looks()
        };
        assert_eq!(looks(0), [64]);
        assert_eq!(looks(5000), [64, 128, 256]);
        assert_eq!(looks(u64::MAX).last(), Some(&(1 << 18)));
    }

    #[test]
    fn a_face_never_seen_has_an_upper_bound() {
        let sums = [[32.0, 32.0, 0.0]; 16];
        let [heads, _, side] = GOAL.shares(&sums, 64, true);
        assert_eq!((heads.p, side.p, side.lo), (0.5, 0.0, 0.0));
        // half a point of 64 is more than ln(2·7/0.05)/1024
        assert!((side.hi - 0.5 / 64.0).abs() < 1e-11, "{}", side.hi);
        let sums = [[32768.0, 32768.0, 0.0]; 16];
        let [_, _, side] = GOAL.shares(&sums, 65536, false);
        assert!(
            (side.hi * 65536.0 * 16.0 - 5.64).abs() < 0.02,
            "{}",
            side.hi
        );
    }

    /// Clopper and Pearson's interval of a look at 65,536 points of each replicate.
    fn counted(successes: u64, undecided: u64) -> Estimate {
        let method = IntervalMethod::ClopperPearson;
        let confidence = 1.0 - (1.0 - GOAL.confidence) / 7.0;
        Estimate::new(successes, undecided, 16 * 65_536, confidence, method)
    }

    fn is_close(found: f64, expected: f64) -> bool {
        (found - expected).abs() < 1e-11
    }

    /// Sixteen counts of three or four spread too little to say how rare a face is; of 64 occurrences the
    /// spread is believed.
    #[test]
    fn a_face_of_fewer_than_64_occurrences_is_as_uncertain_as_its_count() {
        let of = |counts: [f64; 2]| {
            let mut sums = [[65_536.0 - counts[0], 0.0, counts[0]]; 16];
            sums[0] = [65_536.0 - counts[1], 0.0, counts[1]];
            GOAL.shares(&sums, 65_536, true)
        };
        let ([heads, _, side], exact) = (of([4.0, 3.0]), counted(63, 0));
        assert!(
            is_close(side.lo, exact.lo) && is_close(side.hi, exact.hi),
            "{side:?}"
        );
        // all but few is as rare as few
        assert!(is_close(heads.lo, 1.0 - exact.hi) && is_close(heads.hi, 1.0 - exact.lo));
        let grain = 0.5 / 65_536.0;
        let [heads, _, side] = of([4.0, 4.0]);
        let p = 4.0 / 65_536.0;
        assert!(is_close(heads.lo, 1.0 - p - grain) && is_close(heads.hi, 1.0 - p + grain));
        assert!(
            is_close(side.lo, p - grain) && is_close(side.hi, p + grain),
            "{side:?}"
        );
    }

    /// What had no face may have been all but few.
    #[test]
    fn undecided_evaluations_may_make_a_face_all_but_certain() {
        let sums = [[32_768.0, 1.0, 0.0]; 16];
        let [heads, ..] = GOAL.shares(&sums, 65_536, true);
        let exact = counted(16 * 32_768, 16 * 32_767);
        assert!(is_close(heads.hi, exact.hi), "{heads:?} {exact:?}");
    }

    /// Student's interval of sixteen means with fifteen degrees of freedom: t(15; .025/7) by SciPy.
    #[test]
    fn the_spread_of_the_replicates_is_the_arm() {
        let mut sums = [[20.0, 44.0, 0.0]; 16];
        for sum in &mut sums[..8] {
            *sum = [24.0, 40.0, 0.0];
        }
        let [heads, ..] = Goal {
            evaluations: 65_536,
            ..GOAL
        }
        .shares(&sums, 64, false);
        // means of 24/64 and 20/64, eight each: deviations of 1/32
        let arm = 3.111_805_759_607_633 / 32.0 / 15.0_f64.sqrt();
        assert!((heads.hi - heads.p - arm).abs() < 1e-9 && (heads.p - heads.lo - arm).abs() < 1e-9);
    }

    #[test]
    fn undecided_evaluations_widen_every_interval() {
        let [heads, tails, side] = GOAL.shares(&[[16.0, 16.0, 16.0]; 16], 64, false);
        for share in [heads, tails, side] {
            assert!((share.p - 0.25).abs() < 1e-15);
            assert!((share.lo - 0.25).abs() < 1e-11 && (share.hi - 0.5).abs() < 1e-11);
        }
    }
}
