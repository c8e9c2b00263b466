//! Fits a network to counts: maximum likelihood by stochastic gradients (Adam: Kingma & Ba, arXiv 1412.6980).
//!
//! Everything is done in one order, in single precision and with elementary functions of our own library, so the
//! same counts give the same network to the bit on every machine.

use crate::network::{Layer, Network, OUTPUTS, logistic, single};
use coinmc_core::{Domain, Stream, TossUniforms, UniformSource};

/// Places that are looked at between two corrections of the weights.
const BATCH: usize = 256;
/// Numbers that are added up side by side, so that the compiler can use wide registers.
const WIDE: usize = 16;

/// How a network is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Training {
    /// Units of each hidden layer.
    pub hidden: Vec<usize>,
    /// Times that every place is looked at.
    pub epochs: u32,
    /// Largest step of a weight.
    pub rate: f32,
}

impl Default for Training {
    fn default() -> Self {
        Self {
            hidden: vec![64; 4],
            epochs: 160,
            rate: 4e-3,
        }
    }
}

/// Counts at a place.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sample {
    /// Inputs of the network.
    pub(crate) place: Vec<f32>,
    /// Tosses that showed a face, those among them that showed the side, and heads.
    pub(crate) shown: f32,
    pub(crate) side: f32,
    pub(crate) heads: f32,
}

/// Fits a network to these samples; `go_on` is asked now and then.
pub(crate) fn train(
    samples: &[&Sample],
    training: &Training,
    seed: u64,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Option<Network> {
    let inputs = samples.first()?.place.len();
    let mut uniforms = Stream::new(seed, Domain::Parameters, 0).toss(0);
    let mut drawn = 0;
    let mut network = Network::zero(inputs, &training.hidden);
    begin(&mut network, &mut uniforms, &mut drawn);
    let mut workspace = Workspace::new(&network);
    let mut adam = Adam::new(&network);
    let mean = samples.iter().map(|sample| sample.shown).sum::<f32>() / samples.len() as f32;
    let scale = 1.0 / (mean * BATCH as f32);
    let batches = samples.len() / BATCH;
    let steps = (u64::from(training.epochs) * batches as u64) as f64;
    let mut order: Vec<usize> = (0..samples.len()).collect();
    let mut step = 0_u32;
    for epoch in 0..training.epochs {
        if !go_on() {
            return None;
        }
        let mut words = Stream::new(seed, Domain::Parameters, u64::from(epoch) + 1).toss(0);
        shuffle(&mut order, &mut words);
        for batch in order.chunks_exact(BATCH) {
            step += 1;
            let rate = training.rate * schedule(f64::from(step) / steps, step);
            workspace.forward(&network, samples, batch);
            workspace.backward(&network, samples, batch, scale);
            adam.correct(&mut network, &workspace.gradient, rate, step);
        }
    }
    Some(network)
}

/// Random weights whose sums have the variance of one input (LeCun et al., 1998).
fn begin(network: &mut Network, uniforms: &mut TossUniforms, drawn: &mut u32) {
    for layer in &mut network.layers {
        let width = libm::sqrtf(3.0 / layer.inputs as f32);
        for weight in &mut layer.weights {
            *weight = width * single(2.0 * uniforms.uniform(*drawn) - 1.0);
            *drawn += 1;
        }
    }
}

/// Share of the largest step: a rise over the first steps, then half a cosine down to 0.
fn schedule(t: f64, step: u32) -> f32 {
    let rise = (f64::from(step) / 200.0).min(1.0);
    single(0.5 * rise * (1.0 + libm::cos(std::f64::consts::PI * t)))
}

/// Fisher and Yates' shuffle.
fn shuffle(order: &mut [usize], words: &mut TossUniforms) {
    for last in (1..order.len()).rev() {
        let drawn = u32::try_from(last).expect("a design has fewer points than 2^32");
        // a 64-bit word times the number of choices, the upper half of the product
        let other = (u128::from(words.word(drawn)) * (last as u128 + 1)) >> 64;
        order.swap(last, usize::try_from(other).expect("at most `last`"));
    }
}

/// Values of a layer for all places of a batch: one row a unit.
type Rows = Vec<[f32; BATCH]>;

/// What a batch needs.
struct Workspace {
    /// Values of the inputs and of each layer.
    values: Vec<Rows>,
    /// Derivatives of each layer's values by the sums that they are functions of.
    rates: Vec<Rows>,
    /// Derivatives of ln of the likelihood by each layer's sums.
    slopes: Vec<Rows>,
    /// Derivatives by the network's numbers.
    gradient: Network,
}

impl Workspace {
    fn new(network: &Network) -> Self {
        let rows = |n: usize| vec![[0.0; BATCH]; n];
        let outputs = network.layers.iter().map(|layer| rows(layer.biases.len()));
        let slopes: Vec<Rows> = outputs.collect();
        let mut values = vec![rows(network.layers[0].inputs)];
        values.extend(slopes.iter().cloned());
        Self {
            values,
            rates: slopes.clone(),
            slopes,
            gradient: network.clone(),
        }
    }

    fn forward(&mut self, network: &Network, samples: &[&Sample], batch: &[usize]) {
        for (column, &sample) in batch.iter().enumerate() {
            for (row, x) in self.values[0].iter_mut().zip(&samples[sample].place) {
                row[column] = *x;
            }
        }
        let last = network.layers.len() - 1;
        for (number, layer) in network.layers.iter().enumerate() {
            let (before, after) = self.values.split_at_mut(number + 1);
            let weights = layer.weights.chunks_exact(layer.inputs);
            let rows = after[0].iter_mut().zip(&mut self.rates[number]);
            for (((row, rates), weights), bias) in rows.zip(weights).zip(&layer.biases) {
                weighted(row, *bias, &weights.iter().copied(), &before[number]);
                if number < last {
                    for (value, rate) in row.iter_mut().zip(rates) {
                        let share = logistic(*value);
                        *rate = share * (1.0 + *value * (1.0 - share));
                        *value *= share;
                    }
                }
            }
        }
    }

    fn backward(&mut self, network: &Network, samples: &[&Sample], batch: &[usize], scale: f32) {
        let last = network.layers.len() - 1;
        for (column, &sample) in batch.iter().enumerate() {
            let Sample {
                shown, side, heads, ..
            } = samples[sample];
            let [of_side, of_heads]: [f32; OUTPUTS] =
                [0, 1].map(|output| logistic(self.values[last + 1][output][column]));
            self.slopes[last][0][column] = scale * (shown * of_side - side);
            self.slopes[last][1][column] = scale * ((shown - side) * of_heads - heads);
        }
        for number in (0..=last).rev() {
            let layer = &network.layers[number];
            let gradient = &mut self.gradient.layers[number];
            for (output, slopes) in self.slopes[number].iter().enumerate() {
                gradient.biases[output] = sum(slopes);
                let row = &mut gradient.weights[output * layer.inputs..][..layer.inputs];
                for (weight, values) in row.iter_mut().zip(&self.values[number]) {
                    *weight = product(slopes, values);
                }
            }
            if number > 0 {
                let (before, after) = self.slopes.split_at_mut(number);
                for (input, row) in before[number - 1].iter_mut().enumerate() {
                    let column = layer.weights[input..].iter().step_by(layer.inputs);
                    weighted(row, 0.0, &column.copied(), &after[0]);
                    for (slope, rate) in row.iter_mut().zip(&self.rates[number - 1][input]) {
                        *slope *= rate;
                    }
                }
            }
        }
    }
}

/// bias + Σ weight · row.
fn weighted(
    sum: &mut [f32; BATCH],
    bias: f32,
    weights: &(impl Iterator<Item = f32> + Clone),
    rows: &[[f32; BATCH]],
) {
    for first in (0..BATCH).step_by(WIDE) {
        let mut wide = [bias; WIDE];
        for (weight, row) in weights.clone().zip(rows) {
            let row: &[f32; WIDE] = row[first..][..WIDE].try_into().expect("WIDE divides BATCH");
            for (sum, x) in wide.iter_mut().zip(row) {
                *sum += weight * x;
            }
        }
        sum[first..][..WIDE].copy_from_slice(&wide);
    }
}

/// Σ a b.
fn product(a: &[f32; BATCH], b: &[f32; BATCH]) -> f32 {
    let mut wide = [0.0; WIDE];
    for (a, b) in a.chunks_exact(WIDE).zip(b.chunks_exact(WIDE)) {
        for ((sum, a), b) in wide.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    wide.iter().sum()
}

fn sum(a: &[f32; BATCH]) -> f32 {
    a.iter().sum()
}

/// Running means of the gradient and of its square.
struct Adam {
    mean: Vec<f32>,
    square: Vec<f32>,
}

impl Adam {
    fn new(network: &Network) -> Self {
        let zeros = vec![0.0; network.numbers().count()];
        Self {
            mean: zeros.clone(),
            square: zeros,
        }
    }

    fn correct(&mut self, network: &mut Network, gradient: &Network, rate: f32, step: u32) {
        const MEAN: f32 = 0.9;
        const SQUARE: f32 = 0.999;
        let power = |base: f32| 1.0 - libm::powf(base, step as f32);
        let (of_mean, of_square) = (power(MEAN), power(SQUARE));
        let mut known = self.mean.iter_mut().zip(&mut self.square);
        let mut one = |number: &mut f32, slope: f32| {
            let (mean, square) = known.next().expect("one for each number");
            *mean = MEAN * *mean + (1.0 - MEAN) * slope;
            *square = SQUARE * *square + (1.0 - SQUARE) * slope * slope;
            *number -= rate * (*mean / of_mean) / (libm::sqrtf(*square / of_square) + 1e-8);
        };
        for (layer, slopes) in network.layers.iter_mut().zip(&gradient.layers) {
            let Layer {
                weights, biases, ..
            } = layer;
            for (weight, slope) in weights.iter_mut().zip(&slopes.weights) {
                one(weight, *slope);
            }
            for (bias, slope) in biases.iter_mut().zip(&slopes.biases) {
                one(bias, *slope);
            }
        }
    }
}
