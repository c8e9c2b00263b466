//! Recovery of recordings with damaged bytes.

use crate::common::{Recording, read, recording, salvaged};
use coinmc_recording::Compression;
use proptest::prelude::*;

/// Number of messages recovered; recovering the new recording again loses nothing.
fn recovered_messages(recording: &Recording, bytes: &[u8]) -> usize {
    let Some((recovered, rewritten)) = salvaged(bytes) else {
        return 0;
    };
    let (again, _) = salvaged(&rewritten).expect("a recording");
    assert!(again.was_whole());
    assert_eq!(again.messages, recovered.messages);
    usize::try_from(recovered.messages)
        .unwrap()
        .min(recording.messages.len())
}

/// The longest chunk has ten messages.
const CHUNK: usize = 10;

#[test]
fn a_damaged_byte_costs_at_most_one_chunk() {
    for compression in [Compression::None, Compression::Lz4] {
        let recording = recording(compression);
        let all = recording.messages.len();
        let mut bytes = recording.bytes.clone();
        for i in 0..bytes.len() {
            for flip in [0x01, 0x80, 0xff] {
                bytes[i] ^= flip;
                let found = recovered_messages(&recording, &bytes);
                assert!(found + CHUNK >= all, "byte {i}: {found} of {all}");
                bytes[i] ^= flip;
            }
        }
    }
}

#[test]
fn a_damaged_chunk_is_skipped_entirely() {
    let recording = recording(Compression::None);
    let mut bytes = recording.bytes.clone();
    // inside a message of the second chunk
    let place = bytes.windows(10).enumerate();
    let needle = b"\"chunk\":1,";
    let (i, _) = place.into_iter().find(|(_, w)| w == needle).unwrap();
    bytes[i + 8] = b'7';
    let (recovered, rewritten) = salvaged(&bytes).unwrap();
    assert_eq!((recovered.lost_chunks, recovered.had_end), (1, true));
    assert!(recovered.lost_bytes > 0 && !recovered.was_whole());
    let expected: Vec<_> = recording
        .messages
        .iter()
        .filter(|(_, time, _, _)| !(100_000_000..200_000_000).contains(time))
        .cloned()
        .collect();
    assert_eq!(read(&rewritten), expected);
    // attachments and metadata are kept
    assert_eq!((recovered.attachments, recovered.metadata), (1, 1));
}

#[test]
fn overwritten_or_missing_bytes_cost_only_their_own_chunk() {
    let recording = recording(Compression::Lz4);
    let (from, to) = (recording.flushes[0].0 + 3, recording.flushes[1].0 + 20);
    for filling in [0, 0xaa] {
        let mut bytes = recording.bytes.clone();
        bytes[from..to].fill(filling);
        assert!(recovered_messages(&recording, &bytes) + CHUNK >= recording.messages.len());
    }
    // and with these bytes missing altogether
    let mut bytes = recording.bytes.clone();
    bytes.drain(from..to);
    assert!(recovered_messages(&recording, &bytes) + CHUNK >= recording.messages.len());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damage_never_causes_a_panic(
        compressed in any::<bool>(),
        flips in prop::collection::vec((any::<prop::sample::Index>(), 1..=255_u8), 1..20),
    ) {
        let compression = if compressed { Compression::Lz4 } else { Compression::None };
        let recording = recording(compression);
        let mut bytes = recording.bytes.clone();
        for (index, flip) in flips {
            let i = index.index(bytes.len());
            bytes[i] ^= flip;
        }
        recovered_messages(&recording, &bytes);
    }

    #[test]
    fn neither_do_random_bytes(random in prop::collection::vec(any::<u8>(), 0..2000)) {
        let mut bytes = b"\x89MCAP0\r\n".to_vec();
        bytes.extend_from_slice(&random);
        let (recovered, rewritten) = salvaged(&bytes).expect("it begins like a recording");
        prop_assert_eq!(read(&rewritten).len() as u64, recovered.messages);
    }
}
