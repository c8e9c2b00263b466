//! The equations of motion of a coin on its side: both rims touch the surface, u is level.
//!
//! With u = (1, 0, 0) the two contact points are r = (∓h, 0, −R), and slip at
//! γ_i = (v_x, v_y + R ω_a ∓ h ω_z). In the frame that turns with ω_z,
//!
//! v_x' = ω_z v_y + f_x,  v_y' = −ω_z v_x + f_y,  k_a ω_a' = R f_y − ρ_c σ_c,
//! k_t ω_z' = h (f_2y − f_1y) − ρ_p σ_p,
//!
//! with N_1 + N_2 = 1 (m g) and, because the coin does not tilt, h (N_1 − N_2) = k_t Ω_a ω_z + R
//! f_x, Ω_a = ω_a I_a/I_t. Where this requires a negative force, the coin tips onto the other rim,
//! if contact of that rim alone agrees. Friction is f_i = −μ N_i γ_i/√(γ_i² + ε²),
//! ε = `stick_speed`: instead of sticking, a point creeps more slowly than ε. Straight rolling and
//! sliding are those of the textbooks: a slip v_y + R ω_a decays at the rate μ(1 + R²/k_a), and ω_a
//! of a rolling coin at the rate ρ_c/(k_a + R²).

use super::dynamics::Dynamics;
use super::integrator::Flow;
use crate::motion::{Motion, Spin};

/// v_x, v_y, ω_a, ω_z.
pub(crate) type LineState = [f64; 4];

pub(crate) struct LineRates {
    pub(crate) rates: LineState,
    /// The share of the weight that the rim at r = (−h, 0, −R) would carry if the coin could not
    /// tip.
    pub(super) share: f64,
}

/// The flow of a coin on its side, on a plane.
pub(super) struct LineFlow<'a> {
    pub(super) dynamics: &'a Dynamics,
    pub(super) creep: f64,
}

// not a closure, because a closure that is called six times is not inlined
impl Flow<f64, 4> for LineFlow<'_> {
    #[inline(always)]
    fn rates(&mut self, state: &LineState) -> LineState {
        line_rates(self.dynamics, state, self.creep).rates
    }
}

/// Rates of change of `state`, where sticking is a creep slower than `creep`.
// inlined into each stage of the integrator: a call costs a sixth of a step
#[inline(always)]
pub(crate) fn line_rates(dynamics: &Dynamics, state: &LineState, creep: f64) -> LineRates {
    line_rates_on::<false>(dynamics, state, creep, [0.0; 2])
}

/// The same where the ground slopes, if `SLOPED`: the rims touch so far `ahead` of their lowest points.
#[inline(always)]
pub(crate) fn line_rates_on<const SLOPED: bool>(
    dynamics: &Dynamics,
    state: &LineState,
    creep: f64,
    ahead: [f64; 2],
) -> LineRates {
    let [vx, vy, wa, wz] = *state;
    let body = &dynamics.body;
    let radius = body.outer_radius();
    let slip = [
        vy + radius * wa - body.half * wz,
        vy + radius * wa + body.half * wz,
    ];
    let across = if SLOPED {
        ahead.map(|ahead| vx - wz * ahead)
    } else {
        [vx; 2]
    };
    let slide = |x: f64, y: f64| {
        let scale = -dynamics.friction.mu / (x * x + y * y + creep * creep).sqrt();
        (scale * x, scale * y)
    };
    let ((x1, y1), (x2, y2)) = (slide(across[0], slip[0]), slide(across[1], slip[1]));
    // h (2 N₁ − 1) = k_t Ω_a ω_z + R (N₁ x₁ + (1 − N₁) x₂)
    let gyro = body.kt * dynamics.axial_factor * wa * wz;
    let share = (gyro + body.half + radius * x2) / (2.0 * body.half - radius * (x1 - x2));
    let first = share.clamp(0.0, 1.0);
    let second = 1.0 - first;
    let (fx, f1, f2) = (
        first * x1 + second * x2,
        first * y1 + second * y2,
        second * y2 - first * y1,
    );
    let about = if SLOPED {
        ahead[0] * first * x1 + ahead[1] * second * x2
    } else {
        0.0
    };
    let (contour, pivoting) = dynamics.friction_torques(1.0, 0.0, wa, -wz);
    let (linear, angular) = (dynamics.drag.linear, dynamics.drag.angular);
    let [pull_x, pull_y] = dynamics.pull.unwrap_or_default();
    LineRates {
        rates: [
            wz * vy + fx - linear * vx + pull_x,
            -wz * vx + f1 - linear * vy + pull_y,
            (radius * f1 - contour) / body.ka - angular * wa,
            (body.half * f2 - about + pivoting) / body.kt - angular * wz,
        ],
        share,
    }
}

/// The state of a coin that is laid on its side.
pub(super) fn line_state(motion: &Motion<f64>, spin: &Spin<f64>) -> LineState {
    // ω_z = −ω_θ where u is horizontal
    [motion.vx, motion.vy, spin.axial, -spin.turn]
}

/// The motion of a state.
pub(super) fn line_motion(dynamics: &Dynamics, state: &LineState) -> (Motion<f64>, Spin<f64>) {
    let (mut motion, mut spin) = (Motion::still(), Spin::still());
    place_on_side(dynamics, state, &mut motion, &mut spin);
    (motion, spin)
}

/// Sets the motion of a state.
pub(super) fn place_on_side(
    dynamics: &Dynamics,
    state: &LineState,
    motion: &mut Motion<f64>,
    spin: &mut Spin<f64>,
) {
    let [vx, vy, wa, wz] = *state;
    *spin = Spin {
        axial: wa,
        turn: -wz,
        tilt: 0.0,
    };
    motion.lay_on_side();
    (motion.vx, motion.vy, motion.vz, motion.z) = (vx, vy, 0.0, dynamics.body.radius);
    motion.set_spin(spin, dynamics.axial_factor);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Friction;
    use crate::contact::tests::{STILL, dynamics};
    use crate::drag::Drag;
    use coinmc_testkit::Dice;
    use nalgebra::Vector3;

    /// Momentum and angular momentum change as the forces at both rims, friction lengths, drag and a tilted table
    /// ask, in the frame that turns with the coin; and no torque is left that would tilt it. Where the ground slopes,
    /// friction acts ahead of the lowest points.
    #[test]
    fn rates_are_those_of_newton_and_euler() {
        let mut compared = 0;
        for trial in 0..2000 {
            let mut dice = Dice::new(321, trial);
            let mut up_to = |most: f64| dice.between(0.0, most);
            let friction = Friction {
                mu: up_to(0.5),
                contour: up_to(0.02),
                pivoting: up_to(0.02),
            };
            let drag = Drag {
                linear: up_to(1.0),
                angular: up_to(1.0),
            };
            let mut dynamics = dynamics(up_to(2.0).max(0.2), friction, drag, true);
            let mut part = |size: f64| dice.between(-size, size);
            dynamics.pull = Some([part(0.1), part(0.1)]);
            let (state, ahead) = ([0.0; 4].map(|_| part(0.5)), [part(0.1), part(0.1)]);
            let creep = 1e-3;
            for (ahead, now) in [
                ([0.0; 2], line_rates(&dynamics, &state, creep)),
                (
                    ahead,
                    line_rates_on::<true>(&dynamics, &state, creep, ahead),
                ),
            ] {
                if !(0.0..=1.0).contains(&now.share) {
                    continue;
                }
                compared += 1;
                let off = unexplained(&dynamics, &state, creep, ahead, &now);
                assert!(off.iter().all(|off| off.abs() < 1e-13), "{off:?}");
            }
        }
        assert!(compared > 1000, "{compared}");
    }

    /// Changes of momentum and angular momentum less the forces and torques.
    fn unexplained(
        dynamics: &Dynamics,
        state: &LineState,
        creep: f64,
        ahead: [f64; 2],
        now: &LineRates,
    ) -> [f64; 5] {
        let [vx, vy, wa, wz] = *state;
        let (body, drag) = (&dynamics.body, &dynamics.drag);
        let (velocity, spin) = (Vector3::new(vx, vy, 0.0), Vector3::new(wa, 0.0, wz));
        let momentum = Vector3::new(body.ka * wa, 0.0, body.kt * wz);
        let [pull_x, pull_y] = dynamics.pull.unwrap_or_default();
        let mut force = Vector3::new(pull_x, pull_y, 0.0) - velocity * drag.linear;
        let mut torque = -momentum * drag.angular;
        for (i, normal) in [now.share, 1.0 - now.share].into_iter().enumerate() {
            let side = if i == 0 { -body.half } else { body.half };
            let lowest = Vector3::new(side, 0.0, -body.radius);
            let touches = lowest + Vector3::y() * ahead[i];
            let slip = velocity + spin.cross(&touches);
            let slip = Vector3::new(slip.x, slip.y, 0.0);
            let size = (slip.norm_squared() + creep * creep).sqrt();
            let friction = -slip * (dynamics.friction.mu * normal / size);
            force += friction;
            torque += touches.cross(&friction) + lowest.cross(&(Vector3::z() * normal));
        }
        // rolling and pivoting friction, whose laws are tested elsewhere
        let (rolling, pivoting) = dynamics.friction_torques(1.0, 0.0, wa, -wz);
        torque += Vector3::new(-rolling, 0.0, pivoting);
        let turning = Vector3::z() * wz;
        let (force, torque) = (
            force - turning.cross(&velocity),
            torque - turning.cross(&momentum),
        );
        [
            now.rates[0] - force.x,
            now.rates[1] - force.y,
            body.ka * now.rates[2] - torque.x,
            body.kt * now.rates[3] - torque.z,
            torque.y,
        ]
    }

    /// Contour and pivoting friction take energy from a coin on its side, whichever way it turns.
    #[test]
    fn friction_lengths_slow_the_coin_down() {
        let friction = Friction {
            mu: 0.3,
            contour: 0.01,
            pivoting: 0.01,
        };
        let dynamics = dynamics(0.5, friction, STILL, true);
        for way in [-1.0, 1.0] {
            // both points stick, so that friction does no work
            let rolls = [0.0, -way * dynamics.body.radius, way, 0.0];
            assert!(way * line_rates(&dynamics, &rolls, 1e-3).rates[2] < 0.0);
            let spins = [0.0, 0.0, 0.0, way];
            let [.., slows] = line_rates(&dynamics, &spins, 1e-3).rates;
            let dry = dynamics.friction.mu * dynamics.body.half + dynamics.friction.pivoting;
            let off = slows * dynamics.body.kt + way * dry;
            assert!(off.abs() < 1e-5 * dry, "{off:e}");
        }
    }
}
