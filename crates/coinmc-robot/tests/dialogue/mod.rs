//! A cycle that is talked to by hand, message by message.
#![allow(dead_code, missing_docs, unreachable_pub)] // each test uses its part

use crate::world::{OURS, PROGRAM, setting};
use coinmc_link::{Greeting, Info, Limits, PROTOCOL, Reply, Request, State, Status};
use coinmc_robot::Face;
use coinmc_robot::cycle::{Cycle, Photo, Rules, Shown, Step};
use coinmc_robot::journal::{Digest, Entry, History, ImageName, VoidReason};

pub const THROW: u32 = 1;

/// A cycle and a journal, talked to by hand.
pub struct Dialogue {
    pub cycle: Cycle,
    pub history: History,
}

impl Dialogue {
    /// Before the first throw: the robot has said who it is, and the journal has its name.
    pub fn named(rules: Rules) -> Self {
        let mut dialogue = Self {
            cycle: Cycle::new(rules, PROGRAM),
            history: History::default(),
        };
        dialogue.cycle.connected(&greeting(4));
        dialogue.tell(Reply::Info(info()));
        dialogue.status(State::Idle, |status| status.throw_id = 0);
        let named = dialogue.step();
        assert!(matches!(&named, Step::Write(Entry::Session { .. })));
        dialogue.write(named);
        dialogue
    }

    /// After the announcement of the first throw, whose setting is (100, 1001).
    pub fn announced(rules: Rules) -> Self {
        let mut dialogue = Self::named(rules);
        assert_eq!(
            dialogue.step(),
            Step::Announce {
                throw: 0,
                id: THROW
            }
        );
        dialogue.announce(THROW);
        dialogue
    }

    pub fn announce(&mut self, id: u32) {
        let setting = setting(1);
        let entry = Entry::Announced {
            id,
            setting,
            at_ms: 0,
        };
        self.write(Step::Write(entry));
    }

    /// The first throw is read, and the robot is at the coin.
    pub fn read(rules: Rules) -> Self {
        let mut dialogue = Self::announced(rules);
        dialogue.status(State::AtCoin, |_| {});
        dialogue.photo(1, side());
        let read = dialogue.step();
        dialogue.write(read);
        dialogue
    }

    pub fn tell(&mut self, reply: Reply) {
        self.cycle.replied(&Request::Status, &reply);
    }

    /// A status of the first throw as it was asked for, but for this change.
    pub fn status(&mut self, state: State, change: impl Fn(&mut Status)) {
        let mut status = Status {
            state,
            throw_id: THROW,
            experiment: OURS,
            spin_mrev_s: 100,
            angle_cdeg: 1001,
            released: true,
            meas_spin_mrev_s: 103,
            meas_angle_cdeg: 1005,
            ..Status::default()
        };
        change(&mut status);
        self.tell(Reply::Status(status));
    }

    pub fn step(&mut self) -> Step {
        self.cycle.step(&self.history, 7)
    }

    pub fn write(&mut self, step: Step) {
        let Step::Write(entry) = step else {
            panic!("{step:?}")
        };
        self.history.add(&entry).unwrap();
        self.cycle.written(&entry);
    }

    pub fn photo(&mut self, attempt: u32, shown: Shown) {
        let id = self.history.last_id();
        assert_eq!(self.step(), Step::Photograph { id, attempt });
        self.cycle.photographing(id, attempt);
        self.cycle.photographed(Photo { id, attempt, shown });
    }
}

pub fn greeting(boot: u16) -> Greeting {
    Greeting {
        version: PROTOCOL,
        boot,
        throw_id: THROW,
        state: State::Idle,
    }
}

pub fn info() -> Info {
    Info {
        limits: Limits {
            spin_mrev_s: 5000,
            angle_cdeg: 18_000,
            ..Limits::default()
        },
        ..Info::default()
    }
}

pub fn side() -> Shown {
    Shown::Face {
        face: Face::Side,
        image: name(),
        digest: Digest(5),
    }
}

pub fn name() -> ImageName {
    "000001-1.png".parse().unwrap()
}

pub fn void(id: u32, reason: VoidReason) -> Step {
    Step::Write(Entry::Void { id, reason })
}
