//! The coins and grounds of this module's tests.

use crate::laws::Moreau;
use crate::model::Model;
use crate::settings::Settings;
use coinmc_core::{Coin, Roughness, Scene, Surface};

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
