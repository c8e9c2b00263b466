//! Rendered messages against expected files. `UPDATE_EXPECTED=1` writes them.

use crate::support::SMALL;
use coinmc::config::{self, Override};
use std::path::Path;

fn expect(name: &str, text: &str, overrides: &[&str]) {
    let overrides: Vec<Override> = overrides.iter().map(|o| o.parse().unwrap()).collect();
    let rendered = config::parse("toss.toml", text, &overrides)
        .unwrap_err()
        .to_string()
        + "\n";
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/config/expected/{name}.txt"));
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        std::fs::write(&path, &rendered).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(rendered, expected, "{name}");
}

fn with(coin: &str) -> String {
    SMALL.replace("ratio = 1.2", coin)
}

#[test]
fn a_mistyped_key() {
    expect("mistyped_key", &with("ratoi = 1.2"), &[]);
}

#[test]
fn a_number_out_of_range() {
    expect(
        "out_of_range",
        &with("ratio = -1.2   # µ, the line has more in it"),
        &[],
    );
}

#[test]
fn a_wrong_type() {
    expect("wrong_type", &with("ratio = 'thick'"), &[]);
}

#[test]
fn a_sweep_too_large() {
    let coin = "ratio = { from = 1, to = 2, steps = 1_000_000 }\nradius_m = [0.01, 0.02]";
    expect("sweep_too_large", &with(coin), &[]);
}

#[test]
fn an_empty_document() {
    expect("empty", "", &[]);
}

#[test]
fn a_syntax_error() {
    expect("syntax", &with("ratio = [1, 2"), &[]);
}

#[test]
fn a_launch_out_of_the_plane() {
    expect(
        "not_planar",
        &with("ratio = 1").replace("robot", "hand"),
        &[],
    );
}

#[test]
fn an_impossible_moment() {
    expect(
        "moment",
        &with("ratio = [1, 2]\naxial_moment_kg_m2 = 0.1"),
        &[],
    );
}

#[test]
fn one_of_two_roughness_keys() {
    let text =
        with("ratio = 1").replace("friction = 0.3", "friction = 0.3\nroughness_slope = 0.05");
    let text = text.replace("[engine.flat]", "[engine.volumetric]");
    expect("half_roughness", &text, &[]);
}

#[test]
fn waves_too_short_for_the_coin() {
    let rough = "friction = 0.3\nroughness_slope = 0.05\nroughness_wavelength_m = [1e-3, 4e-5]";
    let text = with("ratio = 1").replace("friction = 0.3", rough);
    expect(
        "short_waves",
        &text.replace("[engine.flat]", "[engine.volumetric]"),
        &[],
    );
}

#[test]
fn a_reference_speed_without_an_exponent() {
    let text = with("ratio = 1");
    expect(
        "reference_alone",
        &text,
        &["surface.restitution_reference_m_s=2"],
    );
}

#[test]
fn an_unknown_material() {
    let text = with("ratio = 1").replace("friction = 0.3", "material = 'woood'");
    expect("unknown_material", &text, &[]);
}

#[test]
fn pivoting_friction_twice() {
    let twice = "friction = 0.3\ncontact_patch_m = 3e-5\npivoting_friction_m = 5e-6";
    let text = with("ratio = 1").replace("friction = 0.3", twice);
    expect(
        "pivoting_twice",
        &text.replace("[engine.flat]", "[engine.volumetric]"),
        &[],
    );
}

#[test]
fn roughness_on_an_engine_without() {
    let rough = "friction = 0.3\nroughness_slope = 0.05\nroughness_wavelength_m = 1e-3\n\
                 restitution_exponent = 0.25";
    let text = with("ratio = 1").replace("friction = 0.3", rough);
    expect(
        "rough_rapier",
        &text.replace("[engine.flat]", "[engine.rapier]"),
        &[],
    );
}

#[test]
fn two_engines() {
    let text = with("ratio = 1") + "[engine.analytic]\nrule = 'zoen'\n";
    expect("two_engines", &text, &[]);
}

#[test]
fn bad_overrides() {
    let sets = [
        "surface.friction=abc",
        "coin.ratio=[1,",
        "stop.tosses=",
        "stop.toses=5",
        "launch.preset=clean",
    ];
    expect("overrides", &with("ratio = 1"), &sets);
}

#[test]
fn control_characters_do_not_reach_the_terminal() {
    let text = with("ratio = 1") + "\"\\u001b[31mred\" = '\u{202e}'\n";
    let rendered = config::parse("a\u{1b}[0m.toml", &text, &[])
        .unwrap_err()
        .render(false);
    assert!(
        !rendered.contains('\u{1b}') && !rendered.contains('\u{202e}'),
        "{rendered:?}"
    );
}

#[test]
fn colour_adds_only_escapes() {
    let diagnostics = config::parse("toss.toml", "", &[]).unwrap_err();
    let coloured = diagnostics.render(true);
    assert!(coloured.contains("\u{1b}["));
    let mut plain = String::new();
    let mut pieces = coloured.split("\u{1b}[");
    plain.push_str(pieces.next().unwrap());
    for piece in pieces {
        plain.push_str(piece.split_once('m').unwrap().1);
    }
    assert_eq!(plain, diagnostics.render(false));
}
