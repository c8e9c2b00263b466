//! Any coin that can be described has a good mesh.

use crate::common::error;
use coinmc_solid::{Edge, MIN_PART_M, Marks, Shape};
use proptest::prelude::*;
use std::collections::HashSet;

/// Sizes spread evenly over powers of ten.
fn size() -> impl Strategy<Value = f64> {
    (-3.9..-0.7_f64).prop_map(|power| libm::pow(10.0, power))
}

/// A share of a range of lengths.
fn between(least: f64, most: f64, share: f64) -> f64 {
    least + share * (most - least)
}

prop_compose! {
    fn plain()(diameter in size(), thickness in size(), kind in 0..4_usize, share in 0.001..0.999_f64,
        is_heads_wide: bool) -> Shape
    {
        if kind == 3 {
            let most = diameter / 2.0 - MIN_PART_M;
            let draft = libm::atan(between(1.001 * MIN_PART_M, most, share) / thickness).to_degrees();
            let draft = if is_heads_wide { draft } else { -draft };
            let sharp = Shape::new(diameter, thickness, Edge::Sharp).expect("a coin");
            return sharp.with_draft(draft).expect("a conical edge");
        }
        let most = diameter.min(thickness) / 2.0 - MIN_PART_M;
        let e = between(MIN_PART_M, most, share);
        let edge = [
            Edge::Sharp,
            Edge::Rounded { radius_m: e },
            Edge::Chamfered { size_m: e },
        ][kind];
        Shape::new(diameter, thickness, edge).expect("a coin")
    }
}

prop_compose! {
    fn coin()(plain in plain(), is_marked: bool, inner in 0.01..0.9_f64, outer in 0.1..0.99_f64,
        depth in 0.01..0.99_f64) -> Shape
    {
        let room = plain.face_radius_m() - 3.0 * MIN_PART_M;
        if !is_marked || room <= MIN_PART_M || plain.draft_deg() != 0.0 {
            return plain;
        }
        let inner_m = between(MIN_PART_M, MIN_PART_M + room, inner);
        let outer_m = between(inner_m + MIN_PART_M, plain.face_radius_m() - MIN_PART_M, outer);
        let depth_m = between(MIN_PART_M, plain.thickness_m() / 4.0, depth);
        plain.with_marks(Marks { inner_m, outer_m, depth_m }).expect("marks")
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn its_mesh_closes_and_has_its_moments(coin in coin()) {
        let mesh = coin.mesh(coin.chord_error_m()).expect("a mesh");
        prop_assert!(mesh.is_watertight());
        prop_assert!(error(mesh.volume_m3(), coin.volume_m3()) < 1e-3);
        let (inertia, exact) = (mesh.inertia_m5(), coin.moments());
        prop_assert!(error(inertia[2][2], exact.axial_m5) < 2e-3);
        prop_assert!(error(inertia[0][0], exact.transverse_m5) < 2e-3);
        prop_assert!(error(inertia[0][0], inertia[1][1]) < 1e-11);
        let size = coin.diameter_m().max(coin.thickness_m());
        for (x, expected) in mesh.centre_m().into_iter().zip([0.0, 0.0, coin.centre_m()]) {
            prop_assert!((x - expected).abs() < 1e-12 * size);
        }
    }

    /// Euler: V − E + F = 2 for a surface without handles, and three half edges to each triangle.
    #[test]
    fn its_mesh_is_one_surface_of_real_triangles(coin in coin()) {
        let mesh = coin.mesh(4.0 * coin.chord_error_m()).expect("a mesh");
        let places: HashSet<_> = mesh.vertices().iter().map(|v| v.map(f64::to_bits)).collect();
        prop_assert_eq!(places.len(), mesh.vertices().len());
        prop_assert_eq!(2 * mesh.vertices().len(), mesh.triangles().len() + 4);
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.map(|i| mesh.vertices()[i as usize]);
            let (p, q) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
            let twice_area: f64 = [(1, 2), (2, 0), (0, 1)]
                .map(|(i, j)| p[i] * q[j] - p[j] * q[i])
                .map(|x| x * x)
                .iter()
                .sum::<f64>()
                .sqrt();
            prop_assert!(twice_area > 0.0);
        }
    }

    /// Most coins fit the marks that are made for them.
    #[test]
    fn marks_fit_where_there_is_room(plain in plain()) {
        prop_assume!(plain.draft_deg() == 0.0);
        let is_roomy = plain.face_radius_m() > 5.0 * MIN_PART_M;
        prop_assert!(!is_roomy || plain.with_marks(Marks::fitting(&plain)).is_ok());
    }
}
