//! The rules of the device (see `device/mod.rs`), each by itself and all at once; limits and stops are
//! in `limits.rs`.

mod support;

use coinmc_link::{
    AT_COIN_LIMIT_MS, Greeting, Nak, PROTOCOL, Record, Reply, Request, SILENCE_LIMIT_MS, State,
    Version, capability, fault,
};
use support::bed::{CYCLE, EXPERIMENT, TestBed, ok, throw};
use support::{Bench, Random};

#[test]
fn a_throw_passes_through_all_phases() {
    let mut bed = TestBed::ready();
    bed.bring_to(State::AtCoin);
    let status = bed.status();
    assert!(status.released && status.t_release_ms > 0);
    assert_eq!(
        (status.meas_spin_mrev_s, status.meas_angle_cdeg),
        (3200, 9000)
    );
    assert_eq!(
        bed.request(&Request::Collect { throw_id: 1 }),
        ok(1, State::Returning)
    );
    bed.bring_on(State::Idle);
    assert_eq!(bed.releases(), [1]);
    assert_eq!(bed.throw(2), ok(2, State::Aiming));
}

#[test]
fn rule_1_a_repetition_is_answered_but_not_executed() {
    let mut bed = TestBed::ready();
    let reply = bed.throw(1);
    bed.bring_on(State::Flying);
    // still "Aiming": the cached reply
    assert_eq!(bed.repeat(&throw(1)), Some(reply));
    assert_eq!(bed.releases(), [1]);
}

#[test]
fn rule_1_a_new_host_gets_no_stale_reply() {
    let mut bed = TestBed::ready();
    bed.throw(1);
    let seq = bed.header.seq;
    // the new host's first number after Hello happens to be the old host's last
    for session in [8, 7] {
        bed.header.seq = seq.wrapping_sub(2);
        bed.hello(session);
        assert!(matches!(bed.request(&Request::Status), Reply::Status(_)));
    }
}

#[test]
fn rule_2_an_id_is_thrown_once() {
    let mut bed = TestBed::ready();
    assert_eq!(bed.throw(5000), ok(5000, State::Aiming));
    bed.bring_on(State::AtCoin);
    bed.request(&Request::Collect { throw_id: 5000 });
    bed.bring_on(State::Idle);
    assert_eq!(bed.throw(5000), ok(5000, State::Idle));
    assert_eq!(bed.throw(4999), Reply::Nak(Nak::WrongId));
    assert_eq!(bed.releases(), [5000]);
}

#[test]
fn rule_3_a_reset_during_a_cycle_ends_in_fault() {
    for phase in CYCLE {
        let mut bed = TestBed::ready();
        bed.bring_to(phase);
        let released = bed.releases().len();
        let code = fault::RESET + u16::from(phase.number());
        // twice: the second start must find the same phase
        for boot in [2, 3] {
            bed.reset();
            let greeting = bed.hello(9);
            assert_eq!((greeting.boot, greeting.throw_id), (boot, 1));
            assert_eq!(greeting.state, State::Fault);
            let status = bed.status();
            assert_eq!(
                (status.fault, status.released),
                (code, phase != State::Aiming)
            );
        }
        assert_eq!(bed.throw(1), ok(1, State::Fault));
        assert_eq!(bed.throw(2), Reply::Nak(Nak::WrongState));
        let wrong = Request::ClearFault { code: code + 1 };
        assert_eq!(bed.request(&wrong), Reply::Nak(Nak::WrongState));
        assert_eq!(
            bed.request(&Request::ClearFault { code }),
            ok(1, State::Idle)
        );
        assert_eq!(bed.releases().len(), released);
        bed.reset();
        assert_eq!(bed.hello(9).state, State::Idle);
    }
}

#[test]
fn rule_3_nothing_is_released_without_a_journal() {
    let mut bed = TestBed::ready();
    bed.throw(1);
    bed.device.hardware_mut().store_works = false;
    bed.pass(1_000);
    let status = bed.status();
    assert_eq!((status.state, status.fault), (State::Fault, fault::JOURNAL));
    assert!(bed.releases().is_empty() && !bed.device.hardware().motors_on);
    // clearing needs the journal, too
    let code = fault::JOURNAL;
    assert_eq!(
        bed.request(&Request::ClearFault { code }),
        ok(1, State::Fault)
    );
}

#[test]
fn rule_4_without_a_session_nothing_is_executed() {
    let mut bed = TestBed::new(Bench::default());
    bed.header.session = 0;
    assert_eq!(bed.throw(1), Reply::Nak(Nak::NoSession));
    bed.header.session = 7;
    assert_eq!(bed.throw(1), Reply::Nak(Nak::NoSession));
    bed.hello(7);
    bed.header.session = 8;
    assert_eq!(bed.throw(1), Reply::Nak(Nak::NoSession));
    bed.header.session = 7;
    bed.reset();
    assert_eq!(bed.throw(1), Reply::Nak(Nak::NoSession));
    assert_eq!(bed.device.hardware().stored.unwrap().throw_id, 0);
}

#[test]
fn rule_4_another_major_version_gets_no_session() {
    let mut bed = TestBed::ready();
    let version = Version { major: 1, minor: 0 };
    bed.header.session = 9;
    let session = 9;
    let reply = bed.request(&Request::Hello { version, session });
    assert!(matches!(reply, Reply::Hello(Greeting { version, .. }) if version == PROTOCOL));
    assert_eq!(bed.throw(1), Reply::Nak(Nak::NoSession));
    // and the open session stays open
    bed.header.session = 7;
    assert_eq!(bed.throw(1), ok(1, State::Aiming));
}

#[test]
fn rule_5_damaged_frames_get_no_reply() {
    let mut bed = TestBed::ready();
    let mut bytes = throw(1).to_wire(bed.header).unwrap().as_bytes().to_vec();
    bytes[4] ^= 0x40;
    assert_eq!(bed.send(&bytes), None);
    assert_eq!(bed.status().rx_bad, 1);
}

#[test]
fn at_the_coin_the_robot_waits_for_an_absent_host() {
    let mut bed = TestBed::ready();
    bed.bring_to(State::AtCoin);
    bed.pass(AT_COIN_LIMIT_MS - 1_000);
    assert_eq!(bed.hello(8).state, State::AtCoin);
    assert_eq!(
        bed.request(&Request::Collect { throw_id: 1 }),
        ok(1, State::Returning)
    );
    bed.bring_on(State::Idle);
}

#[test]
fn requests_in_the_wrong_state_are_rejected() {
    let mut bed = TestBed::ready();
    let collect = Request::Collect { throw_id: 1 };
    assert_eq!(bed.request(&collect), Reply::Nak(Nak::WrongId));
    let too_fast = Request::Throw {
        throw_id: 1,
        experiment: EXPERIMENT,
        spin_mrev_s: 4501,
        angle_cdeg: 0,
    };
    assert_eq!(bed.request(&too_fast), Reply::Nak(Nak::BadRange));
    let too_far = Request::MoveCarriage {
        x_um: 0,
        y_um: -300_001,
    };
    assert_eq!(bed.request(&too_far), Reply::Nak(Nak::BadRange));
    assert_eq!(bed.request(&Request::Home { axes: 1 }), ok(0, State::Idle));
    assert_eq!(bed.throw(1), Reply::Nak(Nak::Busy));
    bed.pass(300);
    bed.bring_to(State::Flying);
    assert_eq!(
        bed.request(&Request::Home { axes: 1 }),
        Reply::Nak(Nak::WrongState)
    );
    assert_eq!(bed.request(&collect), Reply::Nak(Nak::WrongState));
    let counter = Request::SetCounter {
        throw_id: 0,
        experiment: 0,
    };
    assert_eq!(bed.request(&counter), Reply::Nak(Nak::WrongState));
    assert_eq!(bed.request(&Request::Stop), ok(1, State::Fault));
    assert_eq!(bed.status().fault, fault::STOPPED);
}

/// The reply to a host whose first reply was lost, even with its session.
#[test]
fn a_collected_coin_may_be_collected_again_with_the_same_reply() {
    let mut bed = TestBed::ready();
    bed.bring_to(State::Returning);
    let collect = Request::Collect { throw_id: 1 };
    assert_eq!(bed.request(&collect), ok(1, State::Returning));
    bed.bring_on(State::Idle);
    bed.hello(8);
    assert_eq!(bed.request(&collect), ok(1, State::Idle));
}

#[test]
fn a_robot_that_has_not_started_yet_is_busy() {
    let mut bench = Bench::default();
    bench.never_ready = true;
    let mut bed = TestBed::new(bench);
    assert_eq!(bed.hello(7).state, State::Boot);
    assert_eq!(bed.throw(1), Reply::Nak(Nak::Busy));
    let home = Request::Home { axes: 1 };
    assert_eq!(bed.request(&home), Reply::Nak(Nak::Busy));
}

/// Either is enough: a motion that nobody has seen end, and something that still moves on its own.
#[test]
fn nothing_is_thrown_before_everything_stands_still() {
    let mut bed = TestBed::ready();
    bed.request(&Request::Home { axes: 1 });
    // it has ended, but no tick has looked
    bed.device.hardware_mut().now_ms += 1_000;
    assert_eq!(bed.throw(1), Reply::Nak(Nak::Busy));

    let mut bed = TestBed::ready();
    bed.device.hardware_mut().never_ready = true;
    assert_eq!(bed.throw(1), Reply::Nak(Nak::Busy));
    bed.device.hardware_mut().never_ready = false;
    assert_eq!(bed.throw(1), ok(1, State::Aiming));
}

/// Random sequences of requests, repetitions, pauses and resets.
#[test]
fn no_sequence_of_events_breaks_a_rule() {
    for seed in 0..400 {
        let mut random = Random(seed);
        let mut bed = TestBed::ready();
        let (mut id, mut heard_ms) = (0, 0);
        for _ in 0..400 {
            let before = bed.device.hardware().clone();
            let state = bed.device.state();
            match random.below(20) {
                0 => {
                    bed.reset();
                    let phase = before
                        .stored
                        .map_or(State::Idle, |record: Record| record.phase);
                    let caught = phase.in_cycle();
                    assert!(
                        caught || !state.in_cycle(),
                        "{state:?} is not in the journal"
                    );
                    let expected = if caught { State::Fault } else { State::Idle };
                    assert_eq!(bed.hello(7).state, expected);
                    heard_ms = bed.now_ms;
                }
                1 => bed.pass(random.below(8_000)),
                2..8 => bed.pass(random.below(250)),
                _ => {
                    let request = any_request(&mut random, &mut id, &mut bed);
                    let reply = bed.request(&request);
                    let after = bed.device.hardware().releases.clone();
                    if !matches!(request, Request::Hello { .. }) {
                        assert_eq!(bed.repeat(&request), Some(reply));
                        assert_eq!(bed.releases(), after);
                    }
                    if reply != Reply::Nak(Nak::NoSession) {
                        heard_ms = bed.now_ms;
                    }
                }
            }
            let bench = bed.device.hardware();
            assert!(
                bench.releases.is_sorted_by(|a, b| a < b),
                "{:?}",
                bench.releases
            );
            if bed.now_ms - heard_ms > SILENCE_LIMIT_MS + 10 {
                assert!(!bench.motors_on);
            }
            if bench.releases.len() > before.releases.len() && bed.device.state() == State::Flying {
                assert_eq!(bench.stored.map(|record| record.phase), Some(State::Flying));
            }
        }
    }
}

fn any_request(random: &mut Random, id: &mut u32, bed: &mut TestBed) -> Request {
    match random.below(12) {
        0 => {
            bed.header.session = 7;
            Request::Hello {
                version: PROTOCOL,
                session: 7,
            }
        }
        1 => Request::Stop,
        2 => Request::Home { axes: 3 },
        3 | 4 => {
            *id += random.below(2);
            throw(1 + *id)
        }
        5 => throw(1 + id.saturating_sub(1)),
        6 | 7 => Request::Collect { throw_id: 1 + *id },
        8 | 9 => {
            let code = bed.status_or_none().map_or(0, |status| status.fault);
            Request::ClearFault { code }
        }
        10 => Request::Light { permille: 500 },
        _ => Request::Status,
    }
}

/// Limits of the protocol, in each direction by itself.
#[test]
fn no_carriage_goes_farther_than_two_metres() {
    const REACH_UM: i32 = 2_000_000;
    let is_allowed = |x_um, y_um| Request::MoveCarriage { x_um, y_um }.check().is_ok();
    for sign in [1, -1] {
        assert!(is_allowed(sign * REACH_UM, -sign * REACH_UM));
        assert!(!is_allowed(sign * (REACH_UM + 1), 0));
        assert!(!is_allowed(0, sign * (REACH_UM + 1)));
    }
}

/// Limits of this robot, not of the protocol: what is just within them is carried out, one step farther is refused,
/// and so is what the robot cannot do at all.
#[test]
fn a_robot_goes_up_to_its_own_limits() {
    let answers = |capabilities, request: &Request| {
        let mut bench = Bench::default();
        bench.info.capabilities = capabilities;
        bench.info.limits.angle_cdeg = 9_000;
        let mut bed = TestBed::new(bench);
        bed.hello(7);
        bed.request(request)
    };
    let throw = |spin_mrev_s, angle_cdeg| Request::Throw {
        throw_id: 1,
        experiment: EXPERIMENT,
        spin_mrev_s,
        angle_cdeg,
    };
    let moves = |x_um, y_um| Request::MoveCarriage { x_um, y_um };
    let both = capability::LIGHT | capability::CARRIAGE;
    let light = Request::Light { permille: 1 };
    for (capabilities, request) in [
        (both, throw(4_500, 9_000)),
        (both, throw(0, 0)),
        (both, moves(400_000, 300_000)),
        (both, moves(-400_000, -300_000)),
        (capability::CARRIAGE, moves(1, 1)),
        (capability::LIGHT, light),
    ] {
        let reply = answers(capabilities, &request);
        assert!(matches!(reply, Reply::Ok { .. }), "{request:?}: {reply:?}");
    }
    for (capabilities, request) in [
        (both, throw(4_501, 9_000)),
        (both, throw(5_000, 0)),
        (both, throw(4_500, 9_001)),
        (both, throw(0, 18_000)),
        (both, moves(400_001, 0)),
        (both, moves(-400_001, 0)),
        (both, moves(0, 300_001)),
        (both, moves(0, -2_000_000)),
        (capability::LIGHT, moves(1, 1)),
        (capability::CARRIAGE, light),
    ] {
        let reply = answers(capabilities, &request);
        assert_eq!(reply, Reply::Nak(Nak::BadRange), "{request:?}");
    }
}
