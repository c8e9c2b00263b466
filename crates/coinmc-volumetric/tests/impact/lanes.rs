//! Impacts in four lanes: each lane is bit-identical to the scalar path.

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
fn lanes_are_independent() {
    for law in Law::ALL {
        for trial in 0..25_000 {
            // body and friction are common to all lanes; the contact point and e are not
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
            let lanes =
                |part: fn(&ContactPoint<f64>) -> f64| Four(from_fn(|i| part(&cases[i].point)));
            let point = ContactPoint {
                sin: lanes(|t| t.sin),
                cos: lanes(|t| t.cos),
                rx: lanes(|t| t.rx),
                rz: lanes(|t| t.rz),
                slip_x: lanes(|t| t.slip_x),
                slip_y: lanes(|t| t.slip_y),
                approach: lanes(|t| t.approach),
                spin: lanes(|t| t.spin),
                turn: lanes(|t| t.turn),
            };
            let e = Four(from_fn(|i| cases[i].e));
            let in_lanes = impulse(law, &cases[0].body, &cases[0].friction, &point, e);
            for (i, case) in cases.iter().enumerate() {
                let scalar = parts(&case.impulse(law));
                assert_eq!(
                    scalar.map(f64::to_bits),
                    lane(&in_lanes, i).map(f64::to_bits),
                    "{law:?} trial {trial} lane {i} {case:?}"
                );
            }
        }
    }
}
