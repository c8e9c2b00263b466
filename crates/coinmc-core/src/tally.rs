//! Counts of outcomes: the only thing a run accumulates.

use crate::{Ended, Face, Outcome};

/// How many tosses ended how. Merging is addition of integers: exact, and the same in any order.
///
/// # Example
/// ```
/// use coinmc_core::{Ended, Face, Outcome, Tally};
/// let mut tally = Tally::default();
/// tally.add(&Outcome::decided(Face::Heads));
/// tally.add(&Outcome { ended: Ended::TimeLimit, ..Outcome::decided(Face::Heads) });
/// assert_eq!((tally.heads, tally.undecided(), tally.tosses()), (1, 1, 2));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// Tosses that show heads.
    pub heads: u64,
    /// Tosses that show tails.
    pub tails: u64,
    /// Tosses on the side.
    pub side: u64,
    /// Undecided at the limit of simulated time.
    pub time_limit: u64,
    /// Undecided for ever.
    pub never_settles: u64,
    /// Undecided at the limit of impacts.
    pub impact_limit: u64,
    /// Numbers that went wrong.
    pub failed: u64,
    /// Impacts, summed over tosses.
    pub impacts: u64,
    /// Steps in sustained contact, summed over tosses.
    pub contact_steps: u64,
    /// Tangential impacts in Painlevé configurations, summed over tosses.
    pub jams: u64,
    /// Tosses that a stopping rule decided and the certain rule decides otherwise.
    pub overruled: u64,
    /// Impacts at which the law asked for a negative height of rebound, summed over tosses.
    pub negative_heights: u64,
    /// Impacts at which the law would have gained energy, summed over tosses.
    pub energy_gains: u64,
    /// Impacts at which the law's lever turned the coin the wrong way, summed over tosses.
    pub wrong_levers: u64,
    /// Impacts after which the corner would have gone on into the surface, summed over tosses.
    pub sinkings: u64,
    /// Impacts whose integration was given up, summed over tosses.
    pub unresolved: u64,
}

/// Number of counters.
const COUNT: usize = 16;

impl Tally {
    /// Names of the counters, in the order of [`to_array`](Self::to_array).
    pub const COUNTERS: [&'static str; COUNT] = [
        "heads",
        "tails",
        "side",
        "time_limit",
        "never_settles",
        "impact_limit",
        "failed",
        "impacts",
        "contact_steps",
        "jams",
        "overruled",
        "negative_heights",
        "energy_gains",
        "wrong_levers",
        "sinkings",
        "unresolved",
    ];

    /// Counters that laws of impact without breakdowns never move: the last ones of
    /// [`COUNTERS`](Self::COUNTERS), from this place on.
    pub const FIRST_BREAK: usize = 11;

    /// Counts one toss.
    pub fn add(&mut self, outcome: &Outcome) {
        match outcome.ended {
            Ended::Decided(Face::Heads) => self.heads += 1,
            Ended::Decided(Face::Tails) => self.tails += 1,
            Ended::Decided(Face::Side) => self.side += 1,
            Ended::TimeLimit => self.time_limit += 1,
            Ended::NeverSettles => self.never_settles += 1,
            Ended::ImpactLimit => self.impact_limit += 1,
            Ended::Failed => self.failed += 1,
        }
        self.impacts += u64::from(outcome.impacts);
        self.contact_steps += u64::from(outcome.contact_steps);
        self.jams += u64::from(outcome.jams);
        self.overruled += u64::from(outcome.overruled);
        let breaks = &outcome.breaks;
        self.negative_heights += u64::from(breaks.negative_heights);
        self.energy_gains += u64::from(breaks.energy_gains);
        self.wrong_levers += u64::from(breaks.wrong_levers);
        self.sinkings += u64::from(breaks.sinkings);
        self.unresolved += u64::from(breaks.unresolved);
    }

    /// Adds another tally's counts; `None` if a counter would overflow (only forged input can).
    #[must_use]
    pub fn checked_merge(&self, other: &Self) -> Option<Self> {
        let (a, b) = (self.to_array(), other.to_array());
        let mut sum = [0; COUNT];
        for (sum, (a, b)) in sum.iter_mut().zip(a.iter().zip(b)) {
            *sum = a.checked_add(b)?;
        }
        Some(Self::from_array(sum))
    }

    /// Adds another tally's counts.
    ///
    /// # Panics
    /// If a counter would exceed `u64`; no run of real tosses can get there. Counts that come
    /// from a file go through [`checked_merge`](Self::checked_merge).
    pub fn merge(&mut self, other: &Self) {
        *self = self.checked_merge(other).expect("fewer than 2^64 tosses");
    }

    /// Tosses with this face.
    pub fn count(&self, face: Face) -> u64 {
        match face {
            Face::Heads => self.heads,
            Face::Tails => self.tails,
            Face::Side => self.side,
        }
    }

    /// Tosses that ended without a face, for whatever reason.
    pub fn undecided(&self) -> u64 {
        self.time_limit + self.never_settles + self.impact_limit + self.failed
    }

    /// All tosses, undecided ones included.
    pub fn tosses(&self) -> u64 {
        self.heads + self.tails + self.side + self.undecided()
    }

    /// The counters in the order of [`COUNTERS`](Self::COUNTERS), for writing to a file.
    pub fn to_array(&self) -> [u64; COUNT] {
        [
            self.heads,
            self.tails,
            self.side,
            self.time_limit,
            self.never_settles,
            self.impact_limit,
            self.failed,
            self.impacts,
            self.contact_steps,
            self.jams,
            self.overruled,
            self.negative_heights,
            self.energy_gains,
            self.wrong_levers,
            self.sinkings,
            self.unresolved,
        ]
    }

    /// The reverse of [`to_array`](Self::to_array).
    pub fn from_array(counts: [u64; COUNT]) -> Self {
        let [
            heads,
            tails,
            side,
            time_limit,
            never_settles,
            impact_limit,
            failed,
            impacts,
            contact_steps,
            jams,
            overruled,
            negative_heights,
            energy_gains,
            wrong_levers,
            sinkings,
            unresolved,
        ] = counts;
        Self {
            heads,
            tails,
            side,
            time_limit,
            never_settles,
            impact_limit,
            failed,
            impacts,
            contact_steps,
            jams,
            overruled,
            negative_heights,
            energy_gains,
            wrong_levers,
            sinkings,
            unresolved,
        }
    }
}
