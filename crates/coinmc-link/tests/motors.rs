//! Current of the motors after any single fault, in a simulated microcontroller: never longer than its
//! limit. `scripts/firmware test` starts it, like `firmware.rs`, with `COINMC_SIMULATOR` and
//! `COINMC_SIMULATOR_SPEED`, simulated time over real time.
#![cfg(target_os = "linux")]

mod support;

use coinmc_link::{
    Action, Host, PROTOCOL, Reply, Request, SILENCE_LIMIT_MS, State, Status, Version, fault,
};
use std::fs::File;
use std::io::Write;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};
use support::simulator::Simulator;

/// What the measurement adds: the time between two looks at the pin, on a busy computer.
const SLACK_MS: u64 = 600;

/// After so long without its main loop the chip is reset.
const WATCHDOG_MS: u64 = 1_000;

/// The ATmega328P looks at the emergency stop as often.
const LOOK_MS: f64 = 1.1;

/// Who talks to the robot after the fault.
#[derive(Clone, Copy)]
enum Then {
    Nobody,
    Polls,
    /// Asks for the motion again and again.
    Insists,
    /// Sends intact frames as fast as the line takes them.
    Floods,
}

struct Bench {
    simulator: Simulator,
    line: File,
    arriving: Receiver<Vec<u8>>,
    speed: f64,
    begun: Instant,
    host: Host,
    session: u16,
    /// Time of the chip when a measurement began, where the simulator does not measure: a busy computer
    /// slows QEMU down, and its chip with it.
    chip_ms: Option<u32>,
}

#[test]
fn motors_have_no_current_longer_than_their_limit_after_any_fault() {
    let Ok(command) = std::env::var("COINMC_SIMULATOR") else {
        eprintln!("SKIPPED: no simulator (scripts/firmware test starts this test with one)");
        return;
    };
    let speed =
        std::env::var("COINMC_SIMULATOR_SPEED").map_or(1.0, |s| s.parse().expect("a number"));
    let mut bench = Bench::new(&command, speed);
    let home = Request::Home { axes: 15 };
    let carriage = Request::MoveCarriage { x_um: 9, y_um: 9 };
    for (what, motion, then, limit_ms) in [
        ("Home is stuck, the host polls", home, Then::Polls, 10_000),
        (
            "Home is stuck, the host insists",
            home,
            Then::Insists,
            10_000,
        ),
        (
            "Home is stuck, the line is flooded",
            home,
            Then::Floods,
            10_000,
        ),
        (
            "Home is stuck, the host is silent",
            home,
            Then::Nobody,
            5_000,
        ),
        ("MoveCarriage is stuck", carriage, Then::Polls, 5_000),
        ("Aiming is stuck", throw(1), Then::Polls, 3_000),
        (
            "Aiming is stuck, the host is silent",
            throw(2),
            Then::Nobody,
            3_000,
        ),
    ] {
        bench.ready();
        bench.simulator.stick();
        let taken = bench.current_after(&motion, then);
        bench.simulator.unstick();
        report(what, taken, limit_ms);
    }
    bench.ready();
    bench.ask(&throw(3));
    while bench.status().state != State::AtCoin {}
    assert!(bench.simulator.motors_on());
    let before = bench.simulator.longest_ms.take().unwrap_or(0);
    let begun = bench.begin();
    let taken = bench.until_off(begun, Then::Nobody).saturating_sub(before);
    report(
        "the host is silent at the coin",
        taken,
        SILENCE_LIMIT_MS.into(),
    );
    for (what, throw_id) in [("the emergency stop", 4), ("a reset", 5)] {
        bench.simulator.settle();
        bench.ready();
        bench.ask(&throw(throw_id));
        while bench.status().state != State::AtCoin {}
        assert!(bench.simulator.motors_on());
        let before = bench.simulator.longest_ms.take().unwrap_or(0);
        if throw_id == 4 {
            bench.simulator.press();
        }
        let begun = bench.begin();
        if throw_id == 5 {
            bench.chip_ms = None;
            bench.simulator.tell("system_reset");
        }
        let taken = bench.until_off(begun, Then::Polls).saturating_sub(before);
        if throw_id == 4 {
            assert_eq!(bench.status().fault, fault::EMERGENCY);
            bench.simulator.release();
        }
        report(what, taken, 50);
    }
    bench.fails("the program hangs", 6, WATCHDOG_MS);
    if bench.simulator.qemu {
        bench.fails("a fault of the program", 7, 10);
    } else {
        bench.stop_while_storing(7);
    }
}

fn throw(throw_id: u32) -> Request {
    Request::Throw {
        throw_id,
        experiment: 1,
        spin_mrev_s: 3200,
        angle_cdeg: 9000,
    }
}

fn report(what: &str, taken_ms: u64, limit_ms: u64) {
    println!("current after: {what}: {taken_ms} ms, limit {limit_ms} ms");
    assert!(taken_ms <= limit_ms + SLACK_MS, "{what}: {taken_ms} ms");
}

impl Bench {
    fn new(command: &str, speed: f64) -> Self {
        let (simulator, line, arriving) = Simulator::start(command);
        Self {
            simulator,
            line,
            arriving,
            speed,
            begun: Instant::now(),
            host: Host::new(),
            session: 0,
            chip_ms: None,
        }
    }

    /// Time of the simulation, ms, as far as it keeps its pace.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn now_ms(&self) -> u64 {
        (self.begun.elapsed().as_secs_f64() * self.speed * 1e3) as u64
    }

    fn real_ms(&self) -> u64 {
        u64::try_from(self.begun.elapsed().as_millis()).expect("not so long")
    }

    fn open(&mut self) {
        self.session += 1;
        self.host.open(self.session, self.real_ms());
    }

    /// A new session, and a robot that is idle.
    fn ready(&mut self) {
        self.open();
        loop {
            let status = self.status();
            match status.state {
                State::Idle if !self.simulator.motors_on() => {
                    self.simulator.longest_ms = None;
                    return;
                }
                State::Fault => {
                    let code = status.fault;
                    let _ = self.ask(&Request::ClearFault { code });
                }
                State::AtCoin => {
                    let throw_id = status.throw_id;
                    let _ = self.ask(&Request::Collect { throw_id });
                }
                _ => {}
            }
        }
    }

    fn status(&mut self) -> Status {
        loop {
            if let Some(Reply::Status(status)) = self.ask(&Request::Status) {
                return status;
            }
        }
    }

    /// The reply; none if the session had to be opened again.
    fn ask(&mut self, request: &Request) -> Option<Reply> {
        let ready = self.host.is_ready();
        if ready {
            self.host.request(request, self.real_ms()).unwrap();
        }
        loop {
            let now_ms = self.real_ms();
            match self.host.poll(now_ms) {
                Action::Transmit(bytes) => self.line.write_all(bytes).expect("the line is open"),
                Action::Wait { .. } => {
                    if let Ok(bytes) = self.arriving.recv_timeout(Duration::from_millis(20)) {
                        let now_ms = self.real_ms();
                        self.host.receive(&bytes, now_ms);
                    }
                }
                Action::Reply(reply) => return Some(reply),
                Action::Connected { .. } => return None,
                Action::Lost => self.open(),
                Action::Refused { version } => panic!("{version:?}"),
            }
            assert!(self.begun.elapsed() < Duration::from_secs(580), "too slow");
        }
    }

    /// How long the motors have current after a request whose motion is stuck.
    fn current_after(&mut self, motion: &Request, then: Then) -> u64 {
        let begun = self.begin();
        while self.ask(motion).is_none() {}
        match then {
            Then::Insists => {
                while self.simulator.motors_on() {
                    self.ask(motion);
                }
                self.taken(begun)
            }
            then => self.until_off(begun, then),
        }
    }

    /// The program hangs or has a fault in a throw: the motors have no current after the limit, and the
    /// robot starts again in a fault of that phase.
    fn fails(&mut self, what: &str, throw_id: u32, limit_ms: u64) {
        let hangs = limit_ms == WATCHDOG_MS;
        self.simulator.settle();
        self.simulator
            .use_button(if hangs { "down" } else { "left" });
        self.ready();
        self.ask(&throw(throw_id));
        while self.status().state != State::AtCoin {}
        assert!(self.simulator.motors_on());
        let before = self.simulator.longest_ms.take().unwrap_or(0);
        let begun = self.now_ms();
        if hangs {
            self.simulator.hang();
        } else {
            self.simulator.tell("sendkey left 300");
        }
        let taken = self.until_off(begun, Then::Nobody).saturating_sub(before);
        report(what, taken, limit_ms);
        if hangs {
            self.simulator.recover();
        } else {
            // the watchdog was put off, so that it cannot have been that
            self.simulator.tell("system_reset");
        }
        self.open();
        let code = fault::RESET + u16::from(State::AtCoin.number());
        assert_eq!(self.status().fault, code, "{what}");
    }

    /// The emergency stop is pressed while a record is written, for 60 ms in which the firmware waits.
    fn stop_while_storing(&mut self, throw_id: u32) {
        self.ready();
        self.simulator.tell("press-storing");
        self.ask(&throw(throw_id));
        while self.status().fault != fault::EMERGENCY {}
        assert!(!self.simulator.motors_on());
        let taken_ms = self.simulator.stop_ms;
        println!("current after: the emergency stop, while a record is written: {taken_ms:.1} ms");
        assert!((0.001..LOOK_MS).contains(&taken_ms), "{taken_ms} ms");
        self.simulator.release();
    }

    /// Begins a measurement.
    fn begin(&mut self) -> u64 {
        self.chip_ms = self.simulator.qemu.then(|| self.status().t_ms);
        self.now_ms()
    }

    /// As the simulator has measured it, by the chip's clock, or by ours.
    fn taken(&mut self, begun: u64) -> u64 {
        let chip_ms = self.chip_ms.take();
        let chip = chip_ms.map(|since| u64::from(self.status().t_ms.wrapping_sub(since)));
        let measured = self.simulator.longest_ms.take().or(chip);
        measured.unwrap_or_else(|| self.now_ms() - begun)
    }

    fn until_off(&mut self, begun: u64, then: Then) -> u64 {
        let hello = Request::Hello {
            version: Version { ..PROTOCOL },
            session: self.session.max(1),
        };
        let header = coinmc_link::Header {
            session: self.session.max(1),
            seq: 9,
        };
        let frame = hello.to_wire(header).expect("it fits");
        while self.simulator.motors_on() {
            match then {
                Then::Nobody | Then::Insists => std::thread::sleep(Duration::from_millis(5)),
                Then::Polls => {
                    let _ = self.ask(&Request::Status);
                }
                Then::Floods => {
                    // as much as arrives in 20 ms, and nobody waits for the answers
                    for _ in 0..14 {
                        self.line
                            .write_all(frame.as_bytes())
                            .expect("the line is open");
                    }
                    std::thread::sleep(Duration::from_secs_f64(0.02 / self.speed));
                    while self.arriving.try_recv().is_ok() {}
                }
            }
        }
        self.taken(begun)
    }
}
