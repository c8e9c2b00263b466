//! Records messages that have a type.

use crate::chunk::{RawChannel, RawMessage, RawSchema};
use crate::error::Error;
use crate::schema::Schema;
use crate::sink::Sink;
use crate::writer::{Attachment, Options, Writer};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::BufWriter;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

/// Writes a recording.
///
/// Messages wait in memory for their chunk (1 MiB) to be full; [`flush`](Self::flush) ends it at
/// once, and what was written before survives whatever happens next. Every chunk can be read
/// without the others. A recording that was never finished is read by
/// [`recover`](crate::recover()).
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
    /// What errors call the sink.
    path: Option<PathBuf>,
    json: Vec<u8>,
}

/// A channel of messages of type `T`, of the recorder that gave it.
#[derive(Debug)]
pub struct Channel<T> {
    id: u16,
    messages: PhantomData<fn(&T)>,
}

impl Recorder {
    /// Begins a new file.
    ///
    /// # Errors
    /// [`Error::Exists`] if there is one of that name, or the system's.
    pub fn create(path: &Path, options: &Options) -> Result<Self, Error> {
        let file = OpenOptions::new().write(true).create_new(true).open(path);
        let file = file.map_err(|error| Error::io("create", path, error))?;
        let writer = Writer::new(BufWriter::new(file), options).map_err(|error| error.at(path))?;
        Ok(Self {
            writer,
            path: Some(path.to_owned()),
            json: Vec::new(),
        })
    }
}

impl<S: Sink> Recorder<S> {
    /// Records to any sink.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn new(sink: S, options: &Options) -> Result<Self, Error> {
        Ok(Self {
            writer: Writer::new(sink, options)?,
            path: None,
            json: Vec::new(),
        })
    }

    /// A channel for messages of this type, in JSON. The same topic and schema are the same
    /// channel.
    ///
    /// # Errors
    /// [`Error::TooMany`] or [`Error::TooLong`].
    pub fn channel<T: Serialize>(
        &mut self,
        topic: &str,
        schema: &Schema,
    ) -> Result<Channel<T>, Error> {
        let schema = self.writer.schema(RawSchema {
            name: schema.name.clone().into_owned(),
            encoding: "jsonschema".to_owned(),
            data: schema.text.as_bytes().to_vec(),
        })?;
        let id = self.writer.channel(RawChannel {
            schema,
            topic: topic.to_owned(),
            encoding: "json".to_owned(),
            metadata: BTreeMap::new(),
        })?;
        Ok(Channel {
            id,
            messages: PhantomData,
        })
    }

    /// Records a message at a time, ns. Times of a channel should not run backwards.
    ///
    /// # Errors
    /// [`Error::Message`] if it cannot be told as JSON; those of the sink.
    ///
    /// # Panics
    /// If the channel is another recorder's.
    pub fn write<T: Serialize>(
        &mut self,
        channel: &Channel<T>,
        time_ns: u64,
        message: &T,
    ) -> Result<(), Error> {
        self.json.clear();
        serde_json::to_writer(&mut self.json, message).map_err(|source| Error::Message {
            topic: self.writer.topic(channel.id).to_owned(),
            source,
        })?;
        // the format counts in 32 bits, round and round
        #[allow(clippy::cast_possible_truncation)]
        let sequence = self.writer.count(channel.id) as u32;
        let written = self.writer.message(RawMessage {
            channel: channel.id,
            sequence,
            log_time: time_ns,
            publish_time: time_ns,
            data: &self.json,
        });
        self.named(written)
    }

    /// Ends the chunk and brings everything to the disk: it survives from here on.
    ///
    /// # Errors
    /// Those of the sink.
    pub fn flush(&mut self) -> Result<(), Error> {
        let flushed = self.writer.flush();
        self.named(flushed)
    }

    /// Adds names and values.
    ///
    /// # Errors
    /// [`Error::TooLong`]; those of the sink.
    pub fn metadata(&mut self, name: &str, map: &BTreeMap<String, String>) -> Result<(), Error> {
        let written = self.writer.metadata(name, map);
        self.named(written)
    }

    /// Adds a piece of data that is no message.
    ///
    /// # Errors
    /// [`Error::TooLong`]; those of the sink.
    pub fn attachment(&mut self, attachment: &Attachment<'_>) -> Result<(), Error> {
        let written = self.writer.attachment(attachment);
        self.named(written)
    }

    /// Messages recorded so far.
    pub fn messages(&self) -> u64 {
        self.writer.messages()
    }

    /// Writes the index that readers find their way by, and closes the recording.
    ///
    /// # Errors
    /// Those of the sink; what was flushed can be recovered.
    pub fn finish(self) -> Result<S, Error> {
        let path = self.path;
        self.writer.finish().map_err(|error| match &path {
            Some(path) => error.at(path),
            None => error,
        })
    }

    fn named<T>(&self, result: Result<T, Error>) -> Result<T, Error> {
        result.map_err(|error| match &self.path {
            Some(path) => error.at(path),
            None => error,
        })
    }
}
