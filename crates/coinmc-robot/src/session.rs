//! One session of an experiment: robot, camera, journal and recording, until all throws are made or
//! somebody says stop.

use crate::camera::{Camera, CameraError, CameraOptions, Taken};
use crate::clock::{Clock, unix_ms};
use crate::cycle::{Cycle, Halt, Photo, Rules, Step};
use crate::journal::{Entry, Journal, JournalError, Resolution, VoidReason};
use crate::port::{Answer, Connection, ConnectionError, LinkEvent};
use crate::recording::SessionRecorder;
use crate::{Directory, Experiment, Face};
use coinmc_link::{Counters, Request, Seen, State, Status};
use coinmc_recording::foxglove::LogLevel;
use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};
use thiserror::Error;

/// How often the robot is asked where it is, in its time.
pub const POLL: Duration = Duration::from_millis(100);

/// The link's own times shrink no further than this: below 5 ms for an answer a busy computer looks
/// like a lost line.
const FASTEST_LINK: f64 = 30.0;

/// Shortest time between two questions, wall time.
const SHORTEST_POLL: Duration = Duration::from_millis(1);

/// How long a robot that does not answer may keep a session from ending.
const PATIENCE: Duration = Duration::from_secs(30);

/// What a session needs beyond its experiment.
pub struct SessionOptions<'a> {
    /// The serial port.
    pub port: &'a Path,
    /// The camera.
    pub camera: CameraOptions,
    /// What does not change.
    pub rules: Rules,
    /// How much faster than life a simulated robot is; 1 for a real one.
    pub speed: f64,
    /// Whether to record the session.
    pub record: bool,
    /// Set it to finish the open throw and stop.
    pub cancel: &'a AtomicBool,
    /// Who is told.
    pub sink: &'a dyn ProgressSink,
}

/// Told how a session goes.
pub trait ProgressSink {
    /// Something changed.
    fn live(&self, live: &Live);
    /// Something happened that a person may want to know.
    fn note(&self, text: &str);
    /// Something happened that a person should know.
    fn warning(&self, text: &str);
}

/// A session at a moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Live {
    /// What the robot said last; `None` while it cannot be asked.
    pub status: Option<Status>,
    /// Throws planned.
    pub planned: u32,
    /// Throws done, by face in the order of [`Face::ALL`].
    pub faces: [u32; 3],
    /// Void throws.
    pub voids: u32,
    /// Throws resolved in this session.
    pub here: u32,
    /// Losses of the line in this session.
    pub losses: u32,
}

impl Live {
    /// Throws resolved.
    pub fn resolved(&self) -> u32 {
        self.faces.iter().sum::<u32>() + self.voids
    }
}

/// What a session came to.
#[derive(Debug, Clone)]
pub struct SessionReport {
    /// All planned throws are resolved.
    pub complete: bool,
    /// How it stands.
    pub live: Live,
    /// What happened on the line.
    pub counters: Counters,
    /// Round trips of requests, wall time: number, mean, longest.
    pub round_trips: RoundTrips,
}

/// How long the robot takes to answer.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RoundTrips {
    /// Requests answered.
    pub count: u64,
    /// All of them together.
    pub sum: Duration,
    /// The longest.
    pub longest: Duration,
}

/// Why a session ended early. The journal is right in any case.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SessionError {
    /// The journal cannot be written.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The robot cannot be talked to.
    #[error(transparent)]
    Connection(#[from] ConnectionError),
    /// The camera cannot be started at all.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// A person must decide.
    #[error(transparent)]
    Halt(#[from] Halt),
    /// The recording cannot be begun.
    #[error("cannot record the session: {0}")]
    Recording(coinmc_recording::Error),
}

/// Goes on with an experiment until it is complete, or told to stop.
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
    let recorder = if options.record {
        let begun = SessionRecorder::begin(&directory.sessions());
        Some(begun.map_err(SessionError::Recording)?)
    } else {
        None
    };
    let mut session = Session {
        experiment,
        options,
        photos: directory.photos(),
        journal,
        cycle: Cycle::new(options.rules),
        connection,
        camera: Camera::start(options.camera.clone())?,
        photos_under_way: 0,
        notes: Notes {
            sink: options.sink,
            recorder,
            live: Live::default(),
            round_trips: RoundTrips::default(),
        },
        cancelled_at: Cell::new(None),
    };
    let ended = session.run();
    session.finish();
    let complete = ended?;
    Ok(SessionReport {
        complete,
        live: session.notes.live.clone(),
        counters: session.connection.counters(),
        round_trips: session.notes.round_trips,
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
    /// Photos asked for and not yet back. The last may be of a throw that is void by then, and the
    /// next one's photo comes behind it.
    photos_under_way: u32,
    notes: Notes<'a>,
    cancelled_at: Cell<Option<Instant>>,
}

impl Session<'_> {
    fn run(&mut self) -> Result<bool, SessionError> {
        self.notes.live = live(&self.journal, self.options.rules.throws);
        self.options.sink.live(&self.notes.live);
        loop {
            if self.options.cancel.load(Ordering::Relaxed) {
                self.cycle.stop();
            }
            match self.cycle.step(self.journal.history(), unix_ms()) {
                Step::Ask(request) => {
                    if !self.ask(&request)? {
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
                    self.photos_under_way += 1;
                }
                Step::Finished => {
                    let announced = self.journal.history().announced();
                    return Ok(announced >= self.options.rules.throws);
                }
                Step::Halt(halt) => return Err(halt.into()),
            }
        }
    }

    /// Whether the session goes on.
    fn ask(&mut self, request: &Request) -> Result<bool, SessionError> {
        let (cancel, since) = (self.options.cancel, &self.cancelled_at);
        let given_up = || {
            if !cancel.load(Ordering::Relaxed) {
                return false;
            }
            let now = Instant::now();
            let first = since.get().unwrap_or(now);
            since.set(Some(first));
            now - first > PATIENCE
        };
        let notes = &mut self.notes;
        let answer = self
            .connection
            .ask(request, &given_up, &mut |event| notes.heard(event))?;
        match answer {
            Answer::Reply(reply) => {
                self.cycle.replied(request, &reply);
                let status = self.cycle.status().copied();
                if status.is_some() && self.notes.live.status != status {
                    self.notes.live.status = status;
                    self.options.sink.live(&self.notes.live);
                }
            }
            Answer::Connected { greeting, .. } => self.cycle.connected(&greeting),
            Answer::GivenUp => return Ok(false),
        }
        Ok(true)
    }

    /// The polling interval, or less if a photo comes back before.
    fn wait(&mut self) {
        let interval = POLL.div_f64(self.options.speed).max(SHORTEST_POLL);
        if self.photos_under_way > 0 {
            if let Some(taken) = self.camera.taken(interval) {
                self.photographed(taken);
            }
        } else {
            thread::sleep(interval);
        }
        self.cycle.waited();
    }

    fn photographed(&mut self, taken: Taken) {
        self.photos_under_way = self.photos_under_way.saturating_sub(1);
        let Taken {
            id,
            attempt,
            result,
        } = taken;
        let read = match result {
            Ok((face, image)) => {
                let path = self.photos.join(image.as_str());
                self.notes.record(|to, now| to.photo(&path, now));
                Some((face, image))
            }
            Err(error) => {
                self.notes
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
            Entry::Adopted { counter } => self.notes.warning(&format!(
                "the robot's counter is adopted: throws go on with number {}",
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
            self.notes.live.voids += 1;
            let text = format!("throw {} is void: {}", throw.id, why(reason));
            self.notes.note(&text);
        } else if let Some((reading, _)) = &throw.reading {
            self.notes.live.faces[index(reading.face)] += 1;
        }
        self.notes.live.here += 1;
        self.notes.record(|to, now| to.result(throw, now));
        self.options.sink.live(&self.notes.live);
    }

    fn finish(&mut self) {
        if let Some(recorder) = self.notes.recorder.take()
            && let Err(error) = recorder.finish()
        {
            self.notes
                .warning(&format!("the recording cannot be finished: {error}"));
        }
    }
}

/// Display, log and recording together.
struct Notes<'a> {
    sink: &'a dyn ProgressSink,
    recorder: Option<SessionRecorder>,
    live: Live,
    round_trips: RoundTrips,
}

impl Notes<'_> {
    fn note(&mut self, text: &str) {
        self.sink.note(text);
        self.record(|to, now| to.log(LogLevel::Info, text, now));
    }

    fn warning(&mut self, text: &str) {
        self.sink.warning(text);
        self.record(|to, now| to.log(LogLevel::Warning, text, now));
    }

    /// Records, until it fails: the journal holds the truth, and throws go on without a recording.
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
                "{error}. This session is not recorded any further; the journal is"
            ));
        }
    }

    fn heard(&mut self, event: &LinkEvent<'_>) {
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
                // every attempt that fails is one more; people hear of the first
                if self.live.status.take().is_some() {
                    self.live.losses += 1;
                    self.note(&format!(
                        "the line to the robot is lost ({why}); trying again"
                    ));
                    self.sink.live(&self.live);
                }
            }
            LinkEvent::Connected { greeting, seen } => {
                let state = format!("boot {}, {}", greeting.boot, name(greeting.state));
                match seen {
                    Seen::First => self.note(&format!("connected to the robot ({state})")),
                    Seen::Same => self.note(&format!("connected again ({state})")),
                    Seen::NewBoot => {
                        self.note(&format!("connected again; the robot was reset ({state})"));
                    }
                    Seen::Taken => {
                        self.warning("another program talks to the same robot; end it");
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

/// The journal's throws, counted.
fn live(journal: &Journal, planned: u32) -> Live {
    let mut live = Live {
        planned,
        ..Live::default()
    };
    for throw in journal.history().throws() {
        match (throw.resolution, &throw.reading) {
            (Some(Resolution::Void(_)), _) => live.voids += 1,
            (Some(Resolution::Done), Some((reading, _))) => live.faces[index(reading.face)] += 1,
            _ => {}
        }
    }
    live
}

fn index(face: Face) -> usize {
    match face {
        Face::Heads => 0,
        Face::Tails => 1,
        Face::Side => 2,
    }
}

/// A void throw's reason, for people.
fn why(reason: VoidReason) -> String {
    match reason {
        VoidReason::Unread => "no photo showed a face".to_owned(),
        VoidReason::Fault(code) => format!("the robot stopped with {}", fault(code)),
        VoidReason::Lost => "the coin was put away unread".to_owned(),
        VoidReason::Superseded => "the robot counts beyond it".to_owned(),
    }
}

/// A state's name, for people.
pub fn name(state: State) -> &'static str {
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

/// A fault, for people.
pub fn fault(code: u16) -> String {
    use coinmc_link::fault::{HARDWARE, JOURNAL, LIMIT, RESET, SILENCE, STOPPED};
    let phase = |base: u16| {
        u8::try_from(code - base)
            .ok()
            .and_then(State::from_number)
            .map_or("an unknown phase", name)
    };
    let text = match code {
        STOPPED => "stopped".to_owned(),
        SILENCE => "the host fell silent".to_owned(),
        JOURNAL => "its memory cannot be written".to_owned(),
        _ if code >= HARDWARE => format!("something is broken, number {}", code - HARDWARE),
        _ if code >= LIMIT => format!("{} took too long", phase(LIMIT)),
        _ if code >= RESET => format!("reset while {}", phase(RESET)),
        _ => "unknown".to_owned(),
    };
    format!("fault {code} ({text})")
}
