//! A robot at the other end of a port: asked one thing at a time, through any loss of the line.

use super::{PortError, open};
use crate::clock::{Clock, unix_ms};
use coinmc_link::{
    Action, Counters, Greeting, Host, PROTOCOL, Reply, Request, RequestError, Seen, Version,
};
use serial2::SerialPort;
use std::io;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;
use thiserror::Error;

/// The first pause before a lost port is opened again, and the longest; each is twice the last.
const FIRST_PAUSE: Duration = Duration::from_millis(200);
const LONGEST_PAUSE: Duration = Duration::from_secs(5);

/// Longest sleep between two looks at whether to give up.
const NAP: Duration = Duration::from_millis(50);

/// Sessions taken over by somebody else, within this long, that make it certain.
const MOST_TAKEN: usize = 5;
const TAKEN_WITHIN_MS: u64 = 60_000;

/// What comes of asking.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// The robot's answer.
    Reply(Reply),
    /// The session was opened anew, and the request dropped: it may or may not have been carried
    /// out.
    Connected {
        /// What the robot said.
        greeting: Greeting,
        /// Whether it was reset since.
        seen: Seen,
    },
    /// The caller gave up before the robot answered.
    GivenUp,
}

/// What happens on the line, for logs and displays.
#[derive(Debug)]
pub enum LinkEvent<'a> {
    /// The port was opened.
    Opened(&'a Path),
    /// The line is lost; it is tried again after this pause.
    Lost {
        /// What was seen, for people.
        why: String,
        /// The pause.
        pause: Duration,
    },
    /// A session is open.
    Connected {
        /// What the robot said.
        greeting: Greeting,
        /// Whether it was reset since.
        seen: Seen,
    },
    /// A request went out and was answered.
    Exchanged {
        /// The request.
        request: Request,
        /// The answer.
        reply: Reply,
        /// From the first transmission to the answer, wall time.
        took: Duration,
    },
}

/// Why a robot cannot be talked to, ever.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConnectionError {
    /// The port.
    #[error(transparent)]
    Port(#[from] PortError),
    /// Another major version of the protocol.
    #[error(
        "the robot speaks version {}.{} of the protocol, this program {}.{}: use the program that \
         belongs to its firmware, or bring the firmware up to date",
        .0.major, .0.minor, PROTOCOL.major, PROTOCOL.minor
    )]
    OtherVersion(Version),
    /// Two hosts at one robot, through different ports.
    #[error("another program talks to the same robot: end it first")]
    Shared,
    /// A request that the protocol does not allow.
    #[error(transparent)]
    Request(#[from] RequestError),
}

/// A port, the link's state machine on it, and what to do when either is gone.
#[derive(Debug)]
pub struct Connection {
    path: PathBuf,
    clock: Clock,
    host: Host,
    port: Option<SerialPort>,
    pause: Duration,
    /// When sessions were taken over, ms of the clock.
    taken: Vec<u64>,
    session: u16,
}

impl Connection {
    /// Opens the port and says hello.
    ///
    /// # Errors
    /// [`PortError`] if the port cannot be opened *now*: a typing error shows at once. Later losses
    /// are no errors.
    pub fn open(path: &Path, clock: Clock) -> Result<Self, PortError> {
        let port = open(path)?;
        // two hosts, and two sessions of one, differ in all likelihood
        #[allow(clippy::cast_possible_truncation)]
        let session = (unix_ms() ^ u64::from(std::process::id()) << 3) as u16;
        let mut connection = Self {
            path: path.to_owned(),
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

    /// What happened on the line so far.
    pub fn counters(&self) -> Counters {
        self.host.counters()
    }

    /// Waits until a session is open, for as long as it takes.
    ///
    /// # Errors
    /// [`ConnectionError`]
    pub fn connect(
        &mut self,
        given_up: &dyn Fn() -> bool,
        watch: &mut dyn FnMut(&LinkEvent<'_>),
    ) -> Result<Answer, ConnectionError> {
        self.drive(None, given_up, watch)
    }

    /// Asks the robot and waits for its answer, for as long as it takes.
    ///
    /// # Errors
    /// [`ConnectionError`]
    pub fn ask(
        &mut self,
        request: &Request,
        given_up: &dyn Fn() -> bool,
        watch: &mut dyn FnMut(&LinkEvent<'_>),
    ) -> Result<Answer, ConnectionError> {
        if self.port.is_some() && self.host.is_ready() {
            self.host.request(request, self.clock.now_ms())?;
        } else {
            // the session's greeting comes first; the caller asks again
            request.check().map_err(RequestError::from)?;
        }
        self.drive(Some(request), given_up, watch)
    }

    fn drive(
        &mut self,
        request: Option<&Request>,
        given_up: &dyn Fn() -> bool,
        watch: &mut dyn FnMut(&LinkEvent<'_>),
    ) -> Result<Answer, ConnectionError> {
        let asked = std::time::Instant::now();
        loop {
            if given_up() {
                return Ok(Answer::GivenUp);
            }
            let Some(port) = &mut self.port else {
                self.open_again(given_up, watch);
                continue;
            };
            match advance(&mut self.host, port, &self.clock) {
                Ok(Progress::Nothing) => {}
                Ok(Progress::Reply(reply)) => {
                    if let Some(&request) = request {
                        watch(&LinkEvent::Exchanged {
                            request,
                            reply,
                            took: asked.elapsed(),
                        });
                    }
                    return Ok(Answer::Reply(reply));
                }
                Ok(Progress::Connected { greeting, seen }) => {
                    self.pause = FIRST_PAUSE;
                    watch(&LinkEvent::Connected { greeting, seen });
                    self.mind_others(seen)?;
                    return Ok(Answer::Connected { greeting, seen });
                }
                Ok(Progress::Refused(version)) => {
                    return Err(ConnectionError::OtherVersion(version));
                }
                Ok(Progress::Lost) => self.lose("no answer".to_owned(), watch),
                // unplugged: EIO, ENXIO, or the end of the file
                Err(error) => self.lose(error.to_string(), watch),
            }
        }
    }

    fn begin(&mut self, port: SerialPort) {
        self.session = self.session.wrapping_add(1);
        self.host.open(self.session, self.clock.now_ms());
        self.port = Some(port);
    }

    fn lose(&mut self, why: String, watch: &mut dyn FnMut(&LinkEvent<'_>)) {
        self.port = None;
        self.host.close();
        let pause = self.pause;
        watch(&LinkEvent::Lost { why, pause });
    }

    /// One attempt, after a pause.
    fn open_again(&mut self, given_up: &dyn Fn() -> bool, watch: &mut dyn FnMut(&LinkEvent<'_>)) {
        let mut left = self.clock.wall(self.pause);
        while !left.is_zero() && !given_up() {
            thread::sleep(left.min(NAP));
            left = left.saturating_sub(NAP);
        }
        self.pause = (self.pause * 2).min(LONGEST_PAUSE);
        match open(&self.path) {
            Ok(port) => {
                watch(&LinkEvent::Opened(&self.path));
                self.begin(port);
            }
            Err(error) => {
                let (why, pause) = (error.to_string(), self.pause);
                watch(&LinkEvent::Lost { why, pause });
            }
        }
    }

    /// A session may be lost to an old frame that was still on its way; not again and again.
    fn mind_others(&mut self, seen: Seen) -> Result<(), ConnectionError> {
        if seen == Seen::Taken {
            let now = self.clock.now_ms();
            self.taken.retain(|at| now - at < TAKEN_WITHIN_MS);
            self.taken.push(now);
            if self.taken.len() >= MOST_TAKEN {
                return Err(ConnectionError::Shared);
            }
        }
        Ok(())
    }
}

enum Progress {
    Nothing,
    Reply(Reply),
    Connected { greeting: Greeting, seen: Seen },
    Refused(Version),
    Lost,
}

/// One turn of the state machine: send what it wants sent, or wait for what it waits for.
fn advance(host: &mut Host, port: &mut SerialPort, clock: &Clock) -> io::Result<Progress> {
    let until_ms = match host.poll(clock.now_ms()) {
        Action::Transmit(bytes) => {
            port.write_all(bytes)?;
            return Ok(Progress::Nothing);
        }
        Action::Connected { greeting, seen } => return Ok(Progress::Connected { greeting, seen }),
        Action::Reply(reply) => return Ok(Progress::Reply(reply)),
        Action::Refused { version } => return Ok(Progress::Refused(version)),
        Action::Lost => return Ok(Progress::Lost),
        Action::Wait { until_ms } => until_ms,
    };
    let mut bytes = [0; 512];
    let wait = until_ms.map_or(NAP, |until| {
        clock.wall(Duration::from_millis(until.saturating_sub(clock.now_ms())))
    });
    // below a millisecond the system's clock turns waiting into asking
    port.set_read_timeout(wait.clamp(Duration::from_millis(1), NAP))?;
    match port.read(&mut bytes) {
        Ok(0) => Err(io::ErrorKind::UnexpectedEof.into()),
        Ok(count) => {
            host.receive(&bytes[..count], clock.now_ms());
            Ok(Progress::Nothing)
        }
        Err(error) if patient(&error) => Ok(Progress::Nothing),
        Err(error) => Err(error),
    }
}

/// Nothing arrived, and nothing is wrong.
fn patient(error: &io::Error) -> bool {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), TimedOut | WouldBlock | Interrupted)
}
