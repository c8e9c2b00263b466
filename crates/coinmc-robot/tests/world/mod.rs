//! The cycle with the link's device, a journal in memory, and faults at every point. The robot writes its
//! memory byte by byte, its clock wraps, the host's calendar jumps, and some answers are forged.
#![allow(dead_code, missing_docs, unreachable_pub)] // each test uses its part

use coinmc_link::{
    Action, Device, Greeting, Hardware, Host, Info, Limits, Motion, Record, Reply, Request, Sensors,
};
use coinmc_robot::cycle::{Cycle, Halt, Photo, Rules, Shown, Step};
use coinmc_robot::journal::{Digest, Entry, Header, History, LineChecksum, Resolution, parse};
use coinmc_robot::sim::{Dice, reframed, with_another_identity, with_old_content};
use coinmc_robot::{Face, Setting};

/// Bytes of a record in the robot's memory, and how long each takes.
const RECORD_BYTES: u32 = 17;
const BYTE_US: u32 = 3_400;
/// When the robot's clock wraps.
const WRAPS_AFTER_MS: u32 = 4_000;
/// How far the host's calendar jumps at most: ten days.
const JUMP_MS: u64 = 864_000_000;
/// More steps than any host needs: one that goes on and on fails.
pub const MAX_STEPS: u32 = 1_500;

pub const THROWS: u32 = 6;
/// Number of the experiment.
pub const OURS: u32 = 77;
pub const PROGRAM: &str = "0.1.0";

/// The simulated robot's motors and memory.
#[derive(Default)]
pub struct Bench {
    pub memory: Option<Record>,
    pub uid: u8,
    pub stopped: bool,
    /// Measured less asked for, spin.
    pub drift: u16,
    /// Greatest spin, if it is not the protocol's.
    pub reach: Option<u16>,
    pub aim: (u16, u16),
    /// Every release: the throw and its setting, and whose it is.
    pub releases: Vec<(u32, u16, u16)>,
    pub experiments: Vec<u32>,
    /// Number of sensor readings until the motion ends.
    pub left: u32,
    /// A reset comes after so many bytes of the next record.
    pub cut_after: Option<u32>,
    /// It has come.
    pub cut: bool,
    /// Time spent writing, µs.
    pub written_us: u32,
}

impl Hardware for Bench {
    fn info(&self) -> Info {
        Info {
            uid: [0, 0, 0, 0, 0, 0, 0, self.uid],
            limits: Limits {
                spin_mrev_s: self.reach.unwrap_or(5000),
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
        if self.cut {
            return false;
        }
        let cut = self.cut_after.take();
        let bytes = cut.unwrap_or(RECORD_BYTES).min(RECORD_BYTES);
        self.written_us += BYTE_US * bytes;
        self.cut = cut.is_some();
        if bytes == RECORD_BYTES {
            self.memory = Some(*record);
        }
        !self.cut
    }
    fn start(&mut self, motion: Motion) {
        if self.cut {
            return;
        }
        self.left = 7;
        match motion {
            Motion::Aim {
                spin_mrev_s,
                angle_cdeg,
            } => self.aim = (spin_mrev_s, angle_cdeg),
            Motion::Release => {
                let id = self.memory.map_or(0, |record| record.throw_id);
                self.releases.push((id, self.aim.0, self.aim.1));
                let experiment = self.memory.map_or(0, |record| record.experiment);
                self.experiments.push(experiment);
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
            spin_mrev_s: self.aim.0 + self.drift,
            angle_cdeg: self.aim.1,
            stopped: self.stopped,
            ..Sensors::default()
        }
    }
}

/// The face of the last released coin.
pub fn true_face(bench: &Bench) -> Face {
    let last = bench.releases.last().map_or(0, |release| release.0);
    Face::ALL[(last % 3) as usize]
}

pub fn setting(throw: u32) -> Setting {
    let throw = u16::try_from(throw).unwrap();
    Setting::new(100 * throw, 1000 + throw).unwrap()
}

/// One byte for every moment at which something can go wrong; no faults once they are used up.
pub struct Faults {
    pub bytes: Vec<u8>,
    pub next: usize,
}

impl Faults {
    pub fn draw(&mut self) -> u8 {
        let byte = self.bytes.get(self.next).copied().unwrap_or(255);
        self.next += 1;
        byte
    }
}

pub struct World {
    pub device: Option<Device<Bench>>,
    /// Time of the host; the robot has its own.
    pub now_ms: u64,
    /// The journal's file.
    pub file: Vec<u8>,
    pub faults: Faults,
    pub session: u16,
    pub camera_fails: bool,
    /// The frame that the robot sent last.
    sent: Vec<u8>,
    /// Answers that were forged.
    pub forged: u32,
    /// Resets within a record.
    pub cuts: u32,
    dice: Dice,
}

/// The host has crashed.
pub struct Crashed;

pub enum End {
    Finished,
    Halted(Halt),
}

pub fn rules(adopt: bool) -> Rules {
    Rules {
        throws: THROWS,
        experiment: OURS,
        reach: Setting::new(500, 2000).unwrap(),
        spin_tolerance_mrev_s: 50,
        angle_tolerance_cdeg: 200,
        max_photos: 2,
        max_camera_failures: 3,
        max_voids: u32::MAX,
        adopt,
    }
}

/// The robot's clock, ms.
#[allow(clippy::cast_possible_truncation)] // it wraps
pub fn chip_ms(now_ms: u64) -> u32 {
    (now_ms as u32).wrapping_sub(WRAPS_AFTER_MS)
}

pub fn header() -> Header {
    Header {
        plan_hash: "abc".to_owned(),
        throws: THROWS,
        experiment: OURS,
    }
}

impl World {
    pub fn new(faults: Vec<u8>) -> Self {
        Self {
            device: Some(Device::boot(Bench::default(), chip_ms(0))),
            now_ms: 0,
            file: LineChecksum::header(&header()).0.into_bytes(),
            faults: Faults {
                bytes: faults,
                next: 0,
            },
            session: 1,
            camera_fails: false,
            sent: Vec::new(),
            forged: 0,
            cuts: 0,
            dice: Dice::new(1, 0),
        }
    }

    /// The calendar of the host: it jumps.
    fn calendar_ms(&mut self) -> u64 {
        (JUMP_MS + self.now_ms) - self.dice.word() % JUMP_MS
    }

    /// The robot starts again.
    pub fn reboot(&mut self, change: impl FnOnce(&mut Bench)) {
        let mut bench = self.device.take().unwrap().into_hardware();
        bench.cut = false;
        change(&mut bench);
        let now = chip_ms(self.now_ms);
        self.device = Some(Device::boot(bench, now));
        self.device().tick(now);
    }

    /// The time that writing has taken, and the reset that has interrupted it; whether one has.
    fn after_writing(&mut self) -> bool {
        let bench = self.device().hardware_mut();
        let spent = std::mem::take(&mut bench.written_us) / 1000;
        let cut = bench.cut;
        self.now_ms += u64::from(spent);
        if cut {
            self.cuts += 1;
            self.reboot(|_| {});
        }
        cut
    }

    pub fn device(&mut self) -> &mut Device<Bench> {
        self.device.as_mut().unwrap()
    }

    /// Lets time pass; sometimes the robot is reset, at once or while it writes its next record.
    pub fn pass(&mut self, ms: u32) {
        for _ in 0..ms / 10 {
            self.now_ms += 10;
            let now = chip_ms(self.now_ms);
            self.device().tick(now);
            self.after_writing();
        }
        match self.faults.draw() {
            0..4 => self.reboot(|_| {}),
            4..8 => {
                let bytes = u32::from(self.faults.draw()) % (RECORD_BYTES + 1);
                self.device().hardware_mut().cut_after = Some(bytes);
            }
            _ => {}
        }
    }

    /// Sends a request over a connection that loses frames; returns the reply or the greeting of a
    /// new session.
    pub fn request(
        &mut self,
        host: &mut Host,
        request: Option<&Request>,
    ) -> Result<Reply, Greeting> {
        if let Some(request) = request {
            host.request(request, self.now_ms).unwrap();
        }
        loop {
            let bytes = match host.poll(self.now_ms) {
                Action::Transmit(bytes) => bytes.to_vec(),
                Action::Reply(reply) => return Ok(reply),
                Action::Connected { greeting, .. } => return Err(greeting),
                Action::Wait { .. } => {
                    self.pass(50);
                    continue;
                }
                Action::Lost => {
                    self.session += 1;
                    host.open(self.session, self.now_ms);
                    continue;
                }
                Action::Refused { .. } => panic!("the versions are the same"),
            };
            if self.faults.draw() < 20 {
                continue; // the request is lost
            }
            let now = chip_ms(self.now_ms);
            let mut answer = Vec::new();
            for byte in bytes {
                if let Some(bytes) = self.device().receive(byte, now) {
                    answer.extend_from_slice(bytes);
                }
            }
            if self.after_writing() {
                continue; // and so is the answer
            }
            let forged = self.forge(&answer);
            host.receive(&forged, self.now_ms);
            self.sent.clone_from(&answer);
            if self.faults.draw() >= 20 {
                host.receive(&answer, self.now_ms);
            }
        }
    }

    /// An intact frame that comes before the answer; mostly none.
    fn forge(&mut self, answer: &[u8]) -> Vec<u8> {
        let forged = match self.faults.draw() {
            0..8 => reframed(answer, &mut self.dice),
            8..14 => with_another_identity(answer, &mut self.dice),
            14..20 => with_old_content(answer, &self.sent),
            _ => None,
        };
        self.forged += u32::from(forged.is_some());
        forged.unwrap_or_default()
    }

    /// Sends the request that the cycle asks for, and tells it what came of it.
    pub fn ask(&mut self, cycle: &mut Cycle, host: &mut Host, request: &Request) {
        let ready = host.is_ready();
        match self.request(host, ready.then_some(request)) {
            Ok(reply) => cycle.replied(request, &reply),
            Err(greeting) => cycle.connected(&greeting),
        }
    }

    /// Appends to the journal; a crash leaves any beginning of the line.
    pub fn append(
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
    pub fn host(&mut self, adopt: bool) -> Result<End, Crashed> {
        let parsed = parse(&self.file).unwrap();
        self.file.truncate(parsed.whole);
        let (mut history, mut checksum) = (parsed.history, parsed.checksum);
        let mut cycle = Cycle::new(rules(adopt), PROGRAM);
        let mut host = Host::new();
        self.session += 1;
        host.open(self.session, self.now_ms);
        let mut photo = None;
        for _ in 0..MAX_STEPS {
            if self.faults.draw() < 6 {
                return Err(Crashed);
            }
            let at_ms = self.calendar_ms();
            match cycle.step(&history, at_ms) {
                Step::Request(request) => {
                    self.ask(&mut cycle, &mut host, &request);
                }
                Step::Wait => {
                    self.pass(100);
                    if let Some(photo) = photo.take() {
                        cycle.photographed(photo);
                    }
                    cycle.waited();
                }
                Step::Announce { throw, id } => {
                    let setting = setting(throw);
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
                    let digest = Digest(u64::from(id) << 8 | u64::from(attempt));
                    let shown = match self.faults.draw() {
                        _ if self.camera_fails => Shown::Failure("it hangs".to_owned()),
                        0..40 => Shown::Nothing,
                        _ => Shown::Face {
                            face,
                            image: name,
                            digest,
                        },
                    };
                    cycle.photographing(id, attempt);
                    photo = Some(Photo { id, attempt, shown });
                }
                Step::Finished => return Ok(End::Finished),
                Step::Halt(halt) => return Ok(End::Halted(halt)),
            }
        }
        panic!("the host goes on and on");
    }

    /// Runs hosts until one of them finishes.
    pub fn run(&mut self, adopt: bool) -> End {
        for _ in 0..10_000 {
            if let Ok(end) = self.host(adopt) {
                return end;
            }
        }
        panic!("no host has finished");
    }

    /// Runs hosts until one of them finishes. A person who is asked about the robot starts the host again,
    /// because the answer was forged; and takes the robot over if the host still asks when none is: it
    /// may have been told that an announced throw was made, which the robot knows nothing of.
    pub fn run_through_halts(&mut self) {
        for _ in 0..1_000 {
            let adopt = self.faults.next > self.faults.bytes.len();
            match self.run(adopt) {
                End::Finished => return,
                End::Halted(Halt::Ahead { .. } | Halt::Foreign { .. }) if !adopt => {}
                End::Halted(halt) => panic!("{halt}"),
            }
        }
        panic!("it halts again and again");
    }

    pub fn history(&self) -> History {
        parse(&self.file).unwrap().history
    }

    /// Checks everything that must be true of a finished experiment.
    pub fn audit(&mut self) {
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
