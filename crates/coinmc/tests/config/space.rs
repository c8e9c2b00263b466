//! Configs of the toss in space and their plans.

use crate::support::{column, parse};
use coinmc::config;
use coinmc::plan::{EngineChoice, Explanation};
use coinmc_core::Preset;
use coinmc_volumetric as volumetric;
use std::collections::HashSet;

/// A toss in space.
const IN_SPACE: &str = "
[coin]
ratio = 0.85
[surface]
restitution = 0.5
friction = 0.3
rolling_friction_m = 1e-4
pivoting_friction_m = 2e-4
[launch]
preset = 'clean'
[engine.volumetric]
[stop]
tosses = 1000
";

#[test]
fn the_toss_in_space_has_the_defaults_of_its_crate() {
    let plan = parse(IN_SPACE, &[]);
    let points: Vec<_> = plan.points.iter().collect();
    let [point] = points[..] else {
        panic!("one point")
    };
    assert_eq!(
        point.engine,
        EngineChoice::new(volumetric::Settings::default())
    );
    assert_eq!(point.launches, Preset::Clean.distribution());
    let surface = point.scene.surface;
    assert_eq!(
        (surface.rolling_friction_m(), surface.pivoting_friction_m()),
        (1e-4, 2e-4)
    );
    assert_eq!(surface.restitution_threshold_m_s(), 0.0);
    assert!(point.scene.drag().is_none() && point.scene.has_gyroscopic_torque());
    assert_eq!(plan.tosses_planned(), 1000);
    assert!(plan.notes.is_empty(), "{:?}", plan.notes);
    assert_eq!(parse(&plan.resolved_toml, &[]), plan);
}

/// H/2 = 4.25 mm and R = 10 mm: what a rim's rounding leaves must be a cylinder.
#[test]
fn a_rim_rounded_by_half_the_thickness_is_refused() {
    let plan = parse(IN_SPACE, &["coin.rim_radius_m=[0, 0.004]"]);
    assert_eq!(column(&plan, "rim_radius_m"), [0.0, 0.004]);
    for (ratio, radius) in [(0.85, 0.00425), (8.0, 0.01)] {
        let text = IN_SPACE.replace("0.85", &format!("{ratio}\nrim_radius_m = {radius}"));
        let problems = config::parse("rim.toml", &text, &[]).unwrap_err();
        let [problem] = problems.problems() else {
            panic!("{problems}")
        };
        let message = format!("below both R and H/2, here below {radius} m, not {radius} m");
        assert!(problem.message.ends_with(&message), "{problems}");
    }
}

/// Asserts that a config with this override has one problem, which says so.
fn assert_refused(text: &str, set: &str, expected: &str) {
    let set = [set.parse().expect("an override")];
    let problems = config::parse("refused.toml", text, &set).unwrap_err();
    let [problem] = problems.problems() else {
        panic!("{problems}")
    };
    assert!(problem.message.contains(expected), "{problems}");
}

/// Asserts that every engine but that in space refuses the coin of a config, which says so.
fn assert_other_engines_refuse(text: &str, expected: &str) {
    for engine in ["flat = {}", "rapier = {}", "analytic = {}"] {
        let text = text
            .replace("[engine.volumetric]", "")
            .replace("law = 'moreau'", "");
        let text = format!("{text}\n[engine]\n{engine}\n");
        let problems = config::parse("refused.toml", &text, &[]).unwrap_err();
        let refused = |problem: &config::Problem| problem.message.contains(expected);
        assert!(
            problems.problems().iter().any(refused),
            "{engine}: {problems}"
        );
    }
}

/// A loaded cylinder: read, swept, resolved, without a trace where the load is 0, and refused where it is not
/// modelled or cannot be.
#[test]
fn a_load_is_read_and_refused_where_it_cannot_be() {
    let plan = parse(
        IN_SPACE,
        &["coin.centre_of_mass_over_height=[-0.1, 0, 0.1]"],
    );
    let centres = column(&plan, "centre_of_mass_over_height");
    assert_eq!(centres, [-0.1, 0.0, 0.1]);
    assert_eq!(parse(&plan.resolved_toml, &[]), plan);
    let plain = parse(IN_SPACE, &[]);
    assert_eq!(plan.points[1].scene, plain.points[0].scene);
    assert!(!plain.resolved_toml.contains("centre_of_mass"));
    let [heads, tails] = plan.points[2].scene.coin.rims();
    assert!(heads.distance_m < tails.distance_m && heads.radius_m == tails.radius_m);
    // with the moment of a coin that is heavy at its faces, farther out
    let moments = [
        "coin.centre_of_mass_over_height=0.4",
        "coin.transverse_moment_kg_m2=3e-7",
    ];
    assert!(
        !parse(IN_SPACE, &moments).points[0]
            .scene
            .coin
            .has_like_faces()
    );
    let text = IN_SPACE.replace("0.85", "0.85\ncentre_of_mass_over_height = 0.1");
    for (set, expected) in [
        (
            "coin.centre_of_mass_over_height=0.3",
            "`transverse_moment_kg_m2` must be given",
        ),
        ("coin.transverse_moment_kg_m2=1e-6", "is impossible"),
        ("coin.draft_deg=5", "its draft and rim radius must be 0"),
        (
            "coin.rim_radius_m=1e-4",
            "its draft and rim radius must be 0",
        ),
        ("surface.table_radius_m=0.3", "on a table with an edge"),
        ("surface.table_tilt_deg=3", "on a tilted table"),
        ("surface.material='wood'", "on rough ground"),
    ] {
        assert_refused(&text, set, expected);
    }
    assert_other_engines_refuse(&text, "`coin.centre_of_mass_over_height` must be 0");
}

/// A coin with a conical edge: read, swept, resolved, and refused where it is not modelled or would not rest
/// on its edge.
#[test]
fn a_conical_edge_is_read_and_refused_where_it_cannot_be() {
    let plan = parse(IN_SPACE, &["coin.draft_deg=[-10, 0, 10]"]);
    assert_eq!(column(&plan, "draft_deg"), [-10.0, 0.0, 10.0]);
    assert_eq!(parse(&plan.resolved_toml, &[]), plan);
    let [heads, tails] = plan.points[2].scene.coin.rims();
    assert!(heads.radius_m == 0.01 && tails.radius_m < 0.0086);
    // without a draft nothing is said of it
    assert!(!parse(IN_SPACE, &[]).resolved_toml.contains("draft"));
    let text = IN_SPACE.replace("0.85", "0.85\ndraft_deg = 10.0");
    for (set, expected) in [
        (
            "coin.ratio=0.2",
            "draft must be below 5.870° to either side",
        ),
        (
            "coin.rim_radius_m=1e-4",
            "a coin with a conical edge has sharp rims",
        ),
        ("surface.table_radius_m=0.3", "on a table with an edge"),
        ("surface.table_tilt_deg=3", "on a tilted table"),
        ("surface.material='wood'", "on rough ground"),
    ] {
        assert_refused(&text, set, expected);
    }
    // a material's waves of no height are a plane
    let level = ["surface.material='wood'", "surface.roughness_slope=0"];
    assert!(parse(&text, &level).points[0].scene.coin.is_conical());
    assert_other_engines_refuse(&text, "`coin.draft_deg` must be 0");
}

#[test]
fn every_setting_of_the_toss_in_space_can_be_given() {
    let sets = [
        "surface.restitution_threshold_m_s=2",
        "environment.linear_drag_per_s=1",
        "environment.angular_drag_per_s=0.05",
        "environment.gyroscopic_torque=false",
        "engine.volumetric={law='stronge', decision='energy', zeno=0.01, tolerance=1e-6, \
         stick_speed = 1e-3, smoothing_time=1e-4, ground_step=0.25, max_impacts=7, max_steps=9, time_limit=100}",
    ];
    let plan = parse(IN_SPACE, &sets);
    let point = &plan.points[0];
    assert_eq!(point.scene.surface.restitution_threshold_m_s(), 2.0);
    let drag = point.scene.drag();
    assert_eq!((drag.linear_per_s(), drag.angular_per_s()), (1.0, 0.05));
    assert!(!point.scene.has_gyroscopic_torque());
    let chosen = volumetric::Settings {
        law: volumetric::Law::Stronge,
        decision: volumetric::Decision::Energy,
        zeno: 0.01,
        tolerance: 1e-6,
        stick_speed: 1e-3,
        smoothing_time: 1e-4,
        ground_step: 0.25,
        max_impacts: 7,
        max_steps: 9,
        time_limit: 100.0,
    };
    assert_eq!(point.engine, EngineChoice::new(chosen));
    assert_eq!(parse(&plan.resolved_toml, &[]), plan);
}

#[test]
fn every_number_of_the_toss_in_space_can_be_swept() {
    for (key, name) in [
        ("surface.rolling_friction_m", "rolling_friction_m"),
        ("surface.pivoting_friction_m", "pivoting_friction_m"),
        (
            "surface.restitution_threshold_m_s",
            "restitution_threshold_m_s",
        ),
        ("environment.linear_drag_per_s", "linear_drag_per_s"),
        ("environment.angular_drag_per_s", "angular_drag_per_s"),
        ("engine.volumetric.zeno", "engine.volumetric.zeno"),
        ("engine.volumetric.tolerance", "engine.volumetric.tolerance"),
        (
            "engine.volumetric.stick_speed",
            "engine.volumetric.stick_speed",
        ),
        (
            "engine.volumetric.smoothing_time",
            "engine.volumetric.smoothing_time",
        ),
        (
            "engine.volumetric.time_limit",
            "engine.volumetric.time_limit",
        ),
    ] {
        let plan = parse(IN_SPACE, &[&format!("{key}=[1e-3, 5e-4]")]);
        assert_eq!(plan.axes, [name]);
        assert_eq!(column(&plan, name), [1e-3, 5e-4]);
        assert_ne!(plan.points[0], plan.points[1], "{key}");
        let names: HashSet<_> = plan.points[0].parameters.iter().map(|(n, _)| n).collect();
        assert_eq!(names.len(), plan.points[0].parameters.len(), "{key}");
        assert_eq!(parse(&plan.resolved_toml, &[]), plan, "{key}");
    }
}

#[test]
fn all_physics_and_settings_of_the_toss_in_space_are_in_the_hash() {
    let base = parse(IN_SPACE, &[]);
    let mut hashes = HashSet::from([base.hash()]);
    for set in [
        "surface.rolling_friction_m=1.1e-4",
        "surface.pivoting_friction_m=0",
        "surface.restitution_threshold_m_s=0.01",
        "environment.linear_drag_per_s=0.1",
        "environment.angular_drag_per_s=0.1",
        "environment.gyroscopic_torque=false",
        "engine.volumetric.law=chatterjee-ruina",
        "engine.volumetric.max_steps=10000",
        "engine.volumetric.law=stronge",
        "engine.volumetric.decision=energy",
        "engine.volumetric.zeno=0.03",
        "engine.volumetric.tolerance=1e-6",
        "engine.volumetric.stick_speed=1e-3",
        "engine.volumetric.smoothing_time=1e-4",
        "engine.volumetric.ground_step=0.4",
        "engine.volumetric.max_impacts=10",
        "surface.restitution_exponent=0.25",
        "coin.rim_radius_m=0.001",
        "coin.draft_deg=5",
        "coin.draft_deg=-5",
        "coin.centre_of_mass_over_height=0.1",
        "coin.centre_of_mass_over_height=-0.1",
        "engine.volumetric.time_limit=10",
        "launch.preset=drop",
    ] {
        let other = parse(IN_SPACE, &[set]);
        assert!(other != base && hashes.insert(other.hash()), "{set}");
    }
}

#[test]
fn omissions_of_the_toss_in_space_are_explained() {
    let explained = |sets: &[&str]| {
        let [all] = &parse(IN_SPACE, sets).explain()[..] else {
            panic!("one treatment: {sets:?}")
        };
        (all.computed.clone(), all.skipped.join("; "))
    };
    let (computed, skipped) = explained(&[]);
    assert!(
        computed.contains("the law moreau, sustained contact on the rim and on the side, until"),
        "{computed}"
    );
    assert_eq!(skipped, "drag: both of its rates are 0");
    for (sets, word) in [
        (
            &["surface.rolling_friction_m=0"][..],
            "rolling_friction_m is 0",
        ),
        (
            &["surface.pivoting_friction_m=0"],
            "pivoting_friction_m is 0",
        ),
        (&["surface.friction=0"], "friction is 0"),
        (&["surface.restitution=0"], "restitution is 0"),
        (&["environment.gyroscopic_torque=false"], "switched off"),
        (
            &["surface.landing=adhesive", "sampling.method=random"],
            "rolling and rocking",
        ),
    ] {
        let (_, skipped) = explained(sets);
        assert_eq!(skipped.split("; ").count(), 2, "{skipped}");
        assert!(skipped.contains(word), "{skipped}");
    }
    assert_eq!(explained(&["environment.linear_drag_per_s=1"]).1, "");
    let (computed, _) = explained(&["surface.restitution_threshold_m_s=2"]);
    assert!(computed.contains("(restitution 0 below its threshold)"));
    let (computed, _) = explained(&["engine.volumetric.decision=energy"]);
    assert!(computed.ends_with("until energy alone decides the face"));
    let (computed, _) = explained(&["surface.landing=adhesive", "sampling.method=random"]);
    assert!(computed.contains("to the first contact"));
    let sets = ["surface.rolling_friction_m=[0, 1e-4]", "coin.ratio=[1, 2]"];
    let points: Vec<_> = parse(IN_SPACE, &sets)
        .explain()
        .iter()
        .map(|e| e.points)
        .collect();
    assert_eq!(points, [2, 2]);
}

/// Below the threshold nothing bounces: that is said where something could bounce, of the points that have one.
#[test]
fn points_with_a_threshold_are_explained_apart_where_the_coin_bounces() {
    let groups = |sets: &[&str]| {
        let threshold = "surface.restitution_threshold_m_s=[0, 0.1, 0.2]";
        let plan = parse(IN_SPACE, &[&[threshold], sets].concat());
        let of = |e: &Explanation| (e.points, e.computed.contains("below its threshold"));
        plan.explain().iter().map(of).collect::<Vec<_>>()
    };
    assert_eq!(groups(&[]), [(1, false), (2, true)]);
    assert_eq!(
        groups(&["surface.landing=adhesive", "sampling.method=random"]),
        [(3, false)]
    );
    assert_eq!(groups(&["surface.landing=adhesive"]), [(3, false)]);
}

#[test]
fn surprising_settings_in_space_are_noted() {
    let notes = |sets: &[&str]| parse(IN_SPACE, sets).notes.join("; ");
    assert!(notes(&["surface.rolling_friction_m=0"]).contains("engine.volumetric.max_steps"));
    // something else ends it: no roll without friction, and drag
    let frictionless = ["surface.rolling_friction_m=0", "surface.friction=0"];
    let dragged = [
        "surface.rolling_friction_m=0",
        "environment.angular_drag_per_s=1",
    ];
    assert_eq!((notes(&frictionless), notes(&dragged)), Default::default());
    assert!(notes(&["surface.restitution=1"]).contains("engine.volumetric.max_impacts"));
    assert!(notes(&["surface.landing=adhesive"]).starts_with(
        "surface.restitution, surface.friction, surface.rolling_friction_m and surface.pivoting_friction_m change \
         nothing"
    ));
}
