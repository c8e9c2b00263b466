//! Tests of the walk: which rim lands, what is clear of the ground, and what gains no energy.

mod nodes;

use super::super::test_scenes::{Rough, leaning, set_spin};
use super::*;
use crate::laws::Moreau;
use crate::settings::Settings;
use crate::toss::tests::agree;
use coinmc_core::Launch;
use coinmc_oracle::Start;
use coinmc_testkit::Dice;
use nalgebra::{UnitVector3, Vector3};

/// Whatever the heights under both rims of a coin that is almost upright: of two that come down, that lands first
/// which the other does not find in the ground then. Which it is moves nothing and changes no energy.
#[test]
fn of_two_rims_that_land_none_ends_below_the_ground() {
    let model = Rough::of(0.7, 0.05).model();
    let ground = model.ground.expect("a rough ground");
    let (mut own_first, mut other_first) = (0, 0);
    for number in 0..400 {
        let mut dice = Dice::new(524, number);
        let launch = Launch {
            height_m: 0.0,
            velocity_m_s: Vector3::new(0.1, 0.2, -0.2),
            axis: UnitVector3::new_normalize(Vector3::new(1.0, 0.0, dice.between(0.0, 0.004))),
            spin_rad_s: Vector3::zeros(),
        };
        let mut toss = model.launch(&launch);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        walk.draw_place();
        let (before, spare) = (walk.toss.state(&model.units), walk.budget - walk.energy());
        if walk.land_first_rim() {
            other_first += 1;
        } else {
            own_first += 1;
        }
        // heights count from the ground under the rim that lands, and the coin is where it was
        agree(&walk.toss.state(&model.units), &before, 1e-12);
        assert!((walk.budget - walk.energy() - spare).abs() < 1e-12);
        let (motion, body) = (walk.toss.motion, *walk.body());
        let points = rim_points(&body, &motion, &walk.toss.spin);
        let [own, other] =
            points.map(|point| carried_now(walk.ground, &body, &motion, &walk.place, point.rx).0);
        // now the own rim is at its ground, and this is how high the other one is above its own
        let clear = 2.0 * body.half * motion.cos - (other - own);
        assert!(clear >= -1e-12, "{clear}");
    }
    assert!(
        own_first > 50 && other_first > 50,
        "{own_first} {other_first}"
    );
}

/// Friction and impacts take energy, and nothing gives any: the budget never grows, and after
/// every event the coin has no more energy than its budget and the lead of slopes but for
/// rounding, 1e-12 of it. (In between, the energy may exceed it by what the next node takes back.)
#[test]
fn no_event_gains_energy() {
    let mut events = 0;
    for (ratio, slope) in [(0.1, 0.02), (0.3, 0.05), (0.7, 0.05), (1.5, 0.1)] {
        let model = Rough::of(ratio, slope).model();
        let ground = model.ground.expect("a rough ground");
        for toss in 0..150 {
            let mut dice = Dice::new(21, toss);
            let lean = dice.between(-0.03, 0.03);
            let launch = Launch {
                height_m: 0.0,
                velocity_m_s: dice.vector(0.3),
                axis: UnitVector3::new_normalize(Vector3::new(1.0, 0.0, lean)),
                spin_rad_s: dice.vector(30.0),
            };
            let mut toss = model.launch(&launch);
            toss.motion.z = toss.motion.rest_height(&model.dynamics.body);
            toss.motion.vz = -toss.motion.vz.abs();
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            walk.put_down();
            walk.lay_out_tracks();
            let (mut next, mut budget) = (Next::Impact, walk.budget);
            while !matches!(next, Next::Ends(_)) {
                next = walk.go_on(next);
                assert!(walk.budget <= budget, "{} {budget}", walk.budget);
                budget = walk.budget;
                // an impact is balanced once it has happened
                if walk.tracks.left == walk.tracks.interval && next != Next::Impact {
                    events += 1;
                    let gain = walk.energy() - budget - walk.lead;
                    assert!(gain <= 1e-12 * budget, "gain {gain:e} of {budget}");
                }
            }
        }
    }
    assert!(events > 1_000, "{events}");
}

/// The gap under the other rim: how high its lowest point is above its track, with the own rim's on its own.
#[test]
fn the_other_rim_is_as_high_above_its_track_as_its_lowest_point() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let mut toss = leaning(&model, 0.3, [0.0; 3]);
    let (mut usage, mut observer) = (Usage::default(), ());
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    (walk.tracks.own.height, walk.tracks.other.height) = (0.03, -0.05);
    let [own, other] = rim_points(walk.body(), &walk.toss.motion, &walk.toss.spin);
    let centre = 0.03 - own.rz;
    let gap = centre + other.rz - -0.05;
    assert!((walk.gap_of_other() - gap).abs() < 1e-15);
}

/// A rim of the tilt θ is as steep as the ground, dz/dy, where z = R sin θ (1 − cos β) and y = R sin β have that ratio.
#[test]
fn a_rim_touches_where_it_is_as_steep_as_the_ground() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let mut toss = leaning(&model, 0.9, [0.0; 3]);
    let (mut usage, mut observer) = (Usage::default(), ());
    let walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    let radius = walk.body().radius;
    for angle in [-2e-3, 1e-3, 5e-3] {
        let (sin, cos) = libm::sincos(angle);
        let steep = walk.toss.motion.sin * sin / cos;
        let ahead = walk.ahead_with([0.7, steep]);
        assert!((ahead / (radius * sin) - 1.0).abs() < 2e-5, "{ahead}");
    }
}

/// A coin is clear of the ground if it leans more than a tenth beyond where it feels it, and will at the next node.
#[test]
fn a_coin_is_clear_while_it_leans_far_until_the_next_node() {
    let model = Rough::of(0.2, 0.002).model();
    let ground = model.ground.expect("a rough ground");
    let felt = ground.felt;
    for (lean, falls, clear) in [
        (1.05 * felt, 0.0, false),
        (1.15 * felt, 0.0, true),
        (1.35 * felt, 0.2 * felt, true),
        (1.35 * felt, 0.3 * felt, false),
        (1.15 * felt, -0.3 * felt, true),
        (1.05 * felt, -0.3 * felt, false),
    ] {
        let angle = libm::asin(lean);
        let mut toss = leaning(&model, angle, [0.0; 3]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        walk.tracks.interval = 0.04;
        let tilt = falls / 0.04;
        set_spin(
            &mut walk,
            Spin {
                tilt,
                ..Spin::still()
            },
        );
        assert_eq!(walk.is_clear(), clear, "{lean} {falls} of {felt}");
    }
}

/// Each half of the way is gone at half of the turn: many short ones make, to first order in their length, the circle of a coin that goes at a constant
/// speed and turns at a constant rate, which is that of the azimuth, −ω_θ/sin θ.
#[test]
fn many_half_ways_make_a_circle() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let [vx, vy] = [0.3, -0.5];
    let mut toss = leaning(&model, 0.6, [vx, vy, 0.0]);
    let (mut usage, mut observer) = (Usage::default(), ());
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    let rate = 1.7;
    let turn = -rate * walk.toss.motion.sin;
    set_spin(
        &mut walk,
        Spin {
            turn,
            ..Spin::still()
        },
    );
    walk.place = Place::at([0.2, 0.1], [0.6, 0.8]);
    let (time, count) = (1.3, 4_000);
    for _ in 0..count {
        walk.half_way(time / f64::from(count));
        walk.half_way(time / f64::from(count));
    }
    let (sin, cos) = libm::sincos(rate * time);
    // the integral of the velocity, turned by 0 to ω t
    let way = [
        (vx * sin - vy * (1.0 - cos)) / rate,
        (vy * sin + vx * (1.0 - cos)) / rate,
    ];
    let lab = |[x, y]: [f64; 2]| [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y];
    let (went, heads) = (lab(way), lab([cos, sin]));
    let (place, direction) = (walk.place.point(0.0, 0.0), walk.place.direction(1.0, 0.0));
    for i in 0..2 {
        assert!(
            (place[i] - [0.2, 0.1][i] - went[i]).abs() < 1e-4,
            "{place:?} {went:?}"
        );
        assert!(
            (direction[i] - heads[i]).abs() < 1e-12,
            "{direction:?} {heads:?}"
        );
    }
}

/// A coin that leaves its track flies high where it rises by more than 2 σ above it and goes farther than 2 ℓ; otherwise it
/// hops. It falls back onto level ground as fast as it left it, so it rises by w²/2 and is in the air for 2w.
#[test]
fn a_coin_flies_high_where_it_lands_on_other_ground() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let rises = |apex: f64| (2.0 * apex * 2.0 * ground.height).sqrt();
    let goes = |share: f64, rising: f64| share * 2.0 * ground.length / (2.0 * rising);
    for (apex, way, high) in [
        (1.1, 1.1, true),
        (0.9, 50.0, false),
        (1.1, 0.9, false),
        (3.0, 1.1, true),
    ] {
        let (rising, track) = (rises(apex), 0.2);
        let along = goes(way, rising);
        let mut toss = leaning(&model, 0.01, [0.0, along, track + rising]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        walk.tracks.own.rate = track;
        let expected = if high {
            Next::Ends(Transition::Flight(Departure::Rebound))
        } else {
            Next::Goes(Touch::Nothing)
        };
        assert_eq!(walk.rise(), expected, "{apex} {way}");
    }
}

/// What slopes gave ahead is taken back from a coin that rises.
#[test]
fn a_coin_that_rises_gives_back_what_slopes_gave_ahead() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let mut toss = leaning(&model, 0.01, [0.0, 0.5, 0.1]);
    let (mut usage, mut observer) = (Usage::default(), ());
    let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
    (walk.lead, walk.budget) = (0.02, walk.energy() - 0.02);
    walk.rise();
    assert_eq!(walk.lead, 0.0);
    assert!((walk.energy() - walk.budget).abs() < 1e-12);
}

/// A toss is given up at its last step, and where its energy is no number; else it goes on.
#[test]
fn a_toss_ends_at_its_last_step_or_without_a_number() {
    let model = Rough::of(0.7, 0.02).model();
    let ground = model.ground.expect("a rough ground");
    let most = Settings::default().max_steps;
    for (steps, budget, ends) in [
        (most - 1, 1.5, false),
        (most, 1.5, true),
        (0, f64::NAN, true),
        (0, f64::INFINITY, true),
    ] {
        let mut toss = leaning(&model, 0.01, [0.0, 0.5, 0.1]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        walk.usage.steps = steps;
        walk.budget = budget;
        assert_eq!(walk.end_now(Touch::Rim).is_some(), ends, "{steps} {budget}");
    }
}

/// A hop ends where a rim comes down to the ground under it, and before that neither rim is in the ground: looked at 300 times
/// along the flight, with nodes so close that the tracks are the ground but for a hundredth of σ. It is a flight: its energy and its
/// time are those of one, and the place on the ground goes on with the coin.
#[test]
fn a_hop_ends_where_a_rim_first_meets_the_ground() {
    let rough = Rough::of(0.5, 0.05);
    let settings = Settings {
        ground_step: 0.05,
        ..Settings::default()
    };
    let model = Model::new(&rough.scene(), &settings, Moreau).expect("valid settings");
    let ground = model.ground.expect("a rough ground");
    let (body, tolerance) = (&model.dynamics.body, 0.02 * ground.height);
    let mut seen = [0; 2];
    for number in 0..120 {
        let mut dice = Dice::new(561, number);
        let velocity = [dice.between(-0.2, 0.2), dice.between(-0.2, 0.2), 0.0];
        let mut toss = leaning(&model, dice.between(-0.02, 0.1), velocity);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let spin = Spin {
            axial: dice.between(-1.0, 1.0),
            turn: dice.between(-1.0, 1.0),
            tilt: dice.between(-0.3, 1.5),
        };
        set_spin(&mut walk, spin);
        walk.put_down();
        // where the other rim would be in the ground, the coin starts above it
        walk.toss.motion.z += dice.between(0.0, 4.0) * ground.height + ground.near;
        walk.toss.motion.vz = dice.between(0.0, 0.12);
        walk.begin_tracks();
        walk.budget = walk.energy();
        let (start, place, energy) = (*walk.toss, walk.place, walk.energy());
        if walk.hop() != Next::Impact {
            continue;
        }
        let (time, now) = (walk.usage.time, walk.toss.motion);
        assert!((walk.energy() - energy).abs() < 1e-9 && (walk.budget - energy).abs() < 1e-9);
        let orbit = crate::flight::Orbit::new(&start.motion, model.dynamics.drag);
        // how high both rims are above the ground, t after the start
        let gaps = |t: f64| {
            let ([dx, dy], from) = model.glide(&start, &orbit, t);
            let (motion, [nx, ny], _): (Motion<f64>, _, _) = orbit.at(&from, t);
            let mut there = place;
            there.shift(dx, dy);
            there.align(nx, ny);
            let spin = motion.spin(model.dynamics.axial_factor);
            rim_points(body, &motion, &spin).map(|point| {
                let under = carried_now(&ground, body, &motion, &there, point.rx).0;
                motion.z + point.rz - under
            })
        };
        for i in 0..300 {
            let [own, other] = gaps(time * f64::from(i) / 300.0);
            assert!(
                own.min(other) > -tolerance,
                "{number}: {own} {other} at {i}"
            );
        }
        let [own, other] = gaps(time);
        assert!(own.min(other).abs() < tolerance, "{number}: {own} {other}");
        seen[usize::from(walk.toss.heads_up != start.heads_up)] += 1;
        // the rim that touches is the own one now, on its track
        let [touches, _] = rim_points(body, &now, &walk.toss.spin);
        assert!((now.z + touches.rz - walk.tracks.own.height).abs() < 1e-12);
        let under = carried_now(&ground, body, &now, &walk.place, touches.rx).0;
        assert!(
            (under - walk.tracks.own.height).abs() < tolerance,
            "{number}"
        );
        assert!((now.vz - (start.motion.vz - time)).abs() < 1e-9, "{number}");
        // nothing changes the spin about the axis, as heads has it
        let spins = |toss: &Toss| {
            if toss.heads_up {
                toss.spin.axial
            } else {
                -toss.spin.axial
            }
        };
        assert!((spins(walk.toss) - spins(&start)).abs() < 1e-12, "{number}");
    }
    assert!(seen.iter().all(|count| *count > 15), "{seen:?}");
}

/// A coin that is put down has its lowest point on the ground under it, with the energy that its height is worth; what is shown of
/// its height goes on.
#[test]
fn a_coin_is_put_down_onto_the_ground_under_it() {
    let model = Rough::of(0.7, 0.05).model();
    let ground = model.ground.expect("a rough ground");
    for angle in [0.1, 0.6] {
        let mut toss = leaning(&model, angle, [0.2, 0.1, -0.3]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        let shown = |walk: &Walk<'_, Moreau, ()>| {
            let toss = &walk.toss;
            toss.place
                .state(&toss.motion, &toss.spin, true, &walk.model.units)
                .position_m
                .z
        };
        let (before, height) = (shown(&walk), walk.toss.motion.z);
        walk.put_down();
        let [own, _] = rim_points(walk.body(), &walk.toss.motion, &walk.toss.spin);
        let under = carried_now(&ground, walk.body(), &walk.toss.motion, &walk.place, own.rx).0;
        assert!((walk.toss.motion.z + own.rz - under).abs() < 1e-12 && under.abs() > 1e-6);
        assert!((walk.tracks.own.height - under).abs() < 1e-12);
        assert!((walk.energy() - walk.budget).abs() < 1e-12);
        assert!((shown(&walk) - before).abs() < 1e-12 && walk.toss.motion.z != height);
    }
}

/// A coin that leaves the rough ground counts its height from the ground under its own rim, no lower than it can lie, with its axis
/// up; what is shown of its height goes on.
#[test]
fn a_coin_that_leaves_counts_its_height_from_its_own_track() {
    let model = Rough::of(0.7, 0.05).model();
    let ground = model.ground.expect("a rough ground");
    for (angle, above, points_down) in [(0.1, 0.02, false), (0.1, -0.02, false), (-0.1, 0.02, true)]
    {
        let mut toss = leaning(&model, 0.1, [0.2, 0.1, -0.3]);
        let (mut usage, mut observer) = (Usage::default(), ());
        let mut walk = Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
        (walk.tracks.own.height, walk.tracks.other.height) = (0.3, 0.3);
        let rest = walk.toss.motion.rest_height(walk.body());
        walk.toss.motion.z = rest + 0.3 + above;
        if points_down {
            walk.toss.motion.cos = -walk.toss.motion.cos;
        }
        let heads_up = walk.toss.heads_up;
        let shown = |walk: &Walk<'_, Moreau, ()>| {
            let toss = &walk.toss;
            toss.place
                .state(&toss.motion, &toss.spin, true, &walk.model.units)
                .position_m
                .z
        };
        let before = shown(&walk);
        walk.leave();
        assert!(
            (walk.toss.motion.z - (rest + above.max(0.0))).abs() < 1e-12,
            "{angle} {above}"
        );
        assert!((shown(&walk) - before).abs() < 1e-12, "{angle} {above}");
        assert_eq!(walk.toss.heads_up != heads_up, points_down);
        assert!(walk.toss.motion.cos > 0.0);
    }
}
