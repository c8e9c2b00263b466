//! Coins that do not bounce, and what bounces change.

use super::scenes::{clean, robot};
use crate::tosser::{Scene, Tosser};
use crate::{Evidence, Finding, ValidateError, Verdict};
use coinmc::results::Results;
use coinmc_analytic::{arc, zone};
use coinmc_core::Estimate;

const RATIOS: &str = "coin.ratio=[0.25, 0.5, 1.0, 1.1547005383792515, 2.0]";
const ADHESIVE: &str = "surface.landing='adhesive'";

pub(super) fn arc_rule(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    // vigorous: many turns before the landing
    let scene = robot("claims/arc-rule").with("launch.spin.about.rate_rad_s=200.0");
    against(tosser, scene, "arc rule", arc::p_side)
}

pub(super) fn zone_rule(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    against(tosser, clean("claims/zone-rule"), "zone rule", zone::p_side)
}

/// A closed form holds if it lies within every interval, but for the rounding of an exact integral.
fn against(
    tosser: &Tosser<'_>,
    scene: Scene,
    rule: &str,
    p_side: fn(f64) -> f64,
) -> Result<Finding, ValidateError> {
    let results = tosser.toss(&scene.with(RATIOS).with(ADHESIVE), 20_000, 20_000)?;
    let mut evidence = vec![];
    let mut holds = vec![];
    for (ratio, side, tosses) in sides(&results) {
        let closed = p_side(ratio);
        if side.lo - 1e-9 <= closed && closed <= side.hi + 1e-9 {
            holds.push(format!("H/R = {ratio:.4}"));
        }
        let at = format!("H/R = {ratio:.4}");
        evidence.push(Evidence::estimate(
            format!("P(side) by integral, {at}"),
            &side,
            tosses,
        ));
        evidence.push(Evidence::exact(format!("{rule}, {at}"), closed));
    }
    let verdict = Verdict::of_cases(&holds, results.rows.len());
    Ok(Finding { verdict, evidence })
}

pub(super) fn arc_shift(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    let (mut evidence, mut shifted, mut all) = (vec![], vec![], 0);
    for (e, mu) in [(0.3, 0.0), (0.5, 0.0), (0.7, 0.0), (0.5, 0.3)] {
        let scene = robot(&format!("claims/arc-shift-{e}-{mu}"))
            .with(format!("surface.restitution={e:?}"))
            .with(format!("surface.friction={mu:?}"))
            .with("coin.ratio=[0.5, 1.1547005383792515, 1.5]");
        let results = tosser.toss(&scene, 4000, 100_000)?;
        for (ratio, side, tosses) in sides(&results) {
            let closed = arc::p_side(ratio);
            all += 1;
            let at = format!("e = {e}, μ = {mu}, H/R = {ratio:.4}");
            if closed < side.lo || side.hi < closed {
                shifted.push(at.clone());
            }
            evidence.push(Evidence {
                what: format!("P(side) minus the arc rule, {at}"),
                value: side.p - closed,
                interval: Some([side.lo - closed, side.hi - closed]),
                tosses,
            });
        }
    }
    // (not at H/R = 2, where a square section leaves P(side) at 1/2 whatever happens)
    Ok(Finding {
        verdict: Verdict::of_cases(&shifted, all),
        evidence,
    })
}

#[allow(clippy::unnecessary_wraps, reason = "the type of all checks")]
pub(super) fn robot_shift(_: &Tosser<'_>) -> Result<Finding, ValidateError> {
    Ok(Finding::not_validated(
        "the counts of the robot's throws are not to be had",
    ))
}

fn sides(results: &Results) -> impl Iterator<Item = (f64, Estimate, u64)> {
    results.rows.iter().map(|row| {
        let ratio = row.parameter("ratio").expect("always a parameter");
        (ratio, row.side, row.tally.tosses())
    })
}
