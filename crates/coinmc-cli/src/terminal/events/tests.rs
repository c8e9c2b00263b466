use super::rows::{Line, Row, lines};
use super::{Style, events};
use coinmc_core::{Ended, Face};
use coinmc_trace::{Trace, replay};

fn trace(config: &str, toss: u64) -> Trace {
    let plan = coinmc::config::parse("inline", config, &[]).expect("a good config");
    replay(&plan, 0, toss, 100.0).expect("a toss of the plan")
}

const FLAT: &str = "coin.ratio = 1.2\nsurface = { restitution = 0.5, friction = 0.3 }\n\
    launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 100";

fn shown(trace: &Trace) -> String {
    events(trace, false, &Style::plain(120))
}

#[test]
fn a_toss_is_shown_from_launch_to_end() {
    let trace = trace(FLAT, 5);
    let text = shown(&trace);
    let lines: Vec<&str> = text.lines().collect();
    assert!(
        lines[0].starts_with("Toss 5 of point 0, flat engine: H/R 1.2, R"),
        "{text}"
    );
    assert!(lines[2].starts_with("time, s  event"), "{text}");
    assert!(lines[3].contains("launched"), "{text}");
    assert!(text.contains("impact 1 "), "{text}");
    assert!(lines.iter().any(|line| line.contains("  ends")), "{text}");
    assert!(
        text.contains("Decided at ") && text.contains("can never cross it again"),
        "{text}"
    );
    assert!(
        lines.iter().all(|line| line.chars().count() <= 120),
        "{text}"
    );
}

/// The energy of each row is at most that of the row before.
#[test]
fn energy_is_a_fraction_of_that_at_balance() {
    let trace = trace(FLAT, 7);
    let rows = super::rows::rows(&trace);
    let barrier = trace.scene.gravity_m_s2() * trace.scene.coin.rim_distance_m();
    assert!(
        rows.windows(2)
            .all(|pair| pair[1].of_balance <= pair[0].of_balance + 1e-9)
    );
    assert!(rows.last().is_some_and(|row| row.of_balance < 1.0));
    assert!(
        rows.iter()
            .all(|row| (row.of_balance * barrier - row.energy_j_kg).abs() < 1e-12)
    );
    let impacts = rows.iter().filter(|row| row.is_impact);
    assert!(
        impacts
            .clone()
            .all(|row| row.rim_m_s.is_some_and(|speed| speed > 0.0))
    );
    assert_eq!(impacts.count() as u64, u64::from(trace.outcome.impacts));
}

fn row(time_s: f64) -> Row {
    Row {
        time_s,
        event: "impact".to_owned(),
        is_impact: true,
        goes_on: "flies",
        height_m: 0.01,
        energy_j_kg: 0.1,
        of_balance: 1.1,
        turns_s: 1.0,
        up: "heads",
        tilt_deg: 10.0,
        rim_m_s: Some(0.1),
    }
}

/// Fifty bounces within a hundredth of the time that toppling takes are one line.
#[test]
fn floods_of_small_bounces_are_one_line() {
    let mut rows: Vec<Row> = (0..50).map(|i| row(1.0 + 1e-4 * f64::from(i))).collect();
    rows.insert(0, row(0.0));
    rows.push(row(2.0));
    let shown_lines = lines(&rows, 0.03, false);
    assert_eq!(shown_lines.len(), 5, "{shown_lines:?}");
    assert!(matches!(shown_lines[2], Line::Group(group) if group.len() == 48));
    assert_eq!(lines(&rows, 0.03, true).len(), 52);
    assert_eq!(super::grouped(&rows[2..50]), "48 impacts in 4.700 ms");
}

#[test]
fn a_long_table_shows_its_ends() {
    let rows: Vec<Row> = (0..1000).map(|i| row(f64::from(i))).collect();
    let shown_lines = lines(&rows, 0.03, false);
    assert_eq!(shown_lines.len(), 51);
    assert!(matches!(shown_lines[25], Line::Hidden(hidden) if hidden.len() == 950));
    assert!(lines(&rows, 0.03, true).len() == 1000);
}

#[test]
fn every_end_has_its_sentence() {
    let mut trace = trace(FLAT, 5);
    for (ended, says) in [
        (Ended::NeverSettles, "never settles"),
        (Ended::TimeLimit, "time_limit"),
        (Ended::ImpactLimit, "limit of impacts"),
        (Ended::Failed, "not a number"),
        (Ended::Decided(Face::Side), "It comes to rest on its side."),
    ] {
        trace.outcome.ended = ended;
        let text = shown(&trace);
        assert!(text.contains(says), "{text}");
    }
    trace.outcome.overruled = true;
    assert!(
        shown(&trace).contains("named its side"),
        "{}",
        shown(&trace)
    );
    let adhesive = FLAT.replace("restitution = 0.5", "landing = 'adhesive', restitution = 0");
    let text = shown(&self::trace(&adhesive, 5));
    assert!(text.contains("landing is adhesive"), "{text}");
}

#[test]
fn a_terminal_of_ascii_gets_ascii() {
    let text = events(&trace(FLAT, 5), false, &Style::ascii(80));
    assert!(text.is_ascii() && !text.contains('?'), "{text}");
}
