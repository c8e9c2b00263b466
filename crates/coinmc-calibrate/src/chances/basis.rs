//! Polynomials that are orthogonal under a standard normal distribution.

/// Products of normalised Hermite polynomials up to a total degree.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Basis {
    dimensions: usize,
    degree: usize,
    /// The degree of each term in each dimension.
    terms: Vec<Vec<usize>>,
}

impl Basis {
    pub(super) fn new(dimensions: usize, degree: usize) -> Self {
        let mut terms = vec![vec![]];
        for _ in 0..dimensions {
            terms = terms
                .into_iter()
                .flat_map(|term: Vec<usize>| {
                    let left = degree - term.iter().sum::<usize>();
                    (0..=left).map(move |next| {
                        let mut term = term.clone();
                        term.push(next);
                        term
                    })
                })
                .collect();
        }
        // the constant first, so that it can be told from the others
        terms.sort_by_key(|term| term.iter().sum::<usize>());
        Self {
            dimensions,
            degree,
            terms,
        }
    }

    pub(super) fn degree(&self) -> usize {
        self.degree
    }

    pub(super) fn len(&self) -> usize {
        self.terms.len()
    }

    /// Calls `with` with the value of every term at a point.
    pub(super) fn evaluate<T>(&self, point: &[f64], with: impl FnOnce(&[f64]) -> T) -> T {
        let powers: Vec<[f64; 5]> = point.iter().map(|z| hermite(*z)).collect();
        debug_assert_eq!(powers.len(), self.dimensions);
        let of = |term: &Vec<usize>| {
            let factors = powers.iter().zip(term);
            factors.map(|(powers, degree)| powers[*degree]).product()
        };
        let values: Vec<f64> = self.terms.iter().map(of).collect();
        with(&values)
    }
}

/// The Hermite polynomials of degree 0 to 4, normalised to variance 1.
fn hermite(z: f64) -> [f64; 5] {
    let square = z * z;
    [
        1.0,
        z,
        (square - 1.0) / 2.0_f64.sqrt(),
        z * (square - 3.0) / 6.0_f64.sqrt(),
        (square * (square - 6.0) + 3.0) / 24.0_f64.sqrt(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_terms_up_to_the_degree_are_there_once() {
        let basis = Basis::new(4, 3);
        assert_eq!(basis.len(), 35);
        let mut terms = basis.terms.clone();
        terms.sort();
        terms.dedup();
        assert_eq!(terms.len(), 35);
        assert_eq!(basis.terms[0], [0; 4]);
        basis.evaluate(&[1.0, 0.0, 2.0, 0.0], |values| {
            assert_eq!(values[0], 1.0);
            assert_eq!(values[1..5].iter().sum::<f64>(), 3.0);
        });
    }
}
