//! Flights in four lanes: each lane is bit-identical to the scalar path.

use super::{Departure, Orbit, first_contact};
use crate::body::Body;
use crate::drag::Drag;
use crate::four::Four;
use crate::motion::Motion;
use coinmc_core::{Coin, Domain, Stream, UniformSource};
use std::array::from_fn;

/// In the air, or just after a bounce.
pub(super) fn motion(body: &Body, trial: u64, rebounds: bool) -> Motion<f64> {
    let uniforms = Stream::new(310, Domain::Launch, 0).toss(trial);
    let mut uniforms = uniforms;
    let mut at = |i: u32, from: f64, to: f64| from + (to - from) * uniforms.uniform(i);
    let mut motion = Motion::still();
    let cos = at(0, 0.0, 1.0);
    motion.set_tilt((1.0 - cos * cos).sqrt(), cos);
    let spin = libm::exp(at(1, -3.0, 5.0));
    (motion.ox, motion.oy, motion.oz) =
        (at(2, -spin, spin), at(3, -spin, spin), at(4, -spin, spin));
    (motion.vx, motion.vy, motion.vz) = (at(5, -1.0, 1.0), at(6, -1.0, 1.0), at(7, -3.0, 3.0));
    let rest = motion.rest_height(body);
    if rebounds {
        let turning = motion.spin(body.ka / body.kt);
        let point = motion.contact_point(body, &turning);
        // the contact point recedes
        motion.vz += at(8, 0.0, 1.0) - point.approach;
        motion.z = rest;
    } else {
        motion.z = rest + at(8, 0.0, 10.0);
    }
    motion
}

fn in_lanes(motions: &[Motion<f64>; 4]) -> Motion<Four> {
    let part = |f: fn(&Motion<f64>) -> f64| Four(from_fn(|i| f(&motions[i])));
    Motion {
        sin: part(|m| m.sin),
        cos: part(|m| m.cos),
        ox: part(|m| m.ox),
        oy: part(|m| m.oy),
        oz: part(|m| m.oz),
        vx: part(|m| m.vx),
        vy: part(|m| m.vy),
        vz: part(|m| m.vz),
        z: part(|m| m.z),
    }
}

fn bits(m: &Motion<f64>) -> [u64; 9] {
    [m.sin, m.cos, m.ox, m.oy, m.oz, m.vx, m.vy, m.vz, m.z].map(f64::to_bits)
}

fn lane(motion: &Motion<Four>, i: usize) -> Motion<f64> {
    Motion {
        sin: motion.sin.0[i],
        cos: motion.cos.0[i],
        ox: motion.ox.0[i],
        oy: motion.oy.0[i],
        oz: motion.oz.0[i],
        vx: motion.vx.0[i],
        vy: motion.vy.0[i],
        vz: motion.vz.0[i],
        z: motion.z.0[i],
    }
}

#[test]
fn lanes_of_flight_are_independent() {
    for trial in 0..5000 {
        let ratio = [0.01, 0.3, 1.0, 5.0][(trial % 4) as usize];
        let body = Body::new(&Coin::cylinder(ratio, 0.01).expect("a good coin"));
        let drag = match trial % 3 {
            0 => Drag {
                linear: 0.3,
                angular: 0.1,
            },
            _ => Drag {
                linear: 0.0,
                angular: 0.0,
            },
        };
        let rebounds = trial % 2 == 0;
        let departure = if rebounds {
            Departure::Rebound
        } else {
            Departure::Launched
        };
        let each = from_fn(|i| motion(&body, 4 * trial + i as u64, rebounds));
        let four = in_lanes(&each);
        let mut orbit = Orbit::new(&four, drag);
        let found = first_contact(&mut orbit, &body, departure, Four([1e-9; 4]));
        let (landed, heading, reflected) = orbit.land(&four, &body, found.time);
        for (i, one) in each.iter().enumerate() {
            let mut orbit = Orbit::new(one, drag);
            let single = first_contact(&mut orbit, &body, departure, 1e-9);
            let (motion, [nx, ny], flips) = orbit.land(one, &body, single.time);
            assert_eq!(found.gave_up.0[i], single.gave_up, "{trial} {i}");
            assert_eq!(
                found.time.0[i].to_bits(),
                single.time.to_bits(),
                "{trial} {i}"
            );
            assert_eq!(bits(&lane(&landed, i)), bits(&motion), "{trial} {i}");
            assert_eq!(
                heading.map(|x| x.0[i].to_bits()),
                [nx.to_bits(), ny.to_bits()]
            );
            assert_eq!(reflected.0[i], flips, "{trial} {i}");
        }
    }
}

/// The bound that the search uses for a widening gap: until `until`, the gap of a rim is at least
/// the cubic with the greatest jerk. The bound is close enough to be useful.
#[test]
fn the_jerk_bound_holds_and_is_tight() {
    let (mut shares, mut checked) = (0.0, 0_u32);
    for (trial, ratio) in (0..3000).zip([0.1, 0.85, 2.0, 10.0].into_iter().cycle()) {
        let body = Body::new(&Coin::cylinder(ratio, 0.01).expect("a good coin"));
        let no_drag = Drag {
            linear: 0.0,
            angular: 0.0,
        };
        let orbit = Orbit::new(&motion(&body, trial, trial % 2 == 0), no_drag);
        let bounds = orbit.bounds(&orbit.extent(&body));
        let now = orbit.first_gap(&body);
        let (jerk, until) = bounds.jerk(&body, now.sin, 1.0 / now.sin);
        for i in 1..=40 {
            let t = until * f64::from(i) / 40.0;
            let then = orbit.gap(&body, t);
            // for the rim that is the lowest at the start
            let touch = body.half.copysign(now.uz) * then.uz + body.radius * then.sin;
            let fall = then.z - touch - now.height;
            let parabola = t * (now.slope + 0.5 * t * now.curvature);
            let most = jerk * t * t * t / 6.0;
            // rounding of the heights, and cancellation in the curvature
            let rounding = 1e-13 * (1.0 + then.z + t * t * now.curvature.abs());
            let error = (fall - parabola).abs();
            assert!(error <= most + rounding, "{trial} {t}: {error:e} {most:e}");
            shares += error / most.max(rounding);
            checked += 1;
        }
    }
    let mean = shares / f64::from(checked);
    assert!(mean > 0.01, "{mean}");
}
