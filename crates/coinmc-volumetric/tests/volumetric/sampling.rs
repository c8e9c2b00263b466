//! Samples of the coin between events: they obey the laws of motion, and do not affect the toss.

use crate::common::{Moment, Start, Tosser, moment};
use coinmc_core::{Drag, Event, EventKind, Launch, Outcome, Preset, Roughness, Scene};
use coinmc_oracle::newton_euler::{Contact, Twist, runge_kutta, slip};
use coinmc_oracle::{Model, Motion};
use coinmc_testkit::{
    Dice, Recorder, Sampler, conformance, preset_launch, rolling_scene, samples_beside_events,
};
use coinmc_volumetric::{Decision, Settings};
use nalgebra::Vector3;

/// Every kind of motion: bouncing, rocking, sliding, rolling on the rim and on the side; thin and
/// thick coins; with drag, without friction and without gyroscopic torque.
fn scenes() -> Vec<Scene> {
    let air = |scene: Scene| scene.with_drag(Drag::new(0.5, 2.0).expect("valid rates"));
    vec![
        rolling_scene(0.85, 0.5, 0.3, 0.01),
        rolling_scene(0.85, 0.0, 0.3, 0.01),
        rolling_scene(0.1, 0.3, 0.5, 0.003),
        rolling_scene(3.0, 0.0, 0.3, 0.01),
        rolling_scene(1.5, 0.6, 0.0, 0.01),
        air(rolling_scene(1.0, 0.3, 0.3, 0.01)),
        rolling_scene(1.2, 0.4, 0.3, 0.01).with_gyroscopic_torque(false),
    ]
}

/// A thin coin on rough ground, and the standard deviation of that ground's height, in the distance of the rims.
fn rough_scene() -> (Scene, f64) {
    let (slope, wavelength) = (0.03, 3e-3);
    let plane = rolling_scene(0.3, 0.3, 0.3, 0.003);
    let roughness = Roughness::new(slope, wavelength).ok();
    let surface = plane.surface.with_roughness(roughness);
    let scene = Scene::new(plane.coin, surface, Scene::STANDARD_GRAVITY_M_S2);
    let deviation = slope * wavelength / std::f64::consts::TAU;
    let distance = plane.coin.rim_distance_m();
    (scene.expect("a valid scene"), deviation / distance)
}

fn sampled(tosser: &Tosser, launch: &Launch, rate: f64) -> (Outcome, Sampler) {
    let mut sampler = Sampler::new(rate);
    let outcome = tosser.observe(launch, &mut sampler);
    (outcome, sampler)
}

fn launches(scene: &Scene, seed: u64, count: u64) -> Vec<Launch> {
    let launch = |toss| preset_launch(Preset::Clean, scene, seed, toss);
    (0..count).map(launch).collect()
}

#[test]
fn sampling_changes_nothing() {
    let mut samples = 0;
    for scene in scenes() {
        let (tosser, launches) = (Tosser::new(&scene), launches(&scene, 400, 120));
        let rates = [7.0, 100.0, 1000.0];
        samples += conformance::observers_change_nothing(&tosser.0, &launches, &rates);
    }
    assert!(samples > 300_000, "{samples}");
}

#[test]
fn a_sample_does_not_depend_on_the_others() {
    for scene in scenes() {
        let launches = launches(&scene, 401, 100);
        conformance::samples_do_not_depend_on_the_rate(&Tosser::new(&scene).0, &launches);
    }
}

/// The pieces of a toss: an event, the samples after it, and the next event.
fn pieces(scene: &Scene, sampler: &Sampler) -> Vec<(Moment, Vec<Moment>, Moment)> {
    let moments = |events: &[Event]| -> Vec<Moment> {
        events.iter().map(|event| moment(scene, event)).collect()
    };
    let (events, samples) = (moments(&sampler.events), moments(&sampler.samples));
    let mut rest = samples.into_iter().peekable();
    events
        .windows(2)
        .map(|pair| {
            let mut within = Vec::new();
            while let Some(sample) = rest.next_if(|sample| sample.time < pair[1].time) {
                within.push(sample);
            }
            (pair[0], within, pair[1])
        })
        .collect()
}

fn is_contact(from: &Moment) -> bool {
    matches!(from.kind, EventKind::Sticking | EventKind::Sliding)
}

/// The largest difference of two motions.
fn apart(a: &Motion, b: &Motion) -> f64 {
    [
        a.position - b.position,
        a.velocity - b.velocity,
        a.axis - b.axis,
        a.spin - b.spin,
    ]
    .iter()
    .map(nalgebra::Matrix::amax)
    .fold(0.0, f64::max)
}

/// Flights against the closed form of the oracle, by vectors in the laboratory frame. Times are
/// known to one unit in the last place, and angular velocities reach a few tens: a few 1e-13.
#[test]
fn flights_are_those_of_a_free_top() {
    let (mut seen, mut worst, mut worst_energy) = (0, 0.0_f64, 0.0_f64);
    for scene in scenes() {
        let (tosser, model) = (Tosser::new(&scene), Model::new(&scene));
        let conserves = scene.has_gyroscopic_torque() && scene.drag() == Drag::default();
        for toss in 0..200 {
            let launch = preset_launch(Preset::Clean, &scene, 402, toss);
            let (_, sampler) = sampled(&tosser, &launch, 500.0);
            for (from, within, _) in pieces(&scene, &sampler) {
                if is_contact(&from) {
                    continue;
                }
                for sample in within {
                    let mut motion = from.motion;
                    motion.fly(&model, sample.time - from.time);
                    seen += 1;
                    worst = worst.max(apart(&motion, &sample.motion));
                    let gap = sample.motion.gap(&model);
                    assert!(gap > -1e-9, "{gap:e} {from:?} {sample:?}");
                    if conserves {
                        let gain = sample.motion.energy(&model) / from.motion.energy(&model) - 1.0;
                        worst_energy = worst_energy.max(gain.abs());
                    }
                }
            }
        }
    }
    println!("{seen} samples: {worst:e}, energy {worst_energy:e}");
    assert!(seen > 100_000, "{seen}");
    assert!(worst < 1e-11, "{worst:e}");
    assert!(worst_energy < 1e-12, "{worst_energy:e}");
}

#[derive(Debug, Default)]
struct Contacts {
    stuck: u32,
    slid: u32,
    worst: f64,
    rise: f64,
    rim_m: f64,
}

/// Integrates contact closely, for the time of a few turns.
fn tight() -> Settings {
    Settings {
        decision: Decision::Energy,
        tolerance: 1e-10,
        stick_speed: 1e-6,
        smoothing_time: 1e-6,
        time_limit: 10.0,
        ..Settings::default()
    }
}

/// Samples of one phase against the nine equations of the oracle, by the classical Runge–Kutta
/// method in steps of 1/1000 of the fastest time scale, from sample to sample. Left out: what those
/// steps do not resolve (a slip so slow that its direction may turn faster, an almost flat coin),
/// and everything after 3 units of time, as some of these motions are unstable.
fn contact(model: &Model, from: &Moment, within: &[Moment], seen: &mut Contacts) {
    let sticks = from.kind == EventKind::Sticking;
    let mode = |motion: &Motion| {
        let contact = if sticks {
            Contact::Stick
        } else {
            Contact::Slip(slip(model, motion).normalize())
        };
        (contact, Twist::default())
    };
    let (mut motion, mut time) = (from.motion, from.time);
    let mut energy = from.motion.energy(model);
    for sample in within {
        let gone = sample.time - time;
        let is_blurred =
            |motion: &Motion| motion.sine() < 0.1 || !sticks && slip(model, motion).norm() < 0.3;
        if is_blurred(&motion) || is_blurred(&sample.motion) || sample.time - from.time > 3.0 {
            return;
        }
        let fastest = 1.0 + motion.spin.norm() / motion.sine();
        // a nonnegative number of steps, a few hundred
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let steps = (1000.0 * fastest * gone).ceil().max(1.0) as u32;
        for _ in 0..steps {
            motion = runge_kutta(model, &motion, gone / f64::from(steps), mode);
        }
        time = sample.time;
        let found = &sample.motion;
        seen.worst = seen
            .worst
            .max(apart(&motion, found) / (1.0 + motion.spin.norm()));
        seen.rise = seen.rise.max(found.energy(model) / energy - 1.0);
        energy = found.energy(model);
        seen.rim_m = seen.rim_m.max(found.gap(model).abs() * 0.01);
        *(if sticks {
            &mut seen.stuck
        } else {
            &mut seen.slid
        }) += 1;
    }
}

fn contacts(settings: &Settings) -> Contacts {
    let mut seen = Contacts::default();
    for (ratio, rim, mu) in [
        (0.85, 0.0, 0.3),
        (0.3, 0.0, 0.5),
        (2.0, 0.0, 0.7),
        (0.1, 0.0, 0.2),
        (0.85, 0.3, 0.3),
        (0.3, 0.1, 0.5),
    ] {
        let mut scene = rolling_scene(ratio, 0.0, mu, 0.0);
        let rim_m = rim * scene.coin.radius_m();
        scene.coin = scene
            .coin
            .with_rim_radius(rim_m)
            .expect("a thin enough rim");
        let (tosser, model) = (Tosser::with(&scene, settings), Model::new(&scene));
        for toss in 0..40 {
            let mut start = Start::lively(&mut Dice::new(403, toss));
            start.z = start.z.min(2.0);
            let (_, sampler) = sampled(&tosser, &start.launch(&scene), 400.0);
            for (from, within, _) in pieces(&scene, &sampler) {
                // on its side the coin touches with both rims
                if is_contact(&from) && from.motion.axis.z.abs() > 1e-9 {
                    contact(&model, &from, &within, &mut seen);
                }
            }
        }
    }
    println!("{settings:?}: {seen:?}");
    assert!(seen.stuck > 2000 && seen.slid > 1000, "{seen:?}");
    assert!(seen.rim_m < 1e-15, "{seen:?}");
    seen
}

#[test]
fn contact_obeys_newton_and_euler() {
    let seen = contacts(&tight());
    assert!(seen.worst < 1e-6, "{seen:?}");
    assert!(seen.rise < 1e-10, "{seen:?}");
}

#[test]
fn contact_at_the_default_tolerance_is_close() {
    let seen = contacts(&Settings {
        time_limit: 10.0,
        ..Settings::default()
    });
    assert!(seen.worst < 0.02, "{seen:?}");
    // tolerance 2e-4, in a few tens of steps
    assert!(seen.rise < 1e-2, "{seen:?}");
}

/// The engine has the end of rolling on the side in closed form, v' = −a − bv; here it is
/// integrated.
#[test]
fn samples_of_rolling_continue_to_the_end() {
    for drag in [0.0, 0.5] {
        let scene = rolling_scene(1.0, 0.0, 0.3, 0.01)
            .with_drag(Drag::new(drag, 0.0).expect("a good rate"));
        let model = Model::new(&scene);
        let (radius, r2) = (model.radius, model.radius * model.radius);
        let inertia = model.axial + r2;
        let (a, b) = (
            model.contour * radius / inertia,
            model.linear_drag * r2 / inertia,
        );
        let start = Start {
            z: radius,
            velocity: Vector3::new(0.0, 3.0, 0.0),
            axis: Vector3::x(),
            spin: Vector3::new(-3.0 / radius, 0.0, 0.0),
        };
        let (_, sampler) = sampled(&Tosser::with(&scene, &tight()), &start.launch(&scene), 50.0);
        let rolling = pieces(&scene, &sampler)
            .into_iter()
            .find(|(from, ..)| from.kind == EventKind::Sticking);
        let (from, within, to) = rolling.expect("it rolls");
        assert!(within.len() > 100, "{}", within.len());
        let (mut y, mut v, mut time) = (from.motion.position.y, from.motion.velocity.y, from.time);
        for sample in within.iter().chain([&to]) {
            let gone = sample.time - time;
            // the trapezoidal rule over 100 pieces: error 1e-4 of h³v''/12
            for _ in 0..100 {
                let h = gone / 100.0;
                let after = (v * (1.0 - 0.5 * b * h) - a * h) / (1.0 + 0.5 * b * h);
                y += 0.5 * h * (v + after);
                v = after;
            }
            time = sample.time;
            assert!(
                (sample.motion.velocity.y - v).abs() < 1e-6,
                "{v} {sample:?}"
            );
            assert!(
                (sample.motion.position.y - y).abs() < 1e-5,
                "{y} {sample:?}"
            );
            assert!(
                (sample.motion.spin.x * radius + v).abs() < 1e-5,
                "{v} {sample:?}"
            );
            assert!(sample.motion.gap(&model).abs() < 1e-12);
        }
        assert_eq!(to.motion.velocity, Vector3::zeros());
    }
}

/// A nanosecond before or after an event, the coin is where the event shows it, apart from its
/// motion in that time and the error of the step that led there. On rough ground a coin lands on ground that is
/// drawn as it touches, and is then shown at most five standard deviations of its height higher or lower.
#[test]
fn samples_join_the_events() {
    const NEAR: f64 = 1e-9;
    let mut joints = 0;
    let (rough, deviation) = rough_scene();
    let even = scenes().into_iter().map(|scene| (scene, 1e-7));
    for (scene, error) in even.chain([(rough, 5.0 * deviation)]) {
        let settings = Settings {
            tolerance: 1e-10,
            ..Settings::default()
        };
        let tosser = Tosser::with(&scene, &settings);
        for toss in 0..40 {
            let launch = preset_launch(Preset::Clean, &scene, 404, toss);
            let mut recorder = Recorder::default();
            tosser.observe(&launch, &mut recorder);
            let joined = samples_beside_events(&recorder.0, NEAR, |instants| {
                tosser.observe(&launch, instants);
            });
            for (event, sample) in &joined {
                let beside = Event {
                    state: *sample,
                    ..*event
                };
                let (a, b) = (moment(&scene, event), moment(&scene, &beside));
                let passed = (b.time - a.time).abs();
                let speed = 1.0 + a.motion.velocity.norm() + a.motion.spin.norm();
                let moved = (a.motion.position - b.motion.position).norm();
                let turned = (a.motion.axis - b.motion.axis).norm();
                assert!(
                    moved.max(turned) <= error + 2.0 * passed * speed,
                    "{moved:e} {turned:e} in {passed:e}: {a:?} {b:?}"
                );
                joints += 1;
            }
        }
    }
    assert!(joints > 3_000, "{joints}");
}
