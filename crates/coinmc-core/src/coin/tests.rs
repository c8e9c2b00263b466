//! Sizes, moments and lowest points against their definitions.

use super::*;

#[test]
fn a_thin_ring_is_allowed_and_a_larger_moment_is_not() {
    let coin = Coin::cylinder(0.1, 0.01).unwrap();
    let ring = coin.mass_kg() * 1e-4;
    assert!(coin.with_moments(Some(ring), Some(ring / 2.0)).is_ok());
    assert!(matches!(
        coin.with_moments(Some(ring * 1.001), None),
        Err(CoinError::AxialMoment { .. })
    ));
}

#[test]
fn a_transverse_moment_beyond_all_mass_at_the_ends_is_refused() {
    let coin = Coin::cylinder(2.0, 1.0).unwrap().with_mass(1.0).unwrap();
    // I_a = 1/2, H²/4 = 1: I_t lies in [1/4, 5/4]
    assert!(coin.with_moments(None, Some(1.25)).is_ok());
    for bad in [0.249, 1.251, f64::NAN, f64::INFINITY, -1.0] {
        assert!(coin.with_moments(None, Some(bad)).is_err(), "{bad}");
    }
}

#[test]
fn bad_sizes_are_refused() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Coin::cylinder(bad, 1.0).is_err());
        assert!(Coin::cylinder(1.0, bad).is_err());
        assert!(Coin::cylinder(1.0, 1.0).unwrap().with_mass(bad).is_err());
    }
}

/// A coin of 20 g, R = 3 m: no power of R is 1, and R² is not 2R.
fn heavy(ratio: f64) -> Coin {
    let coin = Coin::cylinder(ratio, 3.0).and_then(|coin| coin.with_mass(0.02));
    coin.expect("a good coin")
}

fn rounded(ratio: f64, rim_radius_m: f64) -> Coin {
    let coin = heavy(ratio).with_rim_radius(rim_radius_m);
    coin.expect("rounded rims")
}

fn close(found: f64, expected: f64) -> bool {
    (found - expected).abs() < 1e-14 * expected.abs()
}

#[test]
fn a_refused_moment_is_named_with_its_bounds_in_kg_m2() {
    // m R² = 0.18, I_a of a uniform coin 0.09, m H²/4 = 0.0648 with H = 3.6 m
    let coin = heavy(1.2);
    let Err(CoinError::AxialMoment { found, most }) = coin.with_moments(Some(0.19), None) else {
        panic!("more than a thin ring has")
    };
    assert!(close(found, 0.19) && close(most, 0.18));
    for bad in [0.04, 0.11] {
        let refused = coin.with_moments(None, Some(bad));
        let Err(CoinError::TransverseMoment { found, least, most }) = refused else {
            panic!("{bad} is out of bounds")
        };
        assert!(close(found, bad) && close(least, 0.045) && close(most, 0.1098));
    }
}

#[test]
fn a_coin_without_axial_moment_is_refused() {
    let none = heavy(1.2).with_moments(Some(0.0), None);
    assert!(matches!(none, Err(CoinError::AxialMoment { .. })));
}

#[test]
fn the_height_is_the_ratio_times_the_radius() {
    let coin = heavy(1.2);
    assert_eq!([coin.ratio(), coin.radius_m()], [1.2, 3.0]);
    assert!(close(coin.height_m(), 3.6));
}

#[test]
fn rounding_leaves_a_cylinder_inside() {
    // H/2 is the limit of a flat coin, R that of a tall one
    for (ratio, limit) in [(0.25, 0.375), (5.0, 3.0)] {
        let coin = heavy(ratio);
        assert!(coin.with_rim_radius(0.999 * limit).is_ok());
        for bad in [-1e-3, limit, 1.001 * limit, f64::NAN] {
            let Err(CoinError::RimRadius { found, most }) = coin.with_rim_radius(bad) else {
                panic!("{bad} does not fit into ratio {ratio}")
            };
            assert_eq!((found.to_bits(), most), (bad.to_bits(), limit));
        }
    }
}

/// With r the inner cylinder has the radius R − r and the height H − 2r.
#[test]
fn the_inner_ratio_is_that_of_the_cylinder_inside() {
    let coin = rounded(1.2, 0.3);
    assert_eq!(coin.rim_radius_m(), 0.3);
    assert!(close(coin.inner_ratio(), (3.6 - 0.6) / (3.0 - 0.3)));
    assert_eq!(heavy(1.2).inner_ratio(), 1.2);
}

/// In the limit r = R = H/2 the coin is a sphere: 2/5 m R² about any diameter.
#[test]
fn a_coin_that_is_all_rim_is_a_sphere() {
    let sphere = rounded(2.0, 3.0 * (1.0 - 1e-9));
    for gyration in [sphere.transverse_gyration_m2(), sphere.axial_gyration_m2()] {
        // off by the part of the cylinder that is left, some 1e-9
        assert!((gyration / (0.4 * 9.0) - 1.0).abs() < 1e-8, "{gyration}");
    }
}

/// The sums of thin slices, in metres: off by some n^(−3/2) with n slices.
#[test]
fn a_rounded_coin_has_the_moments_of_thin_slices() {
    let (half, radius, rim) = (1.8, 3.0, 0.3_f64);
    let slices = 20_000;
    let [mut mass, mut axial, mut square] = [0.0; 3];
    for slice in 0..slices {
        let z = half * (f64::from(slice) + 0.5) / f64::from(slices);
        let t = (z - (half - rim)).max(0.0);
        let rho: f64 = radius - rim + (rim * rim - t * t).sqrt();
        mass += rho * rho;
        axial += 0.5 * rho.powi(4);
        square += z * z * rho * rho;
    }
    let coin = rounded(1.2, 0.3);
    let axial = axial / mass;
    assert!((coin.axial_gyration_m2() / axial - 1.0).abs() < 1e-6);
    let transverse = 0.5 * axial + square / mass;
    assert!((coin.transverse_gyration_m2() / transverse - 1.0).abs() < 1e-6);
}

#[test]
fn own_moments_outlast_a_rounding_that_changes_nothing() {
    let hollow = heavy(1.2).with_moments(Some(0.12), Some(0.08));
    let hollow = hollow.expect("a hollow coin");
    assert_eq!(hollow.with_rim_radius(0.0), Ok(hollow));
}

#[test]
fn a_conical_edge_has_sharp_rims() {
    let conical = heavy(1.2).with_draft(5.0).expect("a cone");
    assert_eq!(conical.with_rim_radius(0.0), Ok(conical));
    assert_eq!(conical.with_rim_radius(0.1), Err(CoinError::RoundedDraft));
    assert_eq!(
        rounded(1.2, 0.1).with_draft(5.0),
        Err(CoinError::RoundedDraft)
    );
}

/// Unit vectors: both faces down, in several azimuths, none of them level.
fn axes() -> impl Iterator<Item = Vector3<f64>> {
    (1..24).map(|step| {
        let (tilt, azimuth) = (0.13 * f64::from(step), 0.7 * f64::from(step));
        let across = libm::sin(tilt);
        Vector3::new(
            across * libm::cos(azimuth),
            across * libm::sin(azimuth),
            libm::cos(tilt),
        )
    })
}

/// The lowest of points all along circles about the axis: (radius, distance of the plane towards heads).
/// Among 8 points that start at the horizontal diameter are the lowest and the highest one.
fn lowest_of_circles(axis: &Vector3<f64>, circles: [(f64, f64); 2]) -> Vector3<f64> {
    let level = axis.cross(&Vector3::z()).normalize();
    let steep = axis.cross(&level);
    let points = circles.into_iter().flat_map(|(radius, distance)| {
        (0..8).map(move |eighth| {
            let turn = f64::from(eighth) * std::f64::consts::FRAC_PI_4;
            axis * distance + (level * libm::cos(turn) + steep * libm::sin(turn)) * radius
        })
    });
    let lowest = points.min_by(|one, other| one.z.total_cmp(&other.z));
    lowest.expect("some points")
}

/// A rounded coin is the cylinder inside with balls of the rims' radius all over it.
#[test]
fn no_point_of_a_cylinder_is_below_its_lowest() {
    for coin in [heavy(1.2), rounded(1.2, 0.3)] {
        let rim = coin.rim_radius_m();
        let circles = [1.0, -1.0].map(|side| (3.0 - rim, side * (1.8 - rim)));
        for axis in axes() {
            let expected = lowest_of_circles(&axis, circles) - Vector3::z() * rim;
            let found = coin.lowest_point_m(&axis);
            assert!(
                (found - expected).norm() < 1e-14,
                "{axis} {found} {expected}"
            );
        }
    }
}

#[test]
fn no_point_of_a_coin_with_unlike_faces_is_below_its_lowest() {
    let loaded = heavy(1.2).with_centre_of_mass(0.2, None, None);
    // heads is 0.3 of H from the centre, tails 0.7 of H
    let loaded = (loaded.expect("a loaded coin"), [(3.0, 1.08), (3.0, -2.52)]);
    let conical = heavy(1.2).with_draft(-12.0).expect("a cone");
    let [heads, tails] = conical.rims();
    let circles = [
        (heads.radius_m, heads.distance_m),
        (tails.radius_m, -tails.distance_m),
    ];
    for (coin, circles) in [loaded, (conical, circles)] {
        for axis in axes() {
            let expected = lowest_of_circles(&axis, circles);
            let found = coin.lowest_point_m(&axis);
            assert!(
                (found - expected).norm() < 1e-14,
                "{axis} {found} {expected}"
            );
        }
    }
}

#[test]
fn a_level_coin_touches_in_the_middle_of_its_face_or_side() {
    let loaded = heavy(1.2).with_centre_of_mass(0.2, None, None);
    let loaded = loaded.expect("a loaded coin");
    // the side's middle is 0.2 H = 0.72 m on the tails side of the centre
    let cases = [
        (heavy(1.2), [-1.8, -1.8], 0.0),
        (rounded(1.2, 0.3), [-1.8, -1.8], 0.0),
        (loaded, [-2.52, -1.08], -0.72),
    ];
    for (coin, [heads_up, heads_down], middle) in cases {
        for (axis, expected) in [
            (Vector3::z(), Vector3::z() * heads_up),
            (-Vector3::z(), Vector3::z() * heads_down),
            (Vector3::x(), Vector3::new(middle, 0.0, -3.0)),
            (-Vector3::y(), Vector3::new(0.0, -middle, -3.0)),
        ] {
            let found = coin.lowest_point_m(&axis);
            assert!(
                (found - expected).norm() < 1e-14,
                "{axis} {found} {expected}"
            );
        }
    }
}

/// On its edge the axis of a coin rises by the draft towards the wider face, and the line of contact is that
/// from rim to rim.
#[test]
fn a_conical_coin_on_its_edge_touches_in_the_middle_of_a_line() {
    let coin = heavy(1.2).with_draft(12.0).expect("a cone");
    let (sin, cos) = libm::sincos(12.0_f64.to_radians());
    let axis = Vector3::new(cos, 0.0, sin);
    let down = Vector3::new(sin, 0.0, -cos);
    let [heads, tails] = coin.rims();
    let ends = [
        axis * heads.distance_m + down * heads.radius_m,
        -axis * tails.distance_m + down * tails.radius_m,
    ];
    assert!((ends[0].z - ends[1].z).abs() < 1e-14, "the line is level");
    let found = coin.lowest_point_m(&axis);
    assert!((found - (ends[0] + ends[1]) / 2.0).norm() < 1e-14);
}
