//! The face that was up at the launch.

use crate::support::run_whole;
use coinmc::config;
use coinmc_analytic::precession::thin::p_same_side;
use tempfile::tempdir;

/// A thin coin that is caught, tossed with this face up and the angle ψ between its axis and its angular
/// momentum.
fn caught(tilt_deg: f64, psi_deg: f64) -> String {
    format!(
        "coin = {{ ratio = 1e-6, radius_m = 0.01 }}\nstop.tosses = 100_000\nestimate.confidence = 0.999\n\
         surface = {{ landing = 'adhesive', restitution = 0.0, friction = 0.3 }}\nengine.volumetric = {{}}\n\
         sampling.method = 'random'\n[launch]\nheight_m = 1.0\nvelocity_m_s = [0, 0, 2.4]\n\
         orientation.tilt_deg = {tilt_deg:?}\n\
         spin.precessing.rate_rad_s.normal = {{ mean = 238.6, sd = 50.0 }}\n\
         spin.precessing.psi_deg = {psi_deg:?}\n"
    )
}

/// Diaconis, Holmes & Montgomery's probability of the same side lies in the interval of 99.9 %, whichever
/// face was up.
#[test]
fn a_caught_coin_shows_the_same_side_as_often_as_theory_says() {
    for (tilt, psi) in [(0.0, 60.0), (180.0, 60.0), (0.0, 75.0)] {
        let plan = config::parse("inline", &caught(tilt, psi), &[]).expect("a plan");
        let dir = tempdir().expect("a directory");
        let report = run_whole(&plan, dir.path());
        let row = &report.results.rows[0];
        let same = row.same.expect("tosses tell it");
        let known = p_same_side(psi.to_radians());
        assert!(
            same.lo < known && known < same.hi,
            "{same:?} {known} {tilt}"
        );
        let face = if tilt == 0.0 {
            row.tally.heads
        } else {
            row.tally.tails
        };
        assert_eq!(row.tally.same, face);
    }
}

/// Integrals and closed forms do not tell how the coin began.
#[test]
fn without_tosses_it_is_not_known() {
    let text = caught(0.0, 60.0).replace("sampling.method = 'random'\n", "");
    let plan = config::parse("inline", &text, &[]).expect("a plan");
    let dir = tempdir().expect("a directory");
    let row = &run_whole(&plan, dir.path()).results.rows[0];
    assert_ne!(row.sampling, "random");
    assert_eq!((row.same, row.tally.same), (None, 0));
}
