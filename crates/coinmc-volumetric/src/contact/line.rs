//! The equations of motion of a coin on its side: both rims touch the surface, the tilt is zero.
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
