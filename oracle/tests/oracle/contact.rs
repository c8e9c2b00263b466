//! The stepper in sustained contact, against the equations and the textbook.

use crate::common::in_contact;
use coinmc_core::Scene;
use coinmc_oracle::newton_euler::{Contact, Twist, rates, runge_kutta, slip, twist_rates};
use coinmc_oracle::{Model, Motion, StepperSettings, TimeStepper, textbook};
use coinmc_testkit::{Dice, rolling_scene};
use nalgebra::Vector3;

fn stepper(scene: &Scene, step: f64) -> TimeStepper {
    let settings = StepperSettings {
        step,
        ..StepperSettings::default()
    };
    TimeStepper::new(scene, settings)
}

/// The state of the stepper after a time, to which its last step is cut by interpolation.
fn stepped(scene: &Scene, start: &Motion, step: f64, time: f64) -> Motion {
    let (mut before, mut after) = ((0.0, *start), (0.0, *start));
    stepper(scene, step).follow(*start, time, |t, motion| {
        before = after;
        after = (t, *motion);
    });
    let share = (time - before.0) / (after.0 - before.0);
    let mix = |a: Vector3<f64>, b: Vector3<f64>| a + (b - a) * share;
    let (a, b) = (before.1, after.1);
    Motion {
        position: mix(a.position, b.position),
        velocity: mix(a.velocity, b.velocity),
        axis: mix(a.axis, b.axis),
        spin: mix(a.spin, b.spin),
    }
}

fn apart(a: &Motion, b: &Motion) -> f64 {
    (a.axis - b.axis).norm() + (a.spin - b.spin).norm() + (a.velocity - b.velocity).norm()
}

/// The motion after a time by the equations, if it keeps its mode all the way: pressed on, rolling
/// within the friction cone or sliding, with rates of wandering and pivoting that keep their sign.
fn exact(model: &Model, start: &Motion, sticks: bool, time: f64) -> Option<Motion> {
    let signs = |m: &Motion| {
        let (wander, pivot) = twist_rates(m);
        (wander.signum(), pivot.signum())
    };
    let mode = |m: &Motion| {
        let contact = if sticks {
            Contact::Stick
        } else {
            Contact::Slip(slip(model, m).normalize())
        };
        let (contour, pivoting) = signs(m);
        (contact, Twist { contour, pivoting })
    };
    let steps = 500;
    let (mut motion, at_start) = (*start, signs(start));
    for _ in 0..steps {
        let (contact, twist) = mode(&motion);
        let force = rates(model, &motion, contact, twist).force;
        let holds = if sticks {
            force.xy().norm() < 0.95 * model.friction * force.z
        } else {
            slip(model, &motion).norm() > 0.1
        };
        let (wander, pivot) = twist_rates(&motion);
        let slow = wander.abs().min(pivot.abs()) < 0.02;
        if force.z < 0.1 || !holds || slow || signs(&motion) != at_start {
            return None;
        }
        motion = runge_kutta(model, &motion, time / f64::from(steps), mode);
    }
    Some(motion)
}

/// Rolling or sliding all the way, with both friction lengths: the stepper's error falls with the
/// square of its step, 16-fold for a quarter of it (8 allows for errors that pass through zero;
/// a scheme of first order would give 4).
#[test]
fn the_stepper_is_of_second_order() {
    for sticks in [true, false] {
        let (mut compared, mut coarse, mut fine) = (0, 0.0, 0.0);
        for trial in 0..200 {
            let mut dice = Dice::new(11, trial);
            let mu = if sticks { 1.0 } else { 0.2 };
            let scene = rolling_scene(dice.between(0.1, 2.0), 0.0, mu, 0.02);
            let model = Model::new(&scene);
            let mut start = in_contact(&mut dice, &model, 0.7);
            if sticks {
                let off = slip(&model, &start);
                start.velocity -= Vector3::new(off.x, off.y, 0.0);
            }
            let time = 0.3;
            let Some(exact) = exact(&model, &start, sticks, time) else {
                continue;
            };
            compared += 1;
            coarse += apart(&stepped(&scene, &start, 4e-3, time), &exact);
            fine += apart(&stepped(&scene, &start, 1e-3, time), &exact);
        }
        assert!(compared > 20, "{sticks}: only {compared} keep their mode");
        assert!(fine < coarse / 8.0, "{sticks}: {coarse:e} {fine:e}");
        assert!(coarse / f64::from(compared) < 1e-4, "{sticks}: {coarse:e}");
    }
}

/// On its side without friction lengths: sliding turns into rolling when and how fast as known.
#[test]
fn a_cylinder_slides_until_it_rolls() {
    let scene = rolling_scene(1.0, 0.0, 0.3, 0.0);
    let model = Model::new(&scene);
    let speed = 2.0;
    let start = Motion {
        position: Vector3::new(0.0, 0.0, model.radius),
        velocity: Vector3::new(0.0, speed, 0.0),
        axis: Vector3::x(),
        spin: Vector3::zeros(),
    };
    let (time, rolling) = textbook::slide_to_rolling(&model, speed);
    let halfway = stepped(&scene, &start, 4e-3, 0.5 * time);
    assert!((halfway.velocity.y - (speed - 0.5 * time * model.friction)).abs() < 1e-6);
    let after = stepped(&scene, &start, 4e-3, 2.0 * time);
    assert!(
        (after.velocity.y - rolling).abs() < 1e-6,
        "{}",
        after.velocity.y
    );
    assert!((after.velocity.y + model.radius * after.spin.x).abs() < 1e-6);
}

/// A wheel on its side slows down by contour friction, which both rims share.
#[test]
fn a_wheel_slows_down_at_the_known_rate() {
    let scene = rolling_scene(0.5, 0.0, 0.5, 0.02);
    let model = Model::new(&scene);
    let spin = 3.0;
    let start = Motion {
        position: Vector3::new(0.0, 0.0, model.radius),
        velocity: Vector3::new(0.0, -spin * model.radius, 0.0),
        axis: Vector3::x(),
        spin: Vector3::x() * spin,
    };
    let after = stepped(&scene, &start, 4e-3, 2.0);
    let expected = spin - 2.0 * textbook::wheel_deceleration(&model);
    assert!((after.spin.x - expected).abs() < 1e-6, "{}", after.spin.x);
}

/// Euler's disk falls from one tilt to another in the known time, up to terms of the order of the
/// tilt; the friction is small, so that it takes many turns.
#[test]
fn eulers_disk_falls_in_the_known_time() {
    let scene = rolling_scene(1e-3, 0.0, 1.0, 1e-3);
    let model = Model::new(&scene);
    let (high, low) = (0.1, 0.03);
    let start = textbook::precessing(&model, high, 0.0).expect("a speed");
    let known = textbook::euler_disk_stop(&model, high) - textbook::euler_disk_stop(&model, low);
    let mut time = None;
    stepper(&scene, 4e-3).follow(start, 2.0 * known, |t, motion| {
        if motion.sine() < low && time.is_none() {
            time = Some(t);
        }
    });
    let time = time.expect("it falls");
    assert!((time / known - 1.0).abs() < 0.1, "{time} {known}");
}
