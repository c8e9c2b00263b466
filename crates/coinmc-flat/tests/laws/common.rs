//! Scenes, laws, launches and random numbers.

use coinmc_core::{
    Coin, Domain, DynEngine, Launch, Scene, Stream, Surface, TossUniforms, UniformSource,
};
use coinmc_flat::{
    GaekSukhov, HalfSine, Law, Lever, LineContact, Materials, PulseTime, Settings, SingleImpact,
};
use nalgebra::{UnitVector3, Vector3};

/// A 10 g coin of R = 1 cm.
pub(crate) fn scene(ratio: f64, restitution: f64, friction: f64) -> Scene {
    let coin = Coin::cylinder(ratio, 0.01).expect("a valid coin");
    let surface = Surface::new(restitution, friction).expect("a valid surface");
    Scene::new(coin, surface, 9.81).expect("valid gravity")
}

/// Coin and surface of the same material.
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

/// Random numbers of one trial, one after the other.
pub(crate) struct Dice(TossUniforms, u32);

impl Dice {
    pub(crate) fn new(seed: u64, trial: u64) -> Self {
        Self(Stream::new(seed, Domain::Launch, 0).toss(trial), 0)
    }

    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        self.1 += 1;
        from + (to - from) * self.0.uniform(self.1 - 1)
    }

    /// Log-uniform.
    pub(crate) fn scale(&mut self, from: f64, to: f64) -> f64 {
        libm::exp(self.between(libm::log(from), libm::log(to)))
    }

    pub(crate) fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        // the share lies in (0, 1): the index within the slice
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let index = (self.between(0.0, 1.0) * choices.len() as f64) as usize;
        choices[index.min(choices.len() - 1)]
    }
}
