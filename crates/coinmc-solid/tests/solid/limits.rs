//! What is not a coin, or not a mesh.

use crate::common::marked;
use coinmc_solid::{Edge, Infill, MAX_TRIANGLES, Marks, MassError, MeshError, Shape, ShapeError};

const NOT_SIZES: [f64; 6] = [0.0, -0.01, 0.9e-4, 1.1, f64::NAN, f64::INFINITY];

#[test]
fn sizes_have_bounds() {
    for bad in NOT_SIZES {
        let wide = Shape::new(bad, 0.002, Edge::Sharp);
        assert!(
            matches!(
                wide,
                Err(ShapeError::Size {
                    what: "diameter",
                    ..
                })
            ),
            "{bad}"
        );
        let thick = Shape::new(0.02, bad, Edge::Sharp);
        assert!(
            matches!(
                thick,
                Err(ShapeError::Size {
                    what: "thickness",
                    ..
                })
            ),
            "{bad}"
        );
    }
    assert!(Shape::new(1e-4, 1.0, Edge::Sharp).is_ok());
    assert!(Shape::new(1.0, 1e-4, Edge::Sharp).is_ok());
}

#[test]
fn edges_leave_face_and_side() {
    let kinds = [
        |radius_m: f64| Edge::Rounded { radius_m },
        |size_m: f64| Edge::Chamfered { size_m },
    ];
    for kind in kinds {
        for bad in [
            0.0,
            -1e-3,
            0.9e-5,
            0.001,
            0.000_995,
            f64::NAN,
            f64::INFINITY,
        ] {
            for (diameter, thickness) in [(0.02, 0.002), (0.002, 0.02)] {
                let shape = Shape::new(diameter, thickness, kind(bad));
                assert!(matches!(shape, Err(ShapeError::Edge { .. })), "{bad}");
            }
        }
        assert!(Shape::new(0.02, 0.002, kind(0.000_98)).is_ok());
        assert!(Shape::new(0.02, 0.002, kind(1.1e-5)).is_ok());
    }
}

#[test]
fn marks_stay_on_the_face_and_shallow() {
    let plain = Shape::new(0.02, 0.004, Edge::Rounded { radius_m: 0.001 }).expect("a coin");
    let good = Marks {
        inner_m: 0.003,
        outer_m: 0.006,
        depth_m: 0.0005,
    };
    assert_eq!(
        plain.with_marks(good).map(|coin| coin.marks()),
        Ok(Some(good))
    );
    for depth_m in [0.0, -1e-4, 0.9e-5, 0.001, f64::NAN, f64::INFINITY] {
        let coin = plain.with_marks(Marks { depth_m, ..good });
        assert!(
            matches!(coin, Err(ShapeError::MarkDepth { .. })),
            "{depth_m}"
        );
    }
    for (inner_m, outer_m) in [
        (0.0, 0.006),
        (-0.001, 0.006),
        (0.006, 0.006),
        (0.006, 0.003),
        (0.003, 0.009),
        (0.003, 0.2),
        (f64::NAN, 0.006),
        (0.003, f64::NAN),
        (0.003, f64::INFINITY),
    ] {
        let coin = plain.with_marks(Marks {
            inner_m,
            outer_m,
            ..good
        });
        assert!(
            matches!(coin, Err(ShapeError::MarkRadii { .. })),
            "{inner_m} {outer_m}"
        );
    }
}

#[test]
fn a_face_without_room_takes_no_marks() {
    let plain = Shape::new(0.002, 0.004, Edge::Chamfered { size_m: 0.00098 }).expect("a coin");
    let coin = plain.with_marks(Marks::fitting(&plain));
    assert!(matches!(coin, Err(ShapeError::MarkRadii { .. })));
}

#[test]
fn chord_errors_have_bounds() {
    let shape = Shape::new(0.02, 0.002, Edge::Sharp).expect("a coin");
    for bad in [0.0, -1e-6, 0.9e-8, f64::NAN, f64::INFINITY] {
        assert!(
            matches!(shape.mesh(bad), Err(MeshError::ChordError { .. })),
            "{bad}"
        );
    }
    assert!(shape.mesh(1e-8).is_ok());
}

/// The mesh that files are written with exists even for the coin that takes most triangles.
#[test]
fn meshes_have_a_bound() {
    let ball = Edge::Rounded { radius_m: 0.49 };
    let coin = marked(Shape::new(1.0, 1.0, ball).expect("a coin"));
    let mesh = coin.mesh(coin.chord_error_m()).expect("a mesh");
    let count = mesh.triangles().len() as u64;
    assert!(
        count > MAX_TRIANGLES / 2 && count <= MAX_TRIANGLES,
        "{count}"
    );
    // half of the chord error doubles the number
    let Err(MeshError::TooFine { triangles, most }) = coin.mesh(2.5e-6) else {
        panic!("more triangles than may be");
    };
    assert_eq!(most, MAX_TRIANGLES);
    assert!(
        (1.95..2.05).contains(&(triangles as f64 / count as f64)),
        "{triangles} {count}"
    );
}

#[test]
fn messages_name_the_bound() {
    let error = Shape::new(2.0, 0.002, Edge::Sharp).expect_err("too wide");
    assert_eq!(
        error.to_string(),
        "diameter must be from 0.0001 m to 1 m, not 2 m"
    );
}

/// A draft leaves a narrower face, and keeps sharp rims, no marks and no infill.
#[test]
fn a_conical_edge_leaves_a_face_and_nothing_that_moves_the_centre() {
    let plain = Shape::new(0.02, 0.01, Edge::Sharp).expect("a coin");
    assert_eq!(plain.with_draft(0.0), Ok(plain));
    for bad in [1e-3, 45.0, -45.0, 60.0, 91.0, f64::NAN, f64::INFINITY] {
        let coin = plain.with_draft(bad);
        assert!(matches!(coin, Err(ShapeError::Draft { .. })), "{bad}");
    }
    let conical = plain.with_draft(44.9).expect("a coin");
    let marks = Marks::fitting(&plain);
    assert_eq!(conical.with_marks(marks), Err(ShapeError::DraftedMarks));
    let drafted = |coin: Shape| coin.with_draft(5.0);
    assert_eq!(drafted(marked(plain)), Err(ShapeError::DraftedMarks));
    let rounded = Shape::new(0.02, 0.01, Edge::Rounded { radius_m: 1e-3 }).expect("a coin");
    assert_eq!(drafted(rounded), Err(ShapeError::DraftedEdge));
    let infill = Infill {
        walls_m: 1e-3,
        density_fraction: 0.2,
    };
    let mass = conical.mass(1000.0, Some(infill));
    assert_eq!(mass, Err(MassError::DraftedInfill));
}
