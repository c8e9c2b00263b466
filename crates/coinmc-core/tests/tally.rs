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
