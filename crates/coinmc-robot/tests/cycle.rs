//! The step that each state asks for, message by message: what belongs together, what is stale, and what
//! is counted anew.

mod world;

use coinmc_link::{Greeting, Info, Limits, PROTOCOL, Reply, Request, State, Status};
use coinmc_robot::Face;
use coinmc_robot::cycle::{Cycle, Halt, Photo, Rules, Shown, Step};
use coinmc_robot::journal::{Digest, Entry, History, ImageName, Measured, Reading, VoidReason};
use world::{OURS, PROGRAM, rules, setting};

const THROW: u32 = 1;

/// A cycle and a journal, talked to by hand.
struct Table {
    cycle: Cycle,
    history: History,
}

impl Table {
    /// After the announcement of the first throw, whose setting is (100, 1001).
    fn announced(rules: Rules) -> Self {
        let mut table = Self {
            cycle: Cycle::new(rules, PROGRAM),
            history: History::default(),
        };
        table.cycle.connected(&greeting(4));
        table.tell(Reply::Info(info()));
        table.status(State::Idle, |status| status.throw_id = 0);
        let named = table.step();
        assert!(matches!(&named, Step::Write(Entry::Session { .. })));
        table.write(named);
        assert_eq!(
            table.step(),
            Step::Announce {
                throw: 0,
                id: THROW
            }
        );
        table.announce(THROW);
        table
    }

    fn announce(&mut self, id: u32) {
        let setting = setting(1);
        let entry = Entry::Announced {
            id,
            setting,
            at_ms: 0,
        };
        self.write(Step::Write(entry));
    }

    fn tell(&mut self, reply: Reply) {
        self.cycle.replied(&Request::Status, &reply);
    }

    /// A status of the first throw as it was asked for, but for this change.
    fn status(&mut self, state: State, change: impl Fn(&mut Status)) {
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

    fn step(&mut self) -> Step {
        self.cycle.step(&self.history, 7)
    }

    fn write(&mut self, step: Step) {
        let Step::Write(entry) = step else {
            panic!("{step:?}")
        };
        self.history.add(&entry).unwrap();
        self.cycle.written(&entry);
    }

    fn photo(&mut self, attempt: u32, shown: Shown) {
        let id = self.history.last_id();
        assert_eq!(self.step(), Step::Photograph { id, attempt });
        self.cycle.photographing(id, attempt);
        self.cycle.photographed(Photo { id, attempt, shown });
    }
}

fn greeting(boot: u16) -> Greeting {
    Greeting {
        version: PROTOCOL,
        boot,
        throw_id: THROW,
        state: State::Idle,
    }
}

fn info() -> Info {
    Info {
        limits: Limits {
            spin_mrev_s: 5000,
            angle_cdeg: 18_000,
            ..Limits::default()
        },
        ..Info::default()
    }
}

fn side() -> Shown {
    Shown::Face {
        face: Face::Side,
        image: name(),
        digest: Digest(5),
    }
}

fn name() -> ImageName {
    "000001-1.png".parse().unwrap()
}

fn void(id: u32, reason: VoidReason) -> Step {
    Step::Write(Entry::Void { id, reason })
}

#[test]
fn a_reading_has_the_measured_values_at_release_and_the_boot() {
    let mut table = Table::announced(rules(false));
    // before the release the present values are no measurement
    table.status(State::Aiming, |status| {
        (status.released, status.meas_spin_mrev_s) = (false, 9);
    });
    assert_eq!(table.step(), Step::Wait);
    table.status(State::AtCoin, |_| {});
    table.photo(1, side());
    let Step::Write(Entry::Read { id, reading, at_ms }) = table.step() else {
        panic!("{:?}", table.step())
    };
    let expected = Reading {
        face: Face::Side,
        measured: Measured {
            spin_mrev_s: 103,
            angle_cdeg: 1005,
        },
        boot: 4,
        image: name(),
        digest: Some(Digest(5)),
    };
    assert_eq!((id, reading, at_ms), (THROW, expected, 7));
}

/// A face alone is no reading: without its own release nobody knows how the coin was thrown.
#[test]
fn a_face_is_not_joined_with_what_is_not_its_release() {
    let at_coin = |change: fn(&mut Status)| {
        let mut table = Table::announced(rules(false));
        table.status(State::AtCoin, change);
        table.photo(1, side());
        table.step()
    };
    assert!(matches!(at_coin(|_| {}), Step::Write(Entry::Read { .. })));
    // one that has not happened, as far as the robot knows
    let unreleased = at_coin(|status| status.released = false);
    assert!(matches!(unreleased, Step::Photograph { .. } | Step::Wait));

    // one of another experiment
    let mut table = Table::announced(rules(false));
    table.status(State::AtCoin, |status| status.experiment = OURS + 1);
    table.status(State::AtCoin, |status| status.released = false);
    table.photo(1, side());
    let step = table.step();
    assert!(
        matches!(step, Step::Photograph { .. } | Step::Wait),
        "{step:?}"
    );

    // one that was before
    let mut table = Table::announced(rules(false));
    table.status(State::AtCoin, |_| {});
    table.photo(1, side());
    let read = table.step();
    table.write(read);
    table.status(State::Idle, |_| {});
    let done = table.step();
    table.write(done);
    table.announce(2);
    table.status(State::AtCoin, |status| {
        (status.throw_id, status.released) = (2, false);
    });
    table.photo(1, side());
    let step = table.step();
    assert!(
        matches!(step, Step::Photograph { .. } | Step::Wait),
        "{step:?}"
    );
}

#[test]
fn a_release_that_was_not_asked_for_is_void() {
    let mut table = Table::announced(rules(false));
    table.status(State::Driving, |status| status.spin_mrev_s = 101);
    assert_eq!(table.step(), void(THROW, VoidReason::Mismatch));
    // noted as released, and the robot was reset since: it has forgotten what was asked
    let mut table = Table::announced(rules(false));
    table.status(State::AtCoin, |_| {});
    table.photo(1, side());
    table.status(State::AtCoin, |status| status.angle_cdeg = 1002);
    table.status(State::Idle, |_| {});
    assert_eq!(table.step(), void(THROW, VoidReason::Mismatch));
}

#[test]
fn a_release_is_on_target_to_the_tolerance_of_each_number() {
    let rules = rules(false);
    let (spin, angle) = (rules.spin_tolerance_mrev_s, rules.angle_tolerance_cdeg);
    let read = |measured: (u16, u16)| {
        let mut table = Table::announced(rules.clone());
        table.status(State::AtCoin, |status| {
            (status.meas_spin_mrev_s, status.meas_angle_cdeg) = measured;
        });
        table.photo(1, side());
        table.step()
    };
    for on_target in [(100 + spin, 1001 + angle), (100 - spin, 1001 - angle)] {
        assert!(matches!(read(on_target), Step::Write(Entry::Read { .. })));
    }
    for (more_spin, more_angle) in [(1, 0), (0, 1)] {
        let high = (100 + spin + more_spin, 1001 + angle + more_angle);
        let low = (100 - spin - more_spin, 1001 - angle - more_angle);
        for measured in [high, low] {
            assert_eq!(read(measured), void(THROW, VoidReason::OffTarget));
        }
    }
}

#[test]
fn a_photo_that_comes_late_is_not_taken() {
    for (id, attempt) in [(THROW, 1), (THROW + 1, 2), (THROW - 1, 2)] {
        let mut table = Table::announced(rules(false));
        table.status(State::AtCoin, |_| {});
        table.photo(1, Shown::Nothing);
        table.cycle.photographing(THROW, 2);
        let shown = side();
        table.cycle.photographed(Photo { id, attempt, shown });
        assert_eq!(table.step(), Step::Wait, "{id} {attempt}");
    }
}

#[test]
fn photos_without_a_face_add_up_to_a_void_throw() {
    let mut table = Table::announced(rules(false));
    table.status(State::AtCoin, |_| {});
    table.photo(1, Shown::Nothing);
    // a camera that fails has not looked
    table.photo(2, Shown::Failure("no light".to_owned()));
    table.photo(3, Shown::Nothing);
    assert_eq!(table.step(), void(THROW, VoidReason::Unread));
}

#[test]
fn only_failures_of_the_camera_in_a_row_halt() {
    let failure = || Shown::Failure("no light".to_owned());
    let mut patient = rules(false);
    patient.max_photos = 9;
    let mut table = Table::announced(patient);
    table.status(State::AtCoin, |_| {});
    let shown = [failure(), failure(), Shown::Nothing, failure(), failure()];
    for (attempt, shown) in (1..).zip(shown) {
        table.photo(attempt, shown);
    }
    table.photo(6, failure());
    let Step::Halt(Halt::CameraFails { id, count, last }) = table.step() else {
        panic!("{:?}", table.step())
    };
    assert_eq!((id, count, last.as_str()), (THROW, 3, "no light"));
}

/// Throws with these endings, `true` for a reading; the halt, if there is one.
fn after(endings: &[bool], max_voids: u32) -> Option<Halt> {
    let mut strict = rules(false);
    strict.max_voids = max_voids;
    let mut table = Table::announced(strict);
    for (id, read) in (THROW..).zip(endings) {
        if id > THROW {
            table.announce(id);
        }
        let of = |status: &mut Status| status.throw_id = id;
        if *read {
            table.status(State::AtCoin, of);
            table.photo(1, side());
            let read = table.step();
            table.write(read);
        }
        table.status(State::Idle, of);
        let resolved = table.step();
        table.write(resolved);
    }
    match table.step() {
        Step::Halt(halt) => Some(halt),
        _ => None,
    }
}

#[test]
fn only_void_throws_in_a_row_halt() {
    assert_eq!(after(&[false, true, false], 2), None);
    let last = VoidReason::Lost;
    let halt = Halt::TooManyVoids { count: 2, last };
    assert_eq!(after(&[true, false, false], 2), Some(halt));
    assert_eq!(after(&[false, false], 3), None);
}

#[test]
fn attempts_to_clear_a_fault_are_counted_anew_once_the_robot_is_idle() {
    let mut table = Table::announced(rules(false));
    for _ in 0..3 {
        for _ in 0..15 {
            table.status(State::Fault, |status| {
                (status.throw_id, status.fault) = (0, 103);
            });
            let clear = Request::ClearFault { code: 103 };
            assert_eq!(table.step(), Step::Request(clear));
        }
        table.status(State::Idle, |status| status.throw_id = 0);
        assert!(matches!(table.step(), Step::Request(Request::Throw { .. })));
    }
}

/// A reset between two messages: what was said before it is not believed.
#[test]
fn after_a_connection_the_robot_is_asked_who_it_is_and_how() {
    let mut table = Table::announced(rules(false));
    table.status(State::AtCoin, |_| {});
    table.cycle.connected(&greeting(5));
    assert_eq!(table.step(), Step::Request(Request::Info));
    table.tell(Reply::Info(info()));
    assert_eq!(table.step(), Step::Request(Request::Status));
    table.status(State::AtCoin, |_| {});
    table.cycle.waited();
    assert_eq!(table.step(), Step::Request(Request::Status));
}

/// Photos of a throw that is void are none of the next one, whether they came or not.
#[test]
fn photos_are_counted_anew_for_each_throw() {
    for came in [true, false] {
        let mut table = Table::announced(rules(false));
        table.status(State::AtCoin, |_| {});
        table.cycle.photographing(THROW, 1);
        if came {
            let (attempt, shown) = (1, Shown::Nothing);
            let photo = Photo {
                id: THROW,
                attempt,
                shown,
            };
            table.cycle.photographed(photo);
        }
        table.status(State::Fault, |status| status.fault = 103);
        assert_eq!(table.step(), void(THROW, VoidReason::Fault(103)));
        let step = table.step();
        table.write(step);
        table.announce(THROW + 1);
        table.status(State::AtCoin, |status| status.throw_id = THROW + 1);
        // not as many without a face as the rules allow: those of the first throw do not count
        table.photo(1, Shown::Nothing);
        table.photo(2, Shown::Failure("no light".to_owned()));
        assert!(matches!(table.step(), Step::Photograph { attempt: 3, .. }));
    }
}

#[test]
fn a_robot_reaches_all_that_is_planned_or_none_is_thrown() {
    let reach = rules(false).reach;
    let (spin, angle) = (reach.spin_mrev_s(), reach.angle_cdeg());
    for (spin_mrev_s, angle_cdeg, fits) in [
        (spin, angle, true),
        (spin - 1, angle, false),
        (spin, angle - 1, false),
    ] {
        let mut cycle = Cycle::new(rules(false), PROGRAM);
        cycle.connected(&greeting(4));
        let mut robot = info();
        robot.limits.spin_mrev_s = spin_mrev_s;
        robot.limits.angle_cdeg = angle_cdeg;
        cycle.replied(&Request::Info, &Reply::Info(robot));
        let step = cycle.step(&History::default(), 7);
        let halts = matches!(step, Step::Halt(Halt::OutOfReach { .. }));
        assert_eq!(halts, !fits, "{spin_mrev_s} {angle_cdeg}: {step:?}");
    }
}
