//! Corners of circles.

use std::f64::consts::PI;

/// The directions of a regular polygon's corners, longer than one so that it has the circle's area.
///
/// A polygon of N corners at the distance R' has the area N R'²/2 sin ψ with ψ = 2π/N, so that
/// R' = R sqrt(ψ/sin ψ). Its corners lie R ψ²/12 outside the circle, the middles of its sides R ψ²/24
/// inside: less than the R ψ²/8 of an inscribed polygon. Its moment ∫ρ² dA is the circle's times
/// 1 + ψ⁴/180 + …
pub(super) struct Grid {
    directions: Vec<[f64; 2]>,
}

impl Grid {
    /// A polygon of so many corners, a multiple of four.
    pub(super) fn new(corners: u32) -> Self {
        let psi = 2.0 * PI / f64::from(corners);
        let stretch = (psi / libm::sin(psi)).sqrt();
        let quarter = corners / 4;
        let first = |k: u32| {
            let phi = psi * f64::from(k);
            [stretch * libm::cos(phi), stretch * libm::sin(phi)]
        };
        // the same quarter four times, turned exactly: no coordinate of an axis is nearly zero
        let turn = |[x, y]: [f64; 2], quarters: u32| match quarters {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        };
        let directions = (0..corners)
            .map(|k| turn(first(k % quarter), k / quarter))
            .collect();
        Self { directions }
    }

    /// The number of corners.
    pub(super) fn len(&self) -> usize {
        self.directions.len()
    }

    /// The corner `k` at the distance `rho` from the axis; corners repeat after a turn.
    pub(super) fn at(&self, k: usize, rho: f64, z: f64) -> [f64; 3] {
        let [x, y] = self.directions[k % self.len()];
        // without the sign of a negative zero
        [rho * x + 0.0, rho * y + 0.0, z]
    }
}
