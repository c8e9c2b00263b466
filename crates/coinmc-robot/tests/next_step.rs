//! The step that each state asks for: the table at the head of `cycle`, row by row, and what the robot
//! rejects.

mod dialogue;
mod world;

use coinmc_link::{Info, Nak, Reply, Request, State, Status, fault};
use coinmc_robot::Setting;
use coinmc_robot::cycle::{Cycle, Halt, Photo, Shown, Step, Stranger};
use coinmc_robot::journal::{Entry, History, RobotName, VoidReason};
use dialogue::{Dialogue, THROW, greeting, info, side, void};
use world::{OURS, PROGRAM, THROWS, rules, setting};

const MOVING: [State; 4] = [
    State::Aiming,
    State::Flying,
    State::Driving,
    State::Returning,
];

/// The rules of an experiment whose user lets it take a robot over.
const ADOPT: bool = true;

fn before_the_first(status: &mut Status) {
    (status.throw_id, status.released) = (0, false);
}

fn collect(throw_id: u32) -> Step {
    Step::Request(Request::Collect { throw_id })
}

fn throw() -> Request {
    Request::Throw {
        throw_id: THROW,
        experiment: OURS,
        spin_mrev_s: setting(1).spin_mrev_s(),
        angle_cdeg: setting(1).angle_cdeg(),
    }
}

#[test]
fn a_robot_that_was_told_nothing_is_told_the_experiment() {
    let mut dialogue = Dialogue::named(rules(false));
    dialogue.status(State::Idle, |status| {
        (status.throw_id, status.experiment) = (0, OURS + 1);
    });
    let told = Request::SetCounter {
        throw_id: 0,
        experiment: OURS,
    };
    assert_eq!(dialogue.step(), Step::Request(told));
}

#[test]
fn with_nothing_open_the_robot_is_brought_to_idle() {
    let mut dialogue = Dialogue::named(rules(false));
    dialogue.status(State::AtCoin, before_the_first);
    assert_eq!(dialogue.step(), collect(0));
    for state in MOVING {
        dialogue.status(state, before_the_first);
        assert_eq!(dialogue.step(), Step::Wait, "{state:?}");
    }
    dialogue.status(State::Fault, |status| {
        (status.throw_id, status.fault) = (0, 103);
    });
    let clear = Request::ClearFault { code: 103 };
    assert_eq!(dialogue.step(), Step::Request(clear));
    dialogue.status(State::Fault, |status| {
        (status.throw_id, status.fault) = (0, fault::EMERGENCY);
    });
    assert_eq!(dialogue.step(), Step::Halt(Halt::EmergencyStop));
}

#[test]
fn a_fault_that_stays_is_cleared_twenty_times() {
    let mut dialogue = Dialogue::named(rules(false));
    for _ in 0..20 {
        dialogue.status(State::Fault, |status| {
            (status.throw_id, status.fault) = (0, 103);
        });
        let clear = Request::ClearFault { code: 103 };
        assert_eq!(dialogue.step(), Step::Request(clear));
    }
    assert_eq!(dialogue.step(), Step::Halt(Halt::FaultStays { code: 103 }));
}

#[test]
fn an_announced_throw_is_thrown_as_announced() {
    let mut dialogue = Dialogue::announced(rules(false));
    dialogue.status(State::Idle, before_the_first);
    assert_eq!(dialogue.step(), Step::Request(throw()));
    // first the coin of an earlier throw is brought back
    dialogue.status(State::AtCoin, before_the_first);
    assert_eq!(dialogue.step(), collect(0));
}

#[test]
fn a_throw_is_waited_for_while_the_robot_moves() {
    for state in MOVING.into_iter().chain([State::Boot]) {
        let mut dialogue = Dialogue::announced(rules(false));
        dialogue.status(state, |status| status.released = false);
        assert_eq!(dialogue.step(), Step::Wait, "{state:?}");
    }
}

#[test]
fn a_throw_without_a_reading_is_void_once_the_robot_is_idle() {
    let mut dialogue = Dialogue::announced(rules(false));
    dialogue.status(State::Idle, |_| {});
    assert_eq!(dialogue.step(), void(THROW, VoidReason::Lost));
}

#[test]
fn a_coin_that_is_read_is_collected_and_then_the_throw_is_done() {
    let done = Step::Write(Entry::Done { id: THROW });
    let mut dialogue = Dialogue::read(rules(false));
    dialogue.status(State::AtCoin, |_| {});
    assert_eq!(dialogue.step(), collect(THROW));
    // a robot that starts does not say yet whether it carries the coin
    for state in [State::Returning, State::Boot] {
        dialogue.status(state, |_| {});
        assert_eq!(dialogue.step(), Step::Wait, "{state:?}");
    }
    for state in [State::Idle, State::Fault] {
        dialogue.status(state, |_| {});
        assert_eq!(dialogue.step(), done, "{state:?}");
    }
    // and one that has gone on, or is another one, has no such coin
    dialogue.status(State::AtCoin, |status| status.throw_id = THROW + 1);
    assert_eq!(dialogue.step(), done);
    dialogue.status(State::AtCoin, |status| status.experiment = OURS + 1);
    assert_eq!(dialogue.step(), done);
}

#[test]
fn a_counter_that_is_ahead_is_adopted_on_demand() {
    let ahead = |status: &mut Status| status.throw_id = 9;
    let halt = |journal| Step::Halt(Halt::Ahead { robot: 9, journal });
    for open in [false, true] {
        let start = if open {
            Dialogue::announced
        } else {
            Dialogue::named
        };
        let mut dialogue = start(rules(false));
        dialogue.status(State::Idle, ahead);
        assert_eq!(dialogue.step(), halt(u32::from(open)));
        let mut dialogue = start(rules(ADOPT));
        dialogue.status(State::Idle, ahead);
        if open {
            let superseded = dialogue.step();
            assert_eq!(superseded, void(THROW, VoidReason::Superseded));
            dialogue.write(superseded);
        }
        let adopted = Entry::Adopted { counter: 9 };
        assert_eq!(dialogue.step(), Step::Write(adopted));
    }
}

/// A journal of format 1 does not name its robot, so nobody knows whose throw was announced.
#[test]
fn a_throw_that_was_announced_to_nobody_is_void() {
    let mut dialogue = Dialogue {
        cycle: Cycle::new(rules(false), PROGRAM),
        history: History::default(),
    };
    dialogue.announce(THROW);
    dialogue.cycle.connected(&greeting(4));
    dialogue.tell(Reply::Info(info()));
    dialogue.status(State::Idle, before_the_first);
    let named = dialogue.step();
    dialogue.write(named);
    assert_eq!(dialogue.step(), void(THROW, VoidReason::Foreign));
}

#[test]
fn the_journal_names_robot_and_program_and_again_where_either_is_new() {
    let mut dialogue = Dialogue::named(rules(false));
    let newer = Info {
        firmware: [9, 8, 7],
        ..info()
    };
    dialogue.tell(Reply::Info(newer));
    dialogue.status(State::Idle, before_the_first);
    let session = Entry::Session {
        robot: RobotName::of(&newer),
        boot: 4,
        program: PROGRAM.to_owned(),
        at_ms: 7,
    };
    assert_eq!(dialogue.step(), Step::Write(session.clone()));
    dialogue.write(Step::Write(session.clone()));
    // another program continues the journal
    dialogue.cycle = Cycle::new(rules(false), PROGRAM);
    dialogue.cycle.connected(&greeting(4));
    dialogue.tell(Reply::Info(newer));
    dialogue.status(State::Idle, before_the_first);
    assert_eq!(dialogue.step(), Step::Write(session));
}

#[test]
fn a_strange_robot_is_asked_about_and_adopted_on_demand() {
    let stranger = |adopt| {
        let mut dialogue = Dialogue::announced(rules(adopt));
        dialogue.tell(Reply::Info(Info {
            uid: [0, 0, 0, 0, 0, 0, 0, 5],
            ..info()
        }));
        dialogue.status(State::Idle, |_| {});
        dialogue
    };
    let how = Stranger::OtherRobot {
        found: 5,
        expected: 0,
    };
    assert_eq!(stranger(false).step(), Step::Halt(Halt::Foreign { how }));
    let mut dialogue = stranger(ADOPT);
    let foreign = dialogue.step();
    assert_eq!(foreign, void(THROW, VoidReason::Foreign));
    dialogue.write(foreign);
    let adopted = Entry::Adopted { counter: THROW };
    assert_eq!(dialogue.step(), Step::Write(adopted));
}

/// Its memory was changed: it would count the throws that it has made again.
#[test]
fn a_robot_that_has_made_fewer_throws_than_the_journal_is_a_stranger() {
    let at = |throw_id| {
        let mut dialogue = Dialogue::announced(rules(false));
        dialogue.status(State::Idle, |_| {});
        let lost = dialogue.step();
        dialogue.write(lost);
        dialogue.status(State::Idle, |status| status.throw_id = throw_id);
        dialogue.step()
    };
    let how = Stranger::Behind {
        throw_id: THROW - 1,
        least: THROW,
    };
    assert_eq!(at(THROW - 1), Step::Halt(Halt::Foreign { how }));
    let (throw, id) = (1, THROW + 1);
    assert_eq!(at(THROW), Step::Announce { throw, id });
}

#[test]
fn a_stopped_cycle_finishes_the_open_throw_and_no_other() {
    let mut dialogue = Dialogue::announced(rules(false));
    dialogue.cycle.stop();
    dialogue.status(State::Idle, before_the_first);
    assert_eq!(dialogue.step(), Step::Request(throw()));
    dialogue.status(State::Idle, |_| {});
    let lost = dialogue.step();
    dialogue.write(lost);
    assert_eq!(dialogue.step(), Step::Finished);
}

#[test]
fn the_plan_ends_after_its_throws() {
    let mut dialogue = Dialogue::announced(rules(false));
    for id in THROW..=THROWS {
        if id > THROW {
            let next = Step::Announce { throw: id - 1, id };
            assert_eq!(dialogue.step(), next);
            dialogue.announce(id);
        }
        dialogue.status(State::Idle, |status| status.throw_id = id);
        let lost = dialogue.step();
        dialogue.write(lost);
    }
    assert_eq!(dialogue.step(), Step::Finished);
}

#[test]
fn what_the_robot_rejects_is_sent_again_after_a_pause_or_a_person_is_asked() {
    let rejected = |request: &Request, nak| {
        let mut dialogue = Dialogue::announced(rules(false));
        dialogue.cycle.replied(request, &Reply::Nak(nak));
        dialogue
    };
    for nak in [Nak::WrongState, Nak::WrongId, Nak::NoSession, Nak::Busy] {
        let mut dialogue = rejected(&throw(), nak);
        assert_eq!(dialogue.step(), Step::Wait, "{nak:?}");
        dialogue.cycle.waited();
        assert_eq!(dialogue.step(), Step::Request(Request::Status), "{nak:?}");
    }
    let setting = setting(1);
    let halts = [
        (throw(), Nak::BadRange, Halt::OutOfRange { setting }),
        (Request::Status, Nak::BadRange, Halt::Misunderstood),
        (throw(), Nak::BadMessage, Halt::Misunderstood),
    ];
    for (request, nak, halt) in halts {
        assert_eq!(rejected(&request, nak).step(), Step::Halt(halt), "{nak:?}");
    }
    // any other answer ends the pause
    let mut dialogue = rejected(&throw(), Nak::Busy);
    dialogue.status(State::Idle, before_the_first);
    assert_eq!(dialogue.step(), Step::Request(throw()));
}

#[test]
fn a_status_is_there_until_it_is_stale() {
    let mut dialogue = Dialogue::announced(rules(false));
    dialogue.status(State::Flying, |_| {});
    let known = |cycle: &Cycle| cycle.status().map(|status| status.state);
    assert_eq!(known(&dialogue.cycle), Some(State::Flying));
    dialogue.cycle.waited();
    assert_eq!(known(&dialogue.cycle), None);
    dialogue.status(State::Flying, |_| {});
    let (throw_id, state) = (THROW, State::Flying);
    dialogue.tell(Reply::Ok { throw_id, state });
    assert_eq!(known(&dialogue.cycle), None);
}

/// The camera may still be busy with another throw, or have tried in vain, or have read its face.
#[test]
fn photos_of_another_throw_are_none_of_this_one() {
    let other = THROW + 4;
    let taken = |shown| Photo {
        id: other,
        attempt: 1,
        shown,
    };
    for photo in [None, Some(taken(Shown::Nothing)), Some(taken(side()))] {
        let mut dialogue = Dialogue::announced(rules(false));
        dialogue.cycle.photographing(other, 1);
        if let Some(photo) = photo.clone() {
            dialogue.cycle.photographed(photo);
        }
        dialogue.status(State::AtCoin, |_| {});
        dialogue.photo(1, Shown::Nothing);
        let (id, attempt) = (THROW, 2);
        assert_eq!(
            dialogue.step(),
            Step::Photograph { id, attempt },
            "{photo:?}"
        );
    }
}

#[test]
fn a_setting_that_no_link_can_carry_is_no_reason_to_halt() {
    let beyond = Request::Throw {
        throw_id: THROW,
        experiment: OURS,
        spin_mrev_s: 5001,
        angle_cdeg: 0,
    };
    assert!(Setting::new(5001, 0).is_err());
    let mut dialogue = Dialogue::announced(rules(false));
    dialogue.cycle.replied(&beyond, &Reply::Nak(Nak::BadRange));
    assert_eq!(dialogue.step(), Step::Wait);
}
