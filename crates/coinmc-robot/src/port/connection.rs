//! The connection to a robot: one request at a time, with reconnection after any loss.

use super::PortError;
use super::line::{Line, Opener, Serial};
use crate::clock::{Clock, unix_ms};
use coinmc_link::{
    Action, Counters, Greeting, Host, PROTOCOL, Reply, Request, RequestError, Seen, Version,
};
use std::io;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};
use thiserror::Error;

/// First and longest pause before a lost port is opened again; each pause doubles the last.
const FIRST_PAUSE: Duration = Duration::from_millis(200);
const LONGEST_PAUSE: Duration = Duration::from_secs(5);

/// Longest wait before checking again whether to give up.
const MAX_WAIT: Duration = Duration::from_millis(50);

/// If other hosts take over this many sessions within this time, the robot is shared.
const MAX_TAKEN: usize = 5;
const TAKEN_WITHIN_MS: u64 = 60_000;

/// The outcome of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RequestOutcome {
    /// The robot's reply.
    Reply(Reply),
    /// The session was opened again and the request dropped: it may or may not have been executed.
    Connected {
        /// The robot's reply to Hello.
        greeting: Greeting,
        /// Whether the robot was reset since the last session.
        seen: Seen,
    },
    /// The caller gave up before the robot replied.
    GivenUp,
}

/// Events of the connection, for logs and displays.
#[derive(Debug)]
pub enum LinkEvent<'a> {
    /// The port was opened.
    Opened(&'a Path),
    /// The connection is lost, and will be tried again after this pause.
    Lost {
        /// The cause, for the user.
        why: String,
        /// The pause.
        pause: Duration,
    },
    /// A session is open.
    Connected {
        /// The robot's reply to Hello.
        greeting: Greeting,
        /// Whether the robot was reset since the last session.
        seen: Seen,
    },
    /// A request was sent and got a reply.
    Exchanged {
        /// The request.
        request: Request,
        /// The reply.
        reply: Reply,
        /// Time from the first transmission to the reply, wall time.
        took: Duration,
    },
}

/// Why communication with a robot is impossible.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConnectionError {
    /// The port.
    #[error(transparent)]
    Port(#[from] PortError),
    /// Another major version of the protocol.
    #[error(
        "the robot speaks version {}.{} of the protocol, this program {}.{}: use the program that \
         belongs to its firmware, or update the firmware",
        .0.major, .0.minor, PROTOCOL.major, PROTOCOL.minor
    )]
    OtherVersion(Version),
    /// Two hosts use one robot, through different ports.
    #[error("another program uses the same robot: end it first")]
    Shared,
    /// A request that the protocol does not allow.
    #[error(transparent)]
    Request(#[from] RequestError),
}

/// A port with the link's state machine, which reconnects when the port or the robot is lost.
#[derive(Debug)]
pub struct Connection {
    path: PathBuf,
    opener: Box<dyn Opener>,
    clock: Clock,
    host: Host,
    port: Option<Box<dyn Line>>,
    pause: Duration,
    /// Times at which other hosts took over sessions, ms of the clock.
    taken: Vec<u64>,
    session: u16,
}

impl Connection {
    /// Opens the port and sends Hello.
    ///
    /// # Errors
    /// [`PortError`] if the port cannot be opened *now*, so that a mistyped name is reported at once.
    /// Later losses are not errors.
    pub fn open(path: &Path, clock: Clock) -> Result<Self, PortError> {
        Self::open_within(path, clock, None, &|| false)
    }

    /// Opens the port and sends Hello; waits for a missing port for this time, unless the caller gives
    /// up.
    ///
    /// # Errors
    /// [`PortError`] if the port cannot be opened in that time.
    pub fn open_within(
        path: &Path,
        clock: Clock,
        wait: Option<Duration>,
        given_up: &dyn Fn() -> bool,
    ) -> Result<Self, PortError> {
        let opener = Box::new(Serial(path.to_owned()));
        Self::over(opener, path, clock, wait, given_up)
    }

    /// As [`Connection::open_within`], over any line: for tests of what a failing one does. `path` is its
    /// name in messages.
    ///
    /// # Errors
    /// [`PortError`] if it cannot be opened in that time.
    pub fn over(
        mut opener: Box<dyn Opener>,
        path: &Path,
        clock: Clock,
        wait: Option<Duration>,
        given_up: &dyn Fn() -> bool,
    ) -> Result<Self, PortError> {
        let (begun, wait) = (Instant::now(), wait.unwrap_or_default());
        let port = loop {
            match opener.open() {
                Err(PortError::Missing { .. }) if begun.elapsed() < wait && !given_up() => {
                    thread::sleep(FIRST_PAUSE);
                }
                opened => break opened?,
            }
        };
        // the sessions of any two hosts, and any two of one host, almost certainly differ
        #[allow(clippy::cast_possible_truncation)]
        let session = (unix_ms() ^ u64::from(std::process::id()) << 3) as u16;
        let mut connection = Self {
            path: path.to_owned(),
            opener,
            clock,
            host: Host::new(),
            port: None,
            pause: FIRST_PAUSE,
            taken: Vec::new(),
            session,
        };
        connection.begin(port);
        Ok(connection)
    }

    /// Statistics of the connection.
    pub fn counters(&self) -> Counters {
        self.host.counters()
    }

    /// Drops the request that was given up, so that another one can be made.
    pub fn give_up(&mut self) {
        self.host.give_up();
    }

    /// Waits until a session is open, without a time limit.
    ///
    /// # Errors
    /// [`ConnectionError`]
    pub fn connect(
        &mut self,
        given_up: &dyn Fn() -> bool,
        on_event: &mut dyn FnMut(&LinkEvent<'_>),
    ) -> Result<RequestOutcome, ConnectionError> {
        self.drive(None, given_up, on_event)
    }

    /// Sends a request and waits for the reply, without a time limit.
    ///
    /// # Errors
    /// [`ConnectionError`]
    pub fn request(
        &mut self,
        request: &Request,
        given_up: &dyn Fn() -> bool,
        on_event: &mut dyn FnMut(&LinkEvent<'_>),
    ) -> Result<RequestOutcome, ConnectionError> {
        if self.port.is_some() && self.host.is_ready() {
            self.host.request(request, self.clock.now_ms())?;
        } else {
            // the session must be opened first; the caller repeats the request then
            request.check().map_err(RequestError::from)?;
        }
        self.drive(Some(request), given_up, on_event)
    }

    fn drive(
        &mut self,
        request: Option<&Request>,
        given_up: &dyn Fn() -> bool,
        on_event: &mut dyn FnMut(&LinkEvent<'_>),
    ) -> Result<RequestOutcome, ConnectionError> {
        let asked = std::time::Instant::now();
        loop {
            if given_up() {
                return Ok(RequestOutcome::GivenUp);
            }
            let Some(port) = &mut self.port else {
                self.open_again(given_up, on_event);
                continue;
            };
            match advance(&mut self.host, port.as_mut(), &self.clock) {
                Ok(StepResult::Nothing) => {}
                Ok(StepResult::Reply(reply)) => {
                    if let Some(&request) = request {
                        on_event(&LinkEvent::Exchanged {
                            request,
                            reply,
                            took: asked.elapsed(),
                        });
                    }
                    return Ok(RequestOutcome::Reply(reply));
                }
                Ok(StepResult::Connected { greeting, seen }) => {
                    self.pause = FIRST_PAUSE;
                    on_event(&LinkEvent::Connected { greeting, seen });
                    self.check_other_hosts(seen)?;
                    return Ok(RequestOutcome::Connected { greeting, seen });
                }
                Ok(StepResult::Refused(version)) => {
                    return Err(ConnectionError::OtherVersion(version));
                }
                Ok(StepResult::Lost) => self.lose("no reply".to_owned(), on_event),
                // unplugged: EIO, ENXIO or end of file
                Err(error) => self.lose(error.to_string(), on_event),
            }
        }
    }

    fn begin(&mut self, port: Box<dyn Line>) {
        self.session = self.session.wrapping_add(1);
        self.host.open(self.session, self.clock.now_ms());
        self.port = Some(port);
    }

    fn lose(&mut self, why: String, on_event: &mut dyn FnMut(&LinkEvent<'_>)) {
        self.port = None;
        self.host.close();
        let pause = self.pause;
        on_event(&LinkEvent::Lost { why, pause });
    }

    /// Tries once to reopen the port, after a pause.
    fn open_again(
        &mut self,
        given_up: &dyn Fn() -> bool,
        on_event: &mut dyn FnMut(&LinkEvent<'_>),
    ) {
        let mut left = self.clock.wall(self.pause);
        while !left.is_zero() && !given_up() {
            thread::sleep(left.min(MAX_WAIT));
            left = left.saturating_sub(MAX_WAIT);
        }
        self.pause = (self.pause * 2).min(LONGEST_PAUSE);
        match self.opener.open() {
            Ok(port) => {
                on_event(&LinkEvent::Opened(&self.path));
                self.begin(port);
            }
            Err(error) => {
                let (why, pause) = (error.to_string(), self.pause);
                on_event(&LinkEvent::Lost { why, pause });
            }
        }
    }

    /// An old frame in transit can take over a session once, but only another host does so
    /// repeatedly.
    fn check_other_hosts(&mut self, seen: Seen) -> Result<(), ConnectionError> {
        if seen == Seen::Taken {
            let now = self.clock.now_ms();
            self.taken.retain(|at| now - at < TAKEN_WITHIN_MS);
            self.taken.push(now);
            if self.taken.len() >= MAX_TAKEN {
                return Err(ConnectionError::Shared);
            }
        }
        Ok(())
    }
}

enum StepResult {
    Nothing,
    Reply(Reply),
    Connected { greeting: Greeting, seen: Seen },
    Refused(Version),
    Lost,
}

/// One step of the state machine: sends what it asks to send, or waits for bytes.
fn advance(host: &mut Host, port: &mut dyn Line, clock: &Clock) -> io::Result<StepResult> {
    let until_ms = match host.poll(clock.now_ms()) {
        Action::Transmit(bytes) => {
            port.write_all(bytes)?;
            return Ok(StepResult::Nothing);
        }
        Action::Connected { greeting, seen } => {
            return Ok(StepResult::Connected { greeting, seen });
        }
        Action::Reply(reply) => return Ok(StepResult::Reply(reply)),
        Action::Refused { version } => return Ok(StepResult::Refused(version)),
        Action::Lost => return Ok(StepResult::Lost),
        Action::Wait { until_ms } => until_ms,
    };
    let mut bytes = [0; 512];
    let wait = until_ms.map_or(MAX_WAIT, |until| {
        clock.wall(Duration::from_millis(until.saturating_sub(clock.now_ms())))
    });
    // with less than a millisecond the system would not wait at all
    port.set_patience(wait.clamp(Duration::from_millis(1), MAX_WAIT))?;
    match port.read(&mut bytes) {
        Ok(0) => Err(io::ErrorKind::UnexpectedEof.into()),
        Ok(count) => {
            host.receive(&bytes[..count], clock.now_ms());
            Ok(StepResult::Nothing)
        }
        Err(error) if is_timeout(&error) => Ok(StepResult::Nothing),
        Err(error) => Err(error),
    }
}

/// Whether nothing arrived but nothing is wrong.
fn is_timeout(error: &io::Error) -> bool {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), TimedOut | WouldBlock | Interrupted)
}
