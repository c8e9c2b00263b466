//! Mass of prints.

use crate::common::{coins, error};
use coinmc_solid::{Edge, Infill, Mass, MassError, Shape};

const PLA: f64 = 1240.0;

/// A conical edge allows no infill.
fn fillable() -> impl Iterator<Item = Shape> {
    coins().into_iter().filter(|coin| coin.draft_deg() == 0.0)
}

fn print(shape: &Shape, walls_m: f64, density_fraction: f64) -> Result<Mass, MassError> {
    let infill = Infill {
        walls_m,
        density_fraction,
    };
    shape.mass(PLA, Some(infill))
}

#[test]
fn a_full_print_has_the_moments_of_the_solid() {
    for shape in fillable() {
        let (moments, mass) = (shape.moments(), shape.mass(PLA, None).expect("a mass"));
        assert!(error(mass.mass_kg, PLA * moments.volume_m3) < 1e-15);
        assert!(error(mass.axial_kg_m2, PLA * moments.axial_m5) < 1e-15);
        assert!(error(mass.transverse_kg_m2, PLA * moments.transverse_m5) < 1e-15);
        // a core of full density, or no core, is the same
        assert_eq!(print(&shape, 0.001, 1.0), Ok(mass));
        assert_eq!(print(&shape, 0.003, 0.1), Ok(mass));
        assert_eq!(print(&shape, f64::INFINITY, 0.1), Ok(mass));
    }
}

/// A hollow cylinder and a thinned cylinder inside it, by hand.
#[test]
fn a_core_adds_its_share() {
    let (w, f) = (0.001, 0.25);
    let shape = Shape::new(0.02, 0.01, Edge::Sharp).expect("a coin");
    let mass = print(&shape, w, f).expect("a mass");
    let of = |r: f64, h: f64| {
        let m = PLA * std::f64::consts::PI * r * r * h;
        [m, m * r * r / 2.0, m * (3.0 * r * r + h * h) / 12.0]
    };
    let (outer, core) = (of(0.01, 0.01), of(0.009, 0.008));
    let expected = [0, 1, 2].map(|i| outer[i] - core[i] + f * core[i]);
    let found = [mass.mass_kg, mass.axial_kg_m2, mass.transverse_kg_m2];
    for (found, expected) in found.into_iter().zip(expected) {
        assert!(error(found, expected) < 1e-13);
    }
}

/// With mass outside, a coin is harder to turn for its mass.
#[test]
fn less_infill_means_larger_gyrations() {
    for shape in fillable() {
        let mut last = 0.0;
        for fraction in [1.0, 0.6, 0.2, 0.0] {
            let mass = print(&shape, 0.0012, fraction).expect("a mass");
            assert!(mass.axial_kg_m2 / mass.mass_kg > last);
            last = mass.axial_kg_m2 / mass.mass_kg;
        }
    }
}

#[test]
fn what_has_no_mass_is_refused() {
    let shape = Shape::new(0.02, 0.01, Edge::Sharp).expect("a coin");
    for density in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            matches!(shape.mass(density, None), Err(MassError::Density(_))),
            "{density}"
        );
    }
    for fraction in [-0.1, 1.1, f64::NAN] {
        let mass = print(&shape, 0.001, fraction);
        assert!(matches!(mass, Err(MassError::Fraction(_))), "{fraction}");
    }
    for walls in [-1e-9, f64::NAN] {
        let mass = print(&shape, walls, 0.5);
        assert!(
            matches!(mass, Err(MassError::Walls { least: 0.0, .. })),
            "{walls}"
        );
    }
    assert!(print(&shape, 0.0, 0.0001).is_ok());
}

/// The core's corner stays inside: on the arc at (1 − 1/√2)r, on the cone at half of its size.
#[test]
fn walls_hold_the_core_inside() {
    for shape in fillable() {
        let e = shape.edge().size_m();
        let corner = match shape.edge() {
            Edge::Sharp => 0.0,
            // distance of the core's corner from the arc's centre is √2 (r − w), at most r
            Edge::Rounded { .. } => e - e / 2.0_f64.sqrt(),
            Edge::Chamfered { .. } => e / 2.0,
        };
        let least = shape
            .marks()
            .map_or(corner, |marks| marks.depth_m.max(corner));
        assert!(print(&shape, least + 1e-12, 0.5).is_ok());
        let mass = print(&shape, least - 1e-12, 0.5);
        assert!(matches!(mass, Err(MassError::Walls { .. })), "{shape:?}");
    }
}
