//! A table with an edge.

use crate::support::{contents, run_whole};
use coinmc::config;
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
