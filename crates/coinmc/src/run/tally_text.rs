//! The tally of one finished chunk: a few lines of text with a checksum. See
//! docs/reference/formats.md.

use super::Chunk;
use super::chunk_result::Tossed;
use super::damage::Damage;
use super::sealed::{seal, unseal};
use coinmc_core::{Counter, CounterKind, Tally};
use std::fmt::Write;

/// Version of the format.
const FORMAT: u64 = 2;
const TITLE: &str = "coinmc tally";
/// The line of the computing time.
const TIME: &str = "microseconds";

/// Whether the counter has a line even if it is 0; counters of what most laws or engines never
/// count do not.
fn is_always_written(counter: &Counter) -> bool {
    !matches!(
        counter.kind,
        CounterKind::Breakdown | CounterKind::SideEnding | CounterKind::EdgeEnding
    )
}

/// The text.
pub(super) fn encode(chunk: &Chunk, tossed: &Tossed, plan_hash: &str) -> String {
    let Chunk { point, tosses } = chunk;
    let mut text = format!(
        "{TITLE} {FORMAT}\nplan {plan_hash}\npoint {point}\ntosses {} {}\n",
        tosses.start, tosses.end
    );
    for (counter, count) in Tally::COUNTERS.iter().zip(tossed.tally.to_array()) {
        if is_always_written(counter) || count > 0 {
            writeln!(text, "{} {count}", counter.name).expect("a String takes all text");
        }
    }
    if tossed.microseconds > 0 {
        writeln!(text, "{TIME} {}", tossed.microseconds).expect("a String takes all text");
    }
    seal(text)
}

/// The range of tosses that the text says it counts, if it says so.
pub(super) fn chunk(bytes: &[u8]) -> Option<Chunk> {
    let text = std::str::from_utf8(bytes).ok()?;
    let mut lines = text.lines().skip(2);
    let point = lines.next()?.strip_prefix("point ")?.parse().ok()?;
    let start = lines.next()?.strip_prefix("tosses ")?.split_once(' ')?.0;
    let tosses = start.parse().ok()?..end(bytes)?;
    Some(Chunk { point, tosses })
}

/// The number that the text gives for the toss after its last, if it gives one.
pub(super) fn end(bytes: &[u8]) -> Option<u64> {
    let text = std::str::from_utf8(bytes).ok()?;
    let range = text.lines().find_map(|line| line.strip_prefix("tosses "))?;
    range.split_once(' ')?.1.parse().ok()
}

/// Reads the text of `chunk`. Any bytes other than those that [`encode`] would write are rejected.
pub(super) fn decode(bytes: &[u8], chunk: &Chunk, plan_hash: &str) -> Result<Tossed, Damage> {
    let mut lines = unseal(bytes)?.lines();
    let title = lines
        .next()
        .and_then(|line| line.strip_prefix(TITLE))
        .ok_or(Damage::Form)?;
    if title.strip_prefix(' ') != Some(FORMAT.to_string().as_str()) {
        return Err(Damage::Version);
    }
    let plan = lines
        .next()
        .and_then(|line| line.strip_prefix("plan "))
        .ok_or(Damage::Form)?;
    if plan != plan_hash {
        return Err(Damage::OtherPlan);
    }
    let place = [
        format!("point {}", chunk.point),
        format!("tosses {} {}", chunk.tosses.start, chunk.tosses.end),
    ];
    if !place.iter().all(|expected| lines.next() == Some(expected)) {
        return Err(Damage::OtherChunk);
    }
    let mut counts = [0; Tally::COUNTERS.len()];
    let mut line = lines.next();
    for (count, counter) in counts.iter_mut().zip(&Tally::COUNTERS) {
        let value = line.and_then(|line| line.strip_prefix(counter.name)?.strip_prefix(' '));
        if value.is_none() && !is_always_written(counter) {
            continue;
        }
        *count = value
            .and_then(|value| value.parse().ok())
            .ok_or(Damage::Form)?;
        line = lines.next();
    }
    let tally = Tally::from_array(counts);
    let microseconds = match line.and_then(|line| line.strip_prefix(TIME)?.strip_prefix(' ')) {
        Some(value) => value.parse().map_err(|_| Damage::Form)?,
        None => 0,
    };
    let tossed = Tossed {
        tally,
        microseconds,
    };
    if !is_possible(&tally, chunk.tosses.end - chunk.tosses.start) {
        return Err(Damage::Counts);
    }
    if encode(chunk, &tossed, plan_hash).as_bytes() == bytes {
        Ok(tossed)
    } else {
        Err(Damage::Form)
    }
}

/// Whether `tosses` tosses can have these counts.
fn is_possible(tally: &Tally, tosses: u64) -> bool {
    let most_events = tosses.saturating_mul(u64::from(u32::MAX));
    let mut endings = Some(0_u64);
    for (counter, count) in Tally::COUNTERS.iter().zip(tally.to_array()) {
        let most = match counter.kind {
            CounterKind::Ending | CounterKind::EdgeEnding => {
                endings = endings.and_then(|sum| sum.checked_add(count));
                tosses
            }
            CounterKind::Toss => tosses,
            CounterKind::Event => most_events,
            CounterKind::Breakdown => tally.impacts,
            CounterKind::SideEnding => tally.side,
        };
        if count > most {
            return false;
        }
    }
    // a toss without a face does not show the one that was up
    let faces = || tally.heads + tally.tails + tally.side;
    endings == Some(tosses) && tally.same <= faces()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::sealed::MAX_BYTES;
    use proptest::prelude::*;

    const HASH: &str = "0123456789abcdef";

    fn untimed(tally: Tally) -> Tossed {
        Tossed {
            tally,
            microseconds: 0,
        }
    }

    #[test]
    fn only_a_time_that_was_measured_is_written() {
        let (chunk, tally) = example();
        let has_time = |microseconds| {
            let tossed = Tossed {
                tally,
                microseconds,
            };
            encode(&chunk, &tossed, HASH).contains(TIME)
        };
        assert!(!has_time(0) && has_time(1));
    }

    fn example() -> (Chunk, Tally) {
        let chunk = Chunk {
            point: 3,
            tosses: 16384..16484,
        };
        let tally = Tally {
            heads: 50,
            tails: 30,
            side: 15,
            failed: 5,
            impacts: 700,
            sinkings: 9,
            ..Tally::default()
        };
        (chunk, tally)
    }

    #[test]
    fn impossible_counts_are_rejected_without_overflow() {
        let (chunk, tally) = example();
        for forged in [
            Tally {
                heads: u64::MAX,
                ..tally
            },
            Tally { heads: 51, ..tally },
            Tally {
                overruled: 101,
                ..tally
            },
            Tally { same: 96, ..tally },
            Tally {
                impacts: u64::MAX,
                ..tally
            },
            Tally {
                side_spun: tally.side + 1,
                ..tally
            },
        ] {
            let text = encode(&chunk, &untimed(forged), HASH);
            assert_eq!(decode(text.as_bytes(), &chunk, HASH), Err(Damage::Counts));
        }
    }

    #[test]
    fn foreign_texts_with_a_valid_checksum_are_rejected() {
        let (chunk, tally) = example();
        let text = encode(&chunk, &untimed(tally), HASH);
        let other = Chunk {
            point: 4,
            ..chunk.clone()
        };
        assert_eq!(decode(text.as_bytes(), &chunk, HASH), Ok(untimed(tally)));
        assert_eq!(
            decode(text.as_bytes(), &chunk, "f00"),
            Err(Damage::OtherPlan)
        );
        assert_eq!(
            decode(text.as_bytes(), &other, HASH),
            Err(Damage::OtherChunk)
        );
        let body = unseal(text.as_bytes()).unwrap();
        for (from, to, damage) in [
            ("tally 2", "tally 1", Damage::Version),
            ("heads 50", "heads +50", Damage::Form),
            ("heads 50", "heads 050", Damage::Form),
            ("overruled 0\n", "overruled 0\nmore 1\n", Damage::Form),
            ("sinkings 9\n", "sinkings 9\nunresolved 0\n", Damage::Form),
            ("sinkings 9\n", "unresolved 1\nsinkings 9\n", Damage::Form),
            ("sinkings 9\n", "sinkings 701\n", Damage::Counts),
            ("sinkings 9\n", "sinkings 9\nmicroseconds 0\n", Damage::Form),
            (
                "sinkings 9\n",
                "sinkings 9\nmicroseconds -1\n",
                Damage::Form,
            ),
            ("coinmc", "someone", Damage::Form),
        ] {
            let forged = seal(body.replace(from, to));
            assert_eq!(decode(forged.as_bytes(), &chunk, HASH), Err(damage), "{to}");
        }
    }

    #[test]
    fn the_longest_text_is_within_the_bound() {
        let chunk = Chunk {
            point: usize::MAX,
            tosses: 0..u64::MAX,
        };
        let text = encode(
            &chunk,
            &Tossed {
                tally: Tally::from_array([u64::MAX; Tally::COUNTERS.len()]),
                microseconds: u64::MAX,
            },
            &"f".repeat(128),
        );
        assert!(text.len() <= MAX_BYTES);
    }

    proptest! {
        #[test]
        fn texts_read_back_and_any_damage_is_detected(
            point in 0..10_000_usize,
            start in 0..u64::MAX / 2,
            faces in prop::array::uniform7(0..1_u64 << 40),
            place in any::<prop::sample::Index>(),
            flip in 1..=u8::MAX,
            inserted in any::<u8>(),
            microseconds in prop::sample::select(vec![0, 1, 77, u64::MAX]),
        ) {
            let [heads, tails, side, time_limit, never_settles, impact_limit, failed] = faces;
            let tally = Tally {
                heads, tails, side, time_limit, never_settles, impact_limit, failed, ..Tally::default()
            };
            let chunk = Chunk { point, tosses: start..start + tally.tosses() };
            let tossed = Tossed { tally, microseconds };
            let bytes = encode(&chunk, &tossed, HASH).into_bytes();
            prop_assert_eq!(decode(&bytes, &chunk, HASH), Ok(tossed));

            let place = place.index(bytes.len());
            let mut flipped = bytes.clone();
            flipped[place] ^= flip;
            prop_assert!(decode(&flipped, &chunk, HASH).is_err());
            prop_assert!(decode(&bytes[..place], &chunk, HASH).is_err());
            let mut longer = bytes;
            longer.insert(place, inserted);
            prop_assert!(decode(&longer, &chunk, HASH).is_err());
        }
    }
}
