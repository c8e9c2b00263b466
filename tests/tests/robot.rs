//! A simulated robot and its host as processes: noise, resets, disconnections and kills, and every
//! kind of bad input.
#![cfg(unix)]

mod bench;

use bench::{Bench, finish, text};
use coinmc_tests::command;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

fn assert_rejected(command: Command, words: &[&str]) {
    let output = finish(command);
    let text = text(&output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    for word in words {
        assert!(text.contains(word), "`{word}` is not in:\n{text}");
    }
}

#[test]
fn noise_resets_disconnections_and_kills_lose_or_double_no_throw() {
    let bench = Bench::new(40);
    let mut robot = bench.robot(&["--noise", "0.01", "--hostile", "0.05", "--seed", "3"]);
    let quiet = ["--quiet", "--max-voids", "40"];
    let mut host = bench.run("day", &quiet).spawn().expect("it starts");
    for (throw, mishap) in [
        (3, "reset"),
        (5, "kill"),
        (9, "unplug"),
        (13, "kill"),
        (13, "reset"),
        (17, "unplug"),
        (21, "kill"),
        (25, "reset"),
        (25, "unplug"),
        (29, "kill"),
    ] {
        bench.wait_for(throw, &mut host);
        if mishap == "kill" {
            host.kill().expect("it can be killed");
            host.wait().expect("a child");
            host = bench.resume("day", &quiet).spawn().expect("it starts");
        } else {
            robot.send(mishap);
        }
    }
    let output = host.wait_with_output().expect("its output");
    assert!(output.status.success(), "{}", text(&output));
    let (done, void) = bench.audit("day");
    // each of the ten faults costs at most one throw
    assert!(done >= 30 && done + void == 40, "{done} done, {void} void");
    // again: nothing is left to do
    let output = finish(bench.resume("day", &[]));
    assert!(
        text(&output).starts_with("40 of 40 throws"),
        "{}",
        text(&output)
    );

    // the journal's counts against the model
    let mut model = command(bench.dir.path());
    model.args(["run", "day/experiment.toml", "--out", "model", "--quiet"]);
    let model = model.output().expect("it starts");
    assert!(model.status.success(), "{}", text(&model));
    let mut compare = command(bench.dir.path());
    compare.args(["compare", "model", "--journal", "day"]);
    let compared = text(&compare.output().expect("it starts"));
    assert!(compared.contains(&format!("{done} tosses: ")), "{compared}");
    let voids = format!("{void} void throws are left out");
    assert_eq!(compared.contains(&voids), void > 0, "{compared}");

    // tables from the journal: the same as for simulated runs, and one row per throw
    let mut export = command(bench.dir.path());
    export.args(["robot", "export", "day"]);
    assert!(export.output().expect("it starts").status.success());
    let table =
        |name: &str| fs::read_to_string(bench.path("day/export").join(name)).expect("a table");
    let results = table("results.csv");
    let row: Vec<&str> = results.lines().nth(1).expect("a row").split(',').collect();
    let names: Vec<&str> = results.lines().next().expect("names").split(',').collect();
    let cell = |name| row[names.iter().position(|n| *n == name).expect("a column")];
    assert_eq!((cell("engine"), cell("tosses")), ("robot", "40"));
    assert_eq!(cell("undecided"), void.to_string());
    assert_eq!(table("throws.csv").lines().count(), 41);
    for parquet in ["results.parquet", "throws.parquet"] {
        let bytes = fs::read(bench.path("day/export").join(parquet)).expect("a table");
        assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
    }
}

#[test]
fn a_camera_that_hangs_ends_or_reads_nothing_does_not_block_the_experiment() {
    let bench = Bench::new(12);
    let _robot = bench.robot(&[]);
    let camera = Bench::camera("--hang 0.1 --die 0.15 --unread 0.2");
    let more = [
        "--camera-timeout",
        "1",
        "--photos",
        "4",
        "--max-voids",
        "12",
        "--max-camera-failures",
        "1000",
    ];
    bench.run_until_it_starts(&camera, &more);
    let (done, void) = bench.audit("day");
    assert_eq!(done + void, 12);
}

#[test]
fn a_late_photo_is_not_taken_for_the_next_throw() {
    let bench = Bench::new(8);
    let mut robot = bench.robot(&[]);
    // every request takes 0.15 s to reach the camera: a photo is pending when the robot is reset
    let camera = format!(
        "while read -r line; do sleep 0.15; echo \"$line\"; done | ({})",
        Bench::camera("")
    );
    let mut host = bench
        .run_with("day", &camera, &[])
        .spawn()
        .expect("it starts");
    for throw in [2, 5] {
        bench.wait_for(throw, &mut host);
        sleep(Duration::from_millis(120));
        robot.send("reset");
    }
    let output = host.wait_with_output().expect("its output");
    assert!(output.status.success(), "{}", text(&output));
    let (done, void) = bench.audit("day");
    assert!(done >= 6 && done + void == 8, "{done} done, {void} void");
}

#[test]
fn bad_input_is_rejected_with_a_remedy() {
    let bench = Bench::new(4);
    assert_rejected(bench.run("day", &[]), &["no port", "coinmc robot ports"]);
    let mut robot = bench.robot(&[]);

    // out of range
    let mut throw = command(bench.dir.path());
    throw.args([
        "robot", "throw", "--port", "port", "--spin", "5.1", "--angle", "90",
    ]);
    throw.stdout(Stdio::piped()).stderr(Stdio::piped());
    assert_rejected(throw, &["5.1 rev/s", "0 to 5"]);
    let spin = "launch.spin={about={axis=[0,1,0], rate_rad_s={uniform={from=0, to=40}}}}";
    assert_rejected(
        bench.run("wide", &["--set", spin]),
        &["launch.spin", "5 rev/s"],
    );

    // a robot that was used for another experiment
    let mut throw = command(bench.dir.path());
    throw.args([
        "robot", "throw", "--port", "port", "--spin", "1", "--angle", "90",
    ]);
    assert!(throw.output().expect("it starts").status.success());
    assert_rejected(
        bench.run("day", &[]),
        &["counted 1 throws and this journal 0", "--adopt"],
    );
    let output = finish(bench.resume("day", &["--adopt"]));
    assert!(output.status.success(), "{}", text(&output));

    // another experiment's journal
    assert_rejected(
        bench.run("day", &["--set", "seed=9"]),
        &["another experiment", "--out"],
    );

    // damage before the end
    let journal = bench.path("day/journal.txt");
    let whole = fs::read_to_string(&journal).expect("a journal");
    fs::write(&journal, whole.replacen("I 2 ", "I 3 ", 1)).expect("writable");
    assert_rejected(
        bench.resume("day", &[]),
        &["line 6 is damaged", "head -n 5"],
    );
    // and at the end
    fs::write(&journal, &whole[..whole.len() - 5]).expect("writable");
    let output = finish(bench.resume("day", &[]));
    assert!(
        output.status.success() && text(&output).contains("incomplete"),
        "{}",
        text(&output)
    );
    let again = fs::read_to_string(&journal).expect("a journal");
    let bodies = |text: &str| -> Vec<String> {
        // sessions apart, and without the checksums, which depend on them
        let lines = text.lines().filter(|line| !line.starts_with('S'));
        lines
            .map(|line| line[..line.len() - 9].to_owned())
            .collect()
    };
    assert_eq!(bodies(&again), bodies(&whole));

    // two hosts at one port
    let longer = ["--set", "stop.tosses=1000", "--adopt"];
    let mut host = bench.run("long", &longer).spawn().expect("it starts");
    bench.wait_for(8, &mut host);
    assert_rejected(
        bench.run("other", &["--adopt"]),
        &["in use by another program"],
    );
    let _ = host.kill();
    let _ = host.wait();
    robot.send("quit");
}

#[test]
fn a_full_disk_stops_the_host_before_the_throw_and_it_can_resume() {
    let bench = Bench::new(12);
    let _robot = bench.robot(&[]);
    let script = "trap '' XFSZ; ulimit -f 1; exec \"$0\" \"$@\"";
    let limited = |of: &Command| {
        let mut command = Command::new("sh");
        command
            .current_dir(bench.dir.path())
            .args(["-c", script])
            .arg(of.get_program())
            .args(of.get_args())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command
    };
    // a unit of 512 or 1024 bytes: room for the config and a few lines of the journal
    let run = bench.run("day", &["--no-recording"]);
    let output = finish(limited(&run));
    assert_eq!(output.status.code(), Some(1), "{}", text(&output));
    let output = finish(bench.run("day", &[]));
    assert!(output.status.success(), "{}", text(&output));
    let (done, void) = bench.audit("day");
    assert_eq!(done + void, 12);
}

/// Whether the file exists and has the end of a finished recording.
fn is_whole_recording(path: &Path) -> bool {
    fs::read(path)
        .is_ok_and(|bytes| bytes.starts_with(b"\x89MCAP0\r\n") && bytes.ends_with(b"\x89MCAP0\r\n"))
}

#[test]
fn every_session_is_recorded_in_a_file_of_its_own() {
    let bench = Bench::new(3);
    let _robot = bench.robot(&[]);
    assert!(finish(bench.run("day", &[])).status.success());
    assert!(finish(bench.resume("day", &[])).status.success());
    for name in ["session-0001-01.mcap", "session-0002-01.mcap"] {
        assert!(
            is_whole_recording(&bench.path("day/sessions").join(name)),
            "{name}"
        );
    }
}
