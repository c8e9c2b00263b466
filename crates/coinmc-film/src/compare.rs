//! Ranking laws by how well they describe the drops.

use crate::fit::Fit;

/// A law in the ranking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranked {
    /// Index of the fit.
    pub fit: usize,
    /// Akaike information criterion.
    pub aic: f64,
    /// Bayesian (Schwarz) information criterion.
    pub bic: f64,
    /// Difference of AIC from the smallest.
    pub delta_aic: f64,
    /// Difference of BIC from the smallest.
    pub delta_bic: f64,
    /// Akaike weight: exp(−Δ/2), normalised so that all weights sum to 1.
    pub weight: f64,
}

/// Ranks fits of the same points ([`fit_all`](crate::fit_all)) by AIC, the best first.
///
/// Between laws that both leave only noise, differences below 2 mean nothing and differences above
/// 10 are decisive (Burnham & Anderson 2002). If even the best law leaves correlated residuals, it
/// is only the least wrong.
pub fn compare(fits: &[Fit]) -> Vec<Ranked> {
    let least = |of: fn(&Fit) -> f64| fits.iter().map(of).fold(f64::INFINITY, f64::min);
    let (least_aic, least_bic) = (least(Fit::aic), least(Fit::bic));
    let share = |fit: &Fit| libm::exp(0.5 * (least_aic - fit.aic()));
    let all: f64 = fits.iter().map(share).sum();
    let mut ranked: Vec<Ranked> = fits
        .iter()
        .enumerate()
        .map(|(i, fit)| Ranked {
            fit: i,
            aic: fit.aic(),
            bic: fit.bic(),
            delta_aic: fit.aic() - least_aic,
            delta_bic: fit.bic() - least_bic,
            weight: share(fit) / all,
        })
        .collect();
    ranked.sort_by(|a, b| a.aic.total_cmp(&b.aic));
    ranked
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::tests::blank;

    /// Criteria of 4, 2 and 10 by Akaike, whose weights are as e⁻¹ : 1 : e⁻⁴.
    #[test]
    fn laws_are_ranked_by_what_they_need_and_leave() {
        let fits = [(1, -1.0), (2, 1.0), (3, -2.0)].map(|(fitted, log_likelihood)| Fit {
            n: 3,
            fitted,
            log_likelihood,
            ..blank()
        });
        let ranked = compare(&fits);
        let ln_3 = libm::log(3.0);
        let of = |fit, delta: f64, fitted: f64| Ranked {
            fit,
            aic: 2.0 + delta,
            bic: 2.0 + delta + fitted * (ln_3 - 2.0),
            delta_aic: delta,
            delta_bic: delta + (fitted - 2.0) * (ln_3 - 2.0),
            weight: libm::exp(-0.5 * delta) / (1.0 + libm::exp(-1.0) + libm::exp(-4.0)),
        };
        let expected = [of(1, 0.0, 2.0), of(0, 2.0, 1.0), of(2, 8.0, 3.0)];
        assert_eq!(ranked.len(), 3);
        for (found, expected) in ranked.iter().zip(expected) {
            assert_eq!(found.fit, expected.fit);
            for (found, expected) in [
                (found.aic, expected.aic),
                (found.bic, expected.bic),
                (found.delta_aic, expected.delta_aic),
                (found.delta_bic, expected.delta_bic),
                (found.weight, expected.weight),
            ] {
                assert!((found - expected).abs() < 1e-12, "{ranked:?}");
            }
        }
    }
}
