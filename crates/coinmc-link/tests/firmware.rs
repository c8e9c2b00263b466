//! The firmware in a simulated microcontroller: an experiment over its pseudo-terminal, with
//! damaged bytes, resets and killed hosts. `scripts/firmware test` builds the firmware and runs
//! this test with:
//!
//! * `COINMC_SIMULATOR`: the command that starts the simulator. It prints the terminal's name
//!   (`/dev/pts/…`) and resets the board on the line `system_reset` on its standard input.
//! * `COINMC_THROWS`, `COINMC_RESETS`, `COINMC_KILLS`: how many of each.
#![cfg(target_os = "linux")]

mod support;

use coinmc_link::{Action, Host, Reply, Request};
use std::fs::File;
use std::io::Write;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};
use support::Random;
use support::campaign::{Campaign, End, Noise};
use support::simulator::Simulator;

#[test]
fn an_experiment_on_a_simulated_microcontroller() {
    let Ok(command) = std::env::var("COINMC_SIMULATOR") else {
        eprintln!("SKIPPED: no simulator (scripts/firmware test starts this test with one)");
        return;
    };
    let number = |name: &str, default| {
        std::env::var(name).map_or(default, |text| text.parse().expect("a number"))
    };
    let throws = number("COINMC_THROWS", 50);
    let (resets, kills) = (number("COINMC_RESETS", 4), number("COINMC_KILLS", 4));
    let mut bench = Bench::new(&command);
    bench.run(throws, resets, kills);
    let (done, void) = (
        bench.campaign.count(End::Done),
        bench.campaign.count(End::Void),
    );
    assert_eq!(done + void, throws);
    // a reset costs at most one throw, and nothing else costs any
    assert!(void <= resets, "{void} voids after {resets} resets");
    bench.round_trips.sort();
    let percentile = |percent: usize| bench.round_trips[bench.round_trips.len() * percent / 100];
    println!(
        "{throws} throws in {:.1} s: {done} done, {void} void; {resets} resets, {kills} hosts \
         killed, {} bytes damaged; round trip {:.1} ms (median), {:.1} ms (95 %)",
        bench.begun.elapsed().as_secs_f64(),
        bench.noise.damaged,
        percentile(50).as_secs_f64() * 1e3,
        percentile(95).as_secs_f64() * 1e3,
    );
}

struct Bench {
    simulator: Simulator,
    line: File,
    arriving: Receiver<Vec<u8>>,
    noise: Noise,
    campaign: Campaign,
    begun: Instant,
    round_trips: Vec<Duration>,
}

impl Bench {
    fn new(command: &str) -> Self {
        let (simulator, line, arriving) = Simulator::start(command);
        Self {
            simulator,
            line,
            arriving,
            noise: Noise {
                random: Random(1),
                per_mille: 10,
                damaged: 0,
            },
            campaign: Campaign::default(),
            begun: Instant::now(),
            round_trips: Vec::new(),
        }
    }

    fn now_ms(&self) -> u64 {
        u64::try_from(self.begun.elapsed().as_millis()).expect("not so long")
    }

    /// Runs the throws, with resets and kills spread over them.
    fn run(&mut self, throws: usize, resets: usize, kills: usize) {
        let mut host = self.open(Host::new());
        let (mut reset, mut killed) = (0, 0);
        while self.campaign.resolved.len() < throws {
            let resolved = self.campaign.resolved.len();
            if reset < resets && resolved * (resets + 1) >= throws * (reset + 1) {
                reset += 1;
                self.wait_within_a_throw(&mut host);
                self.simulator.tell("system_reset");
            }
            if killed < kills && (2 * resolved + 1) * (kills + 1) >= 2 * throws * (killed + 1) {
                killed += 1;
                self.wait_within_a_throw(&mut host);
                host = self.open(Host::new());
            }
            self.step(&mut host);
        }
    }

    fn wait_within_a_throw(&mut self, host: &mut Host) {
        let until = Instant::now() + Duration::from_millis(u64::from(self.noise.random.below(300)));
        while Instant::now() < until {
            self.step(host);
        }
    }

    fn open(&mut self, mut host: Host) -> Host {
        let session = u16::try_from(self.noise.random.below(65_536)).unwrap();
        host.open(session, self.now_ms());
        host
    }

    /// One request and its reply, or the start of a session.
    fn step(&mut self, host: &mut Host) {
        if host.is_ready() {
            host.request(&Request::Status, self.now_ms()).unwrap();
        }
        let asked = Instant::now();
        loop {
            let now_ms = self.now_ms();
            match host.poll(now_ms) {
                Action::Transmit(bytes) => {
                    let bytes = self.noise.pass(bytes);
                    self.line.write_all(&bytes).expect("the line is open");
                }
                Action::Wait { until_ms } => {
                    let wait_ms = until_ms.map_or(10, |until| until.saturating_sub(now_ms).max(1));
                    match self.arriving.recv_timeout(Duration::from_millis(wait_ms)) {
                        Ok(bytes) => host.receive(&self.noise.pass(&bytes), self.now_ms()),
                        Err(RecvTimeoutError::Timeout) => {}
                        Err(error) => panic!("the simulator has ended: {error}"),
                    }
                }
                Action::Reply(Reply::Status(status)) => {
                    self.round_trips.push(asked.elapsed());
                    if let Some(request) = self.campaign.next(&status) {
                        host.request(&request, now_ms).unwrap();
                    }
                    return;
                }
                Action::Reply(_) | Action::Connected { .. } => return,
                Action::Lost => *host = self.open(std::mem::take(host)),
                Action::Refused { version } => panic!("{version:?}"),
            }
            assert!(self.begun.elapsed() < Duration::from_secs(580), "too slow");
        }
    }
}
