//! The random height field: a stationary Gaussian field on a torus, in its own units.
//!
//! Lengths are in the correlation length ℓ and heights in the rms height σ, so one field serves
//! every ground. Its correlation is C(r) = exp(−r²/2). It is white noise convolved with the Gaussian
//! kernel exp(−r²) (whose autocorrelation is C), in two steps: white noise on a grid of spacing ½ is
//! blurred into coefficients, and these are the weights of cubic B-splines, which are twice
//! continuously differentiable. A cubic B-spline of spacing d is close to a Gaussian of variance
//! d²/3, so the blur supplies the rest of the kernel's variance ½. The finished field is scaled to
//! an rms slope of exactly 1.

use coinmc_core::{Philox4x64, unit_interval};
use std::f64::consts::TAU;
use std::sync::OnceLock;

/// Coefficients along each side of the torus: a power of two.
const SIDE: usize = 256;
/// Coefficients of a line in memory: the first ones are repeated at its end, so that four
/// neighbours never wrap.
const WIDTH: usize = SIDE + 3;
/// Coefficients per correlation length.
const DENSITY: f64 = 2.0;
/// Farthest neighbour in the blur, in coefficients: the kernel is below 1e-9 beyond.
const BLUR: usize = 9;
/// More than the rounding errors of a height, in σ.
const ROUNDING: f64 = 1e-9;
/// The step of the bounds of cells, in σ: a byte then reaches to 7.9 σ.
const BOUND_STEP: f64 = 1.0 / 16.0;
/// The key of the field's random numbers; there is one field for all scenes.
const KEY: [u64; 2] = [0x726f_7567_686e_6573, 0x7320_6f66_2061_2074];

/// The field.
pub(super) struct HeightField {
    coefficients: Vec<f64>,
    /// What the height in each cell does not exceed, in steps of [`BOUND_STEP`].
    bounds: Vec<i8>,
    /// What no height exceeds, in σ.
    highest: f64,
}

impl HeightField {
    /// The length of the torus, in ℓ.
    pub(super) const LENGTH: f64 = SIDE as f64 / DENSITY;

    /// The field that all grounds share: where a coin is on it is random.
    pub(super) fn shared() -> &'static Self {
        static FIELD: OnceLock<HeightField> = OnceLock::new();
        FIELD.get_or_init(Self::new)
    }

    fn new() -> Self {
        let coefficients = blurred_noise();
        let scale = 1.0 / rms_slope(&coefficients);
        let wrapped = |index: usize| {
            let (row, column) = (index / WIDTH % SIDE, index % WIDTH % SIDE);
            scale * coefficients[row * SIDE + column]
        };
        let coefficients: Vec<f64> = (0..WIDTH * WIDTH).map(wrapped).collect();
        let bounds = (0..SIDE * SIDE).map(|cell| bound(&coefficients, cell / SIDE, cell % SIDE));
        let bounds: Vec<i8> = bounds.collect();
        let highest = bounds.iter().copied().max().unwrap_or(i8::MAX);
        Self {
            highest: f64::from(highest) * BOUND_STEP,
            bounds,
            coefficients,
        }
    }

    /// What the height nowhere exceeds, in σ.
    pub(super) fn highest(&self) -> f64 {
        self.highest
    }

    /// What the height nowhere exceeds in the cell around (`x`, `y`), in σ. Costs a fraction of
    /// [`height`](Self::height).
    #[inline]
    pub(super) fn height_at_most(&self, x: f64, y: f64) -> f64 {
        let ((column, _), (row, _)) = (cell(x), cell(y));
        f64::from(self.bounds[row * SIDE + column]) * BOUND_STEP
    }

    /// The height at (`x`, `y`), in σ; the coordinates are in ℓ.
    #[inline]
    pub(super) fn height(&self, x: f64, y: f64) -> f64 {
        let ((column, across), (row, along)) = (cell(x), cell(y));
        let line = weighted(&self.lines(row, column), weights(along));
        dot(weights(across), line)
    }

    /// The slopes along x and y at (`x`, `y`), in σ/ℓ.
    pub(super) fn gradient(&self, x: f64, y: f64) -> [f64; 2] {
        let ((column, across), (row, along)) = (cell(x), cell(y));
        let lines = self.lines(row, column);
        let (heights, rates) = (
            weighted(&lines, weights(along)),
            weighted(&lines, weight_rates(along)),
        );
        let (gx, gy) = (
            dot(weight_rates(across), heights),
            dot(weights(across), rates),
        );
        [DENSITY * gx, DENSITY * gy]
    }

    /// The height at (`x`, `y`), in σ, and its first two rates on the way (`dx`, `dy`).
    pub(super) fn height_along(&self, [x, y]: [f64; 2], [dx, dy]: [f64; 2]) -> [f64; 3] {
        let ((column, across), (row, along)) = (cell(x), cell(y));
        let lines = self.lines(row, column);
        let of_rows = [weights(along), weight_rates(along), weight_bends(along)];
        let [heights, rates, bends] = of_rows.map(|of_rows| weighted(&lines, of_rows));
        let (w, r, b) = (weights(across), weight_rates(across), weight_bends(across));
        let (dx, dy) = (DENSITY * dx, DENSITY * dy);
        let twist = 2.0 * dx * dy * dot(r, rates);
        [
            dot(w, heights),
            dx * dot(r, heights) + dy * dot(w, rates),
            dx * dx * dot(b, heights) + twist + dy * dy * dot(w, bends),
        ]
    }

    /// The coefficients of the splines that are not zero in a cell.
    #[inline]
    fn lines(&self, row: usize, column: usize) -> [&[f64; 4]; 4] {
        let block = &self.coefficients[row * WIDTH + column..][..3 * WIDTH + 4];
        [0, WIDTH, 2 * WIDTH, 3 * WIDTH].map(|start| {
            let line = block[start..].first_chunk();
            line.expect("a block of four lines")
        })
    }
}

/// The sum of four lines, each with its weight.
#[inline]
fn weighted(lines: &[&[f64; 4]; 4], weights: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|i| dot(weights, [0, 1, 2, 3].map(|line: usize| lines[line][i])))
}

#[inline]
fn dot(a: [f64; 4], b: [f64; 4]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

/// The cell of a coordinate, as the first of its four coefficients, and the place within the cell.
///
/// Adding 1.5 · 2⁵² rounds to a whole number and leaves it in the lowest bits, so that to wrap on the
/// torus, whose side is a power of two, is a mask for negative cells too.
#[inline]
fn cell(x: f64) -> (usize, f64) {
    /// 1.5 · 2⁵².
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    let scaled = x * DENSITY;
    let shifted = (scaled - 0.5) + SHIFT;
    // the lowest eight bits fit any usize
    #[allow(clippy::cast_possible_truncation)]
    let index = shifted.to_bits() as usize & (SIDE - 1);
    (index, scaled - (shifted - SHIFT))
}

/// The four cubic B-splines that are not zero at the place `t` of a cell.
#[inline]
fn weights(t: f64) -> [f64; 4] {
    let u = 1.0 - t;
    let (t2, u2) = (t * t, u * u);
    [
        u2 * u / 6.0,
        2.0 / 3.0 - t2 * (1.0 - 0.5 * t),
        2.0 / 3.0 - u2 * (1.0 - 0.5 * u),
        t2 * t / 6.0,
    ]
}

/// The rates of [`weights`] with the place.
fn weight_rates(t: f64) -> [f64; 4] {
    let u = 1.0 - t;
    [
        -0.5 * u * u,
        t * (1.5 * t - 2.0),
        u * (2.0 - 1.5 * u),
        0.5 * t * t,
    ]
}

/// The rates of [`weight_rates`] with the place.
fn weight_bends(t: f64) -> [f64; 4] {
    [1.0 - t, 3.0 * t - 2.0, 1.0 - 3.0 * t, t]
}

/// What the spline does not exceed in a cell, in steps of [`BOUND_STEP`]: the largest of its Bézier
/// coefficients there, whose convex hull it does not leave (Farin, *Curves and Surfaces for CAGD*).
fn bound(coefficients: &[f64], row: usize, column: usize) -> i8 {
    let lines: [[f64; 4]; 4] = std::array::from_fn(|j| {
        let start = (row + j) * WIDTH + column;
        bezier(std::array::from_fn(|i| coefficients[start + i]))
    });
    let columns = [0, 1, 2, 3].map(|i| bezier(lines.map(|line| line[i])));
    let highest = columns.into_iter().flatten().fold(f64::MIN, f64::max);
    // saturates: a field that reached beyond would lose its highest tops, which a test rules out
    #[allow(clippy::cast_possible_truncation)]
    let steps = libm::ceil((highest + ROUNDING) / BOUND_STEP) as i8;
    steps
}

/// The Bézier coefficients of a cubic with these four coefficients of B-splines.
fn bezier([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    let (left, right) = ((2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0);
    let start = 0.5 * ((a + 2.0 * b) / 3.0 + left);
    let end = 0.5 * (right + (2.0 * c + d) / 3.0);
    [start, left, right, end]
}

/// White noise on the grid, convolved with a Gaussian along both axes.
fn blurred_noise() -> Vec<f64> {
    let noise = white_noise();
    let kernel = blur_kernel();
    let blur = |from: &[f64], step: &dyn Fn(usize, usize, usize) -> usize| {
        let mut to = vec![0.0; SIDE * SIDE];
        for row in 0..SIDE {
            for column in 0..SIDE {
                to[row * SIDE + column] = (0..=2 * BLUR)
                    .map(|k| kernel[k] * from[step(row, column, SIDE + k - BLUR)])
                    .sum();
            }
        }
        to
    };
    let once = blur(&noise, &|row, column, k| row * SIDE + (column + k) % SIDE);
    blur(&once, &|row, column, k| ((row + k) % SIDE) * SIDE + column)
}

/// The Gaussian of variance ½ − d²/3 (d the grid's spacing), at the grid's points.
fn blur_kernel() -> [f64; 2 * BLUR + 1] {
    let variance = 0.5 * DENSITY * DENSITY - 1.0 / 3.0;
    std::array::from_fn(|k| {
        let distance = k as f64 - BLUR as f64;
        libm::exp(-0.5 * distance * distance / variance)
    })
}

/// Normal numbers by Box & Muller's transform.
fn white_noise() -> Vec<f64> {
    let philox = Philox4x64::new(KEY);
    let block = |index| philox.block([index, 0, 0, 0]).map(unit_interval);
    let normals = (0..(SIDE * SIDE / 4) as u64).flat_map(|index| {
        let [a, b, c, d] = block(index);
        let pair = |u: f64, v: f64| {
            let (size, (sin, cos)) = ((-2.0 * libm::log(u)).sqrt(), libm::sincos(TAU * v));
            [size * cos, size * sin]
        };
        let ([p, q], [r, s]) = (pair(a, b), pair(c, d));
        [p, q, r, s]
    });
    normals.collect()
}

/// The rms slope of a field along one direction, from its values at the grid's points.
fn rms_slope(coefficients: &[f64]) -> f64 {
    // the derivative of cubic B-splines at a grid point: half the difference of the neighbours, and
    // the weights (1, 4, 1)/6 across
    let at = |row: usize, column: usize| coefficients[(row % SIDE) * SIDE + column % SIDE];
    let mut squares = 0.0;
    for row in 0..SIDE {
        for column in 0..SIDE {
            let line = |j: usize| at(row + j, column + 2) - at(row + j, column);
            let slope = 0.5 * DENSITY * (line(0) + 4.0 * line(1) + line(2)) / 6.0;
            let pile = |i: usize| at(row + 2, column + i) - at(row, column + i);
            let other = 0.5 * DENSITY * (pile(0) + 4.0 * pile(1) + pile(2)) / 6.0;
            squares += 0.5 * (slope * slope + other * other);
        }
    }
    (squares / (SIDE * SIDE) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slope along x and y, in σ/ℓ.
    fn gradient(field: &HeightField, x: f64, y: f64) -> [f64; 2] {
        let step = 1e-3;
        let across = field.height(x + step, y) - field.height(x - step, y);
        let along = field.height(x, y + step) - field.height(x, y - step);
        [across, along].map(|rise| rise / (2.0 * step))
    }

    /// Means over places of a grid that is incommensurate with the field's own.
    fn mean(of: impl Fn(f64, f64) -> f64) -> f64 {
        let count = 400;
        let place = |i: u32| f64::from(i) * HeightField::LENGTH / f64::from(count) + 0.123;
        let mut sum = 0.0;
        for i in 0..count {
            for j in 0..count {
                sum += of(place(i), place(j));
            }
        }
        sum / f64::from(count * count)
    }

    /// There are about LENGTH²/π = 5200 independent patches on the torus, so a mean square is known
    /// to sqrt(2/5200) = 2 %, and 6 % are three standard errors.
    #[test]
    fn heights_slopes_and_correlation_are_those_of_the_spectrum() {
        let field = HeightField::shared();
        let variance = mean(|x, y| field.height(x, y).powi(2));
        assert!((variance - 1.0).abs() < 0.06, "{variance}");
        let slope = mean(|x, y| gradient(field, x, y)[0].powi(2));
        assert!((slope - 1.0).abs() < 0.06, "{slope}");
        for lag in [0.5, 1.0, 1.5, 2.5] {
            let along = mean(|x, y| field.height(x, y) * field.height(x + lag, y));
            let across = mean(|x, y| field.height(x, y) * field.height(x, y + lag));
            let expected = libm::exp(-0.5 * lag * lag);
            assert!((along - expected).abs() < 0.06, "{lag}: {along}");
            assert!((across - expected).abs() < 0.06, "{lag}: {across}");
        }
    }

    #[test]
    fn no_height_exceeds_the_bound_of_its_cell_and_some_come_near() {
        let field = HeightField::shared();
        assert!(field.bounds.iter().all(|&bound| bound < i8::MAX));
        let most = field.bounds.iter().copied().max().map(f64::from);
        assert_eq!(Some(field.highest()), most.map(|steps| steps / 16.0));
        let mut nearest = f64::INFINITY;
        for i in 0..300_u32 {
            for j in 0..300_u32 {
                let (x, y) = (0.427 * f64::from(i), 0.427 * f64::from(j));
                let room = field.height_at_most(x, y) - field.height(x, y);
                assert!(room > 0.0, "{x} {y}: {room}");
                nearest = nearest.min(room);
            }
        }
        assert!(nearest < 0.01, "{nearest}");
    }

    #[test]
    fn the_field_closes_on_itself_and_is_smooth() {
        let field = HeightField::shared();
        for i in 0..50 {
            let (x, y) = (0.37 * f64::from(i), 0.71 * f64::from(i));
            let around = field.height(x - HeightField::LENGTH, y + HeightField::LENGTH);
            assert!((field.height(x, y) - around).abs() < 1e-9);
        }
        // across a cell's border neither the height nor the slope jumps
        let (before, after) = (
            gradient(field, 1.0 - 2e-3, 0.2),
            gradient(field, 1.0 + 2e-3, 0.2),
        );
        assert!((before[0] - after[0]).abs() < 0.02, "{before:?} {after:?}");
    }

    /// Rates of heights by differences over 2h: the third derivative of a bicubic spline jumps between cells, so
    /// those of the rates are off by about h σ/ℓ³ times ten, those of the heights by h² and by rounding.
    #[test]
    fn rates_along_a_way_are_those_of_the_height() {
        let field = HeightField::shared();
        let step = 1e-4;
        for i in 0..500 {
            let (at, angle) = ([0.371 * f64::from(i), 0.713 * f64::from(i)], f64::from(i));
            let way = [libm::cos(angle), libm::sin(angle)];
            let along = |by: f64| {
                let place = [0, 1].map(|k: usize| at[k] + by * way[k]);
                field.height_along(place, way)
            };
            let ([height, rate, bend], before, after) = (along(0.0), along(-step), along(step));
            let slope = field.gradient(at[0], at[1]);
            let by_slope = slope[0] * way[0] + slope[1] * way[1];
            assert!((rate - by_slope).abs() < 1e-12, "{i}: {rate} {by_slope}");
            assert!((height - field.height(at[0], at[1])).abs() < 1e-14);
            let differences = [0, 1].map(|k: usize| (after[k] - before[k]) / (2.0 * step));
            assert!((rate - differences[0]).abs() < 1e-6, "{i}: {rate}");
            assert!((bend - differences[1]).abs() < 1e-3, "{i}: {bend}");
        }
    }

    /// The root mean square of the slopes along both axes, over all points of the grid: 1, but for rounding.
    #[test]
    fn the_rms_slope_is_one() {
        let (field, mut squares) = (HeightField::shared(), 0.0);
        for row in 0..SIDE {
            for column in 0..SIDE {
                let [x, y] = [column, row].map(|index| index as f64 / DENSITY);
                let [gx, gy] = field.gradient(x, y);
                squares += 0.5 * (gx * gx + gy * gy);
            }
        }
        let rms = (squares / (SIDE * SIDE) as f64).sqrt();
        assert!((rms - 1.0).abs() < 1e-11, "{rms}");
    }
}
