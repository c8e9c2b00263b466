//! Host and device over a connection that loses and damages bytes, with resets, unplugged cables
//! and killed hosts: every throw is made at most once, and every throw ends as done or void.

mod support;

use coinmc_link::{Action, Device, Host, Reply, Request, Seen};
use std::collections::VecDeque;
use support::campaign::{Campaign, End, Noise};
use support::{Bench, Random};

const THROWS: usize = 25;
/// Far longer than any experiment here takes.
const LIMIT_MS: u32 = 3_600_000;

#[test]
fn every_throw_is_resolved_once() {
    let mut voids = 0;
    for seed in 0..200 {
        let mut world = World::new(seed, true);
        world.run();
        let releases = &world.device.as_ref().unwrap().hardware().releases;
        assert!(
            releases.is_sorted_by(|a, b| a < b),
            "seed {seed}: {releases:?}"
        );
        for (id, end) in (1..).zip(&world.campaign.resolved) {
            assert!(
                *end == End::Void || releases.contains(&id),
                "seed {seed}: {id}"
            );
        }
        voids += world.campaign.count(End::Void);
    }
    // resets cost some throws, but not many
    assert!((100..2_000).contains(&voids), "{voids} voids");
}

#[test]
fn noise_alone_costs_no_throw() {
    for seed in 0..100 {
        let mut world = World::new(seed, false);
        world.run();
        assert_eq!(world.campaign.count(End::Done), THROWS, "seed {seed}");
        assert!(world.noise.damaged > 0);
    }
}

struct World {
    now_ms: u32,
    device: Option<Device<Bench>>,
    host: Host,
    /// Time of the host's next poll.
    rest_ms: u32,
    campaign: Campaign,
    to_device: VecDeque<u8>,
    to_host: VecDeque<u8>,
    noise: Noise,
    /// The cable is unplugged until this time.
    unplugged_until_ms: u32,
    calamities: bool,
}

impl World {
    fn new(seed: u64, calamities: bool) -> Self {
        let mut host = Host::new();
        host.open(1, 0);
        Self {
            now_ms: 0,
            device: Some(Device::boot(Bench::default(), 0)),
            host,
            rest_ms: 0,
            campaign: Campaign::default(),
            to_device: VecDeque::new(),
            to_host: VecDeque::new(),
            noise: Noise {
                random: Random(seed),
                per_mille: 10,
                damaged: 0,
            },
            unplugged_until_ms: 0,
            calamities,
        }
    }

    fn run(&mut self) {
        while self.campaign.resolved.len() < THROWS {
            self.now_ms += 1;
            assert!(self.now_ms < LIMIT_MS, "{:?}", self.campaign);
            if self.calamities && self.noise.random.below(5_000) == 0 {
                self.suffer();
            }
            self.run_device();
            self.run_host();
        }
    }

    fn suffer(&mut self) {
        match self.noise.random.below(3) {
            0 => {
                let bench = self.device.take().unwrap().into_hardware();
                self.device = Some(Device::boot(bench, self.now_ms));
            }
            1 => self.unplugged_until_ms = self.now_ms + self.noise.random.below(7_000),
            _ => {
                self.host = Host::new();
                self.open();
            }
        }
    }

    fn open(&mut self) {
        let session = u16::try_from(self.noise.random.below(65_536)).unwrap();
        self.host.open(session, u64::from(self.now_ms));
    }

    fn run_device(&mut self) {
        let now_ms = self.now_ms;
        let device = self.device.as_mut().unwrap();
        device.hardware_mut().now_ms = now_ms;
        device.tick(now_ms);
        // 115,200 baud
        for byte in self.to_device.drain(..self.to_device.len().min(11)) {
            if let Some(reply) = device.receive(byte, now_ms)
                && now_ms >= self.unplugged_until_ms
            {
                self.to_host.extend(self.noise.pass(reply));
            }
        }
    }

    fn run_host(&mut self) {
        let now = u64::from(self.now_ms);
        self.host.receive(self.to_host.make_contiguous(), now);
        self.to_host.clear();
        loop {
            let next = match self.host.poll(now) {
                Action::Wait { .. } => break,
                Action::Transmit(bytes) => {
                    if self.now_ms >= self.unplugged_until_ms {
                        self.to_device.extend(self.noise.pass(bytes));
                    }
                    None
                }
                Action::Connected { seen, .. } => {
                    assert_ne!(seen, Seen::Taken);
                    Some(Request::Status)
                }
                Action::Reply(Reply::Status(status)) => self.campaign.next(&status),
                Action::Reply(_) => None,
                Action::Lost => {
                    self.open();
                    None
                }
                Action::Refused { version } => panic!("{version:?}"),
            };
            if let Some(request) = next {
                self.host.request(&request, now).unwrap();
            }
        }
        if self.host.is_ready() && self.now_ms >= self.rest_ms {
            self.rest_ms = self.now_ms + 50;
            self.host.request(&Request::Status, now).unwrap();
        }
    }
}
