//! Tilted tables: motion whose way is known, energy, symmetry, and the time-stepping oracle.

use crate::common::Tosser;
use coinmc_core::{
    Coin, Drag, Ended, Event, Face, Launch, Observer, Preset, Roughness, Scene, Surface, TableTilt,
};
use coinmc_oracle::{StepperSettings, TimeStepper};
use coinmc_testkit::{Instants, preset_launch};
use nalgebra::{UnitVector3, Vector3};

const RADIUS: f64 = 0.01;
const CONTOUR: f64 = 1e-4;
const GRAVITY: f64 = 9.81;

fn table(ratio: f64, mu: f64, tilt_deg: f64, downhill_deg: f64) -> Scene {
    let tilt = TableTilt::new(tilt_deg, downhill_deg).expect("a valid tilt");
    let surface = Surface::new(0.5, mu)
        .and_then(|surface| surface.with_friction_lengths(CONTOUR, 1e-5))
        .and_then(|surface| surface.with_tilt(tilt))
        .expect("a valid surface");
    let coin = Coin::cylinder(ratio, RADIUS).expect("a valid coin");
    Scene::new(coin, surface, GRAVITY).expect("valid gravity")
}

fn with_edge(mut scene: Scene, radius_m: f64) -> Scene {
    scene.surface = scene.surface.with_table_radius(radius_m).expect("a radius");
    scene
}

/// A launch that is `lab` in axes of the table. (The tilt turned back is the tilt the other way.)
fn in_laboratory(scene: &Scene, lab: &Launch) -> Launch {
    let tilt = scene.surface.tilt().expect("a tilt");
    let back = TableTilt::new(tilt.angle_deg(), tilt.direction_deg() + 180.0).expect("a tilt");
    Launch {
        height_m: lab.height_m / tilt.cos(),
        velocity_m_s: back.in_table_axes(&lab.velocity_m_s),
        axis: UnitVector3::new_normalize(back.in_table_axes(&lab.axis)),
        spin_rad_s: back.in_table_axes(&lab.spin_rad_s),
    }
}

/// A coin on its side that rolls along y at `speed`, in axes of the table.
fn wheel(scene: &Scene, speed: f64) -> Launch {
    let launch = Launch {
        height_m: RADIUS,
        velocity_m_s: Vector3::new(0.0, speed, 0.0),
        axis: UnitVector3::new_normalize(Vector3::new(1.0, 0.0, 1e-7)),
        spin_rad_s: Vector3::new(-speed / RADIUS, 0.0, 0.0),
    };
    in_laboratory(scene, &launch)
}

/// A wheel of speed v rolls v²/2a far, with (1 + I_a/mR²) a = ρ_c g cos β/R and g sin β more uphill, or
/// less downhill; where rolling friction does not hold it, it rolls on for ever.
#[test]
fn a_wheel_rolls_up_and_down() {
    let hold = libm::atan(CONTOUR / RADIUS).to_degrees();
    for ratio in [0.2, 0.85] {
        for (share, direction, sign) in [(0.5, 90.0, -1.0), (0.9, -90.0, 1.0), (0.7, 0.0, 0.0)] {
            let tilt_deg = share * hold;
            let scene = table(ratio, 0.3, tilt_deg, direction);
            let (sin, cos) = libm::sincos(tilt_deg.to_radians());
            let slows = GRAVITY * (CONTOUR / RADIUS * cos + sign * sin) / 1.5;
            let way_m: f64 = 0.2;
            let launch = wheel(&scene, (2.0 * slows * way_m).sqrt());
            let ends = |radius_m: f64| Tosser::new(&with_edge(scene, radius_m)).toss(&launch).ended;
            assert_eq!(
                ends(1.01 * way_m),
                Ended::Decided(Face::Side),
                "{ratio} {share}"
            );
            assert_eq!(ends(0.99 * way_m), Ended::Left, "{ratio} {share}");
        }
        for direction in [90.0, -90.0] {
            let scene = table(ratio, 0.3, 1.1 * hold, direction);
            let launch = wheel(&scene, 0.05);
            let endless = Tosser::new(&scene).toss(&launch);
            assert_eq!(endless.ended, Ended::Decided(Face::Side));
            assert_eq!(
                endless.side_ending.map(|ending| ending.roll_bounds_passed),
                Some(7)
            );
            let ends = Tosser::new(&with_edge(scene, 1e3)).toss(&launch).ended;
            assert_eq!(ends, Ended::Left, "{ratio} {direction}");
        }
    }
}

/// A coin that falls straight down onto the middle of a table stays, however far from the table's normal it began; and one
/// that is thrown so that it lands beyond the edge leaves where it lands.
#[test]
fn a_coin_above_a_tilted_table_is_not_beyond_its_edge() {
    let scene = table(0.3, 0.9, 5.0, 30.0);
    let launch = |x: f64| Launch {
        height_m: 1.0,
        velocity_m_s: Vector3::new(x, 0.0, 0.0),
        axis: UnitVector3::new_unchecked(Vector3::z()),
        spin_rad_s: Vector3::zeros(),
    };
    for (radius_m, speed, leaves) in [(0.05, 0.0, false), (0.05, 0.5, true), (0.4, 0.5, false)] {
        let mut scene = with_edge(scene, radius_m);
        scene.surface = scene.surface.with_impact(0.0, 0.9).expect("a surface");
        let toss = Tosser::new(&scene).toss(&launch(speed));
        assert_eq!(
            toss.ended == Ended::Left,
            leaves,
            "{radius_m} {speed}: {toss:?}"
        );
    }
}

/// A coin across the slope falls over where the pull does: R tan β > H/2.
#[test]
fn a_thin_coin_across_the_slope_falls_over() {
    for (ratio, falls) in [(0.1, true), (0.25, false)] {
        // tan 5° = .0875, between .05 and .125
        let scene = table(ratio, 0.3, 5.0, 0.0);
        let face = Tosser::new(&scene).toss(&wheel(&scene, 0.0)).face();
        // onto the face that its axis points down the slope with, tails up
        let expected = if falls { Face::Tails } else { Face::Side };
        assert_eq!(face, Some(expected), "{ratio}");
    }
}

/// In the laboratory the centre of a flying coin falls straight down, with and without drag.
#[test]
fn flight_is_that_of_the_laboratory() {
    for drag in [0.0, 2.0] {
        let scene = table(0.85, 0.3, 8.0, 40.0).with_drag(Drag::new(drag, 0.0).expect("drag"));
        let tilt = scene.surface.tilt().expect("a tilt");
        let launch = Launch {
            height_m: 0.5,
            velocity_m_s: Vector3::new(0.3, -0.2, 1.0),
            axis: UnitVector3::new_normalize(Vector3::new(0.3, 0.4, 0.8)),
            spin_rad_s: Vector3::new(30.0, -20.0, 40.0),
        };
        let mut seen = Instants::new(vec![0.05, 0.15, 0.3]);
        Tosser::new(&scene).observe(&launch, &mut seen);
        assert_eq!(seen.seen.len(), 3);
        for state in &seen.seen {
            let t = state.time_s;
            let (once, twice) = if drag == 0.0 {
                (t, 0.5 * t * t)
            } else {
                let once = -libm::expm1(-drag * t) / drag;
                (once, (t - once) / drag)
            };
            let expected = Vector3::new(0.0, 0.0, 0.5) + launch.velocity_m_s * once
                - Vector3::z() * GRAVITY * twice;
            let off = (state.position_m - tilt.in_table_axes(&expected)).norm();
            assert!(off < 1e-12, "{drag} {t}: {off:e}");
        }
    }
}

/// The largest gain of energy from one event to the next, as a share of the first.
struct Gain<'a> {
    scene: &'a Scene,
    energy: Option<f64>,
    largest: f64,
}

impl Observer for Gain<'_> {
    fn event(&mut self, event: &Event) {
        let now = event.state.energy_j_kg(self.scene);
        if let Some(before) = self.energy {
            self.largest = self.largest.max((now - before) / GRAVITY / RADIUS);
        }
        self.energy = Some(now);
    }
}

/// No event gains energy: 1e-12 m g R is rounding. (On rough ground slopes give some ahead of the way
/// down, and take it back.)
#[test]
fn nothing_gains_energy() {
    let mut events = 0;
    for ratio in [0.2, 0.7, 1.2] {
        let scene = table(ratio, 0.3, 4.0, 20.0);
        let engine = Tosser::new(&scene);
        for toss in 0..40 {
            let launch = preset_launch(Preset::Hand, &scene, 31, toss);
            let mut gain = Gain {
                scene: &scene,
                energy: None,
                largest: 0.0,
            };
            let outcome = engine.observe(&launch, &mut gain);
            events += outcome.impacts;
            assert!(gain.largest < 1e-11, "{ratio} {toss}: {:e}", gain.largest);
        }
    }
    assert!(events > 1_000, "{events}");
}

/// The coin turned end for end shows the other face.
#[test]
fn heads_and_tails_exchange() {
    let mut scene = with_edge(table(0.4, 0.3, 3.0, 0.0), 0.3);
    for slope in [0.0, 0.03] {
        scene.surface = scene
            .surface
            .with_roughness(Roughness::new(slope, 3e-3).ok());
        let engine = Tosser::new(&scene);
        let differ = (0..60)
            .filter(|&toss| {
                let launch = preset_launch(Preset::Hand, &scene, 32, toss);
                let flipped = Launch {
                    axis: -launch.axis,
                    ..launch
                };
                let (face, other) = (engine.toss(&launch).face(), engine.toss(&flipped).face());
                other
                    != face.map(|face| match face {
                        Face::Heads => Face::Tails,
                        Face::Tails => Face::Heads,
                        Face::Side => Face::Side,
                    })
            })
            .count();
        assert_eq!(differ, 0, "{slope}");
    }
}

/// A tilt of 1e-6 degrees changes next to nothing: of 300 tosses without bounces at most 3 end on another
/// face. (A tilted table follows them to rest, a level one as far as the rule `tilting`, whose bias is below
/// 1e-3.) On rough ground every toss meets other ground, so P(side) is compared: within 3.3 standard errors
/// (false alarms: 1e-3).
#[test]
fn a_table_almost_level_is_level() {
    for (ratio, restitution, slope) in [(0.3, 0.0, 0.0), (0.85, 0.0, 0.0), (0.85, 0.5, 0.03)] {
        let surface = Surface::new(restitution, 0.3)
            .and_then(|surface| surface.with_friction_lengths(CONTOUR, 1e-5))
            .expect("a valid surface")
            .with_roughness(Roughness::new(slope, 3e-3).ok());
        let coin = Coin::cylinder(ratio, RADIUS).expect("a valid coin");
        let level = Scene::new(coin, surface, GRAVITY).expect("a valid scene");
        let mut tilted = level;
        let tilt = TableTilt::new(1e-6, 0.0).expect("a valid tilt");
        tilted.surface = surface.with_tilt(tilt).expect("a gentle slope");
        let engines = [Tosser::new(&level), Tosser::new(&tilted)];
        let (tosses, mut differ, mut sides) = (300, 0, [0; 2]);
        for toss in 0..tosses {
            let launch = preset_launch(Preset::Clean, &level, 33, toss);
            let faces = [0, 1].map(|i| engines[i].toss(&launch).face());
            assert!(faces[1].is_some(), "{ratio} {slope} {toss}");
            differ += u32::from(faces[0] != faces[1]);
            for (sides, face) in sides.iter_mut().zip(faces) {
                *sides += u32::from(face == Some(Face::Side));
            }
        }
        println!("H/R {ratio}, slope {slope}: {differ} of {tosses} differ, {sides:?} sides");
        if slope == 0.0 {
            assert!(differ <= 3, "{differ}");
        } else {
            let [a, b] = sides.map(f64::from);
            assert!((a - b).abs() < 3.3 * (a + b).sqrt(), "{a} {b}");
        }
    }
}

/// P(side) against the oracle, of which 100 tosses are made, and 1000 of the engine: within 3.3 standard
/// errors (false alarms: 1e-3), and .01 for the oracle's step.
#[test]
fn the_oracle_agrees() {
    for (ratio, tilt_deg) in [(0.5, 3.0), (1.0, 6.0)] {
        let scene = table(ratio, 0.3, tilt_deg, 0.0);
        let engine = Tosser::new(&scene);
        let settings = StepperSettings {
            step: 8e-3,
            time_limit: 60.0,
        };
        let mut stepper = TimeStepper::new(&scene, settings);
        let side = |face: Option<Face>| f64::from(u8::from(face == Some(Face::Side)));
        let (few, many) = (100, 1_000);
        let mut sums = [0.0; 2];
        for toss in 0..many {
            let launch = preset_launch(Preset::Clean, &scene, 34, toss);
            let ours = engine.toss(&launch);
            assert!(ours.face().is_some(), "{toss}: {:?}", ours.ended);
            sums[0] += side(ours.face());
            if toss < few {
                sums[1] += side(stepper.toss(&launch).face);
            }
        }
        let (n, m) = (many as f64, few as f64);
        let (ours, theirs) = (sums[0] / n, sums[1] / m);
        let error = (ours * (1.0 - ours) * (1.0 / n + 1.0 / m)).sqrt();
        println!("H/R {ratio}, {tilt_deg}°: engine {ours}, oracle {theirs} ± {error}");
        assert!((ours - theirs).abs() < 3.3 * error + 0.01);
    }
}
