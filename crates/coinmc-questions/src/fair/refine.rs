//! From a bracket to a root with its interval.
//!
//! Every round spreads fresh tosses over four values in a window around the root that is known so
//! far, fits the log odds to all fresh tosses near it ([`fit`](super::fit)), and moves the window to
//! the new root. All tosses then tell of the root: with n of them at about the root, its standard
//! error is sqrt(P(1 − P)/n)/P', whatever the values in the window. The window shrinks with that
//! error, down to a width in which the log odds bend little compared with the error that is asked
//! for. The last rounds are as large as the fit says is needed.
//!
//! Where the counts scatter about the fit by more than chance, the curve has steps of its own in the window: the interval
//! is widened by the ratio (Birge, Phys. Rev. 40 (1932) 207), and the next window is a quarter as wide and uses hardly any
//! counts of wider ones, until the curve in it is smooth, or it is as narrow as the half width that is asked for.

use super::axis::Axis;
use super::fit::{Counts, Fit, USED, Window, log_odds};
use super::tosses::{Sample, Tosses};

/// Values of a round, in half widths of the window from its middle.
const VALUES: [f64; 4] = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0];
/// Tosses of the first round.
const FIRST: u64 = 4096;
/// Tosses of the smallest round.
const LEAST: u64 = 512;
/// After a round there are at most this many times the tosses of before: what it aims at is itself
/// uncertain.
const GROWTH: u64 = 4;
/// The first window is wider than the bracket by this factor, as a slope is the better known the
/// farther its ends lie apart.
const WIDER: f64 = 1.5;
/// Most rounds.
const MOST_ROUNDS: u32 = 24;
/// Half width of the window, in standard errors of the root.
const ERRORS: f64 = 3.0;
/// The narrowest window on a curve with steps, in half widths that are asked for.
const NARROWEST: f64 = 2.0;
/// How far from the middle of its window a fit to a curve with steps uses counts, in half widths.
const OWN: f64 = 1.5;

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Goal {
    /// Probability of the face.
    pub(super) target: f64,
    /// Half width of the interval, in the parameter.
    pub(super) half_width: f64,
    /// Standard errors on either side of an interval of the confidence asked for.
    pub(super) z: f64,
    /// Tosses at which the search stops short of the half width.
    pub(super) tosses: u64,
}

/// What one round found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Round {
    /// First value of its tosses.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Fresh tosses up to and with this round.
    pub tosses: u64,
    /// The root as known after it; NaN if the fit has none near.
    pub value: f64,
    /// Lower end of its interval; `None` if it is open.
    pub lo: Option<f64>,
    /// Upper end.
    pub hi: Option<f64>,
}

/// A root.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Refined {
    pub(super) rounds: Vec<Round>,
    /// dP/d(parameter) there, with its standard error; NaN without a root.
    pub(super) slope: (f64, f64),
    pub(super) undecided: u64,
}

/// A search within a bracket.
struct Refinement<'a> {
    axis: Axis,
    goal: &'a Goal,
    bracket: Window,
    window: Window,
    counts: Vec<Counts>,
    tosses: u64,
    undecided: u64,
    /// Whether the counts have shown steps of the curve.
    has_steps: bool,
}

/// Finds the root between `from` and `to` (in u) with the tosses from number `first` on.
pub(super) fn refine<T: Tosses>(
    tosses: &mut T,
    axis: Axis,
    goal: &Goal,
    (from, to): (f64, f64),
    first: u64,
) -> Result<Refined, T::Error> {
    let bracket = Window {
        middle: 0.5 * (from + to),
        half: WIDER * 0.5 * (to - from),
    };
    let mut search = Refinement {
        axis,
        goal,
        bracket,
        window: bracket,
        counts: vec![],
        tosses: 0,
        undecided: 0,
        has_steps: false,
    };
    let mut rounds = vec![];
    let mut slope = (f64::NAN, f64::NAN);
    let mut size = FIRST.min(goal.tosses);
    for _ in 0..MOST_ROUNDS {
        search.toss(tosses, first, size)?;
        let (round, next, found) = search.look();
        rounds.push(round);
        slope = found.unwrap_or(slope);
        match next {
            Some(more) => size = more,
            None => break,
        }
    }
    Ok(Refined {
        rounds,
        slope,
        undecided: search.undecided,
    })
}

impl Refinement<'_> {
    /// Tosses in the window.
    fn toss<T: Tosses>(&mut self, tosses: &mut T, first: u64, size: u64) -> Result<(), T::Error> {
        // whole batches of any engine
        let each = size.div_ceil(64 * VALUES.len() as u64) * 64;
        let sample = |(i, place): (u64, f64)| Sample {
            value: self
                .axis
                .value(self.window.middle + place * self.window.half),
            first: first + self.tosses + i * each,
            tosses: each,
        };
        let samples: Vec<Sample> = (0..).zip(VALUES).map(sample).collect();
        for (sample, seen) in samples.iter().zip(tosses.count(&samples)?) {
            self.counts.push(Counts {
                u: self.axis.u(sample.value),
                tosses: seen.tosses,
                shown: seen.shown,
            });
            self.tosses += seen.tosses;
            self.undecided += seen.undecided;
        }
        Ok(())
    }

    /// What is known of the root, how many tosses the next round needs (`None`: no more), and the
    /// slope.
    fn look(&mut self) -> (Round, Option<u64>, Option<(f64, f64)>) {
        let place = |place: f64| {
            self.axis
                .value(self.window.middle + place * self.window.half)
        };
        let mut round = Round {
            from: place(-1.0),
            to: place(1.0),
            tosses: self.tosses,
            value: f64::NAN,
            lo: None,
            hi: None,
        };
        let left = self.goal.tosses.saturating_sub(self.tosses);
        let grown = (GROWTH - 1) * self.tosses;
        let target = log_odds(self.goal.target);
        let found = Fit::new(&self.counts, self.window, self.reach())
            .and_then(|fit| Some((fit, self.within_reach(fit.root(target)?)?)));
        let Some((fit, root)) = found else {
            return (round, Some(grown.min(left)).filter(|&n| n > 0), None);
        };
        let value = self.axis.value(root);
        let (slope, slope_error) = fit.slope(root);
        let rate = self.axis.rate(value);
        let p = self.goal.target;
        let variance = p * (1.0 - p);
        // undecided tosses could all show the face or none
        let allowance = self.undecided as f64 / self.tosses as f64 / variance;
        let reach = 2.0 * self.bracket.half;
        let excess = fit.excess(&self.counts, self.reach());
        let ends = fit.interval(root, target, self.goal.z * excess, allowance, reach);
        round.value = value;
        [round.lo, round.hi] = ends.map(|end| end.map(|u| self.axis.value(u)));
        let slope = (slope * variance / rate, slope_error * variance / rate);
        let half_width = round.half_width();
        let enough = half_width <= self.goal.half_width;
        let error = fit.at(root).1 / fit.slope(root).0.abs();
        let wanted = self.wanted(slope.0, half_width);
        let next = wanted.max(LEAST).min(grown).min(left);
        // The few tosses that a budget may leave for the end do not tell the slope anew: they stay in
        // the window in which the tosses before told it.
        let few = next == left && next < self.tosses;
        if excess > 1.0 {
            self.narrow_window(root, rate);
        } else if !few && self.has_steps {
            self.window.middle = root;
        } else if !few {
            self.move_window(root, error, rate);
        }
        let next = (!enough && next > 0).then_some(next);
        (round, next, Some(slope))
    }

    /// Tosses that are still needed: as many as the slope says, or, once those were made, as the half
    /// width of the interval does.
    fn wanted(&self, slope: f64, half_width: f64) -> u64 {
        /// More, as the slope is uncertain and the window has a width.
        const SPARE: f64 = 1.06;
        let Goal { target, z, .. } = *self.goal;
        let least = (z / (slope * self.goal.half_width)).powi(2) * target * (1.0 - target);
        let tosses = if self.has_steps {
            let used = self.window.uses(&self.counts, self.reach());
            used.map(|counts| counts.tosses).sum()
        } else {
            self.tosses
        };
        let tosses = tosses as f64;
        let mut all = SPARE * least;
        if all < 1.02 * tosses {
            all = SPARE * tosses * (half_width / self.goal.half_width).powi(2);
        }
        // `as` saturates
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let wanted = (all - tosses) as u64;
        wanted
    }

    /// How far from the middle of the window counts are used, in half widths.
    fn reach(&self) -> f64 {
        if self.has_steps { OWN } else { USED }
    }

    /// A root that lies within the bracket or close to it.
    fn within_reach(&self, root: f64) -> Option<f64> {
        let far = (root - self.bracket.middle).abs() > 2.0 * self.bracket.half;
        (!far).then_some(root)
    }

    /// Puts the window around the root: no narrower than the root is known, and no wider than is
    /// needed for a slope, which the wider windows before tell too.
    fn move_window(&mut self, root: f64, error: f64, rate: f64) {
        /// In half widths that are asked for. With 2½ the slope takes a fifth more tosses; wider windows hold more of the
        /// curve's own steps.
        const NARROW: f64 = 4.0;
        let goal = self.goal.half_width / rate;
        let half = (ERRORS * error).max(NARROW * goal).min(self.bracket.half);
        let inside = self.bracket.half - half;
        let middle = self.bracket.middle + (root - self.bracket.middle).clamp(-inside, inside);
        self.window = Window { middle, half };
    }
    /// Puts a window a quarter as wide around the root, which uses counts in it and close to it.
    fn narrow_window(&mut self, root: f64, rate: f64) {
        self.has_steps = true;
        let least = NARROWEST * self.goal.half_width / rate;
        let half = (0.25 * self.window.half).max(least);
        self.window = Window { middle: root, half };
    }
}

impl Round {
    /// The longer arm of the interval; infinite if an end is open.
    pub fn half_width(&self) -> f64 {
        match (self.lo, self.hi) {
            (Some(lo), Some(hi)) => (self.value - lo).max(hi - self.value),
            _ => f64::INFINITY,
        }
    }
}
