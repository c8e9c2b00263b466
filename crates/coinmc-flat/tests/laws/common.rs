//! Laws, engines and launches.

use coinmc_core::{DynEngine, Launch, Scene};
use coinmc_flat::{
    GaekSukhov, HalfSine, Law, Lever, LineContact, Materials, PulseTime, Settings, SingleImpact,
};
use nalgebra::{UnitVector3, Vector3};

/// Both bodies of the same material.
pub(crate) fn materials(young_pa: f64) -> Materials {
    Materials {
        coin_young_pa: young_pa,
        coin_poisson: 0.3,
        surface_young_pa: young_pa,
        surface_poisson: 0.3,
        length_m: 0.02,
    }
}

pub(crate) fn line(young_pa: f64) -> Law {
    Law::LineContact(LineContact {
        materials: materials(young_pa),
        tangential: LineContact::mindlin(0.3),
    })
}

pub(crate) fn pulse(time_s: f64) -> Law {
    Law::HalfSine(HalfSine {
        time: PulseTime::Given(time_s),
        peak_n: None,
    })
}

pub(crate) fn gaek_sukhov(eta_n_s: f64, lever: Lever) -> Law {
    Law::GaekSukhov(GaekSukhov { eta_n_s, lever })
}

pub(crate) fn settings(law: Law, tolerance: f64) -> Settings {
    Settings {
        law,
        tolerance,
        ..Settings::default()
    }
}

pub(crate) fn engine(scene: &Scene, law: Law) -> DynEngine {
    settings(law, 1e-6).engine(scene).expect("valid settings")
}

pub(crate) fn impact(scene: &Scene, law: Law, tolerance: f64, launch: &Launch) -> SingleImpact {
    SingleImpact::new(scene, &settings(law, tolerance), launch).expect("valid settings")
}

/// A coin about to touch: tilt of u from the vertical, velocity, spin.
pub(crate) fn touch(theta: f64, vx: f64, vz: f64, spin: f64) -> Launch {
    let (sin, cos) = libm::sincos(theta);
    Launch {
        height_m: 0.0,
        velocity_m_s: Vector3::new(vx, 0.0, vz),
        axis: UnitVector3::new_unchecked(Vector3::new(sin, 0.0, cos)),
        spin_rad_s: Vector3::new(0.0, spin, 0.0),
    }
}
