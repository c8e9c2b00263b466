//! A simulated robot and hosts in a directory of their own, and the books compared with what happened.
#![allow(dead_code, missing_docs, unreachable_pub)] // each test uses its part

use coinmc_core::Face;
use coinmc_robot::journal::{Journal, Resolution};
use coinmc_robot::sim::{Truth, last_truth, read_truths};
use coinmc_robot::{Directory, Experiment};
use coinmc_tests::{coinmc, command, root};
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Time limit of every step.
pub const TIMEOUT: Duration = Duration::from_mins(1);

/// A simulated robot, which ends when dropped.
pub struct Robot {
    pub child: Child,
    input: ChildStdin,
}

impl Robot {
    pub fn send(&mut self, command: &str) {
        writeln!(self.input, "{command}").expect("the robot listens");
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

pub struct Bench {
    pub dir: TempDir,
    pub throws: u32,
}

impl Bench {
    pub fn new(throws: u32) -> Self {
        let dir = tempfile::tempdir().expect("a temporary directory");
        fs::copy(
            root().join("examples/robot.toml"),
            dir.path().join("robot.toml"),
        )
        .expect("the example is there");
        Self { dir, throws }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    pub fn stop(&self) -> String {
        format!("stop.tosses={}", self.throws)
    }

    pub fn robot(&self, more: &[&str]) -> Robot {
        let mut command = command(self.dir.path());
        command
            .args(["robot", "sim", "robot.toml", "--set", &self.stop()])
            .args([
                "--name",
                "port",
                "--truth",
                "truth.jsonl",
                "--memory",
                "memory",
            ])
            .args(["--speed", "200"])
            .args(more);
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("it starts");
        let mut line = String::new();
        BufReader::new(child.stdout.take().expect("a pipe"))
            .read_line(&mut line)
            .expect("it speaks");
        assert_eq!(line, "port\n");
        let input = child.stdin.take().expect("a pipe");
        Robot { child, input }
    }

    pub fn camera(more: &str) -> String {
        let program = coinmc().display();
        format!("exec '{program}' robot camera-sim --truth truth.jsonl {more}")
    }

    pub fn run(&self, out: &str, more: &[&str]) -> Command {
        self.run_with(out, &Self::camera(""), more)
    }

    pub fn run_with(&self, out: &str, camera: &str, more: &[&str]) -> Command {
        let mut command = command(self.dir.path());
        command
            .args([
                "robot",
                "run",
                "robot.toml",
                "--set",
                &self.stop(),
                "--out",
                out,
            ])
            .args(["--port", "port", "--speed", "200", "--camera", camera])
            .args(more)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command
    }

    pub fn resume(&self, out: &str, more: &[&str]) -> Command {
        let mut command = command(self.dir.path());
        command
            .args(["robot", "resume", out])
            .args(["--camera", &Self::camera("")])
            .args(more)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command
    }

    /// Runs an experiment whose camera may fail even the test photo, which costs no throw.
    pub fn run_until_it_starts(&self, camera: &str, more: &[&str]) {
        let begun = Instant::now();
        loop {
            let output = finish(self.run_with("day", camera, more));
            if output.status.success() {
                return;
            }
            let text = text(&output);
            assert!(text.contains("No throw was made"), "{text}");
            assert!(begun.elapsed() < TIMEOUT, "{text}");
        }
    }

    /// Waits until the coin of this throw has been released.
    pub fn wait_for(&self, throw: u32, host: &mut Child) {
        let begun = Instant::now();
        let truth = self.path("truth.jsonl");
        while last_truth(&truth)
            .expect("readable")
            .is_none_or(|t| t.throw_id < throw)
        {
            assert!(
                host.try_wait().expect("a child").is_none(),
                "the host ended before {throw}"
            );
            assert!(begun.elapsed() < TIMEOUT, "throw {throw} never comes");
            sleep(Duration::from_millis(2));
        }
    }

    /// Compares the journal with the true outcomes; returns the number of done and of void throws.
    pub fn audit(&self, out: &str) -> (u32, u32) {
        let directory = Directory::at(&self.path(out));
        let experiment: Experiment = directory.experiment().expect("a config");
        let (_, history) = Journal::read(&directory.journal()).expect("a journal");
        let truths = read_truths(&self.path("truth.jsonl")).expect("the truth file");
        assert_eq!(history.throws().len(), self.throws as usize);
        let (mut done, mut void) = (0, 0);
        for (number, throw) in (0..).zip(history.throws()) {
            assert_eq!(
                (throw.id, throw.setting),
                (number + 1, experiment.setting(number))
            );
            let releases: Vec<&Truth> = truths
                .iter()
                .filter(|truth| truth.throw_id == throw.id)
                .collect();
            assert!(releases.len() <= 1, "throw {} was released twice", throw.id);
            match throw.resolution {
                Some(Resolution::Done) => {
                    let face: Face = throw.reading.as_ref().expect("done").0.face;
                    assert_eq!(releases[0].face(), Some(face), "throw {}", throw.id);
                    let model = experiment.model_face(number, throw.setting);
                    assert_eq!(model, Ok(Some(face)), "throw {}", throw.id);
                    done += 1;
                }
                Some(Resolution::Void(_)) => void += 1,
                None => panic!("throw {} is unresolved", throw.id),
            }
        }
        (done, void)
    }
}

/// Output of a process once it has ended.
pub fn finish(mut command: Command) -> Output {
    let mut child = command.spawn().expect("it starts");
    let begun = Instant::now();
    while child.try_wait().expect("a child").is_none() {
        if begun.elapsed() > TIMEOUT {
            let _ = child.kill();
            panic!("it does not end: {:?}", child.wait_with_output());
        }
        sleep(Duration::from_millis(5));
    }
    child.wait_with_output().expect("its output")
}

pub fn text(output: &Output) -> String {
    let both = [&output.stdout[..], &output.stderr].concat();
    String::from_utf8_lossy(&both).into_owned()
}
