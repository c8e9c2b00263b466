//! Which law describes the drops best.

use crate::fit::Fit;

/// One law among several.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranked {
    /// Index of the fit.
    pub fit: usize,
    /// Akaike's criterion.
    pub aic: f64,
    /// Schwarz's criterion.
    pub bic: f64,
    /// By how much AIC exceeds the least.
    pub delta_aic: f64,
    /// By how much BIC exceeds the least.
    pub delta_bic: f64,
    /// Akaike weight: exp(−Δ/2), all of them together 1.
    pub weight: f64,
}

/// Ranks fits of the same points ([`fit_all`](crate::fit_all)) by AIC, the best first.
///
/// Differences below 2 tell nothing, above 10 they decide (Burnham & Anderson 2002) — between laws
/// that both leave noise alone. Where even the best leaves correlated residuals, it is only the
/// least wrong.
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
