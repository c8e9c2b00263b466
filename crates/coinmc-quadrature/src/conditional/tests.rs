use super::*;
use coinmc_core::{Coin, Domain, Drag, Engine, Face, Landing, Preset, Spin, Stream, Surface};
use coinmc_flat::FlatEngine;
use coinmc_volumetric::VolumetricEngine;
use nalgebra::{UnitVector3, Vector3};

/// Tosses of one combination.
const TOSSES: u64 = 400;

fn scene(ratio: f64, drag: f64, gyroscopic: bool) -> Scene {
    let surface = Surface::new(0.0, 0.0)
        .unwrap()
        .with_landing(Landing::Adhesive)
        .expect("a level surface");
    let scene = Scene::new(Coin::cylinder(ratio, 0.01).unwrap(), surface, 9.81).unwrap();
    scene
        .with_drag(Drag::new(drag, 2.0 * drag).unwrap())
        .with_gyroscopic_torque(gyroscopic)
}

/// Launches at and above D, slow and fast, thrown up and down.
fn launches() -> Vec<LaunchDistribution> {
    let uniform = |from, to| Marginal::Uniform { from, to };
    let table1 = Preset::Table1.distribution();
    let about = Spin::About {
        axis: UnitVector3::new_normalize(Vector3::new(1.0, 2.0, 0.5)),
        rate_rad_s: uniform(-300.0, 300.0),
    };
    let near = LaunchDistribution {
        height_m: uniform(0.052, 0.06),
        velocity_m_s: [
            Marginal::Constant(0.5),
            uniform(-1.0, 1.0),
            uniform(-2.0, 2.0),
        ],
        ..table1
    };
    vec![
        table1,
        near,
        LaunchDistribution {
            spin: about,
            ..near
        },
        LaunchDistribution {
            height_m: uniform(0.052, 0.06),
            ..Preset::Hand.distribution()
        },
    ]
}

/// The place of a face among probabilities.
fn place_of(face: Face) -> usize {
    Face::ALL.iter().position(|known| *known == face).unwrap()
}

/// A coin of this tilt that is dropped and turns in the plane of the tilt.
fn dropped(tilt: Marginal, height_m: f64, rate_rad_s: Marginal) -> LaunchDistribution {
    LaunchDistribution {
        orientation: Orientation::Tilt(tilt),
        height_m: Marginal::Constant(height_m),
        velocity_m_s: [Marginal::Constant(0.0); 3],
        spin: Spin::About {
            axis: Vector3::y_axis(),
            rate_rad_s,
        },
    }
}

/// The face of the axis at the passage, with every quantity given.
fn at_passage(scene: &Scene, launch: &Launch) -> Face {
    let given = LaunchDistribution {
        height_m: Marginal::Constant(launch.height_m),
        velocity_m_s: [0, 1, 2].map(|i| Marginal::Constant(launch.velocity_m_s[i])),
        orientation: Orientation::Fixed(launch.axis),
        spin: Spin::Components([0, 1, 2].map(|i| Marginal::Constant(launch.spin_rad_s[i]))),
    };
    let mut stream = Stream::new(0, Domain::Launch, 0).toss(0);
    let mut found = Vec::new();
    for variable in [Variable::Velocity, Variable::Height] {
        let conditional = Conditional::new(scene, &given, variable);
        let faces = conditional.faces(&mut stream, 0.5).p;
        let decided = Face::ALL.into_iter().zip(faces).find(|(_, p)| *p > 0.5);
        found.push(decided.unwrap().0);
    }
    assert_eq!(found[0], found[1]);
    found[0]
}

/// Every toss ends on the face of the axis at the passage.
fn assert_tosses_agree(
    engine: &impl Engine<Workspace = ()>,
    scene: &Scene,
    launches: &LaunchDistribution,
) {
    let stream = Stream::new(7, Domain::Launch, 0);
    for toss in 0..TOSSES {
        let launch = launches.launch(&scene.coin, &mut stream.toss(toss));
        let tossed = engine.toss(&mut (), &launch, &mut ()).face();
        let expected = at_passage(scene, &launch);
        assert_eq!(tossed, Some(expected), "{scene:?} {launches:?} {toss}");
    }
}

/// The theorem of the crate's overview, toss by toss against the search for the first contact: none
/// of 9600 tosses differs. A toss within 1e-9 of a border might.
#[test]
fn the_axis_at_the_passage_decides_spatial_tosses() {
    for launches in launches() {
        for (ratio, drag, gyroscopic) in [
            (0.2, 0.0, true),
            (1.0, 0.0, true),
            (4.0, 0.0, true),
            (0.5, 0.4, true),
            (1.0, 0.0, false),
            (2.0, 3.0, false),
        ] {
            let scene = scene(ratio, drag, gyroscopic);
            let engine = VolumetricEngine::new(
                &scene,
                &coinmc_volumetric::Settings::default(),
                coinmc_volumetric::Moreau,
            )
            .unwrap();
            assert_tosses_agree(&engine, &scene, &launches);
        }
    }
}

#[test]
fn the_axis_at_the_passage_decides_planar_tosses() {
    for preset in [Preset::Robot, Preset::CleanFlat] {
        for ratio in [0.1, 1.0, 3.0] {
            let scene = scene(ratio, 0.0, true);
            let settings = coinmc_flat::Settings::default();
            let engine = FlatEngine::new(&scene, &settings, coinmc_flat::Moreau).unwrap();
            let launches = LaunchDistribution {
                height_m: Marginal::Uniform {
                    from: 0.02,
                    to: 0.03,
                },
                ..preset.distribution()
            };
            assert_tosses_agree(&engine, &scene, &launches);
        }
    }
}

/// The closed form over a quantity is the share of its values that land on each face. With 4000
/// midpoints, each interval of values is wrong by one at either end.
#[test]
fn the_closed_form_is_the_mean_over_the_quantity() {
    let scene = scene(1.0, 0.3, true);
    let uniform = |from, to| Marginal::Uniform { from, to };
    let hand = Preset::Hand.distribution();
    let tilted = LaunchDistribution {
        orientation: Orientation::Tilt(uniform(-0.5, 4.0)),
        height_m: uniform(0.03, 0.2),
        velocity_m_s: [
            Marginal::Constant(0.0),
            Marginal::Constant(0.0),
            uniform(-1.0, 2.0),
        ],
        spin: Spin::About {
            axis: Vector3::y_axis(),
            rate_rad_s: uniform(-40.0, 40.0),
        },
    };
    for launches in [hand, tilted] {
        for variable in [
            Variable::Tilt,
            Variable::Rate,
            Variable::Velocity,
            Variable::Height,
        ] {
            if launches == hand && matches!(variable, Variable::Tilt | Variable::Height) {
                continue;
            }
            for toss in 0..5 {
                let conditional = Conditional::new(&scene, &launches, variable);
                let mut stream = Stream::new(3, Domain::Launch, 0).toss(toss);
                let closed = conditional.faces(&mut stream, 0.5).p;
                let mut mean = [0.0; 3];
                for i in 0..4000 {
                    let p = (f64::from(i) + 0.5) / 4000.0;
                    let mut at = Overridden {
                        stream: &mut stream,
                        variable,
                        p,
                    };
                    let launch = launches.launch(&scene.coin, &mut at);
                    let face = at_passage(&scene, &launch);
                    mean[place_of(face)] += 1.0 / 4000.0;
                }
                for (closed, mean) in closed.iter().zip(mean) {
                    assert!(
                        (closed - mean).abs() < 0.012,
                        "{variable:?} {closed} {mean}"
                    );
                }
            }
        }
    }
}

/// The series and the sum over turns agree to rounding where both apply.
#[test]
fn the_series_agrees_with_the_sum_over_turns() {
    for (mean, sd) in [(0.3, 1.0), (-7.0, 1.7), (1000.0, 4.0), (2.0, 40.0)] {
        let marginal = Marginal::Normal { mean, sd };
        for (centre, half) in [(0.0, 0.4), (PI, 1.3), (PI, 3.1)] {
            let series = WideNormal { mean, sd }.within(centre, half);
            let turns = (-70..=230).map(|turn| {
                let middle = centre + f64::from(turn) * TAU;
                distribution(&marginal, middle + half) - distribution(&marginal, middle - half)
            });
            let sum: f64 = turns.sum();
            assert!((series - sum).abs() < 1e-13, "{mean} {sd} {centre} {half}");
        }
    }
}

/// The closed form over the azimuth is the share of azimuths about the spin that land on each face. With 1000 midpoints,
/// each of two arcs is wrong by two at most.
#[test]
fn the_azimuth_is_the_mean_over_the_circle_about_the_spin() {
    let clean = Preset::Clean.distribution();
    let count = 1000;
    for (number, (ratio, drag, gyroscopic)) in (0_u32..).zip([
        (0.5, 0.0, true),
        (2.0, 0.4, true),
        (1.0, 0.0, false),
        (1.0, 2.0, true),
    ]) {
        let scene = scene(ratio, drag, gyroscopic);
        let conditional = Conditional::new(&scene, &clean, Variable::Azimuth);
        for case in 0..6 {
            let mut words = Stream::new(9, Domain::Launch, u64::from(number)).toss(case);
            let mut between = |from: f64, to: f64, i| from + (to - from) * words.uniform(i);
            let spin = if case == 0 {
                Vector3::zeros()
            } else {
                Vector3::new(
                    between(-40.0, 40.0, 0),
                    between(-40.0, 40.0, 1),
                    between(-40.0, 40.0, 2),
                )
            };
            let along = between(-1.0, 1.0, 3);
            let height_m = between(0.05, 0.5, 4);
            let velocity_m_s = Vector3::new(0.0, 0.0, between(-1.0, 1.0, 5));
            let launch = |axis: Vector3<f64>| Launch {
                height_m,
                velocity_m_s,
                axis: UnitVector3::new_normalize(axis),
                spin_rad_s: spin,
            };
            let about = spin.try_normalize(0.0).unwrap_or_else(Vector3::x);
            let across = about.cross(&Vector3::new(0.3, -0.5, 0.8)).normalize();
            let other = about.cross(&across);
            let radius = (1.0 - along * along).sqrt();
            let mut mean = [0.0; 3];
            for i in 0..count {
                let (sin, cos) = libm::sincos(TAU * (f64::from(i) + 0.5) / f64::from(count));
                let axis = about * along + (across * cos + other * sin) * radius;
                let face = at_passage(&scene, &launch(axis));
                mean[place_of(face)] += 1.0;
            }
            let drawn = launch(Vector3::new(radius, 0.0, along));
            let closed = conditional.over_azimuth(&drawn);
            assert!((closed.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            for (closed, mean) in closed.iter().zip(mean) {
                let error = (closed - mean / f64::from(count)).abs();
                assert!(
                    error <= 4.0 / f64::from(count),
                    "{number} {case}: {closed} {mean}"
                );
            }
        }
    }
}

/// On the circle z = a + b cos φ heads shows above the border and tails below its opposite.
#[test]
fn shares_are_those_of_the_circle() {
    for (border, along, across) in [
        (0.3, 0.1, 0.8),
        (0.5, -0.4, 0.3),
        (0.2, 0.9, 0.05),
        (0.4, 0.0, 0.2),
    ] {
        let count = 20_000;
        let heights = (0..count)
            .map(|i| along + across * libm::cos(TAU * (f64::from(i) + 0.5) / f64::from(count)));
        let mut mean = [0.0; 3];
        for z in heights {
            mean[if z > border {
                0
            } else if z < -border {
                1
            } else {
                2
            }] += 1.0 / f64::from(count);
        }
        let shares = shares_of_circle(border, along, across);
        assert!(
            shares
                .iter()
                .zip(mean)
                .all(|(share, mean)| (share - mean).abs() < 2e-4),
            "{shares:?} {mean:?}"
        );
    }
}

/// A quantity that is spread over thousands of turns is drawn: one face has probability 1, that of a launch with the
/// drawn value. Whether it is, does not depend on the values of the others.
#[test]
fn a_quantity_of_too_many_turns_is_drawn() {
    let scene = scene(1.0, 0.0, true);
    let launches = dropped(
        Marginal::Constant(0.4),
        0.5,
        Marginal::Uniform {
            from: -1e5,
            to: 1e5,
        },
    );
    let conditional = Conditional::new(&scene, &launches, Variable::Rate);
    assert!(!conditional.is_integrable());
    let mut seen = [0; 3];
    for i in 0..60 {
        let p = (f64::from(i) + 0.5) / 60.0;
        let mut stream = Stream::new(3, Domain::Launch, 0).toss(0);
        let faces = conditional.faces(&mut stream, p);
        let mut at = Overridden {
            stream: &mut stream,
            variable: Variable::Rate,
            p,
        };
        let face = at_passage(&scene, &launches.launch(&scene.coin, &mut at));
        let place = place_of(face);
        let mut expected = [0.0; 3];
        expected[place] = 1.0;
        assert!(
            faces.drawn && faces.p == expected,
            "{i}: {faces:?} {face:?}"
        );
        seen[place] += 1;
    }
    assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
}

/// Where a normal tilt or rate spreads the phase over a radian or more, its series gives shares that sum to 1, and
/// those of many quantiles.
#[test]
fn a_wide_normal_quantity_is_the_mean_over_its_quantiles() {
    let scene = scene(1.0, 0.0, true);
    let wide = dropped(
        Marginal::Constant(0.4),
        0.2,
        Marginal::Normal { mean: 9.0, sd: 6.0 },
    );
    let conditional = Conditional::new(&scene, &wide, Variable::Rate);
    let mut stream = Stream::new(3, Domain::Launch, 0).toss(0);
    let phases = Phases::new(
        &conditional,
        conditional.rest.launch(&scene.coin, &mut stream),
    );
    let normal = phases.wide_normal().expect("a wide phase");
    // cos(tilt + rate·τ): the free fall takes τ
    let fall = (2.0 * (0.2 - scene.coin.rim_distance_m()) / 9.81_f64).sqrt();
    assert!((normal.sd - 6.0 * fall).abs() < 1e-12 && normal.sd > 1.0);
    let closed = conditional.faces(&mut stream, 0.5).p;
    assert!((closed.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    let count = 2000;
    let mut mean = [0.0; 3];
    for i in 0..count {
        let mut at = Overridden {
            stream: &mut stream,
            variable: Variable::Rate,
            p: (f64::from(i) + 0.5) / f64::from(count),
        };
        let face = at_passage(&scene, &wide.launch(&scene.coin, &mut at));
        mean[place_of(face)] += 1.0 / f64::from(count);
    }
    assert!(
        closed.iter().zip(mean).all(|(a, b)| (a - b).abs() < 0.01),
        "{closed:?} {mean:?}"
    );
}

/// A coin that starts at D with no speed upwards has no time to turn, at whatever rate: it lands on the face that is up.
#[test]
fn a_coin_without_time_to_turn_keeps_its_face() {
    let scene = scene(1.0, 0.0, true);
    for (tilt, expected) in [
        (0.4, [1.0, 0.0, 0.0]),
        (1.5, [0.0, 0.0, 1.0]),
        (3.0, [0.0, 1.0, 0.0]),
    ] {
        let launches = dropped(
            Marginal::Constant(tilt),
            scene.coin.rim_distance_m(),
            Marginal::Uniform { from: 1.0, to: 2.0 },
        );
        let conditional = Conditional::new(&scene, &launches, Variable::Rate);
        let mut stream = Stream::new(3, Domain::Launch, 0).toss(0);
        assert_eq!(conditional.faces(&mut stream, 0.5).p, expected, "{tilt}");
    }
}

/// A phase of more than 1e9 has too few digits left for the sum over turns, however little it is spread.
#[test]
fn a_phase_without_digits_is_drawn() {
    let scene = scene(1.0, 0.0, true);
    for (rate, over) in [(1e8, true), (1e11, false), (-1e11, false)] {
        let launches = dropped(
            Marginal::Uniform { from: 0.0, to: 1.0 },
            1.0,
            Marginal::Constant(rate),
        );
        let conditional = Conditional::new(&scene, &launches, Variable::Tilt);
        assert_eq!(conditional.is_integrable(), over, "{rate}");
    }
}

/// The uniforms of a toss, with that of one quantity replaced.
struct Overridden<'a> {
    stream: &'a mut coinmc_core::TossUniforms,
    variable: Variable,
    p: f64,
}

impl UniformSource for Overridden<'_> {
    fn uniform(&mut self, dimension: u32) -> f64 {
        let own = match self.variable {
            Variable::Tilt | Variable::Azimuth => 0,
            Variable::Rate => 3,
            Variable::Velocity => 9,
            Variable::Height => 6,
        };
        if dimension == own {
            self.p
        } else {
            self.stream.uniform(dimension)
        }
    }
}
