//! The counts of a run directory chunk by chunk, to see how an estimate converged.

use super::chunk_result::ChunkResult;
use super::cut::Cut;
use super::tallies::{Entry, Tallies};
use super::{Chunk, RunError};
use crate::plan::Plan;
use coinmc_core::Tally;
use std::path::Path;

/// The chunks of tosses that a run directory holds, by point and in the order of their tosses. Integrated
/// points have none. Nothing in the directory is changed; rejected tallies are left out.
///
/// `plan` is that of the run, as [`stored_plan`](super::stored_plan) or
/// [`stored_report`](super::stored_report) return it; files of another plan are left out.
///
/// # Errors
/// [`RunError::Io`] if the directory cannot be read.
///
/// # Example
/// ```no_run
/// # fn example() -> Result<(), coinmc::run::RunError> {
/// let dir = std::path::Path::new("runs/first");
/// let plan = coinmc::run::stored_plan(dir)?;
/// for (chunk, tally) in coinmc::run::stored_chunks(dir, &plan)? {
///     println!("{chunk}: {} on the side", tally.side);
/// }
/// # Ok(())
/// # }
/// ```
pub fn stored_chunks(dir: &Path, plan: &Plan) -> Result<Vec<(Chunk, Tally)>, RunError> {
    let mut chunks = Vec::new();
    Tallies::of(dir, plan.hash()).scan(plan, &Cut::new(plan), |entry| {
        if let Entry::Finished(chunk, result) = entry
            && let ChunkResult::Tossed(tossed) = *result
        {
            chunks.push((chunk, tossed.tally));
        }
        Ok(())
    })?;
    let place = |(chunk, _): &(Chunk, Tally)| (chunk.point, chunk.tosses.start);
    // stable: of a chunk that occurs twice the first counts
    chunks.sort_by_key(place);
    chunks.dedup_by_key(|chunk| place(chunk));
    Ok(chunks)
}
