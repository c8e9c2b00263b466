//! Intact frames that no robot has sent.

use super::Dice;
use coinmc_link::{Decoder, Header, Reply, Wire};

/// Header and message of a frame.
fn open(frame: &[u8]) -> Option<(Header, Vec<u8>)> {
    let mut decoder = Decoder::new();
    let mut found = None;
    for byte in frame {
        if let Some(Ok(frame)) = decoder.push(*byte) {
            found = Some((frame.header, frame.body.to_vec()));
        }
    }
    found
}

fn close(header: Header, body: &[u8]) -> Option<Vec<u8>> {
    let wire = Wire::new(header, body).ok()?;
    Some(wire.as_bytes().to_vec())
}

/// The same message with another sequence number, or in another session.
pub fn reframed(frame: &[u8], dice: &mut Dice) -> Option<Vec<u8>> {
    let (mut header, body) = open(frame)?;
    let [which, by, ..] = dice.word().to_le_bytes();
    let by = u16::from(by % 3) + 1;
    match which % 3 {
        0 => header.seq = header.seq.wrapping_add(by),
        1 => header.seq = header.seq.wrapping_sub(by),
        _ => header.session = header.session.wrapping_add(by).max(1),
    }
    close(header, &body)
}

/// The same answer about another throw or experiment; none if the frame names neither.
pub fn with_another_identity(frame: &[u8], dice: &mut Dice) -> Option<Vec<u8>> {
    let (header, body) = open(frame)?;
    let mut reply = Reply::decode(&body).ok()?;
    let [which, by, ..] = dice.word().to_le_bytes();
    let by = u32::from(by % 3) + 1;
    let (throw_id, experiment) = match &mut reply {
        Reply::Status(status) => (&mut status.throw_id, Some(&mut status.experiment)),
        Reply::Hello(greeting) => (&mut greeting.throw_id, None),
        Reply::Ok { throw_id, .. } => (throw_id, None),
        Reply::Info(_) | Reply::Nak(_) => return None,
    };
    match (which % 3, experiment) {
        (0, Some(experiment)) => *experiment ^= by,
        (1, _) => *throw_id = throw_id.wrapping_add(by),
        _ => *throw_id = throw_id.saturating_sub(by),
    }
    let wire = reply.to_wire(header).ok()?;
    Some(wire.as_bytes().to_vec())
}

/// An answer of an earlier time, as if it were the one to the present request.
pub fn with_old_content(frame: &[u8], old: &[u8]) -> Option<Vec<u8>> {
    let (header, body) = open(frame)?;
    let (_, earlier) = open(old)?;
    Reply::decode(&body).and(Reply::decode(&earlier)).ok()?;
    close(header, &earlier)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_link::{State, Status};

    #[test]
    fn forged_frames_are_intact_and_about_something_else() {
        let header = Header { session: 7, seq: 9 };
        let status = Status {
            throw_id: 12,
            experiment: 5,
            state: State::AtCoin,
            ..Status::default()
        };
        let wire = Reply::Status(status).to_wire(header).unwrap();
        let mut dice = Dice::new(1, 0);
        for _ in 0..100 {
            let (of, body) = open(&reframed(wire.as_bytes(), &mut dice).unwrap()).unwrap();
            assert!(of != header && Reply::decode(&body) == Ok(Reply::Status(status)));
            let forged = with_another_identity(wire.as_bytes(), &mut dice).unwrap();
            let (of, body) = open(&forged).unwrap();
            let Ok(Reply::Status(other)) = Reply::decode(&body) else {
                panic!("{body:?}");
            };
            assert_eq!(of, header);
            assert!((other.throw_id, other.experiment) != (12, 5));
        }
        let request = coinmc_link::Request::Status.to_wire(header).unwrap();
        assert_eq!(with_another_identity(request.as_bytes(), &mut dice), None);
        assert_eq!(with_old_content(request.as_bytes(), wire.as_bytes()), None);
        let later = Header {
            session: 7,
            seq: 10,
        };
        let next = Reply::Nak(coinmc_link::Nak::Busy).to_wire(later).unwrap();
        let forged = with_old_content(next.as_bytes(), wire.as_bytes()).unwrap();
        let (of, body) = open(&forged).unwrap();
        assert_eq!(
            (of, Reply::decode(&body)),
            (later, Ok(Reply::Status(status)))
        );
    }
}
