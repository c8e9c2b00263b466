//! Counts of outcomes: the only thing a run accumulates.

use crate::{Ended, Face, Outcome, ROLL_BOUNDS_M, SideEnding, SideMotion};

/// One counter of a [`Tally`], for whoever writes tallies to a file or a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counter {
    /// Its name.
    pub name: &'static str,
    /// What it counts, in one sentence.
    pub doc: &'static str,
    /// How a toss moves it.
    pub kind: CounterKind,
}

/// How a toss moves a counter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CounterKind {
    /// Every toss adds 1 to exactly one counter of this kind or of [`EdgeEnding`](Self::EdgeEnding).
    Ending,
    /// A toss adds at most 1.
    Toss,
    /// A toss adds any number that fits into 32 bits.
    Event,
    /// An impact adds at most 1, and only under a law of impact that breaks down.
    Breakdown,
    /// A toss on the side adds at most 1, in an engine that knows how it came to end there.
    SideEnding,
    /// An ending that only a table with an edge has.
    EdgeEnding,
}

/// Defines [`Tally`] from one list of counters: name, kind, and what each counts.
macro_rules! tally {
    ($($name:ident: $kind:ident, $doc:literal;)+) => {
        /// How many tosses ended how. Merging is addition of integers: exact, and the same in any
        /// order.
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
            $(#[doc = $doc] pub $name: u64,)+
        }

        /// Number of counters.
        const COUNT: usize = [$(stringify!($name)),+].len();

        impl Tally {
            /// All counters, in the order of [`to_array`](Self::to_array).
            pub const COUNTERS: [Counter; COUNT] = [$(Counter {
                name: stringify!($name),
                doc: $doc,
                kind: CounterKind::$kind,
            }),+];

            /// The counts in the order of [`COUNTERS`](Self::COUNTERS), for writing to a file.
            pub fn to_array(&self) -> [u64; COUNT] {
                [$(self.$name),+]
            }

            /// The reverse of [`to_array`](Self::to_array).
            pub fn from_array(counts: [u64; COUNT]) -> Self {
                let [$($name),+] = counts;
                Self { $($name),+ }
            }
        }
    };
}

tally! {
    heads: Ending, "Tosses that show heads.";
    tails: Ending, "Tosses that show tails.";
    side: Ending, "Tosses on the side.";
    time_limit: Ending, "Undecided at the limit of simulated time.";
    never_settles: Ending, "Undecided forever: provably never at rest on a face.";
    impact_limit: Ending, "Undecided at the limit of impacts or of steps in contact.";
    failed: Ending, "Undecided because a number became NaN or infinite.";
    impacts: Event, "Impacts, in all tosses.";
    contact_steps: Event, "Steps in sustained contact, in all tosses.";
    jams: Event, "Tangential impacts in Painlevé configurations, in all tosses.";
    overruled: Toss, "Tosses that the chosen stopping rule decides otherwise than the energy rule.";
    negative_heights: Breakdown,
        "Impacts at which the law of impact required a negative height of rebound, in all tosses.";
    energy_gains: Breakdown,
        "Impacts at which the law of impact would have gained energy, in all tosses.";
    wrong_levers: Breakdown,
        "Impacts at which the law's lever turned the coin the wrong way, in all tosses.";
    sinkings: Breakdown,
        "Impacts after which the corner would have continued into the surface, in all tosses.";
    unresolved: Breakdown, "Impacts whose integration in time was given up, in all tosses.";
    side_rested: SideEnding, "Tosses on the side that came to rest where they landed.";
    side_rolled: SideEnding, "Tosses on the side that rolled along it, by more than the radius.";
    side_spun: SideEnding, "Tosses on the side that turned about the vertical, more than once.";
    rolled_1_cm: SideEnding, "Tosses on the side that rolled more than 1 cm.";
    rolled_3_cm: SideEnding, "Tosses on the side that rolled more than 3 cm.";
    rolled_10_cm: SideEnding, "Tosses on the side that rolled more than 10 cm.";
    rolled_30_cm: SideEnding, "Tosses on the side that rolled more than 30 cm.";
    rolled_1_m: SideEnding, "Tosses on the side that rolled more than 1 m.";
    rolled_3_m: SideEnding, "Tosses on the side that rolled more than 3 m.";
    rolled_10_m: SideEnding, "Tosses on the side that rolled more than 10 m.";
    same: Toss, "Tosses that show the face that was up at their launch.";
    left: EdgeEnding, "Tosses that left the table over its edge.";
}

impl Tally {
    /// Counts one toss, and whether it shows the face that was up at its launch.
    pub fn add_started(&mut self, outcome: &Outcome, up: Option<Face>) {
        self.add(outcome);
        self.same += u64::from(up.is_some() && outcome.face() == up);
    }

    /// Counts one toss of which it is not known how it began.
    pub fn add(&mut self, outcome: &Outcome) {
        match outcome.ended {
            Ended::Decided(Face::Heads) => self.heads += 1,
            Ended::Decided(Face::Tails) => self.tails += 1,
            Ended::Decided(Face::Side) => self.side += 1,
            Ended::Left => self.left += 1,
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
        if let Some(ending) = outcome.side_ending {
            self.add_side_ending(ending);
        }
    }

    fn add_side_ending(&mut self, ending: SideEnding) {
        match ending.motion {
            SideMotion::Rested => self.side_rested += 1,
            SideMotion::Rolled => self.side_rolled += 1,
            SideMotion::Spun => self.side_spun += 1,
        }
        for counter in self
            .rolled_mut()
            .into_iter()
            .take(ending.roll_bounds_passed.into())
        {
            *counter += 1;
        }
    }

    /// Tosses on the side that rolled more than each of [`ROLL_BOUNDS_M`](crate::ROLL_BOUNDS_M).
    pub fn rolled(&self) -> [u64; ROLL_BOUNDS_M.len()] {
        let mut tally = *self;
        tally.rolled_mut().map(|count| *count)
    }

    fn rolled_mut(&mut self) -> [&mut u64; ROLL_BOUNDS_M.len()] {
        [
            &mut self.rolled_1_cm,
            &mut self.rolled_3_cm,
            &mut self.rolled_10_cm,
            &mut self.rolled_30_cm,
            &mut self.rolled_1_m,
            &mut self.rolled_3_m,
            &mut self.rolled_10_m,
        ]
    }

    /// Adds another tally's counts; `None` if a counter of tosses would overflow (only forged input can).
    /// Counters of what may happen several times in a toss stay at 2^64 − 1 instead.
    #[must_use]
    pub fn checked_merge(&self, other: &Self) -> Option<Self> {
        let (a, b) = (self.to_array(), other.to_array());
        let mut sum = [0; COUNT];
        for ((sum, counter), (a, b)) in sum.iter_mut().zip(&Self::COUNTERS).zip(a.iter().zip(b)) {
            *sum = match counter.kind {
                CounterKind::Event | CounterKind::Breakdown => a.saturating_add(b),
                _ => a.checked_add(b)?,
            };
        }
        Some(Self::from_array(sum))
    }

    /// Adds another tally's counts.
    ///
    /// # Panics
    /// If a counter of tosses would exceed `u64`; no run of real tosses can get there. Counts that come
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

    /// Tosses of which it is not known how they end, for whatever reason. (Those that left the table
    /// are no such tosses.)
    pub fn undecided(&self) -> u64 {
        self.time_limit + self.never_settles + self.impact_limit + self.failed
    }

    /// All tosses, those that left the table and undecided ones included.
    pub fn tosses(&self) -> u64 {
        self.heads + self.tails + self.side + self.left + self.undecided()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of forged files: counts of tosses that exceed 64 bits are refused, counts of events stay at the largest.
    #[test]
    fn sums_beyond_64_bits_are_refused_for_tosses_and_bounded_for_events() {
        let tally = |heads, impacts| Tally {
            heads,
            impacts,
            ..Tally::default()
        };
        let most = tally(1, u64::MAX - 1);
        assert_eq!(most.checked_merge(&tally(2, 7)), Some(tally(3, u64::MAX)));
        assert_eq!(tally(u64::MAX, 0).checked_merge(&most), None);
    }
}
