//! Friction against rolling and pivoting, which Rapier does not have: torques between its steps.
//!
//! Contour friction takes the power N ρ_c |ψ'| from a contact point that wanders along the rim at
//! the rate ψ' = ω_x/s (x the horizontal direction the axis leans to), pivoting friction N ρ_p |ω_z|
//! (Leine 2009; both are independent and set-valued). Of a step in which the surface pushed with the
//! impulse p they are angular impulses |J_c| <= ρ_c p and |J_p| <= ρ_p p,
//!
//! ω_a −= (J_c + c J_p)/k_a,  ω_θ −= (J_c c/s − s J_p)/k_t,
//!
//! each just large enough to end its rate, if it may be that large. A coin that rolls is held to its
//! path by the friction of the next step, so that all of its inertia is slowed, as it must be.

use crate::body::Scaled;
use crate::motion::Motion;
use nalgebra::Vector3;

/// sin of the tilt below which no point of the rim is lower than the others: nothing wanders.
const LEVEL: f64 = 1e-9;

/// Applies the friction of a step in which the normal impulse was `push`.
pub(crate) fn brake(motion: &mut Motion, scaled: &Scaled, push: f64) {
    let (c, s) = (motion.axis.z, motion.lean());
    if s < LEVEL {
        return;
    }
    let body = &scaled.body;
    let lean = Vector3::new(motion.axis.x / s, motion.axis.y / s, 0.0);
    let across = lean * c - Vector3::new(0.0, 0.0, s);
    let (axial, turn) = (motion.axial(), motion.spin.dot(&across));
    let (mut wander, mut pivot) = (axial + turn * c / s, axial * c - turn * s);
    let (inverse_a, inverse_t) = (1.0 / body.ka, 1.0 / body.kt);
    let own = [
        inverse_a + c * c / (s * s) * inverse_t,
        c * c * inverse_a + s * s * inverse_t,
    ];
    let shared = c * (inverse_a - inverse_t);
    let (mut contour, mut pivoting) = (0.0, 0.0);
    // two sweeps: what one of them changes, the other sees
    for _ in 0..2 {
        let before = contour;
        let most = scaled.contour * push;
        contour = (contour + wander / own[0]).clamp(-most, most);
        wander -= own[0] * (contour - before);
        pivot -= shared * (contour - before);
        let before = pivoting;
        let most = scaled.pivoting * push;
        pivoting = (pivoting + pivot / own[1]).clamp(-most, most);
        pivot -= own[1] * (pivoting - before);
        wander -= shared * (pivoting - before);
    }
    let axial = (contour + c * pivoting) * inverse_a;
    let turn = (contour * c / s - s * pivoting) * inverse_t;
    motion.spin -= motion.axis * axial + across * turn;
}
