//! One session of an experiment: runs robot, camera, journal and recording until all throws are
//! made or the session is cancelled.

use crate::camera::{Camera, CameraError, CameraFailure, CameraOptions, PhotoResult};
use crate::clock::{Clock, unix_ms};
use crate::cycle::{Cycle, Halt, Photo, Rules, Shown, Step};
use crate::files::free_bytes;
use crate::journal::{Entry, Journal, JournalError, Resolution};
use crate::liveness::Liveness;
use crate::port::{Connection, ConnectionError, RequestOutcome};
use crate::recording::SessionRecorder;
use crate::reporter::{Progress, ProgressSink, Reporter, RoundTrips, index, journal_progress};
use crate::words::void_text;
use crate::{Directory, Experiment};
use coinmc_link::{Counters, Reply, Request};
use coinmc_recording::Encoding;
use std::cell::Cell;
use std::path::Path;
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

/// A robot that does not answer Stop for this long stops by itself: no valid frame arrives.
const STOP_TIMEOUT: Duration = Duration::from_secs(6);

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
    /// Set it to switch off the robot's motors at once and leave.
    pub stop: &'a AtomicBool,
    /// How long to wait for the port at the start; `None`: not at all.
    pub wait: Option<Duration>,
    /// Without any progress for this long the session halts.
    pub stall: Duration,
    /// Free space below which no throw begins, bytes.
    pub min_free: u64,
    /// Receives progress, notes and warnings.
    pub sink: &'a dyn ProgressSink,
}

/// Result of a session.
#[derive(Debug, Clone)]
pub struct SessionReport {
    /// Whether all planned throws are resolved.
    pub complete: bool,
    /// Whether it was stopped at once, and if so, whether the robot has confirmed it.
    pub stopped: Option<bool>,
    /// Progress at the end.
    pub progress: Progress,
    /// Statistics of the connection.
    pub counters: Counters,
    /// Round-trip times of requests.
    pub round_trips: RoundTrips,
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
    /// The camera cannot be started, or its test photo failed. No throw was made.
    #[error("{0}. No throw was made")]
    Camera(#[from] CameraFailure),
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
    let left = || options.cancel.load(Ordering::Relaxed) || options.stop.load(Ordering::Relaxed);
    let connection = Connection::open_within(options.port, clock, options.wait, &left)
        .map_err(ConnectionError::Port)?;
    let recorder = options
        .record
        .map(|encoding| SessionRecorder::begin(&directory.sessions(), encoding))
        .transpose()
        .map_err(SessionError::Recording)?;
    let mut camera = options.camera.clone();
    camera.seen = journal.history().digests().collect();
    let rules = Rules {
        experiment: journal.header().experiment,
        ..options.rules.clone()
    };
    let mut session = Session {
        experiment,
        options,
        directory,
        journal,
        cycle: Cycle::new(rules, env!("CARGO_PKG_VERSION")),
        connection,
        camera: Camera::start(camera)?,
        pending_photos: 0,
        reporter: Reporter {
            sink: options.sink,
            recorder,
            progress: Progress::default(),
            round_trips: RoundTrips::default(),
        },
        liveness: Liveness::new(options.stall),
        entries: 0,
        cancelled_at: Cell::new(None),
    };
    let ended = session.run();
    session.finish();
    let end = ended?;
    Ok(SessionReport {
        complete: end == End::Complete,
        stopped: match end {
            End::Stopped { confirmed } => Some(confirmed),
            End::Complete | End::Cancelled => None,
        },
        progress: session.reporter.progress.clone(),
        counters: session.connection.counters(),
        round_trips: session.reporter.round_trips,
    })
}

/// How a session ends without an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Complete,
    Cancelled,
    /// At once, and whether the robot has answered Stop.
    Stopped {
        confirmed: bool,
    },
}

/// Why a request is given up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Leave {
    Cancelled,
    Stop,
    Stalled,
}

struct Session<'a> {
    experiment: &'a Experiment,
    options: &'a SessionOptions<'a>,
    directory: &'a Directory,
    journal: Journal,
    cycle: Cycle,
    connection: Connection,
    camera: Camera,
    /// Photos requested and not yet finished. The last may belong to a throw that has become void,
    /// with the next throw's photo queued behind it.
    pending_photos: u32,
    reporter: Reporter<'a>,
    liveness: Liveness,
    /// Entries written in this session.
    entries: u64,
    /// When the cancelled session first waited for a reply.
    cancelled_at: Cell<Option<Instant>>,
}

impl Session<'_> {
    fn run(&mut self) -> Result<End, SessionError> {
        self.reporter.progress = journal_progress(&self.journal, self.options.rules.throws);
        self.options.sink.progress(&self.reporter.progress);
        loop {
            if self.options.stop.load(Ordering::Relaxed) {
                return self.stop_now();
            }
            if self.options.cancel.load(Ordering::Relaxed) {
                self.cycle.stop();
            }
            self.liveness.note(self.entries, self.cycle.status());
            if self.liveness.is_stalled() {
                return Err(self.liveness.halt().into());
            }
            match self.cycle.step(self.journal.history(), unix_ms()) {
                Step::Request(request) => match self.request(&request)? {
                    None => {}
                    Some(Leave::Cancelled) => return Ok(End::Cancelled),
                    Some(Leave::Stop) => return self.stop_now(),
                    Some(Leave::Stalled) => return Err(self.liveness.halt().into()),
                },
                Step::Wait => self.wait(),
                Step::Announce { throw, id } => {
                    self.check_space()?;
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
                    let complete = announced >= self.options.rules.throws;
                    return Ok(if complete {
                        End::Complete
                    } else {
                        End::Cancelled
                    });
                }
                Step::Halt(halt) => return Err(halt.into()),
            }
        }
    }

    /// Sends a request; why it was given up, if it was.
    fn request(&mut self, request: &Request) -> Result<Option<Leave>, SessionError> {
        let (options, liveness) = (self.options, &self.liveness);
        let (cancelled_at, leave) = (&self.cancelled_at, Cell::new(None));
        let given_up = || {
            if options.stop.load(Ordering::Relaxed) {
                leave.set(Some(Leave::Stop));
            } else if liveness.is_stalled() {
                leave.set(Some(Leave::Stalled));
            } else if options.cancel.load(Ordering::Relaxed) {
                let now = Instant::now();
                let first = cancelled_at.get().unwrap_or(now);
                cancelled_at.set(Some(first));
                if now - first > CANCEL_TIMEOUT {
                    leave.set(Some(Leave::Cancelled));
                }
            }
            leave.get().is_some()
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
            RequestOutcome::GivenUp => return Ok(leave.get()),
        }
        Ok(None)
    }

    /// Switches off the robot's motors, if it answers. The open throw stays open in the journal.
    fn stop_now(&mut self) -> Result<End, SessionError> {
        let begun = Instant::now();
        let late = || begun.elapsed() > STOP_TIMEOUT;
        let reporter = &mut self.reporter;
        self.connection.give_up();
        let confirmed = loop {
            let outcome = self
                .connection
                .request(&Request::Stop, &late, &mut |event| {
                    reporter.link_event(event);
                })?;
            match outcome {
                RequestOutcome::Reply(Reply::Ok { .. }) => break true,
                RequestOutcome::GivenUp => break false,
                RequestOutcome::Reply(_) | RequestOutcome::Connected { .. } => {}
            }
        };
        Ok(End::Stopped { confirmed })
    }

    /// A throw begins only if its photo and its lines will fit.
    fn check_space(&self) -> Result<(), SessionError> {
        let directory = self.directory.path();
        // where the system does not tell, the journal's own error has to do
        let free = free_bytes(directory).unwrap_or(u64::MAX);
        if free >= self.options.min_free {
            return Ok(());
        }
        Err(SessionError::Halt(Halt::DiskFull {
            directory: directory.to_owned(),
            free_mib: free >> 20,
            least_mib: self.options.min_free >> 20,
        }))
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
        let shown = match result {
            Ok((face, image, digest)) => {
                let path = self.directory.photos().join(image.as_str());
                self.reporter.record(|to, now| to.photo(&path, now));
                Shown::Face {
                    face,
                    image,
                    digest,
                }
            }
            Err(failure) => {
                self.reporter
                    .note(&format!("throw {id}, photo {attempt}: {failure}"));
                match failure.error {
                    CameraError::NoFace => Shown::Nothing,
                    _ => Shown::Failure(failure.to_string()),
                }
            }
        };
        self.cycle.photographed(Photo { id, attempt, shown });
    }

    fn write(&mut self, entry: &Entry) -> Result<(), SessionError> {
        self.journal.append(entry)?;
        self.entries += 1;
        self.cycle.written(entry);
        match entry {
            Entry::Done { .. } | Entry::Void { .. } => self.resolved(),
            Entry::Adopted { counter } => self.reporter.warning(&format!(
                "the robot is taken over at throw {counter}: throws continue with number {}",
                u64::from(self.journal.history().last_id()) + 1
            )),
            Entry::Session { .. } | Entry::Announced { .. } | Entry::Read { .. } => {}
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
