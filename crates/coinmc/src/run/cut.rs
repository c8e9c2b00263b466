//! How a run is cut into chunks: a function of the plan alone, so that neither threads nor parts
//! nor a restart change what is counted.

use super::Chunk;
use crate::plan::{PILOT, Plan, Stop, Targets};
use std::ops::Range;

/// Fewest tosses of a chunk, except the last of a point: some 30 ms of work in the plane, more in
/// space, which hides the cost of a file.
const LEAST: u64 = 1 << 14;
/// Most tosses of a chunk of a run of fixed length, unless that made too many chunks: a tenth of a
/// second of work in the plane, up to a few seconds in space.
const LARGE: u64 = 1 << 17;
/// A run of fixed length has about this many chunks before they are made larger than [`LARGE`] …
const ENOUGH_CHUNKS: u64 = 256;
/// … and at most this many, or one per point: enough for thousands of cores.
const MOST_CHUNKS: u64 = 1 << 16;
/// Time-stepped tosses are so slow that their runs have as many as this from the start.
const ENOUGH_STEPPED_CHUNKS: u64 = 8192;
/// Chunks from a power of two of tosses to the next where points stop at targets, …
const CHUNKS_AN_OCTAVE: u64 = 16;
/// … until they would be larger than this, some ten seconds of work: then there are more, …
const LARGEST: u64 = 1 << 23;
/// … up to so many, which keep thousands of cores busy.
const MOST_CHUNKS_AN_OCTAVE: u64 = 1 << 16;

/// Tosses per chunk of a run that makes `total` tosses.
fn fixed_size(total: u64, plan: &Plan) -> u64 {
    let of_at_most = |chunks: u64| total.div_ceil(chunks).next_power_of_two();
    // a config names one engine
    let first = plan.points.each().next();
    let stepped = first.is_some_and(|point| point.engine.descriptor().stepped);
    let enough = if stepped {
        ENOUGH_STEPPED_CHUNKS
    } else {
        ENOUGH_CHUNKS
    };
    let size = of_at_most(enough).clamp(LEAST, LARGE);
    size.max(of_at_most(MOST_CHUNKS))
}

/// The cut of one plan: where chunks end.
///
/// A point that stops at targets is tossed in stages (see [`Looks`](crate::plan::Looks)) of which the plan
/// does not know where they end. There the toss at which a chunk begins says where it ends at the latest,
/// so that what an earlier run counted can be checked without its history.
#[derive(Debug, Clone)]
pub(super) struct Cut {
    /// Points of the plan.
    points: u64,
    /// Tosses of a point at most.
    tosses: u64,
    /// Size of a chunk where the number of tosses is fixed.
    fixed: Option<u64>,
}

impl Cut {
    pub(super) fn new(plan: &Plan) -> Self {
        let points = plan.points.len() as u64;
        match plan.stop {
            Stop::Tosses(tosses) => {
                let total = tosses.saturating_mul(plan.points_tossed());
                Self {
                    points,
                    tosses,
                    fixed: Some(fixed_size(total, plan)),
                }
            }
            Stop::Targets(Targets { max_tosses, .. }) => Self {
                points,
                tosses: max_tosses,
                fixed: None,
            },
        }
    }

    /// The chunks of a stage of a point, in order. An iterator, as the chunks of a long run would not fit
    /// into memory.
    pub(super) fn chunks(
        &self,
        point: usize,
        stage: Range<u64>,
    ) -> impl Iterator<Item = Chunk> + use<> {
        let (cut, Range { start, end }) = (self.clone(), stage);
        let starts = std::iter::successors(Some(start), move |&start| Some(cut.end(start)));
        let cut = self.clone();
        starts
            .take_while(move |&start| start < end)
            .map(move |start| Chunk {
                point,
                tosses: start..end.min(cut.end(start)),
            })
    }

    /// The longest chunk of this point that begins at toss `start`, if there is one.
    pub(super) fn chunk_at(&self, point: usize, start: u64) -> Option<Chunk> {
        let aligned = self.fixed.is_none_or(|size| start.is_multiple_of(size));
        (aligned && start < self.tosses).then(|| Chunk {
            point,
            tosses: start..self.end(start).min(self.tosses),
        })
    }

    /// Whether chunks may be shorter than [`chunk_at`](Self::chunk_at) says, where a stage ends.
    pub(super) fn may_be_shorter(&self) -> bool {
        self.fixed.is_none()
    }

    /// The chunk's turn when chunks are dealt out to the parts of a run. Only a run of fixed length has parts.
    ///
    /// The chunks of full size come first, then the shorter last ones of all points: dealt out point by point, the
    /// short ones could all go to the same parts.
    pub(super) fn turn(&self, chunk: &Chunk) -> u64 {
        let Some(size) = self.fixed else { return 0 };
        if chunk.tosses.is_empty() {
            // integrated: one chunk per point
            return chunk.point as u64;
        }
        let full_a_point = self.tosses / size;
        let place = chunk.tosses.start / size;
        let (row, length, column) = if place < full_a_point {
            (chunk.point as u64, full_a_point, place)
        } else {
            (self.points, full_a_point, chunk.point as u64)
        };
        row.wrapping_mul(length).wrapping_add(column)
    }

    /// Chunks of a point, if the number of tosses is fixed.
    pub(super) fn chunks_a_point(&self) -> Option<u64> {
        self.fixed.map(|size| self.tosses.div_ceil(size).max(1))
    }

    /// The chunk of this number, if the number of tosses is fixed and it has work.
    pub(super) fn numbered(&self, plan: &Plan, number: u64) -> Option<Chunk> {
        let (size, chunks_a_point) = (self.fixed?, self.chunks_a_point()?);
        let point = usize::try_from(number / chunks_a_point).ok()?;
        if point >= plan.points.len() || !plan.makes_tosses(point) {
            return None;
        }
        self.chunk_at(point, number % chunks_a_point * size)
    }

    /// Where the chunk that begins at `start` ends at the latest.
    fn end(&self, start: u64) -> u64 {
        if let Some(size) = self.fixed {
            return start.saturating_add(size);
        }
        if start < PILOT {
            return PILOT;
        }
        // from a power of two to the next 16 chunks, or fewer that are large enough
        let octave = 1_u64 << start.ilog2();
        let size = (octave / CHUNKS_AN_OCTAVE).clamp(LEAST, LARGEST);
        let size = size.max(octave / MOST_CHUNKS_AN_OCTAVE).min(octave);
        (start - start % size).saturating_add(size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Part;
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
            let mut end = 0;
            for chunk in cut.chunks(1, 0..tosses) {
                assert_eq!(chunk.tosses.start, end);
                assert!(chunk.tosses.end > end);
                end = chunk.tosses.end;
                assert_eq!(cut.chunk_at(1, chunk.tosses.start), Some(chunk.clone()));
            }
            assert_eq!(end, tosses, "{stop}");
            assert_eq!(cut.chunk_at(1, tosses), None);
            assert_eq!(cut.chunk_at(1, u64::MAX), None);
        }
    }

    /// A stage may begin and end between the ends of longer chunks.
    #[test]
    fn stages_are_cut_at_the_same_places() {
        let cut = Cut::new(&plan(3, "half_width = 0.01"));
        let ends = |stage| {
            let chunks = cut.chunks(0, stage);
            chunks.map(|chunk| chunk.tosses.end).collect::<Vec<_>>()
        };
        assert_eq!(ends(0..64), [64]);
        assert_eq!(ends(1024..2048), [2048]);
        assert_eq!(ends(4096..50_000), [8192, 16_384, 32_768, 49_152, 50_000]);
        assert_eq!(ends(50_000..70_000), [65_536, 70_000]);
        assert_eq!(ends(1 << 20..(1 << 20) + 100_000), [1_114_112, 1_148_576]);
        assert!(cut.chunk_at(0, 50_000).is_some() && cut.may_be_shorter());
        let fixed = Cut::new(&plan(3, "tosses = 1e6"));
        assert!(fixed.chunk_at(0, 50_000).is_none() && !fixed.may_be_shorter());
    }

    #[test]
    fn a_run_has_a_bounded_number_of_chunks_each_with_a_turn_of_its_own() {
        for (points, tosses) in [
            (2, 1_u64),
            (7, 100_000),
            (100, 1_000_000),
            (3, 1_000_000_000_000),
        ] {
            let plan = plan(points, &format!("tosses = {tosses}"));
            let cut = Cut::new(&plan);
            let chunks = (0..plan.points.len()).flat_map(|point| cut.chunks(point, 0..tosses));
            let numbers: Vec<u64> = chunks.map(|chunk| cut.turn(&chunk)).collect();
            assert!(numbers.len() as u64 <= MOST_CHUNKS + u64::from(points));
            assert_eq!(numbers.iter().collect::<HashSet<_>>().len(), numbers.len());
            assert!(cut.end(0).is_power_of_two());
        }
        // adaptive: bounded by the number of octaves
        let cut = Cut::new(&plan(
            2,
            "half_width = 1e-6\nmax_tosses = 1_000_000_000_000",
        ));
        let chunks = cut.chunks(0, 0..1_000_000_000_000).count() as u64;
        assert!(chunks <= 1_000_000_000_000 / LARGEST + 30 * CHUNKS_AN_OCTAVE);
        let most = Cut::new(&plan(2, "half_width = 1e-6\nmax_tosses = 1e15"));
        assert_eq!(most.end(1 << 49), (1 << 49) + (1 << 33));
    }

    /// Whatever the chunks of a point, a full and a short one among them.
    #[test]
    fn parts_make_about_the_same_number_of_tosses() {
        for (points, tosses, of) in [(126, 20_000, 4), (60, 70_000, 5), (64, 120_000, 8)] {
            let plan = plan(points, &format!("tosses = {tosses}"));
            let cut = Cut::new(&plan);
            let mut made = vec![0; of as usize];
            for chunk in (0..plan.points.len()).flat_map(|point| cut.chunks(point, 0..tosses)) {
                let owns = |index: &u32| Part::new(index + 1, of).unwrap().owns(cut.turn(&chunk));
                let owner = (0..of).find(owns).unwrap();
                made[owner as usize] += chunk.tosses.end - chunk.tosses.start;
            }
            let difference = made.iter().max().unwrap() - made.iter().min().unwrap();
            let size = cut.end(0);
            assert!(difference <= size + tosses % size, "{made:?}");
        }
    }

    #[test]
    fn chunks_are_large_enough_to_hide_what_a_file_costs() {
        let size = |tosses: u64| Cut::new(&plan(2, &format!("tosses = {tosses}"))).end(0);
        for (tosses_a_point, expected) in [
            (1, 1 << 14),
            (1 << 21, 1 << 14),
            ((1 << 21) + 1, 1 << 15),
            (5_000_000, 1 << 16),
            (50_000_000, 1 << 17),
            (1 << 29, 1 << 17),
            (1 << 32, 1 << 17),
            ((1 << 32) + 1, 1 << 18),
        ] {
            assert_eq!(size(tosses_a_point), expected, "{tosses_a_point}");
        }
        let stepped = Cut::new(&plan_of("rapier", 2, "tosses = 5_000_000"));
        assert_eq!(stepped.end(0), 1 << 14);
    }
}
