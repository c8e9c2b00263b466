//! Surfaces: what each number means and which are refused.

use super::*;

#[test]
fn restitution_falls_as_a_power_of_the_speed_from_the_reference_on() {
    let constant = Surface::new(0.5, 0.3).unwrap();
    assert_eq!(
        (constant.restitution_at(0.0), constant.restitution_at(9.0)),
        (0.5, 0.5)
    );
    let plastic = constant
        .with_speed_dependent_restitution(0.25, 2.0)
        .unwrap();
    for (speed, expected) in [
        (2.0, 0.5),
        (32.0, 0.25),
        (1.9, 0.5),
        (1e-9, 0.5),
        (0.0, 0.5),
    ] {
        assert!(
            (plastic.restitution_at(speed) - expected).abs() < 1e-15,
            "{speed}"
        );
    }
    let cut = plastic.with_restitution_threshold(0.5).unwrap();
    assert_eq!(
        (cut.restitution_at(0.4), cut.restitution_at(2.0)),
        (0.0, 0.5)
    );
}

fn wood() -> Surface {
    Surface::new(0.5, 0.3).expect("a good surface")
}

fn tilt(angle_deg: f64) -> TableTilt {
    TableTilt::new(angle_deg, 40.0).expect("a good tilt")
}

/// v/v_ref means nothing at v_ref = 0, and a table of no size holds no coin.
#[test]
fn speeds_and_radii_that_are_divided_by_or_measured_from_are_above_zero() {
    for bad in [0.0, -1e-9, f64::NAN, f64::INFINITY] {
        let reference = wood().with_speed_dependent_restitution(0.25, bad);
        assert!(
            matches!(reference, Err(SurfaceError::Reference(_))),
            "{bad}"
        );
        let radius = wood().with_table_radius(bad);
        assert!(matches!(radius, Err(SurfaceError::TableRadius(_))), "{bad}");
    }
    let small = wood().with_table_radius(1e-9).expect("a table");
    assert_eq!(small.table_radius_m(), Some(1e-9));
    assert_eq!(small.without_edge(), wood());
}

/// Friction holds a body on a slope up to tan β = μ.
#[test]
fn a_table_is_tilted_by_less_than_its_angle_of_friction() {
    let tilt = tilt(5.0);
    let with = |friction| {
        Surface::new(0.5, friction)
            .expect("a surface")
            .with_tilt(tilt)
    };
    let table = with(tilt.slope() * 1.001).expect("friction that holds");
    assert_eq!(table.tilt(), Some(tilt));
    for steep in [tilt.slope(), tilt.slope() * 0.999, 0.0] {
        assert!(
            matches!(with(steep), Err(SurfaceError::Steep { .. })),
            "{steep}"
        );
    }
}

#[test]
fn a_level_table_is_no_tilted_one_and_needs_no_friction() {
    for friction in [0.0, 0.3] {
        let floor = Surface::new(0.5, friction).expect("a surface");
        let level = floor.with_tilt(tilt(0.0)).expect("nothing slides");
        assert_eq!(level.tilt(), None);
    }
}

/// The closed forms are for level ground.
#[test]
fn where_the_first_contact_decides_the_table_is_level() {
    let landing = |surface: Surface, landing| surface.with_landing(landing);
    let adhesive = landing(wood(), Landing::Adhesive).expect("a level table");
    assert_eq!(adhesive.landing(), Landing::Adhesive);
    let refused = Err(SurfaceError::TiltedAdhesive);
    assert_eq!(adhesive.with_tilt(tilt(1.0)), refused);
    assert!(adhesive.with_tilt(tilt(0.0)).is_ok());
    let tilted = wood().with_tilt(tilt(1.0)).expect("nothing slides");
    assert_eq!(landing(tilted, Landing::Adhesive), refused);
    assert_eq!(landing(tilted, Landing::Bouncing), Ok(tilted));
    let level = tilted.with_tilt(tilt(0.0)).expect("nothing slides");
    assert!(landing(level, Landing::Adhesive).is_ok());
}

/// At the reference speed a coin bounces with e as given, and k times as fast with e k^-p.
#[test]
fn exponent_and_reference_say_how_restitution_falls() {
    let (restitution, exponent, reference) = (0.6, 0.25, 0.7);
    let metal = Surface::new(restitution, 0.2).expect("a surface");
    let metal = metal
        .with_speed_dependent_restitution(exponent, reference)
        .expect("plastic impacts");
    assert_eq!(
        metal.restitution_at(metal.restitution_reference_m_s()),
        metal.restitution()
    );
    // 16^-1/4 = 1/2
    let fall = metal.restitution_at(16.0 * reference) / metal.restitution();
    assert!((fall - 0.5).abs() < 1e-15);
    let given = [
        metal.restitution(),
        metal.restitution_exponent(),
        metal.restitution_reference_m_s(),
    ];
    assert_eq!(given, [restitution, exponent, reference]);
}

/// Below the threshold no contact bounces, from it on all do.
#[test]
fn the_threshold_is_the_slowest_approach_that_bounces() {
    let sim = wood().with_restitution_threshold(2.0).expect("a threshold");
    let slowest = sim.restitution_threshold_m_s();
    assert_eq!((slowest, sim.restitution_at(slowest)), (2.0, 0.5));
    assert_eq!(sim.restitution_at(slowest * (1.0 - 1e-9)), 0.0);
    assert_eq!(wood().restitution_threshold_m_s(), 0.0);
}
