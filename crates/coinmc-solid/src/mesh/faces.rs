//! The coin's surface along its outline: heads, edge, side, edge, tails.

use super::Mesh;
use super::fineness::Fineness;
use super::lathe::{Lathe, Row};
use crate::marks::Marks;
use crate::shape::{Edge, Shape};
use std::f64::consts::FRAC_PI_2;

/// The mesh of a shape.
pub(super) fn mesh(shape: &Shape, fineness: Fineness) -> Mesh {
    let mut lathe = Lathe::new(fineness.around, fineness.triangles(shape));
    let rows: Vec<Row> = outline(shape, fineness.edge)
        .into_iter()
        .map(|[rho, z]| lathe.circle(rho, z))
        .collect();
    for pair in rows.windows(2) {
        lathe.band(&pair[0], &pair[1]);
    }
    let (top, bottom) = (&rows[0], &rows[rows.len() - 1]);
    let half = shape.thickness_m() / 2.0;
    let (heads, tails) = (lathe.centre(half), lathe.centre(-half));
    if let Some(marks) = shape.marks() {
        let (inner, outer, floor) = (marks.inner_m, marks.outer_m, half - marks.depth_m);
        let [inner_row, outer_row] = ring(&mut lathe, Marks::HEADS, [inner, outer], [half, floor]);
        lathe.fan_out(heads, &inner_row);
        lathe.band(&outer_row, top);
        // inwards, as the outline runs at the bottom
        let [outer_row, inner_row] =
            ring(&mut lathe, Marks::TAILS, [outer, inner], [-half, -floor]);
        lathe.band(bottom, &outer_row);
        lathe.fan_in(&inner_row, tails);
    } else {
        lathe.fan_out(heads, top);
        lathe.fan_in(bottom, tails);
    }
    lathe.finish()
}

/// Radius and height of the circles from the face of heads to that of tails.
fn outline(shape: &Shape, steps: u32) -> Vec<[f64; 2]> {
    if shape.draft_deg() != 0.0 {
        let half = shape.thickness_m() / 2.0;
        let [heads, tails] = shape.face_radii_m();
        return vec![[heads, half], [tails, -half]];
    }
    let upper = upper_edge(shape, steps);
    let lower = upper.iter().rev().map(|&[rho, z]| [rho, -z]);
    upper.iter().copied().chain(lower).collect()
}

/// The circles of the upper edge, from face to side.
fn upper_edge(shape: &Shape, steps: u32) -> Vec<[f64; 2]> {
    let (radius, half) = (shape.radius_m(), shape.thickness_m() / 2.0);
    let size = shape.edge().size_m();
    let (rho, z) = (radius - size, half - size);
    match shape.edge() {
        Edge::Sharp => vec![[radius, half]],
        Edge::Chamfered { .. } => vec![[rho, half], [radius, z]],
        Edge::Rounded { .. } => {
            let angle = |k: u32| FRAC_PI_2 * f64::from(k) / f64::from(steps);
            let inside = (1..steps).map(|k| {
                [
                    rho + size * libm::sin(angle(k)),
                    z + size * libm::cos(angle(k)),
                ]
            });
            // the ends exactly: faces and sides are flat to the bit
            [[rho, half]]
                .into_iter()
                .chain(inside)
                .chain([[radius, z]])
                .collect()
        }
    }
}

/// The part of a face from one radius to another, of which `n` recesses take half, with the heights of
/// the face and of their floors. Returns its first and its last circle.
///
/// The recess number i begins at the angle 2πi/n and ends at 2π(i + 1/2)/n.
fn ring(
    lathe: &mut Lathe,
    n: u32,
    [from_rho, to_rho]: [f64; 2],
    [face_z, floor_z]: [f64; 2],
) -> [Row; 2] {
    let from = lathe.circle(from_rho, face_z);
    let to = lathe.circle(to_rho, face_z);
    let period = lathe.corners() / n as usize;
    for start in (0..lathe.corners()).step_by(period) {
        let (end, next) = (start + period / 2, start + period);
        let (down, up) = (&from[start..=end], &to[start..=end]);
        let foot = lathe.arc(start, end, from_rho, floor_z);
        let rise = lathe.arc(start, end, to_rho, floor_z);
        lathe.band(down, &foot);
        lathe.band(&foot, &rise);
        lathe.band(&rise, up);
        // the end walls look into the recess
        let last = period / 2;
        lathe.quad([down[0], up[0], rise[0], foot[0]]);
        lathe.quad([down[last], foot[last], rise[last], up[last]]);
        lathe.band(&from[end..=next], &to[end..=next]);
    }
    [from, to]
}
