//! OpenSCAD source: the shape as a program with named measures, for people who want to change it.

use crate::marks::Marks;
use crate::shape::{Edge, Shape};
use std::io::{self, Write};

/// What follows the measures.
const PROGRAM: &str = include_str!("coin.scad");

/// Writes the coin as OpenSCAD source, in millimetres. The same shape gives the same bytes.
///
/// Its measures are variables at the top. OpenSCAD puts the corners of its polygons on the circles, which
/// makes the coin lighter by 0.02 % with the 180 corners written here: for a mesh of the circles' area
/// use the other formats.
///
/// # Errors
/// Those of `out`.
///
/// # Example
/// ```
/// use coinmc_solid::{Edge, Shape, write_openscad};
/// let mut file = Vec::new();
/// write_openscad(&Shape::new(0.02, 0.002, Edge::Rounded { radius_m: 3e-4 })?, &mut file)?;
/// assert!(String::from_utf8(file)?.contains("\nedge_size = 0.3;"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_openscad(shape: &Shape, mut out: impl Write) -> io::Result<()> {
    let edge = match shape.edge() {
        Edge::Sharp => "sharp",
        Edge::Rounded { .. } => "rounded",
        Edge::Chamfered { .. } => "chamfered",
    };
    let marks = shape.marks().unwrap_or_else(|| Marks::fitting(shape));
    write!(
        out,
        "// A thick coin, written by coinmc. Lengths in millimetres; heads towards +z.

diameter = {diameter};
thickness = {thickness};
edge = \"{edge}\"; // \"sharp\", \"rounded\" or \"chamfered\"
edge_size = {size}; // radius of the rounding, or what the chamfer takes of face and side
draft = {draft}; // degrees between side and axis, of sharp edges; above 0 heads is the wider face
marks = {is_marked}; // {heads} recesses on heads, {tails} on tails, half of the ring each
mark_inner = {inner}; // radii of the ring
mark_outer = {outer};
mark_depth = {depth};
heads = {heads};
tails = {tails};
$fn = 180; // corners of a circle
{PROGRAM}",
        diameter = millimetres(shape.diameter_m()),
        thickness = millimetres(shape.thickness_m()),
        size = millimetres(shape.edge().size_m()),
        draft = shape.draft_deg(),
        is_marked = shape.marks().is_some(),
        inner = millimetres(marks.inner_m),
        outer = millimetres(marks.outer_m),
        depth = millimetres(marks.depth_m),
        heads = Marks::HEADS,
        tails = Marks::TAILS,
    )?;
    out.flush()
}

/// Millimetres to the nearest picometre, so that 0.0003 m is 0.3 and not 0.29999999999999999.
fn millimetres(length_m: f64) -> f64 {
    (length_m * 1e12).round() / 1e9
}
