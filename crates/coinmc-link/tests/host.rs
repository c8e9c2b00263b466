//! The host's state machine, tested byte by byte.

use coinmc_link::{
    Action, BadMessage, Decoder, Greeting, Header, Host, LOST_AFTER_MS, Nak, PROTOCOL,
    REPLY_TIMEOUT_MS, Reply, Request, RequestError, Seen, State, Version,
};

const GREETING: Greeting = Greeting {
    version: PROTOCOL,
    boot: 3,
    throw_id: 0,
    state: State::Idle,
};
const DONE: Reply = Reply::Ok {
    throw_id: 0,
    state: State::Idle,
};

/// The frame that the host sends now.
fn sent(host: &mut Host, now_ms: u64) -> (Header, Request) {
    let Action::Transmit(bytes) = host.poll(now_ms) else {
        panic!("nothing to send");
    };
    let mut decoder = Decoder::new();
    for byte in bytes {
        if let Some(frame) = decoder.push(*byte) {
            let frame = frame.unwrap();
            return (frame.header, Request::decode(frame.body).unwrap());
        }
    }
    panic!("no frame");
}

fn answer(host: &mut Host, header: Header, reply: Reply, now_ms: u64) {
    host.receive(reply.to_wire(header).unwrap().as_bytes(), now_ms);
}

fn connect(host: &mut Host, greeting: Greeting, now_ms: u64) -> Seen {
    let (header, request) = sent(host, now_ms);
    let Request::Hello { version, session } = request else {
        panic!("{request:?}");
    };
    assert_eq!((version, session), (PROTOCOL, header.session));
    answer(host, header, Reply::Hello(greeting), now_ms);
    match host.poll(now_ms) {
        Action::Connected { greeting: g, seen } if g == greeting => seen,
        other => panic!("{other:?}"),
    }
}

fn connected() -> Host {
    let mut host = Host::new();
    host.open(9, 0);
    assert_eq!(connect(&mut host, GREETING, 0), Seen::First);
    host
}

#[test]
fn a_request_is_repeated_until_it_is_answered() {
    let mut host = connected();
    host.request(&Request::Stop, 1_000).unwrap();
    let first = sent(&mut host, 1_000);
    let until_ms = Some(1_000 + REPLY_TIMEOUT_MS);
    assert_eq!(host.poll(1_001), Action::Wait { until_ms });
    assert_eq!(sent(&mut host, 1_150), first);
    answer(&mut host, first.0, DONE, 1_160);
    assert_eq!(host.poll(1_160), Action::Reply(DONE));
    // the reply to the repetition arrives late and is not taken for the next request's
    host.request(&Request::Status, 1_170).unwrap();
    let second = sent(&mut host, 1_170);
    assert_eq!(second.0.seq, first.0.seq.wrapping_add(1));
    answer(&mut host, first.0, DONE, 1_180);
    assert!(matches!(host.poll(1_180), Action::Wait { .. }));
    let counters = host.counters();
    assert_eq!(
        (counters.sent, counters.repeated, counters.ignored),
        (4, 1, 1)
    );
}

#[test]
fn a_silent_connection_is_lost_and_can_be_reopened() {
    let mut host = connected();
    host.request(&Request::Status, 0).unwrap();
    let mut sent = 0;
    for now_ms in 0..LOST_AFTER_MS {
        sent += u32::from(matches!(host.poll(now_ms), Action::Transmit(_)));
    }
    assert_eq!(sent, 20);
    assert_eq!(host.poll(LOST_AFTER_MS), Action::Lost);
    assert_eq!(host.poll(LOST_AFTER_MS), Action::Wait { until_ms: None });
    let refused = host.request(&Request::Status, LOST_AFTER_MS);
    assert_eq!(refused, Err(RequestError::NotConnected));
    for (greeting, seen) in [
        (GREETING, Seen::Same),
        (
            Greeting {
                boot: 4,
                ..GREETING
            },
            Seen::NewBoot,
        ),
    ] {
        host.open(11, 5_000);
        assert_eq!(connect(&mut host, greeting, 5_000), seen);
    }
}

#[test]
fn a_reset_is_followed_by_another_hello() {
    for (boot, expected) in [(4, Seen::NewBoot), (3, Seen::Taken)] {
        let mut host = connected();
        host.request(&Request::Status, 0).unwrap();
        let (header, _) = sent(&mut host, 0);
        answer(&mut host, header, Reply::Nak(Nak::NoSession), 5);
        let greeting = Greeting { boot, ..GREETING };
        assert_eq!(connect(&mut host, greeting, 5), expected);
        assert!(host.is_ready());
    }
}

#[test]
fn another_major_version_is_rejected() {
    let mut host = Host::new();
    host.open(9, 0);
    let (header, _) = sent(&mut host, 0);
    let version = Version { major: 1, minor: 5 };
    let greeting = Greeting {
        version,
        ..GREETING
    };
    answer(&mut host, header, Reply::Hello(greeting), 1);
    assert_eq!(host.poll(1), Action::Refused { version });
    assert_eq!(host.poll(9_999), Action::Wait { until_ms: None });
}

#[test]
fn requests_out_of_order_or_range_are_not_sent() {
    let mut host = Host::new();
    assert_eq!(
        host.request(&Request::Stop, 0),
        Err(RequestError::NotConnected)
    );
    let mut host = connected();
    let light = Request::Light { permille: 1001 };
    let bad = RequestError::Bad(BadMessage::OutOfRange);
    assert_eq!(host.request(&light, 0), Err(bad));
    host.request(&Request::Stop, 0).unwrap();
    assert_eq!(
        host.request(&Request::Stop, 0),
        Err(RequestError::Outstanding)
    );
    host.close();
    assert_eq!(host.poll(0), Action::Wait { until_ms: None });
}

/// The robot may still do what was asked; the host only waits no longer.
#[test]
fn a_request_that_was_given_up_makes_way_for_another() {
    let mut host = connected();
    host.request(&Request::Stop, 1_000).unwrap();
    let late = sent(&mut host, 1_000);
    assert!(host.request(&Request::Status, 1_010).is_err());
    host.give_up();
    host.request(&Request::Status, 1_010).unwrap();
    let next = sent(&mut host, 1_010);
    answer(&mut host, late.0, DONE, 1_020);
    assert!(matches!(host.poll(1_020), Action::Wait { .. }));
    answer(&mut host, next.0, DONE, 1_030);
    assert_eq!(host.poll(1_030), Action::Reply(DONE));
    // without a request there is nothing to give up: the session stays open
    host.give_up();
    host.request(&Request::Stop, 1_040).unwrap();
}
