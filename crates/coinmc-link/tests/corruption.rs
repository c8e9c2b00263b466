//! Whatever happens to bytes in transit, only frames that were sent are accepted.
//!
//! A wrong frame passes its CRC once in 2^32: with some 6000 wrong frames per run, these tests fail
//! by chance once in 700,000 runs.

mod support;

use coinmc_link::{
    BadMessage, Decoder, Device, Header, Host, MAX_BODY, MAX_WIRE, Reply, Request, Wire,
};
use proptest::collection::vec;
use proptest::prelude::*;
use support::Bench;

/// Damage to one frame.
#[derive(Debug, Clone)]
enum Damage {
    Flip { at: usize, bits: u8 },
    Drop { at: usize },
    Insert { at: usize, byte: u8 },
    Repeat { at: usize, length: usize },
    Truncate { at: usize },
}

fn damage() -> impl Strategy<Value = Damage> {
    let at = 0..MAX_WIRE;
    prop_oneof![
        (at.clone(), 1..=u8::MAX).prop_map(|(at, bits)| Damage::Flip { at, bits }),
        at.clone().prop_map(|at| Damage::Drop { at }),
        (at.clone(), any::<u8>()).prop_map(|(at, byte)| Damage::Insert { at, byte }),
        (at.clone(), 1..20_usize).prop_map(|(at, length)| Damage::Repeat { at, length }),
        at.prop_map(|at| Damage::Truncate { at }),
    ]
}

fn apply(bytes: &mut Vec<u8>, damage: &Damage) {
    let length = bytes.len().max(1);
    match *damage {
        _ if bytes.is_empty() => {}
        Damage::Flip { at, bits } => bytes[at % length] ^= bits,
        Damage::Drop { at } => drop(bytes.remove(at % length)),
        Damage::Insert { at, byte } => bytes.insert(at % length, byte),
        Damage::Repeat { at, length: run } => {
            let at = at % length;
            let run = bytes[at..length.min(at + run)].to_vec();
            bytes.splice(at..at, run);
        }
        Damage::Truncate { at } => bytes.truncate(at % length),
    }
}

type Accepted = Vec<(Header, Vec<u8>)>;

fn decode(decoder: &mut Decoder, bytes: &[u8]) -> Accepted {
    let mut accepted = Vec::new();
    for byte in bytes {
        if let Some(Ok(frame)) = decoder.push(*byte) {
            accepted.push((frame.header, frame.body.to_vec()));
        }
    }
    accepted
}

fn header() -> impl Strategy<Value = Header> {
    (any::<u16>(), any::<u16>()).prop_map(|(session, seq)| Header { session, seq })
}

fn body() -> impl Strategy<Value = Vec<u8>> {
    vec(prop_oneof![Just(0), any::<u8>()], 0..=MAX_BODY)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn frames_survive_the_wire(frames in vec((header(), body()), 1..5)) {
        let mut bytes = Vec::new();
        for (header, body) in &frames {
            let wire = Wire::new(*header, body).unwrap();
            prop_assert!(wire.as_bytes().len() <= MAX_WIRE);
            let inner = &wire.as_bytes()[1..wire.as_bytes().len() - 1];
            prop_assert!(!inner.contains(&0));
            bytes.extend(wire.as_bytes());
        }
        prop_assert_eq!(decode(&mut Decoder::new(), &bytes), frames);
    }

    #[test]
    fn damage_is_rejected_and_the_next_frame_is_intact(
        sent in (header(), body()), next in (header(), body()), harms in vec(damage(), 1..4)
    ) {
        let mut bytes = Wire::new(sent.0, &sent.1).unwrap().as_bytes().to_vec();
        for damage in &harms {
            apply(&mut bytes, damage);
        }
        let mut decoder = Decoder::new();
        for accepted in decode(&mut decoder, &bytes) {
            prop_assert_eq!(accepted, sent.clone());
        }
        // the next frame begins with a zero, which ends whatever came before
        let wire = Wire::new(next.0, &next.1).unwrap();
        let accepted = decode(&mut decoder, wire.as_bytes());
        prop_assert_eq!(accepted.last(), Some(&next));
    }

    #[test]
    fn garbage_is_harmless(garbage in vec(any::<u8>(), 0..300), next in (header(), body())) {
        let mut decoder = Decoder::new();
        decode(&mut decoder, &garbage);
        let wire = Wire::new(next.0, &next.1).unwrap();
        let accepted = decode(&mut decoder, wire.as_bytes());
        prop_assert_eq!(accepted.last(), Some(&next));
    }

    #[test]
    fn a_body_decodes_to_at_most_one_message(body in vec(prop_oneof![0..12_u8, any::<u8>()], 0..=MAX_BODY)) {
        let header = Header { session: 1, seq: 1 };
        if let Ok(request) = Request::decode(&body) {
            let wire = request.to_wire(header).unwrap();
            prop_assert_eq!(&decode(&mut Decoder::new(), wire.as_bytes())[0].1, &body);
        }
        if let Ok(reply) = Reply::decode(&body) {
            let wire = reply.to_wire(header).unwrap();
            prop_assert_eq!(&decode(&mut Decoder::new(), wire.as_bytes())[0].1, &body);
        }
    }

    /// An echo is not taken for a reply.
    #[test]
    fn no_request_decodes_as_a_reply(body in vec(prop_oneof![0..12_u8, any::<u8>()], 0..16)) {
        if Request::decode(&body).is_ok() {
            prop_assert_eq!(Reply::decode(&body), Err(BadMessage::Malformed));
        }
    }

    #[test]
    fn noise_panics_neither_side(bytes in vec(prop_oneof![Just(0), any::<u8>()], 0..600)) {
        let mut device = Device::boot(Bench::default(), 0);
        device.tick(1);
        for byte in &bytes {
            let reply = device.receive(*byte, 2);
            prop_assert!(reply.is_none_or(|reply| reply.len() <= MAX_WIRE));
        }
        prop_assert_eq!(device.hardware().releases.len(), 0);
        let mut host = Host::new();
        host.open(1, 0);
        host.receive(&bytes, 1);
        prop_assert!(!host.is_ready());
    }
}

/// Flips every single bit and every pair of bits of a frame.
#[test]
fn one_or_two_flipped_bits_are_detected() {
    let header = Header {
        session: 0x00FF,
        seq: 7,
    };
    let request = Request::Throw {
        experiment: 3,
        throw_id: 1000,
        spin_mrev_s: 3200,
        angle_cdeg: 9000,
    };
    let wire = request.to_wire(header).unwrap();
    let bits = wire.as_bytes().len() * 8;
    for first in 0..bits {
        for second in first..bits {
            let mut bytes = wire.as_bytes().to_vec();
            bytes[first / 8] ^= 1 << (first % 8);
            if second != first {
                bytes[second / 8] ^= 1 << (second % 8);
            }
            let accepted = decode(&mut Decoder::new(), &bytes);
            assert!(accepted.is_empty(), "bits {first} and {second}");
        }
    }
}
