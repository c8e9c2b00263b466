//! A robot that can be left alone: whose throw, whose photo, and a way to stop. Each find of an attack
//! is a test.
#![cfg(unix)]

mod bench;

use bench::{Bench, finish, text};
use coinmc_robot::Directory;
use coinmc_robot::journal::{Entry, Journal, Pending, Resolution, VoidReason};
use coinmc_robot::sim::read_truths;
use coinmc_tests::command;
use std::fs;
use std::os::unix::fs::symlink;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

impl Bench {
    fn robot_command(&self, arguments: &[&str]) -> Output {
        let mut command = command(self.dir.path());
        command.arg("robot").args(arguments);
        command.stdin(Stdio::null());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        finish(command)
    }

    fn journal(&self) -> String {
        fs::read_to_string(self.path("day/journal.txt")).expect("a journal")
    }

    fn throws(&self) -> usize {
        let (_, history) = Journal::read(&self.path("day/journal.txt")).expect("a journal");
        history.throws().len()
    }

    /// Begins an experiment, and leaves throw 1 announced but not thrown.
    fn announce(&self) {
        let blocked = self.run("day", &["--min-free", "99999999"]);
        assert_eq!(finish(blocked).status.code(), Some(4));
        let directory = Directory::at(&self.path("day"));
        let experiment = directory.experiment().expect("a config");
        let (mut journal, _) = Journal::open(&directory.journal(), &Directory::header(&experiment))
            .expect("a journal");
        let (setting, at_ms) = (experiment.setting(0), 7);
        journal
            .append(&Entry::Announced {
                id: 1,
                setting,
                at_ms,
            })
            .expect("announced");
    }
}

fn said(output: &Output, code: i32, words: &[&str]) {
    let text = text(output);
    assert_eq!(output.status.code(), Some(code), "{text}");
    for word in words {
        assert!(text.contains(word), "`{word}` is not in:\n{text}");
    }
}

#[test]
fn a_throw_by_hand_between_announcement_and_throw_is_not_the_announced_one() {
    let bench = Bench::new(3);
    let _robot = bench.robot(&[]);
    bench.announce();
    let by_hand = ["throw", "--port", "port", "--spin", "4.5", "--angle", "12"];
    said(&bench.robot_command(&by_hand), 0, &["throw 1"]);
    let output = finish(bench.resume("day", &[]));
    said(&output, 2, &["no experiment", "--adopt"]);
    assert!(bench.journal().contains("V 1 mismatch "));
    let output = finish(bench.resume("day", &["--adopt"]));
    said(&output, 0, &["3 of 3 throws", "1 void"]);
    // the throw by hand is nobody's result
    let directory = Directory::at(&bench.path("day"));
    let (_, history) = Journal::read(&directory.journal()).expect("a journal");
    let mismatch = Some(Resolution::Void(VoidReason::Mismatch));
    assert_eq!(history.throws()[0].resolution, mismatch);
    assert_eq!(history.pending(), Pending::Nothing);
    // robot, firmware and program are in the journal
    let version = env!("CARGO_PKG_VERSION");
    let named = format!("S 636f696e2d73696d 2.0.0 1 {version} ");
    assert!(bench.journal().contains(&named), "{}", bench.journal());
}

#[test]
fn a_robot_swapped_or_erased_at_the_coin_is_noticed() {
    for (change, words) in [("swap", "this is robot"), ("erase", "memory was erased")] {
        let bench = Bench::new(6);
        let mut robot = bench.robot(&[]);
        let slow = "while read -r line; do sleep 0.1; echo \"$line\"; done";
        let camera = format!("{slow} | ({})", Bench::camera(""));
        let mut host = bench
            .run_with("day", &camera, &[])
            .spawn()
            .expect("it starts");
        bench.wait_for(3, &mut host);
        robot.send(change);
        let output = host.wait_with_output().expect("its output");
        said(&output, 2, &[words, "--adopt"]);
        let output = finish(bench.resume("day", &["--adopt"]));
        said(&output, 0, &["6 of 6 throws"]);
        // throw 3 was released once, although the robot had forgotten it
        let truths = read_truths(&bench.path("truth.jsonl")).expect("the truth file");
        assert_eq!(truths.iter().filter(|truth| truth.throw_id == 3).count(), 1);
        bench.audit("day");
    }
}

#[test]
fn a_camera_with_every_vice_gives_no_wrong_face() {
    let bench = Bench::new(30);
    let _robot = bench.robot(&[]);
    let camera = Bench::camera("--vice 0.25 --seed 5");
    let more = [
        "--max-camera-failures",
        "1000",
        "--quiet",
        "--max-voids",
        "30",
    ];
    bench.run_until_it_starts(&camera, &more);
    let (done, void) = bench.audit("day");
    assert!(done >= 20 && done + void == 30, "{done} done, {void} void");
}

#[test]
fn a_camera_that_repeats_its_first_photo_gives_no_result() {
    let bench = Bench::new(4);
    let _robot = bench.robot(&[]);
    // it answers correctly, but always with the same picture
    let program = r#"while read -r line; do r=$(echo "$line" | sed 's/.*"request":\([0-9]*\).*/\1/'); case $line in
*take*) t=$(echo "$line" | sed 's/.*"throw":\([0-9]*\).*/\1/'); a=$(echo "$line" | sed 's/.*"attempt":\([0-9]*\).*/\1/')
name=$(echo "$line" | sed 's/.*"name":"\([^"]*\)".*/\1/'); echo frame > "day/photos/$name.png"
echo "{\"throw\":$t,\"attempt\":$a,\"request\":$r,\"image\":\"$name.png\"}";;
*) echo "{\"throw\":$t,\"attempt\":$a,\"request\":$r,\"face\":\"heads\"}";;
esac; done"#;
    let output = finish(bench.run_with("day", program, &["--max-camera-failures", "3"]));
    said(&output, 4, &["the same picture", "3 times in a row"]);
    assert!(!bench.journal().contains("heads"), "{}", bench.journal());
}

#[test]
fn a_camera_that_cannot_start_costs_no_throw_and_its_words_are_quoted() {
    let bench = Bench::new(4);
    let _robot = bench.robot(&[]);
    let output = finish(bench.run_with("day", "echo no device >&2; exit 3", &[]));
    said(&output, 1, &["no device", "No throw was made"]);
    assert_eq!(bench.throws(), 0);
    assert!(
        fs::read_to_string(bench.path("day/camera.log")).is_ok_and(|log| log.contains("device"))
    );
}

#[test]
fn the_camera_and_its_children_die_with_the_host() {
    let bench = Bench::new(500);
    let _robot = bench.robot(&[]);
    let sleeper = "sleep 98765 & echo $! > sleeper; ";
    let camera = format!("{sleeper}{}", Bench::camera("").replace("exec ", ""));
    let mut host = bench
        .run_with("day", &camera, &[])
        .spawn()
        .expect("it starts");
    bench.wait_for(1, &mut host);
    let sleeper = fs::read_to_string(bench.path("sleeper")).expect("its number");
    host.kill().expect("it can be killed");
    host.wait().expect("a child");
    let begun = Instant::now();
    let alive = || {
        let test = Command::new("kill").args(["-0", sleeper.trim()]).output();
        test.expect("it starts").status.success()
    };
    while alive() {
        assert!(begun.elapsed() < Duration::from_secs(5), "it lives on");
        sleep(Duration::from_millis(20));
    }
}

#[test]
fn stop_reaches_a_running_host_and_its_robot() {
    let bench = Bench::new(500);
    let _robot = bench.robot(&[]);
    let mut host = bench.run("day", &[]).spawn().expect("it starts");
    bench.wait_for(2, &mut host);
    said(
        &bench.robot_command(&["stop", "day"]),
        0,
        &["has stopped the robot"],
    );
    let output = host.wait_with_output().expect("its output");
    // or it was just between two throws
    said(&output, 130, &[]);
    let said_so = text(&output);
    assert!(said_so.contains("motors are off") || said_so.contains("coinmc robot resume"));
    let output = bench.robot_command(&["status", "--port", "port"]);
    let stopped = text(&output);
    assert!(
        stopped.contains("fault 1") || stopped.contains("ready"),
        "{stopped}"
    );
    // without a host it is the robot itself
    said(
        &bench.robot_command(&["stop", "day"]),
        0,
        &["motors are off"],
    );
    said(
        &bench.robot_command(&["stop", "--port", "port"]),
        0,
        &["motors are off"],
    );
}

#[test]
fn an_emergency_stop_halts_calls_for_help_and_stays_until_it_is_cleared() {
    let bench = Bench::new(8);
    let mut robot = bench.robot(&[]);
    let alert = ["--alert", "echo \"$COINMC_ALERT\" > alert.txt"];
    let mut host = bench.run("day", &alert).spawn().expect("it starts");
    bench.wait_for(2, &mut host);
    robot.send("press");
    let output = host.wait_with_output().expect("its output");
    said(&output, 4, &["emergency stop", "coinmc robot clear"]);
    let alert = fs::read_to_string(bench.path("alert.txt")).expect("the alert");
    assert!(alert.contains("emergency stop"), "{alert}");
    let clear = ["clear", "--port", "port"];
    said(&bench.robot_command(&clear), 1, &["still pressed"]);
    robot.send("release");
    sleep(Duration::from_millis(50));
    said(&finish(bench.resume("day", &[])), 4, &["emergency stop"]);
    said(&bench.robot_command(&clear), 0, &["is cleared"]);
    said(&finish(bench.resume("day", &[])), 0, &["8 of 8 throws"]);
    bench.audit("day");
}

#[test]
fn too_little_space_stops_before_the_throw_and_resumes() {
    let bench = Bench::new(3);
    let _robot = bench.robot(&[]);
    let output = finish(bench.run("day", &["--min-free", "99999999"]));
    said(&output, 4, &["no space left for another throw", "resume"]);
    assert_eq!(bench.throws(), 0);
    said(&finish(bench.resume("day", &[])), 0, &["3 of 3 throws"]);
    bench.audit("day");
}

#[test]
fn a_missing_port_is_waited_for_if_asked() {
    let bench = Bench::new(2);
    let host = bench.run("day", &["--wait=30"]).spawn().expect("it starts");
    sleep(Duration::from_millis(300));
    let _robot = bench.robot(&[]);
    said(
        &host.wait_with_output().expect("its output"),
        0,
        &["2 of 2 throws"],
    );
}

#[test]
fn a_stored_command_does_not_run_unseen_and_cannot_reach_the_terminal() {
    let bench = Bench::new(2);
    let _robot = bench.robot(&[]);
    said(&finish(bench.run("day", &[])), 0, &[]);
    let setup = bench.path("day/setup.json");
    let text_of = fs::read_to_string(&setup).expect("the setup");
    let mut setup_json: serde_json::Value = serde_json::from_str(&text_of).expect("JSON");
    setup_json["camera"] = "touch ran\u{1b}]0;owned\u{7}".into();
    fs::write(&setup, setup_json.to_string()).expect("writable");
    let output = bench.robot_command(&["resume", "day"]);
    said(&output, 2, &["touch ran", "--camera"]);
    assert!(!bench.path("ran").exists());
    assert!(!text(&output).contains('\u{1b}') && text(&output).contains("\\u{1b}"));
}

#[test]
fn links_in_the_directory_are_not_followed() {
    let bench = Bench::new(2);
    let _robot = bench.robot(&[]);
    said(&finish(bench.run("day", &[])), 0, &[]);
    fs::write(bench.path("victim"), "precious").expect("writable");
    fs::remove_file(bench.path("day/camera.log")).expect("it was there");
    symlink(bench.path("victim"), bench.path("day/camera.log")).expect("a link");
    let output = finish(bench.resume("day", &[]));
    assert_eq!(output.status.code(), Some(1), "{}", text(&output));
    fs::remove_file(bench.path("day/camera.log")).expect("it was there");
    fs::remove_dir_all(bench.path("day/sessions")).expect("it was there");
    symlink(bench.dir.path(), bench.path("day/sessions")).expect("a link");
    let output = finish(bench.resume("day", &[]));
    said(&output, 1, &["symbolic link"]);
    assert_eq!(fs::read(bench.path("victim")).expect("a file"), b"precious");
    // a pipe in place of the config is refused, not waited for
    let config = bench.path("day/experiment.toml");
    fs::remove_file(&config).expect("it was there");
    let made = Command::new("mkfifo").arg(&config).status();
    assert!(made.expect("it starts").success());
    let output = bench.robot_command(&["export", "day"]);
    said(&output, 1, &["not a regular file"]);
}
