//! Standard output holds results and nothing else, and may go away.

use coinmc_tests::{command, snapshot};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
#[cfg(target_os = "linux")]
use std::{
    thread,
    time::{Duration, Instant},
};

const CONFIG: &str = "\
[coin]
ratio = { from = 0.5, to = 2.0, steps = 4 }
[surface]
restitution = [0.2, 0.6]
friction = 0.3
[launch]
preset = \"robot\"
[engine.flat]
[stop]
tosses = 20_000
";

fn bench(config: &str) -> tempfile::TempDir {
    let dir = tempfile::tempdir().expect("a temporary directory");
    fs::write(dir.path().join("toss.toml"), config).expect("the config can be written");
    dir
}

fn coinmc(dir: &Path, arguments: &[&str]) -> Output {
    command(dir)
        .args(arguments)
        .output()
        .expect("coinmc starts")
}

/// Standard output as the one JSON document it must be.
fn document(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| panic!("{error}: {}", String::from_utf8_lossy(&output.stdout)))
}

/// A batch system's log shows it, too.
#[test]
fn what_a_long_run_has_shown_is_told_within_two_seconds() {
    let dir = bench(CONFIG);
    let arguments = [
        "run",
        "toss.toml",
        "--set",
        "stop.tosses=1e10",
        "--max-time",
        "2s",
    ];
    let output = coinmc(dir.path(), &arguments);
    assert_eq!(output.status.code(), Some(3));
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    let lines = told.lines().filter(|line| line.ends_with(" left"));
    let [line] = lines.collect::<Vec<_>>()[..] else {
        panic!("one line of progress: {told}");
    };
    let parts: Vec<_> = line.split("  ").collect();
    let [points, tosses, rate, probability, worst, left] = parts[..] else {
        panic!("{line}");
    };
    assert_eq!(points, "coinmc: 0/8 points");
    assert!(
        tosses.ends_with(" tosses") && !tosses.starts_with("0 "),
        "{line}"
    );
    assert!(
        rate.ends_with("/s") && worst.starts_with("worst ±"),
        "{line}"
    );
    assert!(
        probability.starts_with("P(side) 0.")
            && probability.contains("] at ratio 0.5, restitution 0."),
        "{line}"
    );
    assert!(left.ends_with(" d left") || left.contains(" h "), "{line}");
    // and not where it is not wanted
    let again = [&arguments[..], &["--quiet"]].concat();
    let output = coinmc(dir.path(), &again);
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

#[test]
fn a_result_is_one_json_document() {
    let dir = bench(CONFIG);
    let output = coinmc(
        dir.path(),
        &["run", "toss.toml", "--format", "json", "--quiet"],
    );
    assert_eq!(output.status.code(), Some(0));
    assert!(
        output.stderr.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let document = document(&output);
    assert_eq!(
        (&document["format_version"], &document["kind"]),
        (&1.into(), &"run".into())
    );
    assert_eq!(document["status"], "complete");
    let hash = document["plan_hash"].as_str().expect("a hash");
    assert_eq!(document["out"], format!("runs/toss-{}", &hash[..8]));
    let rows = document["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 8);
    for row in rows {
        let number = |name: &str| {
            row[name]
                .as_f64()
                .unwrap_or_else(|| panic!("{name}: {row}"))
        };
        assert_eq!(number("tosses"), 20_000.0);
        let sum = number("heads") + number("tails") + number("side") + number("undecided");
        assert_eq!(sum, 20_000.0);
        assert!(number("p_side_lo") <= number("p_side") && number("p_side") <= number("p_side_hi"));
    }
    for fair in document["fair_ratios"].as_array().expect("fair ratios") {
        assert!(
            fair["at"]["restitution"].is_number() && fair["ratio"].is_number(),
            "{fair}"
        );
    }
}

/// A page that cannot be made is told before anything is tossed, or in place of the result: under a name that is too long for
/// any file system.
#[test]
fn a_page_that_cannot_be_made_is_one_json_document_too() {
    let dir = bench(CONFIG);
    let too_long = format!("{}.html", "x".repeat(300));
    for (page, code) in [("nowhere/page.html", 2), (too_long.as_str(), 1)] {
        let report = format!("--report={page}");
        let arguments = ["run", "toss.toml", "--format", "json", "--quiet", &report];
        let output = coinmc(dir.path(), &arguments);
        assert_eq!(output.status.code(), Some(code));
        assert_eq!(document(&output)["kind"], "error");
        assert_eq!(dir.path().join("runs").exists(), code == 1);
    }
}

#[test]
fn problems_are_one_json_document_too() {
    let dir = bench("sede = 1\n[coin]\nratio = -1\n");
    for verb in ["run", "check"] {
        let output = coinmc(dir.path(), &[verb, "toss.toml", "--format", "json"]);
        assert_eq!(output.status.code(), Some(2));
        let document = document(&output);
        assert_eq!(document["kind"], "problems");
        let problems = document["problems"].as_array().expect("problems");
        assert!(problems.len() >= 2, "{problems:?}");
        let first = &problems[0];
        assert_eq!((&first["line"], &first["column"]), (&1.into(), &1.into()));
        assert!(first["file"] == "toss.toml" && first["message"].is_string());
    }
    let output = coinmc(
        dir.path(),
        &["merge", "nowhere", "--out", "x", "--format", "json"],
    );
    assert_eq!(document(&output)["kind"], "error");
    assert_eq!(
        snapshot(dir.path()).len(),
        1,
        "bad input leaves nothing behind"
    );
}

#[test]
fn a_half_width_out_of_reach_exits_3() {
    let dir = bench(&CONFIG.replace("tosses = 20_000", "half_width = 1e-4\nmax_tosses = 20_000"));
    let output = coinmc(dir.path(), &["run", "toss.toml", "--format", "json"]);
    assert_eq!(
        output.status.code(),
        Some(3),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(document(&output)["status"], "short_of_target");
    assert!(String::from_utf8_lossy(&output.stderr).contains("stop.max_tosses"));
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let dir = bench(CONFIG);
    for arguments in [
        &["run", "toss.toml"][..],
        &["schema"],
        &["completions", "bash"],
        &["analytic", "--ratio", "1", "--format", "csv"],
    ] {
        let mut child = command(dir.path())
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("coinmc starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("coinmc ends");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {stderr}");
        assert!(!stderr.contains("panic"), "{stderr}");
    }
}

#[test]
fn a_closed_standard_error_is_no_error() {
    let dir = bench(CONFIG);
    let run = command(dir.path());
    let output = Command::new("sh")
        .args(["-c", "exec \"$0\" run toss.toml 2>&-"])
        .arg(run.get_program())
        .current_dir(dir.path())
        .output()
        .expect("sh starts");
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&output.stdout).contains("P(side)"));
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_standard_output_is_an_error() {
    let dir = bench(CONFIG);
    let full = fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .expect("Linux has it");
    let output = command(dir.path())
        .args(["analytic", "--fair"])
        .stdout(full)
        .stderr(Stdio::piped())
        .output()
        .expect("coinmc starts");
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("error:"));
}

#[test]
fn colour_is_only_where_it_is_asked_for() {
    let dir = bench(CONFIG);
    let escape = |arguments: &[&str]| coinmc(dir.path(), arguments).stdout.contains(&0x1b);
    assert!(!escape(&["run", "toss.toml"]));
    assert!(escape(&["run", "toss.toml", "--color", "always"]));
}

#[test]
fn nothing_is_wider_than_the_terminal_and_the_c_locale_gets_ascii() {
    let dir = bench(CONFIG);
    for width in ["60", "80", "140"] {
        let output = command(dir.path())
            .args(["run", "toss.toml", "--out", "a"])
            .env("COLUMNS", width)
            .output()
            .expect("coinmc starts");
        let most: usize = width.parse().expect("a number");
        for line in String::from_utf8_lossy(&output.stdout).lines() {
            assert!(line.chars().count() <= most, "{width}: {line}");
        }
    }
    for arguments in [
        &["run", "toss.toml", "--out", "a"][..],
        &["analytic"],
        &["check", "toss.toml"],
    ] {
        let output = command(dir.path())
            .args(arguments)
            .env("LC_ALL", "C")
            .output();
        let stdout = output.expect("coinmc starts").stdout;
        assert!(
            stdout.is_ascii(),
            "{arguments:?}: {}",
            String::from_utf8_lossy(&stdout)
        );
    }
}

/// What a config or an argument can get wrong: exit status 2, and nothing on the disk.
#[test]
fn bad_input_exits_2_and_leaves_nothing_behind() {
    let bad = [
        "coin.ratio=0",
        "coin.ratio=nan",
        "coin.ratio=[]",
        "coin.ratio=[1.0, 1.0]",
        "coin.ratio={from=2, to=1, steps=3}",
        "coin.ratio={from=1, to=2, steps=1_000_000_000_000}",
        "coin.radius_m=-1",
        "coin.radius_m=inf",
        "surface.restitution=1.5",
        "surface.restitution=\"0.5\"",
        "surface.friktion=0.1",
        "seed=-1",
        "seed=99999999999999999999",
        "stop.tosses=0",
        "launch.preset=robt",
        "engine.flat.law=newton",
        "engine.analytic.rule=arc",
    ];
    let dir = bench(CONFIG);
    for set in bad {
        let output = coinmc(dir.path(), &["run", "toss.toml", "--set", set]);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{set}: {stderr}");
        assert!(
            !stderr.contains("panicked") && stderr.contains("error"),
            "{set}: {stderr}"
        );
    }
    fs::write(dir.path().join("bytes.toml"), [0xff, 0xfe, 0x00]).expect("a file");
    for arguments in [
        &["run", "bytes.toml"][..],
        &["run", "nothing.toml"],
        &["run", "."],
        &["run", "toss.toml", "--set", "ratio"],
        &["run", "toss.toml", "--shard", "3/2"],
        &["run", "toss.toml", "--shard", "0/2"],
        &["run", "toss.toml", "--threads", "0"],
        &["run", "toss.toml", "--threads", "100000"],
        &["run"],
        &["toss"],
        &["analytic", "--ratio", "-1"],
        &["analytic", "--ratio", "nan"],
        &["analytic", "--rule", "ark"],
        &["analytic", "--fair", "--target", "2"],
        &["analytic", "--psi-deg", "181"],
        &["analytic", "--speed", "1"],
        &["merge", "--out", "x"],
    ] {
        let output = coinmc(dir.path(), arguments);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert!(!stderr.contains("panicked"), "{arguments:?}: {stderr}");
    }
    assert_eq!(snapshot(dir.path()).len(), 2);
}

/// What `SigCgt` of a process says of SIGINT in `/proc`.
#[cfg(target_os = "linux")]
fn listens(id: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
    let mask = caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask & 0b10 != 0)
}

/// What a question that takes far too long has printed after Ctrl-C.
#[cfg(target_os = "linux")]
fn interrupted(dir: &Path, arguments: &[&str]) -> Output {
    let mut asking = command(dir);
    asking.args(arguments);
    asking.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = asking.spawn().expect("coinmc starts");
    let start = Instant::now();
    while !listens(child.id()) {
        assert!(start.elapsed() < Duration::from_mins(1), "{arguments:?}");
        thread::sleep(Duration::from_millis(10));
    }
    let signal = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(signal.expect("kill starts").success());
    child.wait_with_output().expect("coinmc ends")
}

#[cfg(target_os = "linux")]
#[test]
fn a_question_that_is_stopped_is_one_json_document() {
    let one_point = CONFIG
        .replace("{ from = 0.5, to = 2.0, steps = 4 }", "1.0")
        .replace("[0.2, 0.6]", "0.5");
    let dir = bench(&one_point);
    for words in [
        "fair toss.toml --half-width 1e-9 --max-tosses 1e12",
        "sensitivity toss.toml --tosses 1e9",
        "rare toss.toml --relative-error 1e-5 --max-tosses 1e12",
        "aim toss.toml --over launch.height_m=0.1..1 --tosses 1e8",
        "ask --ratio 1 --sure --tosses 1e9",
        "validate --full --out validation",
        "converge toss.toml --tosses 1e9",
        "trace map toss.toml --set surface.restitution=0.99 --over wy_rad_s=0..60:100 --over height_m=1..9:100 -o map.html",
    ] {
        let words: Vec<&str> = words.split(' ').collect();
        let json = [&words[..], &["--format", "json", "--quiet"]].concat();
        let output = interrupted(dir.path(), &json);
        assert_eq!(output.status.code(), Some(130), "{words:?}");
        let document = document(&output);
        assert_eq!(document["kind"], "error", "{words:?}");
        assert_eq!(document["exit_code"], 130);
        assert_eq!(
            document["message"],
            "stopped by Ctrl-C or SIGTERM before there was an answer"
        );
        let text = interrupted(dir.path(), &words);
        assert_eq!(text.status.code(), Some(130), "{words:?}");
        assert!(text.stdout.is_empty(), "{words:?}");
    }
    assert!(!dir.path().join("map.html").exists());
}

/// A forecast that is stopped while it makes its trial tosses.
#[cfg(target_os = "linux")]
#[test]
fn a_check_that_is_stopped_is_one_json_document() {
    let dir = bench(CONFIG);
    let many = "coin.ratio={from=0.5,to=2.0,steps=200000}";
    let output = interrupted(
        dir.path(),
        &["check", "toss.toml", "--set", many, "--format", "json"],
    );
    assert_eq!(output.status.code(), Some(130));
    assert_eq!(document(&output)["exit_code"], 130);
}
