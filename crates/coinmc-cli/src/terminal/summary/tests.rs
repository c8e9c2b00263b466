use super::*;
use coinmc::config;
use coinmc::results::fair_ratios;
use coinmc_core::Tally;

/// Results of a config with made-up counts: P(side) after the arc rule times `share`, less where
/// the coin bounces more.
fn results(config: &str, share: f64) -> Results {
    let plan = config::parse("test", config, &[]).unwrap_or_else(|problems| panic!("{problems}"));
    let rows = (0..plan.points.len())
        .map(|i| {
            let scene = &plan.points[i].scene;
            let share = share * (1.0 - 0.3 * scene.surface.restitution());
            let p = Rule::Arc.p_side(scene.coin.ratio()) * share;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let side = (p * 10_000.0) as u64;
            let heads = (10_000 - side) / 2;
            let tails = 10_000 - side - heads - 1;
            Row::new(
                &plan,
                i,
                Tally {
                    heads,
                    tails,
                    side,
                    time_limit: 1,
                    ..Tally::default()
                },
                true,
            )
        })
        .collect();
    Results::new(&plan, rows)
}

fn sweep(ratio: &str, restitution: &str) -> String {
    format!(
        "coin.ratio = {ratio}\nsurface = {{ restitution = {restitution}, friction = 0.3 }}\n\
         launch.preset = 'robot'\nengine.flat = {{}}\nstop.tosses = 10000"
    )
}

fn text(results: &Results, style: &Style) -> String {
    summary(
        results,
        &fair_ratios(results, FAIR),
        Path::new("runs/a/results.csv"),
        style,
    )
}

#[test]
fn a_sweep_with_two_axes() {
    let results = results(
        &sweep("{ from = 0.5, to = 2.5, steps = 5 }", "[0.3, 0.5]"),
        0.8,
    );
    let text = text(&results, &Style::plain(80));
    assert_eq!(text, include_str!("two_axes.txt"), "\n{text}");
}

#[test]
fn a_single_point_is_a_table_of_one_row() {
    let text = text(&results(&sweep("1.0", "0.5"), 1.0), &Style::ascii(80));
    assert_eq!(text, include_str!("single_point.txt"), "\n{text}");
}

#[test]
fn a_curve_that_never_crosses_is_told() {
    let results = results(&sweep("[0.1, 0.2, 0.3]", "0.5"), 1.0);
    let text = text(&results, &Style::plain(80));
    assert!(
        text.contains("Fair ratio: none in this sweep, 1 curve stays below 1/3\n"),
        "{text}"
    );
}

#[test]
fn a_long_sweep_shows_its_ends_and_names_the_file() {
    let results = results(&sweep("{ from = 0.5, to = 2.5, steps = 101 }", "0.5"), 0.8);
    let text = text(&results, &Style::plain(80));
    assert!(text.contains("… 61 more rows …\n"), "{text}");
    assert!(
        text.contains("All 101 points: runs/a/results.csv\n"),
        "{text}"
    );
}

#[test]
fn closed_forms_are_exact_and_have_no_interval() {
    let config = "coin.ratio = [1.0, 2.0]\nengine.analytic.rule = 'arc'";
    let plan = config::parse("test", config, &[]).unwrap();
    let rows = (0..2)
        .map(|i| Row::new(&plan, i, Tally::default(), true))
        .collect();
    let text = text(&Results::new(&plan, rows), &Style::plain(80));
    assert!(text.contains("0.500000 exact"), "{text}");
    assert!(!text.contains('±'), "{text}");
}

#[test]
fn axes_side_by_side_make_one_curve() {
    let config = sweep("[0.5, 1.0, 1.5]", "[0.3, 0.4, 0.5]") + "\nsweep.mode = 'zip'";
    let text = text(&results(&config, 1.0), &Style::plain(80));
    assert_eq!(text.matches('●').count(), 3, "{text}");
}

#[test]
fn nothing_is_wider_than_the_terminal() {
    let results = results(
        &sweep("{ from = 0.5, to = 2.5, steps = 9 }", "[0.3, 0.5, 0.7]"),
        0.8,
    );
    for width in [60, 72, 100, 200] {
        for line in text(&results, &Style::plain(width)).lines() {
            assert!(line.chars().count() <= width, "{width}: {line}");
        }
    }
}
