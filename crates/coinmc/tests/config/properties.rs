//! What holds for every config: the resolved text means the same, and no text makes it panic.

use coinmc::config::{self, Override};
use proptest::prelude::*;

fn number(low: f64, high: f64) -> impl Strategy<Value = String> {
    let value = move || (0.0..1.0).prop_map(move |t| low + (high - low) * t);
    prop_oneof![
        4 => value().prop_map(|x| format!("{x:?}")),
        1 => prop::collection::btree_set(0..1000_u32, 1..4).prop_map(move |steps| {
            let values = steps.iter().rev().map(|i| low + (high - low) * f64::from(*i) / 1000.0);
            format!("{:?}", values.collect::<Vec<f64>>())
        }),
        1 => (0.0..0.4, 0.6..1.0, 2..5, any::<bool>()).prop_map(move |(a, b, steps, log)| {
            let (from, to) = (low + (high - low) * a, low + (high - low) * b);
            let scale = if log && from > 0.0 { "log" } else { "linear" };
            format!("{{ from = {from:?}, to = {to:?}, steps = {steps}, scale = '{scale}' }}")
        }),
    ]
}

fn marginal(low: f64, high: f64) -> impl Strategy<Value = String> {
    let middle = f64::midpoint(low, high);
    prop_oneof![
        number(low, high),
        (number(low, middle), number(middle + 1.0, high + 2.0))
            .prop_map(|(from, to)| format!("{{ uniform = {{ from = {from}, to = {to} }} }}")),
        (number(low, high), number(0.0, 1.0))
            .prop_map(|(mean, sd)| format!("{{ normal = {{ mean = {mean}, sd = {sd} }} }}")),
    ]
}

fn launch() -> impl Strategy<Value = String> {
    let preset = prop_oneof![Just("robot"), Just("clean-flat")];
    let own = (
        marginal(0.0, 5.0),
        marginal(-90.0, 90.0),
        marginal(-50.0, 50.0),
    )
        .prop_map(|(height, tilt, rate)| {
            format!(
                "height_m = {height}\norientation = {{ tilt_deg = {tilt} }}\n\
                 spin = {{ about = {{ axis = [0, 2, 0], rate_rad_s = {rate} }} }}\n"
            )
        });
    prop_oneof![
        preset.prop_map(|name| format!("preset = '{name}'\n")),
        (marginal(-3.0, 3.0), marginal(0.0, 3.0))
            .prop_map(|(x, z)| format!("preset = 'robot'\nvelocity_m_s = [{x}, 0, {z}]\n")),
        own
    ]
}

fn stop() -> impl Strategy<Value = String> {
    prop_oneof![
        (1_u64..=1_000_000_000_000_000).prop_map(|n| format!("tosses = {n}")),
        (1e-7..0.4, 1_u64..1_000_000)
            .prop_map(|(w, n)| format!("half_width = {w:?}\nmax_tosses = {n}")),
    ]
}

/// The engine with all that goes with it: more keys of `[surface]`, `[environment]`, `[engine.…]`.
fn engine() -> impl Strategy<Value = (String, String, String)> {
    let flat = number(1e-3, 1.0).prop_map(|zeno| {
        let engine = format!("[engine.flat]\nzeno = {zeno}\n");
        (String::new(), String::new(), engine)
    });
    let lengths = prop_oneof![
        (number(0.0, 1e-3), number(0.0, 1e-3)).prop_map(|(contour, pivoting)| format!(
            "rolling_friction_m = {contour}\npivoting_friction_m = {pivoting}\n"
        )),
        number(0.0, 1e-3).prop_map(|patch| format!("contact_patch_m = {patch}\n")),
        Just("material = 'glass'\n".to_owned()),
    ];
    let contact = (lengths, 0.0..2.0);
    let air = (number(0.0, 1.0), 0.0..1.0, any::<bool>());
    let laws = prop_oneof![Just("moreau"), Just("chatterjee-ruina"), Just("stronge")];
    let settings = (laws, number(1e-4, 0.1), 1e-3..1e9);
    let in_space = (contact, air, settings).prop_map(
        |((lengths, threshold), (linear, angular, torque), (law, stick, limit))| {
            let surface = format!("{lengths}restitution_threshold_m_s = {threshold:?}\n");
            let environment = format!(
                "[environment]\nlinear_drag_per_s = {linear}\nangular_drag_per_s = {angular:?}\n\
                 gyroscopic_torque = {torque}\n"
            );
            let engine = format!(
                "[engine.volumetric]\nlaw = '{law}'\nstick_speed = {stick}\ntime_limit = {limit:?}\n"
            );
            (surface, environment, engine)
        },
    );
    prop_oneof![flat, in_space]
}

fn good() -> impl Strategy<Value = String> {
    let coin = (number(0.1, 10.0), number(1e-3, 1.0), number(0.001, 1.0));
    let surface = (number(0.0, 1.0), number(0.0, 2.0), any::<bool>());
    let whole = (0..=i64::MAX as u64, any::<bool>(), 0.5..0.999);
    (coin, surface, launch(), stop(), whole, engine()).prop_map(
        |(
            (ratio, radius, mass),
            (e, mu, sticky),
            launch,
            stop,
            (seed, paired, confidence),
            (contact, environment, engine),
        )| {
            let landing = if sticky { "adhesive" } else { "bouncing" };
            format!(
                "seed = {seed}\npaired = {paired}\n[estimate]\nconfidence = {confidence:?}\n\
                 [coin]\nratio = {ratio}\nradius_m = {radius}\nmass_kg = {mass}\n\
                 [surface]\nrestitution = {e}\nfriction = {mu}\nlanding = '{landing}'\n\
                 {contact}{environment}{engine}[launch]\n{launch}[stop]\n{stop}\n"
            )
        },
    )
}

/// Pieces that bad configs are made of, so that random texts get past the TOML parser.
fn fragment() -> impl Strategy<Value = String> {
    let pieces = [
        "[coin]\n",
        "[surface]\n",
        "[launch]\n",
        "[engine.flat]\n",
        "[stop]\n",
        "[[coin]]\n",
        "ratio",
        "friction",
        "preset",
        "spin",
        "height_m",
        "velocity_m_s",
        "orientation",
        "tosses",
        "half_width",
        "decision",
        "steps",
        "from",
        "to",
        "scale",
        "uniform",
        "normal",
        " = ",
        "=",
        "{ ",
        " }",
        "[",
        "]",
        ", ",
        ".",
        "\n",
        "'",
        "\"",
        "#",
        "1",
        "0",
        "-1",
        "1e400",
        "nan",
        "inf",
        "1.5",
        "0x1F",
        "1979-05-27",
        "true",
        "'robot'",
        "'log'",
        "µ",
        "\u{feff}",
        "\r",
    ];
    prop::collection::vec(prop::sample::select(pieces.to_vec()), 0..40)
        .prop_map(|pieces| pieces.concat())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn the_resolved_text_gives_the_same_plan(text in good()) {
        let plan = config::parse("a.toml", &text, &[]).unwrap_or_else(|e| panic!("{text}\n{e}"));
        let again = config::parse("b.toml", &plan.resolved_toml, &[]).unwrap();
        // but for the remarks on what it now spells out
        let again = coinmc::plan::Plan { notes: plan.notes.clone(), ..again };
        prop_assert_eq!(&plan, &again);
        prop_assert_eq!(plan.hash(), again.hash());
        let explained: usize = plan.explain().iter().map(|e| e.points).sum();
        prop_assert_eq!(explained, plan.points.len());
    }

    #[test]
    fn no_text_makes_it_panic(text in prop_oneof![any::<String>(), fragment()]) {
        if let Err(diagnostics) = config::parse("a.toml", &text, &[]) {
            prop_assert!(!diagnostics.problems().is_empty());
            prop_assert!(!diagnostics.render(true).is_empty());
        }
    }

    #[test]
    fn no_damage_makes_it_panic(text in good(), at in any::<prop::sample::Index>(), piece in fragment()) {
        let at = text.floor_char_boundary(at.index(text.len()));
        let damaged = format!("{}{piece}{}", &text[..at], &text[at..]);
        if let Err(diagnostics) = config::parse("a.toml", &damaged, &[]) {
            prop_assert!(!diagnostics.render(false).is_empty());
        }
    }

    #[test]
    fn no_override_makes_it_panic(text in prop_oneof![any::<String>(), fragment()]) {
        if let Ok(set) = text.parse::<Override>()
            && let Err(diagnostics) = config::parse("a.toml", "[coin]\nratio = 1", &[set])
        {
            prop_assert!(!diagnostics.render(false).is_empty());
        }
    }
}
