//! The equations of motion of a conical coin on its edge: both rims touch, the tilt is constant.
//!
//! With s and c of that tilt, u = (s, 0, c), the contact points are r_i = (x_i, 0, −ζ): of the lower rim
//! x₁ = R c − h s < 0, of the upper one x₂ = R' c + h' s > 0, at ζ = h c + R s below the centre. They slip at
//! γ_i = (v_x, v_y + ζ ω_x + x_i ω_z). The triad turns at φ' = −ω_θ/s, and as in contact on one rim
//! ([`crate::contact`]), with ω_y = 0 and N₁ + N₂ = 1,
//!
//! v_x' = φ'v_y + f_x,  v_y' = −φ'v_x + f_y,
//! k_a ω_a' = R f_1y + R' f_2y − t_a,  k_t ω_θ' = h f_1y − h' f_2y − t_θ,
//! 0 = k_t G − ζ f_x − (x₁ N₁ + x₂ N₂),  G = ω_θ(Ω_a − φ'c).
//!
//! The last line (no tilting) distributes the weight. Friction is f_i = −μ N_i γ_i/√(γ_i² + ε²).
//!
//! # Rolling about the apex
//! Without slip ω_z = 0 and v_y = −ζ ω_x: the coin turns about its line of contact, and goes at φ' =
//! −(c/s) ω_x in a circle about the apex of the cone, which lies x_c = ζ s/c beyond its centre. It has the
//! energy ½(ζ² + k_a s² + k_t c²) ω_x², and contour friction, of power ρ_c|ψ'| = ρ_c|ω_x|/s, slows the
//! centre down by a = ρ_c ζ/(s(ζ² + k_a s² + k_t c²)). What the circle asks of friction, f_x =
//! (c/s) ζ ω_x², and of the weight, k_t G with G = (c s)(k_a/k_t + c²/s²) ω_x², falls with ω_x²: once both
//! rims press, they press until the coin rests.

use crate::contact::{Dynamics, RollingStop};
use crate::motion::{Motion, Spin};
use coinmc_core::LowerRim;

/// v_x, v_y, ω_a, ω_θ.
pub(super) type EdgeState = [f64; 4];

/// A coin on its edge, in the frame of one of its rims.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Edge {
    /// s and c.
    pub(super) sin: f64,
    pub(super) cos: f64,
    /// ζ.
    pub(super) height: f64,
    /// x₁ and x₂.
    pub(super) reach: [f64; 2],
    /// R, R' and h, −h': the levers of a force along y about u and e_θ.
    radius: [f64; 2],
    half: [f64; 2],
}

pub(super) struct EdgeRates {
    pub(super) rates: EdgeState,
    /// The share of the weight that the lower rim would carry if the coin could not tip.
    pub(super) share: f64,
}

impl Edge {
    pub(super) fn new(rim: &LowerRim) -> Self {
        let (sin, cos) = rim.on_edge();
        let (body, upper) = (&rim.body, &rim.upper);
        Self {
            sin,
            cos,
            height: rim.height_on_edge(),
            reach: [
                body.radius * cos - body.half * sin,
                upper.radius * cos + upper.half * sin,
            ],
            radius: [body.radius, upper.radius],
            half: [body.half, -upper.half],
        }
    }

    /// Whether a coin at this tilt leans on the other rim.
    pub(super) fn is_beyond(&self, sin: f64, cos: f64) -> bool {
        cos * self.sin < self.cos * sin
    }

    /// The distance of the nearer rim from the point below the centre.
    pub(super) fn shorter_reach(&self) -> f64 {
        (-self.reach[0]).min(self.reach[1])
    }

    /// ω_x and ω_z.
    fn turning(&self, axial: f64, turn: f64) -> (f64, f64) {
        let (s, c) = (self.sin, self.cos);
        (s * axial + c * turn, c * axial - s * turn)
    }

    /// Slip along y of both contact points.
    pub(super) fn slips(&self, &[_, vy, axial, turn]: &EdgeState) -> [f64; 2] {
        let (wx, wz) = self.turning(axial, turn);
        self.reach.map(|x| vy + self.height * wx + x * wz)
    }

    /// Rates of change of `state`, where sticking is a creep slower than `creep`.
    pub(super) fn rates(&self, dynamics: &Dynamics, state: &EdgeState, creep: f64) -> EdgeRates {
        let [vx, vy, axial, turn] = *state;
        let (s, c) = (self.sin, self.cos);
        let (kt, ka) = (dynamics.body.kt, dynamics.body.ka);
        let [(x1, y1), (x2, y2)] = self.slips(state).map(|y| {
            let scale = -dynamics.friction.mu / (vx * vx + y * y + creep * creep).sqrt();
            (scale * vx, scale * y)
        });
        let azimuth = -turn / s;
        let gyro = kt * turn * (dynamics.axial_factor * axial - azimuth * c);
        let [near, far] = self.reach;
        let share = (far + self.height * x2 - gyro) / (far - near - self.height * (x1 - x2));
        let first = share.clamp(0.0, 1.0);
        let second = 1.0 - first;
        let (f1, f2) = (first * y1, second * y2);
        let (torque_a, torque_t) = dynamics.friction_torques(s, c, axial, turn);
        let (linear, angular) = (dynamics.drag.linear, dynamics.drag.angular);
        let about_u = self.radius[0] * f1 + self.radius[1] * f2 - torque_a;
        let across = self.half[0] * f1 + self.half[1] * f2 - torque_t;
        EdgeRates {
            rates: [
                azimuth * vy + first * x1 + second * x2 - linear * vx,
                -azimuth * vx + f1 + f2 - linear * vy,
                about_u / ka - angular * axial,
                across / kt - angular * turn,
            ],
            share,
        }
    }

    /// Twice the moment that friction and the gyroscopic torque can raise against the weight's.
    pub(super) fn overturning(&self, dynamics: &Dynamics, state: &EdgeState) -> f64 {
        let [vx, vy, axial, turn] = *state;
        let cot = (self.cos / self.sin).abs();
        let axial = axial.abs().max((vx.abs() + vy.abs()) / self.height);
        let turn = turn.abs() + cot * axial;
        let gyro = dynamics.body.kt * turn * (dynamics.axial_factor * axial + cot * turn);
        2.0 * (dynamics.friction.mu * self.height + gyro)
    }

    /// The largest slip of either point, as a sum.
    pub(super) fn slip(&self, state: &EdgeState) -> f64 {
        let [vx, vy, axial, turn] = *state;
        let (wx, wz) = self.turning(axial, turn);
        let reach = self.reach[1].max(-self.reach[0]);
        (vy + self.height * wx).abs() + (reach * wz).abs() + vx.abs()
    }

    /// How rolling about the apex at this speed of the centre ends.
    pub(super) fn rolling_stop(&self, dynamics: &Dynamics, speed: f64) -> RollingStop {
        let (s, c) = (self.sin, self.cos);
        let (body, drag) = (&dynamics.body, &dynamics.drag);
        let (along, turning) = (self.height * self.height, body.ka * s * s + body.kt * c * c);
        let inertia = along + turning;
        let a = dynamics.friction.contour * self.height / (s * inertia);
        let b = (drag.linear * along + drag.angular * turning) / inertia;
        RollingStop::with(a, b, speed)
    }

    /// The state of a coin that is laid on its edge.
    pub(super) fn state(motion: &Motion<f64>, spin: &Spin<f64>) -> EdgeState {
        [motion.vx, motion.vy, spin.axial, spin.turn]
    }

    /// The motion of a state.
    pub(super) fn motion(
        &self,
        dynamics: &Dynamics,
        state: &EdgeState,
    ) -> (Motion<f64>, Spin<f64>) {
        let (mut motion, mut spin) = (Motion::still(), Spin::still());
        self.place(dynamics, state, &mut motion, &mut spin);
        (motion, spin)
    }

    /// Sets the motion of a state.
    pub(super) fn place(
        &self,
        dynamics: &Dynamics,
        state: &EdgeState,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
    ) {
        let [vx, vy, axial, turn] = *state;
        *spin = Spin {
            axial,
            turn,
            tilt: 0.0,
        };
        (motion.sin, motion.cos) = (self.sin, self.cos);
        (motion.vx, motion.vy, motion.vz, motion.z) = (vx, vy, 0.0, self.height);
        motion.set_spin(spin, dynamics.axial_factor);
    }
}
