//! Wrong lengths, full disks, existing files and limits.

use crate::common::{options, recording, salvaged, transform};
use coinmc_recording::foxglove::FrameTransform;
use coinmc_recording::{Compression, Error, Options, Recorder, Schema, Unsynced, recover};
use serde_json::Value;
use std::fs;

/// A record that claims any length.
fn record(kind: u8, length: u64, content: &[u8]) -> Vec<u8> {
    [&[kind][..], &length.to_le_bytes(), content].concat()
}

#[test]
fn wrong_lengths_cost_neither_memory_nor_other_records() {
    let recording = recording(Compression::None);
    let (at, _) = recording.flushes[1];
    for kind in 0..=255 {
        for length in [0, 1, 1 << 20, 1 << 40, u64::MAX - 8, u64::MAX] {
            let wrong = record(kind, length, b"");
            let mut bytes = recording.bytes.clone();
            bytes.splice(at..at, wrong);
            let (recovered, _) = salvaged(&bytes).unwrap();
            // nothing distinguishes these from the end of the file
            let ends_file = matches!(kind, 0x02 | 0x0f);
            let found = usize::try_from(recovered.messages).unwrap();
            assert!(
                found == recording.messages.len() || ends_file,
                "kind {kind:#x}, length {length}: {found}"
            );
        }
    }
}

/// The chunk claims to decompress to an exabyte.
#[test]
fn a_chunk_decompresses_to_no_more_than_the_limit() {
    let mut packed = lz4_frame();
    let mut content = [0_u64, 0, u64::MAX >> 4]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect::<Vec<_>>();
    content.extend_from_slice(&1_u32.to_le_bytes());
    content.extend_from_slice(&3_u32.to_le_bytes());
    content.extend_from_slice(b"lz4");
    content.extend_from_slice(&(packed.len() as u64).to_le_bytes());
    content.append(&mut packed);
    let mut bytes = b"\x89MCAP0\r\n".to_vec();
    bytes.extend(record(6, content.len() as u64, &content));
    let (recovered, _) = salvaged(&bytes).unwrap();
    assert_eq!((recovered.messages, recovered.lost_chunks), (0, 1));
}

/// The beginning of an LZ4 frame.
fn lz4_frame() -> Vec<u8> {
    let recording = recording(Compression::Lz4);
    let start = recording
        .bytes
        .windows(4)
        .position(|four| four == [0x04, 0x22, 0x4d, 0x18])
        .expect("an LZ4 frame");
    recording.bytes[start..start + 200].to_vec()
}

/// Messages of one byte with a schema of 2 MB, and metadata after each: the recovered file repeats the schema in
/// every chunk, but is no more than twice as long, and a schema at its end.
#[test]
fn a_recovered_file_is_not_much_longer_than_the_damaged_one() {
    let text = |text: &[u8]| [&u32::try_from(text.len()).unwrap().to_le_bytes(), text].concat();
    let schema = vec![b' '; 2_000_000];
    let schema = [
        &1_u16.to_le_bytes()[..],
        &text(b"s"),
        &text(b""),
        &text(&schema),
    ]
    .concat();
    let channel = [&[1, 0, 1, 0][..], &text(b"c"), &text(b""), &text(b"")].concat();
    let message = [&[1, 0][..], &[0; 20], b"m"].concat();
    let metadata = [text(b"n"), text(b"")].concat();
    let mut bytes = b"\x89MCAP0\r\n".to_vec();
    for (kind, content) in [(3, schema), (4, channel)] {
        bytes.extend(record(kind, content.len() as u64, &content));
    }
    for _ in 0..100 {
        for (kind, content) in [(5, &message), (12, &metadata)] {
            bytes.extend(record(kind, content.len() as u64, content));
        }
    }
    let (recovered, file) = salvaged(&bytes).unwrap();
    assert_eq!((recovered.messages, recovered.metadata), (100, 100));
    assert!(file.len() < 3 * bytes.len(), "{}", file.len());
}

#[test]
fn existing_files_are_not_overwritten() {
    let dir = tempfile::tempdir().unwrap();
    let (first, second) = (dir.path().join("a.mcap"), dir.path().join("b.mcap"));
    fs::write(&first, recording(Compression::None).bytes).unwrap();
    fs::write(&second, "precious").unwrap();
    for path in [&first, &second] {
        assert!(matches!(
            Recorder::create(path, &Options::default()),
            Err(Error::Exists { .. })
        ));
        assert!(matches!(recover(&first, path), Err(Error::Exists { .. })));
    }
    assert_eq!(fs::read_to_string(&second).unwrap(), "precious");
    let third = dir.path().join("c.mcap");
    assert!(recover(&first, &third).unwrap().was_whole());
    assert!(matches!(
        recover(&second, &dir.path().join("d.mcap")),
        Err(Error::NotMcap { .. })
    ));
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 3);
}

/// A disk with room for this many bytes.
struct SmallDisk(usize);

impl std::io::Write for SmallDisk {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let left = self.0.checked_sub(bytes.len());
        self.0 = left.ok_or(std::io::ErrorKind::StorageFull)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[cfg(target_os = "linux")]
#[test]
fn after_an_error_of_the_disk_the_recorder_writes_nothing_more() {
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    assert!(Recorder::new(full, &Options::default()).is_err());
    let mut recorder =
        Recorder::new(Unsynced(SmallDisk(1000)), &options(Compression::None)).unwrap();
    let channel = recorder
        .channel::<FrameTransform>("/tf", &Schema::FRAME_TRANSFORM)
        .unwrap();
    recorder.write(&channel, 0, &transform(0)).unwrap();
    assert!(matches!(recorder.flush(), Err(Error::Stream(_))));
    assert!(matches!(
        recorder.write(&channel, 1, &transform(1)),
        Err(Error::Broken)
    ));
    assert!(recorder.finish().is_err());
}

#[test]
fn too_long_messages_and_too_many_channels_are_rejected() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.mcap");
    let mut recorder = Recorder::create(&path, &options(Compression::None)).unwrap();
    let schema = Schema::new("any", "{}", b"");
    let channel = recorder.channel::<Value>("/long", &schema).unwrap();
    let long = Value::String("x".repeat(65 << 20));
    assert!(matches!(
        recorder.write(&channel, 0, &long),
        Err(Error::TooLong { .. })
    ));
    // the recording can continue
    recorder.write(&channel, 0, &Value::Null).unwrap();
    let full =
        (0..=u16::MAX).find_map(|i| recorder.channel::<Value>(&format!("/{i}"), &schema).err());
    assert!(matches!(full, Some(Error::TooMany { .. })));
    recorder.finish().unwrap();
    assert_eq!(crate::common::read(&fs::read(&path).unwrap()).len(), 1);
}
