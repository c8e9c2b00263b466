//! What belongs together, what is stale, and what is counted anew, message by message.

mod dialogue;
mod world;

use coinmc_link::{Reply, Request, State, Status};
use coinmc_robot::Face;
use coinmc_robot::cycle::{Cycle, Halt, Photo, Shown, Step};
use coinmc_robot::journal::{Digest, Entry, History, Measured, Reading, VoidReason};
use dialogue::{Dialogue, THROW, greeting, info, name, side, void};
use world::{OURS, PROGRAM, rules};

#[test]
fn a_reading_has_the_measured_values_at_release_and_the_boot() {
    let mut dialogue = Dialogue::announced(rules(false));
    // before the release the present values are no measurement
    dialogue.status(State::Aiming, |status| {
        (status.released, status.meas_spin_mrev_s) = (false, 9);
    });
    assert_eq!(dialogue.step(), Step::Wait);
    dialogue.status(State::AtCoin, |_| {});
    dialogue.photo(1, side());
    let Step::Write(Entry::Read { id, reading, at_ms }) = dialogue.step() else {
        panic!("{:?}", dialogue.step())
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
        let mut dialogue = Dialogue::announced(rules(false));
        dialogue.status(State::AtCoin, change);
        dialogue.photo(1, side());
        dialogue.step()
    };
    assert!(matches!(at_coin(|_| {}), Step::Write(Entry::Read { .. })));
    // one that has not happened, as far as the robot knows
    let unreleased = at_coin(|status| status.released = false);
    assert!(matches!(unreleased, Step::Photograph { .. } | Step::Wait));

    // one of another experiment
    let mut dialogue = Dialogue::announced(rules(false));
    dialogue.status(State::AtCoin, |status| status.experiment = OURS + 1);
    dialogue.status(State::AtCoin, |status| status.released = false);
    dialogue.photo(1, side());
    let step = dialogue.step();
    assert!(
        matches!(step, Step::Photograph { .. } | Step::Wait),
        "{step:?}"
    );

    // one that was before
    let mut dialogue = Dialogue::announced(rules(false));
    dialogue.status(State::AtCoin, |_| {});
    dialogue.photo(1, side());
    let read = dialogue.step();
    dialogue.write(read);
    dialogue.status(State::Idle, |_| {});
    let done = dialogue.step();
    dialogue.write(done);
    dialogue.announce(2);
    dialogue.status(State::AtCoin, |status| {
        (status.throw_id, status.released) = (2, false);
    });
    dialogue.photo(1, side());
    let step = dialogue.step();
    assert!(
        matches!(step, Step::Photograph { .. } | Step::Wait),
        "{step:?}"
    );
}

#[test]
fn a_release_that_was_not_asked_for_is_void() {
    let mut dialogue = Dialogue::announced(rules(false));
    dialogue.status(State::Driving, |status| status.spin_mrev_s = 101);
    assert_eq!(dialogue.step(), void(THROW, VoidReason::Mismatch));
    // noted as released, and the robot was reset since: it has forgotten what was asked
    let mut dialogue = Dialogue::announced(rules(false));
    dialogue.status(State::AtCoin, |_| {});
    dialogue.photo(1, side());
    dialogue.status(State::AtCoin, |status| status.angle_cdeg = 1002);
    dialogue.status(State::Idle, |_| {});
    assert_eq!(dialogue.step(), void(THROW, VoidReason::Mismatch));
}

#[test]
fn a_release_is_on_target_to_the_tolerance_of_each_number() {
    let rules = rules(false);
    let (spin, angle) = (rules.spin_tolerance_mrev_s, rules.angle_tolerance_cdeg);
    let read = |measured: (u16, u16)| {
        let mut dialogue = Dialogue::announced(rules.clone());
        dialogue.status(State::AtCoin, |status| {
            (status.meas_spin_mrev_s, status.meas_angle_cdeg) = measured;
        });
        dialogue.photo(1, side());
        dialogue.step()
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
        let mut dialogue = Dialogue::announced(rules(false));
        dialogue.status(State::AtCoin, |_| {});
        dialogue.photo(1, Shown::Nothing);
        dialogue.cycle.photographing(THROW, 2);
        let shown = side();
        dialogue.cycle.photographed(Photo { id, attempt, shown });
        assert_eq!(dialogue.step(), Step::Wait, "{id} {attempt}");
    }
}

#[test]
fn photos_without_a_face_add_up_to_a_void_throw() {
    let mut dialogue = Dialogue::announced(rules(false));
    dialogue.status(State::AtCoin, |_| {});
    dialogue.photo(1, Shown::Nothing);
    // a camera that fails has not looked
    dialogue.photo(2, Shown::Failure("no light".to_owned()));
    dialogue.photo(3, Shown::Nothing);
    assert_eq!(dialogue.step(), void(THROW, VoidReason::Unread));
}

#[test]
fn only_failures_of_the_camera_in_a_row_halt() {
    let failure = || Shown::Failure("no light".to_owned());
    let mut patient = rules(false);
    patient.max_photos = 9;
    let mut dialogue = Dialogue::announced(patient);
    dialogue.status(State::AtCoin, |_| {});
    let shown = [failure(), failure(), Shown::Nothing, failure(), failure()];
    for (attempt, shown) in (1..).zip(shown) {
        dialogue.photo(attempt, shown);
    }
    dialogue.photo(6, failure());
    let Step::Halt(Halt::CameraFails { id, count, last }) = dialogue.step() else {
        panic!("{:?}", dialogue.step())
    };
    assert_eq!((id, count, last.as_str()), (THROW, 3, "no light"));
}

/// Throws with these endings, `true` for a reading; the halt, if there is one.
fn after(endings: &[bool], max_voids: u32) -> Option<Halt> {
    let mut strict = rules(false);
    strict.max_voids = max_voids;
    let mut dialogue = Dialogue::announced(strict);
    for (id, read) in (THROW..).zip(endings) {
        if id > THROW {
            dialogue.announce(id);
        }
        let of = |status: &mut Status| status.throw_id = id;
        if *read {
            dialogue.status(State::AtCoin, of);
            dialogue.photo(1, side());
            let read = dialogue.step();
            dialogue.write(read);
        }
        dialogue.status(State::Idle, of);
        let resolved = dialogue.step();
        dialogue.write(resolved);
    }
    match dialogue.step() {
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
    let mut dialogue = Dialogue::announced(rules(false));
    for _ in 0..3 {
        for _ in 0..15 {
            dialogue.status(State::Fault, |status| {
                (status.throw_id, status.fault) = (0, 103);
            });
            let clear = Request::ClearFault { code: 103 };
            assert_eq!(dialogue.step(), Step::Request(clear));
        }
        dialogue.status(State::Idle, |status| status.throw_id = 0);
        assert!(matches!(
            dialogue.step(),
            Step::Request(Request::Throw { .. })
        ));
    }
}

/// A reset between two messages: what was said before it is not believed.
#[test]
fn after_a_connection_the_robot_is_asked_who_it_is_and_how() {
    let mut dialogue = Dialogue::announced(rules(false));
    dialogue.status(State::AtCoin, |_| {});
    dialogue.cycle.connected(&greeting(5));
    assert_eq!(dialogue.step(), Step::Request(Request::Info));
    dialogue.tell(Reply::Info(info()));
    assert_eq!(dialogue.step(), Step::Request(Request::Status));
    dialogue.status(State::AtCoin, |_| {});
    dialogue.cycle.waited();
    assert_eq!(dialogue.step(), Step::Request(Request::Status));
}

/// Photos of a throw that is void are none of the next one, whether they came or not.
#[test]
fn photos_are_counted_anew_for_each_throw() {
    for came in [true, false] {
        let mut dialogue = Dialogue::announced(rules(false));
        dialogue.status(State::AtCoin, |_| {});
        dialogue.cycle.photographing(THROW, 1);
        if came {
            let (attempt, shown) = (1, Shown::Nothing);
            let photo = Photo {
                id: THROW,
                attempt,
                shown,
            };
            dialogue.cycle.photographed(photo);
        }
        dialogue.status(State::Fault, |status| status.fault = 103);
        assert_eq!(dialogue.step(), void(THROW, VoidReason::Fault(103)));
        let step = dialogue.step();
        dialogue.write(step);
        dialogue.announce(THROW + 1);
        dialogue.status(State::AtCoin, |status| status.throw_id = THROW + 1);
        // not as many without a face as the rules allow: those of the first throw do not count
        dialogue.photo(1, Shown::Nothing);
        dialogue.photo(2, Shown::Failure("no light".to_owned()));
        assert!(matches!(
            dialogue.step(),
            Step::Photograph { attempt: 3, .. }
        ));
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
