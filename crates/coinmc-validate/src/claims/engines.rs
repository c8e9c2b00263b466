//! Ways to compute the same toss, on the same launches.
//!
//! Two ways toss the same launches, so their counts are not independent; the test takes them as if they were, which
//! makes it cautious: it rejects more rarely than it says.

use super::scenes::{clean, robot};
use crate::tosser::{Scene, Tosser};
use crate::trend::LEVEL;
use crate::{Evidence, Finding, ValidateError, Verdict};
use coinmc::results::Row;
use coinmc_questions::{Model, compare};

/// A way to compute tosses.
struct Way {
    name: &'static str,
    scene: Scene,
}

/// Compares each way with the first, at each point.
fn agree(
    tosser: &Tosser<'_>,
    ways: &[Way],
    [quick, full]: [u64; 2],
) -> Result<Finding, ValidateError> {
    let tossed = ways
        .iter()
        .map(|way| tosser.toss(&way.scene.clone().with("paired=true"), quick, full))
        .collect::<Result<Vec<_>, _>>()?;
    let (mut evidence, mut agreeing, mut all) = (vec![], vec![], 0);
    for place in 0..tossed[0].rows.len() {
        let first = &tossed[0].rows[place];
        let ratio = first.parameter("ratio").unwrap_or(f64::NAN);
        for (way, results) in ways.iter().zip(&tossed) {
            let row = &results.rows[place];
            evidence.push(Evidence::p_side(
                format!("{}, H/R = {ratio}", way.name),
                row,
            ));
        }
        for (way, results) in ways.iter().zip(&tossed).skip(1) {
            all += 1;
            let p = p_value(first, &results.rows[place])?;
            let at = format!("{} against {}, H/R = {ratio}", way.name, ways[0].name);
            evidence.push(Evidence::exact(format!("p-value, {at}"), p));
            if p >= LEVEL {
                agreeing.push(at);
            }
        }
    }
    let verdict = Verdict::of_cases(&agreeing, all);
    Ok(Finding { verdict, evidence })
}

/// Of the exact test that two rows have the same probabilities.
fn p_value(first: &Row, second: &Row) -> Result<f64, ValidateError> {
    let tally = &second.tally;
    let counts = [tally.heads, tally.tails, tally.side];
    let model = Model {
        run: "first",
        row: first,
    };
    Ok(compare(counts, &[model], 0.95)?.models[0].p_value)
}

pub(super) fn plane_space(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    const RATIOS: &str = "coin.ratio=[0.5, 1.0, 1.5, 2.0]";
    // a point contact without friction lengths, as in the plane
    let in_space = Scene::new(
        "claims/plane-space-space",
        "[coin]\nratio = 1.0\nradius_m = 0.01\n[surface]\nrestitution = 0.5\nfriction = 0.3\n\
         rolling_friction_m = 0.0\npivoting_friction_m = 0.0\n\
         [launch]\npreset = \"robot\"\n[engine.volumetric]\n",
    );
    let ways = [
        Way {
            name: "plane",
            scene: robot("claims/plane-space-plane").with(RATIOS),
        },
        Way {
            name: "space",
            scene: in_space.with(RATIOS),
        },
    ];
    agree(tosser, &ways, [10_000, 200_000])
}

pub(super) fn plane_laws(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    const RATIOS: &str = "coin.ratio=[1.0, 1.5]";
    let way = |name: &'static str, law: &str| Way {
        name,
        scene: robot(&format!("claims/plane-laws-{name}"))
            .with(RATIOS)
            .with(format!("engine.flat.law={law}")),
    };
    let contact =
        "{ line-contact = { coin_young_pa = 3e9, surface_young_pa = 1e10, length_m = 0.02 } }";
    let mut ways = vec![
        way("moreau", "'moreau'"),
        way("chatterjee-ruina", "'chatterjee-ruina'"),
        way("half-sine", "{ half-sine = { time_s = 1e-4 } }"),
    ];
    // a hundred times the work
    if tosser.size == crate::Size::Full {
        ways.push(way("line-contact", contact));
    }
    agree(tosser, &ways, [3000, 20_000])
}

pub(super) fn space_laws(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    let way = |name: &'static str| Way {
        name,
        scene: clean(&format!("claims/space-laws-{name}"))
            .with("coin.ratio=[0.25, 0.85, 2.0]")
            .with(format!("engine.volumetric.law='{name}'")),
    };
    let ways = [way("moreau"), way("chatterjee-ruina"), way("stronge")];
    agree(tosser, &ways, [3000, 50_000])
}

pub(super) fn decisions(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    let way = |name: &'static str| Way {
        name,
        scene: clean(&format!("claims/decisions-{name}"))
            .with("coin.ratio=[0.25, 0.85, 2.0]")
            .with(format!("engine.volumetric.decision='{name}'")),
    };
    agree(tosser, &[way("tilting"), way("energy")], [3000, 50_000])
}

#[cfg(feature = "rapier")]
pub(super) fn rapier(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    // Rapier knows no friction lengths
    let text = |engine: &str| {
        format!(
            "[coin]\nratio = [0.5, 1.0, 2.0]\nradius_m = 0.01\n\
             [surface]\nrestitution = 0.5\nfriction = 0.3\nrolling_friction_m = 0.0\n\
             pivoting_friction_m = 0.0\n[launch]\npreset = \"clean\"\n{engine}\n"
        )
    };
    let ways = [
        Way {
            name: "volumetric",
            scene: Scene::new("claims/rapier-volumetric", text("[engine.volumetric]")),
        },
        Way {
            name: "rapier, steps of 1 ms",
            scene: Scene::new(
                "claims/rapier-steps",
                text("[engine.rapier]\nstep_s = 1e-3"),
            ),
        },
    ];
    agree(tosser, &ways, [600, 5000])
}

#[cfg(not(feature = "rapier"))]
#[allow(clippy::unnecessary_wraps, reason = "with the engine it may fail")]
pub(super) fn rapier(_: &Tosser<'_>) -> Result<Finding, ValidateError> {
    Ok(Finding::not_validated("this build has no engine.rapier"))
}
