//! Flight: it agrees with its equations, conserves what it should, and misses no contact.

use crate::common::{Moment, Start, Tosser, flights};
use coinmc_core::{Coin, Drag, EventKind, Scene, Surface};
use coinmc_oracle::{Model, Motion};
use coinmc_testkit::Dice;
use coinmc_volumetric::Settings;
use nalgebra::Vector3;

/// The highest angular velocity during a flight.
fn turning(model: &Model, motion: &Motion) -> f64 {
    let momentum = model.inertia(&motion.axis) * motion.spin;
    motion.spin.norm().max(momentum.norm() / model.transverse)
}

/// Times at which a flight is examined: 400 over the whole flight, and where the coin is low enough
/// to touch, at least one per 1/20 rad of rotation (2000 at most).
fn looks(model: &Model, from: &Moment, time: f64) -> Vec<f64> {
    let evenly = |from: f64, to: f64, n: u32| {
        (1..n).map(move |i| from + (to - from) * f64::from(i) / f64::from(n))
    };
    let low = |t: f64| {
        let mut motion = from.motion;
        motion.fly(model, t);
        motion.position.z < 1.0
    };
    let all: Vec<f64> = evenly(0.0, time, 400).collect();
    let mut looks = all.clone();
    // a nonnegative number, a few thousand at most
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let fine = (20.0 * turning(model, &from.motion) * time / 400.0).min(2000.0) as u32;
    let lows: Vec<f64> = all.into_iter().filter(|t| low(*t)).collect();
    if fine > 1 && !lows.is_empty() {
        let lows_count = u32::try_from(lows.len()).expect("at most 400");
        let each = (fine * 400 / lows_count).clamp(2, fine.max(2));
        for t in lows {
            looks.extend(evenly(t, t + time / 400.0, each.min(50)));
        }
    }
    looks
}

#[derive(Debug, Default)]
struct Seen {
    flights: u32,
    deepest: f64,
    rim: f64,
    energy: f64,
    momentum: f64,
    drift: f64,
}

/// Searches for contacts within the flight. Rounding changes the gap by 1e-16 of the phase and of
/// the height covered.
fn scan(model: &Model, from: &Moment, to: &Moment, seen: &mut Seen, what: &dyn Fn() -> String) {
    seen.flights += 1;
    let time = to.time - from.time;
    let phase = turning(model, &from.motion) * time;
    let speed = from.motion.velocity.z.abs() + time;
    // the time is known to 1e-16 of the duration of the toss
    let blur = 1e-12 + 1e-15 * (phase + speed * time + (speed + phase / time) * to.time);
    for t in looks(model, from, time) {
        let mut motion = from.motion;
        motion.fly(model, t);
        let gap = motion.gap(model);
        seen.deepest = seen.deepest.max(-gap);
        assert!(gap > -blur, "{gap:e} at {t} of {time}: {from:?} {}", what());
    }
    let rim = to.motion.gap(model).abs();
    seen.rim = seen.rim.max(rim);
    assert!(rim <= 1e-12, "{rim:e} off the surface: {to:?} {}", what());
    // where both closed forms end
    let mut motion = from.motion;
    motion.fly(model, time);
    let drift = (motion.axis - to.motion.axis)
        .norm()
        .max((motion.position - to.motion.position).norm())
        .max((motion.velocity - to.motion.velocity).norm())
        .max((motion.spin - to.motion.spin).norm() / (1.0 + motion.spin.norm()));
    seen.drift = seen.drift.max(drift / blur);
    assert!(drift <= 1e3 * blur, "{drift:e}: {from:?} {to:?} {}", what());
}

/// Without torque and drag the energy, the angular momentum and the horizontal velocity are
/// conserved. The axial spin is L·u/I_a: the rounding of u, 1e-16, is multiplied by I_t/I_a in each
/// flight, which matters for rods.
fn conserves(model: &Model, from: &Motion, to: &Motion, seen: &mut Seen) {
    let (before, after) = (from.energy(model), to.energy(model));
    let energy = (after / before - 1.0).abs();
    let momentum = |m: &Motion| model.inertia(&m.axis) * m.spin;
    let (before, after) = (momentum(from), momentum(to));
    let turned = (after - before).norm() / before.norm().max(1e-300);
    seen.energy = seen.energy.max(energy);
    seen.momentum = seen.momentum.max(turned);
    let bound = 1e-12 + 1e-15 * model.transverse / model.axial;
    assert!(energy <= bound, "energy {energy:e}: {from:?} {to:?}");
    assert!(turned <= bound, "momentum {turned:e}: {from:?} {to:?}");
    let pushed = (from.velocity - to.velocity).xy().norm();
    assert!(pushed <= 1e-12 * (1.0 + from.velocity.norm()), "{pushed:e}");
}

/// A random scene and launch of one kind.
fn case(seed: u64, trial: u64, spin: f64, dragged: bool, gyroscopic: bool) -> (Scene, Start) {
    let mut dice = Dice::new(seed, trial);
    let ratio = match trial % 4 {
        0 => dice.scale(1e-3, 0.1),
        1 => dice.scale(5.0, 1e3),
        _ => dice.scale(0.1, 5.0),
    };
    let surface = Surface::new(dice.between(0.3, 0.9), dice.between(0.0, 1.0)).unwrap();
    let surface = surface.with_friction_lengths(1e-4, 1e-4).unwrap();
    let coin = Coin::cylinder(ratio, 0.01).unwrap();
    let mut scene = Scene::new(coin, surface, 9.81)
        .unwrap()
        .with_gyroscopic_torque(gyroscopic);
    if dragged {
        let time = scene.time_scale_s();
        let rate = dice.scale(1e-3, 3.0) / time;
        scene = scene.with_drag(Drag::new(rate, dice.between(0.0, 1.0) / time).unwrap());
    }
    let start = Start {
        z: dice.scale(1.0, 100.0),
        velocity: dice.vector(3.0),
        axis: dice.direction(),
        spin: dice.direction() * dice.scale(1e-2, spin),
    };
    (scene, start)
}

fn fly(seed: u64, tosses: u64, spin: f64, dragged: bool, gyroscopic: bool) -> Seen {
    let mut seen = Seen::default();
    let settings = Settings {
        max_impacts: 40,
        max_steps: 2000,
        ..Settings::default()
    };
    for trial in 0..tosses {
        let (scene, start) = case(seed, trial, spin, dragged, gyroscopic);
        let model = Model::new(&scene);
        let (_, moments) = Tosser::with(&scene, &settings).record(&scene, &start.launch(&scene));
        for (from, to) in flights(&moments) {
            let what = || format!("trial {trial}, ratio {}", scene.coin.ratio());
            scan(&model, from, to, &mut seen, &what);
            if !dragged && gyroscopic {
                conserves(&model, &from.motion, &to.motion, &mut seen);
            }
        }
    }
    println!("{spin} {dragged} {gyroscopic}: {seen:?}");
    seen
}

#[test]
fn no_contact_is_missed_and_nothing_is_lost() {
    assert!(fly(200, 1500, 10.0, false, true).flights > 12_000);
    assert!(fly(201, 300, 1000.0, false, true).flights > 3000);
}

#[test]
fn no_contact_is_missed_under_drag() {
    assert!(fly(202, 1000, 10.0, true, true).flights > 5000);
    assert!(fly(203, 300, 100.0, true, false).flights > 1000);
}

#[test]
fn no_contact_is_missed_without_gyroscopic_torque() {
    assert!(fly(204, 800, 30.0, false, false).flights > 5000);
}

/// v' = −kv − ẑ, u' = ω × u and L' = −k'L (or, without gyroscopic torque, ω' = −k'ω), by the
/// classical Runge–Kutta method in steps of 1/200 of the fastest time scale. The error of a step is
/// (1/200)⁵/120: 1e-10 in a phase of 100.
fn integrated(model: &Model, from: &Motion, time: f64) -> Motion {
    let spin = |axis: &Vector3<f64>, turning: &Vector3<f64>| {
        if model.gyroscopic {
            model.inverse_inertia(axis) * turning
        } else {
            *turning
        }
    };
    let turning = if model.gyroscopic {
        model.inertia(&from.axis) * from.spin
    } else {
        from.spin
    };
    let slope = |y: &[Vector3<f64>; 4]| {
        let [_, v, u, l] = *y;
        let fall = -v * model.linear_drag - Vector3::z();
        [v, fall, spin(&u, &l).cross(&u), -l * model.angular_drag]
    };
    let ahead = |y: &[Vector3<f64>; 4], k: &[Vector3<f64>; 4], h: f64| {
        std::array::from_fn::<_, 4, _>(|i| y[i] + k[i] * h)
    };
    let mut y = [from.position, from.velocity, from.axis, turning];
    let fastest = 1.0 + from.spin.norm() + model.linear_drag;
    // a nonnegative number of steps, a few thousand
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let steps = (200.0 * fastest * time).ceil() as u32;
    let h = time / f64::from(steps);
    for _ in 0..steps {
        let a = slope(&y);
        let b = slope(&ahead(&y, &a, h / 2.0));
        let c = slope(&ahead(&y, &b, h / 2.0));
        let d = slope(&ahead(&y, &c, h));
        y = std::array::from_fn(|i| y[i] + (a[i] + (b[i] + c[i]) * 2.0 + d[i]) * (h / 6.0));
    }
    Motion {
        position: y[0],
        velocity: y[1],
        axis: y[2],
        spin: spin(&y[2], &y[3]),
    }
}

#[test]
fn flight_obeys_its_equations() {
    let mut worst: f64 = 0.0;
    let mut flights = 0;
    for trial in 0..400 {
        let (dragged, gyroscopic) = (trial % 2 == 0, trial % 3 != 0);
        let (scene, mut start) = case(205, trial, 10.0, dragged, gyroscopic);
        start.z = start.z.min(10.0);
        let model = Model::new(&scene);
        let (_, moments) = Tosser::new(&scene).record(&scene, &start.launch(&scene));
        let Some([from, to]) = moments.first_chunk() else {
            continue;
        };
        if to.kind != EventKind::Touching {
            continue;
        }
        flights += 1;
        let arrived = integrated(&model, &from.motion, to.time);
        let momentum = |m: &Motion| model.inertia(&m.axis) * m.spin / model.transverse;
        for (a, b) in [
            (arrived.position, to.motion.position),
            (arrived.velocity, to.motion.velocity),
            (arrived.axis, to.motion.axis),
            (momentum(&arrived), momentum(&to.motion)),
        ] {
            worst = worst.max((a - b).norm() / (1.0 + b.norm()));
        }
    }
    println!("{flights} flights, worst {worst:e}");
    assert!(flights > 350 && worst < 1e-9, "{flights} {worst:e}");
}
