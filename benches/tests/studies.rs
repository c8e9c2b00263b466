//! Every command runs to its end at a small size, and its file holds what was asked for.

use std::process::{Command, Output};

fn coinmc_bench(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_coinmc-bench"))
        .args(arguments)
        .output()
        .unwrap()
}

/// Runs a study and returns its CSV, line by line.
fn study(arguments: &[&str]) -> Vec<String> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("study.csv");
    let mut all = vec!["--csv", path.to_str().unwrap()];
    all.extend(arguments);
    let output = coinmc_bench(&all);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    assert!(output.stdout.len() > 200, "{arguments:?} says nothing");
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// The column of this name, below its title.
fn column<'a>(lines: &'a [String], name: &str) -> Vec<&'a str> {
    let place = lines[0].split(',').position(|title| title == name);
    let place = place.unwrap_or_else(|| panic!("no {name} in {}", lines[0]));
    lines[1..]
        .iter()
        .map(|line| line.split(',').nth(place).unwrap())
        .collect()
}

#[test]
fn the_planar_table_is_met_within_its_errors() {
    let lines = study(&["flat-table", "--tosses", "4000"]);
    assert_eq!(lines.len(), 1 + 2 * 20);
    let differences = column(&lines, "difference");
    for (line, difference) in lines[1..].iter().zip(differences) {
        // five standard errors of 4000 tosses, and what the two moments of inertia differ by
        let difference: f64 = difference.parse().unwrap();
        assert!(difference.abs() < 0.04 + 0.03, "{line}");
    }
}

#[test]
fn no_flight_passes_over_a_contact_and_nothing_gains_energy() {
    let lines = study(&["missed-contacts", "--flights", "3000"]);
    assert!(column(&lines, "missed").iter().all(|missed| *missed == "0"));
    let lines = study(&["energy", "--events", "30000"]);
    for (gain, line) in column(&lines, "worst_gain").iter().zip(&lines[1..]) {
        assert!(gain.parse::<f64>().unwrap() <= 1e-13, "{line}");
    }
}

#[test]
fn no_toss_of_the_stress_box_is_undecided() {
    for preset in ["clean-flat", "robot"] {
        let lines = study(&["undecided", "--tosses", "50", "--preset", preset]);
        assert_eq!(lines.len(), 1 + 5 * 5 * 5);
        assert!(
            column(&lines, "undecided")
                .iter()
                .all(|undecided| *undecided == "0")
        );
    }
}

#[test]
fn settings_at_their_defaults_are_converged() {
    let lines = study(&["convergence", "--tosses", "100"]);
    let defaults = lines.iter().filter(|line| line.contains(",default,"));
    assert_eq!(defaults.count(), 4 * 3 * 3);
    // one toss in 3600 may change
    let changed = column(&lines, "changed");
    let of_defaults = lines[1..]
        .iter()
        .zip(changed)
        .filter(|(line, _)| line.contains(",default,"));
    let sum: f64 = of_defaults
        .map(|(_, changed)| changed.parse::<f64>().unwrap())
        .sum();
    assert!(sum * 100.0 <= 1.5, "{sum}");
}

#[test]
fn the_early_rule_disagrees_only_where_the_drop_is_high() {
    let lines = study(&["stopping-rule", "--tosses", "50"]);
    assert_eq!(lines.len(), 1 + 2 * 4 * 3 * 5);
    let share = column(&lines, "disagree");
    for (height, share) in column(&lines, "height_over_100_d").iter().zip(share) {
        // the spin adds a per cent or two to the energy of the height
        if height.parse::<f64>().unwrap() < 0.9 {
            assert_eq!(share.parse::<f64>().unwrap(), 0.0);
        }
    }
}

#[test]
fn the_fair_ratio_is_found_for_every_value() {
    let lines = study(&["sensitivity", "--tosses", "2000"]);
    assert!(lines.len() > 25);
    for ratio in column(&lines, "fair_ratio") {
        assert!(
            (1.2..2.0).contains(&ratio.parse::<f64>().unwrap()),
            "{ratio}"
        );
    }
}

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
    let lines = study(&[&["speed"], &sizes[..]].concat());
    let memory: Vec<f64> = lines
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
fn a_study_is_the_same_every_time_and_another_with_another_seed() {
    let of = |seed| study(&["--seed", seed, "stopping-rule", "--tosses", "40"]);
    assert_eq!(of("1"), of("1"));
    assert_ne!(of("1"), of("2"));
}

#[test]
fn work_is_listed_and_unknown_work_refused() {
    let output = coinmc_bench(&["work"]);
    let names = String::from_utf8(output.stdout).unwrap();
    assert!(names.lines().count() > 10);
    for name in names.lines() {
        assert!(
            coinmc_bench(&["work", name, "--count", "3"])
                .status
                .success(),
            "{name}"
        );
    }
    let output = coinmc_bench(&["work", "nothing"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && message.contains("no piece of work is called `nothing`"));
}
