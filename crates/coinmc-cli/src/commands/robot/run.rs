//! `coinmc robot run` and `resume`: running an experiment.

use super::progress_line::ProgressLine;
use super::{PortArgument, failure, sim};
use crate::exit::{self, Failure, Outcome};
use crate::interrupt;
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::grouped;
use anyhow::anyhow;
use clap::Args;
use coinmc::config::{self, Override};
use coinmc_core::Face;
use coinmc_recording::Encoding;
use coinmc_robot::camera::CameraOptions;
use coinmc_robot::cycle::Rules;
use coinmc_robot::{
    Directory, DirectoryError, Experiment, SessionOptions, SessionReport, Setup, run_session,
};
use serde_json::json;
use std::collections::HashSet;
use std::io::{self, BufRead, IsTerminal, Read};
use std::path::{self, Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  coinmc robot run examples/robot.toml --out day --camera './my-camera'
  coinmc robot resume day

The same command again, or `resume`, continues where the last one stopped, whatever stopped it. Ctrl-C \
finishes the open throw first; a second one sends Stop to the robot, whose motors are off then.

When a person is needed, the command ends with exit status 4 and runs --alert, if given.";

/// Run the experiment that a config describes: throw, photograph and keep a journal
///
/// The config is that of `coinmc run`: the coin, the surface, the distribution of spin and start
/// angle, the engine that the outcome is compared with, and stop.tosses. docs/guide/robot.md
/// describes the journal and the camera's side.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Run {
    /// The config (TOML)
    config: PathBuf,

    /// Directory of the experiment: new, empty, or that of the same experiment
    /// [default: robot-runs/NAME-HASH]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace or add a value of the config; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Override>,

    #[command(flatten)]
    pub(super) session: Session,
}

/// Continue an experiment
///
/// Port and camera are those of the last session unless given. The stored camera is a shell command: it
/// is shown, and runs only if you agree at the terminal or give it again with --camera.
#[derive(Debug, Args)]
pub(super) struct Resume {
    /// Directory of the experiment
    #[arg(value_name = "DIR")]
    directory: PathBuf,

    #[command(flatten)]
    pub(super) session: Session,
}

/// Arguments of both.
#[derive(Debug, Args)]
pub(super) struct Session {
    #[command(flatten)]
    port: PortArgument,

    /// The camera: a shell command that speaks JSON lines (docs/guide/robot.md)
    #[arg(long, value_name = "COMMAND")]
    camera: Option<String>,

    /// Time limit for a photo, seconds
    #[arg(long, value_name = "S", default_value_t = 8,
          value_parser = clap::value_parser!(u64).range(1..=3600))]
    camera_timeout: u64,

    /// Photos of one throw without a face before the throw is void
    #[arg(long, value_name = "N", default_value_t = 3,
          value_parser = clap::value_parser!(u32).range(1..=100))]
    photos: u32,

    /// Consecutive void throws before the experiment stops
    #[arg(long, value_name = "N", default_value_t = 10,
          value_parser = clap::value_parser!(u32).range(1..))]
    max_voids: u32,

    /// Consecutive failures of the camera before the experiment stops
    #[arg(long, value_name = "N", default_value_t = 5,
          value_parser = clap::value_parser!(u32).range(1..=1000))]
    max_camera_failures: u32,

    /// Greatest difference of the measured spin from the one asked for, rev/s; beyond it a throw is void
    #[arg(long, value_name = "REV_S", default_value_t = 0.2, value_parser = tolerance)]
    spin_tolerance: f64,

    /// Greatest difference of the measured start angle from the one asked for, degrees
    #[arg(long, value_name = "DEG", default_value_t = 5.0, value_parser = tolerance)]
    angle_tolerance: f64,

    /// Take the robot over as it is: if its counter is ahead of the journal, or if it is another robot
    /// or has forgotten the experiment. An open throw becomes void
    #[arg(long)]
    adopt: bool,

    /// Wait for a port that is not there yet, seconds [without a number: for ever]
    #[arg(long, value_name = "S", num_args = 0..=1, require_equals = true, default_missing_value = "4294967295")]
    wait: Option<u32>,

    /// Without any progress for this long the experiment halts, minutes
    #[arg(long, value_name = "MIN", default_value_t = 10,
          value_parser = clap::value_parser!(u64).range(1..=10_000))]
    stall: u64,

    /// A shell command to run when the experiment halts or fails; it finds the reason in COINMC_ALERT
    #[arg(long, value_name = "COMMAND")]
    alert: Option<String>,

    /// Free disk space below which no throw begins, MiB
    #[arg(long, value_name = "MIB", default_value_t = 64,
          value_parser = clap::value_parser!(u64).range(0..=1 << 40))]
    min_free: u64,

    /// Speed of a simulated robot relative to real time
    #[arg(long, value_name = "FACTOR", value_parser = sim::speed)]
    speed: Option<f64>,

    /// Do not record the session (MCAP)
    #[arg(long)]
    no_recording: bool,

    /// Encoding of the recording: protobuf or json
    #[arg(
        long,
        value_name = "HOW",
        default_value_t,
        conflicts_with = "no_recording"
    )]
    encoding: Encoding,

    /// Format of the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub(super) format: Format,

    /// Hide the status line and notes; warnings and errors are still shown
    #[arg(long, short)]
    quiet: bool,
}

impl Run {
    pub(super) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let plan = config::load(&self.config, &self.overrides)?;
        let out = self.out.clone().unwrap_or_else(|| {
            let stem = self.config.file_stem();
            let stem = stem.map_or("experiment".into(), |stem| stem.to_string_lossy());
            Path::new("robot-runs").join(format!("{stem}-{}", &plan.hash()[..8]))
        });
        let experiment = Experiment::new(plan).map_err(|e| Failure::Input(e.into()))?;
        self.session
            .execute(&experiment, &Directory::at(&out), console)
    }
}

impl Resume {
    pub(super) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let directory = Directory::at(&self.directory);
        let experiment = directory.experiment().map_err(failure)?;
        if !directory.journal().exists() {
            return Err(failure(DirectoryError::Missing(self.directory.clone())));
        }
        self.session.execute(&experiment, &directory, console)
    }
}

impl Session {
    fn execute(
        &self,
        experiment: &Experiment,
        directory: &Directory,
        console: &Console,
    ) -> Result<Outcome, Failure> {
        let setup = self.setup(directory)?;
        let line = ProgressLine::new(*console.stderr(), self.quiet);
        let (journal, torn) = directory.open(experiment, &setup).map_err(failure)?;
        directory.note_host().map_err(failure)?;
        if torn > 0 {
            line.print(&format!(
                "the last line of {} was incomplete ({torn} bytes) and has been removed",
                directory.journal().display()
            ));
        }
        let (cancel, stop) = interrupt::listen_twice(
            || output::note("finishing the open throw; Ctrl-C again sends Stop to the robot"),
            || output::note("sending Stop to the robot; Ctrl-C again ends this program at once"),
        )?;
        let report = run_session(
            experiment,
            directory,
            journal,
            &SessionOptions {
                port: &setup.port,
                camera: self.camera_options(&setup, directory),
                rules: self.rules(experiment),
                speed: setup.speed,
                record: (!self.no_recording).then_some(self.encoding),
                cancel,
                stop,
                wait: self.wait.map(|s| Duration::from_secs(s.into())),
                stall: Duration::from_secs(self.stall * 60),
                min_free: self.min_free << 20,
                sink: &line,
            },
        );
        line.finish();
        let report = report.map_err(|error| {
            let failure = failure(error);
            alert(self.alert.as_deref(), &failure);
            failure
        })?;
        if let Some(confirmed) = report.stopped {
            output::note(if confirmed {
                "the robot has stopped: its motors are off"
            } else {
                "the robot has not answered Stop; without its host its motors are off within 5 s"
            });
        }
        self.present(&report, directory, console)
            .map_err(|error| Failure::Runtime(error.into()))?;
        Ok(if report.complete {
            Outcome::Done
        } else {
            Outcome::Interrupted
        })
    }

    fn camera_options(&self, setup: &Setup, directory: &Directory) -> CameraOptions {
        let absolute = |path: PathBuf| path::absolute(&path).unwrap_or(path);
        CameraOptions {
            command: setup.camera.clone(),
            folder: absolute(directory.photos()),
            log: Some(directory.camera_log()),
            timeout: Duration::from_secs(self.camera_timeout),
            seen: HashSet::new(),
        }
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // `tolerance` bounds both
    fn rules(&self, experiment: &Experiment) -> Rules {
        Rules {
            throws: experiment.throws(),
            // the journal has it
            experiment: 0,
            reach: experiment.reach(),
            spin_tolerance_mrev_s: (self.spin_tolerance * 1e3) as u16,
            angle_tolerance_cdeg: (self.angle_tolerance * 1e2) as u16,
            max_photos: self.photos,
            max_camera_failures: self.max_camera_failures,
            max_voids: self.max_voids,
            adopt: self.adopt,
        }
    }

    /// Port and camera: as given, otherwise those of the last session.
    fn setup(&self, directory: &Directory) -> Result<Setup, Failure> {
        let last = directory.setup();
        let camera = match (&self.camera, &last) {
            (Some(camera), _) => camera.clone(),
            (None, Some(last)) => agreed(&last.camera, directory)?,
            (None, None) => {
                return Err(Failure::Input(anyhow!(
                    "no camera: give the command that takes and reads photos with --camera \
                     (docs/guide/robot.md describes its protocol)"
                )));
            }
        };
        let port = match (&self.port.port, &last) {
            (None, Some(last)) => last.port.clone(),
            _ => self.port.port()?,
        };
        let speed = self.speed.or(last.map(|last| last.speed)).unwrap_or(1.0);
        Ok(Setup {
            port,
            camera,
            speed,
        })
    }

    fn present(
        &self,
        report: &SessionReport,
        directory: &Directory,
        console: &Console,
    ) -> std::io::Result<()> {
        let (progress, trips) = (&report.progress, &report.round_trips);
        let mean_ms = trips.sum.as_secs_f64() * 1e3 / (trips.count.max(1) as f64);
        let longest_ms = trips.longest.as_secs_f64() * 1e3;
        let faces = Face::ALL.iter().zip(progress.faces);
        if console.format() == Format::Json {
            return output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "robot-run",
                "complete": report.complete,
                "out": directory.path().to_string_lossy(),
                "planned": progress.planned,
                "heads": progress.faces[0],
                "tails": progress.faces[1],
                "side": progress.faces[2],
                "void": progress.voids,
                "losses_of_the_line": progress.losses,
                "round_trip_ms": { "mean": mean_ms, "longest": longest_ms, "count": trips.count },
                "frames": {
                    "sent": report.counters.sent,
                    "repeated": report.counters.repeated,
                    "rejected": report.counters.rejected,
                    "ignored": report.counters.ignored,
                },
            }));
        }
        let counts: Vec<String> = faces
            .map(|(face, count)| format!("{} {}", grouped(u64::from(count)), face.name()))
            .collect();
        output::print(&format!(
            "{} of {} throws: {}, {} void\n",
            grouped(u64::from(progress.resolved())),
            grouped(u64::from(progress.planned)),
            counts.join(", "),
            grouped(u64::from(progress.voids)),
        ))?;
        if !self.quiet {
            output::note(&format!(
                "coinmc: {} throws in this session; replies took {mean_ms:.1} ms on average, \
                 {longest_ms:.1} ms at most",
                grouped(u64::from(progress.this_session))
            ));
            let dir = directory.path().display();
            output::note(&if report.complete {
                format!("Next: coinmc robot export {dir}; coinmc robot fairness {dir}")
            } else {
                format!("Continue with: coinmc robot resume {dir}")
            });
        }
        Ok(())
    }
}

/// The stored command, if the user agrees to run it: a directory may come from anywhere.
fn agreed(camera: &str, directory: &Directory) -> Result<String, Failure> {
    let path = directory.path().display();
    output::note(&format!(
        "{path} names this command as its camera:\n  {camera}"
    ));
    if !io::stdin().is_terminal() {
        return Err(Failure::Input(anyhow!(
            "a stored command does not run unseen: give the camera again with --camera"
        )));
    }
    output::note("Run it? [y/N]");
    let mut answer = String::new();
    let read = io::stdin().lock().take(100).read_line(&mut answer);
    if read.is_ok() && matches!(answer.trim(), "y" | "Y" | "yes") {
        return Ok(camera.to_owned());
    }
    Err(Failure::Input(anyhow!(
        "not run: give the camera with --camera"
    )))
}

/// Runs the command for a person to come, with the reason in its environment.
fn alert(command: Option<&str>, failure: &Failure) {
    let (Some(command), Failure::Halted(error) | Failure::Runtime(error) | Failure::Input(error)) =
        (command, failure)
    else {
        return;
    };
    let ended = Command::new("sh")
        .args(["-c", command])
        .env("COINMC_ALERT", exit::words(error))
        .stdin(Stdio::null())
        .status();
    match ended {
        Ok(status) if status.success() => {}
        Ok(status) => output::note(&format!("the command of --alert failed: {status}")),
        Err(error) => output::note(&format!("the command of --alert failed: {error}")),
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..=60.0).contains(&value) => Ok(value),
        _ => Err("a tolerance is a number from 0 to 60".to_owned()),
    }
}
