//! How a run is cut into chunks: a function of the plan alone, so that neither threads nor parts
//! nor a restart change what is counted.

use super::Chunk;
use crate::plan::{FIRST_LOOK, Plan, Stop, Targets, looks};
use std::ops::Range;

/// Fewest tosses of a chunk, except the last of a point: some 30 ms of work in the plane, more in
/// space, which hides the cost of a file.
const LEAST: u64 = FIRST_LOOK;
/// Most tosses of a chunk of a run of fixed length, unless that made too many chunks: a tenth of a
/// second of work in the plane, up to a few seconds in space.
const LARGE: u64 = 1 << 17;
/// A run of fixed length has about this many chunks before they are made larger than [`LARGE`] …
const ENOUGH_CHUNKS: u64 = 256;
/// … and at most this many, or one per point. Time-stepped tosses are so slow that their runs have as
/// many from the start.
const MOST_CHUNKS: u64 = 8192;
/// Most chunks of a stage after the first.
const CHUNKS_A_STAGE: u64 = 16;

/// Tosses per chunk of a run that makes `total` tosses.
fn fixed_size(total: u64, plan: &Plan) -> u64 {
    let of_at_most = |chunks: u64| {
        let size = total.div_ceil(chunks).checked_next_power_of_two();
        size.unwrap_or(1 << 63)
    };
    let mut engines = plan.points.iter().map(|point| &point.engine);
    let stepped = engines.any(|engine| engine.descriptor().stepped);
    let enough = if stepped { MOST_CHUNKS } else { ENOUGH_CHUNKS };
    let size = of_at_most(enough).clamp(LEAST, LARGE);
    size.max(of_at_most(MOST_CHUNKS))
}

/// The cut of one plan.
///
/// A point's tosses are divided into stages, each of which ends with a look at the point: one stage for
/// a fixed number of tosses, otherwise one per look. A stage is divided into chunks of equal size; the
/// last may be shorter.
#[derive(Debug, Clone)]
pub(super) struct Cut {
    /// Where each stage ends.
    ends: Vec<u64>,
    /// Size of a chunk where the number of tosses is fixed.
    fixed: Option<u64>,
}

impl Cut {
    pub(super) fn new(plan: &Plan) -> Self {
        match plan.stop {
            Stop::Tosses(tosses) => {
                let total = tosses.saturating_mul(plan.points_tossed());
                Self {
                    ends: vec![tosses],
                    fixed: Some(fixed_size(total, plan)),
                }
            }
            Stop::Targets(Targets { max_tosses, .. }) => Self {
                ends: looks(max_tosses).collect(),
                fixed: None,
            },
        }
    }

    /// Number of stages of a point.
    pub(super) fn stages(&self) -> usize {
        self.ends.len()
    }

    /// Tosses of a stage.
    pub(super) fn stage(&self, stage: usize) -> Range<u64> {
        let start = if stage == 0 { 0 } else { self.ends[stage - 1] };
        start..self.ends[stage]
    }

    /// The chunks of a stage of a point, in order. An iterator, as the chunks of a long run would not fit
    /// into memory.
    pub(super) fn chunks(&self, point: usize, stage: usize) -> impl Iterator<Item = Chunk> + use<> {
        let Range { start, end } = self.stage(stage);
        let size = self.size(start);
        let starts = std::iter::successors(Some(start), move |start| start.checked_add(size));
        starts
            .take_while(move |&start| start < end)
            .map(move |start| Chunk {
                point,
                tosses: start..end.min(start.saturating_add(size)),
            })
    }

    /// The chunk of this point that begins at toss `start`, if there is one.
    pub(super) fn chunk_at(&self, point: usize, start: u64) -> Option<Chunk> {
        let stage = self.ends.partition_point(|&end| end <= start);
        (stage < self.stages()).then_some(())?;
        let range = self.stage(stage);
        let size = self.size(range.start);
        (start - range.start).is_multiple_of(size).then(|| {
            let end = range.end.min(start.saturating_add(size));
            Chunk {
                point,
                tosses: start..end,
            }
        })
    }

    /// The chunk's number in the whole run, which decides the part that it belongs to. Only a run of fixed
    /// length has parts.
    pub(super) fn number(&self, chunk: &Chunk) -> u64 {
        if chunk.tosses.is_empty() {
            // integrated: one chunk per point
            return chunk.point as u64;
        }
        let size = self.size(0);
        let chunks_a_point = self.ends[0].div_ceil(size);
        (chunk.point as u64)
            .wrapping_mul(chunks_a_point)
            .wrapping_add(chunk.tosses.start / size)
    }

    fn size(&self, stage_start: u64) -> u64 {
        self.fixed
            .unwrap_or_else(|| LEAST.max(stage_start / CHUNKS_A_STAGE))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    fn plan(points: u32, stop: &str) -> Plan {
        plan_of("flat", points, stop)
    }

    fn plan_of(engine: &str, points: u32, stop: &str) -> Plan {
        let text = format!(
            "seed = 1\n[coin]\nradius_m = 0.01\nratio = {{ from = 1.0, to = 2.0, steps = {points} }}\n\
             [surface]\nrestitution = 0.5\nfriction = 0.3\n[launch]\npreset = \"robot\"\n\
             [engine.{engine}]\n[stop]\n{stop}\n"
        );
        crate::config::parse("test", &text, &[]).unwrap_or_else(|problems| panic!("{problems}"))
    }

    #[test]
    fn chunks_tile_a_point_and_are_found_by_their_start() {
        for (stop, tosses) in [
            ("tosses = 1", 1),
            ("tosses = 16_384", 16_384),
            ("tosses = 1_000_003", 1_000_003),
            ("half_width = 0.01\nmax_tosses = 5", 5),
            ("half_width = 0.01\nmax_tosses = 32_768", 32_768),
            ("half_width = 0.01\nmax_tosses = 10_000_001", 10_000_001),
        ] {
            let cut = Cut::new(&plan(3, stop));
            let chunks = (0..cut.stages()).flat_map(|stage| cut.chunks(1, stage));
            let mut end = 0;
            for chunk in chunks {
                assert_eq!(chunk.tosses.start, end);
                assert!(chunk.tosses.end > end);
                end = chunk.tosses.end;
                assert_eq!(cut.chunk_at(1, chunk.tosses.start), Some(chunk.clone()));
                assert_eq!(
                    cut.chunk_at(1, chunk.tosses.start + 1).is_some(),
                    chunk.tosses.end - chunk.tosses.start == 1 && end < tosses
                );
            }
            assert_eq!(end, tosses, "{stop}");
            assert_eq!(cut.chunk_at(1, tosses), None);
            assert_eq!(cut.chunk_at(1, u64::MAX), None);
        }
    }

    #[test]
    fn a_run_has_a_bounded_number_of_chunks_each_with_a_number_of_its_own() {
        for (points, tosses) in [
            (2, 1_u64),
            (7, 100_000),
            (100, 1_000_000),
            (3, 1_000_000_000_000),
        ] {
            let plan = plan(points, &format!("tosses = {tosses}"));
            let cut = Cut::new(&plan);
            let chunks = (0..plan.points.len()).flat_map(|point| cut.chunks(point, 0));
            let numbers: Vec<u64> = chunks.map(|chunk| cut.number(&chunk)).collect();
            assert!(numbers.len() as u64 <= MOST_CHUNKS + u64::from(points));
            assert_eq!(numbers.iter().collect::<HashSet<_>>().len(), numbers.len());
            assert!(cut.size(0).is_power_of_two());
        }
        // adaptive: bounded by the number of looks
        let cut = Cut::new(&plan(
            2,
            "half_width = 1e-6\nmax_tosses = 1_000_000_000_000",
        ));
        let chunks = (0..cut.stages()).map(|stage| cut.chunks(0, stage).count());
        assert!(chunks.sum::<usize>() as u64 <= cut.stages() as u64 * CHUNKS_A_STAGE);
    }

    #[test]
    fn chunks_are_large_enough_to_hide_what_a_file_costs() {
        let size = |tosses: u64| Cut::new(&plan(2, &format!("tosses = {tosses}"))).size(0);
        for (tosses_a_point, expected) in [
            (1, 1 << 14),
            (1 << 21, 1 << 14),
            ((1 << 21) + 1, 1 << 15),
            (5_000_000, 1 << 16),
            (50_000_000, 1 << 17),
            (1 << 29, 1 << 17),
            ((1 << 29) + 1, 1 << 18),
        ] {
            assert_eq!(size(tosses_a_point), expected, "{tosses_a_point}");
        }
        let stepped = Cut::new(&plan_of("rapier", 2, "tosses = 5_000_000"));
        assert_eq!(stepped.size(0), 1 << 14);
    }
}
