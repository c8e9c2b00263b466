//! Numbers that may be given in several ways: lengths of the coin, friction over the radius, spin.

use crate::support::{SMALL, column, parse};
use coinmc::config;
use coinmc_core::{Marginal, Spin};

/// SMALL with this table of the coin.
fn with_coin(coin: &str) -> String {
    SMALL.replace("ratio = 1.2", coin)
}

fn problems(text: &str) -> String {
    let found = config::parse("test.toml", text, &[]);
    found.expect_err("a bad config").render(false)
}

#[test]
fn lengths_of_the_coin_are_the_same_plan_as_its_ratio_and_radius() {
    let by_ratio = parse(&with_coin("ratio = 1.2\nradius_m = 0.011625"), &[]);
    for lengths in [
        "height_m = 0.01395\nradius_m = 0.011625",
        "height_mm = 13.95\nradius_mm = 11.625",
        "thickness_m = 0.01395\ndiameter_m = 0.02325",
        "thickness_mm = 13.95\ndiameter_mm = 23.25",
        "ratio = 1.2\ndiameter_mm = 23.25",
    ] {
        assert_eq!(
            parse(&with_coin(lengths), &[]).hash(),
            by_ratio.hash(),
            "{lengths}"
        );
    }
    let swept = parse(&with_coin("thickness_mm = [5, 10, 15]"), &[]);
    assert_eq!(
        (swept.axes.as_slice(), column(&swept, "ratio")),
        (&["ratio".to_owned()][..], vec![0.5, 1.0, 1.5])
    );
    let again = parse(&swept.resolved_toml, &[]);
    assert_eq!(again.hash(), swept.hash());
}

#[test]
fn lengths_that_contradict_each_other_are_reported() {
    for (coin, message) in [
        (
            "radius_m = 0.01",
            "`ratio` is missing in `coin` (required unless `height_m` is given",
        ),
        (
            "ratio = 1\nheight_mm = 5",
            "only one of `ratio`, `height_mm` is allowed",
        ),
        (
            "ratio = 1\nradius_m = 0.01\ndiameter_mm = 5",
            "only one of `radius_m`, `diameter_mm`",
        ),
        (
            "height_mm = 5\nradius_mm = [5, 6]",
            "`coin.height_mm` does not go with a sweep of radii",
        ),
        ("height_m = 1e6\nradius_m = 1e-8", "H/R is 1e14: it must be"),
        ("height_mm = 0", "`coin.height_mm` must be"),
    ] {
        let text = problems(&with_coin(coin));
        assert!(text.contains(message), "{coin}\n{text}");
    }
}

#[test]
fn an_override_replaces_what_says_the_same() {
    let text = with_coin("thickness_mm = 5\ndiameter_mm = 20");
    let plan = parse(&text, &["coin.ratio=1.2", "coin.radius_m=0.02"]);
    assert_eq!(column(&plan, "ratio"), [1.2]);
    assert_eq!(column(&plan, "radius_m"), [0.02]);
}

#[test]
fn friction_lengths_are_fractions_of_the_radius() {
    let text = "coin = { ratio = 1, radius_m = [0.01, 0.02] }\nlaunch.preset = 'clean'\n\
                engine.volumetric = {}\nstop.tosses = 10\n[surface]\nrestitution = 0.5\nfriction = 0.3\n\
                rolling_friction_over_radius = 0.005\npivoting_friction_over_radius = 0.25\n";
    let plan = parse(text, &[]);
    assert_eq!(column(&plan, "rolling_friction_m"), [5e-5, 1e-4]);
    assert_eq!(column(&plan, "pivoting_friction_m"), [0.0025, 0.005]);
    assert!(plan.notes.is_empty(), "{:?}", plan.notes);
    let both = problems(&format!("{text}rolling_friction_m = 1e-4"));
    assert!(both.contains("only one of `rolling_friction_m`"), "{both}");
    let flat = problems(&text.replace("volumetric", "flat").replace("clean", "robot"));
    assert!(flat.contains("models no rolling friction"), "{flat}");
}

#[test]
fn an_isotropic_spin_is_one_number() {
    let text = SMALL.replace("flat", "volumetric").replace(
        "preset = 'robot'",
        "preset = 'clean'\nspin = { isotropic_sd_rad_s = [0, 20] }",
    );
    let plan = parse(&text, &[]);
    assert_eq!(plan.axes, ["launch.spin.isotropic_sd_rad_s"]);
    let normal = Marginal::Normal {
        mean: 0.0,
        sd: 20.0,
    };
    assert_eq!(plan.points[1].launches.spin, Spin::Components([normal; 3]));
    let still = Spin::Components([Marginal::Constant(0.0); 3]);
    assert_eq!(plan.points[0].launches.spin, still);
}

#[test]
fn an_override_of_a_part_of_a_preset_keeps_the_rest() {
    let plan = parse(SMALL, &["launch.spin.about.rate_rad_s=7"]);
    let whole = SMALL.replace(
        "preset = 'robot'",
        "preset = 'robot'\nspin = { about = { axis = [0, 1, 0], rate_rad_s = 7 } }",
    );
    assert_eq!(plan.hash(), parse(&whole, &[]).hash());
    let deep = parse(SMALL, &["launch.spin.about.rate_rad_s.uniform.to=7"]);
    assert!(
        deep.resolved_toml.contains("{ from = 0.0, to = 7.0 }"),
        "{}",
        deep.resolved_toml
    );
    // another kind of spin takes the place of the preset's
    let other = parse(
        &SMALL.replace("flat", "volumetric"),
        &["launch.spin.isotropic_sd_rad_s=5"],
    );
    assert!(other.resolved_toml.contains("isotropic_sd_rad_s = 5.0"));
}

#[test]
fn seeds_are_whole_numbers_of_64_bits() {
    let plan = parse(SMALL, &["seed=18446744073709551615"]);
    assert_eq!(plan.seed, u64::MAX);
    assert_eq!(parse(&plan.resolved_toml, &[]).hash(), plan.hash());
    let text = problems(&format!("seed = 18446744073709551616\n{SMALL}"));
    assert!(text.contains("from 0 to 18446744073709551615"), "{text}");
}
