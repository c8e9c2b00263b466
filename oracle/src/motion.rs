//! The state, and how it moves when nothing touches.

use crate::Model;
use coinmc_core::{Launch, Scene, State};
use nalgebra::{UnitVector3, Vector3};

/// Position, velocity, axis and angular velocity in the laboratory, without units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Centre.
    pub position: Vector3<f64>,
    /// Velocity of the centre.
    pub velocity: Vector3<f64>,
    /// u, a unit vector.
    pub axis: Vector3<f64>,
    /// ω.
    pub spin: Vector3<f64>,
}

impl Motion {
    /// The motion at launch, in axes of the table. A coin that would begin inside the surface is lifted
    /// until it touches.
    pub fn launched(scene: &Scene, launch: &Launch) -> Self {
        let scene = &scene.pressed_onto_table();
        let (d, time) = (scene.coin.rim_distance_m(), scene.time_scale_s());
        let (launch, [x, y]) = match scene.surface.tilt() {
            Some(tilt) => tilt.launch_in_table_axes(launch),
            None => (*launch, [0.0; 2]),
        };
        let mut motion = Self {
            position: Vector3::new(x, y, launch.height_m) / d,
            velocity: launch.velocity_m_s * (time / d),
            axis: launch.axis.into_inner(),
            spin: launch.spin_rad_s * time,
        };
        let sunk = motion.gap(&Model::new(scene)).min(0.0);
        motion.position.z -= sunk;
        motion
    }

    /// The same state in SI units.
    pub fn state(&self, scene: &Scene, time: f64) -> State {
        let scene = &scene.pressed_onto_table();
        let (d, unit) = (scene.coin.rim_distance_m(), scene.time_scale_s());
        State {
            time_s: time * unit,
            position_m: self.position * d,
            velocity_m_s: self.velocity * (d / unit),
            axis: UnitVector3::new_normalize(self.axis),
            spin_rad_s: self.spin / unit,
        }
    }

    /// s, the sine of the axis' tilt from the vertical: from the horizontal part itself, since
    /// 1 − c² has no digits left near s = 0.
    pub fn sine(&self) -> f64 {
        let (x, y) = (self.axis.x, self.axis.y);
        (x * x + y * y).sqrt()
    }

    /// Height of the lowest point of the coin.
    pub fn gap(&self, model: &Model) -> f64 {
        let [(heads, above), (tails, below)] = model.rims;
        let (s, c) = (self.sine(), self.axis.z);
        let centre_line = (tails * s + below * c).max(heads * s - above * c);
        self.position.z - centre_line - model.rim
    }

    /// Kinetic energy of the translation and of the rotation, ½ω·Iω.
    pub fn kinetic(&self, model: &Model) -> f64 {
        let momentum = model.inertia(&self.axis) * self.spin;
        0.5 * (self.velocity.norm_squared() + self.spin.dot(&momentum))
    }

    /// Mechanical energy, the potential zero at the surface.
    pub fn energy(&self, model: &Model) -> f64 {
        self.kinetic(model) + self.position.z
    }

    /// Moves freely under gravity for a time: exact.
    pub fn fly(&mut self, model: &Model, time: f64) {
        let k = model.linear_drag;
        let (decay, once) = decay(k, time);
        // twice integrated e^(−kt); the difference cancels for small kt, where its series serves
        let twice = if k * time < 1e-3 {
            time * time * (0.5 - k * time * (1.0 / 6.0 - k * time / 24.0))
        } else {
            (time - once) / k
        };
        self.position += self.velocity * once;
        let weight = model.pull - Vector3::z();
        self.position += weight * twice;
        self.velocity *= decay;
        self.velocity += weight * once;
        self.turn(model, time);
    }

    /// Moves freely without gravity, which a step of contact adds as an impulse.
    pub(crate) fn drift(&mut self, model: &Model, time: f64) {
        let (decay, once) = decay(model.linear_drag, time);
        self.position += self.velocity * once;
        self.velocity *= decay;
        self.turn(model, time);
    }

    /// Turns freely. With the gyroscopic torque L keeps its direction and the axis goes round it
    /// at the rate |L|/I_t (u' = ω × u, and ω differs from L/I_t only along u); without, the axis
    /// goes round ω itself.
    fn turn(&mut self, model: &Model, time: f64) {
        let (decay, phase) = decay(model.angular_drag, time);
        if model.gyroscopic {
            let momentum = model.inertia(&self.axis) * self.spin;
            self.axis = rotate(&self.axis, &(momentum * (phase / model.transverse)));
            self.spin = model.inverse_inertia(&self.axis) * momentum * decay;
        } else {
            self.axis = rotate(&self.axis, &(self.spin * phase));
            self.spin *= decay;
        }
    }
}

/// e^(−kt) and its integral from 0 to t.
fn decay(k: f64, time: f64) -> (f64, f64) {
    if k == 0.0 {
        (1.0, time)
    } else {
        let lost = libm::expm1(-k * time);
        (1.0 + lost, -lost / k)
    }
}

/// A unit vector turned about `rotation` by its length, renewed to unit length.
pub(crate) fn rotate(unit: &Vector3<f64>, rotation: &Vector3<f64>) -> Vector3<f64> {
    let angle = rotation.norm();
    if angle == 0.0 {
        return *unit;
    }
    let about = rotation / angle;
    let (sin, cos) = libm::sincos(angle);
    let turned = unit * cos + about.cross(unit) * sin + about * (about.dot(unit) * (1.0 - cos));
    // one step of Newton's iteration for 1/|u|: the length is off by rounding only
    turned * (1.5 - 0.5 * turned.norm_squared())
}
