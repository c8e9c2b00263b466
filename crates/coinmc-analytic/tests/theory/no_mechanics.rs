//! The surface-area and cross-section rules as shares of random straight lines (Cauchy and
//! Crofton).

use crate::measure::simpson;
use crate::random::{SplitMix, assert_share};
use coinmc_analytic::{cross_section, surface_area};
use std::f64::consts::{FRAC_PI_2, PI};

const RATIOS: [f64; 6] = [0.05, 0.5, 1.0, 1.6, 2.0, 7.0];

/// Whether the ray from `at` along `way` enters the cylinder `R = 1` of height `h` through its
/// side; `None` if it misses.
fn enters_through_side(h: f64, at: [f64; 3], way: [f64; 3]) -> Option<bool> {
    let half = 0.5 * h;
    let a = way[0] * way[0] + way[1] * way[1];
    let b = at[0] * way[0] + at[1] * way[1];
    let c = at[0] * at[0] + at[1] * at[1] - 1.0;
    let root = (b * b - a * c).max(0.0).sqrt();
    if root == 0.0 {
        return None;
    }
    let (slab_in, slab_out) = (
        -half * way[2].signum() - at[2],
        half * way[2].signum() - at[2],
    );
    let (side_in, side_out) = ((-b - root) / a, (-b + root) / a);
    let (face_in, face_out) = (slab_in / way[2], slab_out / way[2]);
    (side_in.max(face_in) < side_out.min(face_out)).then_some(side_in > face_in)
}

#[test]
fn surface_area_rule_is_the_share_of_lines_that_enter_there() {
    let mut random = SplitMix(2);
    for ratio in RATIOS {
        let (mut side, mut hits) = (0, 0);
        let reach = (1.0 + 0.25 * ratio * ratio).sqrt();
        while hits < 100_000 {
            let way = random.direction();
            // Uniform in a disc across the line that is wide enough for the coin: a random
            // direction minus its part along the line has a random azimuth, and the square of the
            // distance is uniform.
            let any = random.direction();
            let along: f64 = (0..3).map(|i| any[i] * way[i]).sum();
            let across: [f64; 3] = std::array::from_fn(|i| any[i] - along * way[i]);
            let length = across.iter().map(|c| c * c).sum::<f64>().sqrt();
            let distance = reach * random.uniform(0.0, 1.0).sqrt();
            let at = across.map(|c| c * distance / length);
            if let Some(through_side) = enters_through_side(ratio, at, way) {
                hits += 1;
                side += u32::from(through_side);
            }
        }
        assert_share(
            side,
            hits,
            surface_area::p_side(ratio),
            &format!("ratio {ratio}"),
        );
    }
}

#[test]
fn surface_area_rule_is_the_mean_projected_area() {
    for ratio in RATIOS {
        // Seen at the angle t to the axis, the side has the area 2RH sin t and a face πR² cos t.
        let mean =
            |shown: fn(f64) -> f64| simpson(0.0, FRAC_PI_2, 2000, |t| shown(t) * libm::sin(t));
        let side = 2.0 * ratio * mean(libm::sin);
        let face = PI * mean(libm::cos);
        // Simpson: (π/2)⁵·16/(180·2000⁴) = 6e-14.
        assert!((side / (side + face) - surface_area::p_side(ratio)).abs() < 1e-12);
    }
}

#[test]
fn cross_section_rule_is_the_mean_projected_length() {
    for ratio in RATIOS {
        let side = ratio * simpson(0.0, FRAC_PI_2, 2000, libm::sin);
        let face = 2.0 * simpson(0.0, FRAC_PI_2, 2000, libm::cos);
        // Simpson: (π/2)⁵/(180·2000⁴) = 4e-15, and the rounding of 2000 terms.
        assert!((side / (side + face) - cross_section::p_side(ratio)).abs() < 1e-12);
    }
}
