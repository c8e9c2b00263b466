//! One session of an experiment: runs robot, camera, journal and recording until all throws are
//! made or the session is cancelled.

use crate::camera::{Camera, CameraError, CameraOptions, PhotoResult};
use crate::clock::{Clock, unix_ms};
use crate::cycle::{Cycle, Halt, Photo, Rules, Step};
use crate::journal::{Entry, Journal, JournalError, Resolution, VoidReason};
use crate::port::{Connection, ConnectionError, LinkEvent, RequestOutcome};
use crate::recording::SessionRecorder;
use crate::{Directory, Experiment, Face};
use coinmc_link::{Counters, Request, Seen, State, Status};
use coinmc_recording::Encoding;
use coinmc_recording::foxglove::LogLevel;
use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};
use thiserror::Error;

/// Polling interval of the robot's status, in the robot's time.
pub const POLL: Duration = Duration::from_millis(100);

/// Greatest speed of the link's clock: with less than 5 ms for a reply, a busy computer would look
/// like a lost connection.
const FASTEST_LINK: f64 = 30.0;

/// Shortest polling interval, wall time.
const SHORTEST_POLL: Duration = Duration::from_millis(1);

/// A cancelled session waits at most this long for a robot that does not reply.
const CANCEL_TIMEOUT: Duration = Duration::from_secs(30);

/// Options of a session.
pub struct SessionOptions<'a> {
    /// The serial port.
    pub port: &'a Path,
    /// The camera.
    pub camera: CameraOptions,
    /// Rules of the cycle.
    pub rules: Rules,
    /// Speed of a simulated robot relative to real time; 1 for a real robot.
    pub speed: f64,
    /// How to encode the recording of the session; `None` for no recording.
    pub record: Option<Encoding>,
    /// Set it to finish the open throw and stop.
    pub cancel: &'a AtomicBool,
    /// Receives progress, notes and warnings.
    pub sink: &'a dyn ProgressSink,
}

/// Receives the progress of a session.
pub trait ProgressSink {
    /// The progress changed.
    fn progress(&self, progress: &Progress);
    /// Information for the user.
    fn note(&self, text: &str);
    /// A warning for the user.
    fn warning(&self, text: &str);
}

/// Progress of a session.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Progress {
    /// The robot's last status; `None` while it is disconnected.
    pub status: Option<Status>,
    /// Throws planned.
    pub planned: u32,
    /// Throws done, by face in the order of [`Face::ALL`].
    pub faces: [u32; 3],
    /// Void throws.
    pub voids: u32,
    /// Throws resolved in this session.
    pub this_session: u32,
    /// Losses of the connection in this session.
    pub losses: u32,
}

impl Progress {
    /// Throws resolved.
    pub fn resolved(&self) -> u32 {
        self.faces.iter().sum::<u32>() + self.voids
    }
}

/// Result of a session.
#[derive(Debug, Clone)]
pub struct SessionReport {
    /// Whether all planned throws are resolved.
    pub complete: bool,
    /// Progress at the end.
    pub progress: Progress,
    /// Statistics of the connection.
    pub counters: Counters,
    /// Round-trip times of requests.
    pub round_trips: RoundTrips,
}

/// Statistics of round-trip times, wall time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RoundTrips {
    /// Number of requests with a reply.
    pub count: u64,
    /// Sum of their times.
    pub sum: Duration,
    /// The longest time.
    pub longest: Duration,
}

/// Why a session ended early. The journal is correct in any case.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SessionError {
    /// The journal cannot be written.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// No communication with the robot is possible.
    #[error(transparent)]
    Connection(#[from] ConnectionError),
    /// The camera cannot be started.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The user must decide.
    #[error(transparent)]
    Halt(#[from] Halt),
    /// The recording cannot be started.
    #[error("cannot record the session: {0}")]
    Recording(coinmc_recording::Error),
}

/// Continues an experiment until it is complete or cancelled.
///
/// # Errors
/// [`SessionError`]
pub fn run_session(
    experiment: &Experiment,
    directory: &Directory,
    journal: Journal,
    options: &SessionOptions<'_>,
) -> Result<SessionReport, SessionError> {
    let clock = Clock::new(options.speed.min(FASTEST_LINK));
    let connection = Connection::open(options.port, clock).map_err(ConnectionError::Port)?;
    let recorder = options
        .record
        .map(|encoding| SessionRecorder::begin(&directory.sessions(), encoding))
        .transpose()
        .map_err(SessionError::Recording)?;
    let mut session = Session {
        experiment,
        options,
        photos: directory.photos(),
        journal,
        cycle: Cycle::new(options.rules),
        connection,
        camera: Camera::start(options.camera.clone())?,
        pending_photos: 0,
        reporter: Reporter {
            sink: options.sink,
            recorder,
            progress: Progress::default(),
            round_trips: RoundTrips::default(),
        },
        cancelled_at: Cell::new(None),
    };
    let ended = session.run();
    session.finish();
    let complete = ended?;
    Ok(SessionReport {
        complete,
        progress: session.reporter.progress.clone(),
        counters: session.connection.counters(),
        round_trips: session.reporter.round_trips,
    })
}

struct Session<'a> {
    experiment: &'a Experiment,
    options: &'a SessionOptions<'a>,
    photos: PathBuf,
    journal: Journal,
    cycle: Cycle,
    connection: Connection,
    camera: Camera,
    /// Photos requested and not yet finished. The last may belong to a throw that has become void,
    /// with the next throw's photo queued behind it.
    pending_photos: u32,
    reporter: Reporter<'a>,
    cancelled_at: Cell<Option<Instant>>,
}

impl Session<'_> {
    fn run(&mut self) -> Result<bool, SessionError> {
        self.reporter.progress = journal_progress(&self.journal, self.options.rules.throws);
        self.options.sink.progress(&self.reporter.progress);
        loop {
            if self.options.cancel.load(Ordering::Relaxed) {
                self.cycle.stop();
            }
            match self.cycle.step(self.journal.history(), unix_ms()) {
                Step::Request(request) => {
                    if !self.request(&request)? {
                        return Ok(false);
                    }
                }
                Step::Wait => self.wait(),
                Step::Announce { throw, id } => {
                    let setting = self.experiment.setting(throw);
                    let at_ms = unix_ms();
                    self.write(&Entry::Announced { id, setting, at_ms })?;
                }
                Step::Write(entry) => self.write(&entry)?,
                Step::Photograph { id, attempt } => {
                    self.camera.take(id, attempt);
                    self.cycle.photographing(id, attempt);
                    self.pending_photos += 1;
                }
                Step::Finished => {
                    let announced = self.journal.history().announced();
                    return Ok(announced >= self.options.rules.throws);
                }
                Step::Halt(halt) => return Err(halt.into()),
            }
        }
    }

    /// Sends a request; whether the session continues.
    fn request(&mut self, request: &Request) -> Result<bool, SessionError> {
        let (cancel, since) = (self.options.cancel, &self.cancelled_at);
        let given_up = || {
            if !cancel.load(Ordering::Relaxed) {
                return false;
            }
            let now = Instant::now();
            let first = since.get().unwrap_or(now);
            since.set(Some(first));
            now - first > CANCEL_TIMEOUT
        };
        let reporter = &mut self.reporter;
        let outcome = self
            .connection
            .request(request, &given_up, &mut |event| reporter.link_event(event))?;
        match outcome {
            RequestOutcome::Reply(reply) => {
                self.cycle.replied(request, &reply);
                let status = self.cycle.status().copied();
                if status.is_some() && self.reporter.progress.status != status {
                    self.reporter.progress.status = status;
                    self.options.sink.progress(&self.reporter.progress);
                }
            }
            RequestOutcome::Connected { greeting, .. } => self.cycle.connected(&greeting),
            RequestOutcome::GivenUp => return Ok(false),
        }
        Ok(true)
    }

    /// Waits for the polling interval, or until a photo is finished.
    fn wait(&mut self) {
        let interval = POLL.div_f64(self.options.speed).max(SHORTEST_POLL);
        if self.pending_photos > 0 {
            if let Some(taken) = self.camera.finished_photo(interval) {
                self.photographed(taken);
            }
        } else {
            thread::sleep(interval);
        }
        self.cycle.waited();
    }

    fn photographed(&mut self, taken: PhotoResult) {
        self.pending_photos = self.pending_photos.saturating_sub(1);
        let PhotoResult {
            id,
            attempt,
            result,
        } = taken;
        let read = match result {
            Ok((face, image)) => {
                let path = self.photos.join(image.as_str());
                self.reporter.record(|to, now| to.photo(&path, now));
                Some((face, image))
            }
            Err(error) => {
                self.reporter
                    .note(&format!("throw {id}, photo {attempt}: {error}"));
                None
            }
        };
        self.cycle.photographed(Photo { id, attempt, read });
    }

    fn write(&mut self, entry: &Entry) -> Result<(), SessionError> {
        self.journal.append(entry)?;
        self.cycle.written(entry);
        match entry {
            Entry::Done { .. } | Entry::Void { .. } => self.resolved(),
            Entry::Adopted { counter } => self.reporter.warning(&format!(
                "the robot's counter is adopted: throws continue with number {}",
                u64::from(*counter) + 1
            )),
            Entry::Announced { .. } | Entry::Read { .. } => {}
        }
        Ok(())
    }

    fn resolved(&mut self) {
        let Some(throw) = self.journal.history().throws().last() else {
            return;
        };
        if let Some(Resolution::Void(reason)) = throw.resolution {
            self.reporter.progress.voids += 1;
            let text = format!("throw {} is void: {}", throw.id, void_text(reason));
            self.reporter.note(&text);
        } else if let Some((reading, _)) = &throw.reading {
            self.reporter.progress.faces[index(reading.face)] += 1;
        }
        self.reporter.progress.this_session += 1;
        self.reporter.record(|to, now| to.result(throw, now));
        self.options.sink.progress(&self.reporter.progress);
    }

    fn finish(&mut self) {
        if let Some(recorder) = self.reporter.recorder.take()
            && let Err(error) = recorder.finish()
        {
            self.reporter
                .warning(&format!("the recording cannot be finished: {error}"));
        }
    }
}

/// Reports to the sink, the log and the recording.
struct Reporter<'a> {
    sink: &'a dyn ProgressSink,
    recorder: Option<SessionRecorder>,
    progress: Progress,
    round_trips: RoundTrips,
}

impl Reporter<'_> {
    fn note(&mut self, text: &str) {
        self.sink.note(text);
        self.record(|to, now| to.log(LogLevel::Info, text, now));
    }

    fn warning(&mut self, text: &str) {
        self.sink.warning(text);
        self.record(|to, now| to.log(LogLevel::Warning, text, now));
    }

    /// Records until recording fails; throws then continue without, because the journal is what
    /// counts.
    fn record(
        &mut self,
        what: impl FnOnce(&mut SessionRecorder, u64) -> Result<(), coinmc_recording::Error>,
    ) {
        let Some(recorder) = &mut self.recorder else {
            return;
        };
        if let Err(error) = what(recorder, unix_ms().saturating_mul(1_000_000)) {
            self.recorder = None;
            self.sink.warning(&format!(
                "{error}. The session continues without a recording; the journal is complete"
            ));
        }
    }

    fn link_event(&mut self, event: &LinkEvent<'_>) {
        match event {
            LinkEvent::Exchanged {
                request,
                reply,
                took,
            } => {
                self.count(*took);
                self.record(|to, now| to.exchange(request, reply, *took, now));
            }
            LinkEvent::Opened(_) => {}
            LinkEvent::Lost { why, .. } => {
                // every failed attempt to reconnect is another event; report only the first
                if self.progress.status.take().is_some() {
                    self.progress.losses += 1;
                    self.note(&format!(
                        "the connection to the robot is lost ({why}); trying again"
                    ));
                    self.sink.progress(&self.progress);
                }
            }
            LinkEvent::Connected { greeting, seen } => {
                let state = format!("boot {}, {}", greeting.boot, state_name(greeting.state));
                match seen {
                    Seen::First => self.note(&format!("connected to the robot ({state})")),
                    Seen::Same => self.note(&format!("reconnected ({state})")),
                    Seen::NewBoot => {
                        self.note(&format!("reconnected; the robot was reset ({state})"));
                    }
                    Seen::Taken => {
                        self.warning("another program uses the same robot; end it");
                    }
                }
            }
        }
    }

    fn count(&mut self, took: Duration) {
        let trips = &mut self.round_trips;
        trips.count += 1;
        trips.sum += took;
        trips.longest = trips.longest.max(took);
    }
}

/// Progress according to the journal.
fn journal_progress(journal: &Journal, planned: u32) -> Progress {
    let mut progress = Progress {
        planned,
        ..Progress::default()
    };
    for throw in journal.history().throws() {
        match (throw.resolution, &throw.reading) {
            (Some(Resolution::Void(_)), _) => progress.voids += 1,
            (Some(Resolution::Done), Some((reading, _))) => {
                progress.faces[index(reading.face)] += 1;
            }
            _ => {}
        }
    }
    progress
}

fn index(face: Face) -> usize {
    match face {
        Face::Heads => 0,
        Face::Tails => 1,
        Face::Side => 2,
    }
}

/// Describes the reason of a void throw.
fn void_text(reason: VoidReason) -> String {
    match reason {
        VoidReason::Unread => "no photo showed a face".to_owned(),
        VoidReason::Fault(code) => format!("the robot stopped with {}", fault_text(code)),
        VoidReason::Lost => "the coin was collected before its face was read".to_owned(),
        VoidReason::Superseded => "the robot's counter is ahead of it".to_owned(),
    }
}

/// Describes a state.
pub fn state_name(state: State) -> &'static str {
    match state {
        State::Boot => "starting",
        State::Idle => "ready",
        State::Aiming => "aiming",
        State::Flying => "flying",
        State::Driving => "driving",
        State::AtCoin => "at the coin",
        State::Returning => "returning",
        State::Fault => "fault",
    }
}

/// Describes a fault.
pub fn fault_text(code: u16) -> String {
    use coinmc_link::fault::{HARDWARE, JOURNAL, LIMIT, RESET, SILENCE, STOPPED};
    let phase = |base: u16| {
        u8::try_from(code - base)
            .ok()
            .and_then(State::from_number)
            .map_or("an unknown phase", state_name)
    };
    let text = match code {
        STOPPED => "stopped".to_owned(),
        SILENCE => "the host was silent".to_owned(),
        JOURNAL => "its memory cannot be written".to_owned(),
        _ if code >= HARDWARE => format!("hardware failure {}", code - HARDWARE),
        _ if code >= LIMIT => format!("{} took too long", phase(LIMIT)),
        _ if code >= RESET => format!("reset while {}", phase(RESET)),
        _ => "unknown".to_owned(),
    };
    format!("fault {code} ({text})")
}
