//! Coins with a conical edge: limits, symmetry, conservation, rest and rolling on the edge, and whole
//! tosses against the time-stepping oracle, which knows the two rims as vectors only. What holds of any coin
//! whose faces are not alike is tested of loaded cylinders as well.

use crate::common::{Start, Tosser, flights};
use coinmc_core::{Coin, Domain, Engine, Face, Launch, LowerRim, Preset, Scene, Stream, Surface};
use coinmc_oracle::{Model, StepperSettings, TimeStepper};
use coinmc_testkit::conformance::{self, flipped};
use coinmc_testkit::{Dice, Extremes, Sampler, adhesive, turned};
use coinmc_volumetric::{Law, Settings};
use nalgebra::Vector3;

const MU: f64 = 0.3;

/// Why heads and tails are not alike.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Faces {
    /// A draft in degrees.
    Draft(f64),
    /// The centre of mass, at this share of H from the middle.
    Centre(f64),
}

use Faces::{Centre, Draft};

impl Faces {
    fn turned_over(self) -> Self {
        match self {
            Draft(draft) => Draft(-draft),
            Centre(centre) => Centre(-centre),
        }
    }
}

/// Ratio, faces, e, friction lengths in R.
const SCENES: [(f64, Faces, f64, f64); 9] = [
    (0.85, Draft(10.0), 0.5, 0.01),
    (0.85, Draft(-15.0), 0.0, 0.003),
    (0.2, Draft(4.0), 0.5, 0.01),
    (2.0, Draft(10.0), 0.3, 0.01),
    (1.2, Draft(-20.0), 0.8, 0.02),
    (0.6, Draft(0.5), 0.5, 0.01),
    (0.85, Centre(0.2), 0.5, 0.01),
    (0.3, Centre(-0.1), 0.3, 0.01),
    (2.0, Centre(-0.25), 0.0, 0.003),
];

fn scene(ratio: f64, draft_deg: f64, e: f64, rho: f64) -> Scene {
    scene_of(ratio, Draft(draft_deg), e, rho)
}

pub(crate) fn scene_of(ratio: f64, faces: Faces, e: f64, rho: f64) -> Scene {
    let radius = 0.01;
    let surface = Surface::new(e, MU)
        .and_then(|surface| surface.with_friction_lengths(rho * radius, rho * radius))
        .expect("a valid surface");
    let coin = Coin::cylinder(ratio, radius)
        .and_then(|coin| match faces {
            Draft(draft_deg) => coin.with_draft(draft_deg),
            Centre(centre) => coin.with_centre_of_mass(centre, None, None),
        })
        .expect("a coin that rests on its edge");
    Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("valid gravity")
}

pub(crate) fn launch(scene: &Scene, seed: u64, toss: u64) -> Launch {
    Start::lively(&mut Dice::new(seed, toss)).launch(scene)
}

/// How many of 600 launches of the one coin show another face with the other.
pub(crate) fn faces_changed(one: &Scene, other: &Scene, seed: u64) -> usize {
    let [before, after] = [one, other].map(Tosser::new);
    let changes = |toss: &u64| {
        let launch = launch(one, seed, *toss);
        after.toss(&launch).face() != before.toss(&launch).face()
    };
    (0..600).filter(changes).count()
}

/// A coin with the draft, or the centre, turned the other way, and its launch turned over, is the same body with heads
/// and tails exchanged: to the last bit.
#[test]
fn turning_the_coin_over_exchanges_heads_and_tails() {
    for law in Law::ALL {
        for (ratio, faces, e, rho) in SCENES {
            let [one, other] =
                [faces, faces.turned_over()].map(|faces| scene_of(ratio, faces, e, rho));
            let engines = [&one, &other].map(|scene| Tosser::of(scene, law));
            for toss in 0..100 {
                let launch = launch(&one, 300, toss);
                let found = engines[0].toss(&launch);
                let image = engines[1].toss(&flipped(&launch));
                assert_eq!(
                    turned(found.face()),
                    image.face(),
                    "{ratio} {faces:?} {toss}"
                );
                assert_eq!(found.impacts, image.impacts);
                assert_eq!(found.contact_steps, image.contact_steps);
            }
        }
    }
}

/// Without bounces a toss depends smoothly on the draft: at a millionth of a degree hardly any coin ends
/// elsewhere than the cylinder, and the more do the larger it is.
#[test]
fn a_small_draft_is_nearly_a_cylinder() {
    let cylinder = scene(0.85, 0.0, 0.0, 0.01);
    let faces = |draft: f64| faces_changed(&cylinder, &scene(0.85, draft, 0.0, 0.01), 301);
    let (tiny, small, large) = (faces(1e-6), faces(0.1), faces(15.0));
    assert!(
        tiny <= 2 && small <= 20 && large > 40,
        "{tiny} {small} {large}"
    );
}

/// In flight energy and angular momentum stay, and neither impacts nor contact gain energy.
#[test]
fn nothing_gains_energy_and_flights_conserve() {
    for law in Law::ALL {
        for (ratio, faces, e, rho) in SCENES {
            let scene = scene_of(ratio, faces, e, rho);
            let (engine, model) = (Tosser::of(&scene, law), Model::new(&scene));
            for toss in 0..60 {
                let launch = launch(&scene, 302, toss);
                let mut extremes = Extremes::new(&scene);
                engine.observe(&launch, &mut extremes);
                let Extremes {
                    gain, drift, gap, ..
                } = extremes;
                assert!(
                    gain < 1e-12 && drift < 1e-12 && gap < 1e-11,
                    "{gain} {drift} {gap}"
                );
                let (_, moments) = engine.record(&scene, &launch);
                for (from, to) in flights(&moments) {
                    let momentum = |at: &coinmc_oracle::Motion| model.inertia(&at.axis) * at.spin;
                    let change = momentum(&to.motion) - momentum(&from.motion);
                    assert!(
                        change.norm() < 1e-11,
                        "{ratio} {faces:?} {toss}: {change:?}"
                    );
                }
            }
        }
    }
}

/// Flights end at the first contact of either rim: nowhere before has the oracle's flight a gap below 0.
#[test]
fn flights_end_at_the_first_contact_of_either_rim() {
    let (mut seen, mut turns) = (0, 0);
    for (ratio, faces, e, rho) in SCENES {
        let scene = scene_of(ratio, faces, e, rho);
        let (engine, model) = (Tosser::new(&scene), Model::new(&scene));
        for toss in 0..30 {
            let (_, moments) = engine.record(&scene, &launch(&scene, 303, toss));
            for (from, to) in flights(&moments) {
                let duration = to.time - from.time;
                for part in 1..60 {
                    let mut motion = from.motion;
                    motion.fly(&model, duration * f64::from(part) / 60.0);
                    assert!(motion.gap(&model) > -1e-11, "{ratio} {faces:?} {toss}");
                }
                let mut end = from.motion;
                end.fly(&model, duration);
                assert!(
                    end.gap(&model).abs() < 1e-11 && (end.axis - to.motion.axis).norm() < 1e-10
                );
                seen += 1;
                turns += u32::from(from.motion.axis.z * to.motion.axis.z < 0.0);
            }
        }
    }
    assert!(seen > 500 && turns > 100, "{seen} {turns}");
}

/// A launch of a coin that lies on its edge: its axis along x but for the tilt, with the given velocity
/// along y and angular velocity.
pub(crate) fn on_edge(scene: &Scene, off: f64, speed: f64, spin: Vector3<f64>) -> Launch {
    // with heads up
    let [rim, _] = LowerRim::of(&scene.coin);
    let (sin, cos) = rim.on_edge();
    let tilt = libm::atan2(sin, cos) + off;
    let (sin, cos) = libm::sincos(tilt);
    Start {
        z: 0.0,
        velocity: Vector3::y() * speed,
        axis: Vector3::new(sin, 0.0, cos),
        spin,
    }
    .launch(scene)
}

/// At rest on its edge the coin stays there; let go within the well on either side it falls back, beyond the
/// balance onto a face. (From just within the higher barrier it may rock over the lower one.)
#[test]
fn the_edge_is_a_place_to_rest() {
    for (ratio, faces, _, rho) in SCENES {
        let scene = scene_of(ratio, faces, 0.0, rho);
        let engine = Tosser::new(&scene);
        let [rim, _] = LowerRim::of(&scene.coin);
        let edge_tilt = libm::atan2(rim.on_edge().0, rim.on_edge().1);
        let [own, other] = LowerRim::of(&scene.coin).map(|rim| libm::acos(rim.balance()));
        // from the edge to the balance on the rim of tails, and on that of heads
        let (to_heads, to_tails) = (own - edge_tilt, std::f64::consts::PI - other - edge_tilt);
        assert!(to_heads < 0.0 && to_tails > 0.0);
        // a height below the lower of the two barriers
        let (near, far) = (to_tails.min(-to_heads), to_tails.max(-to_heads));
        let within = 0.4 * near * near / far;
        for (off, face) in [
            (0.0, Face::Side),
            (-within, Face::Side),
            (1.05 * to_heads, Face::Heads),
            (within, Face::Side),
            (1.05 * to_tails, Face::Tails),
        ] {
            let found = engine.toss(&on_edge(&scene, off, 0.0, Vector3::zeros()));
            assert_eq!(found.face(), Some(face), "{ratio} {faces:?} {off}");
        }
    }
}

/// A coin that rolls on its edge goes in a circle about the apex of the cone, which stays where it is, and
/// comes to rest after v²/2a, a = ρ_c ζ/(s(ζ² + k_a s² + k_t c²)).
#[test]
fn a_coin_that_rolls_on_its_edge_circles_the_apex() {
    let scene = scene(0.85, 10.0, 0.0, 0.01);
    let [rim, _] = LowerRim::of(&scene.coin);
    let ((s, c), height, body) = (rim.on_edge(), rim.height_on_edge(), rim.body);
    // too slow for the energy to carry it over a rim it would be decided at once: fast
    let omega = 1.0;
    let spin = Vector3::x() * omega;
    let settings = Settings {
        decision: coinmc_volumetric::Decision::Energy,
        ..Settings::default()
    };
    let engine = Tosser::with(&scene, &settings);
    let launch = on_edge(&scene, 0.0, -height * omega, spin);
    let mut sampler = Sampler::new(200.0);
    let outcome = engine.observe(&launch, &mut sampler);
    assert_eq!(outcome.face(), Some(Face::Side));
    let length = scene.coin.rim_distance_m();
    let apex = |state: &coinmc_core::State| {
        let heading = Vector3::new(state.axis.x, state.axis.y, 0.0).normalize();
        state.position_m.xy() - heading.xy() * (length * height * s / c)
    };
    let rolling: Vec<_> = sampler
        .samples
        .iter()
        .filter(|sample| sample.kind == coinmc_core::EventKind::Sticking)
        .collect();
    assert!(rolling.len() > 50, "{}", rolling.len());
    let first = apex(&rolling[0].state);
    let mut angle = 0.0;
    for pair in rolling.windows(2) {
        let [from, to] = [&pair[0].state, &pair[1].state];
        assert!((apex(to) - first).norm() < 0.02 * length, "{:?}", apex(to));
        let (a, b) = (from.axis.xy(), to.axis.xy());
        angle += libm::atan2(a.x * b.y - a.y * b.x, a.dot(&b));
    }
    let inertia = height * height + body.ka * s * s + body.kt * c * c;
    let slows = 0.01 * scene.coin.radius_m() / length * height / (s * inertia);
    let speed = rolling[0].state.velocity_m_s.norm() * scene.time_scale_s() / length;
    let way = speed * speed / (2.0 * slows);
    let expected = way * (c / (s * height)).abs();
    assert!(
        (angle.abs() / expected - 1.0).abs() < 0.03,
        "{angle} {expected}"
    );
}

/// Ten times finer, few tosses without bounces end elsewhere.
#[test]
fn outcomes_do_not_hang_on_the_tolerance() {
    let scene = scene(0.85, 12.0, 0.0, 0.01);
    let default = Settings::default();
    let finer = Settings {
        tolerance: 0.1 * default.tolerance,
        zeno: 0.25 * default.zeno,
        stick_speed: 0.25 * default.stick_speed,
        ..default
    };
    let (coarse, fine) = (Tosser::new(&scene), Tosser::with(&scene, &finer));
    let differ = (0..800)
        .filter(|&toss| {
            let launch = launch(&scene, 305, toss);
            coarse.toss(&launch).face() != fine.toss(&launch).face()
        })
        .count();
    assert!(differ <= 12, "{differ}");
}

#[test]
fn an_observer_changes_nothing_and_a_run_is_its_tosses() {
    let scene = scene(0.85, 10.0, 0.5, 0.01);
    let launches: Vec<_> = (0..200).map(|toss| launch(&scene, 306, toss)).collect();
    let engine = Tosser::new(&scene).0;
    conformance::outcomes_depend_on_the_launch_alone(&engine, &launches);
    for launch in &launches[..40] {
        let mut sampler = Sampler::new(500.0);
        let seen = engine.toss(&mut (), launch, &mut sampler);
        assert_eq!(seen, engine.toss(&mut (), launch, &mut ()));
        for sample in &sampler.samples {
            let state = &sample.state;
            let lowest = state.position_m.z + scene.coin.lowest_point_m(&state.axis).z;
            assert!(lowest > -1e-9, "{state:?}");
        }
    }
}

/// Dropped without spin onto a surface to which it sticks, a coin ends in the well over which its axis points:
/// of a uniform direction (1 − h/D)/2 are heads, h and D of the rim of tails, and likewise tails. Within 4
/// standard errors (false alarms with other seeds: 1e-4).
#[test]
fn a_coin_that_sticks_shows_the_solid_angles_of_its_wells() {
    for (ratio, faces) in [
        (0.85, Draft(10.0)),
        (2.0, Draft(-15.0)),
        (0.85, Centre(0.2)),
    ] {
        let scene = adhesive(scene_of(ratio, faces, 0.0, 0.01));
        let engine = Tosser::new(&scene);
        let [heads, tails] = scene
            .coin
            .rims()
            .map(|rim| 0.5 * (1.0 - rim.distance_m / libm::hypot(rim.radius_m, rim.distance_m)));
        let launches = Preset::Drop.distribution();
        let stream = Stream::new(43, Domain::Launch, 0);
        let (tosses, mut found) = (10_000, [0.0; 2]);
        for toss in 0..tosses {
            let launch = launches.launch(&scene.coin, &mut stream.toss(toss));
            match engine.toss(&launch).face() {
                Some(Face::Heads) => found[0] += 1.0,
                Some(Face::Tails) => found[1] += 1.0,
                _ => {}
            }
        }
        // on the rim of the other face
        for (found, expected) in found.into_iter().zip([tails, heads]) {
            let error = (expected * (1.0 - expected) / tosses as f64).sqrt();
            let p = found / tosses as f64;
            assert!(
                (p - expected).abs() < 4.0 * error,
                "{ratio} {faces:?}: {p} {expected}"
            );
        }
    }
}

/// P of all three faces against the oracle: paired differences within 3 standard errors and .002 for the
/// oracle's step (false alarms with other seeds: 3e-3 a face).
#[test]
fn tosses_agree_with_the_oracle() {
    for (ratio, faces, e) in [
        (0.85, Draft(12.0), 0.5),
        (0.3, Draft(5.0), 0.0),
        (0.85, Centre(0.2), 0.5),
        (1.5, Centre(-0.25), 0.0),
    ] {
        let scene = scene_of(ratio, faces, e, 0.02);
        let engine = Tosser::new(&scene);
        let mut oracle = TimeStepper::new(&scene, StepperSettings::default());
        let stream = Stream::new(41, Domain::Launch, 0);
        let launches = Preset::Clean.distribution();
        let tosses = 400;
        let mut gained = [[0_u32; 2]; 3];
        for toss in 0..tosses {
            let launch = launches.launch(&scene.coin, &mut stream.toss(toss));
            let faces = [engine.toss(&launch).face(), oracle.toss(&launch).face];
            for (gained, face) in gained
                .iter_mut()
                .zip([Face::Heads, Face::Tails, Face::Side])
            {
                let is = faces.map(|found| found == Some(face));
                gained[0] += u32::from(is[0] && !is[1]);
                gained[1] += u32::from(is[1] && !is[0]);
            }
        }
        for [engine, oracle] in gained {
            let bias = (f64::from(engine) - f64::from(oracle)) / tosses as f64;
            let error = f64::from(engine + oracle).sqrt() / tosses as f64;
            assert!(
                bias.abs() <= 3.0 * error + 0.002,
                "{ratio} {faces:?}: {gained:?}"
            );
        }
    }
}
