//! Triangle meshes: their integrals, and whether they close.

mod faces;
mod fineness;
mod grid;
mod integrals;
mod lathe;

pub use fineness::{MAX_TRIANGLES, MIN_CHORD_ERROR_M};
pub(crate) use integrals::cross;

use crate::error::MeshError;
use crate::shape::Shape;

/// A closed surface of triangles, seen counterclockwise from outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// A mesh whose surface is nowhere further than `chord_error_m` from the coin's.
    ///
    /// Circles become regular polygons of the circle's area, so that sharp and chamfered coins, with or
    /// without marks, keep their volume exactly. A rounding becomes the inscribed cones of an arc: its
    /// volume is short by an amount proportional to the chord error, within 0.1 % of the coin's at
    /// [`Shape::chord_error_m`]. However coarse, circles keep 48 corners.
    ///
    /// # Errors
    /// [`MeshError::ChordError`] unless the error is finite and at least [`MIN_CHORD_ERROR_M`];
    /// [`MeshError::TooFine`] if there would be more than [`MAX_TRIANGLES`].
    ///
    /// # Example
    /// ```
    /// use coinmc_solid::{Edge, Shape};
    /// let shape = Shape::new(0.02, 0.005, Edge::Rounded { radius_m: 0.001 })?;
    /// let mesh = shape.mesh(shape.chord_error_m())?;
    /// assert!(mesh.is_watertight());
    /// assert!((mesh.volume_m3() / shape.volume_m3() - 1.0).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn mesh(&self, chord_error_m: f64) -> Result<Mesh, MeshError> {
        let fineness = fineness::Fineness::of(self, chord_error_m)?;
        Ok(faces::mesh(self, fineness))
    }

    /// The chord error that files are written with unless another is asked for: 5 µm, or R/4000 for
    /// coins of a radius below 20 mm.
    pub const fn chord_error_m(&self) -> f64 {
        (self.radius_m() / 4000.0).min(5e-6)
    }
}

impl Mesh {
    /// The corners, m. No two of them are in the same place.
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    /// The triangles: three indices of vertices each, counterclockwise from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of every triangle, m.
    pub(crate) fn corners(&self) -> impl ExactSizeIterator<Item = [[f64; 3]; 3]> {
        let vertices = &self.vertices;
        self.triangles
            .iter()
            .map(move |t| t.map(|i| vertices[i as usize]))
    }

    /// Whether the surface closes: every edge of a triangle is, once and in the other direction, the
    /// edge of another one.
    pub fn is_watertight(&self) -> bool {
        let mut edges: Vec<(u32, u32)> = self
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
            .collect();
        edges.sort_unstable();
        let is_single = edges.windows(2).all(|pair| pair[0] != pair[1]);
        let is_paired = edges
            .iter()
            .all(|&(a, b)| a != b && edges.binary_search(&(b, a)).is_ok());
        !edges.is_empty() && is_single && is_paired
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box from its lowest corner.
    pub(super) fn cuboid(low: [f64; 3], size: [f64; 3]) -> Mesh {
        let corner = |k: u32| {
            let is_far = [k & 1, k >> 1 & 1, k >> 2].map(f64::from);
            [0, 1, 2].map(|i| low[i] + is_far[i] * size[i])
        };
        let quads: [[u32; 4]; 6] = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let triangles = quads
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect();
        Mesh {
            vertices: (0..8).map(corner).collect(),
            triangles,
        }
    }

    #[test]
    fn a_box_is_watertight_and_nothing_less() {
        let whole = cuboid([0.0; 3], [1.0; 3]);
        assert!(whole.is_watertight());
        for k in 0..whole.triangles.len() {
            let mut open = whole.clone();
            open.triangles.remove(k);
            assert!(!open.is_watertight(), "a hole");
            let mut turned = whole.clone();
            turned.triangles[k].swap(1, 2);
            assert!(!turned.is_watertight(), "a triangle inside out");
            let mut doubled = whole.clone();
            doubled.triangles.push(whole.triangles[k]);
            assert!(!doubled.is_watertight(), "the same triangle twice");
            let mut flat = whole.clone();
            flat.triangles.push([0, 0, 7]);
            assert!(!flat.is_watertight(), "a line there and back");
        }
        let none = Mesh {
            vertices: Vec::new(),
            triangles: Vec::new(),
        };
        assert!(!none.is_watertight());
    }
}
