//! Scenes and launches.

use coinmc_core::{
    Coin, Domain, Drag, Landing, Launch, LaunchDistribution, Marginal, Preset, Scene, Spin, Stream,
    Surface,
};

/// Radius of the coins, m.
const RADIUS_M: f64 = 0.01;

fn on(surface: Surface, ratio: f64, radius_m: f64) -> Scene {
    let coin = Coin::cylinder(ratio, radius_m).expect("H/R and R are positive");
    Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("gravity is positive")
}

/// A coin of R = 1 cm on a surface without friction lengths, g = 9.81 m/s².
///
/// # Panics
/// If a parameter is out of range.
pub fn scene(ratio: f64, restitution: f64, friction: f64) -> Scene {
    let surface = Surface::new(restitution, friction).expect("0 <= e <= 1 and mu >= 0");
    on(surface, ratio, RADIUS_M)
}

/// [`scene`] with both friction lengths `rho` radii.
///
/// # Panics
/// If a parameter is out of range.
pub fn rolling_scene(ratio: f64, restitution: f64, friction: f64, rho: f64) -> Scene {
    let mut scene = scene(ratio, restitution, friction);
    let length = rho * RADIUS_M;
    let surface = scene.surface.with_friction_lengths(length, length);
    scene.surface = surface.expect("rho >= 0");
    scene
}

/// The same scene where the coin stays at its first contact.
///
/// # Panics
/// If the table is tilted.
#[must_use]
pub fn adhesive(mut scene: Scene) -> Scene {
    scene.surface = scene
        .surface
        .with_landing(Landing::Adhesive)
        .expect("a level surface");
    scene
}

/// The Unity scene of Gaek & Sukhov, arXiv 2401.03557, table 1.
///
/// # Panics
/// If `ratio` is not positive.
pub fn table1(ratio: f64) -> Scene {
    let surface = Surface::new(0.3, 10.0)
        .and_then(|surface| surface.with_restitution_threshold(2.0))
        .expect("the published surface is valid");
    let drag = Drag::new(1.0, 0.05).expect("the published rates are valid");
    let scene = on(surface, ratio, 0.5).with_drag(drag);
    scene.with_gyroscopic_torque(false)
}

/// The random numbers of launches.
pub fn stream(seed: u64) -> Stream {
    Stream::new(seed, Domain::Launch, 0)
}

/// Toss number `toss` of a preset.
pub fn preset_launch(preset: Preset, scene: &Scene, seed: u64, toss: u64) -> Launch {
    let mut uniforms = stream(seed).toss(toss);
    preset.distribution().launch(&scene.coin, &mut uniforms)
}

/// The launches of the preset `hand`, all with this angle between angular momentum and axis.
///
/// # Panics
/// If the preset no longer precesses.
pub fn hand_at(psi_deg: f64) -> LaunchDistribution {
    let mut launches = Preset::Hand.distribution();
    let Spin::Precessing { psi_rad, .. } = &mut launches.spin else {
        panic!("a coin tossed by hand precesses");
    };
    *psi_rad = Marginal::Constant(psi_deg.to_radians());
    launches
}
