//! At which toss counts a point that stops at targets is looked at.
//!
//! # Why a pilot
//! Whoever looks again and again, and stops when an interval happens to be short, must share the error
//! probability α over all looks, and pays for it: with a dozen looks at doubling counts 3.2 times the
//! tosses of a design that knew the probabilities. A *pilot* learns them instead:
//!
//! 1. The pilot's tosses only say how many tosses the targets need. It doubles as long as the margin of the next
//!    step shrinks by more tosses than that costs: so it has some hundredths of them, or, where a face is rare, a tenth.
//! 2. So many tosses follow, with a margin of 2.5 standard errors of the pilot. Only these are counted.
//!    Given the pilot their number is fixed, so that their interval is as valid as that of any fixed number
//!    of tosses; the pilot's own tosses had to go, as chance in them decides that number.
//! 3. Chance seldom leaves the targets unmet. Then the point is looked at again at three times, nine times … as
//!    many counted tosses. The first look has the share .97 of α, the others .015, .0075, …, and the last, at
//!    the limit of tosses, all that is left: in all no more than α (Bonferroni).
//!
//! For P = .3 and a half width of .001 that takes 1.05 times the tosses of the fixed design
//! (`benches/python/stopping.py`).
//!
//! The two stages are Stein's (Ann. Math. Stat. 16 (1945) 243), for proportions, without his use of the
//! pilot in the estimate.

use super::{MAX_TOSSES, Targets};
use coinmc_core::{Estimate, Face, IntervalMethod, Tally};
use std::f64::consts::FRAC_1_SQRT_2;
use std::ops::Range;

/// Tosses of the pilot's first stage.
pub(crate) const PILOT: u64 = 1 << 6;
/// Least limit of tosses with which a pilot pays.
const LEAST_WITH_PILOT: u64 = 1 << 12;
/// Share of α of the first look.
const FIRST_SHARE: f64 = 0.97;
/// Standard errors of the pilot by which the first look is later than the pilot says.
const MARGIN: f64 = 2.5;
/// Times as many tosses as the pilot says that the first look is later at most.
const MOST_MARGIN: f64 = 3.0;
/// Standard errors of the pilot by which undecided tosses must be too many, before a point is given up.
const SURE: f64 = 4.0;
/// More tosses than any point may make.
const MOST: f64 = MAX_TOSSES as f64;
/// Counted tosses are a multiple of this, but for those at the limit.
const MULTIPLE: u64 = 32;

/// The looks at a point that stops at targets.
///
/// # Example
/// ```
/// use coinmc::plan::{Looks, Stop, Targets, Verdict};
/// use coinmc_core::Tally;
/// let plan = coinmc::config::parse(
///     "inline",
///     "coin.ratio = 1\nsurface = { restitution = 0.5, friction = 0.3 }\nlaunch.preset = 'robot'\n\
///      engine.flat = {}\nstop.half_width = 0.01",
///     &[],
/// ).unwrap();
/// let Stop::Targets(targets) = plan.stop else { unreachable!() };
/// let mut looks = Looks::new(targets, plan.confidence);
/// assert_eq!((looks.stage(), looks.is_pilot()), (0..64, true));
/// // whatever the pilot shows, its tosses do not count
/// let shown = |tosses| Tally { heads: tosses / 2, tails: tosses - tosses / 2, ..Tally::default() };
/// assert_eq!(looks.look(&shown(64)), Verdict::More);
/// assert_eq!(looks.stage(), 64..10_048);
/// assert_eq!(looks.look(&shown(looks.counted())), Verdict::Met);
/// # assert_eq!(looks.counted(), 9984);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Looks {
    targets: Targets,
    /// α: probability allowed that the final interval misses.
    alpha: f64,
    /// Tosses at most, those of the pilot included.
    limit: u64,
    /// Of how many tosses in all the pilot may be a part.
    limit_of_pilot: u64,
    /// Tosses of the pilot, once it has ended.
    pilot: Option<u64>,
    /// Looks at counted tosses so far.
    looked: i32,
    /// Where the stage begins and ends.
    stage: Range<u64>,
    /// Tosses that the stage would have without a limit.
    wanted: f64,
    /// Tosses without a face alone are more than the targets allow, as the pilot shows.
    hopeless: bool,
}

/// What a look shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Make the tosses of the next stage.
    More,
    /// The targets are met.
    Met,
    /// They are not, and no more tosses are allowed.
    Short,
}

impl Looks {
    /// The looks at a point, for intervals of this confidence.
    pub fn new(targets: Targets, confidence: f64) -> Self {
        Self::within(targets, confidence, targets.max_tosses)
    }

    /// The same with a pilot that is limited as if this were the limit of all tosses; without a pilot, all
    /// tosses are.
    pub(crate) fn within(targets: Targets, confidence: f64, limit: u64) -> Self {
        let limit = limit.min(targets.max_tosses);
        let with_pilot = limit >= LEAST_WITH_PILOT;
        Self {
            targets,
            alpha: 1.0 - confidence,
            limit: if with_pilot {
                targets.max_tosses
            } else {
                limit
            },
            limit_of_pilot: limit,
            pilot: (!with_pilot).then_some(0),
            looked: 0,
            stage: 0..if with_pilot { PILOT } else { limit },
            wanted: f64::INFINITY,
            hopeless: false,
        }
    }

    /// Numbers of the tosses of the present stage.
    pub fn stage(&self) -> Range<u64> {
        self.stage.clone()
    }

    /// Whether the tosses of the present stage belong to the pilot.
    pub fn is_pilot(&self) -> bool {
        self.pilot.is_none()
    }

    /// Tosses of the pilot, up to the end of the present stage while it lasts.
    pub fn pilot(&self) -> u64 {
        self.pilot.unwrap_or(self.stage.end)
    }

    /// Tosses that count at the end of the present stage.
    pub fn counted(&self) -> u64 {
        self.stage.end - self.pilot()
    }

    /// Tosses that the present stage would have without a limit; infinite if no number meets the targets, as
    /// far as the pilot can tell.
    pub(crate) fn wanted(&self) -> f64 {
        self.wanted
    }

    /// Whether the pilot shows that no number of tosses meets the targets, as too many of them end without a face.
    pub fn is_hopeless(&self) -> bool {
        self.hopeless
    }

    /// Confidence of the intervals at the end of the present stage, so that all looks together have that
    /// of the plan.
    pub fn confidence(&self) -> f64 {
        1.0 - self.alpha * self.share()
    }

    fn share(&self) -> f64 {
        let left = if self.looked == 0 {
            1.0
        } else {
            (1.0 - FIRST_SHARE) * 0.5_f64.powi(self.looked - 1)
        };
        match self.looked {
            _ if self.stage.end == self.limit => left,
            0 => FIRST_SHARE,
            _ => 0.5 * left,
        }
    }

    /// Looks at the tally of the tosses that count, or of the pilot, at the end of the present stage, and
    /// goes on to the next.
    pub fn look(&mut self, tally: &Tally) -> Verdict {
        let Some(pilot) = self.pilot else {
            self.size(tally);
            return Verdict::More;
        };
        let faces = faces(tally, self.confidence());
        if self.targets.are_met(&faces) {
            return Verdict::Met;
        }
        if self.stage.end == self.limit {
            return Verdict::Short;
        }
        self.looked += 1;
        // looked at twice as late, the smaller share of α would hardly be met
        let more = 2 * (self.stage.end - pilot);
        self.wanted = more as f64;
        self.stage = self.stage.end..self.limit.min(self.stage.end.saturating_add(more));
        Verdict::More
    }

    /// Lets the present stage, which must not have begun, make at most `tosses`, and be the last.
    pub(crate) fn end_after(&mut self, tosses: u64) {
        if tosses == 0 && self.looked > 0 {
            // what was seen last is final
            self.looked -= 1;
        }
        self.stage.end = self.stage.end.min(self.stage.start.saturating_add(tosses));
        self.limit = self.stage.end;
    }

    /// Tosses, those of the pilot included, after which the targets are met or the limit is reached, judged
    /// by some of them.
    ///
    /// # Panics
    /// If the tally is empty.
    pub fn forecast(&self, tally: &Tally) -> u64 {
        assert!(tally.tosses() > 0);
        let (confidence, undecided) = (self.first_confidence(), self.hoped_undecided(tally));
        let needed = self.needed((tally, 1.0), undecided.unwrap_or(0.0), 0.0, confidence);
        if self.limit < LEAST_WITH_PILOT {
            return ceil(needed).min(self.limit);
        }
        let mut pilot = PILOT;
        loop {
            let at_most = self.needed_at_most((tally, pilot as f64), undecided, needed);
            if !self.pilot_goes_on(pilot, needed, at_most) {
                return ceil(at_most).saturating_add(pilot).min(self.limit);
            }
            pilot *= 2;
        }
    }

    /// Lets the pilot be a part of at most `tosses` in all.
    pub(crate) fn limit_pilot(&mut self, tosses: u64) {
        self.limit_of_pilot = self.limit_of_pilot.min(tosses);
    }

    /// Makes the pilot twice as long, or sizes the first stage that counts.
    fn size(&mut self, tally: &Tally) {
        let made = self.stage.end;
        let undecided = self.hoped_undecided(tally);
        let seen = (tally, tally.tosses() as f64);
        let needed = self.needed(seen, undecided.unwrap_or(0.0), 0.0, self.first_confidence());
        let needed_at_most = self.needed_at_most(seen, undecided, needed);
        if self.pilot_goes_on(made, needed, needed_at_most) {
            self.stage = made..2 * made;
            return;
        }
        self.pilot = Some(made);
        self.wanted = needed_at_most;
        let counted = ceil(needed_at_most).checked_next_multiple_of(MULTIPLE);
        let end = made.saturating_add(counted.unwrap_or(u64::MAX));
        self.stage = made..end.min(self.limit);
        if undecided.is_none() {
            self.hopeless = true;
            self.limit = self.stage.end;
        }
    }

    /// The confidence of the first look.
    fn first_confidence(&self) -> f64 {
        1.0 - FIRST_SHARE * self.alpha
    }

    /// The share of undecided tosses, if some number of tosses meets the targets in spite of it. Without hope as many are
    /// made as if all had a face: more would not make the intervals much shorter.
    fn hoped_undecided(&self, tally: &Tally) -> Option<f64> {
        self.lets_hope(tally, self.first_confidence())
            .then(|| share_undecided(tally))
    }

    /// Tosses at which the first look is, with the margin for the error of so many, where `needed` are without.
    fn needed_at_most(&self, seen: (&Tally, f64), undecided: Option<f64>, needed: f64) -> f64 {
        let undecided = undecided.unwrap_or(0.0);
        self.needed(seen, undecided, MARGIN, self.first_confidence())
            .min(MOST_MARGIN * needed)
    }

    /// Whether a pilot of so many tosses becomes twice as long, as it says that so many are needed and, by its own error,
    /// at most so many.
    fn pilot_goes_on(&self, made: u64, needed: f64, needed_at_most: f64) -> bool {
        let most = self.limit_of_pilot as f64;
        // the margin shrinks like 1/√n
        let is_worth = if needed < most {
            (needed_at_most - needed) * (1.0 - FRAC_1_SQRT_2) > made as f64
        } else {
            made as f64 * 32.0 < most
        };
        is_worth && made <= self.limit_of_pilot / 8
    }

    /// Whether some number of tosses meets the targets with so few undecided ones as the tally allows, or none
    /// would without any.
    fn lets_hope(&self, tally: &Tally, confidence: f64) -> bool {
        let (n, share) = (tally.tosses() as f64, share_undecided(tally));
        let least = share - SURE * (share * (1.0 - share) / n).sqrt();
        if least <= 0.0 {
            return true;
        }
        let needed = |undecided| self.needed((tally, n), undecided, 0.0, confidence);
        needed(least).is_finite() || needed(0.0).is_infinite()
    }

    /// Tosses after which the targets are met, if this share of them is undecided and the probabilities are
    /// those of the tally, or any that `errors` standard errors of `n` tosses like its own allow; infinite if no number
    /// will do.
    fn needed(
        &self,
        (tally, n): (&Tally, f64),
        undecided: f64,
        errors: f64,
        confidence: f64,
    ) -> f64 {
        let share = n / tally.tosses() as f64;
        let of_face = |face| {
            let k = tally.count(face) as f64 * share;
            let arm = errors * (k * (n - k) / n).sqrt();
            let [least, most] = [k - arm, k + arm].map(|count| (count / n).clamp(0.0, 1.0));
            [least, k / n, most, 0.5_f64.clamp(least, most)]
        };
        let ps = self.targets.faces().flat_map(of_face);
        let needed = ps.map(|p| Self::solve(p, |n| self.excess_at(p, undecided, n, confidence)));
        // what whole counts leave
        1.003 * needed.fold(0.0, f64::max)
    }

    /// The number of tosses whose excess is 1; infinite if it is beyond reason.
    fn solve(p: f64, excess: impl Fn(f64) -> f64) -> f64 {
        // no count is 0 where the face was seen
        let least = if p > 0.0 { 4.0 / p } else { 0.0 };
        if excess(MOST) > 1.0 {
            return f64::INFINITY;
        }
        let mut n = least.clamp(MULTIPLE as f64, MOST);
        // Intervals that shrink like 1/√n and exceed their targets by the factor √e need e n tosses; those of a face
        // that is never seen shrink like 1/n and need √e n. Steps by √e converge for both: where e n are needed, the
        // logarithm of what is missing halves each time.
        for _ in 0..24 {
            n = (n * excess(n).sqrt()).max(1.0);
            if n > MOST {
                return f64::INFINITY;
            }
        }
        n
    }

    /// By which factor `n` tosses are too few for a face of this probability: by Wilson's interval, and one
    /// toss more on either side. So much longer, or a little less, is the interval that counts, which costs a
    /// hundred times as much to compute.
    fn excess_at(&self, p: f64, undecided: f64, n: f64, confidence: f64) -> f64 {
        // at most 1e15, so whole numbers are exact; a count is never more than is left
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let [seen, unseen, tosses] =
            [p * n, (undecided * n).min(n - p * n), n].map(|count| libm::floor(count) as u64);
        let wilson = Estimate::new(seen, unseen, tosses, confidence, IntervalMethod::Wilson);
        self.targets.excess(&[Estimate {
            lo: wilson.lo - 1.0 / n,
            hi: wilson.hi + 1.0 / n,
            ..wilson
        }])
    }
}

fn share_undecided(tally: &Tally) -> f64 {
    tally.undecided() as f64 / tally.tosses() as f64
}

/// At least 1; saturates, and then a limit is what stops.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn ceil(tosses: f64) -> u64 {
    tosses.ceil().max(1.0) as u64
}

/// The estimates of all faces at a look. Only Clopper and Pearson's interval has at least the stated
/// confidence at every probability and number of tosses, which the sum over looks requires.
fn faces(tally: &Tally, confidence: f64) -> [Estimate; 3] {
    let (undecided, n) = (tally.undecided(), tally.tosses());
    let method = IntervalMethod::ClopperPearson;
    Face::ALL.map(|face| Estimate::new(tally.count(face), undecided, n, confidence, method))
}

#[cfg(test)]
mod tests;
