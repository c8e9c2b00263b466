//! Tables with an edge: which coins leave, against motion whose way is known.

use crate::common::Tosser;
use coinmc_core::{
    Coin, Drag, Ended, Engine, EventKind, Face, Landing, Launch, LaunchSource, Preset, Roughness,
    Scene, Surface,
};
use coinmc_testkit::{Recorder, preset_launch};
use coinmc_volumetric::Settings;
use nalgebra::{UnitVector3, Vector3};
use std::ops::ControlFlow;

const RADIUS: f64 = 0.01;
const CONTOUR: f64 = 1e-4;
const GRAVITY: f64 = 9.81;

fn plane(ratio: f64, mu: f64) -> Scene {
    let surface = Surface::new(0.5, mu)
        .and_then(|surface| surface.with_friction_lengths(CONTOUR, 1e-5))
        .expect("a valid surface");
    let coin = Coin::cylinder(ratio, RADIUS).expect("a valid coin");
    Scene::new(coin, surface, GRAVITY).expect("valid gravity")
}

fn with_edge(mut scene: Scene, radius_m: f64) -> Scene {
    let table = scene.surface.with_table_radius(radius_m);
    scene.surface = table.expect("a valid radius");
    scene
}

fn launch(height_m: f64, axis: Vector3<f64>, velocity: Vector3<f64>, spin: Vector3<f64>) -> Launch {
    Launch {
        height_m,
        velocity_m_s: velocity,
        axis: UnitVector3::new_normalize(axis),
        spin_rad_s: spin,
    }
}

fn ends(scene: Scene, radius_m: f64, launch: &Launch) -> Ended {
    Tosser::new(&with_edge(scene, radius_m)).toss(launch).ended
}

/// `launch` comes to rest `way_m` from where it began: it stays on a table 1 % larger, and leaves one
/// 1 % smaller.
fn assert_way(scene: Scene, launch: &Launch, way_m: f64, face: Face) {
    assert_eq!(ends(scene, 1.01 * way_m, launch), Ended::Decided(face));
    assert_eq!(ends(scene, 0.99 * way_m, launch), Ended::Left);
}

/// A wheel of speed v rolls v²/2a far, a = ρ_c g R/(R² + R²/2).
#[test]
fn a_wheel_rolls_to_the_edge() {
    let slows = CONTOUR * GRAVITY / (1.5 * RADIUS);
    for ratio in [0.2, 0.85] {
        for way_m in [0.03_f64, 0.3] {
            let speed = (2.0 * slows * way_m).sqrt();
            let axis = Vector3::new(1.0, 0.0, 1e-6);
            let velocity = Vector3::new(0.0, speed, 0.0);
            let spin = Vector3::new(-speed / RADIUS, 0.0, 0.0);
            let rolls = launch(RADIUS, axis, velocity, spin);
            assert_way(plane(ratio, 0.3), &rolls, way_m, Face::Side);
        }
    }
}

/// A coin in contact is looked at no more than a hundredth of its radius beyond the edge.
#[test]
fn a_wheel_leaves_at_the_edge() {
    let (radius_m, speed) = (0.25, 1.0);
    let velocity = Vector3::new(0.0, speed, 0.0);
    let spin = Vector3::new(-speed / RADIUS, 0.0, 0.0);
    let rolls = launch(RADIUS, Vector3::new(1.0, 0.0, 1e-6), velocity, spin);
    let mut recorder = Recorder::default();
    let scene = with_edge(plane(0.2, 0.3), radius_m);
    let outcome = Tosser::new(&scene).observe(&rolls, &mut recorder);
    assert_eq!(outcome.ended, Ended::Left);
    let last = recorder.0.last().expect("events").state.position_m;
    let beyond = last.xy().norm() - radius_m;
    assert!(beyond > 0.0 && beyond <= 0.0101 * RADIUS, "{beyond}");
}

/// A coin flat on its face slides v²/2μg far.
#[test]
fn a_flat_coin_slides_to_the_edge() {
    let way_m = 0.05_f64;
    let speed = (2.0 * 0.3 * GRAVITY * way_m).sqrt();
    let velocity = Vector3::new(0.6, -0.8, 0.0) * speed;
    let height_m = 0.1 * RADIUS;
    let slides = launch(height_m, Vector3::z(), velocity, Vector3::zeros());
    assert_way(plane(0.2, 0.3), &slides, way_m, Face::Heads);
}

/// On an adhesive table the coin rests where it lands: v sqrt(2 s/g) away, s its fall.
#[test]
fn an_adhesive_table_holds_a_coin_where_it_lands() {
    let mut scene = plane(0.85, 0.3);
    scene.surface = scene
        .surface
        .with_landing(Landing::Adhesive)
        .expect("a level surface");
    let (half, fall) = (0.5 * 0.85 * RADIUS, 0.2_f64);
    let velocity = Vector3::new(0.5, 0.0, 0.0);
    let drops = launch(half + fall, Vector3::z(), velocity, Vector3::zeros());
    assert_way(
        scene,
        &drops,
        0.5 * (2.0 * fall / GRAVITY).sqrt(),
        Face::Heads,
    );
}

/// Without friction a coin that moves sideways slides on: over any edge; or, by drag k, v/k far.
#[test]
fn without_friction_only_drag_or_no_speed_keeps_a_coin() {
    let scene = plane(0.85, 0.0);
    let moves = |speed: f64| {
        let velocity = Vector3::new(speed, 0.0, 0.0);
        launch(
            0.05,
            Vector3::new(0.3, 0.0, 1.0),
            velocity,
            Vector3::new(0.0, 9.0, 1.0),
        )
    };
    assert_eq!(ends(scene, 1e3, &moves(0.1)), Ended::Left);
    assert!(matches!(ends(scene, 0.02, &moves(0.0)), Ended::Decided(_)));
    let drags = scene.with_drag(Drag::new(0.5, 0.0).expect("valid drag"));
    assert!(matches!(ends(drags, 0.202, &moves(0.1)), Ended::Decided(_)));
    assert_eq!(ends(drags, 0.198, &moves(0.1)), Ended::Left);
}

/// On a table larger than any way, every toss ends as on an endless one; on a smaller one, unless it leaves. And
/// the smaller the table, the more coins leave it.
#[test]
fn a_large_table_changes_no_face_and_a_smaller_one_loses_more() {
    for (ratio, slope) in [(0.2, 0.0), (0.85, 0.0), (0.3, 0.03)] {
        let mut scene = plane(ratio, 0.3);
        scene.surface = scene
            .surface
            .with_roughness(Roughness::new(slope, 3e-3).ok());
        let settings = Settings::default();
        let endless = Tosser::with(&scene, &settings);
        let launches: Vec<Launch> = (0..150)
            .map(|toss| preset_launch(Preset::Hand, &scene, 21, toss))
            .collect();
        let faces: Vec<_> = launches
            .iter()
            .map(|launch| endless.toss(launch).ended)
            .collect();
        let mut left = Vec::new();
        for radius_m in [1e3, 0.3, 0.1, 0.03] {
            let table = with_edge(scene, radius_m);
            let engine = settings.engine(&table).expect("valid settings");
            let mut found = vec![None; launches.len()];
            let mut each = launches.iter().copied();
            engine.toss_many(
                &mut engine.workspace(),
                LaunchSource::new(&mut each),
                &mut |outcomes| {
                    for (number, outcome) in outcomes {
                        found[usize::try_from(*number).expect("a small number")] =
                            Some(outcome.ended);
                    }
                    ControlFlow::Continue(())
                },
            );
            let mut count = 0;
            for (number, (ended, expected)) in found.iter().zip(&faces).enumerate() {
                let ended = ended.expect("every toss ends");
                count += u32::from(ended == Ended::Left);
                assert!(
                    ended == Ended::Left || ended == *expected,
                    "toss {number} on {radius_m} m: {ended:?}, not {expected:?}"
                );
            }
            left.push(count);
        }
        println!("H/R {ratio}, slope {slope}: {left:?} of 150 leave");
        assert!(left[0] == 0 && left.is_sorted() && left[3] > 20, "{left:?}");
    }
}

/// An observer sees the coin up to the edge and no farther, and one last event there.
#[test]
fn an_observer_sees_the_coin_as_far_as_the_edge() {
    let (scene, radius_m) = (plane(0.2, 0.3), 0.1);
    let table = with_edge(scene, radius_m);
    let mut left = 0;
    for toss in 0..100 {
        let launch = preset_launch(Preset::Hand, &scene, 22, toss);
        let mut recorder = Recorder::default();
        let outcome = Tosser::new(&table).observe(&launch, &mut recorder);
        let (last, before) = recorder.0.split_last().expect("events");
        assert_eq!(last.kind, EventKind::Ended);
        let distance = |position: Vector3<f64>| position.xy().norm();
        assert!(
            before
                .iter()
                .all(|event| distance(event.state.position_m) <= radius_m)
        );
        assert!(before.iter().all(|event| event.kind != EventKind::Ended));
        if outcome.ended == Ended::Left {
            left += 1;
            assert!(distance(last.state.position_m) > radius_m);
        }
    }
    assert!(left > 10, "{left}");
}
