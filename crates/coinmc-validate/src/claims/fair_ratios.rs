//! How thick a fair coin is: the published values, over surfaces.

use super::scenes::{self, clean, hand, robot};
use crate::predictive::{self, Model};
use crate::tosser::{Scene, Tosser};
use crate::trend::LEVEL;
use crate::{Evidence, Finding, ValidateError, Verdict};
use coinmc::published::{fair_ratios, table1};
use coinmc_analytic::zone;
use coinmc_questions::number::grouped;

const FAIR: f64 = 1.0 / 3.0;

pub(super) fn flat(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    let mut surfaces = vec![];
    for mu in [0.0, 0.1, 0.3] {
        for e in [0.3, 0.5, 0.7] {
            let scene = robot(&format!("claims/fair-flat-{e}-{mu}"))
                .with(format!("surface.restitution={e:?}"))
                .with(format!("surface.friction={mu:?}"));
            surfaces.push((format!("e = {e}, μ = {mu}"), scene));
        }
    }
    within(tosser, "flat", &surfaces, [10_000, 200_000])
}

pub(super) fn space(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    let mut surfaces = vec![(
        "Unity's scene".to_owned(),
        scenes::unity("claims/fair-space-unity"),
    )];
    for (e, mu) in [
        (0.3, 0.3),
        (0.5, 0.1),
        (0.5, 0.3),
        (0.5, 0.6),
        (0.7, 0.3),
        (0.85, 0.3),
    ] {
        let scene = hand(&format!("claims/fair-space-hand-{e}-{mu}"))
            .with(format!("surface.restitution={e:?}"))
            .with(format!("surface.friction={mu:?}"));
        surfaces.push((format!("by hand on wood, e = {e}, μ = {mu}"), scene));
    }
    for (rho_over_r, rho) in [(0.003, 3e-5), (0.01, 1e-4)] {
        let scene = clean(&format!("claims/fair-space-clean-{rho_over_r}"))
            .with(format!("surface.rolling_friction_m={rho:?}"))
            .with(format!("surface.pivoting_friction_m={rho:?}"));
        surfaces.push((
            format!("any launch, plane, e = 0.5, μ = 0.3, ρ/R = {rho_over_r}"),
            scene,
        ));
    }
    within(tosser, "volumetric", &surfaces, [1500, 50_000])
}

/// On which surfaces the published fair ratio is not contradicted by P(side) at the two ends of its interval.
fn within(
    tosser: &Tosser<'_>,
    engine: &str,
    surfaces: &[(String, Scene)],
    [quick, full]: [u64; 2],
) -> Result<Finding, ValidateError> {
    let published = fair_ratios(engine).next().expect("a published value");
    let ends = [
        published.ratio - published.half_width,
        published.ratio + published.half_width,
    ];
    let (mut evidence, mut within) = (vec![], vec![]);
    for (name, scene) in surfaces {
        let scene = scene.clone().with(format!("coin.ratio={ends:?}"));
        let results = tosser.toss(&scene, quick, full)?;
        let [low, high] = [0, 1].map(|place: usize| {
            let tally = &results.rows[place].tally;
            Model::Counted {
                shown: tally.side,
                tosses: tally.tosses(),
            }
        });
        let surprise = predictive::fair_ratio(&[[low, high]], FAIR);
        if surprise.p_value >= LEVEL {
            within.push(name.clone());
        }
        for (row, end) in results.rows.iter().zip(ends) {
            evidence.push(Evidence::p_side(format!("H/R = {end:.2}, {name}"), row));
        }
    }
    let verdict = Verdict::of_cases(&within, surfaces.len());
    Ok(Finding { verdict, evidence })
}

pub(super) fn unity(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    let ratios: Vec<f64> = table1().iter().map(|counts| counts.ratio).collect();
    let scene = scenes::unity("claims/unity-figure").with(format!("coin.ratio={ratios:?}"));
    let results = tosser.toss(&scene, 4000, 100_000)?;
    let (mut evidence, mut agreeing) = (vec![], vec![]);
    for (row, counts) in results.rows.iter().zip(table1()) {
        let at = format!("H/R = {}", counts.ratio);
        let model = Model::Counted {
            shown: row.tally.side,
            tosses: row.tally.tosses(),
        };
        if predictive::count(&[model], counts.side, counts.tosses()).p_value >= LEVEL {
            agreeing.push(at.clone());
        }
        evidence.push(Evidence::exact(
            format!(
                "published share, {} of {} tosses, {at}",
                grouped(counts.side),
                grouped(counts.tosses())
            ),
            counts.p_side(),
        ));
        evidence.push(Evidence::p_side(&at, row));
        evidence.push(Evidence::exact(
            format!("zone rule, {at}"),
            zone::p_side(counts.ratio),
        ));
    }
    let verdict = Verdict::of_cases(&agreeing, ratios.len());
    Ok(Finding { verdict, evidence })
}
