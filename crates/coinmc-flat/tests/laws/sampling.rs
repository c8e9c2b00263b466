//! Samples within an impact that lasts follow the law.

use crate::common::{line, pulse, settings, touch};
use coinmc_core::{Engine, Event, EventKind, Launch, Observer, Scene, State};
use coinmc_flat::Law;
use coinmc_testkit::{Dice, scene};
use std::f64::consts::PI;

/// Samples a number of equally spaced instants within the first impact.
struct Film {
    from_s: f64,
    every_s: f64,
    taken: u32,
    of: u32,
    seen: Vec<State>,
    touched: Option<State>,
    released: Option<State>,
}

impl Observer for Film {
    fn event(&mut self, event: &Event) {
        match event.kind {
            EventKind::Touching if self.touched.is_none() => self.touched = Some(event.state),
            EventKind::Impact if self.released.is_none() => self.released = Some(event.state),
            _ => {}
        }
    }

    fn wants_at_s(&self) -> f64 {
        if self.taken < self.of {
            self.from_s + f64::from(self.taken) * self.every_s
        } else {
            f64::INFINITY
        }
    }

    fn sample(&mut self, state: &State) {
        self.taken += 1;
        self.seen.push(*state);
    }
}

fn film(
    scene: &Scene,
    law: Law,
    tolerance: f64,
    launch: &Launch,
    at: Option<(f64, f64, u32)>,
) -> Film {
    let (from_s, every_s, of) = at.unwrap_or((f64::INFINITY, 1.0, 0));
    let mut film = Film {
        from_s,
        every_s,
        taken: 0,
        of,
        seen: Vec::new(),
        touched: None,
        released: None,
    };
    let engine = settings(law, tolerance)
        .engine(scene)
        .expect("good settings");
    engine.toss(&mut (), launch, &mut film);
    film
}

/// The start and the end of the first impact, and 40 instants in it.
fn within(scene: &Scene, law: Law, launch: &Launch) -> Option<(State, State, (f64, f64, u32))> {
    let events = film(scene, law, 1e-9, launch, None);
    let (touched, released) = (events.touched?, events.released?);
    let length = released.time_s - touched.time_s;
    (length > 0.0).then_some((
        touched,
        released,
        (touched.time_s + 0.0125 * length, length / 40.0, 40),
    ))
}

fn distance(a: &State, b: &State) -> f64 {
    let turned = (a.axis.into_inner() - b.axis.into_inner()).norm() * 0.01;
    let moving = (a.velocity_m_s - b.velocity_m_s).norm() * 1e-4;
    (a.position_m - b.position_m).norm().max(turned).max(moving)
}

fn drop(trial: u64) -> (Scene, Launch) {
    let mut dice = Dice::new(230, trial);
    let scene = scene(
        dice.scale(0.3, 3.0),
        dice.between(0.2, 0.9),
        dice.pick(&[0.0, 0.3]),
    );
    let mut launch = touch(
        dice.between(0.2, 1.4),
        dice.between(-1.0, 1.0),
        -dice.between(1.0, 3.0),
        dice.between(-20.0, 20.0),
    );
    launch.height_m = 0.05;
    (scene, launch)
}

/// At the tightest tolerance errors are about 1e-12 of the lengths and speeds of an impact (0.1 mm,
/// 3 m/s). At 1e-6 they are at most a hundredfold of the tolerance: 1e-8 m, and 1e-4 m/s (weighted
/// by 1e-4 here). A straight line from touch to release would be wrong by 1e-5 m and 1 m/s.
#[test]
fn samples_within_an_impact_follow_the_law() {
    let mut seen = 0;
    for trial in 0..40 {
        let (scene, launch) = drop(trial);
        for law in [line(3e9), pulse(1e-4)] {
            let Some((touched, released, at)) = within(&scene, law, &launch) else {
                continue;
            };
            let coarse = film(&scene, law, 1e-6, &launch, Some(at));
            let exact = film(&scene, law, 1e-12, &launch, Some(at));
            assert_eq!((coarse.seen.len(), exact.seen.len()), (40, 40), "{trial}");
            let mut straight: f64 = 0.0;
            for (a, b) in coarse.seen.iter().zip(&exact.seen) {
                assert_eq!(a.time_s, b.time_s);
                assert!(distance(a, b) < 1e-8, "{trial} {}: {a:?} {b:?}", law.name());
                let share = (b.time_s - touched.time_s) / (released.time_s - touched.time_s);
                let linear = touched.velocity_m_s.lerp(&released.velocity_m_s, share);
                straight = straight.max((linear - b.velocity_m_s).norm());
                seen += 1;
            }
            assert!(straight > 0.05, "{trial}: {straight}");
        }
    }
    assert!(seen > 2000, "{seen}");
}

/// Velocities are the derivatives of positions: central differences over 40 instants of a pulse
/// have an error of (h/τ)²π²/6 of the change, below 1e-3 of it, except at the ends of the pulse.
#[test]
fn velocities_of_samples_are_derivatives_of_positions() {
    for trial in 0..20 {
        let (scene, launch) = drop(trial);
        for law in [line(3e9), pulse(1e-4)] {
            let Some((touched, released, at)) = within(&scene, law, &launch) else {
                continue;
            };
            let changed = (released.velocity_m_s - touched.velocity_m_s).norm();
            let film = film(&scene, law, 1e-11, &launch, Some(at));
            for three in film.seen.windows(3) {
                let step = three[2].time_s - three[0].time_s;
                let rate = (three[2].position_m - three[0].position_m) / step;
                let off = (rate - three[1].velocity_m_s).norm();
                assert!(
                    off < 0.02 * changed,
                    "{trial} {}: {off} of {changed}",
                    law.name()
                );
            }
        }
    }
}

/// Corner under the centre: nothing turns, and the centre moves as under its weight and half a sine in closed
/// form, z = z₀ + v t − g t²/2 + (1 + e)|v| (t/2 − τ sin(πt/τ)/2π). In this long pulse the fall is 2 mm.
#[test]
fn a_coin_falls_during_a_pulse() {
    const TIME_S: f64 = 0.02;
    let scene = scene(2.0, 0.5, 0.0);
    let mut launch = touch(PI / 4.0, 0.0, -2.0, 0.0);
    launch.height_m = 0.05;
    let (touched, _, at) = within(&scene, pulse(TIME_S), &launch).expect("it lasts");
    let film = film(&scene, pulse(TIME_S), 1e-11, &launch, Some(at));
    let (g, v) = (scene.gravity_m_s2(), touched.velocity_m_s.z);
    assert_eq!(film.seen.len(), 40);
    for state in film.seen {
        let t = state.time_s - touched.time_s;
        let (sin, cos) = libm::sincos(PI * t / TIME_S);
        let push = -1.5 * v;
        let moved = v * t - 0.5 * g * t * t + push * (0.5 * t - 0.5 * TIME_S * sin / PI);
        let speed = v - g * t + push * 0.5 * (1.0 - cos);
        let off = state.position_m.z - touched.position_m.z - moved;
        assert!(off.abs() < 1e-10, "{t}: {off}");
        assert!((state.velocity_m_s.z - speed).abs() < 1e-9, "{t}");
    }
}
