//! How tosses came to end on their side, of coins started so that it is known.

use crate::common::Tosser;
use coinmc_core::{Coin, Face, Landing, Launch, Outcome, Scene, SideEnding, SideMotion, Surface};
use coinmc_volumetric::{Decision, Settings};
use nalgebra::{UnitVector3, Vector3};

const RADIUS: f64 = 0.01;
const CONTOUR: f64 = 1e-4;
const GRAVITY: f64 = 9.81;

fn surface(pivoting: f64) -> Surface {
    Surface::new(0.5, 0.3)
        .and_then(|surface| surface.with_friction_lengths(CONTOUR, pivoting))
        .expect("a valid surface")
}

fn scene(surface: Surface) -> Scene {
    let coin = Coin::cylinder(0.85, RADIUS).expect("a valid coin");
    Scene::new(coin, surface, GRAVITY).expect("valid gravity")
}

/// A coin that touches on its side, with its axis along x.
fn on_side(velocity_m_s: Vector3<f64>, spin_rad_s: Vector3<f64>) -> Launch {
    Launch {
        height_m: RADIUS,
        velocity_m_s,
        axis: UnitVector3::new_normalize(Vector3::new(1.0, 0.0, 1e-4)),
        spin_rad_s,
    }
}

/// Under both decisions: they end the toss at different times, but say the same of it.
fn outcomes(scene: &Scene, launch: &Launch) -> [Outcome; 2] {
    [Decision::Tilting, Decision::Energy].map(|decision| {
        let settings = Settings {
            decision,
            ..Settings::default()
        };
        Tosser::with(scene, &settings).toss(launch)
    })
}

fn assert_ending(scene: &Scene, launch: &Launch, motion: SideMotion, passed: u8) {
    for outcome in outcomes(scene, launch) {
        assert_eq!(outcome.face(), Some(Face::Side));
        let expected = SideEnding {
            motion,
            roll_bounds_passed: passed,
        };
        assert_eq!(outcome.side_ending, Some(expected));
    }
}

/// A wheel of speed v rolls v²/2a far, a = ρ_c g R/(R² + R²/2).
#[test]
fn a_wheel_rolls_as_far_as_its_speed_carries_it() {
    let scene = scene(surface(CONTOUR));
    let slows = CONTOUR * GRAVITY / (1.5 * RADIUS);
    for (distance, passed) in [(0.011, 1), (0.029, 1), (0.031, 2), (0.9, 4), (1.1, 5)] {
        let speed = (2.0_f64 * slows * distance).sqrt();
        let launch = on_side(
            Vector3::new(0.0, speed, 0.0),
            Vector3::new(-speed / RADIUS, 0.0, 0.0),
        );
        assert_ending(&scene, &launch, SideMotion::Rolled, passed);
    }
}

/// A sliding coin keeps v/(1 + k_a/R²) = 2v/3 of its speed once it rolls.
#[test]
fn a_coin_that_slides_at_first_rolls_on() {
    let scene = scene(surface(CONTOUR));
    let slows = CONTOUR * GRAVITY / (1.5 * RADIUS);
    for (distance, passed) in [(0.095, 2), (0.105, 3)] {
        let speed = 1.5 * (2.0_f64 * slows * distance).sqrt();
        let launch = on_side(Vector3::new(0.0, speed, 0.0), Vector3::zeros());
        assert_ending(&scene, &launch, SideMotion::Rolled, passed);
    }
}

/// On both rims, each of which slips at H/2 from the middle, a coin turns by ½ (I_t/m) ω²/(g(ρ_p + μ H/2)): once at 71.5 rad/s.
/// (With pivoting friction alone it would be 11 turns.)
#[test]
fn a_coin_that_turns_on_the_spot_spins() {
    let scene = scene(surface(1e-5));
    let brakes = GRAVITY * (1e-5 + 0.3 * scene.coin.height_m() / 2.0);
    let once = (2.0 * std::f64::consts::TAU * brakes / scene.coin.transverse_gyration_m2()).sqrt();
    for (share, motion) in [(0.97, SideMotion::Rested), (1.03, SideMotion::Spun)] {
        let launch = on_side(Vector3::zeros(), Vector3::new(0.0, 0.0, share * once));
        assert_ending(&scene, &launch, motion, 0);
    }
}

#[test]
fn a_coin_that_lands_straight_rests() {
    let straight = on_side(Vector3::zeros(), Vector3::zeros());
    let dropped = Launch {
        height_m: 1.15 * RADIUS,
        ..straight
    };
    assert_ending(&scene(surface(CONTOUR)), &dropped, SideMotion::Rested, 0);
    let fast = on_side(Vector3::new(0.0, 1.0, 0.0), Vector3::zeros());
    let adhesive = surface(CONTOUR)
        .with_landing(Landing::Adhesive)
        .expect("a level surface");
    assert_ending(&scene(adhesive), &fast, SideMotion::Rested, 0);
}

#[test]
fn faces_have_no_side_ending() {
    let launch = Launch {
        axis: Vector3::z_axis(),
        ..on_side(Vector3::zeros(), Vector3::zeros())
    };
    for outcome in outcomes(&scene(surface(CONTOUR)), &launch) {
        assert_eq!(
            (outcome.face(), outcome.side_ending),
            (Some(Face::Heads), None)
        );
    }
}
