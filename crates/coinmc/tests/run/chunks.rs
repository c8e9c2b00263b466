//! The chunks of a run: their numbers, and what is stored of them.

use crate::support::{FIXED, HALF_WIDTH, plan, run_whole};
use coinmc::plan::Plan;
use coinmc::run::{Chunk, chunks, numbered_chunk, stored_chunks};
use coinmc_core::Tally;
use tempfile::tempdir;

/// All chunks of a plan, in the order of their numbers.
fn numbered(plan: &Plan) -> Vec<Chunk> {
    let numbers = 0..chunks(plan).unwrap();
    numbers
        .map(|number| numbered_chunk(plan, number).unwrap())
        .collect()
}

/// Executors ask for chunks by number: together they are the whole run, each toss once.
#[test]
fn the_numbers_of_chunks_are_those_of_a_whole_run() {
    let (plan, adaptive) = (plan(FIXED), plan(HALF_WIDTH));
    let numbered = numbered(&plan);
    assert_eq!(numbered_chunk(&plan, numbered.len() as u64), None);
    for point in 0..plan.points.len() {
        let mut of_point = numbered.iter().filter(|chunk| chunk.point == point);
        let end = of_point.try_fold(0, |end, chunk| {
            (chunk.tosses.start == end).then_some(chunk.tosses.end)
        });
        assert_eq!(end, Some(40_000), "{point}");
    }
    assert_eq!(chunks(&adaptive), None);
}

#[test]
fn what_is_stored_of_chunks_adds_up_to_the_rows() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    let report = run_whole(&plan, dir.path());
    let stored = stored_chunks(dir.path(), &plan).unwrap();
    assert!(stored.iter().map(|(chunk, _)| chunk).eq(&numbered(&plan)));
    for (point, row) in report.results.rows.each().enumerate() {
        let mut sum = Tally::default();
        for (_, tally) in stored.iter().filter(|(chunk, _)| chunk.point == point) {
            sum.merge(tally);
        }
        assert_eq!(sum, row.tally);
    }
}
