//! The robot's side of the link: answers requests, runs the cycle of a throw, keeps its journal.
//!
//! The rules, each learned from a failure of an earlier robot:
//! 1. A repeated request (same session, same sequence number) gets the same reply and is not
//!    executed again. Hello never counts as a repetition: a new host may happen to start with the
//!    number at which the last one ended.
//! 2. An id of a throw is accepted once. Any greater id is accepted: a robot with blank memory must
//!    not block an experiment that is at throw 5000.
//! 3. Every phase is in the journal before it begins, so that a coin that may have been released is
//!    never thrown again: a start during a cycle ends in Fault 100 + phase.
//! 4. After a start there is no session; every request gets `NoSession` until the next Hello.
//! 5. A damaged frame gets no reply, which could collide with another one.
//! 6. Every phase and every motion has a time limit, whatever the host sends; after 5 s without a
//!    host, and whenever nothing moves, all motors are off.
//! 7. An emergency stop is latched: it outlasts its button and a reset, until `ClearFault`.

mod cycle;
mod hardware;

pub use cycle::{
    AT_COIN_LIMIT_MS, BOOT_LIMIT_MS, HOME_LIMIT_MS, MOVE_LIMIT_MS, SILENCE_LIMIT_MS, fault,
};
pub use hardware::{Hardware, Motion, Record, Sensors};

use crate::frame::{Decoder, Header, Wire};
use crate::message::{
    BadMessage, Greeting, Info, Nak, PROTOCOL, Reply, Request, State, Status, Version, capability,
};
use cycle::Cycle;

/// The robot's state machine. Pass it every byte received, and call [`Device::tick`] about every
/// 10 ms or more often: only then do phases advance and limits apply.
///
/// Times are in ms from any origin and may wrap; it assumes at least one tick every 24 days.
#[derive(Debug)]
pub struct Device<H> {
    hardware: H,
    decoder: Decoder,
    out: Wire,
    /// 0: none.
    session: u16,
    /// Sequence number of the last request in this session, and its reply.
    answered: Option<(u16, Reply)>,
    rx_bad: u16,
    started_ms: u32,
    cycle: Cycle,
}

impl<H: Hardware> Device<H> {
    /// The robot after power-on or reset: motors off, no session; in Fault if the journal contains
    /// an unfinished throw.
    pub fn boot(mut hardware: H, now_ms: u32) -> Self {
        let cycle = Cycle::boot(&mut hardware, now_ms);
        Self {
            hardware,
            decoder: Decoder::new(),
            out: Wire::default(),
            session: 0,
            answered: None,
            rx_bad: 0,
            started_ms: now_ms,
            cycle,
        }
    }

    /// Takes one received byte; returns the bytes to send if it completed a request.
    pub fn receive(&mut self, byte: u8, now_ms: u32) -> Option<&[u8]> {
        let Ok(frame) = self.decoder.push(byte)? else {
            self.rx_bad = self.rx_bad.saturating_add(1);
            return None;
        };
        let (header, request) = (frame.header, Request::decode(frame.body));
        let reply = self.answer(header, request, now_ms);
        // every reply fits (tested); if one did not, sending nothing would be right
        self.out = reply.to_wire(header).unwrap_or_default();
        Some(self.out.as_bytes())
    }

    /// Advances the cycle and checks the time limits.
    pub fn tick(&mut self, now_ms: u32) {
        self.cycle.tick(&mut self.hardware, now_ms);
    }

    /// The robot's state.
    pub fn state(&self) -> State {
        self.cycle.state
    }

    /// The hardware.
    pub fn hardware(&self) -> &H {
        &self.hardware
    }

    /// The hardware, mutable.
    pub fn hardware_mut(&mut self) -> &mut H {
        &mut self.hardware
    }

    /// The hardware, which is all that survives a loss of power.
    pub fn into_hardware(self) -> H {
        self.hardware
    }

    fn answer(
        &mut self,
        header: Header,
        request: Result<Request, BadMessage>,
        now_ms: u32,
    ) -> Reply {
        if let Ok(Request::Hello { version, session }) = request {
            return self.hello(header, version, session, now_ms);
        }
        if self.session == 0 || header.session != self.session {
            return Reply::Nak(Nak::NoSession);
        }
        self.cycle.heard(now_ms);
        if let Some((seq, reply)) = self.answered
            && seq == header.seq
        {
            return reply;
        }
        let reply = match request {
            Ok(request) => self.execute(request, now_ms),
            Err(BadMessage::Malformed) => Reply::Nak(Nak::BadMessage),
            Err(BadMessage::OutOfRange) => Reply::Nak(Nak::BadRange),
        };
        self.answered = Some((header.seq, reply));
        reply
    }

    fn hello(&mut self, header: Header, version: Version, session: u16, now_ms: u32) -> Reply {
        if header.session != session {
            return Reply::Nak(Nak::BadRange);
        }
        if version.major == PROTOCOL.major {
            self.session = session;
            self.answered = None;
            self.cycle.heard(now_ms);
        }
        Reply::Hello(Greeting {
            version: PROTOCOL,
            boot: self.cycle.boot,
            throw_id: self.cycle.throw_id,
            state: self.cycle.state,
        })
    }

    fn execute(&mut self, request: Request, now_ms: u32) -> Reply {
        if exceeds_limits(&self.hardware.info(), &request) {
            return Reply::Nak(Nak::BadRange);
        }
        let done = match request {
            // `answer` has handled Hello
            Request::Hello { .. } => Err(Nak::BadMessage),
            Request::Info => return Reply::Info(self.hardware.info()),
            Request::Status => return Reply::Status(self.status(now_ms)),
            Request::Light { permille } => {
                self.hardware.light(permille);
                Ok(())
            }
            other => self.cycle.execute(&mut self.hardware, other, now_ms),
        };
        match done {
            Ok(()) => Reply::Ok {
                throw_id: self.cycle.throw_id,
                state: self.cycle.state,
            },
            Err(nak) => Reply::Nak(nak),
        }
    }

    fn status(&mut self, now_ms: u32) -> Status {
        let sensors = self.hardware.sense();
        let t_ms = now_ms.wrapping_sub(self.started_ms);
        self.cycle
            .status(&sensors, self.started_ms, t_ms, self.rx_bad)
    }
}

/// Whether a request exceeds this robot's capabilities or limits.
fn exceeds_limits(info: &Info, request: &Request) -> bool {
    let lacks = |bit| info.capabilities & bit == 0;
    let far = |um: i32, limit: i32| i64::from(um).abs() > i64::from(limit);
    match *request {
        Request::Throw {
            spin_mrev_s,
            angle_cdeg,
            ..
        } => spin_mrev_s > info.limits.spin_mrev_s || angle_cdeg > info.limits.angle_cdeg,
        Request::MoveCarriage { x_um, y_um } => {
            lacks(capability::CARRIAGE)
                || far(x_um, info.limits.x_um)
                || far(y_um, info.limits.y_um)
        }
        Request::Light { .. } => lacks(capability::LIGHT),
        _ => false,
    }
}
