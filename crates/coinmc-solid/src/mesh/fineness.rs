//! How many corners circles and arcs need, and how many triangles this makes.

use crate::error::MeshError;
use crate::marks::Marks;
use crate::shape::{Edge, Shape};
use std::f64::consts::{FRAC_PI_2, PI};

/// The most triangles of a mesh: an STL file of 50 MB.
pub const MAX_TRIANGLES: u64 = 1_000_000;
/// The smallest chord error, m: the steps of the smallest arc still differ in the single precision of
/// STL files.
pub const MIN_CHORD_ERROR_M: f64 = 1e-8;

/// Circles have a multiple of this many corners: recesses of both faces begin and end at one, and so do
/// quarters.
const CORNERS: f64 = 12.0;
/// The fewest corners of a circle: four to a recess on tails.
const LEAST_CORNERS: f64 = 48.0;

/// Steps around the axis, and along the arc of a rounded edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fineness {
    /// Corners of every circle.
    pub(super) around: u32,
    /// Steps from face to side; 1 for a chamfer, 0 for a sharp edge.
    pub(super) edge: u32,
}

impl Fineness {
    /// What keeps within the chord error.
    pub(super) fn of(shape: &Shape, chord_error_m: f64) -> Result<Self, MeshError> {
        let least = MIN_CHORD_ERROR_M;
        if !(chord_error_m >= least && chord_error_m.is_finite()) {
            return Err(MeshError::ChordError {
                found: chord_error_m,
                least,
            });
        }
        // the middles of a polygon's sides are up to a third of the chord error inside (see `Grid`), which
        // leaves two thirds to the arcs
        let around = 2.0 * PI / step(shape.radius_m(), chord_error_m);
        let arc_error_m = 2.0 / 3.0 * chord_error_m;
        let edge = match shape.edge() {
            Edge::Sharp => 0.0,
            Edge::Chamfered { .. } => 1.0,
            Edge::Rounded { radius_m } => (FRAC_PI_2 / step(radius_m, arc_error_m)).ceil(),
        };
        let around = ((around / CORNERS).ceil() * CORNERS).max(LEAST_CORNERS);
        // both are below 1e5: radii are at most 0.5 m, and chord errors at least 1e-8 m
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let fineness = Self {
            around: around as u32,
            edge: edge as u32,
        };
        fineness.checked(shape)
    }

    fn checked(self, shape: &Shape) -> Result<Self, MeshError> {
        let (triangles, most) = (self.triangles(shape), MAX_TRIANGLES);
        if triangles > most {
            return Err(MeshError::TooFine { triangles, most });
        }
        Ok(self)
    }

    /// The number of triangles of the mesh.
    ///
    /// The side has a band of 2N for its cylinder and for each step of both edges. A plain face is a fan
    /// of N. Marks split it into a fan and two bands, 5N, add walls at both radii along half of the
    /// circle, 2N, and two end walls of two triangles to each recess.
    pub(super) fn triangles(self, shape: &Shape) -> u64 {
        let (around, edge) = (u64::from(self.around), u64::from(self.edge));
        let side = 2 * around * (1 + 2 * edge);
        let faces = match shape.marks() {
            None => 2 * around,
            Some(_) => 14 * around + 4 * u64::from(Marks::HEADS + Marks::TAILS),
        };
        side + faces
    }
}

/// The angle whose chord in a circle is within `chord_error_m` of the arc, at most a third of a turn:
/// the arc rises by r(1 − cos(ψ/2)) = 2r sin²(ψ/4) above its chord.
fn step(radius_m: f64, chord_error_m: f64) -> f64 {
    4.0 * libm::asin((chord_error_m / (2.0 * radius_m)).sqrt().min(0.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_triangles_is_that_of_the_mesh() {
        let sizes = [
            Edge::Sharp,
            Edge::Rounded { radius_m: 1e-3 },
            Edge::Chamfered { size_m: 1e-3 },
        ];
        for edge in sizes {
            let plain = Shape::new(0.02, 0.006, edge).expect("a coin");
            let marked = plain.with_marks(Marks::fitting(&plain)).expect("marks");
            for shape in [plain, marked] {
                let fineness = Fineness::of(&shape, 1e-5).expect("a fineness");
                let mesh = shape.mesh(1e-5).expect("a mesh");
                assert_eq!(fineness.triangles(&shape), mesh.triangles().len() as u64);
            }
        }
    }

    /// The arc over a chord of the angle ψ rises by r(1 − cos(ψ/2)).
    #[test]
    fn a_step_rises_by_the_chord_error() {
        for (radius, error) in [(0.01, 1e-6), (0.01, 1e-3), (0.5, 1e-8)] {
            let rise = radius * (1.0 - libm::cos(step(radius, error) / 2.0));
            assert!((rise / error - 1.0).abs() < 1e-6, "{radius} {error}");
        }
        assert!((step(0.001, 1.0) - 2.0 * PI / 3.0).abs() < 1e-15);
    }
}
