//! The host's side of the link: one request at a time, repeated until the robot answers.

use crate::frame::{Decoder, Header, Wire};
use crate::message::{BadMessage, Greeting, Nak, PROTOCOL, Reply, Request, Version};
use thiserror::Error;

/// A request without a reply is repeated after this time, ms.
pub const REPLY_TIMEOUT_MS: u64 = 150;
/// The connection counts as lost after this time without a reply, ms.
pub const LOST_AFTER_MS: u64 = 3_000;

/// The host's state machine.
///
/// Open it whenever the port has been opened; then call [`Host::poll`] until it returns
/// [`Action::Wait`], and pass it the bytes that arrive. A request can be made after
/// [`Action::Connected`], and its reply is an [`Action::Reply`]. After [`Action::Lost`] or
/// [`Action::Refused`] the host is closed.
///
/// If the robot turns out to have been reset, an outstanding request is dropped: the next action is
/// [`Action::Connected`], and the caller decides from its greeting what to request. (Every request
/// can be repeated safely: a throw has its id, and all others are idempotent.)
///
/// Times are in ms from any origin and never decrease.
#[derive(Debug, Default)]
pub struct Host {
    decoder: Decoder,
    /// The last frame sent.
    wire: Wire,
    header: Option<Header>,
    outstanding: Outstanding,
    since_ms: u64,
    due_ms: u64,
    boot: Option<u16>,
    /// The robot replied that there is no session.
    interrupted: bool,
    event: Option<Event>,
    counters: Counters,
}

/// The outstanding request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Outstanding {
    /// The port is closed.
    #[default]
    Closed,
    Hello,
    Request,
    /// Connected, without an outstanding request.
    Nothing,
}

#[derive(Debug, Clone, Copy)]
enum Event {
    Connected { greeting: Greeting, seen: Seen },
    Reply(Reply),
    Refused { version: Version },
}

/// What to do next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Action<'a> {
    /// Send these bytes, all of them.
    Transmit(&'a [u8]),
    /// A session is open: requests can be made. Any earlier request was dropped.
    Connected {
        /// The robot's reply to Hello.
        greeting: Greeting,
        /// Whether it was reset since the last session.
        seen: Seen,
    },
    /// The reply to the request.
    Reply(Reply),
    /// The robot has another major version. The host is closed.
    Refused {
        /// The robot's version.
        version: Version,
    },
    /// No reply for [`LOST_AFTER_MS`]: close the port, wait and open it again. The host is closed;
    /// an outstanding request may or may not have been executed.
    Lost,
    /// Nothing to do until bytes arrive or until this time; `None`: until the next request.
    Wait {
        /// When to poll again at the latest, ms.
        until_ms: Option<u64>,
    },
}

/// Whether this is the robot of the last session, according to its count of starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seen {
    /// There was no session before.
    First,
    /// It was not reset.
    Same,
    /// It was reset or is another robot.
    NewBoot,
    /// It was not reset but had a session with another host: two programs use one robot.
    Taken,
}

/// Statistics of the connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Frames sent, including repetitions.
    pub sent: u64,
    /// Repetitions.
    pub repeated: u64,
    /// Damaged frames received.
    pub rejected: u64,
    /// Frames received that were not the reply to the outstanding request, or not valid messages.
    pub ignored: u64,
}

/// Why a request cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum RequestError {
    /// There is no session: wait for [`Action::Connected`].
    #[error("not connected to the robot")]
    NotConnected,
    /// Another request is outstanding: wait for [`Action::Reply`].
    #[error("the robot has not answered the last request yet")]
    Outstanding,
    /// A number is out of the protocol's range.
    #[error(transparent)]
    Bad(#[from] BadMessage),
}

impl Host {
    /// A host whose port is closed.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sends Hello; call it after opening the port. `session` distinguishes this session from
    /// others, including those of other programs: take it from the clock or a random source (0
    /// counts as 1).
    pub fn open(&mut self, session: u16, now_ms: u64) {
        self.decoder = Decoder::new();
        self.event = None;
        self.interrupted = false;
        self.hello(session, now_ms);
    }

    /// Call it after closing the port.
    pub fn close(&mut self) {
        self.event = None;
        self.outstanding = Outstanding::Closed;
    }

    /// Drops the outstanding request: a reply that still comes is ignored, and another request can be
    /// made.
    pub fn give_up(&mut self) {
        self.event = None;
        if self.outstanding == Outstanding::Request {
            self.outstanding = Outstanding::Nothing;
        }
    }

    /// Sends a request.
    ///
    /// # Errors
    /// [`RequestError`]; nothing is sent.
    pub fn request(&mut self, request: &Request, now_ms: u64) -> Result<(), RequestError> {
        request.check()?;
        match (self.outstanding, &self.event) {
            (Outstanding::Nothing, None) => {}
            (Outstanding::Closed | Outstanding::Hello, _) => {
                return Err(RequestError::NotConnected);
            }
            (Outstanding::Request, _) | (_, Some(_)) => return Err(RequestError::Outstanding),
        }
        let last = self.header.ok_or(RequestError::NotConnected)?;
        let header = Header {
            seq: last.seq.wrapping_add(1),
            ..last
        };
        self.send(Outstanding::Request, request, header, now_ms);
        Ok(())
    }

    /// Takes bytes that arrived.
    pub fn receive(&mut self, bytes: &[u8], now_ms: u64) {
        for byte in bytes {
            let reply = match self.decoder.push(*byte) {
                None => continue,
                Some(Err(_)) => {
                    count(&mut self.counters.rejected);
                    continue;
                }
                Some(Ok(frame)) if Some(frame.header) == self.header => Reply::decode(frame.body),
                Some(Ok(_)) => Err(BadMessage::Malformed),
            };
            match reply {
                Ok(reply) => self.take_reply(reply, now_ms),
                Err(_) => count(&mut self.counters.ignored),
            }
        }
    }

    /// What to do next. Call it until it returns [`Action::Wait`].
    pub fn poll(&mut self, now_ms: u64) -> Action<'_> {
        match self.event.take() {
            Some(Event::Connected { greeting, seen }) => {
                return Action::Connected { greeting, seen };
            }
            Some(Event::Reply(reply)) => return Action::Reply(reply),
            Some(Event::Refused { version }) => return Action::Refused { version },
            None => {}
        }
        if matches!(self.outstanding, Outstanding::Closed | Outstanding::Nothing) {
            return Action::Wait { until_ms: None };
        }
        let lost_ms = self.since_ms.saturating_add(LOST_AFTER_MS);
        if now_ms >= lost_ms {
            self.outstanding = Outstanding::Closed;
            return Action::Lost;
        }
        if now_ms < self.due_ms {
            let until_ms = Some(self.due_ms.min(lost_ms));
            return Action::Wait { until_ms };
        }
        count(&mut self.counters.sent);
        if self.due_ms > self.since_ms {
            count(&mut self.counters.repeated);
        }
        self.due_ms = now_ms.saturating_add(REPLY_TIMEOUT_MS);
        Action::Transmit(self.wire.as_bytes())
    }

    /// Whether a request can be sent now.
    pub fn is_ready(&self) -> bool {
        self.outstanding == Outstanding::Nothing && self.event.is_none()
    }

    /// Statistics of the connection.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    fn hello(&mut self, session: u16, now_ms: u64) {
        let session = session.max(1);
        let hello = Request::Hello {
            version: PROTOCOL,
            session,
        };
        let header = Header {
            session,
            seq: self.header.map_or(0, |last| last.seq.wrapping_add(1)),
        };
        self.send(Outstanding::Hello, &hello, header, now_ms);
    }

    fn send(&mut self, outstanding: Outstanding, request: &Request, header: Header, now_ms: u64) {
        // every request fits (tested); if one did not, nothing would be sent and the connection
        // lost
        self.wire = request.to_wire(header).unwrap_or_default();
        self.header = Some(header);
        self.outstanding = outstanding;
        self.since_ms = now_ms;
        self.due_ms = now_ms;
    }

    fn take_reply(&mut self, reply: Reply, now_ms: u64) {
        match (self.outstanding, reply) {
            (Outstanding::Hello, Reply::Hello(greeting)) => self.take_greeting(greeting),
            (Outstanding::Request, Reply::Nak(Nak::NoSession)) => {
                let session = self.header.map_or(0, |header| header.session);
                self.interrupted = true;
                self.hello(session.wrapping_add(1), now_ms);
            }
            (Outstanding::Request, reply) => {
                self.outstanding = Outstanding::Nothing;
                self.event = Some(Event::Reply(reply));
            }
            _ => count(&mut self.counters.ignored),
        }
    }

    fn take_greeting(&mut self, greeting: Greeting) {
        if greeting.version.major != PROTOCOL.major {
            self.outstanding = Outstanding::Closed;
            self.event = Some(Event::Refused {
                version: greeting.version,
            });
            return;
        }
        let seen = match self.boot {
            None => Seen::First,
            Some(boot) if boot != greeting.boot => Seen::NewBoot,
            Some(_) if self.interrupted => Seen::Taken,
            Some(_) => Seen::Same,
        };
        self.interrupted = false;
        self.boot = Some(greeting.boot);
        self.outstanding = Outstanding::Nothing;
        self.event = Some(Event::Connected { greeting, seen });
    }
}

fn count(counter: &mut u64) {
    *counter = counter.saturating_add(1);
}
