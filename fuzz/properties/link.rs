//! What must hold for any bytes on the robot's link. Shared by the fuzz targets `link_decoder` and
//! `link_device` and by `coinmc-studies link-fuzz`.

use coinmc_link::{
    Decoder, Device, Hardware, Header, Host, Info, Limits, MAX_WIRE, Motion, PROTOCOL, Record,
    Reply, Request, SILENCE_LIMIT_MS, Sensors, State, Wire, capability,
};

/// Whatever arrives, every frame accepted is the one encoding of its content, the next whole frame
/// is read, and a host that asked nothing believes nothing.
pub(crate) fn decoder(bytes: &[u8]) {
    let mut decoder = Decoder::new();
    let mut host = Host::new();
    for byte in bytes {
        if let Some(Ok(frame)) = decoder.push(*byte) {
            let (header, body) = (frame.header, frame.body);
            let wire = Wire::new(header, body).expect("what was read fits");
            assert!(wire.as_bytes().len() <= MAX_WIRE);
            let request = Request::decode(body);
            let reply = Reply::decode(body);
            assert!(request.is_err() || reply.is_err(), "both directions");
            if let Ok(request) = request {
                let again = request.to_wire(header).expect("every request fits");
                assert_eq!(again.as_bytes(), wire.as_bytes());
            }
            if let Ok(reply) = reply {
                let again = reply.to_wire(header).expect("every reply fits");
                assert_eq!(again.as_bytes(), wire.as_bytes());
            }
        }
    }
    host.receive(bytes, 0);
    assert!(!host.is_ready());
    let header = Header {
        session: 0x00A5,
        seq: 0xFF00,
    };
    let next = Request::Status.to_wire(header).expect("every request fits");
    let mut read = false;
    for byte in next.as_bytes() {
        if let Some(Ok(frame)) = decoder.push(*byte) {
            read = frame.header == header && Request::decode(frame.body) == Ok(Request::Status);
        }
    }
    assert!(read, "the frame after it is lost");
}

/// A device in any course of events, written as bytes: it throws an id once, journals first, has no
/// current without a host, and answers a repetition as it did before.
pub(crate) fn device(script: &[u8]) {
    let mut course = Course {
        script,
        device: Device::boot(Bench::default(), 0),
        now_ms: 0,
        header: Header { session: 1, seq: 0 },
        last: Wire::default(),
        heard_ms: 0,
    };
    course.hello();
    while course.step().is_some() {
        course.check();
    }
}

struct Course<'a> {
    script: &'a [u8],
    device: Device<Bench>,
    now_ms: u32,
    header: Header,
    last: Wire,
    heard_ms: u32,
}

impl Course<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.script.split_first()?;
        self.script = rest;
        Some(*first)
    }

    fn bytes(&mut self, length: u8) -> &[u8] {
        let length = usize::from(length).min(self.script.len());
        let (bytes, rest) = self.script.split_at(length);
        self.script = rest;
        bytes
    }

    /// One event; none when the script has ended.
    fn step(&mut self) -> Option<()> {
        let order = self.byte()?;
        match order % 8 {
            // a message in a whole frame
            0..3 => {
                self.header.seq = self.header.seq.wrapping_add(1);
                let header = self.header;
                let body = self.bytes(order / 8).to_vec();
                let frame = Wire::new(header, &body).expect("a short body");
                self.send(frame.as_bytes());
                self.last = frame;
            }
            3 => self.repeat(),
            4 => {
                let bytes = self.bytes(order / 8).to_vec();
                self.send(&bytes);
                self.header.session = self.header.session.wrapping_add(u16::from(order > 127));
            }
            5 => self.tick(u32::from(order / 8) * 8),
            6 => {
                self.device.hardware_mut().settled = order & 8 != 0;
                self.device.hardware_mut().store_fails = order & 0x30 == 0x30;
                self.device.hardware_mut().failure = u8::from(order & 0xC0 == 0xC0);
                self.device.hardware_mut().stopped = order & 0xB0 == 0xA0;
                self.tick(u32::from(order));
            }
            _ if order > 200 => self.reset(),
            _ => self.tick(u32::from(order) * 100),
        }
        Some(())
    }

    fn tick(&mut self, ms: u32) {
        self.now_ms += ms;
        self.device.tick(self.now_ms);
        if self.device.hardware().stopped {
            assert_eq!(self.device.state(), State::Fault);
            assert!(!self.device.hardware().motors_on, "current in an emergency");
        }
    }

    fn hello(&mut self) {
        self.header.seq = self.header.seq.wrapping_add(1);
        let session = self.header.session.max(1);
        self.header.session = session;
        let version = PROTOCOL;
        let hello = Request::Hello { version, session };
        let frame = hello.to_wire(self.header).expect("every request fits");
        self.send(frame.as_bytes());
        self.last = frame;
    }

    /// The last frame again: the same answer, unless it is a Hello.
    fn repeat(&mut self) {
        let frame = self.last.as_bytes().to_vec();
        let first = self.send(&frame);
        let releases = self.device.hardware().releases;
        let second = self.send(&frame);
        if !matches!(first, Some(Reply::Hello(_))) {
            assert_eq!(first, second);
        }
        assert_eq!(self.device.hardware().releases, releases);
    }

    fn send(&mut self, bytes: &[u8]) -> Option<Reply> {
        let mut last = None;
        for byte in bytes {
            let Some(wire) = self.device.receive(*byte, self.now_ms) else {
                continue;
            };
            let mut decoder = Decoder::new();
            for byte in wire {
                if let Some(frame) = decoder.push(*byte) {
                    let frame = frame.expect("the device sends whole frames");
                    last = Some(Reply::decode(frame.body).expect("the device sends replies"));
                }
            }
            assert!(last.is_some(), "the device sends one frame");
            self.heard_ms = self.now_ms;
        }
        last
    }

    fn reset(&mut self) {
        let stored = self.device.hardware().stored;
        let caught =
            stored.is_some_and(|record| record.phase.in_cycle() || record.phase == State::Fault);
        let bench = std::mem::take(self.device.hardware_mut());
        self.device = Device::boot(bench, self.now_ms);
        assert_eq!(self.device.state() == State::Fault, caught || self.broken());
        self.hello();
    }

    fn broken(&self) -> bool {
        self.device.hardware().store_fails
    }

    fn check(&self) {
        let bench = self.device.hardware();
        if self.now_ms - self.heard_ms >= SILENCE_LIMIT_MS {
            assert!(!bench.motors_on, "current without a host");
        }
        if self.device.state().in_cycle() {
            assert_eq!(
                bench.stored.map(|record| record.phase),
                Some(self.device.state())
            );
        }
    }
}

#[derive(Debug, Default)]
#[allow(clippy::struct_excessive_bools)] // inputs and outputs of a board
struct Bench {
    settled: bool,
    store_fails: bool,
    failure: u8,
    stopped: bool,
    motors_on: bool,
    stored: Option<Record>,
    releases: u32,
    /// The id released last.
    released: u32,
}

impl Hardware for Bench {
    fn info(&self) -> Info {
        Info {
            capabilities: capability::LIGHT | capability::CARRIAGE,
            limits: Limits {
                spin_mrev_s: 5000,
                angle_cdeg: 18_000,
                x_um: 400_000,
                y_um: 300_000,
            },
            ..Info::default()
        }
    }

    fn load(&mut self) -> Option<Record> {
        self.stored
    }

    fn store(&mut self, record: &Record) -> bool {
        if !self.store_fails {
            // SetCounter may go back: the ids begin anew
            if self
                .stored
                .is_some_and(|before| record.throw_id < before.throw_id)
            {
                self.released = 0;
            }
            self.stored = Some(*record);
        }
        !self.store_fails
    }

    fn start(&mut self, motion: Motion) {
        self.motors_on = true;
        self.settled = false;
        if motion == Motion::Release {
            let record = self.stored.expect("a journal before the release");
            assert_eq!(record.phase, State::Flying);
            assert!(record.throw_id > self.released, "thrown twice");
            self.released = record.throw_id;
            self.releases += 1;
        }
    }

    fn motors_off(&mut self) {
        self.motors_on = false;
    }

    fn light(&mut self, permille: u16) {
        assert!(permille <= 1000);
    }

    fn sense(&mut self) -> Sensors {
        Sensors {
            settled: self.settled,
            failure: self.failure,
            stopped: self.stopped,
            ..Sensors::default()
        }
    }
}
