//! The law of impact, the force and its duration, and the end of a toss.

use super::scenes::robot;
use crate::tosser::Tosser;
use crate::trend::{LEVEL, p_same};
use crate::{Evidence, Finding, ValidateError, Verdict};
use coinmc_core::{Estimate, IntervalMethod};
use coinmc_flat::Materials;
use libm::{pow, tgamma};
use std::f64::consts::PI;

pub(super) fn energy_law(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    let (mut evidence, mut sound) = (vec![], vec![]);
    let etas = [1e-4, 1e-3, 1e-2];
    for eta in etas {
        let scene = robot(&format!("claims/energy-law-{eta:e}"))
            .with("coin.ratio=1.5")
            .with("surface.friction=0.0")
            .with(format!(
                "engine.flat.law={{ gaek-sukhov = {{ eta_n_s = {eta:?} }} }}"
            ));
        let results = tosser.toss(&scene, 4000, 100_000)?;
        let tally = &results.rows[0].tally;
        let kinds = [
            (
                "requires a negative height of rebound",
                tally.negative_heights,
            ),
            ("would gain energy", tally.energy_gains),
            ("would sink into the surface", tally.sinkings),
        ];
        if kinds.iter().all(|(_, broken)| *broken == 0) {
            sound.push(format!("η = {eta:e} N s"));
        }
        for (kind, broken) in kinds {
            // impacts of a toss are not independent, so the share has no interval
            evidence.push(Evidence {
                what: format!("share of impacts at which it {kind}, k = 0.25, η = {eta:e} N s"),
                value: broken as f64 / tally.impacts as f64,
                interval: None,
                tosses: tally.tosses(),
            });
        }
    }
    let verdict = Verdict::of_cases(&sound, etas.len());
    Ok(Finding { verdict, evidence })
}

pub(super) fn half_sine(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    let laws = [
        ("an impulse (Moreau)", "engine.flat.law='moreau'"),
        (
            "half a sine of 0.1 ms",
            "engine.flat.law={ half-sine = { time_s = 1e-4 } }",
        ),
        (
            "half a sine of 1 ms",
            "engine.flat.law={ half-sine = { time_s = 1e-3 } }",
        ),
    ];
    let (mut evidence, mut same) = (vec![], vec![]);
    let cases = [(1.0, 0.0), (1.5, 0.0), (1.5, 0.3)];
    for (ratio, mu) in cases {
        let at = format!("e = 0.5, μ = {mu}, H/R = {ratio}");
        let mut rows = vec![];
        for (place, (name, law)) in laws.iter().enumerate() {
            let scene = robot(&format!("claims/half-sine-{place}-{mu}-{ratio}"))
                .with(format!("coin.ratio={ratio:?}"))
                .with(format!("surface.friction={mu:?}"))
                .with(*law);
            let results = tosser.toss(&scene, 3000, 50_000)?;
            let row = results.rows[0].clone();
            evidence.push(Evidence::p_side(format!("{name}, {at}"), &row));
            rows.push(row);
        }
        let p = p_same(rows.iter());
        if p >= LEVEL {
            same.push(at.clone());
        }
        evidence.push(Evidence::exact(
            format!("p-value of the same P(side), {at}"),
            p,
        ));
    }
    let verdict = Verdict::of_cases(&same, cases.len());
    Ok(Finding { verdict, evidence })
}

/// The duration of a lossless impact of 10 g at 1.5 m/s on the paper's own line contact N = K δ^(10/9).
#[allow(clippy::unnecessary_wraps, reason = "the type of all checks")]
pub(super) fn contact_time(_: &Tosser<'_>) -> Result<Finding, ValidateError> {
    /// As n in the paper.
    const EXPONENT: f64 = 10.0 / 9.0;
    const MASS_KG: f64 = 0.01;
    const SPEED_M_S: f64 = 1.5;
    let duration_ms = |coin_young_pa: f64, surface_young_pa: f64| {
        let materials = Materials {
            coin_young_pa,
            coin_poisson: 0.3,
            surface_young_pa,
            surface_poisson: 0.3,
            length_m: 0.02,
        };
        let share = 1.0 / (EXPONENT + 1.0);
        let energy = 0.5 * (EXPONENT + 1.0) * MASS_KG * SPEED_M_S * SPEED_M_S;
        let deepest = pow(energy / materials.stiffness(), share);
        let pulse = 2.0 * PI.sqrt() * tgamma(1.0 + share) / tgamma(0.5 + share);
        1e3 * pulse * deepest / SPEED_M_S
    };
    let pairs = [
        ("PLA on wood, 3 and 10 GPa", 3e9, 10e9),
        ("steel on wood, 200 and 10 GPa", 200e9, 10e9),
        ("PLA on rubber, 3 and 0.005 GPa", 3e9, 5e6),
    ];
    let (mut evidence, mut there) = (vec![], vec![]);
    for (name, coin, surface) in pairs {
        let ms = duration_ms(coin, surface);
        // about 1 ms: within a factor of 2
        if (0.5..=2.0).contains(&ms) {
            there.push(name.to_owned());
        }
        evidence.push(Evidence::exact(format!("duration, ms, {name}"), ms));
    }
    let verdict = Verdict::of_cases(&there, pairs.len());
    Ok(Finding { verdict, evidence })
}

pub(super) fn stopping_rule(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    let (mut evidence, mut right) = (vec![], vec![]);
    let radii = [0.01, 0.003, 0.001];
    for radius in radii {
        let scene = robot(&format!("claims/stopping-rule-{radius}"))
            .with(format!("coin.radius_m={radius:?}"))
            .with("coin.ratio=1.5")
            .with("surface.restitution=0.7")
            .with("surface.friction=0.0")
            .with("engine.flat.decision={ energy_fraction = 0.01 }");
        let results = tosser.toss(&scene, 4000, 100_000)?;
        let tally = &results.rows[0].tally;
        let name = format!(
            "R = {} mm, dropped from {:.0} R",
            1e3 * radius,
            0.5 / radius
        );
        if tally.overruled == 0 {
            right.push(name.clone());
        }
        let n = tally.tosses();
        let share = Estimate::new(tally.overruled, 0, n, 0.95, IntervalMethod::Wilson);
        evidence.push(Evidence::estimate(
            format!("tosses that energy decides otherwise, {name}"),
            &share,
            n,
        ));
    }
    let verdict = Verdict::of_cases(&right, radii.len());
    Ok(Finding { verdict, evidence })
}
