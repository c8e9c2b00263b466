//! A recording cut off at every byte.

use crate::common::{Recording, read, recording, salvaged};
use coinmc_recording::Compression;

/// What is recovered of the first `n` bytes.
fn check(recording: &Recording, n: usize) {
    let Some((recovered, anew)) = salvaged(&recording.bytes[..n]) else {
        assert!(n < 8, "{n} bytes are the beginning of a recording");
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
    // what comes back is a recording, and nothing is wrong with it
    let (again, _) = salvaged(&anew).unwrap();
    assert!(again.was_whole());
    assert_eq!(again.messages, recovered.messages);
}

#[test]
fn what_was_flushed_comes_back_wherever_the_file_ends() {
    for compression in [Compression::None, Compression::Lz4] {
        let recording = recording(compression);
        for n in 0..=recording.bytes.len() {
            check(&recording, n);
        }
    }
}

#[test]
fn what_comes_back_is_what_was_recorded() {
    let recording = recording(Compression::None);
    for n in (8..recording.bytes.len()).step_by(97) {
        let (_, anew) = salvaged(&recording.bytes[..n]).unwrap();
        let messages = read(&anew);
        assert_eq!(messages, recording.messages[..messages.len()], "{n}");
    }
}

/// An uncompressed chunk is believed as far as it goes.
#[test]
fn messages_of_the_torn_chunk_come_back_too() {
    let recording = recording(Compression::None);
    let &[.., (third, before), (fourth, all)] = &recording.flushes[..] else {
        panic!("four flushes");
    };
    let (recovered, _) = salvaged(&recording.bytes[..third + (fourth - third) * 3 / 4]).unwrap();
    assert!(recovered.messages > before as u64 && recovered.messages < all as u64);
    assert_eq!(recovered.lost_chunks, 1);
}

#[test]
fn rubbish_after_the_cut_is_left_out() {
    let recording = recording(Compression::Lz4);
    let (bytes, messages) = recording.flushes[2];
    for rubbish in [
        vec![0; 5000],
        vec![0xff; 5000],
        b"\x06\x05\x04 chunk?".repeat(500),
    ] {
        let mut file = recording.bytes[..bytes].to_vec();
        file.extend_from_slice(&rubbish);
        let (recovered, _) = salvaged(&file).unwrap();
        assert_eq!(recovered.messages, messages as u64);
        assert_eq!(recovered.lost_bytes, rubbish.len() as u64);
    }
}
