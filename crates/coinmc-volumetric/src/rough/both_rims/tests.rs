//! Tests of a coin on its side on rough ground.

use super::super::test_scenes::Rough;
use super::*;
use crate::contact::Usage;
use crate::toss::Toss;
use coinmc_core::Launch;
use coinmc_testkit::Dice;
use nalgebra::{UnitVector3, Vector3};

/// A toss that begins upright.
fn upright(model: &crate::model::Model<crate::laws::Moreau>) -> Toss {
    model.launch(&Launch {
        height_m: 0.0,
        velocity_m_s: Vector3::zeros(),
        axis: UnitVector3::new_unchecked(Vector3::x()),
        spin_rad_s: Vector3::zeros(),
    })
}

/// Momentum and angular momentum about the centre, per m D sqrt(gD), in axes that the coin's have turned away
/// from by `angle` about the vertical.
fn momenta<I: ImpactLaw>(walk: &Walk<'_, I, ()>, angle: f64) -> [Vector3<f64>; 2] {
    let (m, spin, body) = (&walk.toss.motion, &walk.toss.spin, walk.body());
    let own = Vector3::new(m.sin, 0.0, m.cos) * (body.ka * spin.axial)
        + Vector3::new(m.cos, 0.0, -m.sin) * (body.kt * spin.turn)
        + Vector3::y() * (body.kt * spin.tilt);
    let (sin, cos) = libm::sincos(angle);
    [Vector3::new(m.vx, m.vy, m.vz), own]
        .map(|v| Vector3::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos, v.z))
}

/// The normal forces on both rims by Newton's and Euler's laws: from the rates of momentum and angular momentum
/// of a coin whose rims follow their tracks, as differences, and from where the rims touch. A rim stays down where its
/// force is positive.
#[test]
fn a_rim_stays_down_where_its_normal_force_is_positive() {
    let (model, mut seen) = (Rough::of(0.7, 0.02).model(), [0; 4]);
    let ground = model.ground.expect("a rough ground");
    for toss in 0..1_500 {
        let mut dice = Dice::new(531, toss);
        let mut toss = upright(&model);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let mut number = |most: f64| dice.between(-most, most);
        let state = [number(0.5), number(0.5), number(1.2), number(1.2)];
        let ahead = [number(0.02), number(0.02)];
        let heights = [number(0.02), number(0.02)];
        let rates = [number(0.01), number(0.01)];
        let (time, rises) = (0.05, [number(1.5), number(1.5)]);
        let creep = model.contact_rules().stick_speed;
        let dynamics = &model.dynamics;
        let flow = line_rates_on::<true>(dynamics, &state, creep, ahead).rates;
        let mut at = |t: f64| {
            for (i, track) in [&mut walk.tracks.own, &mut walk.tracks.other]
                .into_iter()
                .enumerate()
            {
                track.height = heights[i] + rates[i] * t + 0.5 * rises[i] * t * t;
                track.rate = rates[i] + rises[i] * t;
            }
            let now: LineState = std::array::from_fn(|i| state[i] + flow[i] * t);
            walk.place_on_tracks(&now);
            momenta(&walk, state[3] * t)
        };
        let h = 1e-5;
        let (before, after) = (at(-h), at(h));
        let [force, torque] = [0, 1].map(|i| (after[i] - before[i]) / (2.0 * h));
        at(0.0);
        let (normal, body) = (1.0 + force.z, &dynamics.body);
        // the rims touch at −h u + R a and h u + R a from the centre, a the lean, and R below it
        let lean = (heights[1] - heights[0]) / (2.0 * body.half);
        let [own, other] = [-body.half, body.half].map(|half| half + body.radius * lean);
        let first = (-body.radius * force.x - torque.y - other * normal) / (own - other);
        let second = normal - first;
        let expected = match (normal > 0.0, first >= 0.0, second >= 0.0) {
            (false, ..) => Down::Nothing,
            (_, true, true) => Down::Both,
            (_, true, false) => Down::Own,
            (_, false, _) => Down::Other,
        };
        // of first order in the lean
        if [normal, first, second]
            .iter()
            .all(|force| force.abs() > 3e-3)
        {
            seen[expected as usize] += 1;
            let bends = rises.map(|rise| rise * time);
            let found = walk.down_at(&state, bends, time, ahead);
            assert_eq!(found, expected, "{normal} {first} {second}");
        }
    }
    assert!(seen.iter().all(|count| *count > 60), "{seen:?}");
}

/// Where both rims touch, neither the coin's energy nor its budget knows of more than the work of friction: of a coin
/// that slides along its axis, along the ground, or turns on the spot, by the textbook's rates.
#[test]
fn friction_on_both_rims_takes_its_work_from_the_budget() {
    let rough = Rough {
        friction_m: [1e-12, 1e-12],
        ..Rough::of(0.7, 1e-4)
    };
    let model = rough.model();
    let ground = model.ground.expect("a rough ground");
    let (body, mu) = (&model.dynamics.body, 0.3);
    let (time, speed) = (0.05_f64, 0.8);
    // the rate at which friction slows down the slip of both rims, and the force on it
    for (state, slowing) in [
        ([speed, 0.0, 0.0, 0.0], mu),
        (
            [0.0, 0.6 * speed, 0.4 * speed / body.radius, 0.0],
            mu * (1.0 + body.radius * body.radius / body.ka),
        ),
        (
            [0.0, 0.0, 0.0, speed / body.half],
            mu * body.half * body.half / body.kt,
        ),
    ] {
        let mut toss = upright(&model);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        (walk.tracks.left, walk.tracks.interval) = (time, time);
        walk.place_on_tracks(&state);
        walk.budget = walk.energy();
        let before = walk.budget;
        walk.roll_on_both();
        let work = mu * (speed * time - 0.5 * slowing * time * time);
        let lost = before - walk.budget;
        assert!((lost / work - 1.0).abs() < 1e-4, "{state:?} {lost} {work}");
    }
}

/// A coin whose rims follow their tracks: its lowest points are at their heights and rise at their rates, and the motion
/// along the ground is the one asked for.
#[test]
fn rims_follow_their_tracks() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let mut toss = upright(&model);
    let (mut usage, mut observer) = (Usage::default(), ());
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    (walk.tracks.own.height, walk.tracks.other.height) = (0.002, -0.003);
    (walk.tracks.own.rate, walk.tracks.other.rate) = (0.3, -0.1);
    let state = [0.4, -0.3, 0.7, 0.9];
    walk.place_on_tracks(&state);
    let (m, spin, body) = (&walk.toss.motion, &walk.toss.spin, walk.body());
    assert_eq!(walk.line_state(), state);
    for (half, height, rate) in [(-body.half, 0.002, 0.3), (body.half, -0.003, -0.1)] {
        let (x, z) = (
            half * m.sin + body.radius * m.cos,
            half * m.cos - body.radius * m.sin,
        );
        assert!((m.z + z - height).abs() < 1e-15);
        // of first order in the lean, which is .008
        assert!((m.vz - spin.tilt * x - rate).abs() < 1e-2 * spin.tilt.abs());
    }
}

/// A coin that rolls straight is slowed down by rolling friction alone: v' = −ρ_c R/(k_a + R²), in one step, and goes on
/// rolling. Its budget loses what that takes from its energy; it takes the time to the node.
#[test]
fn a_coin_that_rolls_straight_is_slowed_down_by_rolling_friction() {
    let rough = Rough {
        friction_m: [5e-4, 1e-12],
        ..Rough::of(0.7, 1e-5)
    };
    let model = rough.model();
    let ground = model.ground.expect("a rough ground");
    let (body, time, speed) = (&model.dynamics.body, 0.05, 0.4);
    let mut toss = upright(&model);
    let (mut usage, mut observer) = (Usage::default(), ());
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    (walk.tracks.left, walk.tracks.interval) = (time, time);
    walk.place_on_tracks(&[0.0, speed, -speed / body.radius, 0.0]);
    walk.budget = walk.energy();
    let before = walk.budget;
    walk.roll_on_both();
    let inertia = body.ka + body.radius * body.radius;
    let end = speed - model.dynamics.friction.contour * body.radius / inertia * time;
    let per_square = 0.5 * inertia / (body.radius * body.radius);
    let lost = per_square * (speed * speed - end * end);
    assert!(((before - walk.budget) / lost - 1.0).abs() < 1e-3, "{lost}");
    let state = walk.line_state();
    assert!((state[1] / end - 1.0).abs() < 1e-4, "{state:?} {end}");
    assert!((state[1] + body.radius * state[2]).abs() < 1e-12);
    assert_eq!((walk.usage.steps, walk.usage.time), (1, time));
}

/// Where tracks that have risen at a rate stop rising, within the mean of the times to the nodes before and after, a coin whose
/// weight does not bring it down as fast loses contact; if one of them does so, its rim does.
#[test]
fn a_coin_lifts_off_where_tracks_fall_away_faster_than_it_falls() {
    let model = Rough::of(0.7, 1e-6).model();
    let ground = model.ground.expect("a rough ground");
    let (interval, speed) = (0.05, 0.3);
    for (shares, expected, own_lifts_off) in [
        ([0.97, 0.97], Touch::Both, false),
        ([1.03, 1.03], Touch::Nothing, false),
        ([1.0, 0.0], Touch::Rim, true),
        ([0.0, 1.0], Touch::Rim, false),
    ] {
        let mut toss = upright(&model);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let state = [0.0, speed, -speed / walk.body().radius, 0.0];
        walk.place_on_tracks(&state);
        let time = 0.5 * (interval + walk.time_between_nodes());
        walk.tracks.interval = interval;
        [walk.tracks.own.rate, walk.tracks.other.rate] = shares.map(|share| share * time);
        walk.tracks.other.near = true;
        walk.place_on_tracks(&state);
        walk.budget = walk.energy();
        let heading = walk.place.direction(1.0, 0.0);
        let next = walk.pass_node_on_both(&state, [[0.0; 2]; 2], [0.0; 2]);
        assert_eq!(next, Next::Goes(expected), "{shares:?}");
        let [x, y] = walk.place.direction(1.0, 0.0);
        let turned = x * heading[0] + y * heading[1] < 0.0;
        assert_eq!(turned, own_lifts_off, "{shares:?}");
    }
}

/// A coin that slides touches slopes ahead of its lowest points; one that rolls straight asks for none.
#[test]
fn a_coin_that_slides_touches_ahead_of_its_lowest_points() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let mut toss = upright(&model);
    let (mut usage, mut observer) = (Usage::default(), ());
    let walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    let radius = walk.body().radius;
    let slopes = [[0.3, 0.02], [0.1, -0.05]];
    let [own, other] = walk.both_ahead(&[0.3, 0.2, 0.1, 0.5], slopes);
    assert!((own - 0.02 * radius).abs() < 1e-15 && (other + 0.05 * radius).abs() < 1e-15);
    let straight = [0.0, 0.3, -0.3 / radius, 0.0];
    assert_eq!(walk.both_ahead(&straight, slopes), [0.0; 2]);
}

/// Nothing takes energy from a coin that slides and turns without friction, and nothing gives it any: steps lose no more than
/// their tolerance allows. A step in which the velocity turns by y multiplies its square by 1 − y⁶/1800 + y⁸/1600 (Dormand &
/// Prince's method, with higher powers left out): one of more than a radian, allowed to a slow coin, would gain.
#[test]
fn a_coin_without_friction_keeps_its_energy() {
    let rough = Rough {
        friction: 0.0,
        friction_m: [0.0; 2],
        ..Rough::of(0.7, 1e-4)
    };
    let model = rough.model();
    let ground = model.ground.expect("a rough ground");
    for (speed, wz) in [(0.4, 0.7), (0.4, -6.0), (4e-3, 3.0), (4e-3, -2.5)] {
        let mut toss = upright(&model);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        (walk.tracks.left, walk.tracks.interval) = (0.5, 0.5);
        walk.place_on_tracks(&[0.6 * speed, 0.8 * speed, 0.2, wz]);
        walk.budget = walk.energy();
        let before = walk.budget;
        walk.roll_on_both();
        let lost = before - walk.budget;
        // the error of the velocity in a step, times the velocity
        let most = model.contact_rules().tolerance * speed * f64::from(walk.usage.steps);
        assert!((0.0..most).contains(&lost), "{speed} {wz}: {lost:e}");
        assert!((walk.energy() - walk.budget).abs() < 1e-9, "{speed} {wz}");
    }
}
