//! Coins that several tests use.

use coinmc_solid::{Edge, Marks, Mesh, Shape};

/// One coin for every edge, of 20 mm by 6 mm, without and with marks, and two with a conical edge.
pub(crate) fn coins() -> Vec<Shape> {
    let edges = [
        Edge::Sharp,
        Edge::Rounded { radius_m: 0.002 },
        Edge::Chamfered { size_m: 0.0015 },
    ];
    edges
        .into_iter()
        .map(|edge| Shape::new(0.02, 0.006, edge).expect("a coin"))
        .flat_map(|plain| [plain, marked(plain)])
        .chain([8.0, -20.0].map(drafted))
        .collect()
}

/// A coin of 20 mm by 6 mm with this draft.
pub(crate) fn drafted(draft_deg: f64) -> Shape {
    Shape::new(0.02, 0.006, Edge::Sharp)
        .and_then(|plain| plain.with_draft(draft_deg))
        .expect("a coin with a conical edge")
}

/// The coin with marks that fit it.
pub(crate) fn marked(plain: Shape) -> Shape {
    plain
        .with_marks(Marks::fitting(&plain))
        .expect("room for marks")
}

/// The mesh that files are written with.
pub(crate) fn mesh(shape: &Shape) -> Mesh {
    shape.mesh(shape.chord_error_m()).expect("a mesh")
}

/// |found/expected − 1|
pub(crate) fn error(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}
