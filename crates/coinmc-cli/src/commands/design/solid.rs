//! The coin that will be printed.

use crate::exit::Failure;
use anyhow::anyhow;
use coinmc_core::Coin;
use coinmc_questions::CoinNumbers;
use coinmc_solid::{Edge, Infill, Marks, Mass, Shape};

/// All of the coin but its thickness.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solid {
    pub(super) diameter_m: f64,
    pub(super) rim_m: Option<f64>,
    pub(super) chamfer_m: Option<f64>,
    pub(super) marks: bool,
    pub(super) density_kg_m3: f64,
    /// Thickness of the walls, and the share of the inside that is full.
    pub(super) infill: Option<(f64, f64)>,
}

impl Solid {
    /// The coin of this thickness.
    pub(super) fn shape(&self, thickness_m: f64) -> Result<Shape, Failure> {
        self.shape_of(thickness_m)
            .map_err(|error| Failure::Input(anyhow!(error)))
    }

    fn shape_of(&self, thickness_m: f64) -> Result<Shape, coinmc_solid::ShapeError> {
        let edge = match (self.rim_m, self.chamfer_m) {
            (Some(radius_m), _) => Edge::Rounded { radius_m },
            (None, Some(size_m)) => Edge::Chamfered { size_m },
            (None, None) => Edge::Sharp,
        };
        let plain = Shape::new(self.diameter_m, thickness_m, edge)?;
        if self.marks {
            plain.with_marks(Marks::fitting(&plain))
        } else {
            Ok(plain)
        }
    }

    /// Its mass and moments of inertia.
    pub(super) fn mass(&self, shape: &Shape) -> Result<Mass, Failure> {
        let infill = self.infill.map(|(walls_m, density_fraction)| Infill {
            walls_m,
            density_fraction,
        });
        shape
            .mass(self.density_kg_m3, infill)
            .map_err(|error| Failure::Input(anyhow!(error)))
    }

    /// What the engines are told of the coin of this ratio. A coin too thin for its marks or walls is
    /// taken as uniform: no answer lies there.
    pub(super) fn numbers(&self, coin: &Coin) -> CoinNumbers {
        let mut numbers = vec![];
        if let Some(rim) = self.rim_m {
            numbers.push(("rim_radius_m", rim));
        }
        if let Ok(mass) = self
            .shape(coin.height_m())
            .and_then(|shape| self.mass(&shape))
        {
            numbers.push(("mass_kg", mass.mass_kg));
            numbers.push(("axial_moment_kg_m2", mass.axial_kg_m2));
            numbers.push(("transverse_moment_kg_m2", mass.transverse_kg_m2));
        }
        numbers
    }
}
