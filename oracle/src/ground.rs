//! An explicit rough ground: a random height field made of plane waves.
//!
//! z = h(x, y) is stationary, isotropic and Gaussian with mean 0 and correlation
//! σ² exp(−r²/(2ℓ²)). Its spectrum is a Gaussian of width 1/ℓ, so that h is a sum of waves whose
//! wave vectors have independent normal components of that width (Shinozuka & Deodatis, Appl.
//! Mech. Rev. 44 (1991) 191). All waves have the same amplitude, σ sqrt(2/N), and random phases:
//! every ground then has the variance σ² itself, and is Gaussian up to an excess kurtosis of −1.5/N.
//! |k| is stratified over its distribution (Rayleigh), so that every ground has nearly the rms
//! slope σ/ℓ as well.
//!
//! The waves are summed at the nodes of a grid, with their derivatives; between the nodes the
//! ground *is* the bicubic Hermite interpolant: its slopes are continuous and are exactly those of
//! its heights, as conservation of energy requires. It differs from the sum by a few 1e-4 σ.

use std::collections::HashMap;
use std::f64::consts::TAU;

/// Number of waves.
const WAVES: usize = 128;
/// Distance of the nodes in ℓ.
const SPACING: f64 = 1.0 / 3.0;
/// Cells of a tile along either axis: nodes are computed a tile at a time, where they are needed.
const CELLS: usize = 4;
const NODES: usize = CELLS + 1;
/// `CELLS` among the indices of cells.
#[allow(clippy::cast_possible_wrap)]
const TILE: i64 = CELLS as i64;
/// Tiles that are remembered.
const MOST_TILES: usize = 1 << 16;
/// Slots of the table of tiles last used.
const RECENT: usize = 1 << 10;
#[allow(clippy::cast_possible_wrap)]
const SLOTS: i64 = RECENT as i64;
/// The golden ratio's fraction, whose multiples spread evenly over the circle.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Height and derivatives at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relief {
    /// h.
    pub height: f64,
    /// (∂h/∂x, ∂h/∂y).
    pub gradient: [f64; 2],
    /// (∂²h/∂x², ∂²h/∂x∂y, ∂²h/∂y²).
    pub curvature: [f64; 3],
}

/// A wave: its vector, and amplitude and phase.
#[derive(Debug, Clone, Copy)]
struct Wave {
    k: [f64; 2],
    amplitude: f64,
    phase: f64,
    /// cos and sin of the phase between neighbouring nodes, along x and y.
    turn: [[f64; 2]; 2],
}

/// h, ∂x, ∂y, ∂x∂y at a node, the derivatives in units of a cell.
type Node = [f64; 4];
type Tile = [[Node; NODES]; NODES];

/// A rough ground. Lengths in the unit of its ℓ.
///
/// # Example
/// ```
/// use coinmc_oracle::Ground;
///
/// let mut ground = Ground::new(0.03, 0.5, 1);
/// let here = ground.at(10.0, -3.0);
/// assert!(here.height.abs() < 6.0 * ground.deviation());
/// assert_eq!(ground.deviation(), 0.03 * 0.5);
/// ```
#[derive(Debug, Clone)]
pub struct Ground {
    slope: f64,
    correlation: f64,
    cell: f64,
    waves: Vec<Wave>,
    tiles: Vec<Tile>,
    places: HashMap<[i64; 2], usize>,
    recent: Vec<([i64; 2], usize)>,
}

impl Ground {
    /// The ground of a seed with the rms slope σ/ℓ along any direction and the correlation
    /// length ℓ, in the unit of all lengths. Slope 0 makes it flat.
    pub fn new(slope: f64, correlation: f64, seed: u64) -> Self {
        let mut random = SplitMix(seed);
        let cell = SPACING * correlation;
        let amplitude = slope * correlation * (2.0 / WAVES as f64).sqrt();
        let offset = random.uniform();
        let waves = (0..WAVES)
            .map(|n| {
                let share = (n as f64 + random.uniform()) / WAVES as f64;
                let size = (-2.0 * libm::log(share)).sqrt() / correlation;
                let (sin, cos) = libm::sincos(TAU * (offset + GOLDEN * n as f64));
                let k = [size * cos, size * sin];
                let turn = k.map(|k| {
                    let (sin, cos) = libm::sincos(k * cell);
                    [cos, sin]
                });
                let phase = TAU * random.uniform();
                Wave {
                    k,
                    amplitude,
                    phase,
                    turn,
                }
            })
            .collect();
        Self {
            slope,
            correlation,
            cell,
            waves,
            tiles: Vec::new(),
            places: HashMap::new(),
            recent: vec![([i64::MAX; 2], 0); RECENT],
        }
    }

    /// Whether it is a plane.
    pub fn is_flat(&self) -> bool {
        self.slope == 0.0
    }

    /// ℓ, over which heights are correlated; λ = 2πℓ is the mean distance of up-crossings.
    pub fn correlation_length(&self) -> f64 {
        self.correlation
    }

    /// σ, the standard deviation of the heights.
    pub fn deviation(&self) -> f64 {
        self.slope * self.correlation
    }

    /// The sum of the waves itself, without the grid: slow.
    pub fn sum(&self, x: f64, y: f64) -> f64 {
        self.waves
            .iter()
            .map(|w| w.amplitude * libm::cos(w.k[0] * x + w.k[1] * y + w.phase))
            .sum()
    }

    /// The ground at a place.
    pub fn at(&mut self, x: f64, y: f64) -> Relief {
        let (i, u) = split(x / self.cell);
        let (j, v) = split(y / self.cell);
        let place = [i.div_euclid(TILE), j.div_euclid(TILE)];
        let tile = self.tile(place);
        // remainders below CELLS
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let (i, j) = (i.rem_euclid(TILE) as usize, j.rem_euclid(TILE) as usize);
        let corner = |a: usize, b: usize| &self.tiles[tile][i + a][j + b];
        interpolate(
            [[corner(0, 0), corner(0, 1)], [corner(1, 0), corner(1, 1)]],
            u,
            v,
        )
        .scaled(self.cell)
    }

    /// The index of a tile, which is computed if it is new.
    fn tile(&mut self, place: [i64; 2]) -> usize {
        // a table index
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let slot = (place[0] + 37 * place[1]).rem_euclid(SLOTS) as usize;
        let (held, tile) = self.recent[slot];
        if held == place {
            return tile;
        }
        let tile = self.places.get(&place).copied().unwrap_or_else(|| {
            if self.tiles.len() >= MOST_TILES {
                self.tiles.clear();
                self.places.clear();
                self.recent.fill(([i64::MAX; 2], 0));
            }
            self.tiles.push(make_tile(&self.waves, self.cell, place));
            self.places.insert(place, self.tiles.len() - 1);
            self.tiles.len() - 1
        });
        self.recent[slot] = (place, tile);
        tile
    }
}

impl Relief {
    fn scaled(mut self, cell: f64) -> Self {
        self.gradient = self.gradient.map(|g| g / cell);
        self.curvature = self.curvature.map(|c| c / (cell * cell));
        self
    }
}

/// The nodes of a tile: each wave is turned from node to node.
fn make_tile(waves: &[Wave], cell: f64, place: [i64; 2]) -> Tile {
    let mut tile = [[[0.0; 4]; NODES]; NODES];
    let origin = place.map(|index| (index * TILE) as f64 * cell);
    let turned = |[c, s]: [f64; 2], [a, b]: [f64; 2]| [c * a - s * b, s * a + c * b];
    for wave in waves {
        let phase = wave.k[0] * origin[0] + wave.k[1] * origin[1] + wave.phase;
        let (sin, cos) = libm::sincos(phase);
        let mut row = [wave.amplitude * cos, wave.amplitude * sin];
        let (kx, ky) = (wave.k[0] * cell, wave.k[1] * cell);
        for nodes in &mut tile {
            let mut at = row;
            for node in nodes {
                let [c, s] = at;
                node[0] += c;
                node[1] -= kx * s;
                node[2] -= ky * s;
                node[3] -= kx * ky * c;
                at = turned(at, wave.turn[1]);
            }
            row = turned(row, wave.turn[0]);
        }
    }
    tile
}

/// The cell's index and the place in it, from 0 to 1.
fn split(x: f64) -> (i64, f64) {
    let floor = x.floor();
    // far below 2⁶³ cells
    #[allow(clippy::cast_possible_truncation)]
    (floor as i64, x - floor)
}

/// The cubic Hermite functions [value at 0, slope at 0, value at 1, slope at 1] and their first and
/// second derivatives.
fn hermite(t: f64) -> [[f64; 4]; 3] {
    let (t2, r) = (t * t, 1.0 - t);
    [
        [
            r * r * (1.0 + 2.0 * t),
            t * r * r,
            t2 * (3.0 - 2.0 * t),
            -t2 * r,
        ],
        [
            -6.0 * t * r,
            r * (1.0 - 3.0 * t),
            6.0 * t * r,
            t * (3.0 * t - 2.0),
        ],
        [12.0 * t - 6.0, 6.0 * t - 4.0, 6.0 - 12.0 * t, 6.0 * t - 2.0],
    ]
}

fn interpolate(corners: [[&Node; 2]; 2], u: f64, v: f64) -> Relief {
    let (along_x, along_y) = (hermite(u), hermite(v));
    let mut sums = [0.0; 6];
    // derivatives along x and y of the six sums
    let orders = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)];
    for (sum, (dx, dy)) in sums.iter_mut().zip(orders) {
        let (p, q) = (&along_x[dx], &along_y[dy]);
        for a in 0..2 {
            for b in 0..2 {
                let node = corners[a][b];
                *sum += p[2 * a] * (q[2 * b] * node[0] + q[2 * b + 1] * node[2])
                    + p[2 * a + 1] * (q[2 * b] * node[1] + q[2 * b + 1] * node[3]);
            }
        }
    }
    let [height, gx, gy, xx, xy, yy] = sums;
    Relief {
        height,
        gradient: [gx, gy],
        curvature: [xx, xy, yy],
    }
}

/// Steele, Lea & Flood, "Fast splittable pseudorandom number generators" (2014).
#[derive(Debug)]
struct SplitMix(u64);

impl SplitMix {
    /// Uniform in (0, 1).
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        ((z >> 12) as f64 + 0.5) / (1u64 << 52) as f64
    }
}
