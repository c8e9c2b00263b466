//! The coin that will be printed.

use crate::CoinNumbers;
use coinmc_core::Coin;
use coinmc_solid::{Edge, Infill, Marks, Mass, MassError, Shape, ShapeError};

/// All of a printed coin but its thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrintedCoin {
    /// Diameter, m.
    pub diameter_m: f64,
    /// Its rims.
    pub edge: Edge,
    /// Whether heads and tails have marks.
    pub marks: bool,
    /// Density of the material, kg/m³.
    pub density_kg_m3: f64,
    /// Walls and inside, if it is not full.
    pub infill: Option<Infill>,
}

impl PrintedCoin {
    /// The coin of this thickness.
    ///
    /// # Errors
    /// [`ShapeError`] if it cannot be.
    pub fn shape(&self, thickness_m: f64) -> Result<Shape, ShapeError> {
        let plain = Shape::new(self.diameter_m, thickness_m, self.edge)?;
        if self.marks {
            plain.with_marks(Marks::fitting(&plain))
        } else {
            Ok(plain)
        }
    }

    /// Its mass and moments of inertia.
    pub(super) fn mass(&self, shape: &Shape) -> Result<Mass, MassError> {
        shape.mass(self.density_kg_m3, self.infill)
    }

    /// What the engines are told of the coin of this ratio. A coin too thin for its marks or walls is
    /// taken as uniform: no answer lies there.
    pub(super) fn numbers(&self, coin: &Coin) -> CoinNumbers {
        let mut numbers = vec![];
        // a chamfer acts like a rounding of its size (docs/methods/space.md)
        if let Edge::Rounded { radius_m: size_m } | Edge::Chamfered { size_m } = self.edge {
            numbers.push(("rim_radius_m", size_m));
        }
        let shape = self.shape(coin.height_m());
        if let Some(mass) = shape.ok().and_then(|shape| self.mass(&shape).ok()) {
            numbers.push(("mass_kg", mass.mass_kg));
            numbers.push(("axial_moment_kg_m2", mass.axial_kg_m2));
            numbers.push(("transverse_moment_kg_m2", mass.transverse_kg_m2));
        }
        numbers
    }
}
