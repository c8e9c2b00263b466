//! Weighted least squares for several responses at once.

use nalgebra::{DMatrix, DVector};

/// Keeps the normal equations solvable where columns say the same, as a share of their size.
const RIDGE: f64 = 1e-9;

/// Coefficients: a column for each response.
pub(crate) struct Regression(DMatrix<f64>);

impl Regression {
    /// The regression of the responses on the rows; `None` where there is nothing to fit.
    pub(crate) fn fit(rows: &[Vec<f64>], responses: &[Vec<f64>], weights: &[f64]) -> Option<Self> {
        let columns = rows.first()?.len();
        let of = responses.first()?.len();
        let mut normal = DMatrix::<f64>::zeros(columns, columns);
        let mut right = DMatrix::<f64>::zeros(columns, of);
        for ((row, response), weight) in rows.iter().zip(responses).zip(weights) {
            let row = DVector::from_column_slice(row);
            let response = DVector::from_column_slice(response);
            normal.ger(*weight, &row, &row, 1.0);
            right.ger(*weight, &row, &response, 1.0);
        }
        let ridge = RIDGE * normal.diagonal().max();
        for place in 0..columns {
            normal[(place, place)] += ridge;
        }
        Some(Self(normal.cholesky()?.solve(&right)))
    }

    /// The responses for a row.
    pub(crate) fn at(&self, row: &[f64]) -> Vec<f64> {
        let row = DVector::from_column_slice(row);
        (self.0.transpose() * row).iter().copied().collect()
    }

    /// The share of rows that are farther from their mean than a given one, by Mahalanobis' distance.
    pub(crate) fn share_farther(rows: &[Vec<f64>], given: &[f64]) -> Option<f64> {
        let n = rows.len() as f64;
        let columns = given.len();
        let mut mean = DVector::<f64>::zeros(columns);
        for row in rows {
            mean += DVector::from_column_slice(row) / n;
        }
        let mut covariance = DMatrix::<f64>::zeros(columns, columns);
        for row in rows {
            let off = DVector::from_column_slice(row) - &mean;
            covariance.ger(1.0 / n, &off, &off, 1.0);
        }
        // a feature that never changes tells nothing, and a small one must not tell everything
        let floor = 1e-4 * covariance.diagonal().max().max(1e-6);
        for place in 0..columns {
            covariance[(place, place)] += floor;
        }
        let cholesky = covariance.cholesky()?;
        let distance = |row: &[f64]| {
            let off = DVector::from_column_slice(row) - &mean;
            off.dot(&cholesky.solve(&off))
        };
        let far = distance(given);
        let farther = rows.iter().filter(|row| distance(row) >= far).count();
        Some(farther as f64 / n)
    }
}

/// One, the numbers, their squares and products.
pub(crate) fn quadratic(numbers: &[f64]) -> Vec<f64> {
    let mut row = vec![1.0];
    row.extend_from_slice(numbers);
    for (place, one) in numbers.iter().enumerate() {
        row.extend(numbers[place..].iter().map(|other| one * other));
    }
    row
}
