//! Studies of the flat toss's laws of impact: single impacts, and the curves they give.

mod accuracy;
mod balance;
mod curves;
mod limit;

pub(crate) use accuracy::ImpactAccuracy;
pub(crate) use balance::ImpactBalance;
pub(crate) use curves::ImpactCurves;
pub(crate) use limit::ImpactLimit;

use coinmc_core::{Coin, Launch, Scene, State, Surface};
use coinmc_flat::{HalfSine, Law, LineContact, Materials, PulseTime, Settings, SingleImpact};
use nalgebra::{UnitVector3, Vector3};

/// PLA on wood: the printed coins of the paper's robot.
const COIN_YOUNG_PA: f64 = 3e9;
const SURFACE_YOUNG_PA: f64 = 1e10;
const POISSON: f64 = 0.35;
/// Length of the line of contact: the diameter of the coin of 1 cm radius.
const LENGTH_M: f64 = 0.02;

/// A contact that is this many times as stiff as PLA on wood.
fn materials(stiffer: f64) -> Materials {
    Materials {
        coin_young_pa: COIN_YOUNG_PA * stiffer,
        coin_poisson: POISSON,
        surface_young_pa: SURFACE_YOUNG_PA * stiffer,
        surface_poisson: POISSON,
        length_m: LENGTH_M,
    }
}

fn line(materials: Materials, tangential: f64) -> Law {
    Law::LineContact(LineContact {
        materials,
        tangential,
    })
}

fn pulse(time: PulseTime) -> Law {
    Law::HalfSine(HalfSine { time, peak_n: None })
}

/// A 10 g coin of R = 1 cm.
fn scene(ratio: f64, restitution: f64, friction: f64) -> Scene {
    let coin = Coin::cylinder(ratio, 0.01).expect("a ratio above 0");
    let surface = Surface::new(restitution, friction).expect("0 <= e <= 1 and mu >= 0");
    Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("gravity is positive")
}

/// One impact by a law.
fn impact(scene: &Scene, law: Law, tolerance: f64, launch: &Launch) -> SingleImpact {
    let settings = Settings {
        law,
        tolerance,
        ..Settings::default()
    };
    SingleImpact::new(scene, &settings, launch).expect("settings are in range")
}

/// A coin that touches with u at this angle from the vertical.
fn touch(theta: f64, vx: f64, vz: f64, spin: f64) -> Launch {
    let (sin, cos) = libm::sincos(theta);
    Launch {
        height_m: 0.0,
        velocity_m_s: Vector3::new(vx, 0.0, vz),
        axis: UnitVector3::new_unchecked(Vector3::new(sin, 0.0, cos)),
        spin_rad_s: Vector3::new(0.0, spin, 0.0),
    }
}

/// How far two states are apart in velocity, m/s: of the centre or of the rim by spin.
fn distance(scene: &Scene, a: &State, b: &State) -> f64 {
    let rim = (a.spin_rad_s.y - b.spin_rad_s.y).abs() * scene.coin.radius_m();
    (a.velocity_m_s - b.velocity_m_s).norm().max(rim)
}
