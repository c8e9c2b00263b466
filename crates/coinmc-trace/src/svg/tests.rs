use super::{picture, units, write};
use crate::replay::replay;
use crate::trace::Trace;
use coinmc_core::Ended;

fn trace(launch: &str, engine: &str, toss: u64, rate_hz: f64) -> Trace {
    // the flat engine has no friction lengths
    let lengths = match engine {
        "flat" => "",
        _ => ", rolling_friction_m = 1e-4, pivoting_friction_m = 1e-4",
    };
    let config = format!(
        "coin = {{ ratio = 0.85, radius_m = 0.01 }}\n\
         surface = {{ restitution = 0.3, friction = 0.3{lengths} }}\n\
         {launch}\nengine.{engine} = {{}}\nstop.tosses = 100"
    );
    let plan = coinmc::config::parse("inline", &config, &[])
        .unwrap_or_else(|problems| panic!("{}", problems.render(false)));
    replay(&plan, 0, toss, rate_hz).expect("a toss of the plan")
}

fn low(toss: u64) -> Trace {
    let launch = "launch.preset = 'clean'\nlaunch.height_m = 0.03";
    trace(launch, "volumetric", toss, 1000.0)
}

fn high(toss: u64) -> Trace {
    let launch = "launch.preset = 'clean'\nlaunch.height_m = 50.0";
    trace(launch, "volumetric", toss, 1000.0)
}

/// Every element is closed, attributes are quoted, and no number is missing.
fn assert_valid_svg(svg: &str) {
    let mut open = Vec::new();
    for element in svg.split('<').skip(1) {
        let (tag, text) = element.split_once('>').expect("a closed tag");
        assert!(
            !text.contains('>') && tag.matches('"').count() % 2 == 0,
            "{element}"
        );
        let name = tag.split([' ', '/']).find(|name| !name.is_empty());
        if tag.starts_with('/') {
            assert_eq!(open.pop(), name, "{element}");
        } else if !tag.ends_with('/') {
            open.extend(name);
        }
    }
    assert!(open.is_empty() && svg.starts_with("<svg xmlns="));
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn a_picture_is_valid_and_reproducible() {
    for toss in 0..20 {
        let svg = picture(&low(toss));
        assert_valid_svg(&svg);
        assert_eq!(svg, picture(&low(toss)));
        let mut written = Vec::new();
        write(&low(toss), &mut written).expect("memory");
        assert_eq!(written, svg.as_bytes());
    }
}

#[test]
fn heads_and_tails_and_impacts_are_there() {
    let svg = picture(&low(9));
    for part in [
        super::canvas::HEADS,
        super::canvas::TAILS,
        "impacts in order",
        "2 cm",
    ] {
        assert!(svg.contains(part), "{part}: {svg}");
    }
}

/// In a drop from 50 m a coin of 2 cm is a fifth of a pixel wide: the end is magnified.
#[test]
fn a_coin_that_is_too_small_is_magnified() {
    let svg = picture(&high(4));
    assert_valid_svg(&svg);
    let magnified = svg.split_once("magnified ").expect("a second panel").1;
    let times: f64 = magnified
        .split_once(" times")
        .and_then(|(times, _)| times.parse().ok())
        .expect("a number");
    assert!(times > 100.0, "{times}");
    assert!(!picture(&low(4)).contains("magnified"));
}

/// Points that are too close to distinguish are skipped, so that a picture stays small.
#[test]
fn a_picture_stays_small() {
    let mut trace = high(3);
    let few = picture(&trace).len();
    let records = trace.records.clone();
    trace.records = records
        .iter()
        .flat_map(|record| vec![*record; 20])
        .collect();
    let many = picture(&trace).len();
    assert!(few < 100_000 && many < 200_000, "{few} {many}");
}

#[test]
fn events_alone_make_a_picture() {
    let launch = "launch.preset = 'robot'";
    let svg = picture(&trace(launch, "flat", 5, 0.0));
    assert_valid_svg(&svg);
    assert!(!svg.contains("every"));
}

#[test]
fn a_failed_toss_has_only_a_caption() {
    let mut trace = low(1);
    trace.outcome.ended = Ended::Failed;
    for record in &mut trace.records {
        record.state.position_m.z = f64::NAN;
    }
    let svg = picture(&trace);
    assert_valid_svg(&svg);
    assert!(svg.contains("Failed"));
    trace.records.clear();
    assert_valid_svg(&picture(&trace));
}

#[test]
fn lengths_and_times_are_round() {
    for (limit, length) in [
        (0.037, "2 cm"),
        (0.05, "5 cm"),
        (12.0, "10 m"),
        (1.2e-3, "1 mm"),
    ] {
        assert_eq!(units::length(units::nice_below(limit)), length);
    }
    assert_eq!(units::time(0.020), "20 ms");
    assert_eq!(units::time(1.5), "1.5 s");
    assert_eq!(
        [0.3, 1.1, 7.0, 10.0, 2001.0].map(units::stride),
        [1, 2, 10, 10, 5000]
    );
}
