//! The mass of a print: full walls around a core of sparse infill.

use crate::error::MassError;
use crate::moments::Moments;
use crate::shape::{Edge, Shape};
use std::f64::consts::FRAC_1_SQRT_2;

/// How a printer fills the coin: walls, bottom and lid of full material, and a sparse core.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Infill {
    /// Thickness of the walls, of the bottom and of the lid, m. Walls of the coin's radius or half its
    /// thickness leave no core.
    pub walls_m: f64,
    /// Share of the core's volume that is material, from 0 to 1.
    pub density_fraction: f64,
}

/// Mass and moments of inertia of a print about its centre of mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mass {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Moment of inertia about the axis, kg m².
    pub axial_kg_m2: f64,
    /// Moment of inertia about any diameter through the centre, kg m².
    pub transverse_kg_m2: f64,
}

impl Infill {
    /// Whether its walls leave room for a core in a coin of this shape.
    pub fn leaves_a_core(&self, shape: &Shape) -> bool {
        self.walls_m < shape.radius_m() && 2.0 * self.walls_m < shape.thickness_m()
    }
}

impl Shape {
    /// Mass and moments of inertia of a print of material of the density `density_kg_m3`; `None` prints
    /// it full.
    ///
    /// Two approximations: the core is the cylinder of radius R − w and height H − 2w, with w the
    /// walls' thickness, so it follows neither the edges nor the marks, around which a printer also lays
    /// walls; and the core's material is spread evenly, while real infill is a lattice. Both matter
    /// little while walls and the lattice's cells are small beside the coin.
    ///
    /// # Errors
    /// [`MassError::Density`] unless the density is positive and finite. [`MassError::Fraction`] unless
    /// the fraction is from 0 to 1. [`MassError::Walls`] if the core would not lie inside the coin:
    /// thin walls and a large edge, or marks deeper than the walls. [`MassError::DraftedInfill`] for infill
    /// inside a conical edge.
    ///
    /// # Example
    /// ```
    /// use coinmc_solid::{Edge, Infill, Shape};
    /// let shape = Shape::new(0.02, 0.02, Edge::Sharp)?;
    /// let full = shape.mass(1240.0, None)?;
    /// let light = shape.mass(1240.0, Some(Infill { walls_m: 8e-4, density_fraction: 0.15 }))?;
    /// // most of the mass is outside: the coin is lighter, but harder to turn for its mass
    /// assert!(light.mass_kg < full.mass_kg);
    /// assert!(light.axial_kg_m2 / light.mass_kg > full.axial_kg_m2 / full.mass_kg);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn mass(&self, density_kg_m3: f64, infill: Option<Infill>) -> Result<Mass, MassError> {
        if !(density_kg_m3 > 0.0 && density_kg_m3.is_finite()) {
            return Err(MassError::Density(density_kg_m3));
        }
        let mut moments = self.moments();
        if let Some(infill) = infill {
            if self.draft_deg() != 0.0 {
                return Err(MassError::DraftedInfill);
            }
            let core = self.core(infill)?;
            moments = moments - core.scaled(1.0 - infill.density_fraction);
        }
        let Moments {
            volume_m3,
            axial_m5,
            transverse_m5,
        } = moments;
        Ok(Mass {
            mass_kg: density_kg_m3 * volume_m3,
            axial_kg_m2: density_kg_m3 * axial_m5,
            transverse_kg_m2: density_kg_m3 * transverse_m5,
        })
    }

    /// The core inside the walls, as if it were full.
    fn core(&self, infill: Infill) -> Result<Moments, MassError> {
        let Infill {
            walls_m: found,
            density_fraction,
        } = infill;
        if !(0.0..=1.0).contains(&density_fraction) {
            return Err(MassError::Fraction(density_fraction));
        }
        let least = self.thinnest_walls_m();
        if found.is_nan() || found < least {
            return Err(MassError::Walls { found, least });
        }
        let radius = (self.radius_m() - found).max(0.0);
        Ok(Moments::cylinder(
            radius,
            (self.thickness_m() - 2.0 * found).max(0.0),
        ))
    }

    /// The thinnest walls whose core lies inside the coin, m.
    ///
    /// The core's corner is w away from face and side. A rounding of radius e passes the corner of the
    /// sharp coin at (1 − 1/√2)e from face and side, a chamfer of size e at e/2.
    fn thinnest_walls_m(&self) -> f64 {
        let corner = match self.edge() {
            Edge::Sharp => 0.0,
            Edge::Rounded { radius_m } => (1.0 - FRAC_1_SQRT_2) * radius_m,
            Edge::Chamfered { size_m } => size_m / 2.0,
        };
        self.marks()
            .map_or(corner, |marks| corner.max(marks.depth_m))
    }
}
