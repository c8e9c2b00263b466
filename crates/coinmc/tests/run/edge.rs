//! A table with an edge.

use crate::support::{contents, run_whole};
use coinmc::config;
use coinmc::run::{FinishedToss, TossSource, for_each_end, stream};
use coinmc_core::{Engine, Event, EventKind, Observer, State};
use tempfile::tempdir;

/// Coins that are thrown flat from 0.5 m at 0 to 1 m/s and stick where they land.
const THROWN: &str = "coin = { ratio = 0.2, radius_m = 0.01 }\nengine.volumetric = {}\n\
                      sampling.method = 'random'\nstop.tosses = 20_000\nestimate.confidence = 0.999\n\
                      environment.linear_drag_per_s = 0\n\
                      [surface]\nlanding = 'adhesive'\nrestitution = 0.0\nfriction = 0.3\n\
                      [launch]\nheight_m = 0.5\nvelocity_m_s = [{ uniform = { from = 0, to = 1 } }, 0, 0]\n\
                      orientation.tilt_deg = 0\nspin.components_rad_s = [0, 0, 0]\n";

/// They leave if they fly farther than the radius, v sqrt(2(z − H/2)/g) > r. The true share lies in the
/// interval of 99.9 %.
#[test]
fn the_share_of_coins_that_leave_is_known() {
    let radius_m = 0.2;
    let text = THROWN.replace(
        "[launch]",
        &format!("table_radius_m = {radius_m}\n[launch]"),
    );
    let plan = config::parse("inline", &text, &[]).unwrap_or_else(|problems| panic!("{problems}"));
    let dir = tempdir().expect("a directory");
    let results = run_whole(&plan, dir.path()).results;
    let row = &results.rows[0];
    assert_eq!(row.parameter("table_radius_m"), Some(radius_m));
    let flight_s = (2.0 * (0.5 - 0.001) / plan.points[0].scene.gravity_m_s2()).sqrt();
    let known = 1.0 - radius_m / flight_s;
    let left = row.left.expect("the table has an edge");
    assert!(left.lo < known && known < left.hi, "{left:?} {known}");
    assert_eq!(row.tally.heads + row.tally.left, 20_000);
    assert_eq!((row.tally.undecided(), row.heads.n), (0, 20_000));

    let tallies = contents(dir.path());
    let lines = |text: &[u8]| String::from_utf8_lossy(text).contains("\nleft ");
    assert!(tallies.values().any(|file| lines(file)), "in the tallies");
    let again = run_whole(&plan, dir.path()).results;
    assert_eq!(again.rows, results.rows, "read back from the tallies");
}

#[test]
fn nothing_leaves_an_endless_table() {
    let plan = config::parse("inline", THROWN, &[]).expect("a plan");
    let dir = tempdir().expect("a directory");
    let row = &run_whole(&plan, dir.path()).results.rows[0];
    assert_eq!((row.left, row.tally.left), (None, 0));
    let text = contents(dir.path());
    let tally = text
        .iter()
        .find(|(name, _)| name.contains("tallies"))
        .expect("a tally");
    assert!(!String::from_utf8_lossy(tally.1).contains("left"));
}

/// At rest where it sticks, or at the edge: not as it last touched the table.
#[test]
fn the_end_of_a_toss_is_where_its_engine_ends_it() {
    /// States at the end, and before.
    #[derive(Default)]
    struct States(Vec<State>, Vec<State>);
    impl Observer for States {
        fn event(&mut self, event: &Event) {
            let of = match event.kind {
                EventKind::Ended => &mut self.0,
                _ => &mut self.1,
            };
            of.push(event.state);
        }
    }
    let text = THROWN.replace("[launch]", "table_radius_m = 0.2\n[launch]");
    let plan = config::parse("inline", &text, &[]).expect("a plan");
    let (point, stream) = (&plan.points[0], stream(&plan, 0));
    let engine = point.build_engine().unwrap().unwrap();
    let source = TossSource::Drawn(&stream);
    let mut differ = 0;
    let mut visit = |toss: &FinishedToss| {
        let mut seen = States::default();
        engine.toss(&mut (), &source.launch(point, toss.toss), &mut seen);
        assert_eq!(seen.0, [toss.end]);
        differ += u32::from(seen.1.last() != Some(&toss.end));
        true
    };
    assert!(for_each_end(point, source, 0..20, &mut visit).unwrap());
    assert!(differ > 0);
}
