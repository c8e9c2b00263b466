//! Another reader reads exactly what was recorded.

use crate::common::{options, read, recording, salvaged, transform};
use coinmc_recording::foxglove::FrameTransform;
use coinmc_recording::{Compression, Recorder, Schema};
use std::fs;

#[test]
fn another_reader_finds_every_message_and_no_wrong_checksum() {
    let recording = recording(Compression::None);
    assert_eq!(read(&recording.bytes), recording.messages);
}

#[test]
fn counts_and_offsets_in_the_summary_are_correct() {
    let recording = recording(Compression::None);
    let bytes = &recording.bytes;
    let summary = mcap::Summary::read(bytes).unwrap().expect("a summary");
    let statistics = summary.stats.as_ref().expect("statistics");
    assert_eq!(statistics.message_count, recording.messages.len() as u64);
    assert_eq!((statistics.schema_count, statistics.channel_count), (2, 2));
    assert_eq!(
        (
            statistics.chunk_count,
            statistics.attachment_count,
            statistics.metadata_count
        ),
        (4, 1, 1)
    );
    let times = recording.messages.iter().map(|(_, time, _, _)| *time);
    assert_eq!(Some(statistics.message_start_time), times.clone().min());
    assert_eq!(Some(statistics.message_end_time), times.max());
    assert_eq!(
        statistics.channel_message_counts.values().sum::<u64>(),
        statistics.message_count
    );
    let mut count = 0;
    for chunk in &summary.chunk_indexes {
        for message in summary.stream_chunk(bytes, chunk).unwrap() {
            let message = message.unwrap();
            assert!(
                (chunk.message_start_time..=chunk.message_end_time).contains(&message.log_time)
            );
            count += 1;
        }
        for (channel, entries) in summary.read_message_indexes(bytes, chunk).unwrap() {
            for entry in entries {
                let found = summary.seek_message(bytes, chunk, &entry).unwrap();
                assert_eq!((found.log_time, &found.channel), (entry.log_time, &channel));
            }
        }
    }
    assert_eq!(count, recording.messages.len());
    let attachment = mcap::read::attachment(bytes, &summary.attachment_indexes[0]).unwrap();
    assert_eq!(
        (&*attachment.data, attachment.log_time),
        (&b"seed = 1\n"[..], 7)
    );
    let metadata = mcap::read::metadata(bytes, &summary.metadata_indexes[0]).unwrap();
    assert_eq!(metadata.metadata["config"], "seed = 1");
}

/// The Python tests read compressed chunks with another reader; here they are only recovered.
#[test]
fn compressed_messages_are_recovered() {
    let (plain, packed) = (recording(Compression::None), recording(Compression::Lz4));
    assert!(packed.bytes.len() < plain.bytes.len());
    let (recovered, _) = salvaged(&packed.bytes).unwrap();
    assert!(recovered.was_whole());
    assert_eq!(recovered.messages, plain.messages.len() as u64);
}

#[test]
fn the_same_messages_give_the_same_bytes() {
    for compression in [Compression::None, Compression::Lz4] {
        assert_eq!(recording(compression).bytes, recording(compression).bytes);
    }
}

#[test]
fn full_chunks_end_without_a_flush() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("long.mcap");
    let mut recorder = Recorder::create(&path, &options(Compression::None)).unwrap();
    let channel = recorder
        .channel::<FrameTransform>("/tf", &Schema::FRAME_TRANSFORM)
        .unwrap();
    for i in 0..20_000 {
        recorder.write(&channel, i, &transform(i)).unwrap();
    }
    // most of it can be recovered while it is still being written
    let (recovered, _) = salvaged(&fs::read(&path).unwrap()).unwrap();
    assert!(!recovered.had_end && recovered.messages > 10_000);
    recorder.finish().unwrap();
    assert_eq!(read(&fs::read(&path).unwrap()).len(), 20_000);
}

#[test]
fn flushed_messages_are_on_disk_while_the_recorder_is_open() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("session.mcap");
    let mut recorder = Recorder::create(&path, &options(Compression::Lz4)).unwrap();
    let channel = recorder
        .channel::<FrameTransform>("/tf", &Schema::FRAME_TRANSFORM)
        .unwrap();
    for i in 0..3 {
        recorder.write(&channel, i, &transform(i)).unwrap();
        recorder.flush().unwrap();
        recorder.write(&channel, i, &transform(i)).unwrap();
        let (recovered, _) = salvaged(&fs::read(&path).unwrap()).unwrap();
        assert_eq!((recovered.messages, recovered.lost_bytes), (2 * i + 1, 0));
    }
}
