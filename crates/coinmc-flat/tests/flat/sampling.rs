//! The coin between events obeys the laws of motion, and sampling does not change the toss.

use crate::common::{Moment, Section, Start, engine, engine_with, moment};
use crate::contact_phases::{phase, world};
use coinmc_core::{Engine, Event, EventKind, Launch, Outcome, Preset, Scene};
use coinmc_flat::{FlatEngine, Moreau, Settings};
use coinmc_testkit::{
    Dice, Recorder, Sampler, conformance, preset_launch, samples_beside_events, scene,
};

/// All kinds of motion: rocking, sliding, pivoting, frictionless, bouncing, thin, thick.
const SCENES: [(f64, f64, f64); 6] = [
    (1.0, 0.0, 0.3),
    (0.2, 0.0, 1.0),
    (1.0, 0.0, 0.0),
    (1.2, 0.5, 0.3),
    (2.0, 0.7, 0.0),
    (20.0, 0.5, 0.3),
];

fn sampled(engine: &FlatEngine<Moreau>, launch: &Launch, rate: f64) -> (Outcome, Sampler) {
    let mut sampler = Sampler::new(rate);
    let outcome = engine.toss(&mut (), launch, &mut sampler);
    (outcome, sampler)
}

fn launches(scene: &Scene, seed: u64, count: u64) -> Vec<Launch> {
    let launch = |toss| preset_launch(Preset::CleanFlat, scene, seed, toss);
    (0..count).map(launch).collect()
}

#[test]
fn sampling_changes_nothing() {
    let mut samples = 0;
    for (ratio, restitution, friction) in SCENES {
        let scene = scene(ratio, restitution, friction);
        let (engine, launches) = (engine(&scene), launches(&scene, 92, 500));
        let rates = [7.0, 100.0, 1000.0];
        samples += conformance::observers_change_nothing(&engine, &launches, &rates);
    }
    assert!(samples > 1_000_000, "{samples}");
}

#[test]
fn a_sample_does_not_depend_on_the_others() {
    for (ratio, restitution, friction) in SCENES {
        let scene = scene(ratio, restitution, friction);
        let launches = launches(&scene, 93, 200);
        conformance::samples_do_not_depend_on_the_rate(&engine(&scene), &launches);
    }
}

/// The pieces of a toss: an event, the samples after it, the next event.
fn pieces(scene: &Scene, sampler: &Sampler) -> Vec<(Moment, Vec<Moment>, Moment)> {
    let moments = |events: &[Event]| -> Vec<Moment> {
        events
            .iter()
            .map(|event| moment(scene, event.kind, &event.state))
            .collect()
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

/// The difference of two angles, in [−π, π).
fn angle_between(a: f64, b: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    (a - b + turn / 2.0).rem_euclid(turn) - turn / 2.0
}

/// Flights are parabolas with constant spin. A toss lasts about 20 sqrt(D/g), in which angle and
/// height are known to about 1e-14: 1e-12 is a hundred times that.
#[test]
fn flights_are_parabolas() {
    let (mut seen, mut worst, mut worst_energy) = (0, 0.0_f64, 0.0_f64);
    for (ratio, restitution, friction) in SCENES {
        let scene = scene(ratio, restitution, friction);
        let (engine, section) = (engine(&scene), Section::new(&scene));
        for toss in 0..300 {
            let launches = [Preset::Robot, Preset::CleanFlat][(toss % 2) as usize];
            let launch = preset_launch(launches, &scene, 94, toss);
            let (_, sampler) = sampled(&engine, &launch, 500.0);
            for (from, within, _) in pieces(&scene, &sampler) {
                if matches!(from.kind, EventKind::Sticking | EventKind::Sliding) {
                    continue;
                }
                for m in within {
                    let t = m.time - from.time;
                    seen += 1;
                    for error in [
                        m.x - (from.x + from.vx * t),
                        m.z - (from.z + t * (from.vz - 0.5 * t)),
                        m.vz - (from.vz - t),
                        m.vx - from.vx,
                        angle_between(m.theta, from.theta + from.omega * t),
                        m.omega - from.omega,
                    ] {
                        worst = worst
                            .max(error.abs() / (1.0 + t * (from.omega.abs() + from.vz.abs() + t)));
                    }
                    worst_energy = worst_energy
                        .max((m.energy(section.k) / from.energy(section.k) - 1.0).abs());
                    let gap = m.z - section.reach(m.theta);
                    assert!(gap > -1e-9, "{gap:e} {from:?} {m:?}");
                }
            }
        }
    }
    println!("{seen} samples: {worst:e}, energy {worst_energy:e}");
    assert!(seen > 100_000, "{seen}");
    assert!(worst < 1e-13, "{worst:e}");
    assert!(worst_energy < 1e-12, "{worst_energy:e}");
}

#[derive(Debug, Default)]
struct Contacts {
    stuck: u32,
    slid: u32,
    smooth: u32,
    worst: f64,
    rise: f64,
    rim_m: f64,
}

/// Samples of contact phases against Newton and Euler's equations in world coordinates.
fn contacts(tolerance: f64) -> Contacts {
    let settings = Settings {
        tolerance,
        ..Settings::default()
    };
    let mut seen = Contacts::default();
    for (ratio, mu) in [
        (1.0, 0.3),
        (1.0, 0.0),
        (0.3, 0.5),
        (0.3, 0.0),
        (2.0, 0.7),
        (2.0, 0.1),
    ] {
        let scene = scene(ratio, 0.0, mu);
        let (engine, section) = (engine_with(&scene, settings), Section::new(&scene));
        for toss in 0..150 {
            let start = Start::lively(&mut Dice::new(95, toss));
            let (_, sampler) = sampled(&engine, &start.launch(&scene), 400.0);
            for (from, within, to) in pieces(&scene, &sampler) {
                if matches!(from.kind, EventKind::Sticking | EventKind::Sliding)
                    && !within.is_empty()
                {
                    contact(&section, mu, &from, &within, &to, &mut seen);
                }
            }
        }
    }
    println!("{tolerance:e}: {seen:?}");
    assert!(
        seen.stuck > 500 && seen.slid > 500 && seen.smooth > 500,
        "{seen:?}"
    );
    // heights are sums of numbers of the size of the coin
    assert!(seen.rim_m < 1e-16, "{seen:?}");
    // a part of a step and the whole step have separate errors within the tolerance
    assert!(seen.rise < 1e-11, "{seen:?}");
    seen
}

fn contact(
    section: &Section,
    mu: f64,
    from: &Moment,
    within: &[Moment],
    to: &Moment,
    seen: &mut Contacts,
) {
    let (body, mode) = phase(section, mu, from, to);
    let (mut y, mut time, mut energy) = (world(from), from.time, from.energy(section.k));
    for m in within {
        y = body.integrate(y, mode, m.time - time, |_| {});
        time = m.time;
        let found = world(m);
        for i in 0..6 {
            let error = if i == 2 {
                angle_between(y[2], found[2])
            } else {
                y[i] - found[i]
            };
            seen.worst = seen.worst.max(error.abs());
        }
        seen.rise = seen.rise.max(m.energy(section.k) / energy - 1.0);
        energy = m.energy(section.k);
        seen.rim_m = seen.rim_m.max((m.z - section.reach(m.theta)).abs() * 0.01);
        match from.kind {
            EventKind::Sticking => seen.stuck += 1,
            _ if mu == 0.0 => seen.smooth += 1,
            _ => seen.slid += 1,
        }
    }
}

/// The reference is accurate to 1e-12, the angle at a time to 1e-10, and slides are integrated to
/// 1e-12 per step: 1e-9 leaves room for the amplification by the motion.
#[test]
fn contact_follows_newton_and_euler() {
    let seen = contacts(1e-12);
    assert!(seen.worst < 1e-9, "{seen:?}");
}

/// As in the test of whole phases.
#[test]
fn contact_at_the_default_tolerance_follows_newton_and_euler() {
    let seen = contacts(Settings::default().tolerance);
    assert!(seen.worst < 1e-4, "{seen:?}");
}

/// A nanosecond from an event the coin is where it is at the event, up to its motion in that time
/// and the error of the step: 1e-10 of a unit.
#[test]
fn samples_join_the_events() {
    const NEAR: f64 = 1e-9;
    let settings = Settings {
        tolerance: 1e-12,
        ..Settings::default()
    };
    let mut joints = 0;
    for (ratio, restitution, friction) in SCENES {
        let scene = scene(ratio, restitution, friction);
        let engine = engine_with(&scene, settings);
        for toss in 0..200 {
            let launch = preset_launch(Preset::CleanFlat, &scene, 96, toss);
            let mut recorder = Recorder::default();
            engine.toss(&mut (), &launch, &mut recorder);
            let joined = samples_beside_events(&recorder.0, NEAR, |instants| {
                engine.toss(&mut (), &launch, instants);
            });
            for (event, sample) in &joined {
                let (a, b) = (
                    moment(&scene, event.kind, &event.state),
                    moment(&scene, event.kind, sample),
                );
                let passed = (b.time - a.time).abs();
                let speed = 1.0 + a.vx.abs() + a.vz.abs() + a.omega.abs();
                for (difference, rate) in [
                    (a.x - b.x, speed),
                    (a.z - b.z, speed),
                    (angle_between(a.theta, b.theta), speed),
                    // contact accelerates by some (1 + ω²)(1 + μ)/k
                    (a.vx - b.vx, 100.0 * speed * speed),
                    (a.omega - b.omega, 100.0 * speed * speed),
                ] {
                    assert!(
                        difference.abs() <= 1e-10 + passed * rate,
                        "{difference:e} {a:?} {b:?}"
                    );
                }
                joints += 1;
            }
        }
    }
    assert!(joints > 15_000, "{joints}");
}
