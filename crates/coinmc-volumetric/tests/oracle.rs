//! Whole tosses against the time-stepping oracle: the same laws in another formulation and other
//! code.
//!
//! Both simulate the same launches, so the differences are paired. Single tosses diverge at e > 0,
//! where rounding grows with every bounce; their statistics must not. The bounds are 3 standard
//! errors of the paired difference (false alarms with other seeds: 3e-3 per scene), plus .002 for
//! what the oracle's step costs. The study `oracle` makes the long comparison.

use coinmc_core::{Coin, Domain, Engine, Face, Launch, Preset, Scene, Stream, Surface};
use coinmc_oracle::{StepperSettings, TimeStepper};
use coinmc_volumetric::{Moreau, Settings, VolumetricEngine};
use nalgebra::{UnitVector3, Vector3};

/// R = 1 cm, μ = 0.3, both friction lengths `rho` radii.
fn scene(ratio: f64, e: f64, rho: f64) -> Scene {
    let radius = 0.01;
    let surface = Surface::new(e, 0.3)
        .and_then(|surface| surface.with_friction_lengths(rho * radius, rho * radius))
        .expect("a valid surface");
    let coin = Coin::cylinder(ratio, radius).expect("a valid coin");
    Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("valid gravity")
}

/// Tosses on which the engine and the oracle disagree.
#[derive(Debug, Default)]
struct Differences {
    /// On the side according to the engine only, and to the oracle only.
    engine_side: u32,
    oracle_side: u32,
    /// Tosses that the engine decides within two impacts, and those of them with different faces.
    short: u32,
    short_differ: u32,
    undecided: u32,
}

fn compare(scene: &Scene, tosses: u64) -> Differences {
    let engine =
        VolumetricEngine::new(scene, &Settings::default(), Moreau).expect("valid settings");
    let mut oracle = TimeStepper::new(scene, StepperSettings::default());
    let stream = Stream::new(41, Domain::Launch, 0);
    let launches = Preset::Clean.distribution();
    let mut differences = Differences::default();
    for toss in 0..tosses {
        let launch = launches.launch(&scene.coin, &mut stream.toss(toss));
        let outcome = engine.toss(&mut engine.workspace(), &launch, &mut ());
        let (face, other) = (outcome.face(), oracle.toss(&launch).face);
        let (side, other_side) = (face == Some(Face::Side), other == Some(Face::Side));
        differences.engine_side += u32::from(side && !other_side);
        differences.oracle_side += u32::from(other_side && !side);
        differences.undecided += u32::from(face.is_none() || other.is_none());
        if outcome.impacts <= 2 {
            differences.short += 1;
            differences.short_differ += u32::from(face != other);
        }
    }
    differences
}

fn agrees(ratio: f64, e: f64, rho: f64, tosses: u64) -> Differences {
    agrees_in(&scene(ratio, e, rho), tosses)
}

fn agrees_in(scene: &Scene, tosses: u64) -> Differences {
    let found = compare(scene, tosses);
    println!("{scene:?}: {found:?}");
    let n = tosses as f64;
    let bias = (f64::from(found.engine_side) - f64::from(found.oracle_side)) / n;
    let error = f64::from(found.engine_side + found.oracle_side).sqrt() / n;
    assert!(
        bias.abs() <= 3.0 * error + 0.002,
        "{scene:?}: {bias} ± {error}"
    );
    assert_eq!(found.undecided, 0, "{scene:?}");
    found
}

#[test]
fn bouncing_coins_agree() {
    agrees(0.85, 0.5, 0.01, 600);
    agrees(0.25, 0.5, 0.01, 600);
}

/// Rims rounded by a quarter of the thickness and more: with them more of these coins roll onto
/// their side, or off it.
#[test]
fn coins_with_rounded_rims_agree() {
    for (ratio, rim) in [(0.85, 0.2), (0.25, 0.06)] {
        let mut scene = scene(ratio, 0.5, 0.01);
        let rim_m = rim * scene.coin.radius_m();
        scene.coin = scene.coin.with_rim_radius(rim_m).expect("a valid rim");
        agrees_in(&scene, 600);
    }
}

/// Tosses decided within two impacts do not amplify errors: they agree one by one, except those
/// that come as close to a balance as the error of the oracle's step (about 2 in 900).
#[test]
fn coins_that_do_not_bounce_agree_toss_by_toss() {
    for (ratio, rho) in [(0.85, 0.01), (2.0, 0.01)] {
        let found = agrees(ratio, 0.0, rho, 500);
        assert!(found.short >= 125, "{ratio}: {found:?}");
        assert!(found.short_differ <= 2, "{ratio}: {found:?}");
    }
}

/// A coin as thin as paper that rolls along its side rocks without loss while pivoting friction
/// holds it, and topples once it has become slow. One that rolls fast makes pivoting friction slide,
/// which ends its rocking: it stays on its side. (With friction that creeps under load all but the
/// slowest end on their side.)
#[test]
fn thin_coins_that_roll_and_rock_fall_as_the_oracles() {
    let scene = scene(0.01, 0.5, 0.003);
    let engine =
        VolumetricEngine::new(&scene, &Settings::default(), Moreau).expect("valid settings");
    let mut oracle = TimeStepper::new(&scene, StepperSettings::default());
    let radius = scene.coin.radius_m();
    let fastest = (Scene::STANDARD_GRAVITY_M_S2 / radius).sqrt();
    // 1.5 times the rate that just carries the coin over its rim: ½(1 + k_t)ω² = h²/2
    let rocks = 1.5 * 0.005 / 1.25_f64.sqrt() * fastest;
    for (roll, falls) in [(0.5, true), (1.0, true), (1.5, true), (2.0, false)] {
        let rolls = roll * fastest;
        let launch = Launch {
            height_m: radius,
            velocity_m_s: Vector3::new(rocks, rolls, 0.0) * radius,
            axis: UnitVector3::new_normalize(Vector3::new(1.0, 0.0, 1e-5)),
            spin_rad_s: Vector3::new(-rolls, rocks, 0.0),
        };
        let outcome = engine.toss(&mut engine.workspace(), &launch, &mut ());
        let faces = [outcome.face(), oracle.toss(&launch).face];
        let fell = faces.map(|face| face.map(|face| face != Face::Side));
        assert_eq!(fell, [Some(falls); 2], "{roll}");
    }
}
