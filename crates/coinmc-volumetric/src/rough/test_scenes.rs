//! The coins and grounds of this module's tests.

use super::walk::Walk;
use crate::laws::Moreau;
use crate::model::Model;
use crate::motion::Spin;
use crate::settings::Settings;
use crate::toss::Toss;
use coinmc_core::{Coin, Launch, Roughness, Scene, Surface};
use nalgebra::{UnitVector3, Vector3};

/// A coin on rough ground.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rough {
    pub(super) ratio: f64,
    pub(super) restitution: f64,
    pub(super) friction: f64,
    /// ρ_c and ρ_p, m.
    pub(super) friction_m: [f64; 2],
    pub(super) slope: f64,
    pub(super) wavelength_m: f64,
}

impl Rough {
    /// A coin with this H/R on ground of this slope, λ = 3 mm.
    pub(super) fn of(ratio: f64, slope: f64) -> Self {
        Self {
            ratio,
            slope,
            restitution: 0.5,
            friction: 0.3,
            friction_m: [5e-5, 5e-6],
            wavelength_m: 3e-3,
        }
    }

    pub(super) fn scene(&self) -> Scene {
        let [contour, pivoting] = self.friction_m;
        let surface = Surface::new(self.restitution, self.friction)
            .and_then(|surface| surface.with_friction_lengths(contour, pivoting))
            .expect("a valid surface")
            .with_roughness(Roughness::new(self.slope, self.wavelength_m).ok());
        let coin = Coin::cylinder(self.ratio, 0.0116).expect("a valid coin");
        Scene::new(coin, surface, 9.81).expect("a valid scene")
    }

    pub(super) fn model(&self) -> Model<Moreau> {
        Model::new(&self.scene(), &Settings::default(), Moreau).expect("valid settings")
    }
}

/// A coin whose own rim touches the mean of the ground, that leans at this angle from upright, and whose centre has
/// this velocity in its frame.
pub(super) fn leaning(model: &Model<Moreau>, angle: f64, velocity: [f64; 3]) -> Toss {
    let (sin, cos) = libm::sincos(angle);
    let mut toss = model.launch(&Launch {
        height_m: 0.0,
        velocity_m_s: Vector3::zeros(),
        axis: UnitVector3::new_unchecked(Vector3::new(cos, 0.0, sin)),
        spin_rad_s: Vector3::zeros(),
    });
    toss.motion.z = toss.motion.rest_height(&model.dynamics.body);
    let m = &mut toss.motion;
    [m.vx, m.vy, m.vz] = velocity;
    toss
}

/// Gives a coin this spin.
pub(super) fn set_spin(walk: &mut Walk<'_, Moreau, ()>, spin: Spin<f64>) {
    walk.toss.spin = spin;
    let factor = walk.model.dynamics.axial_factor;
    walk.toss.motion.set_spin(&spin, factor);
}
