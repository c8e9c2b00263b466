//! The typed recorder: encodes messages and writes them.

use crate::chunk::{RawChannel, RawMessage, RawSchema};
use crate::encoding::Encoding;
use crate::error::Error;
use crate::protobuf;
use crate::schema::Schema;
use crate::sink::Sink;
use crate::writer::{Attachment, Options, Writer};
use prost_reflect::MessageDescriptor;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::BufWriter;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

/// Writes a recording.
///
/// Messages are buffered until their chunk is full (1 MiB); [`flush`](Self::flush) ends the chunk
/// early, and everything written before survives whatever happens next. Every chunk can be read
/// without the others. [`recover`](crate::recover()) reads recordings that were never finished.
///
/// # Example
/// ```
/// use coinmc_recording::foxglove::{Log, LogLevel, Time};
/// use coinmc_recording::{Options, Recorder, Schema};
/// # fn main() -> Result<(), coinmc_recording::Error> {
/// # let dir = tempfile::tempdir().unwrap();
/// # let path = dir.path().join("session.mcap");
/// let mut recorder = Recorder::create(&path, &Options::default())?;
/// let log = recorder.channel::<Log>("/log", &Schema::LOG)?;
/// let time_ns = 1_500_000_000;
/// recorder.write(&log, time_ns, &Log {
///     timestamp: Time::from_ns(time_ns),
///     level: LogLevel::Info,
///     message: "tossed".to_owned(),
///     name: "robot".to_owned(),
///     file: String::new(),
///     line: 0,
/// })?;
/// recorder.flush()?;          // safe from here on
/// recorder.finish()?;
/// assert!(Recorder::create(&path, &Options::default()).is_err()); // nothing is overwritten
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Recorder<S: Sink = BufWriter<File>> {
    writer: Writer<S>,
    /// Path of the sink, for errors.
    path: Option<PathBuf>,
    encoding: Encoding,
    /// The message that is being written.
    encoded: Vec<u8>,
}

/// A channel for messages of type `T`, valid for the recorder that created it.
#[derive(Debug)]
pub struct Channel<T> {
    id: u16,
    /// What a message is in Protobuf; `None` for JSON.
    protobuf: Option<MessageDescriptor>,
    messages: PhantomData<fn(&T)>,
}

impl Recorder {
    /// Begins a new file.
    ///
    /// # Errors
    /// [`Error::Exists`] if a file of that name exists; system errors.
    pub fn create(path: &Path, options: &Options) -> Result<Self, Error> {
        let file = OpenOptions::new().write(true).create_new(true).open(path);
        let file = file.map_err(|error| Error::io("create", path, error))?;
        let writer =
            Writer::new(BufWriter::new(file), options).map_err(|error| error.with_path(path))?;
        Ok(Self {
            writer,
            path: Some(path.to_owned()),
            encoding: options.encoding,
            encoded: Vec::new(),
        })
    }
}

impl<S: Sink> Recorder<S> {
    /// Records to any sink.
    ///
    /// # Errors
    /// Errors of the sink.
    pub fn new(sink: S, options: &Options) -> Result<Self, Error> {
        Ok(Self {
            writer: Writer::new(sink, options)?,
            path: None,
            encoding: options.encoding,
            encoded: Vec::new(),
        })
    }

    /// Adds a channel for messages of this type. The same topic and schema give the same channel.
    ///
    /// # Errors
    /// [`Error::Schema`] if the schema does not define the message; [`Error::TooMany`] or
    /// [`Error::TooLong`].
    pub fn channel<T: Serialize>(
        &mut self,
        topic: &str,
        schema: &Schema,
    ) -> Result<Channel<T>, Error> {
        let name = schema.name.clone().into_owned();
        let (data, protobuf) = match self.encoding {
            Encoding::Json => (schema.json.as_bytes(), None),
            Encoding::Protobuf => {
                let message = protobuf::message_of(&schema.protobuf, &name);
                let message = message.map_err(|source| Error::Schema {
                    topic: topic.to_owned(),
                    source,
                })?;
                (&*schema.protobuf, Some(message))
            }
        };
        let schema = self.writer.schema(RawSchema {
            name,
            encoding: self.encoding.of_schemas().to_owned(),
            data: data.to_vec(),
        })?;
        let id = self.writer.channel(RawChannel {
            schema,
            topic: topic.to_owned(),
            encoding: self.encoding.of_messages().to_owned(),
            metadata: BTreeMap::new(),
        })?;
        Ok(Channel {
            id,
            protobuf,
            messages: PhantomData,
        })
    }

    /// Records a message with its log time, ns. Times on a channel should not decrease.
    ///
    /// # Errors
    /// [`Error::Message`] if the message cannot be serialised, [`Error::Schema`] if its schema does not
    /// describe it; errors of the sink.
    ///
    /// # Panics
    /// If the channel belongs to another recorder.
    pub fn write<T: Serialize>(
        &mut self,
        channel: &Channel<T>,
        time_ns: u64,
        message: &T,
    ) -> Result<(), Error> {
        self.encode(channel, message)?;
        // sequence numbers of the format wrap at 32 bits
        #[allow(clippy::cast_possible_truncation)]
        let sequence = self.writer.count(channel.id) as u32;
        let written = self.writer.message(RawMessage {
            channel: channel.id,
            sequence,
            log_time: time_ns,
            publish_time: time_ns,
            data: &self.encoded,
        });
        with_path(written, self.path.as_deref())
    }

    /// Encodes a message.
    fn encode<T: Serialize>(&mut self, channel: &Channel<T>, message: &T) -> Result<(), Error> {
        self.encoded.clear();
        let topic = || self.writer.topic(channel.id).to_owned();
        let unserialisable = |source| Error::Message {
            topic: topic(),
            source,
        };
        let Some(protobuf) = &channel.protobuf else {
            return serde_json::to_writer(&mut self.encoded, message).map_err(unserialisable);
        };
        let json = serde_json::to_value(message).map_err(unserialisable)?;
        protobuf::encode(protobuf, &json, &mut self.encoded).map_err(|source| Error::Schema {
            topic: topic(),
            source,
        })
    }

    /// Ends the chunk and syncs everything so far to disk, so that it survives a crash.
    ///
    /// # Errors
    /// Errors of the sink.
    pub fn flush(&mut self) -> Result<(), Error> {
        let flushed = self.writer.flush();
        with_path(flushed, self.path.as_deref())
    }

    /// Adds a metadata record.
    ///
    /// # Errors
    /// [`Error::TooLong`]; errors of the sink.
    pub fn metadata(&mut self, name: &str, map: &BTreeMap<String, String>) -> Result<(), Error> {
        let written = self.writer.metadata(name, map);
        with_path(written, self.path.as_deref())
    }

    /// Adds an attachment.
    ///
    /// # Errors
    /// [`Error::TooLong`]; errors of the sink.
    pub fn attachment(&mut self, attachment: &Attachment<'_>) -> Result<(), Error> {
        let written = self.writer.attachment(attachment);
        with_path(written, self.path.as_deref())
    }

    /// Number of messages recorded so far.
    pub fn messages(&self) -> u64 {
        self.writer.messages()
    }

    /// Writes the index and closes the recording.
    ///
    /// # Errors
    /// Errors of the sink; everything flushed can still be recovered.
    pub fn finish(self) -> Result<S, Error> {
        with_path(self.writer.finish(), self.path.as_deref())
    }
}

fn with_path<T>(result: Result<T, Error>, path: Option<&Path>) -> Result<T, Error> {
    result.map_err(|error| match path {
        Some(path) => error.with_path(path),
        None => error,
    })
}
