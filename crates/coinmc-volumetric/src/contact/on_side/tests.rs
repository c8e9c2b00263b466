//! Ends of rolling and sliding on the side, rims that are held down, and coins that tip.

use super::*;
use crate::contact::Usage;
use crate::laws::Moreau;
use crate::model::Model;
use crate::place::Place;
use crate::settings::{Decision, Settings};
use crate::toss::tests::{generic_scene, model_of, stops_plainly};
use coinmc_core::{Coin, Scene, Surface};
use coinmc_testkit::Dice;
use coinmc_testkit::Recorder;
use nalgebra::Vector3;

/// A body that rolls straight on its side at `speed`, in the direction of its sign.
pub(crate) fn rolls(dynamics: &Dynamics, speed: f64) -> LineState {
    [0.0, speed, -speed / dynamics.body.outer_radius(), 0.0]
}

/// The way and the time of straight rolling, by its equation of motion: contour friction and drag slow it down,
/// and a pull along the way does not.
pub(crate) fn rolls_plainly(dynamics: &Dynamics, speed: f64, pull: f64) -> (f64, f64) {
    let (friction, drag) = (&dynamics.friction, &dynamics.drag);
    let radius = dynamics.body.outer_radius();
    let share = dynamics.body.ka / (radius * radius);
    let slowing = |v: f64| {
        let dragged = (drag.linear + drag.angular * share) * v;
        (friction.contour / radius + dragged - pull) / (1.0 + share)
    };
    stops_plainly(slowing, speed)
}

/// Where a coin is that has rolled straight to its end from there, the time by the clock of its toss, and the kinetic
/// energy that it is left with. Its face is decided.
fn rolled_to_rest(model: &Model<Moreau>, speed: f64, mut place: Place) -> (Place, f64, f64) {
    const BEGUN: f64 = 1.5;
    let dynamics = &model.dynamics;
    let mut solver = model.contact_solver(Usage {
        time: BEGUN,
        ..Usage::default()
    });
    let state = rolls(dynamics, speed);
    let (mut motion, mut spin) = line_motion(dynamics, &state);
    let mut adapter = ObserverAdapter {
        observer: &mut Recorder::default(),
        place: &mut place,
        heads_up: true,
        units: &model.units,
    };
    let exit = solver.roll_to_rest(&state, &mut motion, &mut spin, &mut adapter);
    assert_eq!(exit, Exit::Decided(Decided::Side));
    let left = motion.kinetic(&dynamics.body, &spin);
    (place, solver.usage.time - BEGUN, left)
}

/// Drag alone stops no coin in any time. One on an endless table is left where its face is decided, on a table with an
/// edge where it will be at last: v/b farther.
#[test]
fn a_coin_that_drag_alone_slows_down_is_where_it_is_decided() {
    for (radius_m, moves) in [(None, false), (Some(1.0), true)] {
        let scene = generic_scene(|plane| {
            let plane = plane
                .with_friction_lengths(0.0, 0.0)
                .expect("a valid surface");
            radius_m.map_or(plane, |radius| {
                plane.with_table_radius(radius).expect("a valid surface")
            })
        });
        let model = model_of(&scene, &Settings::default());
        let before = Place::origin([1.0, 0.0]);
        let (place, ..) = rolled_to_rest(&model, 0.4, before);
        let way = place.way_from(&before);
        let expected = RollingStop::new(&model.dynamics, 0.4).distance();
        let went = (way[0] * way[0] + way[1] * way[1]).sqrt();
        let due = if moves { expected } else { 0.0 };
        assert!(
            (went - due).abs() < 1e-12 && expected > 0.01,
            "{went} {due}"
        );
    }
}

/// Straight rolling ends where its equation of motion ends it, whichever way it goes and wherever in the
/// laboratory, and is shown until then.
#[test]
fn straight_rolling_ends_where_friction_and_drag_end_it() {
    let model = model_of(&generic_scene(|plane| plane), &Settings::default());
    let dynamics = &model.dynamics;
    for speed in [0.4, -0.9] {
        let before = Place::at([0.2, -0.1], [0.6, 0.8]);
        let (place, took, left) = rolled_to_rest(&model, speed, before);
        let (way, time) = rolls_plainly(dynamics, speed.abs(), 0.0);
        let [x, y] = before.in_frame(place.way_from(&before));
        assert!(x.abs() < 1e-12 && (y / way.copysign(speed) - 1.0).abs() < 1e-4);
        for took in [place.time, took] {
            assert!((took / time - 1.0).abs() < 1e-4, "{took} {time}");
        }
        assert_eq!(left, 0.0);
    }
}

/// A thick coin that slides along its axis on its side, at a speed that does not decide its face yet.
fn slides(settings: Settings, usage: Usage) -> (SideExit, Motion<f64>, Usage) {
    let coin = Coin::cylinder(2.0, 0.01).expect("a valid coin");
    let surface = Surface::new(0.5, 0.1).and_then(|it| it.with_friction_lengths(1e-4, 1e-5));
    let scene = Scene::new(coin, surface.expect("a valid surface"), 9.81);
    let settings = Settings {
        decision: Decision::Energy,
        ..settings
    };
    let model = model_of(&scene.expect("a valid scene"), &settings);
    let mut solver = model.contact_solver(usage);
    let (mut motion, mut spin) = line_motion(&model.dynamics, &[SLIDING, 0.0, 0.0, 0.0]);
    let mut adapter = ObserverAdapter {
        observer: &mut (),
        place: &mut Place::at([0.0; 2], [1.0, 0.0]),
        heads_up: true,
        units: &model.units,
    };
    let exit = solver.follow_on_side(&mut motion, &mut spin, &mut adapter);
    (exit, motion, solver.usage)
}

/// In sqrt(gD).
const SLIDING: f64 = 2.0;

/// Friction stops it by μ m g, and the clock goes on from where it was.
#[test]
fn sliding_on_the_side_takes_the_time_that_friction_takes() {
    for begun in [0.0, 3.0] {
        let usage = Usage {
            time: begun,
            ..Usage::default()
        };
        let (exit, motion, usage) = slides(Settings::default(), usage);
        assert!(matches!(
            exit,
            SideExit::Leaves(Exit::Decided(Decided::Side))
        ));
        let (took, slower) = (usage.time - begun, SLIDING - motion.vx);
        assert!(
            slower > 0.5 && (took / (slower / 0.1) - 1.0).abs() < 1e-3,
            "{took} {slower}"
        );
    }
}

/// Its steps count to the limit like those of other contact, from those that were made before.
#[test]
fn sliding_on_the_side_ends_at_the_limit_of_steps() {
    let settings = Settings {
        max_steps: 7,
        ..Settings::default()
    };
    for steps in [0, 4] {
        let usage = Usage {
            steps,
            ..Usage::default()
        };
        let (exit, motion, usage) = slides(settings, usage);
        assert!(matches!(exit, SideExit::Leaves(Exit::GivenUp)));
        assert_eq!(usage.steps, 7);
        assert!(motion.vx < SLIDING);
    }
}

/// Both rims stay down for sure while the moment of the weight, h/2 of it, is not exceeded by those of friction
/// and of the turning angular momentum, ω × L. A coin that slides is taken as fast as one that rolls.
#[test]
fn the_weight_holds_the_rims_down_up_to_half_its_moment() {
    for number in 0..100 {
        let mut dice = Dice::new(550, number);
        let coin = Coin::cylinder(dice.between(1.0, 2.0), 0.01).expect("a valid coin");
        let surface = Surface::new(0.5, dice.between(0.05, 0.2)).expect("a valid surface");
        let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
        let model = model_of(&scene, &Settings::default());
        let (solver, dynamics) = (model.contact_solver(Usage::default()), &model.dynamics);
        let body = &dynamics.body;
        let axial = dice.between(0.5, 2.0);
        let fastest = |held: &dyn Fn(f64) -> bool| {
            let (mut slow, mut fast) = (0.0, 1e3);
            for _ in 0..80 {
                let rate = 0.5 * (slow + fast);
                if held(rate) {
                    slow = rate;
                } else {
                    fast = rate;
                }
            }
            slow
        };
        let of_friction = Vector3::new(0.0, 0.0, -body.radius)
            .cross(&(Vector3::x() * dynamics.friction.mu))
            .norm();
        let momentum = Vector3::x() * (body.ka * axial);
        let expected = (0.5 * body.half - of_friction) / Vector3::z().cross(&momentum).norm();
        let share = dice.between(-1.0, 1.0);
        let speed = axial * body.radius;
        let (along, across) = (share * speed, (1.0 - share.abs()) * speed);
        for way in [-1.0, 1.0] {
            for state in [
                [0.0, 0.0, axial, way],
                [0.1 * speed, -0.2 * speed, -axial, way],
                [along, across, 0.3 * axial, -way],
                [-along, -across, 0.0, way],
            ] {
                let [vx, vy, wa, sense] = state;
                let found = fastest(&|rate| solver.is_held_down(&[vx, vy, wa, sense * rate]));
                assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
                let held = [vx, vy, wa, sense * 0.9 * expected];
                let share = line_rates(dynamics, &held, 1e-2).share;
                assert!(share > 0.0 && share < 1.0, "{share}");
            }
        }
    }
}

/// In a mirror across its axis a coin on its side tips onto the other rim whenever it tips onto this one.
#[test]
fn in_a_mirror_the_coin_tips_onto_the_other_rim() {
    let coin = Coin::cylinder(0.3, 0.01).expect("a valid coin");
    let surface = Surface::new(0.5, 0.4).expect("a valid surface");
    let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
    let settings = Settings {
        decision: Decision::Energy,
        ..Settings::default()
    };
    let model = model_of(&scene, &settings);
    let (solver, dynamics) = (model.contact_solver(Usage::default()), &model.dynamics);
    let exit = |state: &LineState| {
        let now = line_rates(dynamics, state, solver.rules.stick_speed);
        let (motion, spin) = line_motion(dynamics, state);
        let exit = match solver.side_exit(state, &now, &motion, &spin) {
            None => 0,
            Some(SideExit::TipsOntoThisRim) => 1,
            Some(SideExit::TipsOntoOtherRim) => -1,
            Some(SideExit::Leaves(exit)) => panic!("{exit:?} {state:?}"),
        };
        (exit, now.share)
    };
    let mut seen = [0; 4];
    for number in 0..6_000 {
        let mut dice = Dice::new(551, number);
        let roll = dice.between(0.2, 1.5);
        let [vx, slip, wz] = [0.0; 3].map(|_| {
            let size = dice.scale(1e-4, 1.0);
            dice.between(-size, size)
        });
        let axial = (slip - roll) / dynamics.body.radius;
        let (this, share) = exit(&[vx, roll, axial, wz]);
        let (other, rest) = exit(&[-vx, roll, axial, -wz]);
        assert!((share + rest - 1.0).abs() < 1e-9 * (1.0 + share.abs()));
        assert_eq!(this, -other, "{share} {vx} {slip} {wz}");
        // onto the rim alone that carries all of the weight
        assert!(this == 0 || (this == 1 && share >= 1.0) || (this == -1 && share <= 0.0));
        seen[usize::from(this != 0) + 2 * usize::from((0.0..1.0).contains(&share))] += 1;
    }
    assert!(seen[1] > 100 && seen[2] > 100, "{seen:?}");
}

/// A coin that rests on its side on a slope topples over its lower rim where the pull at its centre, at the height R,
/// has more moment about it than the weight with the lever h.
#[test]
fn a_coin_on_its_side_topples_downhill_on_a_steep_slope() {
    let coin = Coin::cylinder(0.3, 0.01).expect("a valid coin");
    let surface = Surface::new(0.5, 0.4).expect("a valid surface");
    let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
    let model = model_of(&scene, &Settings::default());
    let level = model.contact_solver(Usage::default());
    for pull in [-0.2, -0.16, -0.14, -0.05, 0.05, 0.14, 0.16, 0.2] {
        let dynamics = model.dynamics.pulled_by([pull, 0.02]);
        let solver = level.with(&dynamics);
        // the lowest rim of the folded frame is the one at −x
        let found = [1.0, -1.0].map(|side| solver.tips(&[0.0; 4], side));
        assert_eq!(found, [pull < -0.15, pull > 0.15], "{pull}");
    }
}

/// More energy than there was is taken from all velocities alike, and no other state is changed.
#[test]
fn a_capped_state_has_no_more_energy() {
    let model = model_of(&generic_scene(|plane| plane), &Settings::default());
    let (solver, dynamics) = (model.contact_solver(Usage::default()), &model.dynamics);
    let state = [0.3, -0.5, 0.7, 1.1];
    let kinetic = |state: &LineState| {
        let (motion, spin) = line_motion(dynamics, state);
        motion.kinetic(&dynamics.body, &spin)
    };
    let energy = kinetic(&state);
    assert_eq!(solver.capped(state, 1.01 * energy), state);
    let capped = solver.capped(state, 0.36 * energy);
    for (found, before) in capped.into_iter().zip(state) {
        assert!((found / before - 0.6).abs() < 1e-14);
    }
}
