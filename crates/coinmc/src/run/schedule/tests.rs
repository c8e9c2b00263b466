//! Schedules of which the results are made up: nothing is tossed.

use super::*;
use crate::run::finished::Finished;
use crate::run::unfinished::Beginnings;
use coinmc_core::Tally;
use std::ops::Range;

/// Two points.
pub(in crate::run) fn plan(stop: &str) -> Arc<Plan> {
    plan_of("[1.0, 2.0]", stop)
}

/// One point.
pub(in crate::run) fn plan_of_one(stop: &str) -> Arc<Plan> {
    plan_of("1.0", stop)
}

fn plan_of(ratio: &str, stop: &str) -> Arc<Plan> {
    let config = format!(
        "coin.ratio = {ratio}\nsurface = {{ restitution = 0.5, friction = 0.3 }}\n\
         launch.preset = 'robot'\nengine.flat = {{}}\n[stop]\n{stop}"
    );
    Arc::new(crate::config::parse("test", &config, &[]).unwrap())
}

pub(in crate::run) fn chunk(point: usize, tosses: Range<u64>) -> Chunk {
    Chunk { point, tosses }
}

/// Half heads, half tails, and a millisecond each.
fn half_and_half(tosses: u64) -> Tossed {
    Tossed {
        tally: Tally {
            heads: tosses / 2,
            tails: tosses - tosses / 2,
            ..Tally::default()
        },
        microseconds: 1000 * tosses,
    }
}

fn whole_of(plan: &Arc<Plan>, finished: Finished) -> Schedule {
    Schedule::new(plan, Part::WHOLE, finished)
}

fn stored(chunks: &[(Chunk, u64)]) -> Finished {
    let result = |tosses| Packed::from(&ChunkResult::Tossed(half_and_half(tosses)));
    Finished::new(
        chunks
            .iter()
            .map(|(chunk, tosses)| (chunk.clone(), result(*tosses))),
    )
}

/// Makes what the schedule asks for until it is done; returns the chunks.
fn play(schedule: &mut Schedule) -> Vec<Chunk> {
    let mut made = Vec::new();
    loop {
        match schedule.next() {
            Next::Chunk(Job { chunk, begun }) => {
                let begun = begun.map_or(0, |begun| begun.tally.tosses());
                let rest = chunk.tosses.end - chunk.tosses.start - begun;
                schedule.complete(&chunk, &ChunkResult::Tossed(half_and_half(rest)));
                made.push(chunk);
            }
            Next::Done => return made,
            Next::Wait => unreachable!("nothing is in flight"),
        }
    }
}

/// Tosses done, planned, and of an earlier run; and its chunks.
fn told(schedule: &Schedule) -> (u64, u64, u64, u64) {
    let told = schedule.progress();
    (
        told.tosses_done,
        told.tosses_planned,
        told.tosses_reused,
        told.reused_chunks,
    )
}

#[test]
fn chunks_of_an_earlier_run_are_counted_and_not_handed_out() {
    let plan = plan("tosses = 20_000");
    let there = [
        (chunk(0, 0..16_384), 16_384),
        (chunk(1, 16_384..20_000), 3616),
    ];
    let mut schedule = whole_of(&plan, stored(&there));
    assert_eq!(told(&schedule), (20_000, 40_000, 20_000, 2));
    let made = play(&mut schedule);
    assert_eq!(made, [chunk(0, 16_384..20_000), chunk(1, 0..16_384)]);
    assert_eq!(told(&schedule), (40_000, 40_000, 20_000, 2));
    assert!(schedule.is_done());
    assert_eq!(schedule.progress().points_done, 2);
    for point in [0, 1] {
        let counted = schedule.counted(point);
        assert_eq!(counted.tally.tosses(), 20_000);
        assert_eq!(counted.stopped_by, StoppedBy::Tosses);
    }
}

#[test]
fn a_chunk_that_is_not_whole_is_made_again() {
    let plan = plan("tosses = 20_000");
    for forged in [16_383, 16_385] {
        let mut schedule = whole_of(&plan, stored(&[(chunk(0, 0..16_384), forged)]));
        assert_eq!(told(&schedule), (forged, 40_000, forged, 1));
        let Next::Chunk(job) = schedule.next() else {
            panic!("{forged}");
        };
        assert_eq!((job.chunk, job.begun), (chunk(0, 0..16_384), None));
        assert_eq!(told(&schedule), (0, 40_000, 0, 0));
        assert_eq!(schedule.counted(0).tally.tosses(), 0);
    }
}

#[test]
fn what_the_run_does_not_need_is_not_its_progress() {
    let plan = plan("tosses = 20_000");
    let beyond = chunk(1, 32_768..49_152);
    let mut schedule = whole_of(
        &plan,
        stored(&[(chunk(1, 0..16_384), 16_384), (beyond, 16_384)]),
    );
    play(&mut schedule);
    assert_eq!(told(&schedule), (56_384, 56_384, 32_768, 2));
    assert_eq!(schedule.take_unneeded(), [(1, 32_768)]);
    assert_eq!(told(&schedule), (40_000, 40_000, 16_384, 1));
}

fn begun_with(chunk: Chunk, tossed: Tossed) -> Finished {
    let key = (chunk.point, chunk.tosses.start);
    Finished::default().with_beginnings(Beginnings::from([(key, (chunk, tossed))]))
}

#[test]
fn a_chunk_goes_on_from_its_beginning() {
    let plan = plan("tosses = 1000");
    let finished = begun_with(chunk(0, 0..300), half_and_half(300));
    let mut schedule = whole_of(&plan, finished);
    let Next::Chunk(job) = schedule.next() else {
        panic!("a chunk");
    };
    assert_eq!(job.begun.as_deref(), Some(&half_and_half(300)));
    assert_eq!(told(&schedule), (300, 2000, 300, 0));
    let rest = ChunkResult::Tossed(half_and_half(700));
    schedule.complete(&job.chunk, &rest);
    assert_eq!(play(&mut schedule), [chunk(1, 0..1000)]);
    assert_eq!(told(&schedule), (2000, 2000, 300, 0));
    assert_eq!(schedule.counted(0).tally, half_and_half(1000).tally);
}

/// Only forged counts are so many.
#[test]
fn a_beginning_that_overflows_a_counter_is_made_again() {
    let plan = plan("tosses = 20_000");
    let mut forged = half_and_half(300);
    forged.tally.same = u64::MAX;
    let finished = begun_with(chunk(0, 16_384..16_684), forged);
    let mut schedule = whole_of(&plan, finished);
    let Next::Chunk(first) = schedule.next() else {
        panic!("a chunk");
    };
    let mut result = half_and_half(16_384);
    result.tally.same = 1;
    schedule.complete(&first.chunk, &ChunkResult::Tossed(result));
    let Next::Chunk(second) = schedule.next() else {
        panic!("a chunk");
    };
    assert_eq!(
        (second.chunk, second.begun),
        (chunk(0, 16_384..20_000), None)
    );
    assert_eq!(told(&schedule), (16_384, 40_000, 0, 0));
    assert_eq!(schedule.counted(0).tally, result.tally);
}

/// The tosses of points that never meet their targets.
fn tosses_of(stop: &str) -> (Vec<u64>, u64, StoppedBy) {
    let mut schedule = whole_of(&plan(stop), Finished::default());
    play(&mut schedule);
    let (done, planned, ..) = told(&schedule);
    assert_eq!(done, planned);
    let points: Vec<Counted> = [0, 1].map(|point| schedule.counted(point)).into();
    assert_eq!(points[0].stopped_by, points[1].stopped_by);
    let all = |counted: &Counted| counted.tally.tosses() + counted.look.unwrap().0;
    (points.iter().map(all).collect(), done, points[0].stopped_by)
}

/// Equal points get equal shares, of which rounding takes less than a chunk's least.
#[test]
fn points_share_what_the_run_may_toss() {
    let (each, all, by) = tosses_of("half_width = 1e-4\ntotal_tosses = 100_000");
    assert_eq!((each[0], by), (each[1], StoppedBy::TotalTosses));
    assert_eq!(each[0] + each[1], all);
    assert!(all <= 100_000 && all > 99_990, "{all}");
}

/// 100 s for tosses of a millisecond.
#[test]
fn points_share_the_time_that_the_run_may_take() {
    let (each, all, by) = tosses_of("half_width = 1e-4\ntotal_core_seconds = 100");
    assert_eq!((each[0], by), (each[1], StoppedBy::TotalCoreSeconds));
    assert!(all <= 100_000 && all > 99_990, "{all}");
}

#[test]
fn a_point_takes_no_more_than_its_time() {
    let (each, _, by) = tosses_of("half_width = 1e-4\nmax_core_seconds = 50");
    assert_eq!((each[0], by), (each[1], StoppedBy::MaxCoreSeconds));
    assert!(each[0] <= 50_000 && each[0] > 49_990, "{each:?}");
}

/// As soon as what is left is shared out, it is known what the run will toss.
#[test]
fn the_forecast_is_what_the_shares_come_to() {
    let plan = plan("half_width = 1e-4\ntotal_tosses = 100_000");
    let mut schedule = whole_of(&plan, Finished::default());
    while schedule.states.open(0).is_in_pilot() || schedule.states.open(1).is_in_pilot() {
        let Next::Chunk(job) = schedule.next() else {
            panic!("a pilot goes on");
        };
        let tosses = job.chunk.tosses.end - job.chunk.tosses.start;
        let result = ChunkResult::Tossed(half_and_half(tosses));
        schedule.complete(&job.chunk, &result);
    }
    assert!(matches!(schedule.next(), Next::Chunk(_)));
    let planned = schedule.progress().tosses_planned;
    assert!(planned <= 100_000 && planned > 99_990, "{planned}");
}

/// A limit of time is one of tosses where each takes as long. So is the part of it that a pilot may be.
#[test]
fn a_pilot_takes_the_same_part_of_tosses_and_of_time() {
    let pilots = |stop: &str| {
        let stop = format!("face = 'side'\nrelative_error = 0.01\n{stop}");
        let mut schedule = whole_of(&plan(&stop), Finished::default());
        play(&mut schedule);
        [0, 1].map(|point| schedule.counted(point).look.unwrap().0)
    };
    // 50 000 tosses or 50 s for each point, of which a pilot that never sees the side takes a 32nd, and doubles
    let of_tosses = pilots("total_tosses = 100_000");
    assert_eq!(of_tosses, [2048; 2]);
    assert_eq!(pilots("total_core_seconds = 100"), of_tosses);
    assert_eq!(pilots("max_core_seconds = 50"), of_tosses);
}

/// By Wilson's formula, of points in progress and of those that have ended.
#[test]
fn the_widest_arm_of_all_points_is_told() {
    let plan = plan("tosses = 20_000");
    let mut schedule = whole_of(&plan, Finished::default());
    assert_eq!(schedule.progress().worst_half_width, None);
    let arm = |tosses| {
        let method = coinmc_core::IntervalMethod::Wilson;
        let estimate = coinmc_core::Estimate::new(tosses / 2, 0, tosses, plan.confidence, method);
        Some(estimate.half_width())
    };
    let mut widest = |tosses| {
        let Next::Chunk(job) = schedule.next() else {
            panic!("a chunk");
        };
        let result = ChunkResult::Tossed(half_and_half(tosses));
        schedule.complete(&job.chunk, &result);
        schedule.progress().worst_half_width
    };
    // the second chunk of a point makes its intervals shorter; then the other point has fewer tosses
    assert_eq!(widest(16_384), arm(16_384));
    assert_eq!(widest(3616), arm(20_000));
    assert_eq!(widest(16_384), arm(16_384));
    assert_eq!(widest(3616), arm(20_000));
}

/// The next stage of an open point comes before the next point: a pilot waits for no other.
#[test]
fn a_pilot_goes_on_before_the_next_point_begins() {
    for limit in ["", "total_tosses = 100_000", "max_core_seconds = 50"] {
        let plan = plan(&format!("relative_error = 0.01\n{limit}"));
        let mut schedule = whole_of(&plan, Finished::default());
        for tosses in [0..64, 64..128, 128..256] {
            let Next::Chunk(job) = schedule.next() else {
                panic!("a chunk");
            };
            assert_eq!(job.chunk, chunk(0, tosses.clone()), "{limit}");
            let result = ChunkResult::Tossed(half_and_half(tosses.end - tosses.start));
            schedule.complete(&job.chunk, &result);
        }
    }
}

/// Where nothing is limited, and chance does not change what the pilots have shown.
#[test]
fn the_pilots_tell_what_the_run_will_toss() {
    let plan = plan("half_width = 0.01");
    let mut schedule = whole_of(&plan, Finished::default());
    let mut planned = Vec::new();
    while let Next::Chunk(Job { chunk, .. }) = schedule.next() {
        if [0, 1]
            .iter()
            .all(|&point| schedule.counted(point).look.is_some())
        {
            planned.push(schedule.progress().tosses_planned);
        }
        let result = ChunkResult::Tossed(half_and_half(chunk.tosses.end - chunk.tosses.start));
        schedule.complete(&chunk, &result);
    }
    let done = schedule.progress().tosses_done;
    assert!(
        !planned.is_empty() && planned.iter().all(|&planned| planned == done),
        "{planned:?}"
    );
}

/// Played to its end: half tails at the first point, which so needs more tosses, and a tenth at the second.
fn played_with_fewer_tails_at_the_second(plan: &Arc<Plan>) -> Schedule {
    let mut schedule = whole_of(plan, Finished::default());
    while let Next::Chunk(Job { chunk, .. }) = schedule.next() {
        let tosses = chunk.tosses.end - chunk.tosses.start;
        let tails = if chunk.point == 0 {
            tosses / 2
        } else {
            tosses / 10
        };
        let mut result = half_and_half(tosses);
        (result.tally.heads, result.tally.tails) = (tosses - tails, tails);
        schedule.complete(&chunk, &ChunkResult::Tossed(result));
    }
    schedule
}

/// Tosses for the same half width go as p (1 − p): 1/4 of a face that shows half of the times, 0.09 of one that
/// shows nine times of ten, or 0.11 at the margin of 2.5 standard errors that a pilot of a thousand tosses has.
#[test]
fn the_tosses_of_the_run_go_to_where_more_are_needed() {
    let plan = plan("half_width = 1e-3\ntotal_tosses = 100_000");
    let schedule = played_with_fewer_tails_at_the_second(&plan);
    let [more, less] = [0, 1].map(|point| schedule.counted(point).tally.tosses() as f64);
    let ratio = more / less;
    assert!(ratio > 2.0 && ratio < 2.8, "{ratio}");
}

/// The run allows each point what its own limit does: that is what ends it.
#[test]
fn a_limit_that_is_not_exceeded_does_not_stop_a_point() {
    let by = |stop: &str| tosses_of(stop).2;
    let each = "half_width = 1e-4\nmax_tosses = 1000";
    assert_eq!(
        by(&format!("{each}\ntotal_tosses = 2000")),
        StoppedBy::MaxTosses
    );
    assert_eq!(
        by(&format!("{each}\ntotal_tosses = 1998")),
        StoppedBy::TotalTosses
    );
}

/// A share that is all that a point may have is no limit to it.
#[test]
fn a_point_that_gets_all_that_it_may_have_is_not_limited_by_the_run() {
    let plan = plan("half_width = 1e-4\nmax_tosses = 5000\ntotal_tosses = 9000");
    let schedule = played_with_fewer_tails_at_the_second(&plan);
    let [first, second] = [0, 1].map(|point| schedule.counted(point));
    assert_eq!(first.stopped_by, StoppedBy::MaxTosses);
    assert_eq!(first.tally.tosses() + first.look.unwrap().0, 5000);
    assert_eq!(second.stopped_by, StoppedBy::TotalTosses);
    assert!(second.tally.tosses() + second.look.unwrap().0 <= 4000);
}

/// Each point counts fewer than 2^64 tosses. Of all together, which only files that somebody made can have more of,
/// no more than 2^64 − 1 are told.
#[test]
fn forged_counts_of_many_points_are_not_told_in_full() {
    let mut schedule = whole_of(&plan("tosses = 1_000_000"), Finished::default());
    let forged = Tossed {
        microseconds: 1,
        ..half_and_half(u64::MAX / 1000)
    };
    for _ in 0..600 {
        for point in [0, 1] {
            schedule.add(point, &ChunkResult::Tossed(forged));
        }
    }
    assert_eq!(schedule.progress.tosses_done, u64::MAX);
    assert_eq!(schedule.made, u64::MAX);
}
