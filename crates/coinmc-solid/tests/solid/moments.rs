//! Closed forms against other closed forms and against sums.

use crate::common::{coins, drafted, error};
use coinmc_solid::{Edge, Moments, Shape};
use std::f64::consts::PI;

fn coin(diameter: f64, thickness: f64, edge: Edge) -> Moments {
    Shape::new(diameter, thickness, edge)
        .expect("a coin")
        .moments()
}

#[test]
fn a_sharp_coin_has_the_moments_of_a_cylinder() {
    let Moments {
        volume_m3,
        axial_m5,
        transverse_m5,
    } = coin(0.2, 0.3, Edge::Sharp);
    assert!(error(volume_m3, PI * 0.01 * 0.3) < 1e-14);
    assert!(error(axial_m5, volume_m3 * 0.01 / 2.0) < 1e-14);
    assert!(error(transverse_m5, volume_m3 * (3.0 * 0.01 + 0.09) / 12.0) < 1e-14);
}

/// Pappus: a plane figure turned about an axis sweeps its area times the way of its centroid. A rounding
/// cuts off the corner square of side r but for a quarter disc, whose centroid is 4r/3π from its centre;
/// a chamfer a triangle with its centroid a third of the way.
#[test]
fn volumes_are_those_of_pappus() {
    let (radius, e) = (0.01_f64, 0.0013_f64);
    let cylinder = PI * radius * radius * 0.004;
    let inner = radius - e;
    let square = e * e * 2.0 * PI * (radius - e / 2.0);
    let disc = PI * e * e / 4.0 * 2.0 * PI * (inner + 4.0 * e / (3.0 * PI));
    let rounded = coin(0.02, 0.004, Edge::Rounded { radius_m: e });
    assert!(error(rounded.volume_m3, cylinder - 2.0 * (square - disc)) < 1e-13);
    let triangle = e * e / 2.0 * 2.0 * PI * (radius - e / 3.0);
    let chamfered = coin(0.02, 0.004, Edge::Chamfered { size_m: e });
    assert!(error(chamfered.volume_m3, cylinder - 2.0 * triangle) < 1e-13);
}

/// A rounding that leaves 10 µm of face and side is a ball but for that much: the ball's 2/5 m R² within
/// some 1e-4.
#[test]
fn a_coin_that_is_all_rounding_is_nearly_a_ball() {
    let Moments {
        volume_m3,
        axial_m5,
        transverse_m5,
    } = coin(
        0.2,
        0.2,
        Edge::Rounded {
            radius_m: 0.1 - 1e-5,
        },
    );
    assert!(error(volume_m3, 4.0 / 3.0 * PI * 1e-3) < 5e-4);
    assert!(error(axial_m5, 0.4 * volume_m3 * 0.01) < 5e-4);
    assert!(error(transverse_m5, axial_m5) < 5e-4);
}

/// Thin slices with their own radii, by the midpoint rule.
#[test]
fn moments_are_those_of_thin_slices() {
    let (radius, half, e) = (0.3, 0.2, 0.15);
    for edge in [Edge::Rounded { radius_m: e }, Edge::Chamfered { size_m: e }] {
        let (mut volume, mut axial, mut height) = (0.0, 0.0, 0.0);
        let slices = 400_000;
        let dz = 2.0 * half / f64::from(slices);
        for i in 0..slices {
            let z = -half + dz * (f64::from(i) + 0.5);
            let t = (z.abs() - (half - e)).max(0.0);
            let w = if edge == (Edge::Chamfered { size_m: e }) {
                e - t
            } else {
                (e * e - t * t).sqrt()
            };
            let rho: f64 = radius - e + w;
            volume += PI * rho * rho * dz;
            axial += PI / 2.0 * rho.powi(4) * dz;
            height += PI * z * z * rho * rho * dz;
        }
        let found = coin(2.0 * radius, 2.0 * half, edge);
        assert!(error(found.volume_m3, volume) < 1e-8, "{edge:?}");
        assert!(error(found.axial_m5, axial) < 1e-8, "{edge:?}");
        assert!(
            error(found.transverse_m5, axial / 2.0 + height) < 1e-8,
            "{edge:?}"
        );
    }
}

/// A cone of height H has its centre at H/4, I_a = 3/10 m R², I_t = 3/80 m (4R² + H²): a coin whose narrower
/// face is 10 µm wide is nearly one.
#[test]
fn a_pointed_coin_is_nearly_a_cone() {
    let (radius, height) = (0.1_f64, 0.2_f64);
    let draft = libm::atan((radius - 1.1e-5) / height).to_degrees();
    let coin =
        Shape::new(2.0 * radius, height, Edge::Sharp).and_then(|coin| coin.with_draft(draft));
    let coin = coin.expect("a coin");
    let Moments {
        volume_m3,
        axial_m5,
        transverse_m5,
    } = coin.moments();
    assert!(error(volume_m3, PI * radius * radius * height / 3.0) < 2e-4);
    assert!((coin.centre_m() / height - 0.25).abs() < 1e-4);
    assert!(error(axial_m5, 0.3 * volume_m3 * radius * radius) < 2e-4);
    let transverse = 3.0 / 80.0 * volume_m3 * (4.0 * radius * radius + height * height);
    assert!(error(transverse_m5, transverse) < 2e-4);
}

/// Thin slices of a conical edge, with their centre; turned over, it is on the other side.
#[test]
fn moments_of_a_conical_edge_are_those_of_thin_slices() {
    for draft in [8.0_f64, -20.0] {
        let coin = drafted(draft);
        let [heads, tails] = coin.face_radii_m();
        let (half, slices) = (coin.thickness_m() / 2.0, 100_000);
        let dz = 2.0 * half / f64::from(slices);
        let [mut volume, mut first, mut second, mut axial] = [0.0; 4];
        for i in 0..slices {
            let z = -half + dz * (f64::from(i) + 0.5);
            let rho = tails + (heads - tails) * (z + half) / (2.0 * half);
            volume += PI * rho * rho * dz;
            first += PI * z * rho * rho * dz;
            second += PI * z * z * rho * rho * dz;
            axial += PI / 2.0 * rho.powi(4) * dz;
        }
        let found = coin.moments();
        let transverse = axial / 2.0 + second - first * first / volume;
        assert!(error(found.volume_m3, volume) < 1e-8);
        assert!(error(found.axial_m5, axial) < 1e-8);
        assert!(error(found.transverse_m5, transverse) < 1e-8);
        assert!(error(coin.centre_m(), first / volume) < 1e-7);
        assert_eq!(coin.centre_m() > 0.0, draft > 0.0);
    }
}

/// All moments of a coin k times as large are k³ and k⁵ times as large.
#[test]
fn moments_scale() {
    for shape in coins() {
        let k = 3.0;
        let edge = match shape.edge() {
            Edge::Sharp => Edge::Sharp,
            Edge::Rounded { radius_m } => Edge::Rounded {
                radius_m: k * radius_m,
            },
            Edge::Chamfered { size_m } => Edge::Chamfered { size_m: k * size_m },
        };
        let mut large =
            Shape::new(k * shape.diameter_m(), k * shape.thickness_m(), edge).expect("a coin");
        if shape.draft_deg() != 0.0 {
            large = large.with_draft(shape.draft_deg()).expect("the same angle");
        }
        if let Some(mut marks) = shape.marks() {
            for length in [&mut marks.inner_m, &mut marks.outer_m, &mut marks.depth_m] {
                *length *= k;
            }
            large = large.with_marks(marks).expect("marks");
        }
        let centre = large.centre_m();
        let (small, large) = (shape.moments(), large.moments());
        let centres = [3.0 * shape.centre_m(), centre];
        assert!((centres[0] - centres[1]).abs() < 1e-17, "{centres:?}");
        assert!(error(large.volume_m3, 27.0 * small.volume_m3) < 1e-13);
        assert!(error(large.axial_m5, 243.0 * small.axial_m5) < 1e-13);
        assert!(error(large.transverse_m5, 243.0 * small.transverse_m5) < 1e-13);
    }
}
