//! The wire format, pinned: docs/reference/robot-protocol/golden-frames.txt has every message as a
//! frame, and this crate and the C header write and read exactly these frames.

mod support;

use coinmc_link::{
    BadMessage, Decoder, Greeting, Header, Info, Limits, MAX_BODY, Nak, PROTOCOL, Reply, Request,
    State, Status, Version, Wire, axis, capability,
};
use std::path::PathBuf;
use std::process::Command;

const HEADER: Header = Header {
    session: 0x1234,
    seq: 0x00FF,
};

const EXPERIMENT: u32 = 2_809_463_210;

fn golden_file() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../docs/reference/robot-protocol/golden-frames.txt")
}

#[test]
fn this_crate_writes_the_golden_frames() {
    let path = golden_file();
    let golden = std::fs::read_to_string(&path).unwrap_or_default();
    let golden: Vec<&str> = golden.lines().filter(|l| !l.starts_with('#')).collect();
    let written: Vec<String> = lines();
    for (golden, written) in golden.iter().zip(&written) {
        assert_eq!(golden, written);
    }
    assert!(
        golden.len() == written.len(),
        "{} has {} frames instead of:\n{}",
        path.display(),
        golden.len(),
        written.join("\n")
    );
}

#[test]
fn every_message_is_read_back() {
    for request in requests() {
        let wire = request.to_wire(HEADER).unwrap();
        let read = body(&wire).map(|body| Request::decode(&body));
        assert_eq!(read, Some(Ok(request)));
    }
    for reply in replies() {
        let wire = reply.to_wire(HEADER).unwrap();
        let read = body(&wire).map(|body| Reply::decode(&body));
        assert_eq!(read, Some(Ok(reply)));
    }
}

#[test]
fn the_c_header_reads_and_writes_the_same_frames() {
    let Some(program) = support::compile("golden", &["tests/c/golden.c"]) else {
        return;
    };
    let output = Command::new(&program.path)
        .arg(golden_file())
        .output()
        .expect("the C program runs");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}");
    let checked = format!("{} frames checked", lines().len());
    assert!(text.contains(&checked), "{text}");
}

/// The whole file without its comments.
fn lines() -> Vec<String> {
    let requests = requests().into_iter().map(|request| {
        let wire = request.to_wire(HEADER).unwrap();
        line("request", &request_text(&request), wire.as_bytes())
    });
    let replies = replies().into_iter().map(|reply| {
        let wire = reply.to_wire(HEADER).unwrap();
        line("reply", &reply_text(&reply), wire.as_bytes())
    });
    let bad = bad_bodies().into_iter().map(|(why, body, error)| {
        assert_eq!(Request::decode(&body), Err(error), "{why}");
        let kind = match error {
            BadMessage::Malformed => "malformed",
            BadMessage::OutOfRange => "out_of_range",
        };
        line(kind, why, Wire::new(HEADER, &body).unwrap().as_bytes())
    });
    let rejects = rejects().into_iter().map(|(why, bytes)| {
        let mut decoder = Decoder::new();
        assert!(
            !bytes
                .iter()
                .any(|b| matches!(decoder.push(*b), Some(Ok(_))))
        );
        line("reject", why, &bytes)
    });
    requests.chain(replies).chain(bad).chain(rejects).collect()
}

fn line(kind: &str, text: &str, bytes: &[u8]) -> String {
    let hex: Vec<String> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    format!("{kind} {text} : {}", hex.join(" "))
}

fn body(wire: &Wire) -> Option<Vec<u8>> {
    let mut decoder = Decoder::new();
    let mut found = None;
    for byte in wire.as_bytes() {
        if let Some(Ok(frame)) = decoder.push(*byte) {
            assert_eq!(frame.header, HEADER);
            found = Some(frame.body.to_vec());
        }
    }
    found
}

fn requests() -> Vec<Request> {
    vec![
        Request::Hello {
            version: PROTOCOL,
            session: HEADER.session,
        },
        Request::Info,
        Request::Status,
        Request::Stop,
        Request::Home { axes: axis::ALL },
        throw(1, 0, 0),
        throw(300, 3200, 9000),
        Request::Throw {
            throw_id: u32::MAX,
            experiment: u32::MAX,
            spin_mrev_s: 5000,
            angle_cdeg: 18_000,
        },
        Request::MoveCarriage { x_um: 0, y_um: -1 },
        Request::MoveCarriage {
            x_um: -2_000_000,
            y_um: 2_000_000,
        },
        Request::Light { permille: 1000 },
        Request::Collect { throw_id: 300 },
        Request::ClearFault { code: 103 },
        Request::SetCounter {
            throw_id: 70_000,
            experiment: EXPERIMENT,
        },
    ]
}

fn throw(throw_id: u32, spin_mrev_s: u16, angle_cdeg: u16) -> Request {
    Request::Throw {
        throw_id,
        experiment: EXPERIMENT,
        spin_mrev_s,
        angle_cdeg,
    }
}

fn replies() -> Vec<Reply> {
    let greeting = |boot, throw_id, state| {
        Reply::Hello(Greeting {
            version: PROTOCOL,
            boot,
            throw_id,
            state,
        })
    };
    let mut replies = vec![
        greeting(1, 0, State::Boot),
        greeting(u16::MAX, u32::MAX, State::Fault),
        Reply::Info(Info {
            uid: [1, 0, 3, 4, 255, 6, 7, 8],
            firmware: [1, 2, 3],
            capabilities: capability::LIGHT | capability::CARRIAGE,
            limits: Limits {
                spin_mrev_s: 5000,
                angle_cdeg: 18_000,
                x_um: 400_000,
                y_um: 300_000,
            },
        }),
        Reply::Ok {
            throw_id: 300,
            state: State::Aiming,
        },
    ];
    let naks = [
        Nak::BadMessage,
        Nak::BadRange,
        Nak::WrongState,
        Nak::WrongId,
        Nak::NoSession,
        Nak::Busy,
    ];
    replies.extend(naks.map(Reply::Nak));
    replies.extend([
        Reply::Status(Status::default()),
        Reply::Status(Status {
            state: State::AtCoin,
            throw_id: 300,
            experiment: EXPERIMENT,
            spin_mrev_s: 3200,
            angle_cdeg: 9000,
            released: true,
            meas_spin_mrev_s: 3187,
            meas_angle_cdeg: 9012,
            x_um: -12_345,
            y_um: 54_321,
            t_ms: 86_400_000,
            t_release_ms: 86_396_500,
            fault: 0,
            rx_bad: 2,
        }),
        Reply::Status(LONGEST),
    ]);
    replies
}

const LONGEST: Status = Status {
    state: State::Fault,
    throw_id: u32::MAX,
    experiment: u32::MAX,
    spin_mrev_s: u16::MAX,
    angle_cdeg: u16::MAX,
    released: true,
    meas_spin_mrev_s: u16::MAX,
    meas_angle_cdeg: u16::MAX,
    x_um: i32::MIN,
    y_um: i32::MAX,
    t_ms: u32::MAX,
    t_release_ms: u32::MAX,
    fault: u16::MAX,
    rx_bad: u16::MAX,
};

/// Bodies of intact frames that are not requests.
fn bad_bodies() -> Vec<(&'static str, Vec<u8>, BadMessage)> {
    use BadMessage::{Malformed, OutOfRange};
    vec![
        ("empty", vec![], Malformed),
        ("unknown-variant", vec![11], Malformed),
        ("trailing-byte", vec![2, 0], Malformed),
        ("field-missing", vec![5, 1, 0, 0], Malformed),
        ("varint-not-shortest", vec![8, 0x81, 0x00], Malformed),
        ("varint-too-large", vec![7, 0x80, 0x80, 0x04], Malformed),
        (
            "varint-never_settles",
            vec![8, 255, 255, 255, 255, 255],
            Malformed,
        ),
        ("session-0", vec![0, 1, 0, 0], OutOfRange),
        ("throw-id-0", vec![5, 0, 0, 0, 0], OutOfRange),
        ("spin-5001", vec![5, 1, 0, 0x89, 0x27, 0], OutOfRange),
        ("no-axis", vec![4, 0], OutOfRange),
        ("axis-unknown", vec![4, 16], OutOfRange),
    ]
}

/// Bytes that do not contain a frame.
fn rejects() -> Vec<(&'static str, Vec<u8>)> {
    let good = Request::Status.to_wire(HEADER).unwrap();
    let good = good.as_bytes();
    let mut flipped = good.to_vec();
    flipped[3] ^= 0x10;
    let mut cut = good[..good.len() - 3].to_vec();
    cut.push(0);
    let mut overlong = vec![0];
    overlong.extend([1; 66]);
    overlong.push(0);
    vec![
        ("bit-flipped", flipped),
        ("cut", cut),
        ("too-short", vec![0, 3, 1, 2, 0]),
        ("too-long", overlong),
        ("only-delimiters", vec![0, 0, 0, 0]),
    ]
}

fn request_text(request: &Request) -> String {
    let at = format!("session={} seq={}", HEADER.session, HEADER.seq);
    match *request {
        Request::Hello {
            version: Version { major, minor },
            ..
        } => format!("hello {at} major={major} minor={minor}"),
        Request::Info => format!("info {at}"),
        Request::Status => format!("status {at}"),
        Request::Stop => format!("stop {at}"),
        Request::Home { axes } => format!("home {at} axes={axes}"),
        Request::Throw {
            throw_id,
            experiment,
            spin_mrev_s,
            angle_cdeg,
        } => format!(
            "throw {at} throw_id={throw_id} experiment={experiment} spin_mrev_s={spin_mrev_s} angle_cdeg={angle_cdeg}"
        ),
        Request::MoveCarriage { x_um, y_um } => {
            format!("move_carriage {at} x_um={x_um} y_um={y_um}")
        }
        Request::Light { permille } => format!("light {at} permille={permille}"),
        Request::Collect { throw_id } => format!("collect {at} throw_id={throw_id}"),
        Request::ClearFault { code } => format!("clear_fault {at} code={code}"),
        Request::SetCounter {
            throw_id,
            experiment,
        } => format!("set_counter {at} throw_id={throw_id} experiment={experiment}"),
    }
}

fn reply_text(reply: &Reply) -> String {
    let at = format!("session={} seq={}", HEADER.session, HEADER.seq);
    match *reply {
        Reply::Hello(Greeting {
            version: Version { major, minor },
            boot,
            throw_id,
            state,
        }) => format!(
            "hello {at} major={major} minor={minor} boot={boot} throw_id={throw_id} state={}",
            state.number()
        ),
        Reply::Info(info) => {
            let uid = u64::from_be_bytes(info.uid);
            let [major, minor, patch] = info.firmware;
            let Limits {
                spin_mrev_s,
                angle_cdeg,
                x_um,
                y_um,
            } = info.limits;
            format!(
                "info {at} uid={uid:016x} firmware={major}.{minor}.{patch} capabilities={} \
                 spin_mrev_s={spin_mrev_s} angle_cdeg={angle_cdeg} x_um={x_um} y_um={y_um}",
                info.capabilities
            )
        }
        Reply::Ok { throw_id, state } => {
            format!("ok {at} throw_id={throw_id} state={}", state.number())
        }
        Reply::Nak(nak) => format!("nak {at} reason={}", nak as u8),
        Reply::Status(status) => format!(
            "status {at} state={} throw_id={} experiment={} spin_mrev_s={} angle_cdeg={} \
             released={} meas_spin_mrev_s={} meas_angle_cdeg={} \
             x_um={} y_um={} t_ms={} t_release_ms={} fault={} rx_bad={}",
            status.state.number(),
            status.throw_id,
            status.experiment,
            status.spin_mrev_s,
            status.angle_cdeg,
            u8::from(status.released),
            status.meas_spin_mrev_s,
            status.meas_angle_cdeg,
            status.x_um,
            status.y_um,
            status.t_ms,
            status.t_release_ms,
            status.fault,
            status.rx_bad
        ),
    }
}

#[test]
fn the_longest_message_fits() {
    let wire = Reply::Status(LONGEST).to_wire(HEADER).unwrap();
    assert!(
        wire.as_bytes().len() <= 51 + 8 + 3,
        "{}",
        wire.as_bytes().len()
    );
    assert!(Wire::new(HEADER, &[1; MAX_BODY]).is_ok());
    assert!(Wire::new(HEADER, &[1; MAX_BODY + 1]).is_err());
}
