//! Days of a simulated robot in minutes: noise, resets, unpluggings and kills of the host; then the
//! books are compared with what happened.

use anyhow::{Context, anyhow, bail, ensure};
use clap::Args;
use coinmc_bench::{Report, Table, number};
use coinmc_core::Face;
use coinmc_robot::journal::{History, Journal, Resolution};
use coinmc_robot::sim::{Dice, Truth, last_truth, read_truths};
use coinmc_robot::{Directory, Experiment};
use std::collections::{BTreeMap, HashMap};
use std::env;
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

/// How long a cycle takes at most, s of the robot's time: faults come anywhere in one.
const CYCLE_S: f64 = 10.0;

/// Throws whose every answer is timed at the speed of life.
const TIMED_THROWS: u64 = 2;

/// Of a simulated robot: nothing lost, doubled or misrecorded, whatever goes wrong.
#[derive(Debug, Args)]
pub(crate) struct RobotSoak {
    /// Throws
    #[arg(long, value_parser = number::count, default_value = "20000", value_name = "N")]
    throws: u64,

    /// How much faster than life the robot is
    #[arg(long, default_value_t = 100.0, value_name = "FACTOR")]
    speed: f64,

    /// Share of bytes that are flipped, dropped or followed by another
    #[arg(long, default_value_t = 0.01, value_name = "SHARE")]
    noise: f64,

    /// Resets of the robot
    #[arg(long, default_value_t = 50, value_name = "N")]
    resets: u32,

    /// Unpluggings of the cable
    #[arg(long, default_value_t = 50, value_name = "N")]
    unplugs: u32,

    /// Kills of the host, by SIGKILL
    #[arg(long, default_value_t = 50, value_name = "N")]
    kills: u32,

    /// The program [default: `coinmc` beside this one]
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,

    /// Do not time answers at the speed of life (20 s)
    #[arg(long)]
    untimed: bool,

    /// Keep the experiment in this new directory
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Mishap {
    Reset,
    Unplug,
    Kill,
}

impl RobotSoak {
    pub(crate) fn execute(self, seed: u64) -> anyhow::Result<Report> {
        let program = match &self.program {
            Some(program) => program.clone(),
            None => {
                env::current_exe()?.with_file_name(format!("coinmc{}", env::consts::EXE_SUFFIX))
            }
        };
        ensure!(
            program.is_file(),
            "{} is no program: build coinmc in the same profile, or name it with --program",
            program.display()
        );
        let temporary = tempfile::tempdir()?;
        let dir = self
            .keep
            .clone()
            .unwrap_or_else(|| temporary.path().join("soak"));
        fs::create_dir(&dir).with_context(|| format!("cannot create {}", dir.display()))?;
        let bench = Bench {
            program,
            dir: fs::canonicalize(&dir)?,
            speed: self.speed,
            noise: self.noise,
            seed,
        };
        let mut record = Table::new("robot soak", &["what", "value"]);
        let mut row = |what: &str, value: String| record.push(vec![what.to_owned(), value]);
        row("throws", self.throws.to_string());
        row("speed", self.speed.to_string());
        row("noise", self.noise.to_string());
        let begun = Instant::now();
        let ordeal = self.endure(&bench)?;
        row("wall_s", format!("{:.1}", begun.elapsed().as_secs_f64()));
        for (what, count) in [
            ("resets", ordeal.resets),
            ("unpluggings", ordeal.unplugs),
            ("kills", ordeal.kills),
        ] {
            row(what, count.to_string());
        }
        for (what, value) in bench.audit(self.throws)? {
            row(&what, value);
        }
        if !self.untimed {
            for (what, value) in bench.time()? {
                row(what, value);
            }
        }
        let mut report = Report::new(record);
        report.remark(
            "Every throw is in the journal once and resolved once; none was released twice; every \
             face read is the face that lay there and the one the engine gives.",
        );
        Ok(report)
    }

    /// Runs the experiment through all mishaps to its end.
    fn endure(&self, bench: &Bench) -> anyhow::Result<Ordeal> {
        let mut robot = bench.robot(self.throws)?;
        let mut host = bench.host(self.throws)?;
        let mut ordeal = Ordeal::default();
        let mut mishaps = self.schedule(bench.seed).into_iter().peekable();
        loop {
            if let Some(status) = host.0.try_wait()? {
                ensure!(
                    status.success(),
                    "the host ended by itself: {status}\n{}",
                    bench.said()
                );
                break;
            }
            let at = last_truth(&bench.truth())?.map_or(0, |truth| u64::from(truth.throw_id));
            let Some((_, delay, mishap)) = mishaps.next_if(|(due, ..)| at >= *due) else {
                thread::sleep(Duration::from_millis(2));
                continue;
            };
            thread::sleep(delay);
            match mishap {
                Mishap::Reset => {
                    robot.tell("reset")?;
                    ordeal.resets += 1;
                }
                Mishap::Unplug => {
                    robot.tell("unplug")?;
                    ordeal.unplugs += 1;
                }
                Mishap::Kill => {
                    if host.0.try_wait()?.is_none() {
                        host.0.kill()?;
                        host.0.wait()?;
                        ordeal.kills += 1;
                        host = bench.resume()?;
                    }
                }
            }
        }
        robot.tell("quit")?;
        Ok(ordeal)
    }

    /// When what goes wrong: at which throw, and how long after its release.
    fn schedule(&self, seed: u64) -> Vec<(u64, Duration, Mishap)> {
        let mut dice = Dice::new(seed, 100);
        let mut due = Vec::new();
        for (count, mishap) in [
            (self.resets, Mishap::Reset),
            (self.unplugs, Mishap::Unplug),
            (self.kills, Mishap::Kill),
        ] {
            for _ in 0..count {
                // the last throws are left alone, so that every mishap has its throw
                let throw = 1 + dice.word() % (self.throws * 98 / 100).max(1);
                let delay = Duration::from_secs_f64(dice.uniform() * CYCLE_S / self.speed);
                due.push((throw, delay, mishap));
            }
        }
        due.sort_by_key(|(throw, ..)| *throw);
        due
    }
}

#[derive(Debug, Default)]
struct Ordeal {
    resets: u32,
    unplugs: u32,
    kills: u32,
}

/// Where it happens.
struct Bench {
    program: PathBuf,
    dir: PathBuf,
    speed: f64,
    noise: f64,
    seed: u64,
}

/// A process of the study; it ends with this.
struct Process(Child);

impl Process {
    fn tell(&mut self, command: &str) -> anyhow::Result<()> {
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
    fn truth(&self) -> PathBuf {
        self.dir.join("truth.jsonl")
    }

    fn day(&self) -> PathBuf {
        self.dir.join("day")
    }

    fn config(&self, throws: u64) -> anyhow::Result<PathBuf> {
        let path = self.dir.join("robot.toml");
        let text = format!("seed = {}\n{CONFIG}[stop]\ntosses = {throws}\n", self.seed);
        fs::write(&path, text)?;
        Ok(path)
    }

    fn coinmc(&self, verb: &str) -> Command {
        let mut command = Command::new(&self.program);
        command.current_dir(&self.dir).args(["robot", verb]);
        command
    }

    fn robot(&self, throws: u64) -> anyhow::Result<Process> {
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

    fn host(&self, throws: u64) -> anyhow::Result<Process> {
        let camera = format!(
            "exec {} robot camera-sim --truth truth.jsonl",
            self.program.display()
        );
        let mut command = self.coinmc("run");
        command
            .arg(self.config(throws)?)
            .args(["--port", "port", "--out", "day", "--most-voids", "100"])
            .args(["--speed", &self.speed.to_string(), "--camera", &camera]);
        self.begin(command)
    }

    fn resume(&self) -> anyhow::Result<Process> {
        let mut command = self.coinmc("resume");
        command.args(["day", "--most-voids", "100"]);
        self.begin(command)
    }

    fn begin(&self, mut command: Command) -> anyhow::Result<Process> {
        let log = File::options()
            .create(true)
            .append(true)
            .open(self.dir.join("host.log"))?;
        command
            .args(["--format", "json"])
            .stdin(Stdio::null())
            .stdout(File::create(self.dir.join("result.json"))?)
            .stderr(log);
        let child = command.spawn().context("the host does not start")?;
        Ok(Process(child))
    }

    /// The last the host said.
    fn said(&self) -> String {
        let text = |name| fs::read_to_string(self.dir.join(name)).unwrap_or_default();
        let log = text("host.log");
        let last: Vec<&str> = log.lines().rev().take(5).collect();
        let last: Vec<&str> = last.into_iter().rev().collect();
        format!("{}\n{}", last.join("\n"), text("result.json"))
    }

    /// Compares the journal with the truth.
    fn audit(&self, throws: u64) -> anyhow::Result<Vec<(String, String)>> {
        let directory = Directory::at(&self.day());
        let experiment = directory.experiment()?;
        let (_, history) = Journal::read(&directory.journal())?;
        let truths = read_truths(&self.truth())?;
        let released = once_each(&truths)?;
        ensure!(
            history.throws().len() as u64 == throws,
            "{} throws in the journal, {throws} planned",
            history.throws().len()
        );
        let (mut done, mut voids) = ([0_u64; 3], BTreeMap::new());
        for (number, throw) in (0_u32..).zip(history.throws()) {
            ensure!(
                throw.id == number + 1,
                "throw {} follows {number}",
                throw.id
            );
            ensure!(
                throw.setting == experiment.setting(number),
                "throw {} has another setting than planned",
                throw.id
            );
            match (throw.resolution, &throw.reading) {
                (Some(Resolution::Done), Some((reading, _))) => {
                    let truth = released.get(&throw.id).copied();
                    let lay = truth.and_then(Truth::face);
                    let model = experiment.model_face(number, throw.setting)?;
                    ensure!(
                        lay == Some(reading.face) && model == lay,
                        "throw {}: read {:?}, lay {lay:?}, engine {model:?}",
                        throw.id,
                        reading.face
                    );
                    let face = Face::ALL.iter().position(|face| *face == reading.face);
                    done[face.context("one of three")?] += 1;
                }
                (Some(Resolution::Void(reason)), _) => {
                    *voids.entry(reason.to_string()).or_insert(0_u64) += 1;
                }
                _ => bail!("throw {} is unresolved", throw.id),
            }
        }
        for truth in &truths {
            let at_most = u32::try_from(throws)?;
            ensure!(
                (1..=at_most).contains(&truth.throw_id),
                "a release without a throw"
            );
        }
        let mut rows = vec![("done".to_owned(), done.iter().sum::<u64>().to_string())];
        rows.extend(
            voids
                .into_iter()
                .map(|(reason, count)| (format!("void {reason}"), count.to_string())),
        );
        rows.extend(frequencies(&experiment, &history, done)?);
        Ok(rows)
    }

    /// Round trip and processor time of a host that polls ten times a second.
    fn time(&self) -> anyhow::Result<Vec<(&'static str, String)>> {
        let dir = self.dir.join("timed");
        fs::create_dir(&dir)?;
        let slow = Self {
            program: self.program.clone(),
            dir,
            speed: 1.0,
            noise: 0.0,
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

/// The release of each throw; an error if one was released twice.
fn once_each(truths: &[Truth]) -> anyhow::Result<HashMap<u32, &Truth>> {
    let mut released = HashMap::new();
    for truth in truths {
        let before = released.insert(truth.throw_id, truth);
        ensure!(
            before.is_none(),
            "throw {} was released twice",
            truth.throw_id
        );
    }
    Ok(released)
}

/// Frequencies of the done throws against those of the engine for all planned ones.
fn frequencies(
    experiment: &Experiment,
    history: &History,
    done: [u64; 3],
) -> anyhow::Result<Vec<(String, String)>> {
    let mut engine = [0_u64; 3];
    for (number, throw) in (0..).zip(history.throws()) {
        if let Some(face) = experiment.model_face(number, throw.setting)? {
            engine[Face::ALL
                .iter()
                .position(|f| *f == face)
                .context("one of three")?] += 1;
        }
    }
    let n = done.iter().sum::<u64>() as f64;
    let planned = engine.iter().sum::<u64>() as f64;
    let mut rows = Vec::new();
    for (index, face) in Face::ALL.iter().enumerate() {
        let p = engine[index] as f64 / planned;
        let share = done[index] as f64 / n;
        let z = (share - p) / (p * (1.0 - p) / n).sqrt();
        ensure!(
            z.abs() < 3.0,
            "{}: {share} done, {p} by the engine",
            face.name()
        );
        rows.push((format!("p_{}", face.name()), format!("{share:.4}")));
        rows.push((format!("p_{}_engine", face.name()), format!("{p:.4}")));
        rows.push((format!("z_{}", face.name()), format!("{z:.2}")));
    }
    Ok(rows)
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
