//! The cycle with the link's device state machine, with crashes, resets and losses at every point:
//! every planned throw ends as either done or void, none is thrown twice, and every reading is that
//! of the coin that was thrown.

use coinmc_link::{
    Action, Device, Greeting, Hardware, Host, Info, Limits, Motion, Record, Reply, Request, Sensors,
};
use coinmc_robot::cycle::{Cycle, Halt, Photo, Rules, Step};
use coinmc_robot::journal::{
    Entry, Header, History, LineChecksum, Pending, Resolution, VoidReason, parse,
};
use coinmc_robot::{Face, Setting};
use proptest::prelude::*;

const THROWS: u32 = 6;

/// The simulated robot's motors and memory.
#[derive(Default)]
struct Bench {
    memory: Option<Record>,
    aim: (u16, u16),
    /// Every release: the throw and its setting.
    releases: Vec<(u32, u16, u16)>,
    /// Number of sensor readings until the motion ends.
    left: u32,
}

impl Hardware for Bench {
    fn info(&self) -> Info {
        Info {
            limits: Limits {
                spin_mrev_s: 5000,
                angle_cdeg: 18_000,
                ..Limits::default()
            },
            ..Info::default()
        }
    }
    fn load(&mut self) -> Option<Record> {
        self.memory
    }
    fn store(&mut self, record: &Record) -> bool {
        self.memory = Some(*record);
        true
    }
    fn start(&mut self, motion: Motion) {
        self.left = 7;
        match motion {
            Motion::Aim {
                spin_mrev_s,
                angle_cdeg,
            } => self.aim = (spin_mrev_s, angle_cdeg),
            Motion::Release => {
                let id = self.memory.map_or(0, |record| record.throw_id);
                self.releases.push((id, self.aim.0, self.aim.1));
            }
            _ => {}
        }
    }
    fn motors_off(&mut self) {
        self.left = 0;
    }
    fn light(&mut self, _: u16) {}
    fn sense(&mut self) -> Sensors {
        self.left = self.left.saturating_sub(1);
        Sensors {
            settled: self.left == 0,
            spin_mrev_s: self.aim.0,
            angle_cdeg: self.aim.1,
            ..Sensors::default()
        }
    }
}

/// The face of the last released coin.
fn true_face(bench: &Bench) -> Face {
    let last = bench.releases.last().map_or(0, |release| release.0);
    Face::ALL[(last % 3) as usize]
}

fn setting(throw: u32) -> Setting {
    let throw = u16::try_from(throw).unwrap();
    Setting::new(100 * throw, 1000 + throw).unwrap()
}

/// One byte for every moment at which something can go wrong; no faults once they are used up.
struct Faults {
    bytes: Vec<u8>,
    next: usize,
}

impl Faults {
    fn draw(&mut self) -> u8 {
        let byte = self.bytes.get(self.next).copied().unwrap_or(255);
        self.next += 1;
        byte
    }
}

struct World {
    device: Option<Device<Bench>>,
    now_ms: u32,
    /// The journal's file.
    file: Vec<u8>,
    faults: Faults,
    session: u16,
}

/// The host has crashed.
struct Crashed;

enum End {
    Finished,
    Halted(Halt),
}

fn rules(adopt: bool) -> Rules {
    Rules {
        throws: THROWS,
        max_photos: 2,
        max_voids: u32::MAX,
        adopt,
    }
}

fn header() -> Header {
    Header {
        plan_hash: "abc".to_owned(),
        throws: THROWS,
    }
}

impl World {
    fn new(faults: Vec<u8>) -> Self {
        Self {
            device: Some(Device::boot(Bench::default(), 0)),
            now_ms: 0,
            file: LineChecksum::header(&header()).0.into_bytes(),
            faults: Faults {
                bytes: faults,
                next: 0,
            },
            session: 1,
        }
    }

    fn device(&mut self) -> &mut Device<Bench> {
        self.device.as_mut().unwrap()
    }

    /// Lets time pass; sometimes the robot is reset.
    fn pass(&mut self, ms: u32) {
        for _ in 0..ms / 10 {
            self.now_ms += 10;
            let now = self.now_ms;
            self.device().tick(now);
        }
        if self.faults.draw() < 8 {
            let bench = self.device.take().unwrap().into_hardware();
            let now = self.now_ms;
            self.device = Some(Device::boot(bench, now));
            self.device().tick(now);
        }
    }

    /// Sends a request over a connection that loses frames; returns the reply or the greeting of a
    /// new session.
    fn request(&mut self, host: &mut Host, request: Option<&Request>) -> Result<Reply, Greeting> {
        if let Some(request) = request {
            host.request(request, u64::from(self.now_ms)).unwrap();
        }
        loop {
            let bytes = match host.poll(u64::from(self.now_ms)) {
                Action::Transmit(bytes) => bytes.to_vec(),
                Action::Reply(reply) => return Ok(reply),
                Action::Connected { greeting, .. } => return Err(greeting),
                Action::Wait { .. } => {
                    self.pass(50);
                    continue;
                }
                Action::Lost => {
                    self.session += 1;
                    host.open(self.session, u64::from(self.now_ms));
                    continue;
                }
                Action::Refused { .. } => panic!("the versions are the same"),
            };
            if self.faults.draw() < 20 {
                continue; // the request is lost
            }
            let now = self.now_ms;
            let mut answer = Vec::new();
            for byte in bytes {
                if let Some(bytes) = self.device().receive(byte, now) {
                    answer.extend_from_slice(bytes);
                }
            }
            if self.faults.draw() >= 20 {
                host.receive(&answer, u64::from(now));
            }
        }
    }

    /// Appends to the journal; a crash leaves any beginning of the line.
    fn append(
        &mut self,
        history: &mut History,
        checksum: &mut LineChecksum,
        entry: &Entry,
    ) -> Result<(), Crashed> {
        let (line, next) = checksum.line(&entry.to_string());
        let faults = self.faults.draw();
        if faults < 20 {
            let part = line.len() * usize::from(faults) / 19;
            self.file.extend_from_slice(&line.as_bytes()[..part]);
            return Err(Crashed);
        }
        self.file.extend_from_slice(line.as_bytes());
        history.add(entry).unwrap();
        *checksum = next;
        Ok(())
    }

    /// Runs one host until it ends or crashes.
    fn host(&mut self, adopt: bool) -> Result<End, Crashed> {
        let parsed = parse(&self.file).unwrap();
        self.file.truncate(parsed.whole);
        let (mut history, mut checksum) = (parsed.history, parsed.checksum);
        let mut cycle = Cycle::new(rules(adopt));
        let mut host = Host::new();
        self.session += 1;
        host.open(self.session, u64::from(self.now_ms));
        let mut photo = None;
        loop {
            if self.faults.draw() < 6 {
                return Err(Crashed);
            }
            match cycle.step(&history, u64::from(self.now_ms)) {
                Step::Request(request) => {
                    let ready = host.is_ready();
                    match self.request(&mut host, ready.then_some(&request)) {
                        Ok(reply) => cycle.replied(&request, &reply),
                        Err(greeting) => cycle.connected(&greeting),
                    }
                }
                Step::Wait => {
                    self.pass(100);
                    if let Some(photo) = photo.take() {
                        cycle.photographed(photo);
                    }
                    cycle.waited();
                }
                Step::Announce { throw, id } => {
                    let (setting, at_ms) = (setting(throw), 7);
                    let entry = Entry::Announced { id, setting, at_ms };
                    self.append(&mut history, &mut checksum, &entry)?;
                    cycle.written(&entry);
                }
                Step::Write(entry) => {
                    self.append(&mut history, &mut checksum, &entry)?;
                    cycle.written(&entry);
                }
                Step::Photograph { id, attempt } => {
                    let face = true_face(self.device().hardware());
                    let name = format!("{id:06}-{attempt}.png").parse().unwrap();
                    let read = (self.faults.draw() >= 40).then_some((face, name));
                    cycle.photographing(id, attempt);
                    photo = Some(Photo { id, attempt, read });
                }
                Step::Finished => return Ok(End::Finished),
                Step::Halt(halt) => return Ok(End::Halted(halt)),
            }
        }
    }

    /// Runs hosts until one of them finishes.
    fn run(&mut self, adopt: bool) -> End {
        for _ in 0..10_000 {
            if let Ok(end) = self.host(adopt) {
                return end;
            }
        }
        panic!("no host has finished");
    }

    fn history(&self) -> History {
        parse(&self.file).unwrap().history
    }

    /// Checks everything that must be true of a finished experiment.
    fn audit(&mut self) {
        let history = self.history();
        let releases = self.device().hardware().releases.clone();
        assert_eq!(history.throws().len(), THROWS as usize);
        for (number, throw) in (0..).zip(history.throws()) {
            assert_eq!((throw.id, throw.setting), (number + 1, setting(number)));
            let of: Vec<_> = releases
                .iter()
                .filter(|release| release.0 == throw.id)
                .collect();
            assert!(of.len() <= 1, "throw {} was thrown twice", throw.id);
            for (_, spin, angle) in of.iter().copied() {
                assert_eq!(
                    (*spin, *angle),
                    (setting(number).spin_mrev_s(), setting(number).angle_cdeg())
                );
            }
            match throw.resolution {
                Some(Resolution::Done) => {
                    let (reading, _) = throw.reading.as_ref().unwrap();
                    assert_eq!(of.len(), 1);
                    assert_eq!(reading.face, Face::ALL[(throw.id % 3) as usize]);
                    let measured = &reading.measured;
                    assert_eq!(
                        (measured.spin_mrev_s, measured.angle_cdeg),
                        (of[0].1, of[0].2)
                    );
                }
                Some(Resolution::Void(_)) => assert!(throw.reading.is_none()),
                None => panic!("throw {} is unresolved", throw.id),
            }
        }
    }
}

#[test]
fn without_faults_every_throw_is_done() {
    let mut world = World::new(Vec::new());
    assert!(matches!(world.run(false), End::Finished));
    world.audit();
    let history = world.history();
    assert!(
        history
            .throws()
            .iter()
            .all(|t| t.resolution == Some(Resolution::Done))
    );
}

#[test]
fn unread_throws_are_void_and_not_repeated() {
    let mut world = World::new(Vec::new());
    let mut cycle = Cycle::new(rules(false));
    let mut history = History::default();
    let mut host = Host::new();
    host.open(1, 0);
    while let step = cycle.step(&history, 0)
        && step != Step::Finished
    {
        match step {
            Step::Request(request) => {
                let ready = host.is_ready();
                match world.request(&mut host, ready.then_some(&request)) {
                    Ok(reply) => cycle.replied(&request, &reply),
                    Err(greeting) => cycle.connected(&greeting),
                }
            }
            Step::Wait => {
                world.pass(100);
                cycle.waited();
            }
            Step::Announce { throw, id } => {
                let setting = setting(throw);
                history
                    .add(&Entry::Announced {
                        id,
                        setting,
                        at_ms: 0,
                    })
                    .unwrap();
            }
            Step::Write(entry) => {
                history.add(&entry).unwrap();
                cycle.written(&entry);
            }
            Step::Photograph { id, attempt } => {
                cycle.photographing(id, attempt);
                cycle.photographed(Photo {
                    id,
                    attempt,
                    read: None,
                });
            }
            other => panic!("{other:?}"),
        }
    }
    let unread = Some(Resolution::Void(VoidReason::Unread));
    assert!(
        history
            .throws()
            .iter()
            .all(|throw| throw.resolution == unread)
    );
    assert_eq!(world.device().hardware().releases.len(), THROWS as usize);
}

#[test]
fn a_counter_ahead_halts_and_is_adopted_on_demand() {
    let mut world = World::new(Vec::new());
    let mut host = Host::new();
    host.open(1, 0);
    assert!(world.request(&mut host, None).is_err());
    world.pass(100);
    let reply = world.request(&mut host, Some(&Request::SetCounter { throw_id: 500 }));
    assert!(matches!(reply, Ok(Reply::Ok { throw_id: 500, .. })));
    let ahead = Halt::Ahead {
        robot: 500,
        journal: 0,
    };
    assert!(matches!(world.run(false), End::Halted(halt) if halt == ahead));
    assert_eq!(world.history().pending(), Pending::Nothing);
    assert!(ahead.to_string().contains("--adopt"));
    assert!(matches!(world.run(true), End::Finished));
    let ids: Vec<u32> = world
        .history()
        .throws()
        .iter()
        .map(|throw| throw.id)
        .collect();
    assert_eq!(ids, (501..=500 + THROWS).collect::<Vec<_>>());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    #[test]
    fn with_any_faults_every_throw_is_resolved_once(faults in prop::collection::vec(any::<u8>(), 0..900)) {
        let mut world = World::new(faults);
        prop_assert!(matches!(world.run(false), End::Finished));
        world.audit();
    }
}
