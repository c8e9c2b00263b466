//! The firmware's state machine in C behaves like [`Device`]: the same random scripts of bytes,
//! times, sensor readings and resets give the same motions, journal records and replies.

mod support;

use coinmc_link::{
    Device, Hardware, Header, Info, Motion, PROTOCOL, Record, Request, Sensors, Version,
};
use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};
use support::Random;

const SCRIPTS: u64 = 300;
const STEPS: u32 = 300;

#[test]
fn the_firmware_in_c_behaves_like_this_crate() {
    let sources = [
        "tests/c/peer.c",
        "../../firmware/atmega328p/robot.c",
        "../../firmware/atmega328p/cycle.c",
    ];
    let Some(program) = support::compile("peer", &sources) else {
        return;
    };
    let mut script = String::from("w 1\n");
    for seed in 0..SCRIPTS {
        Author::new(seed).write(&mut script);
    }
    let ours = play(&script);
    let theirs = run(&program.path, &script);
    let differing = ours.lines().zip(theirs.lines()).position(|(a, b)| a != b);
    assert_eq!(differing, None, "line of the log");
    assert_eq!(ours.lines().count(), theirs.lines().count());
    // the scripts have covered everything
    for motion in 0..6 {
        assert!(
            ours.contains(&format!("start {motion} ")),
            "no motion {motion}"
        );
    }
    for phase in 1..8 {
        assert!(
            ours.lines()
                .any(|l| l.starts_with("store") && l.ends_with(&format!(" {phase}")))
        );
    }
    assert!(
        ours.lines()
            .filter(|line| line.starts_with("reply"))
            .count()
            > 20_000
    );
}

fn run(program: &std::path::Path, script: &str) -> String {
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the C program starts");
    let mut stdin = child.stdin.take().expect("its input");
    let script = script.to_owned();
    let writer = std::thread::spawn(move || stdin.write_all(script.as_bytes()));
    let output = child.wait_with_output().expect("the C program ends");
    writer
        .join()
        .expect("the script was written")
        .expect("the whole script");
    assert!(output.status.success());
    String::from_utf8(output.stdout).expect("text")
}

/// Plays the script to a [`Device`] and logs what it does, in the format of peer.c.
fn play(script: &str) -> String {
    let mut device: Option<Device<Logged>> = None;
    let mut hardware = Logged::default();
    let mut now_ms = 0;
    for line in script.lines() {
        let (order, rest) = line.split_at(1);
        let numbers = || {
            rest.split_whitespace()
                .map(|n| n.parse::<i64>().expect("a number"))
        };
        match order {
            "r" => {
                let before = device
                    .take()
                    .map_or(hardware.clone(), Device::into_hardware);
                device = Some(Device::boot(before, now_ms));
            }
            "w" => {
                let works = rest.trim() == "1";
                match &mut device {
                    Some(device) => device.hardware_mut().broken = !works,
                    None => hardware.broken = !works,
                }
            }
            "t" => {
                now_ms = rest.trim().parse().expect("a time");
                device.as_mut().expect("booted").tick(now_ms);
            }
            "s" => {
                let read: Vec<i64> = numbers().collect();
                device.as_mut().expect("booted").hardware_mut().sensors = sensors(&read);
            }
            _ => {
                let device = device.as_mut().expect("booted");
                for byte in rest.split_whitespace() {
                    let byte = u8::from_str_radix(byte, 16).expect("a byte");
                    let reply = device.receive(byte, now_ms).map(hex);
                    if let Some(reply) = reply {
                        let _ = writeln!(device.hardware_mut().log, "reply {reply}");
                    }
                }
            }
        }
    }
    device.expect("booted").into_hardware().log
}

fn sensors(read: &[i64]) -> Sensors {
    Sensors {
        settled: read[0] != 0,
        spin_mrev_s: u16::try_from(read[1]).expect("a spin"),
        angle_cdeg: u16::try_from(read[2]).expect("an angle"),
        x_um: i32::try_from(read[3]).expect("a position"),
        y_um: i32::try_from(read[4]).expect("a position"),
        failure: u8::try_from(read[5]).expect("a failure"),
        stopped: read[6] != 0,
    }
}

fn hex(bytes: &[u8]) -> String {
    let hex: Vec<String> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    hex.join(" ")
}

#[derive(Debug, Clone, Default)]
struct Logged {
    sensors: Sensors,
    stored: Option<Record>,
    broken: bool,
    log: String,
}

impl Hardware for Logged {
    fn info(&self) -> Info {
        support::INFO
    }

    fn load(&mut self) -> Option<Record> {
        self.stored
    }

    fn store(&mut self, next: &Record) -> bool {
        let Record {
            throw_id,
            experiment,
            boot,
            phase,
        } = *next;
        let phase = phase.number();
        let _ = writeln!(self.log, "store {throw_id} {experiment} {boot} {phase}");
        if !self.broken {
            self.stored = Some(*next);
        }
        !self.broken
    }

    fn start(&mut self, motion: Motion) {
        self.sensors.settled = false;
        let (kind, axes, spin, angle, x, y) = match motion {
            Motion::Aim {
                spin_mrev_s,
                angle_cdeg,
            } => (0, 0, spin_mrev_s, angle_cdeg, 0, 0),
            Motion::Release => (1, 0, 0, 0, 0, 0),
            Motion::DriveToCoin => (2, 0, 0, 0, 0, 0),
            Motion::Return => (3, 0, 0, 0, 0, 0),
            Motion::Home { axes } => (4, axes, 0, 0, 0, 0),
            Motion::MoveCarriage { x_um, y_um } => (5, 0, 0, 0, x_um, y_um),
        };
        let _ = writeln!(self.log, "start {kind} {axes} {spin} {angle} {x} {y}");
    }

    fn motors_off(&mut self) {
        self.log.push_str("off\n");
    }

    fn light(&mut self, permille: u16) {
        let _ = writeln!(self.log, "light {permille}");
    }

    fn sense(&mut self) -> Sensors {
        self.sensors
    }
}

/// Writes random scripts: mostly valid input, some invalid.
struct Author {
    random: Random,
    now_ms: u32,
    header: Header,
    throw_id: u32,
    last: Vec<u8>,
}

impl Author {
    fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        Self {
            // some scripts start shortly before the clock wraps
            now_ms: if random.chance(200) {
                u32::MAX - 4000
            } else {
                0
            },
            header: Header { session: 1, seq: 0 },
            throw_id: random.below(5),
            last: vec![0],
            random,
        }
    }

    fn write(mut self, script: &mut String) {
        script.push_str("w 1\nr\n");
        for _ in 0..STEPS {
            let line = match self.random.below(100) {
                0..50 => format!("b {}", hex(&self.bytes())),
                50..80 => self.time(),
                80..98 => self.sensors(),
                98 => format!("w {}", u8::from(!self.random.chance(200))),
                _ => "r".to_owned(),
            };
            let _ = writeln!(script, "{line}");
        }
    }

    fn time(&mut self) -> String {
        let step = match self.random.below(100) {
            0..80 => self.random.below(300),
            80..98 => self.random.below(5_500),
            _ => self.random.below(61_000),
        };
        self.now_ms = self.now_ms.wrapping_add(step);
        format!("t {}", self.now_ms)
    }

    fn sensors(&mut self) -> String {
        let r = &mut self.random;
        format!(
            "s {} {} {} {} {} {} {}",
            u8::from(r.chance(850)),
            r.below(65_536),
            r.below(18_001),
            i64::from(r.below(4_000)) - 2_000,
            i64::from(r.below(4_000)) - 2_000,
            if r.chance(20) { 1 + r.below(255) } else { 0 },
            u8::from(r.chance(10)),
        )
    }

    fn bytes(&mut self) -> Vec<u8> {
        match self.random.below(100) {
            0..5 => (0..self.random.below(90))
                .map(|_| self.random.byte())
                .collect(),
            5..15 => self.last.clone(),
            15..20 => {
                let mut bytes = self.last.clone();
                let at = self.random.below(u32::try_from(bytes.len()).unwrap()) as usize;
                bytes[at] = self.random.byte();
                bytes
            }
            20..25 => self.odd_body(),
            _ => {
                let request = self.request();
                self.last = request.to_wire(self.header).unwrap().as_bytes().to_vec();
                self.last.clone()
            }
        }
    }

    /// The body of an intact frame, rarely a valid request.
    fn odd_body(&mut self) -> Vec<u8> {
        self.header.seq = self.header.seq.wrapping_add(1);
        let mut body = vec![u8::try_from(self.random.below(12)).unwrap()];
        let more = self.random.below(13);
        body.extend((0..more).map(|_| match self.random.below(3) {
            0 => self.random.byte() | 0x80,
            1 => self.random.byte(),
            _ => u8::try_from(self.random.below(4)).unwrap(),
        }));
        let wire = coinmc_link::Wire::new(self.header, &body).unwrap();
        wire.as_bytes().to_vec()
    }

    fn request(&mut self) -> Request {
        let r = &mut self.random;
        if !r.chance(50) {
            self.header.seq = self.header.seq.wrapping_add(1);
        }
        let number = |r: &mut Random, end| u16::try_from(r.below(end)).unwrap();
        match r.below(100) {
            0..8 => {
                let session = number(r, 4).max(1);
                self.header.session = session;
                Request::Hello {
                    version: Version {
                        major: if r.chance(100) { 1 } else { PROTOCOL.major },
                        minor: 0,
                    },
                    session: if r.chance(50) { 9 } else { session },
                }
            }
            8..12 => Request::Info,
            12..35 => Request::Status,
            35..38 => Request::Stop,
            38..42 => Request::Home {
                axes: u8::try_from(r.below(18)).unwrap(),
            },
            42..62 => {
                self.throw_id = self.throw_id.wrapping_add(r.below(3));
                Request::Throw {
                    throw_id: self.throw_id,
                    experiment: r.below(2),
                    spin_mrev_s: number(r, 5_100),
                    angle_cdeg: number(r, 18_100),
                }
            }
            62..66 => Request::MoveCarriage {
                x_um: i32::try_from(r.below(900_000)).unwrap() - 450_000,
                y_um: i32::try_from(r.below(700_000)).unwrap() - 350_000,
            },
            66..70 => Request::Light {
                permille: number(r, 1_100),
            },
            70..85 => Request::Collect {
                throw_id: self.throw_id.wrapping_sub(u32::from(r.chance(100))),
            },
            85..97 => Request::ClearFault {
                code: r.pick(&[
                    0, 1, 2, 2, 3, 4, 4, 102, 103, 104, 105, 106, 202, 203, 204, 205, 206, 200, 201,
                ]),
            },
            _ => Request::SetCounter {
                throw_id: self.throw_id.wrapping_sub(r.below(3)),
                experiment: r.below(3),
            },
        }
    }
}
