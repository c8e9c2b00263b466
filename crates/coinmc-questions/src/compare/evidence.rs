//! How much counts speak for a model: its evidence.

use super::exact::Reference;
use libm::{lgamma, log, log1p};

/// From here on three terms of Stirling's series give the logarithm of Γ to 1e-10.
const LARGE: f64 = 10.0;

/// Natural logarithm of the probability of the counts in one order. A model that was tossed has the probabilities of
/// Jeffreys' posterior, Dirichlet(m + 1/2).
pub(super) fn ln_evidence(reference: &Reference, counts: [u64; 3]) -> f64 {
    match reference {
        Reference::Known(p) => {
            let terms = p.iter().zip(counts);
            terms
                .filter(|(_, count)| *count > 0)
                .map(|(p, count)| count as f64 * log(*p))
                .sum()
        }
        Reference::Counted(model) => ln_dirichlet(counts, model.map(|count| count as f64 + 0.5)),
    }
}

/// The same of a coin of which every triple of probabilities is equally likely.
pub(super) fn ln_uniform(counts: [u64; 3]) -> f64 {
    ln_dirichlet(counts, [1.0; 3])
}

/// ∫ Π p^k Dir(p; a) dp = Γ(A)/Γ(n + A) Π Γ(k + a)/Γ(a).
fn ln_dirichlet(counts: [u64; 3], a: [f64; 3]) -> f64 {
    let faces = counts.into_iter().zip(a);
    let each: f64 = faces.map(|(count, a)| ln_rising(a, count as f64)).sum();
    each - ln_rising(a.iter().sum(), counts.iter().sum::<u64>() as f64)
}

/// ln Γ(a + k)/Γ(a). The logarithms of Γ of 1e9 have lost the digits that tell k: where a is large, the difference of
/// their Stirling series is taken term by term.
fn ln_rising(a: f64, k: f64) -> f64 {
    if a < LARGE {
        return lgamma(a + k) - lgamma(a);
    }
    let rest = |x: f64| {
        let square = x * x;
        (1.0 / 12.0 - (1.0 / 360.0 - 1.0 / (1260.0 * square)) / square) / x
    };
    k * log(a) + (a + k - 0.5) * log1p(k / a) - k + rest(a + k) - rest(a)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By Stirling's series with 60 digits (a few lines of Python).
    #[test]
    fn evidence_of_large_models_is_that_of_sixty_digits() {
        let tosses = 1_000_000_000_000;
        for (counts, model, expected) in [
            (
                [450_500, 399_800, 149_700],
                [450, 400, 150].map(|share| share * tosses),
                -1_010_059.613_486_81,
            ),
            (
                [30, 22, 8],
                [450, 400, 150].map(|share| share * tosses / 1000),
                -59.290_586_866_893_28,
            ),
            ([3, 0, 5], [20, 4, 0], -14.325_815_704_047_74),
            ([100_000, 5, 3], [7, 9, 40], -477.582_854_918_472_7),
        ] {
            let found = ln_evidence(&Reference::Counted(model), counts);
            assert!((found - expected).abs() < 1e-7, "{counts:?} {found}");
        }
    }

    /// Γ(a + k)/Γ(a) = a (a + 1) … (a + k − 1), with either formula.
    #[test]
    fn a_rising_product_is_that_of_its_factors() {
        for a in [0.5, 9.9, 10.0, 12.5, 1e6, 1e15] {
            let product: f64 = (0..20).map(|i| log(a + f64::from(i))).sum();
            let found = ln_rising(a, 20.0);
            assert!((found - product).abs() < 1e-9, "{a}: {found} {product}");
        }
    }
}
