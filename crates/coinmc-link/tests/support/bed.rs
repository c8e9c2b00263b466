//! A device, its clock, and a host on a perfect connection.

use super::Bench;
use coinmc_link::{Decoder, Device, Greeting, Header, PROTOCOL, Reply, Request, State, Status};

pub const EXPERIMENT: u32 = 77;

/// A device, its clock, and a host on a perfect connection.
pub struct TestBed {
    pub device: Device<Bench>,
    pub now_ms: u32,
    pub header: Header,
}

impl TestBed {
    pub fn new(bench: Bench) -> Self {
        let mut bed = Self {
            device: Device::boot(bench, 0),
            now_ms: 0,
            header: Header { session: 7, seq: 0 },
        };
        bed.pass(20);
        bed
    }

    /// An idle device with an open session.
    pub fn ready() -> Self {
        let mut bed = Self::new(Bench::default());
        bed.hello(7);
        bed
    }

    pub fn pass(&mut self, ms: u32) {
        for _ in 0..ms.div_ceil(10) {
            self.now_ms += 10;
            self.device.hardware_mut().now_ms = self.now_ms;
            self.device.tick(self.now_ms);
        }
    }

    /// Lets time pass while the host keeps requesting the status.
    pub fn pass_with_requests(&mut self, ms: u32) {
        for _ in 0..ms.div_ceil(100) {
            self.status();
            self.pass(100);
        }
    }

    pub fn reset(&mut self) {
        let mut bench = self.device.hardware().clone();
        bench.stuck = None;
        self.device = Device::boot(bench, self.now_ms);
        self.pass(20);
    }

    pub fn send(&mut self, bytes: &[u8]) -> Option<Reply> {
        let mut reply = None;
        for byte in bytes {
            if let Some(bytes) = self.device.receive(*byte, self.now_ms) {
                assert!(reply.is_none(), "two replies to one request");
                reply = Some(read(bytes, self.header));
            }
        }
        reply
    }

    /// Sends a request without advancing the sequence number.
    pub fn repeat(&mut self, request: &Request) -> Option<Reply> {
        let wire = request.to_wire(self.header).unwrap();
        self.send(wire.as_bytes())
    }

    pub fn request(&mut self, request: &Request) -> Reply {
        self.header.seq = self.header.seq.wrapping_add(1);
        self.repeat(request).expect("a reply")
    }

    pub fn hello(&mut self, session: u16) -> Greeting {
        self.header.session = session;
        let version = PROTOCOL;
        match self.request(&Request::Hello { version, session }) {
            Reply::Hello(greeting) => greeting,
            other => panic!("{other:?}"),
        }
    }

    pub fn status(&mut self) -> Status {
        match self.request(&Request::Status) {
            Reply::Status(status) => status,
            other => panic!("{other:?}"),
        }
    }

    pub fn status_or_none(&mut self) -> Option<Status> {
        match self.request(&Request::Status) {
            Reply::Status(status) => Some(status),
            _ => None,
        }
    }

    pub fn throw(&mut self, throw_id: u32) -> Reply {
        self.request(&throw(throw_id))
    }

    /// Brings the robot from Idle to the state, with throw 1.
    pub fn bring_to(&mut self, state: State) {
        assert_eq!(self.throw(1), ok(1, State::Aiming));
        if state == State::Returning {
            self.bring_on(State::AtCoin);
            self.request(&Request::Collect { throw_id: 1 });
        } else {
            self.bring_on(state);
        }
    }

    pub fn bring_on(&mut self, state: State) {
        for _ in 0..100 {
            if self.device.state() == state {
                return;
            }
            self.pass(10);
        }
        panic!("never {state:?}");
    }

    pub fn releases(&self) -> &[u32] {
        &self.device.hardware().releases
    }
}

pub fn read(bytes: &[u8], header: Header) -> Reply {
    let mut decoder = Decoder::new();
    for byte in bytes {
        if let Some(frame) = decoder.push(*byte) {
            let frame = frame.expect("an intact frame");
            assert_eq!(frame.header, header);
            return Reply::decode(frame.body).expect("a reply");
        }
    }
    panic!("no frame in {bytes:?}");
}

pub fn throw(throw_id: u32) -> Request {
    Request::Throw {
        throw_id,
        experiment: EXPERIMENT,
        spin_mrev_s: 3200,
        angle_cdeg: 9000,
    }
}

pub fn ok(throw_id: u32, state: State) -> Reply {
    Reply::Ok { throw_id, state }
}

pub const CYCLE: [State; 5] = [
    State::Aiming,
    State::Flying,
    State::Driving,
    State::AtCoin,
    State::Returning,
];
