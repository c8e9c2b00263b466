//! The scenes in which claims are checked.

use crate::sets::UNITY;
use crate::tosser::Scene;
use coinmc_questions::scenes::EverydayScene;

/// The robot's toss in the plane: 10 g, R = 1 cm, e = 0.5, μ = 0.3.
pub(super) fn robot(name: &str) -> Scene {
    Scene::new(
        name,
        "[coin]\nratio = 1.0\nradius_m = 0.01\nmass_kg = 0.01\n\
         [surface]\nrestitution = 0.5\nfriction = 0.3\n[launch]\npreset = \"robot\"\n[engine.flat]\n",
    )
}

/// A toss in space of any orientation and spin onto a perfect plane, R = 1 cm.
pub(super) fn clean(name: &str) -> Scene {
    Scene::new(
        name,
        "[coin]\nratio = 1.0\nradius_m = 0.01\nmass_kg = 0.01\n\
         [surface]\nrestitution = 0.5\nfriction = 0.3\nrolling_friction_m = 3e-5\n\
         pivoting_friction_m = 3e-5\n[launch]\npreset = \"clean\"\n[engine.volumetric]\n",
    )
}

/// A toss by hand onto a table of wood.
pub(super) fn hand(name: &str) -> Scene {
    let wood = EverydayScene::named("wood").expect("an everyday scene");
    Scene::new(name, wood.config())
}

/// The published Unity scene.
pub(super) fn unity(name: &str) -> Scene {
    Scene::new(name, UNITY.config.expect("a scene of its own"))
}
