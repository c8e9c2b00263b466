//! The coin at its lowest point as a rigid body in vectors, for tests: a reference that knows neither triad nor levers.

use crate::body::Body;
use crate::impact::Impulse;
use crate::motion::{Motion, Spin};
use nalgebra::Vector3;

type Vector = Vector3<f64>;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Rigid {
    body: Body,
    /// Unit vector along the coin's axis, which leans in the direction of x.
    axis: Vector,
    /// The lowest point, from the centre.
    pub(crate) arm: Vector,
    pub(crate) velocity: Vector,
    pub(crate) omega: Vector,
}

impl Rigid {
    /// A body whose constants are all generic, with rims rounded with the radius `rim`.
    pub(crate) fn generic_body(rim: f64) -> Body {
        Body {
            radius: 0.8,
            half: 0.6,
            rim,
            kt: 0.27,
            ka: 0.41,
        }
    }

    pub(crate) fn new(body: &Body, tilt: f64, velocity: Vector, omega: Vector) -> Self {
        let axis = Vector::new(libm::sin(tilt), 0.0, libm::cos(tilt));
        // steepest descent within the lower face, then straight down by the rounding
        let down = -Vector::z();
        let descent = (down - axis * axis.dot(&down)).normalize();
        Self {
            body: *body,
            axis,
            arm: descent * body.radius - axis * body.half + down * body.rim,
            velocity,
            omega,
        }
    }

    /// The same in the folded frame, with the centre at the height `z`.
    pub(crate) fn folded(&self, axial_factor: f64, z: f64) -> (Motion<f64>, Spin<f64>) {
        // at right angles to the axis and to y, downhill
        let across = Vector::y().cross(&self.axis);
        let spin = Spin {
            axial: self.omega.dot(&self.axis),
            turn: self.omega.dot(&across),
            tilt: self.omega.y,
        };
        let mut motion = Motion {
            sin: self.axis.x,
            cos: self.axis.z,
            vx: self.velocity.x,
            vy: self.velocity.y,
            vz: self.velocity.z,
            z,
            ..Motion::still()
        };
        motion.set_spin(&spin, axial_factor);
        (motion, spin)
    }

    /// The parts of a vector along the axis and across it.
    fn parts(&self, vector: Vector) -> (Vector, Vector) {
        let along = self.axis * self.axis.dot(&vector);
        (along, vector - along)
    }

    /// Angular momentum about the centre.
    pub(crate) fn angular_momentum(&self) -> Vector {
        let (along, across) = self.parts(self.omega);
        along * self.body.ka + across * self.body.kt
    }

    pub(crate) fn kinetic(&self) -> f64 {
        0.5 * (self.velocity.norm_squared() + self.omega.dot(&self.angular_momentum()))
    }

    /// The velocity of the lowest point.
    pub(crate) fn at_contact(&self) -> Vector {
        self.velocity + self.omega.cross(&self.arm)
    }

    /// The motion after an impulse at the lowest point and one of torque.
    pub(crate) fn pushed(&self, impulse: Vector, torque: Vector) -> Self {
        let (along, across) = self.parts(self.arm.cross(&impulse) + torque);
        Self {
            velocity: self.velocity + impulse,
            omega: self.omega + along / self.body.ka + across / self.body.kt,
            ..*self
        }
    }

    /// The same with the impulse of a law. Contour friction turns the coin about x, where it does as much
    /// work on ω_x = s ψ' as J_c does on ψ'.
    pub(crate) fn after(&self, p: &Impulse<f64>) -> Self {
        let torque = Vector::new(-p.contour / self.axis.x, 0.0, -p.pivoting);
        self.pushed(Vector::new(p.x, p.y, p.z), torque)
    }
}
