//! Robot and host as processes.

use super::TIMED_THROWS;
use anyhow::{Context, anyhow, ensure};
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// What is thrown: all three faces are frequent.
const CONFIG: &str = "\
[coin]
ratio = 1.5
radius_m = 0.0125
[surface]
restitution = 0.5
friction = 0.3
[launch]
preset = \"robot\"
[engine.flat]
";

/// Nothing that is expected here calls for a person.
const PATIENT: [&str; 4] = ["--max-voids", "1000", "--max-camera-failures", "1000"];
/// For cameras that hang.
const IMPATIENT: [&str; 2] = ["--camera-timeout", "2"];

/// Where it happens.
pub(super) struct Bench {
    pub(super) program: PathBuf,
    pub(super) dir: PathBuf,
    pub(super) speed: f64,
    pub(super) noise: f64,
    pub(super) hostile: f64,
    pub(super) forged: f64,
    pub(super) vice: f64,
    pub(super) failing: f64,
    pub(super) seed: u64,
}

/// A process of the study; it ends with this.
pub(super) struct Process(pub(super) Child);

impl Process {
    pub(super) fn signal(&self, name: &str) -> anyhow::Result<()> {
        let process = self.0.id().to_string();
        // it may have ended meanwhile
        Command::new("kill").args(["-s", name, &process]).output()?;
        Ok(())
    }

    pub(super) fn tell(&mut self, command: &str) -> anyhow::Result<()> {
        let input = self.0.stdin.as_mut().context("the robot listens")?;
        writeln!(input, "{command}").context("the simulated robot has ended")
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // gone already: all the better
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Bench {
    pub(super) fn truth(&self) -> PathBuf {
        self.dir.join("truth.jsonl")
    }

    pub(super) fn day(&self) -> PathBuf {
        self.dir.join("day")
    }

    pub(super) fn config(&self, throws: u64) -> anyhow::Result<PathBuf> {
        let path = self.dir.join("robot.toml");
        let text = format!("seed = {}\n{CONFIG}[stop]\ntosses = {throws}\n", self.seed);
        fs::write(&path, text)?;
        Ok(path)
    }

    pub(super) fn coinmc(&self, verb: &str) -> Command {
        let mut command = Command::new(&self.program);
        command.current_dir(&self.dir).args(["robot", verb]);
        command
    }

    pub(super) fn robot(&self, throws: u64) -> anyhow::Result<Process> {
        let mut command = self.coinmc("sim");
        command
            .arg(self.config(throws)?)
            .args([
                "--name",
                "port",
                "--truth",
                "truth.jsonl",
                "--memory",
                "memory",
            ])
            .args([
                "--speed",
                &self.speed.to_string(),
                "--noise",
                &self.noise.to_string(),
                "--hostile",
                &self.hostile.to_string(),
                "--forged",
                &self.forged.to_string(),
            ])
            .args(["--seed", &self.seed.to_string()]);
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .context("the simulated robot does not start")?;
        let output = child.stdout.take().context("the robot speaks")?;
        let robot = Process(child);
        let mut line = String::new();
        BufReader::new(output).read_line(&mut line)?;
        ensure!(line.trim() == "port", "the simulated robot does not start");
        Ok(robot)
    }

    pub(super) fn host(&self, throws: u64) -> anyhow::Result<Process> {
        let mut command = self.coinmc("run");
        command
            .arg(self.config(throws)?)
            .args(["--port", "port", "--out", "day"])
            .args(PATIENT)
            .args([
                "--speed",
                &self.speed.to_string(),
                "--camera",
                &self.camera(),
            ]);
        self.begin(command)
    }

    pub(super) fn camera(&self) -> String {
        format!(
            "exec {} robot camera-sim --truth truth.jsonl --vice {} --hang {} --die {}",
            self.program.display(),
            self.vice,
            self.failing / 2.0,
            self.failing / 2.0,
        )
    }

    pub(super) fn resume(&self, more: &[&str]) -> anyhow::Result<Process> {
        let mut command = self.coinmc("resume");
        command.args(["day", "--camera", &self.camera()]).args(more);
        command.args(PATIENT);
        self.begin(command)
    }

    pub(super) fn begin(&self, mut command: Command) -> anyhow::Result<Process> {
        let log = File::options()
            .create(true)
            .append(true)
            .open(self.dir.join("host.log"))?;
        if self.failing > 0.0 {
            command.args(IMPATIENT);
        }
        command
            .args(["--format", "json"])
            .stdin(Stdio::null())
            .stdout(File::create(self.dir.join("result.json"))?)
            .stderr(log);
        let child = command.spawn().context("the host does not start")?;
        Ok(Process(child))
    }

    /// The last the host said.
    pub(super) fn said(&self) -> String {
        let text = |name| fs::read_to_string(self.dir.join(name)).unwrap_or_default();
        let log = text("host.log");
        let last: Vec<&str> = log.lines().rev().take(5).collect();
        let last: Vec<&str> = last.into_iter().rev().collect();
        format!("{}\n{}", last.join("\n"), text("result.json"))
    }

    /// Round trip and processor time of a host that polls ten times a second.
    pub(super) fn time(&self) -> anyhow::Result<Vec<(&'static str, String)>> {
        let dir = self.dir.join("timed");
        fs::create_dir(&dir)?;
        let slow = Self {
            program: self.program.clone(),
            dir,
            speed: 1.0,
            noise: 0.0,
            hostile: 0.0,
            forged: 0.0,
            vice: 0.0,
            failing: 0.0,
            seed: self.seed,
        };
        let mut robot = slow.robot(TIMED_THROWS)?;
        let mut host = slow.host(TIMED_THROWS)?;
        let begun = Instant::now();
        let mut cpu = (Duration::ZERO, Duration::ZERO);
        while host.0.try_wait()?.is_none() {
            if let Some(used) = processor_time(host.0.id()) {
                cpu = (used, begun.elapsed());
            }
            thread::sleep(Duration::from_millis(100));
        }
        robot.tell("quit")?;
        let result = fs::read_to_string(slow.dir.join("result.json"))?;
        let number = |name: &str| -> anyhow::Result<f64> {
            let rest = result.split(&format!("\"{name}\":")).nth(1);
            let text = rest.and_then(|rest| rest.split([',', '}', '\n']).next());
            let text = text.ok_or_else(|| anyhow!("no {name} in the host's result"))?;
            Ok(text.trim().parse()?)
        };
        let share = cpu.0.as_secs_f64() / cpu.1.as_secs_f64();
        Ok(vec![
            ("round_trip_mean_ms", format!("{:.3}", number("mean")?)),
            (
                "round_trip_longest_ms",
                format!("{:.3}", number("longest")?),
            ),
            ("cpu_share_10_hz", format!("{share:.6}")),
        ])
    }
}

/// Processor time that a process has used, all threads, where the system tells (Linux: /proc, ns).
fn processor_time(process: u32) -> Option<Duration> {
    let tasks = fs::read_dir(Path::new("/proc").join(process.to_string()).join("task")).ok()?;
    let used = |task: fs::DirEntry| {
        let text = fs::read_to_string(task.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<u64>().ok()
    };
    let ns: u64 = tasks.flatten().filter_map(used).sum();
    Some(Duration::from_nanos(ns))
}
