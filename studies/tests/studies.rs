//! Every study finishes at a small size, and its CSV file holds the expected rows.

use coinmc_testkit::study::Program;

const STUDIES: Program = Program(env!("CARGO_BIN_EXE_coinmc-studies"));

#[test]
fn the_planar_table_is_met_within_its_errors() {
    let lines = STUDIES.study(&["flat-table", "--tosses", "4000"]);
    assert_eq!(lines.len(), 2 * 20);
    let differences = lines.column("difference");
    for (line, difference) in lines.lines().iter().zip(differences) {
        // five standard errors of 4000 tosses, and what the two moments of inertia differ by
        let difference: f64 = difference.parse().unwrap();
        assert!(difference.abs() < 0.04 + 0.03, "{line}");
    }
}

#[test]
fn no_flight_passes_over_a_contact_and_nothing_gains_energy() {
    let lines = STUDIES.study(&["missed-contacts", "--flights", "3000"]);
    assert!(lines.column("missed").iter().all(|missed| *missed == "0"));
    let lines = STUDIES.study(&["energy", "--events", "30000"]);
    for (gain, line) in lines.column("worst_gain").iter().zip(lines.lines()) {
        assert!(gain.parse::<f64>().unwrap() <= 1e-13, "{line}");
    }
}

#[test]
fn no_toss_of_the_stress_box_is_undecided() {
    for preset in ["clean-flat", "robot"] {
        let lines = STUDIES.study(&["undecided", "--tosses", "50", "--preset", preset]);
        assert_eq!(lines.len(), 5 * 5 * 5);
        assert!(
            lines
                .column("undecided")
                .iter()
                .all(|undecided| *undecided == "0")
        );
    }
}

#[test]
fn settings_at_their_defaults_are_converged() {
    let size = ["--tosses", "100", "--ratios", "0.25,1,2"];
    let lines = STUDIES.study(&[&["convergence"], &size[..]].concat());
    let defaults = lines
        .lines()
        .iter()
        .filter(|line| line.contains(",default,"));
    assert_eq!(defaults.count(), 4 * 3 * 3);
    // one toss in 3600 may change
    let changed = lines.column("changed");
    let of_defaults = lines
        .lines()
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
    let lines = STUDIES.study(&["stopping-rule", "--tosses", "50"]);
    assert_eq!(lines.len(), 2 * 4 * 3 * 5);
    let share = lines.column("disagree");
    for (height, share) in lines.column("height_over_100_d").iter().zip(share) {
        // the spin adds a per cent or two to the energy of the height
        if height.parse::<f64>().unwrap() < 0.9 {
            assert_eq!(share.parse::<f64>().unwrap(), 0.0);
        }
    }
}

#[test]
fn a_study_is_the_same_every_time_and_another_with_another_seed() {
    let of = |seed| STUDIES.study(&["--seed", seed, "stopping-rule", "--tosses", "40"]);
    assert_eq!(of("1"), of("1"));
    assert_ne!(of("1"), of("2"));
}

#[test]
fn in_space_the_defaults_are_converged_and_the_grid_can_be_chosen() {
    let size = ["--tosses", "400", "--rhos", "0.01,0.03", "--ratios", "0.85"];
    let lines = STUDIES.study(&[&["convergence", "--engine", "volumetric"], &size[..]].concat());
    assert_eq!(lines.len(), 4 * 2);
    let (bias, error) = (lines.numbers("bias"), lines.numbers("std_error"));
    for ((bias, error), line) in bias.iter().zip(error).zip(lines.lines()) {
        // five standard errors, three tosses where next to none differs
        assert!(bias.abs() <= 5.0 * error + 0.0075, "{line}");
    }
    assert!(lines.numbers("undecided").iter().all(|n| *n == 0.0));
}

#[test]
fn in_space_the_laws_are_told_apart_by_name() {
    let size = ["--tosses", "300", "--paired", "100", "--ratios", "0.85"];
    let grid = ["--rhos", "0.01", "--restitutions", "0,0.5"];
    let lines = STUDIES.study(&[&["space-laws"], &size[..], &grid[..]].concat());
    let laws = lines.column("law");
    assert_eq!(laws[..3], ["moreau", "chatterjee-ruina", "stronge"]);
    assert_eq!(laws.len(), 6);
    assert!(
        lines
            .numbers("total_error")
            .iter()
            .all(|error| *error < 0.3)
    );
}

#[test]
fn in_space_the_older_law_is_near_its_published_values() {
    let lines = STUDIES.study(&["space-references", "--tosses", "1500"]);
    assert_eq!(lines.len(), 4 * 8);
    let (laws, z) = (lines.column("law"), lines.numbers("z"));
    for ((law, z), line) in laws.iter().zip(z).zip(lines.lines()) {
        // 4.5 standard errors, eight comparisons: one false alarm in 18,000 seeds
        let near = ["sequential 5", "sequential 6"].contains(law);
        assert!(!near || z.abs() < 4.5, "{line}");
    }
}

#[test]
fn in_space_no_flight_passes_over_a_contact_and_nothing_gains_energy() {
    let lines = STUDIES.study(&[
        "missed-contacts",
        "--engine",
        "volumetric",
        "--flights",
        "4000",
    ]);
    assert!(lines.column("missed").iter().all(|missed| *missed == "0"));
    for name in ["energy", "momentum"] {
        let worst = lines.numbers(name);
        assert!(
            worst.iter().all(|change| *change < 1e-11),
            "{name}: {worst:?}"
        );
    }
    let lines = STUDIES.study(&[
        "energy",
        "--engine",
        "volumetric",
        "--events",
        "12000",
        "--phases",
        "24",
    ]);
    for (gain, line) in lines.numbers("worst_gain").iter().zip(lines.lines()) {
        assert!(*gain <= 1e-12, "{line}");
    }
}

#[test]
fn in_space_peers_stand_beside_ours() {
    let lines = STUDIES.study(&["space-peers", "--tosses", "50"]);
    let engines = lines.column("engine");
    let ours = engines.iter().filter(|engine| **engine == "coinmc").count();
    assert_eq!((ours, engines.len() - ours), (10, 16));
}

#[test]
fn in_space_the_quick_decision_is_the_rigorous_one_but_for_rolling() {
    let size = ["--tosses", "300", "--time-limit", "300", "--rhos", "0,0.01"];
    let grid = ["--ratios", "0.85", "--restitutions", "0,0.5"];
    let lines = STUDIES.study(&[&["space-decision"], &size[..], &grid[..]].concat());
    let (rho, bias) = (lines.numbers("rho_over_r"), lines.numbers("bias"));
    for ((rho, bias), line) in rho.iter().zip(bias).zip(lines.lines()) {
        // two tosses of 300; measured: below 0.0003
        assert!(*rho == 0.0 || bias.abs() < 0.007, "{line}");
    }
    assert!(lines.numbers("undecided_energy")[0] > 0.0);
}

#[test]
fn laws_of_impact_have_the_order_and_the_balance_they_claim() {
    let lines = STUDIES.study(&["impact-limit", "--impacts", "10"]);
    assert_eq!(lines.len(), 6 * 6);
    for (order, line) in lines.column("order").iter().zip(lines.lines()) {
        // the softest have a term of the next order in the time of contact
        let order: f64 = order.parse().unwrap_or(1.0);
        assert!((order - 1.0).abs() < 0.15, "{line}");
    }
    let lines = STUDIES.study(&["impact-balance", "--impacts", "100"]);
    assert!(lines.numbers("not_finite").iter().all(|n| *n == 0.0));
    assert!(lines.numbers("gain_kept").iter().all(|gain| *gain < 1e-13));
    let lines = STUDIES.study(&["impact-accuracy", "--impacts", "10", "--tosses", "5"]);
    assert_eq!(lines.len(), 5 * 10);
    let found = lines.numbers("tolerance").into_iter();
    for ((tolerance, worst), line) in found.zip(lines.numbers("worst_error")).zip(lines.lines()) {
        assert!(worst < 1000.0 * tolerance, "{line}");
    }
    let lines = STUDIES.study(&["impact-curves", "--tosses", "20", "--line-tosses", "5"]);
    assert_eq!(lines.len(), 3 * (12 + 8) * 11);
    assert!(lines.numbers("undecided").iter().all(|n| *n == 0.0));
}

#[test]
fn steps_are_compared_with_events_toss_by_toss() {
    let few = ["--tosses", "20", "--reference", "500", "--shortest", "5e-3"];
    let lines = STUDIES.study(&[&["rapier-step"], &few[..]].concat());
    assert_eq!(lines.len(), 2 * 4 * 3);
    for tosses in lines.column("tosses") {
        assert_eq!(tosses, "20");
    }
    for name in ["p_side", "event_driven", "changed"] {
        for share in lines.column(name) {
            assert!((0.0..=1.0).contains(&share.parse::<f64>().unwrap()));
        }
    }
}

#[test]
fn no_toss_in_steps_panics_or_is_lost_count_of() {
    let lines = STUDIES.study(&["rapier-stress", "--tosses", "60", "--max-steps", "200"]);
    assert_eq!(lines.column("tosses"), ["60"; 3]);
    assert_eq!(lines.column("panics"), ["0"; 3]);
    let count = |name: &str, row: usize| lines.column(name)[row].parse::<f64>().unwrap();
    for row in 0..3 {
        let kinds = ["tunnelled", "sunk", "exploded", "not_finite", "undecided"];
        let lost: f64 = kinds.iter().map(|kind| count(kind, row)).sum();
        // the share of the others is rounded to five digits
        assert!((60.0 * count("decided", row) + lost - 60.0).abs() < 1e-3);
    }
}

#[test]
fn rapier_bounces_a_point_as_asked_and_a_face_not() {
    let lines = STUDIES.study(&["rapier-restitution", "--shortest", "5e-4"]);
    assert_eq!(lines.len(), 6);
    let last = |name| lines.column(name)[5].parse::<f64>().unwrap();
    assert!((last("point_e") - 0.5).abs() < 0.05, "{}", last("point_e"));
    // at every step, however small
    assert!(last("flat_spin") > 0.1, "{}", last("flat_spin"));
}

#[test]
fn exact_flight_gains_no_energy() {
    let lines = STUDIES.study(&["rapier-energy", "--tosses", "4"]);
    let flights = lines.column("flight");
    let by = lines.column("gyroscopic");
    for (i, above) in lines.column("above").iter().enumerate() {
        if flights[i] == "contact" && by[i] == "exact" {
            assert_eq!(above.parse::<f64>().unwrap(), 0.0, "{}", lines.lines()[i]);
        }
    }
}

/// Bounds ten times and more above the worst of 1e8 tosses in the plane and 1e6 in space.
#[test]
fn no_region_of_the_box_breaks_an_engine() {
    for (engine, tosses) in [("flat", 4000.0), ("volumetric", 400.0)] {
        let count = format!("{tosses}");
        let size = ["--tosses", &count, "--max-impacts", "500"];
        let limits = ["--max-steps", "500", "--dense", "10"];
        let arguments = [&["stability", "--engine", engine], &size[..], &limits[..]].concat();
        let lines = STUDIES.study(&arguments);
        for name in ["failed", "not_finite", "panics", "missed"] {
            let broken = lines.numbers(name);
            assert!(broken.iter().all(|n| *n == 0.0), "{engine}: {name}");
        }
        for (name, most) in [("gain", 1e-12), ("residual", 1e-10), ("drift", 1e-11)] {
            let worst = lines.column(name);
            let seen = worst.iter().filter(|cell| **cell != "none");
            let worst = seen.map(|cell| cell.parse::<f64>().unwrap());
            assert!(worst.fold(0.0, f64::max) < most, "{engine}: {name}");
        }
        // every toss is in one region of each parameter, and in the total
        let all: f64 = lines.numbers("tosses").iter().sum();
        assert_eq!(all, 7.0 * tosses);
        let output = STUDIES.execute(&["stability", "--engine", engine, "--only", "7"]);
        assert!(String::from_utf8_lossy(&output.stdout).contains("restitution"));
    }
}

#[test]
fn in_random_scenes_batches_match_the_scalar_path() {
    for engine in ["flat", "volumetric"] {
        let size = ["--tosses", "20000", "--together", "50", "--dense", "1000"];
        let limits = ["--max-impacts", "50", "--max-steps", "50"];
        let lines =
            STUDIES.study(&[&["stability", "--engine", engine], &size[..], &limits[..]].concat());
        let differ = lines.column("differ");
        assert_eq!(*differ.last().unwrap(), "0 of 400", "{engine}");
        assert_eq!(lines.numbers("tosses").last(), Some(&20_000.0));
    }
    for refused in [["50", "20"], ["20001", "0"]] {
        let [together, first] = refused;
        let output = STUDIES.execute(&["stability", "--together", together, "--first", first]);
        assert!(!output.status.success(), "{refused:?}");
    }
}

#[test]
fn no_law_breaks_the_volumetric_engine() {
    for law in ["chatterjee-ruina", "stronge"] {
        let size = ["--tosses", "200", "--max-steps", "500", "--law", law];
        let lines = STUDIES.study(&[&["stability", "--engine", "volumetric"], &size[..]].concat());
        for name in ["failed", "not_finite", "panics", "missed"] {
            assert!(
                lines.numbers(name).iter().all(|n| *n == 0.0),
                "{law}: {name}"
            );
        }
    }
    let output = STUDIES.execute(&["stability", "--law", "nothing"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && message.contains("no law is called `nothing`"));
}

#[test]
fn a_long_study_of_stability_may_be_made_in_parts() {
    let part = |first: &str, tosses: &str| {
        let lines = STUDIES.study(&["stability", "--first", first, "--tosses", tosses]);
        let limit = lines.numbers("impact_or_step_limit");
        (
            lines.lines().last().unwrap().clone(),
            *limit.last().unwrap(),
        )
    };
    let (whole, limit) = part("0", "3000");
    let parts = [part("0", "2000"), part("2000", "1000")];
    assert_eq!(parts[0].1 + parts[1].1, limit);
    assert_ne!(parts[1].0, whole);
}

#[test]
fn quadrature_is_sharper_than_tosses() {
    let lines = STUDIES.study(&["integration", "--estimates", "8", "--most", "1e4"]);
    // two numbers of evaluations, seven scenes, five ways; two that bounce, four ways
    assert_eq!(lines.len(), 2 * (7 * 5 + 2 * 4));
    let (ways, errors) = (lines.column("way"), lines.column("error"));
    let (scenes, number) = (lines.column("scene"), lines.column("evaluations"));
    let methods = lines.column("method");
    let error = |i: usize| errors[i].parse::<f64>().unwrap();
    for i in (0..ways.len()).filter(|&i| ways[i] == "auto" && methods[i] != "tossed") {
        let random = (0..ways.len())
            .find(|&j| ways[j] == "random" && scenes[j] == scenes[i] && number[j] == number[i]);
        // the error of 8 estimates is good to a quarter
        assert!(
            error(i) < 0.7 * error(random.unwrap()),
            "{}",
            lines.lines()[i]
        );
    }
}

#[test]
fn intervals_of_calibrated_coins_hold_the_truth() {
    let size = [
        "--coins",
        "12",
        "--truth",
        "256",
        "--points",
        "64",
        "--tosses",
        "16",
        "--predicted",
        "1024",
    ];
    let lines = STUDIES.study(&[&["calibrate"], &size[..]].concat());
    let lines = lines.lines().iter();
    let coverage: Vec<_> = lines.filter(|line| line.starts_with("coverage,")).collect();
    assert_eq!(coverage.len(), 6);
    for line in coverage {
        // of 12 intervals at 95 %, 7 or fewer hold the truth in 1 of 5000 cases
        let share: f64 = line.split(',').nth(2).unwrap().parse().unwrap();
        assert!(share > 7.5 / 12.0, "{line}");
    }
}

/// A coin and its mirror image show heads and tails exchanged, within four standard errors.
#[test]
fn coins_with_unlike_faces_have_a_row_each() {
    let size = [
        "--ratios",
        "0.85",
        "--tosses",
        "400",
        "--oracle-tosses",
        "2",
    ];
    for (more, rows) in [(&[][..], 4), (&["--loaded"][..], 3)] {
        let lines = STUDIES.study(&[&["conical"], &size[..], more].concat());
        assert_eq!(lines.len(), rows);
        let of = |face: &str| -> Vec<f64> {
            let cells = lines.column(face).into_iter();
            cells.map(|cell| cell.parse().unwrap()).collect()
        };
        let (heads, tails) = (of("heads"), of("tails"));
        assert!((heads[0] - tails[1]).abs() < 0.14, "{heads:?} {tails:?}");
        assert!(heads[0] < tails[0] && heads[1] > tails[1]);
    }
}
