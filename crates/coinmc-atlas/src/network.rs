//! A small neural network: layers of x/(1 + e⁻ˣ), then ln of the odds of the side, and of heads among the faces.

use crate::FileError;

/// Numbers that a network gives.
pub(crate) const OUTPUTS: usize = 2;

/// A network. All numbers have single precision: their rounding is far below the error of the answer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Network {
    pub(crate) layers: Vec<Layer>,
}

/// weights · inputs + biases.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layer {
    pub(crate) inputs: usize,
    /// Row by row: one row an output.
    pub(crate) weights: Vec<f32>,
    pub(crate) biases: Vec<f32>,
}

impl Network {
    /// The network of these sizes with zeros in it.
    pub(crate) fn zero(inputs: usize, hidden: &[usize]) -> Self {
        let mut layers = Vec::new();
        let mut before = inputs;
        for &outputs in hidden.iter().chain(&[OUTPUTS]) {
            layers.push(Layer {
                inputs: before,
                weights: vec![0.0; before * outputs],
                biases: vec![0.0; outputs],
            });
            before = outputs;
        }
        Self { layers }
    }

    /// P(heads), P(tails) and P(side) at a place.
    pub(crate) fn faces(&self, place: &[f64]) -> [f64; 3] {
        let mut values: Vec<f32> = place.iter().map(|x| single(*x)).collect();
        let last = self.layers.len() - 1;
        for (number, layer) in self.layers.iter().enumerate() {
            values = layer.apply(&values);
            if number < last {
                for value in &mut values {
                    *value *= logistic(*value);
                }
            }
        }
        let [side, heads] = [0, 1].map(|output| probability(values[output]));
        [(1.0 - side) * heads, (1.0 - side) * (1.0 - heads), side]
    }

    /// All numbers, layer by layer: weights, then biases.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = &f32> {
        let layers = self.layers.iter();
        layers.flat_map(|layer| layer.weights.iter().chain(&layer.biases))
    }

    /// Takes all numbers, in the same order.
    pub(crate) fn set(&mut self, numbers: &mut impl Iterator<Item = f32>) -> Result<(), FileError> {
        for layer in &mut self.layers {
            for number in layer.weights.iter_mut().chain(&mut layer.biases) {
                *number = numbers.next().ok_or(FileError::Short)?;
                if !number.is_finite() {
                    return Err(FileError::NotFinite);
                }
            }
        }
        Ok(())
    }
}

impl Layer {
    fn apply(&self, values: &[f32]) -> Vec<f32> {
        let rows = self.weights.chunks_exact(self.inputs);
        rows.zip(&self.biases)
            .map(|(row, bias)| {
                row.iter()
                    .zip(values)
                    .fold(*bias, |sum, (w, x)| sum + w * x)
            })
            .collect()
    }
}

/// The nearest number of single precision.
#[allow(
    clippy::cast_possible_truncation,
    reason = "rounding is far below the error of an answer"
)]
pub(crate) fn single(x: f64) -> f32 {
    x as f32
}

/// 1/(1 + e⁻ˣ). A unit of a hidden layer gives x times that: Elfwing et al., "Sigmoid-weighted linear units for neural
/// network function approximation in reinforcement learning", Neural Networks 107 (2018) 3.
pub(crate) fn logistic(x: f32) -> f32 {
    1.0 / (1.0 + libm::expf(-x))
}

/// The probability with these odds, from their logarithm.
pub(crate) fn probability(log_odds: f32) -> f64 {
    1.0 / (1.0 + libm::exp(-f64::from(log_odds)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_network_without_knowledge_gives_even_odds() {
        let network = Network::zero(3, &[4]);
        assert_eq!(network.faces(&[0.1, 0.2, 0.3]), [0.25, 0.25, 0.5]);
        assert_eq!(network.numbers().count(), 3 * 4 + 4 + 4 * 2 + 2);
    }

    /// 1/(1 + e⁻¹), the value of 2·½, through one hidden unit, by hand.
    #[test]
    fn layers_are_applied_one_after_the_other() {
        let mut network = Network::zero(1, &[1]);
        let mut numbers = [2.0, 0.0, 3.0, 0.0, 0.5, -1.0].into_iter();
        network.set(&mut numbers).unwrap();
        let hidden = 1.0 / (1.0 + libm::exp(-1.0));
        let side = 1.0 / (1.0 + libm::exp(-(3.0 * hidden + 0.5)));
        let heads = 1.0 / (1.0 + libm::exp(1.0));
        let [_, tails, found] = network.faces(&[0.5]);
        assert!((found - side).abs() < 1e-6);
        assert!((tails - (1.0 - side) * (1.0 - heads)).abs() < 1e-6);
    }

    #[test]
    fn numbers_that_are_none_are_refused() {
        let mut network = Network::zero(1, &[1]);
        assert!(matches!(
            network.set(&mut [1.0].into_iter()),
            Err(FileError::Short)
        ));
        let mut numbers = std::iter::repeat(f32::NAN);
        assert!(matches!(
            network.set(&mut numbers),
            Err(FileError::NotFinite)
        ));
    }
}
