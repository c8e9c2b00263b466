//! The error of a share.

use super::scenes::robot;
use crate::tosser::Tosser;
use crate::{Evidence, Finding, ValidateError, Verdict};
use coinmc::results::Row;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Samples whose scatter is measured.
const SAMPLES: u32 = 400;

/// ΔP/P of samples of N tosses against 1/√N and against the exact sqrt((1 − P)/(P N)).
pub(super) fn rule_of_thumb(tosser: &Tosser<'_>) -> Result<Finding, ValidateError> {
    let (mut evidence, mut holds) = (vec![], vec![]);
    let cases = [("1.0", 0.0), ("1.5", 0.3), ("2.0", 0.3)];
    let tosses = tosser.size.of(500, 5000);
    for (ratio, mu) in cases {
        // the mass changes no toss under this law: each of its values is one more sample
        let scene = robot(&format!("claims/error-formula-{ratio}"))
            .with(format!("coin.ratio={ratio}"))
            .with(format!("surface.friction={mu:?}"))
            .with(format!(
                "coin.mass_kg={{ from = 0.01, to = 0.02, steps = {SAMPLES} }}"
            ));
        let results = tosser.toss(&scene, tosses, tosses)?;
        let shares: Vec<f64> = results.rows.iter().map(|row: &Row| row.side.p).collect();
        let p = shares.iter().sum::<f64>() / f64::from(SAMPLES);
        let squares: f64 = shares.iter().map(|share| (share - p) * (share - p)).sum();
        let freedom = f64::from(SAMPLES - 1);
        let relative = (squares / freedom).sqrt() / p;
        let n = tosses as f64;
        let factor = relative * n.sqrt();
        let ends =
            [0.975, 0.025].map(|tail| factor * (freedom / chi_squared(freedom, tail)).sqrt());
        let at = format!("P = {p:.3}");
        if ends[0] <= 1.0 && 1.0 <= ends[1] {
            holds.push(at.clone());
        }
        evidence.push(Evidence {
            what: format!("ΔP/P times √N, {at}"),
            value: factor,
            interval: Some(ends),
            tosses: u64::from(SAMPLES) * tosses,
        });
        evidence.push(Evidence::exact(
            format!("exact form sqrt((1 − P)/P), {at}"),
            ((1.0 - p) / p).sqrt(),
        ));
    }
    let verdict = Verdict::of_cases(&holds, cases.len());
    Ok(Finding { verdict, evidence })
}

/// The quantile of χ².
fn chi_squared(freedom: f64, p: f64) -> f64 {
    let distribution = ChiSquared::new(freedom).expect("a positive number");
    distribution.inverse_cdf(p)
}

#[cfg(test)]
mod tests {
    use super::chi_squared;

    /// A table of the distribution: 3.841 and 124.342.
    #[test]
    fn quantiles_are_those_of_tables() {
        assert!((chi_squared(1.0, 0.95) - 3.841_459).abs() < 1e-5);
        assert!((chi_squared(100.0, 0.95) - 124.342_113).abs() < 1e-5);
    }
}
