//! The tosses of a chunk on several threads.

use super::chunk::run_chunk_while;
use super::provenance::{Effort, Stopwatch};
use super::{Chunk, RunError};
use crate::plan::Plan;
use coinmc_core::Tally;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::thread;

/// The counts of a chunk, which do not depend on the threads, and the time of all of them; `None` if `go_on`
/// returned false.
pub(super) fn tossed(
    plan: &Plan,
    chunk: &Chunk,
    threads: NonZeroUsize,
    go_on: &(impl Fn() -> bool + Sync),
) -> Result<Option<(Tally, Effort)>, RunError> {
    let point = chunk.point;
    let piece = |tosses| {
        let watch = Stopwatch::start();
        let tally = run_chunk_while(plan, &Chunk { point, tosses }, go_on)?;
        Ok(tally.map(|tally| (tally, watch.effort())))
    };
    if threads.get() == 1 {
        return piece(chunk.tosses.clone());
    }
    let (mut sum, mut effort) = (Tally::default(), Effort::NONE);
    thread::scope(|scope| {
        let piece = &piece;
        let spawn = |tosses| thread::Builder::new().spawn_scoped(scope, move || piece(tosses));
        let workers: Result<Vec<_>, _> = pieces(&chunk.tosses, threads).map(spawn).collect();
        for worker in workers.map_err(RunError::Thread)? {
            let done = worker.join();
            let Some((tally, its)) =
                done.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?
            else {
                return Ok(None);
            };
            sum.merge(&tally);
            effort = effort.and(its);
        }
        Ok(Some((sum, effort)))
    })
}

/// Adjacent ranges of nearly the same length.
fn pieces(tosses: &Range<u64>, threads: NonZeroUsize) -> impl Iterator<Item = Range<u64>> {
    let (start, of) = (tosses.start, threads.get() as u64);
    let length = tosses.end.saturating_sub(start);
    // the first pieces have one more where it does not come out even
    let bound = move |i: u64| start + length / of * i + i.min(length % of);
    let all = (0..of).map(move |i| bound(i)..bound(i + 1));
    all.filter(|piece| !piece.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::schedule::tests::plan_of_one;

    #[test]
    fn counts_do_not_depend_on_the_threads() {
        let plan = plan_of_one("tosses = 1000");
        let (point, tosses) = (0, 5..1000);
        let chunk = Chunk { point, tosses };
        let counts = [1, 2, 7].map(|threads| {
            let threads = NonZeroUsize::new(threads).unwrap();
            let done = tossed(&plan, &chunk, threads, &|| true).unwrap();
            done.unwrap().0
        });
        assert_eq!(counts[0].tosses(), 995);
        assert_eq!([counts[0]; 2], counts[1..]);
        let stopped = tossed(&plan, &chunk, NonZeroUsize::new(3).unwrap(), &|| false);
        assert_eq!(stopped.unwrap(), None);
    }

    #[test]
    fn pieces_are_the_whole_and_nearly_equal() {
        for (tosses, threads) in [(5..5, 3), (5..7, 3), (0..100, 7), (1..u64::MAX, 64)] {
            let pieces: Vec<_> = pieces(&tosses, NonZeroUsize::new(threads).unwrap()).collect();
            let lengths = pieces.iter().map(|piece| piece.end - piece.start);
            assert_eq!(lengths.clone().sum::<u64>(), tosses.end - tosses.start);
            assert!(pieces.windows(2).all(|pair| pair[0].end == pair[1].start));
            let (least, most) = (lengths.clone().min(), lengths.max());
            assert!(most.unwrap_or(0) - least.unwrap_or(0) <= 1);
        }
    }
}
