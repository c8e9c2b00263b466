//! Meshes against closed forms.

use crate::common::{coins, error, mesh};
use coinmc_solid::{Edge, Mesh, Moments, Shape};

/// Relative errors of volume, axial and both transverse moments.
fn errors(shape: &Shape, mesh: &Mesh) -> [f64; 4] {
    let Moments {
        volume_m3,
        axial_m5,
        transverse_m5,
    } = shape.moments();
    let inertia = mesh.inertia_m5();
    [
        error(mesh.volume_m3(), volume_m3),
        error(inertia[2][2], axial_m5),
        error(inertia[0][0], transverse_m5),
        error(inertia[1][1], transverse_m5),
    ]
}

#[test]
fn meshes_have_the_moments_of_the_coin() {
    for shape in coins() {
        let mesh = mesh(&shape);
        assert!(mesh.is_watertight());
        for error in errors(&shape, &mesh) {
            assert!(error < 1e-3, "{shape:?}: {error}");
        }
    }
}

/// Polygons of the circles' area: their volume is exact however coarse they are, and their second moments
/// are off by ψ⁴/180, with ψ = 2π/48 here.
#[test]
fn coarse_meshes_of_straight_outlines_keep_the_volume() {
    for shape in coins() {
        if matches!(shape.edge(), Edge::Rounded { .. }) {
            continue;
        }
        let [volume, axial, ..] = errors(&shape, &shape.mesh(1.0).expect("a mesh"));
        assert!(volume < 1e-13, "{shape:?}: {volume}");
        assert!(
            (0.9..1.1).contains(&(axial / 1.63e-6)),
            "{shape:?}: {axial}"
        );
    }
}

/// Errors are of the second order in the steps, so proportional to the chord error: a quarter of it
/// halves the steps and leaves a quarter of every error.
#[test]
fn errors_follow_the_chord_error() {
    for shape in coins() {
        if !matches!(shape.edge(), Edge::Rounded { .. }) {
            continue;
        }
        let at = |chord_error: f64| errors(&shape, &shape.mesh(chord_error).expect("a mesh"));
        let (coarse, fine) = (at(1.6e-6), at(1e-7));
        for (coarse, fine) in coarse.into_iter().zip(fine) {
            assert!((13.0..20.0).contains(&(coarse / fine)), "{coarse} {fine}");
        }
    }
}

/// The distance to the surface of a coin with rounded edges and no marks: that of the cylinder inside
/// to every point, less r.
fn distance(shape: &Shape, [x, y, z]: [f64; 3]) -> f64 {
    let r = shape.edge().size_m();
    let outwards = (x * x + y * y).sqrt() - (shape.radius_m() - r);
    let upwards = z.abs() - (shape.thickness_m() / 2.0 - r);
    let outside = (outwards.max(0.0).powi(2) + upwards.max(0.0).powi(2)).sqrt();
    outside + outwards.max(upwards).min(0.0) - r
}

#[test]
fn the_surface_is_within_the_chord_error() {
    let rounded = |r: f64| Shape::new(0.02, 0.01, Edge::Rounded { radius_m: r }).expect("a coin");
    for (shape, chord_error) in [
        (rounded(0.004), 1e-5),
        (rounded(0.0005), 5e-6),
        (rounded(0.0049), 2e-6),
    ] {
        let mesh = shape.mesh(chord_error).expect("a mesh");
        let mut worst: f64 = 0.0;
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.map(|i| mesh.vertices()[i as usize]);
            for (u, v) in [
                (0.0, 0.0),
                (0.5, 0.0),
                (0.0, 0.5),
                (0.5, 0.5),
                (0.25, 0.25),
                (0.33, 0.33),
            ] {
                let point = [0, 1, 2].map(|i| a[i] + u * (b[i] - a[i]) + v * (c[i] - a[i]));
                worst = worst.max(distance(&shape, point).abs());
            }
        }
        assert!(
            worst < chord_error && worst > 0.5 * chord_error,
            "{worst} {chord_error}"
        );
    }
}

/// Faces are flat and sides straight to the bit, and the mesh is the same after a quarter turn.
#[test]
fn meshes_are_symmetric() {
    for shape in coins() {
        let mesh = mesh(&shape);
        let half = shape.thickness_m() / 2.0;
        let most = mesh.vertices().iter().map(|v| v[2]).fold(0.0, f64::max);
        assert_eq!(most, half);
        if shape.marks().is_some() {
            continue;
        }
        let mut places: Vec<_> = mesh
            .vertices()
            .iter()
            .map(|v| v.map(f64::to_bits))
            .collect();
        let turned = |[x, y, z]: &[f64; 3]| [0.0 - y, *x, *z].map(f64::to_bits);
        let mut turned: Vec<_> = mesh.vertices().iter().map(turned).collect();
        places.sort_unstable();
        turned.sort_unstable();
        assert_eq!(places, turned);
    }
}
