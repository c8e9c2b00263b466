//! A run that is stopped, by whatever, goes on and ends in the same bytes.

use coinmc_core::Philox4x64;
use coinmc_tests::{command, snapshot};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use std::{env, fs, thread};
use tempfile::TempDir;

/// Long enough (about a second) to be killed in the middle, with 35 chunks.
const CONFIG: &str = "\
seed = 11
[coin]
ratio = { from = 0.6, to = 1.8, steps = 7 }
[surface]
restitution = 0.4
friction = 0.3
[launch]
preset = \"robot\"
[engine.flat]
[stop]
tosses = 80_000
";

/// The same in space, with 10 chunks.
const IN_SPACE: &str = "\
seed = 11
[coin]
ratio = [0.85, 2.0]
[surface]
restitution = 0.5
friction = 0.3
rolling_friction_m = 1e-4
pivoting_friction_m = 1e-4
[launch]
preset = \"clean\"
[engine.volumetric]
[stop]
tosses = 160_000
";

struct Bench {
    dir: TempDir,
    config: PathBuf,
}

impl Bench {
    fn new() -> Self {
        Self::of(CONFIG)
    }

    fn of(text: &str) -> Self {
        let dir = tempfile::tempdir().expect("a temporary directory");
        let config = dir.path().join("config.toml");
        fs::write(&config, text).expect("the config can be written");
        Self { dir, config }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    fn run(&self, out: &Path) -> Command {
        let mut command = command(self.dir.path());
        command.arg("run").arg(&self.config).arg("--out").arg(out);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn finish(&self, out: &Path) -> Output {
        let output = self.run(out).output().expect("coinmc starts");
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        output
    }

    /// An uninterrupted run.
    fn reference(&self) -> PathBuf {
        let out = self.path("reference");
        self.finish(&out);
        out
    }
}

/// Chunks that a run directory holds.
fn chunks(out: &Path) -> u64 {
    let text = fs::read_to_string(out.join("tallies.txt")).unwrap_or_default();
    text.matches("\ncrc32 ").count() as u64
}

/// Waits until a running process has finished so many chunks, or has ended.
fn wait_for(chunks_done: u64, out: &Path, child: &mut Child) {
    let ended = |child: &mut Child| child.try_wait().expect("the child can be asked").is_some();
    while chunks(out) < chunks_done && !ended(child) {
        thread::sleep(Duration::from_micros(500));
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Both directories hold the same files with the same bytes.
fn assert_same(one: &Path, other: &Path, why: &str) {
    let (one, other) = (snapshot(one), snapshot(other));
    assert_eq!(
        one.keys().collect::<Vec<_>>(),
        other.keys().collect::<Vec<_>>(),
        "{why}"
    );
    for (name, bytes) in &one {
        assert!(other[name] == *bytes, "{why}: {} differs", name.display());
    }
}

/// A random number for each kill, the same in every test run.
fn drawn(kill: u64, what: u64) -> u64 {
    Philox4x64::new([2026, 0]).block([what, kill, 0, 0])[0]
}

fn send(signal: &str, id: u32) {
    let status = Command::new("kill")
        .args([signal, &id.to_string()])
        .status();
    assert!(status.expect("kill starts").success());
}

#[test]
fn a_killed_run_ends_in_the_same_bytes() {
    killed_runs_end_in_the_same_bytes(CONFIG);
}

#[test]
fn a_killed_run_in_space_ends_in_the_same_bytes() {
    killed_runs_end_in_the_same_bytes(IN_SPACE);
}

/// The instant of each kill is drawn as a number of finished chunks and some milliseconds more, so
/// that it falls into start, work or end of the run however fast the machine is.
fn killed_runs_end_in_the_same_bytes(config: &str) {
    let kills: u64 = env::var("COINMC_KILLS").map_or(10, |n| n.parse().expect("a number"));
    let bench = Bench::of(config);
    let reference = bench.reference();
    let all = chunks(&reference);
    let (mut n, mut run, mut hits) = (0, 0, 0);
    while n < kills {
        let out = bench.path(&format!("run-{run}"));
        // Once, twice or three times in a row.
        for _ in 0..=run % 3 {
            let mut quiet = bench.run(&out);
            quiet.stdout(Stdio::null()).stderr(Stdio::null());
            let there = chunks(&out);
            let mut child = quiet.spawn().expect("coinmc starts");
            wait_for(there + drawn(n, 0) % (all + 1 - there), &out, &mut child);
            thread::sleep(Duration::from_micros(drawn(n, 1) % 20_000));
            hits += u64::from(child.try_wait().expect("the child can be asked").is_none());
            // SIGKILL
            child.kill().expect("the child can be killed");
            child.wait().expect("the child ends");
            n += 1;
        }
        bench.finish(&out);
        assert_same(&reference, &out, &format!("run {run}, after {n} kills"));
        fs::remove_dir_all(&out).expect("the run can be removed");
        run += 1;
    }
    println!("{hits} of {n} kills hit a running process");
    assert!(hits * 2 > n, "only {hits} of {n} kills came in time");
}

#[test]
fn ctrl_c_and_termination_say_how_to_go_on() {
    let bench = Bench::new();
    let reference = bench.reference();
    for signal in ["-INT", "-TERM"] {
        let out = bench.path(&format!("stopped{signal}"));
        let mut child = bench
            .run(&out)
            .args(["--threads", "1"])
            .spawn()
            .expect("coinmc starts");
        wait_for(3, &out, &mut child);
        send(signal, child.id());
        let start = Instant::now();
        let output = child.wait_with_output().expect("coinmc ends");
        assert!(
            start.elapsed() < Duration::from_secs(2),
            "it took {:?}",
            start.elapsed()
        );
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(130), "{signal}: {stderr}");
        assert!(stderr.contains("of 7 points finished"), "{stderr}");
        let (_, again) = stderr
            .split_once("Go on with: ")
            .expect("the command to go on");
        assert!(out.join("results.partial.csv").exists());
        assert!(!out.join("results.csv").exists());
        // The very command that was given, through a shell.
        let output = Command::new("sh")
            .args(["-c", again.trim()])
            .current_dir(bench.dir.path())
            .output()
            .expect("sh starts");
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        assert_same(&reference, &out, signal);
    }
}

/// A hang-up stops a run like Ctrl-C, and not at all one that was started to survive it, as by `nohup`.
#[cfg(target_os = "linux")]
#[test]
fn a_run_survives_a_hang_up_that_it_was_told_to_ignore() {
    let bench = Bench::new();
    let reference = bench.reference();
    for (trap, code) in [("trap '' HUP; ", 0), ("", 130)] {
        let out = bench.path(&format!("hung-up-{code}"));
        let run = bench.run(&out);
        let mut shell = Command::new("sh");
        shell
            .args(["-c", &format!("{trap}exec \"$0\" \"$@\"")])
            .arg(run.get_program())
            .args(run.get_args())
            .args(["--threads", "1"])
            .current_dir(bench.dir.path())
            .stderr(Stdio::piped());
        let mut child = shell.spawn().expect("sh starts");
        wait_for(3, &out, &mut child);
        send("-HUP", child.id());
        let output = child.wait_with_output().expect("coinmc ends");
        assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
    }
    assert_same(&reference, &bench.path("hung-up-0"), "after a hang-up");
}

#[test]
fn a_finished_run_is_reported_again_at_once() {
    let bench = Bench::new();
    let out = bench.path("out");
    let first = bench.finish(&out);
    let before = snapshot(&out);
    let again = bench.finish(&out);
    assert_eq!(text(&first.stdout), text(&again.stdout));
    assert!(
        text(&again.stderr).contains("nothing to toss"),
        "{}",
        text(&again.stderr)
    );
    assert!(before == snapshot(&out));
}

#[test]
fn damaged_tallies_are_tossed_again_with_a_warning() {
    let bench = Bench::new();
    let reference = bench.reference();
    let out = bench.path("out");
    bench.finish(&out);
    let place = out.join("tallies.txt");
    let mut tallies = fs::read(&place).expect("tallies");
    // a digit in one tally, and a letter of a word in another
    let all = tallies.len();
    for at in [all / 4, 3 * all / 4] {
        tallies[at] ^= 1;
    }
    fs::write(&place, &tallies).expect("they can be altered");
    let output = bench.finish(&out);
    assert_eq!(
        text(&output.stderr).matches("warning:").count(),
        2,
        "{}",
        text(&output.stderr)
    );
    assert_eq!(
        fs::read(reference.join("results.csv")).expect("results"),
        fs::read(out.join("results.csv")).expect("results")
    );
}

#[test]
fn the_directory_of_another_run_is_refused_and_left_alone() {
    let bench = Bench::new();
    let out = bench.path("out");
    bench.finish(&out);
    let before = snapshot(&out);
    for change in ["seed=12", "surface.friction=0.2", "stop.tosses=79999"] {
        let output = bench
            .run(&out)
            .args(["--set", change])
            .output()
            .expect("coinmc starts");
        assert_eq!(output.status.code(), Some(2), "{change}");
        assert!(
            text(&output.stderr).contains("another plan"),
            "{}",
            text(&output.stderr)
        );
        assert!(before == snapshot(&out), "{change}");
    }
    let stranger = bench.path("stranger");
    fs::create_dir(&stranger).expect("a folder");
    fs::write(stranger.join("thesis.tex"), "years of work").expect("a file");
    let before = snapshot(&stranger);
    let output = bench.run(&stranger).output().expect("coinmc starts");
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(before == snapshot(&stranger));
}

/// `ulimit -f` makes writes beyond so many bytes fail; with SIGXFSZ ignored they fail as on a full
/// disk, with an error instead of a signal.
#[test]
fn a_full_disk_is_a_clear_error_and_the_run_goes_on_later() {
    let bench = Bench::new();
    let reference = bench.reference();
    for blocks in [0, 1, 4] {
        let out = bench.path(&format!("full-{blocks}"));
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
        let run = bench.run(&out);
        let output = Command::new("sh")
            .args(["-c", &script, "sh"])
            .arg(run.get_program())
            .args(run.get_args())
            .current_dir(bench.dir.path())
            .output()
            .expect("sh starts");
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{blocks}: {stderr}");
        assert!(stderr.contains("no space left"), "{blocks}: {stderr}");
        bench.finish(&out);
        assert_same(&reference, &out, &format!("{blocks} blocks"));
    }
}
