//! The result of every rule: one probability per face.

/// Probabilities of the three outcomes of one toss.
///
/// Each is computed separately, none as one minus the others, so that each keeps its relative
/// precision however small it is. All three are NaN outside the domain of the rule that made them.
///
/// ```
/// let coin = coinmc_analytic::zone::probabilities(1e-9);
/// assert_eq!(coin.heads, coin.tails);
/// assert!((coin.side - 0.5e-9).abs() < 1e-24);
/// assert!((coin.heads + coin.tails + coin.side - 1.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceProbabilities {
    /// Probability that the heads face shows, in `[0, 1]`.
    pub heads: f64,
    /// Probability that the tails face shows, in `[0, 1]`.
    pub tails: f64,
    /// Probability that the coin rests on its curved surface, in `[0, 1]`.
    pub side: f64,
}

impl FaceProbabilities {
    /// The result of a rule outside its domain.
    ///
    /// ```
    /// use coinmc_analytic::FaceProbabilities;
    /// assert!(FaceProbabilities::NAN.heads.is_nan());
    /// ```
    pub const NAN: Self = Self {
        heads: f64::NAN,
        tails: f64::NAN,
        side: f64::NAN,
    };

    /// Probability of heads or tails, `1 − P(side)` without its cancellation.
    ///
    /// ```
    /// // A rod of ratio 1e10: P(side) rounds to 1, yet the faces keep all their digits.
    /// let rod = coinmc_analytic::surface_area::probabilities(1e10);
    /// assert!((rod.faces() / 1e-10 - 1.0).abs() < 1.1e-10);
    /// ```
    pub fn faces(&self) -> f64 {
        self.heads + self.tails
    }

    /// Equal probabilities of heads and tails; `side + faces` is 1.
    pub(crate) fn symmetric(side: f64, faces: f64) -> Self {
        Self {
            heads: 0.5 * faces,
            tails: 0.5 * faces,
            side,
        }
    }

    /// The same from relative weights; that of the side may be infinite.
    pub(crate) fn from_weights(side: f64, faces: f64) -> Self {
        if side == f64::INFINITY {
            return Self::symmetric(1.0, 0.0);
        }
        let total = side + faces;
        Self::symmetric(side / total, faces / total)
    }
}
