//! Cylinders whose centre of mass is off the middle: what only they have. What they share with conical
//! coins (mirror image, energy, flights, rest, the solid angles of the wells, the oracle) is tested with those.

use crate::common::Tosser;
use crate::conical::{Faces::Centre, faces_changed, on_edge, scene_of};
use coinmc_core::{Coin, Domain, Face, LowerRim, Preset, Scene, Stream};
use coinmc_testkit::Sampler;
use coinmc_volumetric::{Decision, Settings};
use nalgebra::Vector3;

/// Without bounces a toss depends smoothly on the centre: a millionth of H off the middle hardly any coin ends
/// elsewhere than the cylinder, which another part of the engine tosses; and the more do the farther it is.
#[test]
fn a_centre_near_the_middle_is_nearly_the_middle() {
    let cylinder = scene_of(0.85, Centre(0.0), 0.0, 0.01);
    let uniform = Coin::cylinder(0.85, 0.01).expect("a good coin");
    assert_eq!(
        cylinder.coin, uniform,
        "exactly in the middle it is the same coin"
    );
    let changed = |centre: f64| {
        let loaded = scene_of(0.85, Centre(centre), 0.0, 0.01);
        faces_changed(&cylinder, &loaded, 311)
    };
    let (tiny, small, large) = (changed(1e-6), changed(0.01), changed(0.25));
    assert!(
        tiny <= 2 && small <= 20 && large > 40,
        "{tiny} {small} {large}"
    );
}

/// On its side it rolls straight on, as far as contour friction ρ_c lets it: v²/2a with
/// a = ρ_c R/(R² + k_a) in units of D and g, wherever its centre is.
#[test]
fn a_loaded_coin_rolls_straight() {
    let settings = Settings {
        decision: Decision::Energy,
        ..Settings::default()
    };
    for centre in [0.25, -0.1] {
        let scene = scene_of(0.85, Centre(centre), 0.0, 0.01);
        let [rim, _] = LowerRim::of(&scene.coin);
        let (radius, body) = (rim.height_on_edge(), rim.body);
        let omega = 1.0;
        let launch = on_edge(&scene, 0.0, -radius * omega, Vector3::x() * omega);
        let mut sampler = Sampler::new(200.0);
        let outcome = Tosser::with(&scene, &settings).observe(&launch, &mut sampler);
        assert_eq!(outcome.face(), Some(Face::Side));
        let [first, last] = [sampler.samples.first(), sampler.samples.last()]
            .map(|sample| sample.expect("samples").state.position_m);
        let length = scene.coin.rim_distance_m();
        let way = (last - first) / length;
        assert!(way.x.abs() < 1e-9 && way.z.abs() < 1e-9, "{way:?}");
        let slows = 0.01 * scene.coin.radius_m() / length * radius / (radius * radius + body.ka);
        let expected = (radius * omega).powi(2) / (2.0 * slows);
        assert!(
            (way.y.abs() / expected - 1.0).abs() < 1e-3,
            "{way:?} {expected}"
        );
    }
}

/// The balance on either rim is where the centre of mass is above it: let go beyond it the coin falls onto that
/// face, and within the nearer one onto its side.
#[test]
fn the_well_of_the_side_is_as_wide_as_the_centre_is_far_from_either_rim() {
    let scene = scene_of(1.0, Centre(0.2), 0.0, 0.01);
    let engine = Tosser::new(&scene);
    let [heads, tails] = scene.coin.rims();
    // leaning to heads, the face up is tails; the balance is where the centre is above that rim
    let to_tails = libm::atan(heads.distance_m / heads.radius_m);
    let to_heads = libm::atan(tails.distance_m / tails.radius_m);
    assert!(to_tails < 0.6 * to_heads);
    let released = |off: f64| {
        let outcome = engine.toss(&on_edge(&scene, off, 0.0, Vector3::zeros()));
        outcome.face()
    };
    assert_eq!(released(1.02 * to_tails), Some(Face::Tails));
    assert_eq!(released(0.95 * to_tails), Some(Face::Side));
    assert_eq!(released(-1.02 * to_heads), Some(Face::Heads));
}

/// With the centre nearer to heads a coin lies on heads more often: tails is shown more often. By .09, here
/// at least by half of that: four standard errors.
#[test]
fn the_heavier_face_is_below() {
    let scene: Scene = scene_of(0.5, Centre(0.2), 0.3, 0.01);
    let engine = Tosser::new(&scene);
    let (launches, stream) = (
        Preset::Clean.distribution(),
        Stream::new(45, Domain::Launch, 0),
    );
    let mut shown = [0_u32; 2];
    for toss in 0..10_000 {
        let launch = launches.launch(&scene.coin, &mut stream.toss(toss));
        match engine.toss(&launch).face() {
            Some(Face::Heads) => shown[0] += 1,
            Some(Face::Tails) => shown[1] += 1,
            _ => {}
        }
    }
    assert!(shown[1] > shown[0] + 450, "{shown:?}");
}
