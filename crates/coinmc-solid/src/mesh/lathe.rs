//! Surfaces between circles around the axis.
//!
//! The outline of the coin is a path that begins on the axis at the top, goes out to the rim, down the
//! side and back to the axis at the bottom: the solid is on its right. Every part of it is turned about
//! the axis, from row to row of vertices, into a band whose normals point away from the solid.

use super::Mesh;
use super::grid::Grid;

/// Vertices side by side in the direction of growing φ; a full circle ends with its first one.
pub(super) type Row = Vec<u32>;

/// A mesh in the making.
pub(super) struct Lathe {
    grid: Grid,
    mesh: Mesh,
}

impl Lathe {
    /// Nothing yet, with circles of so many corners and room for so many triangles.
    pub(super) fn new(corners: u32, triangles: u64) -> Self {
        let room = usize::try_from(triangles).expect("at most MAX_TRIANGLES");
        Self {
            grid: Grid::new(corners),
            // a closed surface without holes has half as many vertices, and two
            mesh: Mesh {
                vertices: Vec::with_capacity(room / 2 + 2),
                triangles: Vec::with_capacity(room),
            },
        }
    }

    /// What was made.
    pub(super) fn finish(self) -> Mesh {
        self.mesh
    }

    /// The number of corners of a circle.
    pub(super) fn corners(&self) -> usize {
        self.grid.len()
    }

    fn vertex(&mut self, place: [f64; 3]) -> u32 {
        let index = u32::try_from(self.mesh.vertices.len()).expect("at most MAX_TRIANGLES");
        self.mesh.vertices.push(place);
        index
    }

    /// A vertex on the axis.
    pub(super) fn centre(&mut self, z: f64) -> u32 {
        self.vertex([0.0, 0.0, z])
    }

    /// A circle.
    pub(super) fn circle(&mut self, rho: f64, z: f64) -> Row {
        let mut row = self.arc(0, self.corners() - 1, rho, z);
        row.push(row[0]);
        row
    }

    /// The corners from `first` to `last`.
    pub(super) fn arc(&mut self, first: usize, last: usize, rho: f64, z: f64) -> Row {
        (first..=last)
            .map(|k| self.vertex(self.grid.at(k, rho, z)))
            .collect()
    }

    /// The band from a row to the next one of the outline.
    pub(super) fn band(&mut self, from: &[u32], to: &[u32]) {
        for (a, b) in from.windows(2).zip(to.windows(2)) {
            self.quad([a[0], b[0], b[1], a[1]]);
        }
    }

    /// The part of the outline from the axis to a circle.
    pub(super) fn fan_out(&mut self, centre: u32, to: &[u32]) {
        self.mesh
            .triangles
            .extend(to.windows(2).map(|b| [centre, b[0], b[1]]));
    }

    /// The part of the outline from a circle to the axis.
    pub(super) fn fan_in(&mut self, from: &[u32], centre: u32) {
        self.mesh
            .triangles
            .extend(from.windows(2).map(|a| [a[0], centre, a[1]]));
    }

    /// A flat piece with four corners, counterclockwise from outside.
    pub(super) fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
}
