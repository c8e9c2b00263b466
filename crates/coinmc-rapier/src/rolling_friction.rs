//! Rolling and pivoting friction, which Rapier does not have: torques between its steps.
//!
//! Rolling friction (contour friction, length ρ_c) takes the power N ρ_c |ψ'| from a contact point
//! that moves along the rim at the rate ψ' = ω_x/s, with x the horizontal direction the axis leans
//! to. Pivoting friction takes N ρ_p |ω_z| (Leine 2009; both are independent and set-valued). In a
//! step in which the surface pushed with the impulse p they are angular impulses |J_c| <= ρ_c p and
//! |J_p| <= ρ_p p,
//!
//! ω_a −= (J_c + c J_p)/k_a,  ω_θ −= (J_c c/s − s J_p)/k_t,
//!
//! each just large enough to stop its rate, if that is within its limit. Friction in the next step
//! keeps a rolling coin on its path, so that all of its inertia is slowed, as it must be.

use crate::motion::Motion;
use crate::scaled::Scaled;
use nalgebra::Vector3;

/// sin of the tilt below which no point of the rim is lower than the others, so that no contact
/// point moves along the rim.
const LEVEL: f64 = 1e-9;

/// Applies the friction of a step in which the normal impulse was `push`.
pub(crate) fn apply(motion: &mut Motion, scaled: &Scaled, push: f64) {
    let (c, s) = (motion.axis.z, motion.tilt_sine());
    if s < LEVEL {
        return;
    }
    let body = &scaled.body;
    let lean = Vector3::new(motion.axis.x / s, motion.axis.y / s, 0.0);
    let across = lean * c - Vector3::new(0.0, 0.0, s);
    let (axial, turn) = (motion.axial(), motion.spin.dot(&across));
    let (mut contour_rate, mut pivot_rate) = (axial + turn * c / s, axial * c - turn * s);
    let (inverse_a, inverse_t) = (1.0 / body.ka, 1.0 / body.kt);
    // how each rate answers to its own impulse and to the other's
    let own = [
        inverse_a + c * c / (s * s) * inverse_t,
        c * c * inverse_a + s * s * inverse_t,
    ];
    let shared = c * (inverse_a - inverse_t);
    let (mut contour, mut pivoting) = (0.0, 0.0);
    // two sweeps: each rate sees what the other impulse changed
    for _ in 0..2 {
        let before = contour;
        let most = scaled.rolling_friction * push;
        contour = (contour + contour_rate / own[0]).clamp(-most, most);
        contour_rate -= own[0] * (contour - before);
        pivot_rate -= shared * (contour - before);
        let before = pivoting;
        let most = scaled.pivoting_friction * push;
        pivoting = (pivoting + pivot_rate / own[1]).clamp(-most, most);
        pivot_rate -= own[1] * (pivoting - before);
        contour_rate -= shared * (pivoting - before);
    }
    let axial = (contour + c * pivoting) * inverse_a;
    let turn = (contour * c / s - s * pivoting) * inverse_t;
    motion.spin -= motion.axis * axial + across * turn;
}
