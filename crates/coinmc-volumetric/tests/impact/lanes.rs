//! Four lanes side by side: each is to the bit what it is alone.

use crate::common::{case, impulse, parts};
use coinmc_volumetric::{ContactPoint, Impulse, Law};
use std::array::from_fn;

#[path = "../../src/four.rs"]
mod four;

use four::Four;

fn lane(p: &Impulse<Four>, i: usize) -> [f64; 5] {
    [p.x, p.y, p.z, p.contour, p.pivoting].map(|part| part.0[i])
}

#[test]
fn a_lane_does_not_see_the_others() {
    for law in Law::ALL {
        for trial in 0..25_000 {
            // body and friction are a scene's; the point and e are a lane's
            let cases: [_; 4] = from_fn(|i| {
                let scene = case(21, 4 * trial);
                let mut other = case(21, 4 * trial + i as u64);
                let t = &other.point;
                other.point = crate::common::point(
                    &scene.body,
                    t.sin,
                    [t.slip_x, t.slip_y, t.approach],
                    [t.spin, t.turn],
                );
                other.body = scene.body;
                other.friction = scene.friction;
                other
            });
            let of = |part: fn(&ContactPoint<f64>) -> f64| Four(from_fn(|i| part(&cases[i].point)));
            let point = ContactPoint {
                sin: of(|t| t.sin),
                cos: of(|t| t.cos),
                rx: of(|t| t.rx),
                rz: of(|t| t.rz),
                slip_x: of(|t| t.slip_x),
                slip_y: of(|t| t.slip_y),
                approach: of(|t| t.approach),
                spin: of(|t| t.spin),
                turn: of(|t| t.turn),
            };
            let e = Four(from_fn(|i| cases[i].e));
            let together = impulse(law, &cases[0].body, &cases[0].friction, &point, e);
            for (i, case) in cases.iter().enumerate() {
                let alone = parts(&case.impulse(law));
                assert_eq!(
                    alone.map(f64::to_bits),
                    lane(&together, i).map(f64::to_bits),
                    "{law:?} trial {trial} lane {i} {case:?}"
                );
            }
        }
    }
}
