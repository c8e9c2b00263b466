//! Marks change neither the centre nor the symmetry.

use crate::common::{error, marked, mesh};
use coinmc_solid::{Edge, Marks, Mesh, Moments, Shape};
use std::f64::consts::PI;

fn coin() -> Shape {
    marked(Shape::new(0.02, 0.006, Edge::Sharp).expect("a coin"))
}

/// Each face loses half of a ring of the area π(r2² − r1²), to the depth d.
#[test]
fn recesses_take_half_of_a_ring_from_each_face() {
    let marked = coin();
    let Marks {
        inner_m: r1,
        outer_m: r2,
        depth_m: d,
    } = marked.marks().expect("marks");
    let cylinder = PI * 1e-4 * 0.006;
    let lost = 2.0 * d * PI * (r2 * r2 - r1 * r1) / 2.0;
    assert!(lost > 0.04 * cylinder);
    assert!(error(marked.volume_m3(), cylinder - lost) < 1e-14);
}

/// Sums over a fine polar grid of the recesses: nothing of the closed forms.
#[test]
fn closed_forms_are_those_of_small_pieces() {
    let marked = coin();
    let Marks {
        inner_m,
        outer_m,
        depth_m,
    } = marked.marks().expect("marks");
    let (mut axial, mut xx, mut yy) = (0.0, 0.0, 0.0);
    let (radii, angles, heights) = (300, 360, 30);
    for (n, side) in [(Marks::HEADS, 1.0), (Marks::TAILS, -1.0)] {
        for k in (0..angles).filter(|k| (2 * k * n / angles) % 2 == 0) {
            let phi = 2.0 * PI * (f64::from(k) + 0.5) / f64::from(angles);
            let (cos, sin) = (libm::cos(phi), libm::sin(phi));
            for i in 0..radii {
                let rho = inner_m + (outer_m - inner_m) * (f64::from(i) + 0.5) / f64::from(radii);
                for j in 0..heights {
                    let z = side * (0.003 - depth_m * (f64::from(j) + 0.5) / f64::from(heights));
                    let piece = rho * (2.0 * PI / f64::from(angles)) * (outer_m - inner_m)
                        / f64::from(radii)
                        * depth_m
                        / f64::from(heights);
                    axial += piece * rho * rho;
                    xx += piece * (rho * rho * sin * sin + z * z);
                    yy += piece * (rho * rho * cos * cos + z * z);
                }
            }
        }
    }
    let plain = Shape::new(0.02, 0.006, Edge::Sharp)
        .expect("a coin")
        .moments();
    let Moments {
        axial_m5,
        transverse_m5,
        ..
    } = marked.moments();
    assert!(error(plain.axial_m5 - axial_m5, axial) < 1e-5);
    for transverse in [xx, yy] {
        assert!(error(plain.transverse_m5 - transverse_m5, transverse) < 1e-5);
    }
}

/// The mesh's integrals know nothing of the proof.
#[test]
fn the_centre_stays_and_the_axis_is_a_principal_one() {
    let mesh = mesh(&coin());
    for x in mesh.centre_m() {
        assert!(x.abs() < 1e-16, "{x} m");
    }
    let inertia = mesh.inertia_m5();
    assert!(error(inertia[0][0], inertia[1][1]) < 1e-13);
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        assert!(inertia[i][j].abs() < 1e-13 * inertia[2][2], "{i} {j}");
    }
}

/// Floors of recesses: triangles below the upper face, and above the lower one, that look outwards.
fn recesses(mesh: &Mesh, floor_z: f64) -> usize {
    let is_floor = |t: &&[u32; 3]| {
        t.iter()
            .all(|&i| (mesh.vertices()[i as usize][2] - floor_z).abs() < 1e-12)
    };
    let angles: Vec<f64> = mesh
        .triangles()
        .iter()
        .filter(is_floor)
        .map(|t| {
            let [x, y] = [0, 1].map(|i| {
                t.map(|k| mesh.vertices()[k as usize][i])
                    .iter()
                    .sum::<f64>()
            });
            libm::atan2(y, x).rem_euclid(2.0 * PI)
        })
        .collect();
    let mut sorted = angles.clone();
    sorted.sort_by(f64::total_cmp);
    sorted
        .windows(2)
        .filter(|pair| pair[1] - pair[0] > 0.2)
        .count()
        + 1
}

#[test]
fn heads_has_three_recesses_and_tails_six() {
    let coin = coin();
    let floor = 0.003 - coin.marks().expect("marks").depth_m;
    assert_eq!(recesses(&mesh(&coin), floor), 3);
    assert_eq!(recesses(&mesh(&coin), -floor), 6);
}
