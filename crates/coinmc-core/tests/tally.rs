//! Tallies: exact, order-free, safe against forged counts.

use coinmc_core::{Breaks, Ended, Face, Outcome, SideEnding, SideMotion, Tally};
use proptest::prelude::*;

fn outcome() -> impl Strategy<Value = Outcome> {
    let ended = prop_oneof![
        Just(Ended::Decided(Face::Heads)),
        Just(Ended::Decided(Face::Tails)),
        Just(Ended::Decided(Face::Side)),
        Just(Ended::TimeLimit),
        Just(Ended::NeverSettles),
        Just(Ended::ImpactLimit),
        Just(Ended::Failed),
    ];
    (
        ended,
        any::<u32>(),
        any::<u32>(),
        any::<u32>(),
        any::<bool>(),
    )
        .prop_map(|(ended, impacts, contact_steps, jams, overruled)| Outcome {
            ended,
            impacts,
            contact_steps,
            jams,
            overruled,
            breaks: Breaks {
                sinkings: impacts / 2,
                unresolved: jams,
                ..Breaks::default()
            },
            side_ending: Some(SideEnding {
                motion: SideMotion::Rolled,
                roll_bounds_passed: u8::try_from(jams % 8).expect("below 8"),
            }),
        })
}

fn tally(outcomes: &[Outcome]) -> Tally {
    let mut tally = Tally::default();
    for outcome in outcomes {
        tally.add(outcome);
    }
    tally
}

proptest! {
    #[test]
    fn merging_parts_in_any_order_counts_the_whole(
        outcomes in prop::collection::vec(outcome(), 0..100), cut in 0..100_usize,
    ) {
        let (first, second) = outcomes.split_at(cut.min(outcomes.len()));
        let whole = tally(&outcomes);
        let (a, b) = (tally(first), tally(second));
        prop_assert_eq!(a.checked_merge(&b), Some(whole));
        prop_assert_eq!(b.checked_merge(&a), Some(whole));
        let mut merged = a;
        merged.merge(&b);
        prop_assert_eq!(merged, whole);
        prop_assert_eq!(whole.tosses(), outcomes.len() as u64);
        prop_assert_eq!(Tally::from_array(whole.to_array()), whole);
    }
}

#[test]
fn an_overflow_is_reported() {
    let full = Tally {
        heads: u64::MAX,
        ..Tally::default()
    };
    let one = Tally {
        heads: 1,
        ..Tally::default()
    };
    assert_eq!(full.checked_merge(&one), None);
}

#[test]
fn the_names_of_the_counters_match_their_order() {
    let mut counts = [0; Tally::COUNTERS.len()];
    for (i, counter) in Tally::COUNTERS.iter().enumerate() {
        counts[i] = 7;
        let tally = Tally::from_array(counts);
        let named = format!("{tally:?}");
        let name = counter.name;
        assert!(named.contains(&format!("{name}: 7")), "{name} {named}");
        counts[i] = 0;
    }
}

#[test]
fn a_side_ending_counts_its_motion_and_every_bound_it_passed() {
    let mut sum = Tally::default();
    for (motion, roll_bounds_passed) in [
        (SideMotion::Rested, 0),
        (SideMotion::Rolled, 2),
        (SideMotion::Rolled, 7),
        (SideMotion::Spun, 1),
    ] {
        sum.add(&Outcome {
            side_ending: Some(SideEnding {
                motion,
                roll_bounds_passed,
            }),
            ..Outcome::decided(Face::Side)
        });
    }
    sum.add(&Outcome::decided(Face::Heads));
    assert_eq!((sum.side_rested, sum.side_rolled, sum.side_spun), (1, 2, 1));
    assert_eq!(sum.rolled(), [3, 2, 1, 1, 1, 1, 1]);
    assert_eq!((sum.rolled_1_cm, sum.rolled_10_m), (3, 1));
}

/// Every counter that a toss can move moves alone, by the number that is in the outcome.
#[test]
fn every_counter_counts_its_own() {
    let of = |outcome: Outcome| {
        let mut tally = Tally::default();
        tally.add(&outcome);
        let counts = tally.to_array().into_iter().zip(Tally::COUNTERS);
        let moved = counts.filter(|(count, _)| *count > 0);
        moved
            .map(|(count, counter)| (counter.name, count))
            .collect::<Vec<_>>()
    };
    let endings = [
        (Ended::Decided(Face::Heads), "heads"),
        (Ended::Decided(Face::Tails), "tails"),
        (Ended::Decided(Face::Side), "side"),
        (Ended::Left, "left"),
        (Ended::TimeLimit, "time_limit"),
        (Ended::NeverSettles, "never_settles"),
        (Ended::ImpactLimit, "impact_limit"),
        (Ended::Failed, "failed"),
    ];
    let heads = Outcome::decided(Face::Heads);
    for (ended, name) in endings {
        let outcome = Outcome { ended, ..heads };
        assert_eq!(of(outcome), [(name, 1)]);
    }
    let breaks = |breaks| Outcome { breaks, ..heads };
    let none = Breaks::default();
    #[rustfmt::skip]
    let events = [
        ("impacts", Outcome { impacts: 3, ..heads }),
        ("contact_steps", Outcome { contact_steps: 3, ..heads }),
        ("jams", Outcome { jams: 3, ..heads }),
        ("negative_heights", breaks(Breaks { negative_heights: 3, ..none })),
        ("energy_gains", breaks(Breaks { energy_gains: 3, ..none })),
        ("wrong_levers", breaks(Breaks { wrong_levers: 3, ..none })),
        ("sinkings", breaks(Breaks { sinkings: 3, ..none })),
        ("unresolved", breaks(Breaks { unresolved: 3, ..none })),
    ];
    for (name, outcome) in events {
        assert_eq!(of(outcome), [("heads", 1), (name, 3)]);
    }
    let overruled = Outcome {
        overruled: true,
        ..heads
    };
    assert_eq!(of(overruled), [("heads", 1), ("overruled", 1)]);
}

/// Those that left the table are known: they are tosses, but not undecided ones.
#[test]
fn tosses_are_faces_undecided_ones_and_those_that_left() {
    let tally = Tally {
        heads: 1,
        tails: 20,
        side: 300,
        left: 4_000,
        time_limit: 50_000,
        never_settles: 600_000,
        impact_limit: 7_000_000,
        failed: 80_000_000,
        ..Tally::default()
    };
    assert_eq!(tally.undecided(), 87_650_000);
    assert_eq!(tally.tosses(), 87_654_321);
    assert_eq!(Face::ALL.map(|face| tally.count(face)), [1, 20, 300]);
}

/// A coin that began upright showed no face, so whatever it shows is not the same.
#[test]
fn the_face_of_the_start_counts_where_one_was_up() {
    let same = |ended, up| {
        let mut tally = Tally::default();
        let outcome = Outcome {
            ended,
            ..Outcome::decided(Face::Heads)
        };
        tally.add_started(&outcome, up);
        assert_eq!(tally.tosses(), 1);
        tally.same
    };
    let (heads, tails) = (Some(Face::Heads), Some(Face::Tails));
    assert_eq!(same(Ended::Decided(Face::Heads), heads), 1);
    assert_eq!(same(Ended::Decided(Face::Heads), tails), 0);
    assert_eq!(same(Ended::Decided(Face::Tails), tails), 1);
    for undecided in [Ended::Left, Ended::TimeLimit, Ended::Failed] {
        assert_eq!(same(undecided, None), 0);
        assert_eq!(same(undecided, heads), 0);
    }
}
