//! Recovery of a recording cut off at every byte.

use crate::common::{Recording, read, recording, salvaged};
use coinmc_recording::Compression;

/// Checks what is recovered from the first `n` bytes.
fn check(recording: &Recording, n: usize) {
    let Some((recovered, rewritten)) = salvaged(&recording.bytes[..n]) else {
        assert!(n < 8, "{n} bytes identify a recording");
        return;
    };
    let flushed = recording
        .flushes
        .iter()
        .rev()
        .find(|(bytes, _)| *bytes <= n);
    let flushed = flushed.map_or(0, |(_, messages)| *messages);
    let messages = usize::try_from(recovered.messages).unwrap();
    assert!(messages >= flushed, "{n}: {messages} of {flushed}");
    assert_eq!(recovered.had_end, n == recording.bytes.len());
    // the new file is a recording without errors
    let (again, _) = salvaged(&rewritten).unwrap();
    assert!(again.was_whole());
    assert_eq!(again.messages, recovered.messages);
}

#[test]
fn flushed_messages_are_recovered_wherever_the_file_ends() {
    for compression in [Compression::None, Compression::Lz4] {
        let recording = recording(compression);
        for n in 0..=recording.bytes.len() {
            check(&recording, n);
        }
    }
}

#[test]
fn recovered_messages_are_those_recorded() {
    let recording = recording(Compression::None);
    for n in (8..recording.bytes.len()).step_by(97) {
        let (_, rewritten) = salvaged(&recording.bytes[..n]).unwrap();
        let messages = read(&rewritten);
        assert_eq!(messages, recording.messages[..messages.len()], "{n}");
    }
}

/// The beginning of an uncompressed chunk can be read.
#[test]
fn messages_of_a_torn_chunk_are_recovered() {
    let recording = recording(Compression::None);
    let &[.., (third, before), (fourth, all)] = &recording.flushes[..] else {
        panic!("four flushes");
    };
    let (recovered, _) = salvaged(&recording.bytes[..third + (fourth - third) * 3 / 4]).unwrap();
    assert!(recovered.messages > before as u64 && recovered.messages < all as u64);
    assert_eq!(recovered.lost_chunks, 1);
}

#[test]
fn garbage_at_the_end_is_skipped() {
    let recording = recording(Compression::Lz4);
    let (bytes, messages) = recording.flushes[2];
    for garbage in [
        vec![0; 5000],
        vec![0xff; 5000],
        b"\x06\x05\x04 chunk?".repeat(500),
    ] {
        let mut file = recording.bytes[..bytes].to_vec();
        file.extend_from_slice(&garbage);
        let (recovered, _) = salvaged(&file).unwrap();
        assert_eq!(recovered.messages, messages as u64);
        assert_eq!(recovered.lost_bytes, garbage.len() as u64);
    }
}
