//! Binary STL.
//!
//! 80 bytes of free text, the number of triangles, and for each its normal, three corners and two
//! bytes of no meaning; all numbers in little endian, coordinates in single precision. The format has
//! no unit: slicers take millimetres. (3D Systems, "Stereolithography Interface Specification".)

use crate::mesh::{Mesh, cross};
use std::io::{self, Write};

/// The free text. It must not begin with `solid`, which marks the format's text form.
const HEADER: &[u8; 80] =
    b"coinmc; lengths in millimetres, heads towards +z                                ";

/// Writes a mesh as binary STL, in millimetres. The same mesh gives the same bytes.
///
/// # Errors
/// Those of `out`.
///
/// # Example
/// ```
/// use coinmc_solid::{Edge, Shape, write_stl};
/// let shape = Shape::new(0.02, 0.002, Edge::Sharp)?;
/// let mesh = shape.mesh(shape.chord_error_m())?;
/// let mut file = Vec::new();
/// write_stl(&mesh, &mut file)?;
/// assert_eq!(file.len(), 84 + 50 * mesh.triangles().len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_stl(mesh: &Mesh, mut out: impl Write) -> io::Result<()> {
    let count = u32::try_from(mesh.triangles().len()).map_err(io::Error::other)?;
    out.write_all(HEADER)?;
    out.write_all(&count.to_le_bytes())?;
    for corners in mesh.corners() {
        out.write_all(&facet(corners))?;
    }
    out.flush()
}

/// A triangle's 50 bytes.
fn facet(corners: [[f64; 3]; 3]) -> [u8; 50] {
    let vectors = [normal(corners).map(single)]
        .into_iter()
        .chain(corners.map(millimetres));
    let mut bytes = [0; 50];
    for (place, number) in bytes.chunks_exact_mut(4).zip(vectors.flatten()) {
        place.copy_from_slice(&number.to_le_bytes());
    }
    bytes
}

/// The unit vector out of the solid.
fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let side = |end: [f64; 3]| [end[0] - a[0], end[1] - a[1], end[2] - a[2]];
    let normal = cross(side(b), side(c));
    let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
    // without the sign of a negative zero
    normal.map(|x| x / length + 0.0)
}

/// A place in a file's unit and precision.
pub(crate) fn millimetres(place_m: [f64; 3]) -> [f32; 3] {
    place_m.map(|x| single(1e3 * x))
}

/// To the nearest number of single precision, the one that printers' formats have.
#[expect(clippy::cast_possible_truncation)]
fn single(x: f64) -> f32 {
    x as f32
}
