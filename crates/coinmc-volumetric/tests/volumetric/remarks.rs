//! What the engine remarks on a scene before it is run.

use coinmc_core::{Drag, Roughness, Scene, TableTilt};
use coinmc_testkit::{adhesive, rolling_scene, scene};
use coinmc_volumetric::ENGINE;

/// Whether the remark with these words is made.
fn remarks(words: &str, scene: &Scene) -> bool {
    let mut all = ENGINE.remarks.iter();
    let remark = all.find(|remark| remark.text.contains(words));
    (remark.expect("a remark").applies)(scene)
}

#[test]
fn bounces_without_loss_may_go_on() {
    let says = |scene: &Scene| remarks("restitution = 1 loses no energy", scene);
    assert!(says(&scene(1.0, 1.0, 0.3)));
    assert!(!says(&scene(1.0, 0.99, 0.3)));
    assert!(!says(&adhesive(scene(1.0, 1.0, 0.3))));
}

/// Only friction lets a coin roll, and rolling friction or air stops it.
#[test]
fn a_coin_may_roll_for_ever() {
    let says = |scene: &Scene| remarks("nothing stops a coin that rolls", scene);
    assert!(says(&scene(1.0, 0.5, 0.3)));
    assert!(!says(&scene(1.0, 0.5, 0.0)));
    assert!(!says(&rolling_scene(1.0, 0.5, 0.3, 1e-6)));
    assert!(!says(&adhesive(scene(1.0, 0.5, 0.3))));
    let air = Drag::new(0.1, 0.0).expect("a good rate");
    assert!(!says(&scene(1.0, 0.5, 0.3).with_drag(air)));
}

#[test]
fn a_coin_may_roll_down_an_endless_rough_slope() {
    let says = |scene: &Scene| remarks("endless rough ground", scene);
    let with = |tilt_deg: f64, slope: f64, radius_m: Option<f64>| {
        let mut scene = rolling_scene(1.0, 0.5, 0.3, 0.003);
        let tilt = TableTilt::new(tilt_deg, 0.0).expect("a valid tilt");
        scene.surface = scene.surface.with_tilt(tilt).expect("it bounces");
        if slope > 0.0 {
            let ground = Roughness::new(slope, 3e-3).expect("a usual ground");
            scene.surface = scene.surface.with_roughness(Some(ground));
        }
        if let Some(radius_m) = radius_m {
            let surface = scene.surface.with_table_radius(radius_m);
            scene.surface = surface.expect("a good radius");
        }
        scene
    };
    assert!(says(&with(2.0, 0.05, None)));
    assert!(!says(&with(0.0, 0.05, None)));
    assert!(!says(&with(2.0, 0.0, None)));
    assert!(!says(&with(2.0, 0.05, Some(0.5))));
}

#[test]
fn a_rim_may_be_rounder_than_the_waves() {
    let says = |scene: &Scene| remarks("rims to be sharper than the waves", scene);
    let with = |rim_m: f64, slope: f64| {
        let mut scene = scene(1.0, 0.5, 0.3);
        scene.coin = scene.coin.with_rim_radius(rim_m).expect("a good radius");
        let ground = Roughness::new(slope, 3e-3).expect("a usual ground");
        scene.surface = scene.surface.with_roughness(Some(ground));
        scene
    };
    assert!(says(&with(0.5e-3, 0.05)));
    assert!(!says(&with(0.45e-3, 0.05)));
    assert!(!says(&with(0.5e-3, 0.0)));
}
