//! Free motion.

use coinmc_core::Drag;
use coinmc_oracle::{Model, Motion};
use coinmc_testkit::{Dice, rolling_scene};
use nalgebra::Vector3;

fn random(dice: &mut Dice) -> Motion {
    Motion {
        position: Vector3::new(0.0, 0.0, 5.0),
        velocity: dice.vector(2.0),
        axis: dice.vector(1.0).normalize(),
        spin: dice.vector(3.0),
    }
}

/// A few roundings a flight; hundreds of small flights add up to at most 1e-12.
#[test]
fn energy_and_momentum_are_kept() {
    for trial in 0..200 {
        let mut dice = Dice::new(1, trial);
        let model = Model::new(&rolling_scene(dice.between(0.05, 5.0), 0.5, 0.3, 0.0));
        let start = random(&mut dice);
        let momentum = |m: &Motion| model.inertia(&m.axis) * m.spin;
        let (energy, turning) = (start.energy(&model), momentum(&start));
        let mut motion = start;
        for _ in 0..300 {
            motion.fly(&model, dice.between(0.0, 0.02).powi(2));
            motion.fly(&model, 0.01);
        }
        assert!((motion.energy(&model) - energy).abs() < 1e-12 * (1.0 + energy));
        assert!((momentum(&motion) - turning).norm() < 1e-12 * (1.0 + turning.norm()));
    }
}

/// ω' from Euler's equations, integrated in small steps (RK4, error 3e-10 here), is another way to
/// the same orientation; with drag and without the gyroscopic torque likewise.
#[test]
fn free_motion_solves_the_equations_of_motion() {
    for trial in 0..40 {
        let mut dice = Dice::new(2, trial);
        let drag = Drag::new(dice.between(0.0, 10.0), dice.between(0.0, 10.0)).expect("drag");
        let scene = rolling_scene(dice.between(0.1, 3.0), 0.5, 0.3, 0.0)
            .with_gyroscopic_torque(trial % 2 == 0)
            .with_drag(if trial % 4 < 2 { Drag::default() } else { drag });
        let model = Model::new(&scene);
        let start = random(&mut dice);
        let slope = |m: &Motion| {
            let inertia = model.inertia(&m.axis);
            let momentum = inertia * m.spin;
            let mut torque = -momentum * model.angular_drag;
            if model.gyroscopic {
                torque -= m.spin.cross(&momentum);
            }
            Motion {
                position: m.velocity,
                velocity: -Vector3::z() - m.velocity * model.linear_drag,
                axis: m.spin.cross(&m.axis),
                spin: inertia.try_inverse().expect("regular") * torque,
            }
        };
        let ahead = |m: &Motion, k: &Motion, h: f64| Motion {
            position: m.position + k.position * h,
            velocity: m.velocity + k.velocity * h,
            axis: m.axis + k.axis * h,
            spin: m.spin + k.spin * h,
        };
        let h = 2e-3;
        let mut small = start;
        for _ in 0..500 {
            let a = slope(&small);
            let b = slope(&ahead(&small, &a, h / 2.0));
            let c = slope(&ahead(&small, &b, h / 2.0));
            let d = slope(&ahead(&small, &c, h));
            for (k, weight) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
                small = ahead(&small, &k, h * weight / 6.0);
            }
        }
        let mut exact = start;
        exact.fly(&model, 1.0);
        let apart = [
            exact.position - small.position,
            exact.velocity - small.velocity,
            exact.axis - small.axis,
            exact.spin - small.spin,
        ];
        for difference in apart {
            assert!(difference.norm() < 3e-9, "{trial}: {apart:?}");
        }
    }
}

/// The axis of a free coin goes round its angular momentum at |L|/I_t, at a constant angle.
#[test]
fn a_free_coin_precesses_at_the_known_rate() {
    let model = Model::new(&rolling_scene(0.3, 0.5, 0.3, 0.0));
    let (sin, cos) = libm::sincos(0.4);
    let spin = Vector3::new(0.7, 0.0, 0.0) + Vector3::new(0.0, 0.0, 5.0);
    let mut motion = Motion {
        position: Vector3::new(0.0, 0.0, 100.0),
        velocity: Vector3::zeros(),
        axis: Vector3::z(),
        spin,
    };
    let momentum = Vector3::new(model.transverse * 0.7, 0.0, model.axial * 5.0);
    let period = std::f64::consts::TAU * model.transverse / momentum.norm();
    for _ in 0..8 {
        motion.fly(&model, period / 8.0);
        let angle = motion.axis.dot(&momentum) / momentum.norm();
        assert!((angle - momentum.z / momentum.norm()).abs() < 1e-14);
    }
    assert!((motion.axis - Vector3::z()).norm() < 1e-13 && sin < cos);
}
