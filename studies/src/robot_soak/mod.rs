//! Days of a simulated robot in minutes: noise, resets, unpluggings and kills of the host; then the
//! books are compared with what happened.

mod audit;
mod bench;
mod settings;

use anyhow::{Context, bail, ensure};
use bench::Bench;
use clap::Args;
use coinmc_bench::{Report, Table, number};
use coinmc_robot::sim::{Dice, last_truth};
use std::env;
use std::fs;
use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

/// How long a cycle takes at most, s of the robot's time: faults come anywhere in one.
const CYCLE_S: f64 = 10.0;

/// Halts at the same throw before a person takes the robot over as it is.
const PATIENCE: u32 = 2;

/// Throws whose every answer is timed at the speed of life.
const TIMED_THROWS: u64 = 2;

/// Of a simulated robot: nothing lost, doubled or misrecorded, whatever goes wrong.
#[derive(Debug, Clone, Args)]
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

    /// Share of frames that are dropped, doubled, swapped, delayed, cut, sent again or forged
    #[arg(long, default_value_t = 0.0, value_name = "SHARE")]
    hostile: f64,

    /// Share of the robot's answers preceded by a forged one, about another throw or experiment, or old
    #[arg(long, default_value_t = 0.0, value_name = "SHARE")]
    forged: f64,

    /// Share of the camera's answers with a vice: an old picture or frame, a second line, another throw
    /// or name
    #[arg(long, default_value_t = 0.0, value_name = "SHARE")]
    vice: f64,

    /// Share of photos at which the camera ends or, as often, hangs
    #[arg(long, default_value_t = 0.0, value_name = "SHARE")]
    failing: f64,

    /// Times that the host is suspended for a while, by SIGSTOP
    #[arg(long, default_value_t = 0, value_name = "N")]
    pauses: u32,

    /// Times that the robot's memory is erased; a person takes it over again
    #[arg(long, default_value_t = 0, value_name = "N")]
    erasures: u32,

    /// Times that another robot is put in its place; likewise
    #[arg(long, default_value_t = 0, value_name = "N")]
    swaps: u32,

    /// Resets of the robot
    #[arg(long, default_value_t = 50, value_name = "N")]
    resets: u32,

    /// Resets of the robot between two bytes of a record that it writes
    #[arg(long, default_value_t = 0, value_name = "N")]
    cuts: u32,

    /// Unpluggings of the cable
    #[arg(long, default_value_t = 50, value_name = "N")]
    unplugs: u32,

    /// Kills of the host, by SIGKILL
    #[arg(long, default_value_t = 50, value_name = "N")]
    kills: u32,

    /// Divide the throws among settings of all kinds of attacks, each alone and several together
    #[arg(long)]
    settings: bool,

    /// Of the settings, the first
    #[arg(long, default_value_t = 1, value_name = "NUMBER")]
    first: usize,

    /// Of the settings, the last [default: of all]
    #[arg(long, value_name = "NUMBER")]
    last: Option<usize>,

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
    Cut,
    Unplug,
    Kill,
    Pause,
    Erase,
    Swap,
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
        let dir = fs::canonicalize(&dir)?;
        if self.settings {
            return self.through_settings(&program, &dir, seed);
        }
        let bench = self.bench(program, dir, seed);
        let mut record = Table::new("robot soak", &["what", "value"]);
        let mut row = |what: &str, value: String| record.push(vec![what.to_owned(), value]);
        row("throws", self.throws.to_string());
        row("speed", self.speed.to_string());
        row("noise", self.noise.to_string());
        row("hostile", self.hostile.to_string());
        row("forged", self.forged.to_string());
        row("vice", self.vice.to_string());
        row("failing", self.failing.to_string());
        let begun = Instant::now();
        let ordeal = self.endure(&bench)?;
        row("wall_s", format!("{:.1}", begun.elapsed().as_secs_f64()));
        for (what, count) in [
            ("resets", ordeal.resets),
            ("cuts", ordeal.cuts),
            ("unpluggings", ordeal.unplugs),
            ("kills", ordeal.kills),
            ("pauses", ordeal.pauses),
            ("erasures_and_swaps", ordeal.strangers),
            ("halts", ordeal.halts),
            ("test_photos_failed", ordeal.failed_starts),
        ] {
            row(what, count.to_string());
        }
        let audit = bench.audit(self.throws)?;
        row("done", audit.done().to_string());
        for (reason, count) in &audit.voids {
            row(&format!("void {reason}"), count.to_string());
        }
        for (what, value) in audit.frequencies()? {
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

    fn bench(&self, program: PathBuf, dir: PathBuf, seed: u64) -> Bench {
        Bench {
            program,
            dir,
            speed: self.speed,
            noise: self.noise,
            hostile: self.hostile,
            forged: self.forged,
            vice: self.vice,
            failing: self.failing,
            seed,
        }
    }

    /// Runs the experiment through all mishaps to its end.
    fn endure(&self, bench: &Bench) -> anyhow::Result<Ordeal> {
        let mut robot = bench.robot(self.throws)?;
        let mut host = bench.host(self.throws)?;
        let mut ordeal = Ordeal::default();
        // the last throw before a halt, and how many halts there have been since
        let mut strange = (0, 0);
        let mut mishaps = self.schedule(bench.seed).into_iter().peekable();
        loop {
            if let Some(status) = host.0.try_wait()? {
                if status.success() {
                    break;
                }
                // what a person would do: look, and go on
                let said = bench.said();
                let last = last_truth(&bench.truth())?.map_or(0, |truth| truth.throw_id);
                if said.contains("No throw was made") {
                    ordeal.failed_starts += 1;
                    host = bench.resume(&[])?;
                } else if said.contains("--adopt") {
                    // perhaps it was only told so: once more, and if it stays, the robot is a stranger
                    ordeal.halts += 1;
                    strange = if strange.0 == last {
                        (last, strange.1 + 1)
                    } else {
                        (last, 1)
                    };
                    let adopt: &[&str] = if strange.1 > PATIENCE {
                        &["--adopt"]
                    } else {
                        &[]
                    };
                    host = bench.resume(adopt)?;
                } else {
                    bail!("the host ended by itself: {status}\n{said}");
                }
                continue;
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
                Mishap::Cut => {
                    robot.tell("cut")?;
                    ordeal.cuts += 1;
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
                        host = bench.resume(&[])?;
                    }
                }
                Mishap::Pause => {
                    host.signal("STOP")?;
                    thread::sleep(delay * 10);
                    host.signal("CONT")?;
                    ordeal.pauses += 1;
                }
                Mishap::Erase | Mishap::Swap => {
                    robot.tell(if mishap == Mishap::Erase {
                        "erase"
                    } else {
                        "swap"
                    })?;
                    ordeal.strangers += 1;
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
            (self.cuts, Mishap::Cut),
            (self.unplugs, Mishap::Unplug),
            (self.kills, Mishap::Kill),
            (self.pauses, Mishap::Pause),
            (self.erasures, Mishap::Erase),
            (self.swaps, Mishap::Swap),
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
    cuts: u32,
    unplugs: u32,
    kills: u32,
    pauses: u32,
    strangers: u32,
    halts: u32,
    failed_starts: u32,
}
