//! Valid configs and their plans.

use crate::support::{SMALL, column, parse};
use coinmc::config;
use coinmc::plan::{EngineChoice, Stop, Targets};
use coinmc_core::{IntervalMethod, Landing, Marginal, Orientation, Preset, Remark, Spin};
use coinmc_flat::{Decision, Settings};
use std::path::Path;

#[test]
fn defaults_are_those_of_the_crates() {
    let plan = parse(SMALL, &[]);
    assert_eq!(
        (plan.seed, plan.paired, plan.stop),
        (1, false, Stop::Tosses(1000))
    );
    assert_eq!(
        (plan.confidence, plan.interval),
        (0.95, IntervalMethod::Wilson)
    );
    let points: Vec<_> = plan.points.iter().collect();
    let [point] = points[..] else {
        panic!("one point")
    };
    assert_eq!(point.engine, EngineChoice::new(Settings::default()));
    assert_eq!(point.launches, Preset::Robot.distribution());
    assert_eq!(point.scene.gravity_m_s2(), 9.81);
    assert_eq!(
        point.scene.coin,
        coinmc_core::Coin::cylinder(1.2, 0.01).unwrap()
    );
    assert_eq!(point.scene.surface.landing(), Landing::Bouncing);
    let parameters: Vec<_> = point
        .parameters
        .iter()
        .map(|(name, value)| (&**name, *value))
        .collect();
    assert_eq!(
        parameters,
        [
            ("ratio", 1.2),
            ("radius_m", 0.01),
            ("rim_radius_m", 0.0),
            ("restitution", 0.5),
            ("friction", 0.3),
            ("rolling_friction_m", 0.0),
            ("pivoting_friction_m", 0.0),
            ("restitution_threshold_m_s", 0.0),
            ("linear_drag_per_s", 0.0),
            ("angular_drag_per_s", 0.0),
            ("restitution_exponent", 0.0),
            ("restitution_reference_m_s", 1.0),
            ("roughness_slope", 0.0),
            ("roughness_wavelength_m", 0.0),
            ("table_radius_m", 0.0),
            ("table_tilt_deg", 0.0),
            ("table_downhill_deg", 0.0),
        ]
    );
    assert!(point.scene.has_gyroscopic_torque());
    assert!(plan.axes.is_empty() && plan.notes.is_empty());
    assert_eq!(plan.tosses_planned(), 1000);
}

#[test]
fn the_examples_are_valid_and_their_plans_unchanged() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    for (name, points, tosses) in [
        ("first", 4, 400_000),
        ("flat-fair", 126, 6_300_000),
        ("closed-forms", 41, 0),
        ("precise", 2, 40_000_000),
        ("own-launch", 3, 150_000),
        ("clean", 3, 90_000),
        ("table1", 4, 80_000),
        ("hand", 3, 60_000),
        ("drop", 4, 80_000),
    ] {
        let plan = config::load(&folder.join(name).with_extension("toml"), &[])
            .unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(
            (plan.points.len(), plan.tosses_planned()),
            (points, tosses),
            "{name}"
        );
        // thin coins on the perfect planes of comparisons
        let on_plane = ["clean", "table1"].contains(&name);
        let notes: &[String] = if on_plane {
            &[Remark::PERFECT_PLANE.text.to_owned()]
        } else {
            &[]
        };
        assert_eq!(plan.notes, notes, "{name}");
        assert_eq!(parse(&plan.resolved_toml, &[]), plan, "{name}");
    }
}

#[test]
fn a_grid_varies_its_first_axis_slowest_and_ignores_the_order_of_keys() {
    let plan = parse(
        SMALL,
        &["surface.restitution=[0.7, 0.3]", "coin.ratio=[1, 2, 3]"],
    );
    assert_eq!(plan.axes, ["ratio", "restitution"]);
    assert_eq!(column(&plan, "ratio"), [1.0, 1.0, 2.0, 2.0, 3.0, 3.0]);
    assert_eq!(column(&plan, "restitution"), [0.7, 0.3, 0.7, 0.3, 0.7, 0.3]);
    let shuffled = "# other order, other spelling\n\
        engine = { flat = {} }\n\
        stop.tosses = 1e3\n\
        launch.preset = \"robot\"\n\
        surface.friction = 3e-1\n\
        surface.restitution = [0.7, 0.3]\n\
        coin.ratio = { steps = 3, to = 3, from = 1 }\n";
    let other = parse(shuffled, &[]);
    assert_eq!(other, plan);
    assert_eq!(other.hash(), plan.hash());
}

#[test]
fn a_zip_advances_all_axes_together() {
    let sets = [
        "surface.restitution=[0.7, 0.3]",
        "coin.ratio=[1, 2]",
        "sweep.mode=zip",
    ];
    let plan = parse(SMALL, &sets);
    assert_eq!(column(&plan, "ratio"), [1.0, 2.0]);
    assert_eq!(column(&plan, "restitution"), [0.7, 0.3]);
    assert_ne!(plan.hash(), parse(SMALL, &sets[..2]).hash());
}

#[test]
fn a_zip_of_fewer_than_two_axes_is_a_grid() {
    for set in ["coin.ratio=1.3", "coin.ratio=[1, 2]"] {
        assert_eq!(parse(SMALL, &[set, "sweep.mode=zip"]), parse(SMALL, &[set]));
    }
}

/// Each half of every axis has half of the first four points, and each quarter of every pair of axes a
/// quarter of all. The seed scrambles them, and the resolved config has them.
#[test]
fn a_design_fills_the_box_between_its_ranges() {
    let design = |steps: usize, seed: u64| {
        let log = "scale = 'log'";
        let sets = [
            "sweep.mode=sobol".to_owned(),
            format!("seed={seed}"),
            format!("coin.ratio={{ from = 0.1, to = 10, steps = {steps}, {log} }}"),
            format!("surface.restitution={{ from = 0, to = 0.5, steps = {steps} }}"),
            format!("surface.friction={{ from = 0.2, to = 0.4, steps = {steps} }}"),
        ];
        parse(SMALL, &sets.each_ref().map(String::as_str))
    };
    let plan = design(64, 1);
    let middles = [("ratio", 1.0), ("restitution", 0.25), ("friction", 0.3)];
    let above = middles.map(|(name, middle)| {
        let values = column(&plan, name);
        values.iter().map(|v| *v > middle).collect::<Vec<_>>()
    });
    for axis in &above {
        assert_eq!(axis.iter().take(4).filter(|above| **above).count(), 2);
    }
    for (first, second) in [(0, 1), (0, 2), (1, 2)] {
        for quarter in [(false, false), (false, true), (true, false), (true, true)] {
            let pairs = above[first].iter().zip(&above[second]);
            let inside = pairs.filter(|(a, b)| (**a, **b) == quarter).count();
            assert_eq!(inside, 16, "{first} {second} {quarter:?}");
        }
    }
    let longer = design(128, 1);
    assert_eq!(column(&longer, "friction")[..64], column(&plan, "friction"));
    let other = design(64, 2);
    assert_ne!(column(&other, "friction"), column(&plan, "friction"));
    assert_eq!(parse(&plan.resolved_toml, &[]), plan);
    let single = parse(
        SMALL,
        &[
            "sweep.mode=sobol",
            "coin.ratio={ from = 1, to = 2, steps = 4 }",
        ],
    );
    assert_ne!(column(&single, "ratio")[0], 1.0);
    assert_eq!(parse(&single.resolved_toml, &[]), single);
}

#[test]
fn every_number_can_be_swept_and_has_a_column() {
    for (set, name, values) in [
        ("coin.radius_m=[0.01, 0.02]", "radius_m", [0.01, 0.02]),
        ("coin.mass_kg=[0.01, 0.02]", "mass_kg", [0.01, 0.02]),
        (
            "coin.axial_moment_kg_m2=[5e-7, 6e-7]",
            "axial_moment_kg_m2",
            [5e-7, 6e-7],
        ),
        (
            "environment.gravity_m_s2=[1.62, 9.81]",
            "gravity_m_s2",
            [1.62, 9.81],
        ),
        ("launch.height_m=[1, 2]", "launch.height_m", [1.0, 2.0]),
        (
            "launch.velocity_m_s=[0, 0, [1, 2]]",
            "launch.velocity_m_s.z",
            [1.0, 2.0],
        ),
        (
            "launch.orientation.tilt_deg.normal={mean=[0, 90], sd=1}",
            "launch.orientation.tilt_deg.normal.mean",
            [0.0, 90.0],
        ),
        (
            "launch.spin={about={axis=[0, 1, 0], rate_rad_s={uniform={from=0, to=[1, 2]}}}}",
            "launch.spin.about.rate_rad_s.uniform.to",
            [1.0, 2.0],
        ),
        (
            "launch.spin.components_rad_s=[0, [5, 6], 0]",
            "launch.spin.components_rad_s.y",
            [5.0, 6.0],
        ),
        (
            "engine.flat.zeno=[0.1, 0.01]",
            "engine.flat.zeno",
            [0.1, 0.01],
        ),
        (
            "engine.flat.decision.energy_fraction=[0.1, 0.01]",
            "engine.flat.decision.energy_fraction",
            [0.1, 0.01],
        ),
    ] {
        let plan = parse(SMALL, &[set]);
        assert_eq!(plan.axes, [name], "{set}");
        assert_eq!(column(&plan, name), values, "{set}");
        assert_ne!(plan.points[0], plan.points[1], "{set}");
        assert_eq!(parse(&plan.resolved_toml, &[]), plan, "{set}");
    }
}

#[test]
fn a_launch_can_be_given_without_preset() {
    let text = SMALL.replace(
        "preset = 'robot'",
        "height_m = { uniform = { from = 1, to = 2 } }
         orientation = { axis = [3, 0, 4] }
         spin = { about = { axis = [0, -2, 0], rate_rad_s = 10 } }",
    );
    let launches = parse(&text, &[]).points[0].launches;
    assert_eq!(launches.height_m, Marginal::Uniform { from: 1.0, to: 2.0 });
    assert_eq!(launches.velocity_m_s, [Marginal::Constant(0.0); 3]);
    let Orientation::Fixed(axis) = launches.orientation else {
        panic!("fixed")
    };
    assert!((axis.x - 0.6).abs() < 1e-15 && (axis.z - 0.8).abs() < 1e-15 && axis.y == 0.0);
    let Spin::About { axis, rate_rad_s } = launches.spin else {
        panic!("about")
    };
    assert_eq!((axis.y, rate_rad_s), (-1.0, Marginal::Constant(10.0)));
}

#[test]
fn angles_are_degrees_in_the_config_and_radians_in_the_plan() {
    let set = "launch.orientation={tilt_deg={normal={mean=90, sd=180}}}";
    let launches = parse(SMALL, &[set]).points[0].launches;
    let (mean, sd) = (std::f64::consts::FRAC_PI_2, std::f64::consts::PI);
    assert_eq!(
        launches.orientation,
        Orientation::Tilt(Marginal::Normal { mean, sd })
    );
}

#[test]
fn a_closed_form_needs_only_a_coin() {
    let plan = parse("coin.ratio = [1, 2]\nengine.analytic.rule = 'zone'", &[]);
    assert_eq!(plan.stop, Stop::Tosses(0));
    assert_eq!(plan.tosses_planned(), 0);
    assert!(plan.notes.is_empty());
    let same = SMALL.replace("[engine.flat]", "[engine.analytic]\nrule = 'zone'");
    let plan = parse(&same, &["surface.friction=[0.1, 0.2]"]);
    assert_eq!(
        (plan.points.len(), plan.tosses_planned(), plan.stop),
        (2, 0, Stop::Tosses(0))
    );
    assert_eq!(plan.notes.len(), 3, "{:?}", plan.notes);
    assert_eq!(parse(&plan.resolved_toml, &[]), plan);
}

#[test]
fn an_adhesive_landing_needs_no_coefficients() {
    let text = SMALL.replace("restitution = 0.5\nfriction = 0.3", "landing = 'adhesive'");
    let plan = parse(&text, &[]);
    assert_eq!(plan.points[0].scene.surface.landing(), Landing::Adhesive);
    assert!(plan.notes.is_empty());
    let plan = parse(SMALL, &["surface.landing=adhesive"]);
    assert_eq!(plan.notes.len(), 1);
}

#[test]
fn stop_and_estimate_are_read() {
    let text = SMALL.replace("tosses = 1000", "half_width = 0.01");
    let sets = [
        "estimate.confidence=0.99",
        "estimate.interval=clopper-pearson",
    ];
    let plan = parse(&text, &sets);
    assert_eq!(
        plan.stop,
        Stop::Targets(Targets {
            half_width: Some(0.01),
            relative_error: None,
            events: None,
            face: None,
            max_tosses: 100_000_000,
            total_tosses: None,
            max_core_seconds: None,
            total_core_seconds: None,
        })
    );
    assert_eq!(
        (plan.confidence, plan.interval),
        (0.99, IntervalMethod::ClopperPearson)
    );
}

#[test]
fn targets_can_be_combined() {
    let targets = "relative_error = 0.1\nevents = 500\nmax_tosses = 1e6";
    let plan = parse(&SMALL.replace("tosses = 1000", targets), &[]);
    let expected = Targets {
        half_width: None,
        relative_error: Some(0.1),
        events: Some(500),
        face: None,
        max_tosses: 1_000_000,
        total_tosses: None,
        max_core_seconds: None,
        total_core_seconds: None,
    };
    assert_eq!(plan.stop, Stop::Targets(expected));
}

#[test]
fn overrides_replace_add_and_the_last_one_wins() {
    let plan = parse(
        SMALL,
        &["seed=5", "seed = 6 ", "coin.radius_m=0.02", "paired=true"],
    );
    assert_eq!((plan.seed, plan.paired), (6, true));
    assert_eq!(plan.points[0].scene.coin.radius_m(), 0.02);
    let whole = parse(SMALL, &["launch={preset='clean-flat', height_m=3}"]);
    assert_eq!(whole.points[0].launches.height_m, Marginal::Constant(3.0));
    let engine = parse(SMALL, &["engine={analytic={rule='arc'}}"]);
    assert_eq!(engine.points[0].engine.name(), "analytic");
}

#[test]
fn the_energy_rule_is_a_setting() {
    let plan = parse(SMALL, &["engine.flat.decision={energy_fraction=0.01}"]);
    let settings: &Settings = plan.points[0].engine.settings().expect("flat");
    assert_eq!(settings.decision, Decision::EnergyFraction(0.01));
}

#[test]
fn different_plans_have_different_hashes() {
    let base = parse(SMALL, &[]);
    assert_eq!(base.hash().len(), 64);
    for set in [
        "seed=2",
        "paired=true",
        "coin.ratio=1.2000000000000002",
        "coin.mass_kg=0.011",
        "surface.friction=0",
        "launch.height_m=1",
        "engine.flat.law=chatterjee-ruina",
        "engine.flat.max_impacts=10",
        "stop.tosses=1001",
        "estimate.confidence=0.9",
    ] {
        let other = parse(SMALL, &[set]);
        assert!(other != base && other.hash() != base.hash(), "{set}");
    }
}

#[test]
fn points_of_one_treatment_are_explained_together() {
    let sets = [
        "coin.ratio=[1, 2, 3]",
        "surface.friction=[0, 0.3]",
        "surface.restitution=[0, 0.5]",
    ];
    let plan = parse(SMALL, &sets);
    let explanations = plan.explain();
    assert_eq!(
        explanations.iter().map(|e| e.points).collect::<Vec<_>>(),
        [3, 3, 3, 3]
    );
    let mentions = |i: usize, word: &str| {
        explanations[i]
            .skipped
            .iter()
            .any(|reason| reason.contains(word))
    };
    assert!(mentions(0, "restitution is 0") && mentions(0, "friction is 0"));
    assert!(mentions(1, "restitution is 0") && !mentions(1, "friction is 0"));
    assert!(!mentions(3, "restitution is 0") && !mentions(3, "friction is 0"));
    let adhesive = parse(
        SMALL,
        &["surface.landing=adhesive", sets[0], sets[1], sets[2]],
    );
    assert_eq!(adhesive.explain().len(), 1);
}

/// Laws that are tables reach the engine with their defaults, sweep like any number, and the
/// resolved config means the same.
#[test]
fn laws_of_impact_with_quantities_reach_the_engine() {
    use coinmc_flat::{GaekSukhov, HalfSine, Law, Lever, LineContact, PulseTime};
    let law = |text: &str| {
        let law = format!("engine.flat.law={text}");
        let plan = parse(SMALL, &[&law, "surface.friction=0"]);
        let again = config::parse("again", &plan.resolved_toml, &[]).unwrap();
        assert_eq!(plan.points, again.points);
        let laws = plan.points.iter().map(|point| {
            let settings: Option<&Settings> = point.engine.settings();
            settings.expect("flat").law
        });
        laws.collect::<Vec<_>>()
    };
    let lever = Lever::Height;
    assert_eq!(
        law("{ gaek-sukhov = { eta_n_s = [1e-3, 2e-3] } }")[..2],
        [1e-3, 2e-3].map(|eta_n_s| Law::GaekSukhov(GaekSukhov { eta_n_s, lever }))
    );
    let Law::LineContact(LineContact {
        materials,
        tangential,
    }) =
        law("{ line-contact = { coin_young_pa = 3e9, surface_young_pa = 1e10, length_m = 0.02 } }")
            [0]
    else {
        panic!("another law")
    };
    assert_eq!(
        (materials.coin_poisson, tangential),
        (0.3, LineContact::mindlin(0.3))
    );
    let contact = law(
        "{ half-sine = { peak_n = 9, contact = { coin_young_pa = 3e9, \
                       surface_young_pa = 1e10, length_m = 0.02 } } }",
    )[0];
    let time = PulseTime::Contact(materials);
    assert_eq!(
        contact,
        Law::HalfSine(HalfSine {
            time,
            peak_n: Some(9.0)
        })
    );
}

/// `--set` with a number of tosses takes the place of targets and of all that belongs to them, and the other way round.
#[test]
fn an_option_for_when_to_stop_replaces_the_other_way() {
    let targets = SMALL.replace(
        "tosses = 1000",
        "half_width = 0.01\nface = 'side'\nmax_tosses = 1e6",
    );
    let plan = parse(&targets, &["stop.tosses=500"]);
    assert_eq!(plan.stop, Stop::Tosses(500));
    let plan = parse(SMALL, &["stop.half_width=0.02", "stop.face=heads"]);
    let Stop::Targets(targets) = plan.stop else {
        panic!("{:?}", plan.stop);
    };
    assert_eq!(targets.half_width, Some(0.02));
}
