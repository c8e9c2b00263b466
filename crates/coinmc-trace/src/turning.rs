//! The rotation of the coin about its own axis, computed separately from the toss.
//!
//! A coin is a body of revolution: engines only need its axis u and its angular velocity. Drawing
//! it needs a complete rotation, whose z axis is u.
//!
//! In flight the rotation has a closed form. A free symmetric top turns about its angular momentum
//! at Ω = L/I_t while it spins about u at (1 − I_a/I_t) ω_a (Goldstein, *Classical Mechanics*,
//! §5.6): ω = Ω + (1 − I_a/I_t) ω_a u, so from one record to the next, h later,
//!
//! R(t + h) = rot(Ω h) · R(t) · rot(z, (1 − I_a/I_t) ω_a h).
//!
//! Angular drag k reduces Ω and ω_a equally: h becomes (1 − e^(−kh))/k. Without gyroscopic torque ω
//! is constant and the second factor is 1. In sustained contact the coin is turned by the mean of
//! the angular velocities at both records, with an error of third order in the time between them.
//! In both cases u is then aligned with the engine's by the smallest rotation.

use crate::record::Mode;
use coinmc_core::{Scene, State};
use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};

/// Computes the rotation from record to record.
#[derive(Debug, Clone)]
pub(super) struct Turning {
    /// Ω_a/ω_a.
    axial_factor: f64,
    drag_per_s: f64,
    last: Option<(State, UnitQuaternion<f64>)>,
}

impl Turning {
    pub(super) fn new(scene: &Scene) -> Self {
        let axial_factor = if scene.has_gyroscopic_torque() {
            scene.coin.axial_gyration_m2() / scene.coin.transverse_gyration_m2()
        } else {
            1.0
        };
        Self {
            axial_factor,
            drag_per_s: scene.drag().angular_per_s(),
            last: None,
        }
    }

    /// The rotation at a state, with the mode that led to it.
    pub(super) fn turn(&mut self, state: &State, mode: Mode) -> UnitQuaternion<f64> {
        let turned = match &self.last {
            None => UnitQuaternion::identity(),
            Some((last, orientation)) => {
                let h = state.time_s - last.time_s;
                if h > 0.0 && mode == Mode::Flight {
                    self.fly(last, h) * orientation * self.spin(last, h)
                } else if h > 0.0 {
                    rotation(&((last.spin_rad_s + state.spin_rad_s) * (0.5 * h))) * orientation
                } else {
                    *orientation
                }
            }
        };
        let orientation = with_axis(turned, &state.axis);
        self.last = Some((*state, orientation));
        orientation
    }

    /// The effective time, reduced by drag.
    fn effective(&self, h: f64) -> f64 {
        if self.drag_per_s > 0.0 {
            -libm::expm1(-self.drag_per_s * h) / self.drag_per_s
        } else {
            h
        }
    }

    fn fly(&self, from: &State, h: f64) -> UnitQuaternion<f64> {
        let axial = from.spin_rad_s.dot(&from.axis);
        let omega = from.spin_rad_s - from.axis.into_inner() * (axial * (1.0 - self.axial_factor));
        rotation(&(omega * self.effective(h)))
    }

    fn spin(&self, from: &State, h: f64) -> UnitQuaternion<f64> {
        let axial = from.spin_rad_s.dot(&from.axis);
        let angle = axial * (1.0 - self.axial_factor) * self.effective(h);
        rotation(&Vector3::new(0.0, 0.0, angle))
    }
}

/// The rotation by a vector, computed with `libm`: bit-identical on every machine.
fn rotation(by: &Vector3<f64>) -> UnitQuaternion<f64> {
    let angle = by.norm();
    if !(angle > 0.0 && angle.is_finite()) {
        return UnitQuaternion::identity();
    }
    let (sin, cos) = libm::sincos(0.5 * angle);
    let v = by * (sin / angle);
    UnitQuaternion::new_normalize(Quaternion::new(cos, v.x, v.y, v.z))
}

/// The rotation closest to `turned` whose z axis is `axis`; `turned` itself where a toss that failed has none.
fn with_axis(turned: UnitQuaternion<f64>, axis: &Unit<Vector3<f64>>) -> UnitQuaternion<f64> {
    let from = turned * Vector3::z();
    let between = from.cross(axis);
    let cos = from.dot(axis);
    if !cos.is_finite() {
        return turned;
    }
    let smallest = if cos > -0.5 {
        Quaternion::new(1.0 + cos, between.x, between.y, between.z)
    } else {
        // If the axes are nearly opposite, first turn about a transverse axis: preferably y, about
        // which a planar toss turns.
        let across = if from.y.abs() < 0.9 {
            Vector3::y()
        } else {
            Vector3::x()
        };
        let across = (across - from * across.dot(&from)).normalize();
        let half =
            UnitQuaternion::new_normalize(Quaternion::new(0.0, across.x, across.y, across.z));
        return with_axis(half * turned, axis);
    };
    UnitQuaternion::new_normalize(smallest) * turned
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Drag, Surface};

    fn state(time_s: f64, axis: Vector3<f64>, spin_rad_s: Vector3<f64>) -> State {
        State {
            time_s,
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::zeros(),
            axis: Unit::new_normalize(axis),
            spin_rad_s,
        }
    }

    fn scene(drag: f64, gyroscopic: bool) -> Scene {
        let coin = Coin::cylinder(0.4, 0.01).unwrap();
        Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), 9.81)
            .unwrap()
            .with_drag(Drag::new(0.0, drag).unwrap())
            .with_gyroscopic_torque(gyroscopic)
    }

    /// Euler's equations, integrated with small classical Runge–Kutta steps: R' = [ω] R,
    /// d(Iω)/dt = −k Iω in the laboratory frame.
    fn integrated(
        scene: &Scene,
        start: &State,
        q: UnitQuaternion<f64>,
        t: f64,
    ) -> (Quaternion<f64>, Vector3<f64>) {
        let coin = &scene.coin;
        let inertia = Vector3::new(
            coin.transverse_gyration_m2(),
            coin.transverse_gyration_m2(),
            coin.axial_gyration_m2(),
        );
        let k = scene.drag().angular_per_s();
        let body = q.inverse_transform_vector(&start.spin_rad_s);
        let momentum = q * inertia.component_mul(&body);
        let omega = |q: &Quaternion<f64>, t: f64| {
            let q = UnitQuaternion::new_normalize(*q);
            let l = momentum * libm::exp(-k * t);
            q * q.inverse_transform_vector(&l).component_div(&inertia)
        };
        let rate = |q: &Quaternion<f64>, t: f64| {
            let w = omega(q, t);
            Quaternion::new(0.0, w.x, w.y, w.z) * q * 0.5
        };
        let steps = 4000;
        let h = t / f64::from(steps);
        let mut q = q.into_inner();
        for i in 0..steps {
            let t = f64::from(i) * h;
            let k1 = rate(&q, t);
            let k2 = rate(&(q + k1 * (h / 2.0)), t + h / 2.0);
            let k3 = rate(&(q + k2 * (h / 2.0)), t + h / 2.0);
            let k4 = rate(&(q + k3 * h), t + h);
            q += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
        }
        (q.normalize(), omega(&q, t))
    }

    #[test]
    fn flight_satisfies_eulers_equations() {
        for drag in [0.0, 1.5] {
            let scene = scene(drag, true);
            let start = state(
                0.0,
                Vector3::new(0.3, -0.2, 0.8),
                Vector3::new(11.0, -25.0, 40.0),
            );
            let mut turning = Turning::new(&scene);
            let q = turning.turn(&start, Mode::Flight);
            let (exact, spin) = integrated(&scene, &start, q, 0.3);
            let exact = UnitQuaternion::new_normalize(exact);
            let end = state(0.3, exact * Vector3::z(), spin);
            let found = turning.turn(&end, Mode::Flight);
            // 4th order, 4000 steps of at most 0.004 rad: 1e-9
            assert!(found.angle_to(&exact) < 1e-8, "{}", found.angle_to(&exact));
        }
    }

    /// The rotation in contact converges with the number of records: errors are of third order per
    /// record, so second order in total; halving the step quarters the error.
    #[test]
    fn contact_converges() {
        let scene = scene(0.0, true);
        // a coin that rolls on its side, u wheeling about the vertical while it turns about u
        let at = |t: f64| {
            let (s, c) = libm::sincos(3.0 * t);
            state(
                t,
                Vector3::new(c, s, 0.0),
                Vector3::new(20.0 * c, 20.0 * s, 3.0),
            )
        };
        let end = |n: u32| {
            let mut turning = Turning::new(&scene);
            let states = (0..=n).map(|i| at(f64::from(i) / f64::from(n)));
            states.fold(UnitQuaternion::identity(), |_, state| {
                turning.turn(&state, Mode::Sticking)
            })
        };
        let fine = end(6400);
        let (a, b) = (end(100).angle_to(&fine), end(200).angle_to(&fine));
        assert!(a < 0.05 && (3.5..4.5).contains(&(a / b)), "{a} {b}");
    }

    #[test]
    fn the_bodys_z_axis_is_always_u() {
        let scene = scene(0.0, false);
        let mut turning = Turning::new(&scene);
        let axes = [
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
            [1.0, 0.0, 0.0],
            [-1.0, 1e-9, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.6, 0.0, -0.8],
        ];
        for (i, axis) in axes.iter().enumerate() {
            let state = state(
                i as f64,
                Vector3::from_row_slice(axis),
                Vector3::new(0.0, 1e3, 0.0),
            );
            for mode in [Mode::Flight, Mode::Sliding] {
                let z = turning.turn(&state, mode) * Vector3::z();
                assert!((z - state.axis.into_inner()).norm() < 1e-14, "{axis:?}");
            }
        }
    }

    /// The last state of a toss that failed may hold no numbers.
    #[test]
    fn a_state_without_an_axis_keeps_the_last_rotation() {
        let mut turning = Turning::new(&scene(0.0, true));
        let first = state(0.0, Vector3::new(0.6, 0.0, 0.8), Vector3::zeros());
        let rotation = turning.turn(&first, Mode::Flight);
        let mut last = state(1.0, Vector3::z(), Vector3::repeat(f64::NAN));
        last.axis = Unit::new_unchecked(Vector3::repeat(f64::NAN));
        assert_eq!(turning.turn(&last, Mode::Flight), rotation);
    }
}
