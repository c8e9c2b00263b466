//! The scene in units of D, sqrt(D/g) and m.

use coinmc_core::Scene;
use nalgebra::{Matrix3, Vector3};

/// Coin, surface and air, without units: g = 1, D = 1, m = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// R/D; of rounded rims (R − r)/D, the radius of their centre lines.
    pub radius: f64,
    /// H/(2D), or (H/2 − r)/D.
    pub half: f64,
    /// (R/D, h/D) of the rims of heads and of tails, h the distance from the centre of mass: twice the above,
    /// unless the edge is conical.
    pub rims: [(f64, f64); 2],
    /// r/D, the radius of the rims' rounding: the lowest point is this far below their centre line.
    pub rim: f64,
    /// I_t/(m D²), about a diameter through the centre.
    pub transverse: f64,
    /// I_a/(m D²), about the axis.
    pub axial: f64,
    /// Newton's restitution e.
    pub restitution: f64,
    /// Approach speed in sqrt(gD) below which e is 0.
    pub threshold: f64,
    /// Coulomb friction μ.
    pub friction: f64,
    /// Rolling (contour) friction length, ρ_c/D.
    pub contour: f64,
    /// Pivoting friction length, ρ_p/D.
    pub pivoting: f64,
    /// Decay of the velocity, in sqrt(g/D).
    pub linear_drag: f64,
    /// Decay of the angular momentum, in sqrt(g/D).
    pub angular_drag: f64,
    /// Whether ω × Iω acts.
    pub gyroscopic: bool,
    /// The part of the weight along a tilted table, in axes of the table, over that which presses on it.
    pub pull: Vector3<f64>,
}

impl Model {
    /// The model of a scene. Adhesive landing is ignored: the coin bounces.
    pub fn new(scene: &Scene) -> Self {
        let scene = &scene.pressed_onto_table();
        let (coin, surface, drag) = (&scene.coin, &scene.surface, scene.drag());
        let (d, time) = (coin.rim_distance_m(), scene.time_scale_s());
        Self {
            radius: (coin.radius_m() - coin.rim_radius_m()) / d,
            half: (0.5 * coin.height_m() - coin.rim_radius_m()) / d,
            rims: coin
                .rims()
                .map(|rim| (rim.radius_m / d, rim.distance_m / d)),
            rim: coin.rim_radius_m() / d,
            transverse: coin.transverse_gyration_m2() / (d * d),
            axial: coin.axial_gyration_m2() / (d * d),
            restitution: surface.restitution(),
            threshold: surface.restitution_threshold_m_s() * time / d,
            friction: surface.friction(),
            contour: surface.rolling_friction_m() / d,
            pivoting: surface.pivoting_friction_m() / d,
            linear_drag: drag.linear_per_s() * time,
            angular_drag: drag.angular_per_s() * time,
            gyroscopic: scene.has_gyroscopic_torque(),
            pull: surface.tilt().map_or(Vector3::zeros(), |tilt| {
                let weight = tilt.in_table_axes(&-Vector3::z());
                Vector3::new(weight.x, weight.y, 0.0) / -weight.z
            }),
        }
    }

    /// The inertia tensor of a coin whose axis is `axis`.
    pub fn inertia(&self, axis: &Vector3<f64>) -> Matrix3<f64> {
        tensor(self.transverse, self.axial, axis)
    }

    /// The inverse of [`inertia`](Self::inertia).
    pub fn inverse_inertia(&self, axis: &Vector3<f64>) -> Matrix3<f64> {
        tensor(1.0 / self.transverse, 1.0 / self.axial, axis)
    }
}

/// transverse·1 + (axial − transverse) u uᵀ.
fn tensor(transverse: f64, axial: f64, axis: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_diagonal_element(transverse) + axis * axis.transpose() * (axial - transverse)
}
