//! Scenes and goals of the tests.

use coinmc_core::{
    Coin, Domain, Landing, LaunchDistribution, Marginal, Preset, Scene, Spin, Stream, Surface,
};
use coinmc_quadrature::{Goal, Integral, Method, integrate};
use coinmc_volumetric::{Moreau, Settings, VolumetricEngine};

/// A coin of 10 mm radius above an adhesive surface.
pub(crate) fn scene(ratio: f64) -> Scene {
    let surface = Surface::new(0.0, 0.0)
        .unwrap()
        .with_landing(Landing::Adhesive)
        .expect("a level surface");
    Scene::new(Coin::cylinder(ratio, 0.01).unwrap(), surface, 9.81).unwrap()
}

pub(crate) fn engine(scene: &Scene) -> VolumetricEngine<Moreau> {
    VolumetricEngine::new(scene, &Settings::default(), Moreau).unwrap()
}

/// The preset `clean` with a faster spin about the vertical, so that no rule holds.
pub(crate) fn uneven() -> LaunchDistribution {
    let normal = |sd| Marginal::Normal { mean: 5.0, sd };
    LaunchDistribution {
        spin: Spin::Components([normal(4.0), normal(4.0), normal(20.0)]),
        ..Preset::Clean.distribution()
    }
}

pub(crate) fn scrambles(seed: u64) -> Stream {
    Stream::new(seed, Domain::Scramble, 0)
}

pub(crate) fn goal(half_width: f64, evaluations: u64) -> Goal {
    Goal {
        confidence: 0.95,
        half_width,
        evaluations,
    }
}

pub(crate) fn found(
    method: Method,
    scene: &Scene,
    launches: &LaunchDistribution,
    seed: u64,
    goal: &Goal,
) -> Integral {
    let engine = engine(scene);
    integrate(
        method,
        scene,
        launches,
        &engine,
        &scrambles(seed),
        goal,
        || true,
    )
    .unwrap()
}
