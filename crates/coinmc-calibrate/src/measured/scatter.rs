//! Readings that scatter more than their stated errors allow.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Below this probability of so much scatter, the stated error is too small.
const IMPROBABLE: f64 = 0.01;

/// How many times as large as stated the errors of readings must be for the scatter that they show; 1 where it is not
/// improbable.
///
/// `squares` is the sum of the squares of their distances from what was fitted to them, in units of the stated errors, and
/// `fitted` how many numbers were. Of good readings it is χ² of as many degrees of freedom as there are more readings;
/// of others the errors grow by the Birge ratio sqrt(χ²/ν) (Birge, Phys. Rev. 40 (1932) 207).
pub(super) fn excess(squares: f64, readings: usize, fitted: usize) -> f64 {
    let freedom = readings.saturating_sub(fitted) as f64;
    let probable = ChiSquared::new(freedom).is_ok_and(|chi| chi.sf(squares) >= IMPROBABLE);
    if freedom == 0.0 || probable {
        return 1.0;
    }
    (squares / freedom).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 99 % quantiles of χ² (tables): 6.635 for one degree of freedom, 13.277 for four.
    #[test]
    fn errors_grow_only_where_scatter_is_improbable() {
        assert_eq!(excess(1e9, 1, 1), 1.0);
        assert_eq!(excess(6.63, 2, 1), 1.0);
        assert!((excess(6.64, 2, 1) - 6.64_f64.sqrt()).abs() < 1e-12);
        assert_eq!(excess(13.27, 5, 1), 1.0);
        assert!((excess(400.0, 5, 1) - 10.0).abs() < 1e-12);
    }
}
