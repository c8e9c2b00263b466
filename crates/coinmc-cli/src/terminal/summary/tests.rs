use super::*;
use coinmc::config;
use coinmc::plan::StoppedBy;
use coinmc::results::fair_ratios;
use coinmc_analytic::Rule;
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
                StoppedBy::Tosses,
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
        Some(Path::new("runs/a/results.csv")),
        &Plotted::default(),
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
fn a_file_that_is_not_there_is_not_named() {
    let results = results(&sweep("{ from = 0.5, to = 2.5, steps = 100 }", "0.5"), 1.0);
    let plotted = "none".parse().unwrap();
    let text = summary(&results, &[], None, &plotted, &Style::plain(80));
    assert!(!text.contains("Results:"), "{text}");
    assert!(text.contains("\nAll 100 points: --format csv\n"), "{text}");
}

#[test]
fn a_curve_that_never_crosses_is_told() {
    let results = results(&sweep("[0.1, 0.2, 0.3]", "0.5"), 1.0);
    let text = text(&results, &Style::plain(80));
    assert!(
        text.contains("Fair ratio: none found in this sweep: the curve stays below 1/3\n"),
        "{text}"
    );
}

/// Where no toss shows a face nothing is near 1/3.
#[test]
fn a_curve_without_a_face_is_told() {
    let plan = config::parse("test", &sweep("[0.5, 1.0]", "[0.3, 1.0]"), &[]).expect("a config");
    let rows = (0..plan.points.len()).map(|i| {
        let decided = plan.points[i].scene.surface.restitution() < 1.0;
        let tally = Tally {
            heads: if decided { 10_000 } else { 0 },
            impact_limit: if decided { 0 } else { 10_000 },
            ..Tally::default()
        };
        Row::new(&plan, i, tally, StoppedBy::Tosses)
    });
    let text = text(&Results::new(&plan, rows.collect()), &Style::plain(200));
    let sentence =
        "restitution 0.3 stays below 1/3, restitution 1 has no toss that showed a face\n";
    assert!(text.contains(sentence), "{text}");
    assert!(text.contains("(50 %): 20 000 at the limit"), "{text}");
}

#[test]
fn a_share_says_all_only_of_all() {
    let shares =
        [(1, 1), (99_999, 100_000), (1003, 11_003), (1, 4000)].map(|(some, all)| share(some, all));
    assert_eq!(shares, ["100 %", "99.99 %", "9.12 %", "2.5e-4"]);
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
        .map(|i| Row::new(&plan, i, Tally::default(), StoppedBy::Tosses))
        .collect();
    let text = text(&Results::new(&plan, rows), &Style::plain(80));
    assert!(text.contains("0.500000 exact"), "{text}");
    assert!(!text.contains('±'), "{text}");
}

/// Tosses in space of the published Unity scene, with every hundredth on the side.
fn unity(more: &str, ratio: &str) -> Results {
    let config = format!(
        "coin = {{ ratio = {ratio}, radius_m = 0.5 }}\n\
         surface = {{ restitution = 0.3, friction = 10, restitution_threshold_m_s = 2, \
         rolling_friction_m = 0, pivoting_friction_m = 0 }}\n\
         environment = {{ linear_drag_per_s = 1, angular_drag_per_s = 0.05, \
         gyroscopic_torque = false }}\n\
         launch.preset = 'table1'\nengine.volumetric = {{}}\nstop.tosses = 10000\n"
    );
    let sets: Vec<config::Override> = more.lines().map(|set| set.parse().unwrap()).collect();
    let plan = config::parse("test", &config, &sets).unwrap_or_else(|p| panic!("{p}"));
    let tally = Tally {
        heads: 4950,
        tails: 4950,
        side: 100,
        ..Tally::default()
    };
    let rows = (0..plan.points.len()).map(|i| Row::new(&plan, i, tally, StoppedBy::Tosses));
    Results::new(&plan, rows.collect())
}

#[test]
fn published_counts_stand_beside_ours() {
    let results = unity("", "[0.03125, 0.5, 1]");
    let text = text(&results, &Style::plain(80));
    assert!(text.contains(include_str!("published.txt")), "\n{text}");
}

#[test]
fn published_counts_are_told_by_launch_and_ratio_alone() {
    let has = |more: &str, ratio: &str| {
        text(&unity(more, ratio), &Style::plain(80)).contains("Published for this launch")
    };
    assert!(has("", "5") && has("engine.volumetric.law=stronge", "0.25"));
    assert!(!has("", "2") && !has("launch.height_m=4", "1") && !has("launch.preset=clean", "1"));
    let text = text(
        &unity(
            "surface.rolling_friction_m=1e-3\nsurface.friction=[1, 10]",
            "1",
        ),
        &Style::plain(100),
    );
    assert!(
        text.contains("Not the published scene, it differs in: friction, rolling_friction_m.\n"),
        "{text}"
    );
}

#[test]
fn a_toss_in_space_is_compared_with_its_own_kind() {
    let config = "coin.ratio = [0.5, 1.0, 1.5]\n\
                  surface = { restitution = 0.5, friction = 0.3, rolling_friction_m = 1e-4 }\n\
                  launch.preset = 'clean'\nengine.volumetric = {}\nstop.tosses = 10000";
    let text = text(&results(config, 1.3), &Style::plain(80));
    for line in [
        "    0.7071      zone rule, no bounce\n",
        "    0.8 ± 0.05  Gaek & Sukhov, arXiv 2401.03557, Unity\n",
        "· zone rule (no bounce)   ┄ 1/3\n",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    assert!(!text.contains("flat"), "{text}");
}

#[test]
fn undecided_tosses_are_counted_by_why_not() {
    let mut results = unity("", "2");
    results.rows[0].tally.never_settles = 3;
    results.rows[0].tally.impact_limit = 1000;
    let text = text(&results, &Style::plain(100));
    assert!(
        text.contains("tosses (9.12 %): 3 forever, 1 000 at the limit of impacts or of steps\n"),
        "{text}"
    );
}

#[test]
fn tosses_on_the_side_are_told_by_how_they_came_there() {
    let mut results = unity("", "2");
    let plain = Style::plain(200);
    assert!(!text(&results, &plain).contains("On the side"));
    let tally = &mut results.rows[0].tally;
    (tally.side_rested, tally.side_rolled, tally.side_spun) = (10, 1000, 990);
    (tally.rolled_1_cm, tally.rolled_3_cm, tally.rolled_10_cm) = (1200, 500, 499);
    let sentence = "On the side: 2 000 tosses, 0.5 % came to rest where they landed, 50.0 % rolled, \
                    49.5 % spun; 25.0 % rolled more than 3 cm\n";
    let text = text(&results, &plain);
    assert!(text.contains(sentence), "{text}");
}

/// A column of its own, where a table has an edge.
#[test]
fn tosses_that_left_are_a_probability() {
    let space = sweep("[0.5, 1.0]", "0.5").replace("flat", "volumetric");
    let plain = Style::plain(200);
    assert!(!text(&results(&space, 1.0), &plain).contains("left"));
    let edge = space.replace("friction = 0.3", "friction = 0.3, table_radius_m = 0.2");
    let mut results = results(&edge, 1.0);
    let left = results.rows[0].side;
    results.rows[0].left = Some(left);
    let text = text(&results, &plain);
    let shown = format!("{:.4} ± {:.4}", left.p, left.half_width());
    let row = text
        .lines()
        .find(|line| line.contains("0.5 "))
        .expect("a row");
    assert!(
        text.contains("P(left)") && row.matches(&shown).count() == 2,
        "{text}"
    );
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
    let unity = unity("surface.rolling_friction_m=1e-3", "[0.03125, 1, 5]");
    for width in [60, 72, 100, 200] {
        for results in [&results, &unity] {
            for line in text(results, &Style::plain(width)).lines() {
                assert!(line.chars().count() <= width, "{width}: {line}");
            }
        }
    }
}

#[test]
fn another_axis_and_face_are_plotted_on_demand() {
    let results = results(
        &sweep("[0.5, 1.0, 1.5]", "{ from = 0.1, to = 0.9, steps = 5 }"),
        1.0,
    );
    let told = |plotted: &str| {
        let csv = Path::new("runs/a/results.csv");
        let fair = fair_ratios(&results, FAIR);
        summary(
            &results,
            &fair,
            Some(csv),
            &plotted.parse().unwrap(),
            &Style::plain(80),
        )
    };
    let text = told("restitution,heads");
    assert!(
        text.contains("\nP(heads)\n") && text.contains("\n       restitution\n"),
        "{text}"
    );
    assert!(
        text.contains("● ratio 0.5") && !text.contains("arc rule (no bounce)\n"),
        "{text}"
    );
    // 1/3 is fair for the side alone
    assert!(!text.contains("┄ 1/3"), "{text}");
    let text = told("tails");
    assert!(
        text.contains("\nP(tails)\n") && text.contains("· arc rule (no bounce)"),
        "{text}"
    );
    assert!(!told("none").contains('┤') && told("none").contains("Fair coin"));
}
