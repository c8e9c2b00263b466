//! The places of a plane of launches.

use super::Parameter;

/// The values of each parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plane {
    values: Vec<Vec<f64>>,
}

impl Plane {
    pub(super) fn new(parameters: &[Parameter]) -> Self {
        Self {
            values: parameters.iter().map(Parameter::steps).collect(),
        }
    }

    /// How many places there are.
    pub(super) fn len(&self) -> usize {
        self.values.iter().map(Vec::len).product()
    }

    /// The values of the parameters at a place; the first parameter varies slowest.
    pub(super) fn at(&self, mut place: usize) -> Vec<f64> {
        let mut at = vec![0.0; self.values.len()];
        for (value, values) in at.iter_mut().zip(&self.values).rev() {
            *value = values[place % values.len()];
            place /= values.len();
        }
        at
    }

    /// The places where every parameter has its first or its last value.
    pub(super) fn corners(&self) -> Vec<usize> {
        self.values.iter().fold(vec![0], |places, values| {
            let of = |place: usize| [place * values.len(), (place + 1) * values.len() - 1];
            places.into_iter().flat_map(of).collect()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane() -> Plane {
        let parameter = |from, to, values| Parameter {
            key: String::new(),
            from,
            to,
            values,
        };
        Plane::new(&[parameter(1.0, 2.0, 2), parameter(0.01, 1.0, 3)])
    }

    #[test]
    fn the_first_parameter_varies_slowest() {
        let plane = plane();
        let places: Vec<_> = (0..plane.len()).map(|place| plane.at(place)).collect();
        let (a, b) = (1.0, 2.0);
        let expected = [[a, 0.01], [a, 0.1], [a, 1.0], [b, 0.01], [b, 0.1], [b, 1.0]];
        assert_eq!(places, expected);
    }

    #[test]
    fn corners_are_those_of_the_plane() {
        assert_eq!(plane().corners(), [0, 2, 3, 5]);
    }
}
