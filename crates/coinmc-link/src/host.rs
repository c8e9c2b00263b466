//! The host's side of the link: one request at a time, repeated until it is answered.

use crate::frame::{Decoder, Header, Wire};
use crate::message::{BadMessage, Greeting, Nak, PROTOCOL, Reply, Request, Version};
use thiserror::Error;

/// A request without an answer is repeated after this long, ms.
pub const REPLY_TIMEOUT_MS: u64 = 150;
/// After this long without an answer the line is given up, ms.
pub const LOST_AFTER_MS: u64 = 3_000;

/// The host's state machine.
///
/// Open it whenever the port has been opened; then ask [`Host::poll`] what to do until it says
/// [`Action::Wait`], and put in what arrives. A request is made after [`Action::Connected`] and
/// answered by [`Action::Reply`]. After [`Action::Lost`] or [`Action::Refused`] it is closed.
///
/// A request that is outstanding when the robot turns out to have been reset is dropped: the next
/// event is [`Action::Connected`], and its greeting tells what to ask now. (Every request may be
/// asked again: a throw by its id, the others because they set something absolutely.)
///
/// Times are in ms from any origin and never go back.
#[derive(Debug, Default)]
pub struct Host {
    decoder: Decoder,
    /// The frame last sent.
    wire: Wire,
    header: Option<Header>,
    asking: Asking,
    since_ms: u64,
    due_ms: u64,
    boot: Option<u16>,
    /// The robot answered that there is no session.
    interrupted: bool,
    event: Option<Event>,
    counters: Counters,
}

/// What is outstanding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Asking {
    /// The port is closed.
    #[default]
    Closed,
    Hello,
    Request,
    /// Connected, and nothing is.
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
    /// A session is open: requests may be made. Any request made before was dropped.
    Connected {
        /// What the robot said.
        greeting: Greeting,
        /// Whether it was reset since the last session.
        seen: Seen,
    },
    /// The answer to the request.
    Reply(Reply),
    /// The robot speaks another major version. Closed.
    Refused {
        /// The robot's version.
        version: Version,
    },
    /// No answer for [`LOST_AFTER_MS`]: close the port, wait, open it again. Closed; the
    /// outstanding request, if any, may or may not have been carried out.
    Lost,
    /// Nothing to do until something arrives, or until this time; `None`: until a request.
    Wait {
        /// When to poll again at the latest, ms.
        until_ms: Option<u64>,
    },
}

/// Whether the robot is the one of the last session, as its count of starts tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seen {
    /// There was no session before.
    First,
    /// It ran on since.
    Same,
    /// It was reset, or is another robot.
    NewBoot,
    /// It ran on, but had a session with another host: two programs use one robot.
    Taken,
}

/// What happened on the line so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Frames sent, repetitions included.
    pub sent: u64,
    /// Repetitions.
    pub repeated: u64,
    /// What arrived and was no frame.
    pub rejected: u64,
    /// Frames that answered nothing outstanding, or made no sense.
    pub ignored: u64,
}

/// Why a request cannot be made.
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

    /// The port has just been opened: says Hello. `session` tells this session from others, also
    /// those of other programs: take it from the clock or from a random source (0 counts as 1).
    pub fn open(&mut self, session: u16, now_ms: u64) {
        self.decoder = Decoder::new();
        self.event = None;
        self.interrupted = false;
        self.hello(session, now_ms);
    }

    /// The port was closed.
    pub fn close(&mut self) {
        self.event = None;
        self.asking = Asking::Closed;
    }

    /// Makes a request.
    ///
    /// # Errors
    /// [`RequestError`]; nothing is sent then.
    pub fn request(&mut self, request: &Request, now_ms: u64) -> Result<(), RequestError> {
        request.check()?;
        match (self.asking, &self.event) {
            (Asking::Nothing, None) => {}
            (Asking::Closed | Asking::Hello, _) => return Err(RequestError::NotConnected),
            (Asking::Request, _) | (_, Some(_)) => return Err(RequestError::Outstanding),
        }
        let last = self.header.ok_or(RequestError::NotConnected)?;
        let header = Header {
            seq: last.seq.wrapping_add(1),
            ..last
        };
        self.ask(Asking::Request, request, header, now_ms);
        Ok(())
    }

    /// Takes what arrived.
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
                Ok(reply) => self.answered(reply, now_ms),
                Err(_) => count(&mut self.counters.ignored),
            }
        }
    }

    /// What to do next. Call it until it says [`Action::Wait`].
    pub fn poll(&mut self, now_ms: u64) -> Action<'_> {
        match self.event.take() {
            Some(Event::Connected { greeting, seen }) => {
                return Action::Connected { greeting, seen };
            }
            Some(Event::Reply(reply)) => return Action::Reply(reply),
            Some(Event::Refused { version }) => return Action::Refused { version },
            None => {}
        }
        if matches!(self.asking, Asking::Closed | Asking::Nothing) {
            return Action::Wait { until_ms: None };
        }
        let lost_ms = self.since_ms.saturating_add(LOST_AFTER_MS);
        if now_ms >= lost_ms {
            self.asking = Asking::Closed;
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

    /// Whether a request may be made now.
    pub fn is_ready(&self) -> bool {
        self.asking == Asking::Nothing && self.event.is_none()
    }

    /// What happened on the line so far.
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
        self.ask(Asking::Hello, &hello, header, now_ms);
    }

    fn ask(&mut self, asking: Asking, request: &Request, header: Header, now_ms: u64) {
        // every request fits (tested); if one did not, nothing would be sent and the line lost
        self.wire = request.to_wire(header).unwrap_or_default();
        self.header = Some(header);
        self.asking = asking;
        self.since_ms = now_ms;
        self.due_ms = now_ms;
    }

    fn answered(&mut self, reply: Reply, now_ms: u64) {
        match (self.asking, reply) {
            (Asking::Hello, Reply::Hello(greeting)) => self.greeted(greeting),
            (Asking::Request, Reply::Nak(Nak::NoSession)) => {
                let session = self.header.map_or(0, |header| header.session);
                self.interrupted = true;
                self.hello(session.wrapping_add(1), now_ms);
            }
            (Asking::Request, reply) => {
                self.asking = Asking::Nothing;
                self.event = Some(Event::Reply(reply));
            }
            _ => count(&mut self.counters.ignored),
        }
    }

    fn greeted(&mut self, greeting: Greeting) {
        if greeting.version.major != PROTOCOL.major {
            self.asking = Asking::Closed;
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
        self.asking = Asking::Nothing;
        self.event = Some(Event::Connected { greeting, seen });
    }
}

fn count(counter: &mut u64) {
    *counter = counter.saturating_add(1);
}
