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
