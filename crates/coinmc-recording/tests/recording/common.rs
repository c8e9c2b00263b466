//! A small recording with known content.

use coinmc_recording::foxglove::{FrameTransform, Quaternion, Time, Vector3};
use coinmc_recording::{
    Attachment, Compression, Encoding, Options, Recorder, Recovered, Schema, Unsynced, salvage,
};
use serde_json::{Value, json};
use std::io::Cursor;

/// A message as a reader sees it: topic, log time, sequence number, JSON.
pub(crate) type ReadMessage = (String, u64, u32, Value);

/// Bytes of a recording.
pub(crate) struct Recording {
    pub(crate) bytes: Vec<u8>,
    pub(crate) messages: Vec<ReadMessage>,
    /// Bytes and messages so far, after each flush.
    pub(crate) flushes: Vec<(usize, usize)>,
}

pub(crate) fn options(compression: Compression) -> Options {
    Options {
        profile: "test".to_owned(),
        library: "coinmc test".to_owned(),
        compression,
        encoding: Encoding::Json,
    }
}

pub(crate) fn transform(time_ns: u64) -> FrameTransform {
    FrameTransform {
        timestamp: Time::from_ns(time_ns),
        parent_frame_id: "world".to_owned(),
        child_frame_id: "coin".to_owned(),
        translation: Vector3::new(0.1, -2.5e-3, 1.0 / 3.0),
        rotation: Quaternion::IDENTITY,
    }
}

/// A buffer whose length a test can read while a recorder writes to it.
#[derive(Clone, Default)]
pub(crate) struct Shared(std::rc::Rc<std::cell::RefCell<Vec<u8>>>);

impl std::io::Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Shared {
    pub(crate) fn len(&self) -> usize {
        self.0.borrow().len()
    }

    pub(crate) fn bytes(&self) -> Vec<u8> {
        self.0.borrow().clone()
    }
}

/// Four chunks of messages on two channels, metadata and an attachment.
pub(crate) fn recording(compression: Compression) -> Recording {
    let shared = Shared::default();
    let mut recorder = Recorder::new(Unsynced(shared.clone()), &options(compression)).unwrap();
    let transforms = recorder
        .channel::<FrameTransform>("/tf", &Schema::FRAME_TRANSFORM)
        .unwrap();
    let own = Schema::new("coinmc.test", r#"{"type": "object"}"#, b"");
    let values = recorder.channel::<Value>("/values", &own).unwrap();
    let (mut messages, mut flushes) = (Vec::new(), Vec::new());
    for chunk in 0..4_u32 {
        for i in 0..5 {
            let time = u64::from(chunk * 100 + i) * 1_000_000;
            let sequence = chunk * 5 + i;
            let value = json!({ "chunk": chunk, "i": i, "text": "tossed" });
            recorder.write(&values, time, &value).unwrap();
            messages.push(("/values".to_owned(), time, sequence, value));
            if chunk % 2 == 0 {
                let transform = transform(time);
                recorder.write(&transforms, time, &transform).unwrap();
                let json = serde_json::to_value(&transform).unwrap();
                let sequence = chunk / 2 * 5 + i;
                messages.push(("/tf".to_owned(), time, sequence, json));
            }
        }
        recorder.flush().unwrap();
        flushes.push((shared.len(), messages.len()));
        if chunk == 1 {
            let map = [("config".to_owned(), "seed = 1".to_owned())].into();
            recorder.metadata("run", &map).unwrap();
            let attachment = Attachment {
                name: "config.toml",
                media_type: "application/toml",
                log_time_ns: 7,
                create_time_ns: 0,
                data: b"seed = 1\n",
            };
            recorder.attachment(&attachment).unwrap();
        }
    }
    recorder.finish().unwrap();
    Recording {
        bytes: shared.bytes(),
        messages,
        flushes,
    }
}

/// Messages as the `mcap` crate reads them, with every checksum validated.
pub(crate) fn read(bytes: &[u8]) -> Vec<ReadMessage> {
    use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
    let checks = LinearReaderOptions::default()
        .with_validate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true);
    let mut reader = LinearReader::new_with_options(checks);
    let mut rest = bytes;
    while let Some(event) = reader.next_event() {
        match event.expect("valid records") {
            LinearReadEvent::ReadRequest(n) => {
                let n = n.min(rest.len());
                reader.insert(n).copy_from_slice(&rest[..n]);
                reader.notify_read(n);
                rest = &rest[n..];
            }
            LinearReadEvent::Record { .. } => {}
        }
    }
    mcap::MessageStream::new(bytes)
        .expect("a recording")
        .map(|message| {
            let message = message.expect("a message");
            assert_eq!(message.channel.message_encoding, "json");
            let schema = message.channel.schema.as_ref().expect("a schema");
            assert_eq!(schema.encoding, "jsonschema");
            serde_json::from_slice::<Value>(&schema.data).expect("a schema is JSON");
            (
                message.channel.topic.clone(),
                message.log_time,
                message.sequence,
                serde_json::from_slice(&message.data).expect("JSON"),
            )
        })
        .collect()
}

/// Salvages bytes: the report and the new recording, or `None` if the bytes are not a recording.
pub(crate) fn salvaged(bytes: &[u8]) -> Option<(Recovered, Vec<u8>)> {
    let shared = Shared::default();
    match salvage(Cursor::new(bytes), Unsynced(shared.clone())) {
        Ok(recovered) => Some((recovered, shared.bytes())),
        Err(coinmc_recording::Error::NotMcap { .. }) => None,
        Err(error) => panic!("{error}"),
    }
}
