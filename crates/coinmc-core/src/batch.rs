//! Batches of tosses: launches go in while there is room, and ends come out in any order.

use crate::Launch;
use crate::engine::AT_ONCE;
use std::ops::ControlFlow;

/// The tosses that an engine has in flight at the same time.
///
/// It is independent of the source of launches and of the receiver of ends, so it is compiled only
/// once.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, Domain, Launch, Preset, Stream, TossBatch};
/// use std::ops::ControlFlow;
///
/// /// Two tosses at a time that end at their launch.
/// #[derive(Default)]
/// struct Heights(u64, Vec<(u64, f64)>);
///
/// impl TossBatch for Heights {
///     type End = f64;
///     fn has_room(&self) -> bool {
///         self.1.len() < 2
///     }
///     fn launch(&mut self, launch: &Launch) {
///         self.1.push((self.0, launch.height_m));
///         self.0 += 1;
///     }
///     fn advance(&mut self) -> bool {
///         false
///     }
///     fn ended(&mut self) -> &mut Vec<(u64, f64)> {
///         &mut self.1
///     }
/// }
///
/// let (coin, stream) = (Coin::cylinder(1.0, 0.01)?, Stream::new(1, Domain::Launch, 0));
/// let distribution = Preset::Robot.distribution();
/// let launches = (0..5).map(|toss| distribution.launch(&coin, &mut stream.toss(toss)));
/// let mut seen = vec![];
/// Heights::default().toss_all_in_batch(launches, |ended| {
///     seen.extend(ended.iter().map(|(number, _)| *number));
///     ControlFlow::Continue(())
/// });
/// assert_eq!(seen, [0, 1, 2, 3, 4]);
/// # Ok::<(), coinmc_core::CoinError>(())
/// ```
pub trait TossBatch {
    /// The result of a toss.
    type End;

    /// Whether one more toss may be launched. The number is bounded even for tosses that end at
    /// once, since their ends are kept until they are passed on.
    fn has_room(&self) -> bool;

    /// Launches a toss if there is room. Tosses are numbered in order of launch, from 0.
    fn launch(&mut self, launch: &Launch);

    /// Does one step of work; `false` if no toss is in flight.
    fn advance(&mut self) -> bool;

    /// Tosses that have ended and have not been passed on, with their numbers.
    fn ended(&mut self) -> &mut Vec<(u64, Self::End)>;

    /// Computes the tosses of all launches and passes on their ends, some at a time, each with the
    /// number of its toss, until `sink` breaks.
    fn toss_all_in_batch(
        mut self,
        mut launches: impl Iterator<Item = Launch>,
        mut sink: impl FnMut(&[(u64, Self::End)]) -> ControlFlow<()>,
    ) where
        Self: Sized,
    {
        let mut more = true;
        loop {
            while more && self.has_room() {
                match launches.next() {
                    Some(launch) => self.launch(&launch),
                    None => more = false,
                }
            }
            let idle = !self.advance();
            let ended = self.ended();
            if idle && ended.is_empty() {
                return;
            }
            if idle || ended.len() >= AT_ONCE {
                if sink(ended).is_break() {
                    return;
                }
                ended.clear();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{self, launches};

    /// A toss in flight: its number, its launch, and the steps that it still takes.
    type Flying = (u64, Launch, u32);

    /// Tosses that take from one step to five and end as they began. It refuses what its caller must not
    /// do: launch without room, or work on when all is done.
    struct Slots {
        room: usize,
        launched: u64,
        flying: Vec<Flying>,
        ended: Vec<(u64, Launch)>,
        idle: u64,
    }

    impl Slots {
        fn new(room: usize) -> Self {
            Self {
                room,
                launched: 0,
                flying: Vec::new(),
                ended: Vec::new(),
                idle: 0,
            }
        }
    }

    impl TossBatch for Slots {
        type End = Launch;

        fn has_room(&self) -> bool {
            self.flying.len() + self.ended.len() < self.room
        }

        fn launch(&mut self, launch: &Launch) {
            assert!(self.has_room());
            let steps = 1 + [3, 0, 4, 1, 2][self.flying.len() % 5];
            self.flying.push((self.launched, *launch, steps));
            self.launched += 1;
        }

        fn advance(&mut self) -> bool {
            if self.flying.is_empty() {
                self.idle += 1;
                // each time but the last an end was passed on
                assert!(self.idle <= self.launched + 1, "all is done");
                return false;
            }
            for (number, launch, steps) in &mut self.flying {
                *steps -= 1;
                if *steps == 0 {
                    self.ended.push((*number, *launch));
                }
            }
            self.flying.retain(|(_, _, steps)| *steps > 0);
            true
        }

        fn ended(&mut self) -> &mut Vec<(u64, Launch)> {
            &mut self.ended
        }
    }

    /// Launches that may not be asked for more once they have ended.
    fn once(launches: &[Launch]) -> impl Iterator<Item = Launch> {
        let end = std::iter::once_with(|| -> Option<Launch> { None });
        let after = std::iter::repeat_with(|| unreachable!("asked again after the end"));
        let mut all = launches.iter().copied().map(Some).chain(end).chain(after);
        std::iter::from_fn(move || all.next().flatten())
    }

    /// What is passed on to a sink that breaks at this call.
    fn passed_on(room: usize, launches: &[Launch], breaks_at: usize) -> Vec<Vec<(u64, Launch)>> {
        testing::passed_on(breaks_at, |sink| {
            Slots::new(room).toss_all_in_batch(once(launches), sink);
        })
    }

    #[test]
    fn every_launch_ends_once_under_its_number() {
        let launches = launches(200);
        for room in [1, 10, AT_ONCE, 100, 1000] {
            for tosses in [0, 1, 200] {
                let launches = &launches[..tosses];
                let mut ended = passed_on(room, launches, usize::MAX).concat();
                ended.sort_by_key(|(number, _)| *number);
                let numbered: Vec<_> = (0..).zip(launches.iter().copied()).collect();
                assert_eq!(ended, numbered);
            }
        }
    }

    /// Calls of the sink cost; but ends that take up all room are passed on.
    #[test]
    fn ends_are_passed_on_many_at_a_time_or_when_the_room_is_full() {
        let launches = launches(200);
        for (room, least) in [(10, 10), (100, AT_ONCE)] {
            let calls = passed_on(room, &launches, usize::MAX);
            let (last, others) = calls.split_last().unwrap();
            assert!(!last.is_empty() && others.iter().all(|ends| ends.len() >= least));
            assert!(others.len() > 1);
        }
    }

    #[test]
    fn a_sink_that_breaks_is_given_no_more() {
        let launches = launches(200);
        let all = passed_on(100, &launches, usize::MAX);
        assert_eq!(passed_on(100, &launches, 2), all[..2]);
    }
}
