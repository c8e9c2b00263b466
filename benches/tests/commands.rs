//! Every command finishes at a small size, and its CSV file holds the expected rows.

use coinmc_testkit::study::Program;

const BENCH: Program = Program(env!("CARGO_BIN_EXE_coinmc-bench"));

#[test]
fn speed_is_measured_and_memory_does_not_grow() {
    let sizes = [
        "--tosses",
        "500",
        "--repeats",
        "1",
        "--memory-tosses",
        "200000",
    ];
    let lines = BENCH.study(&[&["speed"], &sizes[..]].concat());
    let memory: Vec<f64> = lines
        .lines()
        .iter()
        .filter(|line| line.starts_with("peak memory"))
        .map(|line| line.split(',').next_back().unwrap().parse().unwrap())
        .collect();
    assert!(
        memory.len() == 2 && memory[1] < memory[0] + 10.0,
        "{memory:?}"
    );
}

#[test]
fn work_is_listed_and_unknown_work_refused() {
    let output = BENCH.execute(&["work"]);
    let names = String::from_utf8(output.stdout).unwrap();
    assert!(names.lines().count() > 10);
    for name in names.lines() {
        assert!(
            BENCH
                .execute(&["work", name, "--count", "3"])
                .status
                .success(),
            "{name}"
        );
    }
    let output = BENCH.execute(&["work", "nothing"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && message.contains("no piece of work is called `nothing`"));
}

#[test]
fn whole_runs_are_timed_over_threads_and_tosses() {
    for toss in ["flat", "space"] {
        let size = ["--tosses", "2000", "--repeats", "1", "--most", "10000"];
        let lines = BENCH.study(&[&["scaling", "--toss", toss], &size[..]].concat());
        assert!(
            lines
                .numbers("tosses_a_processor_second")
                .iter()
                .all(|rate| *rate > 100.0)
        );
        let peak = lines.numbers("peak_mib");
        assert!(
            peak.iter().all(|mib| (1.0..200.0).contains(mib)),
            "{peak:?}"
        );
        assert_eq!(lines.column("tosses").last(), Some(&"10000"));
    }
}

#[test]
fn all_lanes_have_a_rate() {
    for (toss, cases) in [("flat", 12), ("space", 30)] {
        let size = ["--toss", toss, "--tosses", "50", "--repeats", "1"];
        let lines = BENCH.study(&[&["lanes"], &size[..]].concat());
        let kinds = lines.column("lanes");
        assert_eq!(kinds[0], "scalar");
        assert!(kinds.len() >= cases && kinds.len().is_multiple_of(cases));
        let of_scalar = lines.numbers("of_scalar");
        assert!(of_scalar.iter().all(|ratio| *ratio > 0.0));
    }
}

#[test]
fn skipping_saves_steps() {
    let lines = BENCH.study(&["rapier-speed", "--tosses", "3", "--clean-step", "4e-3"]);
    let saved: f64 = lines
        .column("ratio_of_steps")
        .iter()
        .map(|ratio| ratio.parse::<f64>().unwrap())
        .fold(0.0, f64::max);
    assert!(saved > 5.0, "{saved}");
}
