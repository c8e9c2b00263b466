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
