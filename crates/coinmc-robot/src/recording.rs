//! Recording of a session as MCAP: commands, replies, status, photos, results and the log.

use crate::journal::{Resolution, Throw};
use coinmc_link::{Reply, Request, Status};
use coinmc_recording::foxglove::{CompressedImage, Log, LogLevel, Time};
use coinmc_recording::{Channel, Compression, Encoding, Error, Options, Recorder, Schema};
use serde::Serialize;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A new file is started after this time or about this many bytes.
const ROTATE_AFTER: Duration = Duration::from_hours(1);
const ROTATE_BYTES: u64 = 256 << 20;
/// Approximate size of a message, bytes.
const MESSAGE_BYTES: u64 = 200;
/// Largest photo that goes into a recording.
const MAX_IMAGE_BYTES: u64 = 32 << 20;
/// An unchanged status is recorded again after this time.
const SAME_STATUS: Duration = Duration::from_secs(1);

/// Records a session in a sequence of files: `session-0003-01.mcap`, ….
#[derive(Debug)]
pub(crate) struct SessionRecorder {
    folder: PathBuf,
    session: u32,
    part: u32,
    encoding: Encoding,
    file: Option<OpenFile>,
    last_status: Option<(Status, Instant)>,
}

#[derive(Debug)]
struct OpenFile {
    recorder: Recorder,
    channels: Channels,
    started: Instant,
    bytes: u64,
}

#[derive(Debug)]
struct Channels {
    command: Channel<Command>,
    reply: Channel<ReplyMessage>,
    status: Channel<Status>,
    image: Channel<CompressedImage>,
    result: Channel<ThrowResult>,
    log: Channel<Log>,
}

/// `/robot/command`.
#[derive(Debug, Serialize)]
struct Command {
    request: Request,
}

/// `/robot/reply`.
#[derive(Debug, Serialize)]
struct ReplyMessage {
    reply: Reply,
    took_ms: f64,
}

/// `/throw/result`.
#[derive(Debug, Serialize)]
struct ThrowResult {
    id: u32,
    spin_rev_s: f64,
    angle_deg: f64,
    /// Absent from a void throw.
    face: Option<&'static str>,
    measured_spin_rev_s: Option<f64>,
    measured_angle_deg: Option<f64>,
    image: Option<String>,
    /// Why the throw has no result.
    void: Option<String>,
}

/// The messages below, from `robot.proto`.
const PROTOBUF: &[u8] = include_bytes!("robot.bin");

const COMMAND: &str = r#"{"title": "coinmc.RobotCommand", "type": "object", "properties": {
  "request": {"description": "Name and fields of the request, as in the protocol"}}}"#;
const REPLY: &str = r#"{"title": "coinmc.RobotReply", "type": "object", "properties": {
  "reply": {"description": "Name and fields of the reply, as in the protocol"},
  "took_ms": {"type": "number"}}}"#;
const STATUS: &str = r#"{"title": "coinmc.RobotStatus", "type": "object", "properties": {
  "state": {"type": "string"}, "throw_id": {"type": "integer"}, "experiment": {"type": "integer"},
  "spin_mrev_s": {"type": "integer"}, "angle_cdeg": {"type": "integer"}, "released": {"type": "boolean"},
  "meas_spin_mrev_s": {"type": "integer"}, "meas_angle_cdeg": {"type": "integer"},
  "x_um": {"type": "integer"}, "y_um": {"type": "integer"}, "t_ms": {"type": "integer"},
  "t_release_ms": {"type": "integer"}, "fault": {"type": "integer"},
  "rx_bad": {"type": "integer"}}}"#;
const RESULT: &str = r#"{"title": "coinmc.TossResult", "type": "object", "properties": {
  "id": {"type": "integer"}, "spin_rev_s": {"type": "number"}, "angle_deg": {"type": "number"},
  "face": {"type": ["string", "null"]}, "measured_spin_rev_s": {"type": ["number", "null"]},
  "measured_angle_deg": {"type": ["number", "null"]}, "image": {"type": ["string", "null"]},
  "void": {"type": ["string", "null"]}}}"#;

impl SessionRecorder {
    /// Begins the next session in a folder.
    ///
    /// # Errors
    /// System errors.
    pub(crate) fn begin(folder: &Path, encoding: Encoding) -> Result<Self, Error> {
        let last = last_session(folder).map_err(|source| Error::Io {
            action: "list",
            path: folder.to_owned(),
            source,
        })?;
        let Some(session) = last.checked_add(1) else {
            let path = folder.join(format!("session-{last}-01.mcap"));
            return Err(Error::Exists { path });
        };
        let mut recorder = Self {
            folder: folder.to_owned(),
            session,
            part: 0,
            encoding,
            file: None,
            last_status: None,
        };
        recorder.open()?;
        Ok(recorder)
    }

    fn open(&mut self) -> Result<&mut OpenFile, Error> {
        self.part += 1;
        let name = format!("session-{:04}-{:02}.mcap", self.session, self.part);
        let options = Options {
            profile: String::new(),
            library: concat!("coinmc ", env!("CARGO_PKG_VERSION")).to_owned(),
            compression: Compression::Lz4,
            encoding: self.encoding,
        };
        let mut recorder = Recorder::create(&self.folder.join(name), &options)?;
        let channels = Channels::new(&mut recorder)?;
        self.last_status = None;
        Ok(self.file.insert(OpenFile {
            recorder,
            channels,
            started: Instant::now(),
            bytes: 0,
        }))
    }

    /// The open file, or a new one if it is full.
    fn file(&mut self) -> Result<&mut OpenFile, Error> {
        let full =
            |file: &OpenFile| file.started.elapsed() > ROTATE_AFTER || file.bytes > ROTATE_BYTES;
        if self.file.as_ref().is_some_and(full)
            && let Some(file) = self.file.take()
        {
            file.recorder.finish()?;
        }
        if self.file.is_none() {
            self.open()?;
        }
        let file = self.file.as_mut().expect("opened just now");
        file.bytes += MESSAGE_BYTES;
        Ok(file)
    }

    /// Records a request and its reply; a status only if it has changed or some time has passed.
    ///
    /// # Errors
    /// System errors.
    pub(crate) fn exchange(
        &mut self,
        request: &Request,
        reply: &Reply,
        took: Duration,
        time_ns: u64,
    ) -> Result<(), Error> {
        if let (Request::Status, Reply::Status(status)) = (request, reply) {
            return self.status(status, time_ns);
        }
        let file = self.file()?;
        let command = Command { request: *request };
        file.recorder
            .write(&file.channels.command, time_ns, &command)?;
        let reply = ReplyMessage {
            reply: *reply,
            took_ms: took.as_secs_f64() * 1e3,
        };
        file.recorder.write(&file.channels.reply, time_ns, &reply)
    }

    fn status(&mut self, status: &Status, time_ns: u64) -> Result<(), Error> {
        let quiet = |status: &Status| Status {
            t_ms: 0,
            rx_bad: 0,
            ..*status
        };
        if let Some((last, at)) = &self.last_status
            && quiet(last) == quiet(status)
            && at.elapsed() < SAME_STATUS
        {
            return Ok(());
        }
        let file = self.file()?;
        file.recorder
            .write(&file.channels.status, time_ns, status)?;
        self.last_status = Some((*status, Instant::now()));
        Ok(())
    }

    /// Records a photo from its file.
    ///
    /// # Errors
    /// System errors.
    pub(crate) fn photo(&mut self, path: &Path, time_ns: u64) -> Result<(), Error> {
        let io = |source| Error::Io {
            action: "read",
            path: path.to_owned(),
            source,
        };
        if fs::metadata(path).map_err(io)?.len() > MAX_IMAGE_BYTES {
            return self.log(LogLevel::Warning, "a photo is too large to record", time_ns);
        }
        let data = fs::read(path).map_err(io)?;
        let format = match path.extension().and_then(|ending| ending.to_str()) {
            Some("jpg" | "jpeg") => "jpeg",
            Some(other) => other,
            None => "",
        };
        let message = CompressedImage {
            timestamp: Time::from_ns(time_ns),
            frame_id: "camera".to_owned(),
            format: format.to_owned(),
            data,
        };
        let file = self.file()?;
        file.bytes += message.data.len() as u64;
        file.recorder.write(&file.channels.image, time_ns, &message)
    }

    /// Records a resolved throw. Everything recorded so far is on disk when this returns.
    ///
    /// # Errors
    /// System errors.
    pub(crate) fn result(&mut self, throw: &Throw, time_ns: u64) -> Result<(), Error> {
        let reading = throw.reading.as_ref().map(|(reading, _)| reading);
        let result = ThrowResult {
            id: throw.id,
            spin_rev_s: throw.setting.spin_rev_s(),
            angle_deg: throw.setting.angle_deg(),
            face: reading.map(|r| r.face.name()),
            measured_spin_rev_s: reading.map(|r| f64::from(r.measured.spin_mrev_s) / 1e3),
            measured_angle_deg: reading.map(|r| f64::from(r.measured.angle_cdeg) / 1e2),
            image: reading.map(|r| r.image.as_str().to_owned()),
            void: match throw.resolution {
                Some(Resolution::Void(reason)) => Some(reason.to_string()),
                _ => None,
            },
        };
        let file = self.file()?;
        file.recorder
            .write(&file.channels.result, time_ns, &result)?;
        file.recorder.flush()
    }

    /// Records a log message.
    ///
    /// # Errors
    /// System errors.
    pub(crate) fn log(
        &mut self,
        level: LogLevel,
        message: &str,
        time_ns: u64,
    ) -> Result<(), Error> {
        let log = Log {
            timestamp: Time::from_ns(time_ns),
            level,
            message: message.to_owned(),
            name: "coinmc robot".to_owned(),
            file: String::new(),
            line: 0,
        };
        let file = self.file()?;
        file.recorder.write(&file.channels.log, time_ns, &log)
    }

    /// Ends the recording.
    ///
    /// # Errors
    /// System errors.
    pub(crate) fn finish(mut self) -> Result<(), Error> {
        match self.file.take() {
            Some(file) => file.recorder.finish().map(drop),
            None => Ok(()),
        }
    }
}

impl Channels {
    fn new(recorder: &mut Recorder) -> Result<Self, Error> {
        let own = |name, json| Schema::new(name, json, PROTOBUF);
        Ok(Self {
            command: recorder.channel("/robot/command", &own("coinmc.RobotCommand", COMMAND))?,
            reply: recorder.channel("/robot/reply", &own("coinmc.RobotReply", REPLY))?,
            status: recorder.channel("/robot/status", &own("coinmc.RobotStatus", STATUS))?,
            image: recorder.channel("/camera/image", &Schema::COMPRESSED_IMAGE)?,
            result: recorder.channel("/throw/result", &own("coinmc.TossResult", RESULT))?,
            log: recorder.channel("/log", &Schema::LOG)?,
        })
    }
}

/// The greatest session number recorded in a folder; 0 if there is none.
fn last_session(folder: &Path) -> io::Result<u32> {
    let mut last = 0;
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name();
        let number = name
            .to_str()
            .and_then(|name| name.strip_prefix("session-"))
            .and_then(|rest| rest.split('-').next())
            .and_then(|number| number.parse().ok());
        last = last.max(number.unwrap_or(0));
    }
    Ok(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A session follows the last one; after the last number that there is none can begin.
    #[test]
    fn a_session_has_the_next_number() {
        let folder = tempfile::tempdir().expect("a folder");
        let begin = || SessionRecorder::begin(folder.path(), Encoding::Protobuf);
        fs::write(folder.path().join("session-0007-01.mcap"), "").expect("a file");
        assert_eq!(begin().expect("a session").session, 8);
        fs::write(folder.path().join("session-4294967295-01.mcap"), "").expect("a file");
        assert!(matches!(begin(), Err(Error::Exists { .. })));
    }
}
