//! Rules 6 and 7: time limits of everything that moves, whatever the host sends, and stops.

mod support;

use coinmc_link::{
    AT_COIN_LIMIT_MS, BOOT_LIMIT_MS, HOME_LIMIT_MS, MOVE_LIMIT_MS, Motion, Nak, Reply, Request,
    SILENCE_LIMIT_MS, State, fault,
};
use support::Bench;
use support::bed::{CYCLE, EXPERIMENT, TestBed, ok};

#[test]
fn rule_6_every_phase_has_a_limit() {
    let aim = Motion::Aim {
        spin_mrev_s: 3200,
        angle_cdeg: 9000,
    };
    let phases = [
        (State::Aiming, Some(aim), 3_000),
        (State::Flying, Some(Motion::Release), 3_000),
        (State::Driving, Some(Motion::DriveToCoin), 4_000),
        (State::AtCoin, None, AT_COIN_LIMIT_MS),
        (State::Returning, Some(Motion::Return), 5_000),
    ];
    for (phase, stuck, limit_ms) in phases {
        let mut bed = TestBed::ready();
        bed.device.hardware_mut().stuck = stuck;
        bed.bring_to(phase);
        bed.pass_with_requests(limit_ms - 200);
        assert_eq!(bed.device.state(), phase);
        bed.pass_with_requests(300);
        let status = bed.status();
        assert_eq!(status.fault, fault::LIMIT + u16::from(phase.number()));
        assert!(!bed.device.hardware().motors_on);
    }
}

#[test]
fn rule_6_every_motion_on_request_has_a_limit_whatever_the_host_sends() {
    let motions = [
        (
            Request::Home { axes: 15 },
            Motion::Home { axes: 15 },
            HOME_LIMIT_MS,
        ),
        (
            Request::MoveCarriage { x_um: 1, y_um: 2 },
            Motion::MoveCarriage { x_um: 1, y_um: 2 },
            MOVE_LIMIT_MS,
        ),
    ];
    for (request, stuck, limit_ms) in motions {
        let mut bed = TestBed::ready();
        bed.device.hardware_mut().stuck = Some(stuck);
        assert_eq!(bed.request(&request), ok(0, State::Idle));
        let begun_ms = bed.now_ms;
        // a host that asks for it again and again does not begin the limit anew
        while bed.device.hardware().motors_on {
            bed.pass(10);
            let reply = bed.request(&request);
            assert!(matches!(reply, Reply::Nak(Nak::Busy | Nak::WrongState)));
            assert!(bed.now_ms <= begun_ms + limit_ms + 10);
        }
        assert_eq!(bed.now_ms, begun_ms + limit_ms);
        let status = bed.status();
        let code = fault::LIMIT + u16::from(State::Idle.number());
        assert_eq!((status.state, status.fault), (State::Fault, code));
    }
}

#[test]
fn rule_6_a_start_that_does_not_end_is_a_fault() {
    let mut bench = Bench::default();
    bench.never_ready = true;
    let mut bed = TestBed::new(bench);
    bed.hello(7);
    bed.pass_with_requests(BOOT_LIMIT_MS - 200);
    assert_eq!(bed.device.state(), State::Boot);
    bed.pass_with_requests(300);
    assert_eq!(bed.status().fault, fault::LIMIT);
}

#[test]
fn rule_6_what_does_not_move_has_no_current() {
    let mut bed = TestBed::ready();
    bed.request(&Request::Home { axes: 15 });
    assert!(bed.device.hardware().motors_on);
    // the host keeps asking, so that it is not the silence that ends it
    bed.pass_with_requests(400);
    assert!(!bed.device.hardware().motors_on);
    bed.bring_to(State::AtCoin);
    bed.request(&Request::Collect { throw_id: 1 });
    bed.bring_on(State::Idle);
    bed.pass(10);
    assert!(!bed.device.hardware().motors_on);
}

#[test]
fn rule_7_an_emergency_stop_is_latched() {
    for phase in CYCLE {
        let mut bed = TestBed::ready();
        bed.bring_to(phase);
        let released = bed.releases().len();
        bed.device.hardware_mut().motors_on = true;
        bed.device.hardware_mut().stopped = true;
        bed.pass(10);
        assert!(!bed.device.hardware().motors_on, "{phase:?}");
        let emergency = Request::ClearFault {
            code: fault::EMERGENCY,
        };
        // as long as it is pressed it cannot be cleared
        assert_eq!(bed.request(&emergency), Reply::Nak(Nak::Busy));
        bed.device.hardware_mut().stopped = false;
        bed.pass_with_requests(500);
        assert_eq!(bed.status().fault, fault::EMERGENCY);
        // a reset does not clear it either, nor a second one
        for _ in 0..2 {
            bed.reset();
            assert_eq!(bed.hello(9).state, State::Fault);
            let status = bed.status();
            assert_eq!((status.fault, status.throw_id), (fault::EMERGENCY, 1));
        }
        assert_eq!(bed.throw(2), Reply::Nak(Nak::WrongState));
        assert_eq!(bed.request(&emergency), ok(1, State::Idle));
        assert_eq!(bed.releases().len(), released);
        bed.reset();
        assert_eq!(bed.hello(9).state, State::Idle);
    }
    // at rest and during a motion on request, too
    let mut bed = TestBed::ready();
    bed.request(&Request::Home { axes: 15 });
    bed.device.hardware_mut().stopped = true;
    bed.pass(10);
    assert!(!bed.device.hardware().motors_on);
    assert_eq!(bed.status().fault, fault::EMERGENCY);
}

/// The memory of a journal wears out: one entry a stop, however long it is pressed, and after whatever fault.
#[test]
fn rule_7_an_emergency_stop_is_written_down_once() {
    let mut bed = TestBed::ready();
    bed.bring_to(State::Flying);
    bed.request(&Request::Stop);
    assert_eq!(bed.status().fault, fault::STOPPED);
    bed.device.hardware_mut().stored = None;
    bed.device.hardware_mut().stopped = true;
    bed.pass(10);
    let stored = bed.device.hardware_mut().stored.take();
    assert_eq!(stored.map(|record| record.phase), Some(State::Fault));
    bed.pass(1_000);
    assert_eq!(bed.device.hardware().stored, None);
}

#[test]
fn the_status_says_whose_throw_it_is() {
    let mut bed = TestBed::ready();
    let counter = Request::SetCounter {
        throw_id: 4,
        experiment: EXPERIMENT,
    };
    assert_eq!(bed.request(&counter), ok(4, State::Idle));
    bed.throw(5);
    let status = bed.status();
    let asked = (status.spin_mrev_s, status.angle_cdeg);
    assert_eq!((status.throw_id, status.experiment), (5, EXPERIMENT));
    assert_eq!(asked, (3200, 9000));
    // the same number of another experiment is another throw
    let foreign = Request::Throw {
        throw_id: 5,
        experiment: EXPERIMENT + 1,
        spin_mrev_s: 3200,
        angle_cdeg: 9000,
    };
    assert_eq!(bed.request(&foreign), Reply::Nak(Nak::WrongId));
    // it outlasts a reset; what was asked does not, and nobody can take it for the present throw's
    bed.reset();
    bed.hello(9);
    let status = bed.status();
    assert_eq!((status.throw_id, status.experiment), (5, EXPERIMENT));
    assert_eq!((status.spin_mrev_s, status.angle_cdeg), (0, 0));
}

#[test]
fn rule_6_without_a_host_the_motors_switch_off() {
    for phase in CYCLE {
        let mut bed = TestBed::ready();
        bed.bring_to(phase);
        // any motor that had current, including a holding brake at the coin
        bed.device.hardware_mut().motors_on = true;
        bed.pass(SILENCE_LIMIT_MS + 100);
        assert!(!bed.device.hardware().motors_on, "{phase:?}");
    }
    let mut bed = TestBed::ready();
    bed.device.hardware_mut().stuck = Some(Motion::Home { axes: 15 });
    bed.request(&Request::Home { axes: 15 });
    bed.pass(SILENCE_LIMIT_MS - 100);
    assert!(bed.device.hardware().motors_on);
    bed.pass(200);
    assert!(!bed.device.hardware().motors_on);
    assert_eq!(bed.device.state(), State::Idle);
}
