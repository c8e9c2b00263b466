//! Materials, and what a surface has where the config does not say it.

use crate::support::{SMALL, column, parse};
use coinmc::config;
use coinmc::plan::Plan;
use coinmc_core::{Material, pivoting_friction_of_patch_m};

/// A toss in space onto a surface with these keys.
fn on(surface: &str) -> String {
    format!(
        "[coin]\nratio = 0.5\n[surface]\n{surface}\n[launch]\npreset = 'clean'\n[engine.volumetric]\n\
         [stop]\ntosses = 1000\n"
    )
}

/// The plan as its resolved config gives it: equal but for the remarks on what it now spells out.
fn again(plan: &Plan) -> Plan {
    let read = parse(&plan.resolved_toml, &[]);
    assert_eq!(read.hash(), plan.hash());
    Plan {
        notes: plan.notes.clone(),
        ..read
    }
}

#[test]
fn absent_friction_lengths_are_estimated_in_space_and_said() {
    let plan = parse(&on("restitution = 0.5\nfriction = [0.2, 0.4]"), &[]);
    assert_eq!(column(&plan, "rolling_friction_m"), [5e-5, 5e-5]);
    let of_patch = [0.2, 0.4].map(|friction| pivoting_friction_of_patch_m(friction, 3e-5));
    assert_eq!(column(&plan, "pivoting_friction_m"), of_patch);
    let [rolling, pivoting] = &plan.notes[..] else {
        panic!("{:?}", plan.notes)
    };
    assert!(
        rolling.starts_with("surface.rolling_friction_m is not given: taken as 5e-5 (estimate")
    );
    assert!(pivoting.starts_with("surface.pivoting_friction_m is not given: taken as (3π/16)"));
    for line in ["rolling_friction_m = 5e-5\n", "contact_patch_m = 3e-5\n"] {
        assert!(plan.resolved_toml.contains(line), "{}", plan.resolved_toml);
    }
    assert_eq!(again(&plan), plan);
    let stepped = on("restitution = 0.5\nfriction = 0.3").replace("volumetric", "rapier");
    let stepped = parse(&stepped, &[]);
    assert_eq!(column(&stepped, "rolling_friction_m"), [5e-5]);
    assert_eq!(stepped.notes.len(), 3, "{:?}", stepped.notes);
}

#[test]
fn zero_stays_zero_where_it_is_given_or_nothing_asks_for_more() {
    let lengths = |plan: &Plan| {
        (
            column(plan, "rolling_friction_m")[0],
            column(plan, "pivoting_friction_m")[0],
        )
    };
    let given =
        "restitution = 0.5\nfriction = 0.3\nrolling_friction_m = 0\npivoting_friction_m = 0";
    let plan = parse(&on(given), &[]);
    assert_eq!(lengths(&plan), (0.0, 0.0));
    assert!(!plan.notes.iter().any(|note| note.contains("is not given")));
    let patch = parse(
        &on("restitution = 0.5\nfriction = 0.3\ncontact_patch_m = 0"),
        &[],
    );
    assert_eq!(lengths(&patch), (5e-5, 0.0));
    for text in [SMALL.to_owned(), on("landing = 'adhesive'")] {
        let plan = parse(&text, &[]);
        assert_eq!(lengths(&plan), (0.0, 0.0));
        assert!(plan.notes.is_empty(), "{:?}", plan.notes);
        let explicit = "\npivoting_friction_m = 0.0\nrestitution_threshold_m_s";
        assert!(
            plan.resolved_toml.contains(explicit),
            "{}",
            plan.resolved_toml
        );
    }
}

#[test]
fn a_material_gives_every_number_that_is_absent() {
    for material in &Material::ALL {
        let plan = parse(&on(&format!("material = '{}'", material.name)), &[]);
        for (key, number) in material.numbers() {
            if key != "contact_patch_m" {
                assert_eq!(
                    column(&plan, key),
                    [number.value],
                    "{} {key}",
                    material.name
                );
            }
        }
        assert!(plan.notes.is_empty(), "{:?}", plan.notes);
        assert!(!plan.resolved_toml.contains("material"));
        assert_eq!(again(&plan), plan);
    }
}

#[test]
fn a_number_replaces_that_of_the_material_and_says_so() {
    let plan = parse(
        &on(
            "material = 'wood'\nfriction = [0.2, 0.4]\nroughness_slope = 0\npivoting_friction_m = 1e-6",
        ),
        &[],
    );
    assert_eq!(column(&plan, "friction"), [0.2, 0.4]);
    assert_eq!(column(&plan, "restitution"), [0.5, 0.5]);
    assert_eq!(column(&plan, "pivoting_friction_m"), [1e-6, 1e-6]);
    assert_eq!(column(&plan, "roughness_wavelength_m"), [3e-3, 3e-3]);
    assert!(plan.points[0].scene.surface.roughness().is_none());
    assert_eq!(
        plan.notes,
        [
            "surface.friction is given and replaces the friction = 0.3 of material = \"wood\"",
            "surface.pivoting_friction_m is given and replaces the contact_patch_m = 4.7e-5 of material \
             = \"wood\"",
            "surface.roughness_slope is given and replaces the roughness_slope = 0.05 of material = \
             \"wood\"",
        ]
    );
    assert_eq!(again(&plan), plan);
}

#[test]
fn engines_take_of_a_material_what_they_model() {
    let wood = SMALL.replace("restitution = 0.5\nfriction = 0.3", "material = 'wood'");
    let plan = parse(&wood, &[]);
    assert_eq!(column(&plan, "restitution"), [0.5]);
    assert_eq!(column(&plan, "rolling_friction_m"), [0.0]);
    assert_eq!(
        plan.notes,
        [
            "material = \"wood\" without its rolling_friction_m, contact_patch_m, roughness_slope and \
             roughness_wavelength_m: engine.flat does not model them"
        ]
    );
    assert_eq!(again(&plan), plan);
    let frictionless = parse(&wood, &["engine.flat.law={gaek-sukhov={eta_n_s=1e-3}}"]);
    assert_eq!(column(&frictionless, "friction"), [0.0]);
    let rapier = on("material = 'wood'").replace("volumetric", "rapier");
    let plan = parse(&rapier, &[]);
    assert_eq!(column(&plan, "rolling_friction_m"), [5e-5]);
    assert_eq!(column(&plan, "roughness_slope"), [0.0]);
    let adhesive = parse(&on("material = 'wood'\nlanding = 'adhesive'"), &[]);
    assert_eq!(column(&adhesive, "friction"), [0.0]);
    assert!(adhesive.notes[0].starts_with("surface.material = \"wood\" changes nothing"));
}

/// Whatever does not know the edge of a table refuses it, and says who does.
#[test]
fn the_edge_of_a_table_is_refused_where_it_is_not_modelled() {
    let table = |keys: &str| on(&format!("material = 'felt'\n{keys}"));
    let good = table("table_radius_m = [0.1, 0.2]");
    assert_eq!(column(&parse(&good, &[]), "table_radius_m"), [0.1, 0.2]);
    assert_eq!(column(&parse(&table(""), &[]), "table_radius_m"), [0.0]);
    for engine in ["flat", "rapier", "analytic"] {
        let text = good.replace("engine.volumetric", &format!("engine.{engine}"));
        let problems = config::parse("bad.toml", &text, &[])
            .unwrap_err()
            .to_string();
        assert!(
            problems.contains("table_radius_m` must be absent")
                && problems.contains("bad.toml:5:")
                && problems.contains("[engine.volumetric]"),
            "{problems}"
        );
    }
    for radius in ["0", "-1", "1e9", "'wide'"] {
        let text = table(&format!("table_radius_m = {radius}"));
        let problems = config::parse("bad.toml", &text, &[])
            .unwrap_err()
            .to_string();
        assert!(problems.contains("`surface.table_radius_m`"), "{problems}");
    }
}

/// Whatever knows level tables only refuses a tilted one, and a tilt that friction cannot hold is none.
#[test]
fn a_tilted_table_is_refused_where_it_is_not_modelled() {
    let table = |keys: &str| on(&format!("material = 'felt'\n{keys}"));
    let good = table("table_tilt_deg = [0, 2.5]\ntable_downhill_deg = 90");
    assert_eq!(column(&parse(&good, &[]), "table_tilt_deg"), [0.0, 2.5]);
    assert_eq!(
        column(&parse(&good, &[]), "table_downhill_deg"),
        [0.0, 90.0]
    );
    let refused = |text: &str| {
        let plan = config::parse("bad.toml", text, &[]);
        plan.expect_err("refused").to_string()
    };
    for engine in ["flat", "rapier", "analytic"] {
        let problems = refused(&good.replace("engine.volumetric", &format!("engine.{engine}")));
        assert!(
            problems.contains("`surface.table_tilt_deg` must be 0")
                && problems.contains("bad.toml:5:")
                && problems.contains("[engine.volumetric]"),
            "{problems}"
        );
    }
    for (keys, word) in [
        ("table_tilt_deg = 11", "`surface.table_tilt_deg`"),
        ("table_tilt_deg = -1", "`surface.table_tilt_deg`"),
        ("table_downhill_deg = 90", "`table_downhill_deg`"),
        (
            "friction = 0.05\ntable_tilt_deg = 3",
            "needs friction above tan 3",
        ),
        (
            "landing = 'adhesive'\ntable_tilt_deg = 3",
            "adhesive landing on a tilted table",
        ),
    ] {
        let problems = refused(&table(keys));
        assert!(problems.contains(word), "{keys}: {problems}");
    }
}

/// Values that only contradict each other, in the coin and on its surface, are all told at once, and no
/// more than these: each is counted as absent while the others are looked for.
#[test]
fn contradictions_of_a_scene_are_told_at_once() {
    let mut text =
        on("material = 'wood'\nroughness_wavelength_m = 1e-6\nfriction = 0.05\ntable_tilt_deg = 3");
    text = text.replace(
        "[surface]",
        "rim_radius_m = 1.0\naxial_moment_kg_m2 = 9.0\n[surface]",
    );
    let problems = config::parse("bad.toml", &text, &[]).expect_err("refused");
    let told = problems.problems().iter();
    let told: Vec<_> = told.map(|problem| problem.message.as_str()).collect();
    let words = ["rim radius", "axial", "wavelength", "needs friction above"];
    assert_eq!(told.len(), words.len(), "{problems}");
    for word in words {
        let telling = told.iter().filter(|message| message.contains(word));
        assert_eq!(telling.count(), 1, "{word}: {problems}");
    }
}
