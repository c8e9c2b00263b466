//! A robot with another version of the protocol is rejected with a remedy.
#![cfg(unix)]

use coinmc_link::{Decoder, Greeting, Reply, Request, State, Version};
use coinmc_tests::command;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::thread;

/// Replies to every Hello like a robot with protocol 9.1, until the host closes the port.
fn answer(mut line: File) {
    let mut decoder = Decoder::new();
    let mut bytes = [0; 64];
    while let Ok(count) = line.read(&mut bytes) {
        for byte in &bytes[..count] {
            let Some(Ok(frame)) = decoder.push(*byte) else {
                continue;
            };
            assert!(matches!(
                Request::decode(frame.body),
                Ok(Request::Hello { .. })
            ));
            let greeting = Reply::Hello(Greeting {
                version: Version { major: 9, minor: 1 },
                boot: 1,
                throw_id: 0,
                state: State::Idle,
            });
            let wire = greeting.to_wire(frame.header).expect("a reply fits");
            line.write_all(wire.as_bytes()).expect("the host listens");
        }
    }
}

#[test]
fn a_robot_of_another_protocol_version_is_rejected() {
    let line = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a pseudo-terminal");
    grantpt(&line).expect("it is ours");
    unlockpt(&line).expect("it is ours");
    let name = ptsname(&line, Vec::new()).expect("it has a name");
    let name = name.into_string().expect("in ASCII");
    // kept open, so that the port exists as long as the host
    let port = OpenOptions::new().read(true).write(true).open(&name);
    let port = port.expect("it opens");
    let mut settings = tcgetattr(&port).expect("a terminal");
    settings.make_raw();
    tcsetattr(&port, OptionalActions::Now, &settings).expect("a terminal");
    let robot = thread::spawn(move || answer(line.into()));

    let dir = tempfile::tempdir().expect("a temporary directory");
    let output = command(dir.path())
        .args(["robot", "status", "--port", &name])
        .output()
        .expect("it starts");
    drop(port);
    robot.join().expect("the host says Hello and no more");
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{text}");
    for word in ["9.1", "2.0", "firmware"] {
        assert!(text.contains(word), "`{word}` is not in:\n{text}");
    }
}
