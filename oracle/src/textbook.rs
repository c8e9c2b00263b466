//! Known answers for coins in contact, g = 1, D = 1, m = 1.
//!
//! Each is derived in place or cited, and needs only moments of inertia and the geometry.

use crate::{Model, Motion};
use nalgebra::Vector3;

/// Rate φ' at which a coin whose axis stands `tilt` from the vertical rolls in a circle while its
/// centre goes round one of radius `circle` (outwards positive along the projection x of u).
/// `None` where no speed keeps it up.
///
/// The coin turns with ω = φ'ẑ + νu. Its angular momentum I_a ω_a u + I_t ω_θ e_θ, ω_θ = −φ's,
/// goes round with φ', so L' = φ'(I_a ω_a s + I_t ω_θ c) y; the contact at r = (rx, 0, rz) bears
/// the weight and the centripetal force −φ'²a x, whose torque is (−rz φ'² a − rx) y; and without
/// slip φ'a + Rω_a + bω_θ = 0, b = ±H/2 the half height on the far side of the contact.
pub fn steady_precession(model: &Model, tilt: f64, circle: f64) -> Option<f64> {
    let (s, c) = libm::sincos(tilt);
    let half = model.half.copysign(c);
    let (rx, rz) = (-half * s + model.radius * c, -half * c - model.radius * s);
    let inertia = s * (model.transverse * c - model.axial * (half * s - circle) / model.radius);
    let square = rx / (inertia - rz * circle);
    (square > 0.0).then(|| square.sqrt())
}

/// The motion of [`steady_precession`], on the surface, with u in the xz plane.
pub fn precessing(model: &Model, tilt: f64, circle: f64) -> Option<Motion> {
    let rate = steady_precession(model, tilt, circle)?;
    let (s, c) = libm::sincos(tilt);
    let half = model.half.copysign(c);
    let axial = rate * (half * s - circle) / model.radius;
    let (u, theta) = (Vector3::new(s, 0.0, c), Vector3::new(c, 0.0, -s));
    Some(Motion {
        position: Vector3::new(circle, 0.0, model.half * c.abs() + model.radius * s),
        velocity: Vector3::new(0.0, rate * circle, 0.0),
        axis: u,
        spin: u * axial - theta * (rate * s),
    })
}

/// Euler's disk: the rate at which the contact point of a thin, nearly flat coin whose centre is
/// at rest goes round, φ'² = R/(I_t θ). (A uniform disk: 4g/(Rθ).)
pub fn euler_disk_rate(model: &Model, tilt: f64) -> f64 {
    (model.radius / (model.transverse * tilt)).sqrt()
}

/// Euler's disk with contour friction comes to rest after θ^(3/2) (R/ρ_c) sqrt(I_t/R).
///
/// Its energy is RθE₀ with ½I_t φ'²θ² + Rθ = (3/2) Rθ, and the friction takes ρ_c φ'
/// (Leine, "Experimental and theoretical investigation of the energy dissipation of a rolling
/// disk during its final stage of motion", Arch. Appl. Mech. 79 (2009) 1063).
pub fn euler_disk_stop(model: &Model, tilt: f64) -> f64 {
    tilt * tilt.sqrt() * model.radius / model.contour * (model.transverse / model.radius).sqrt()
}

/// Rate at which a coin spun upright on its rim slows down: pivoting friction against I_t.
pub fn spun_coin_deceleration(model: &Model) -> f64 {
    model.pivoting / model.transverse
}

/// Rate at which the spin of a wheel that rolls upright slows down: contour friction against the
/// inertia of rolling.
pub fn wheel_deceleration(model: &Model) -> f64 {
    model.contour / (model.axial + model.radius * model.radius)
}

/// A cylinder that slides on its side without turning begins to roll after v₀k/(μ(1 + k)) with
/// the speed v₀/(1 + k), k = I_a/R²: two thirds of v₀ when uniform. Returns time and speed.
pub fn slide_to_rolling(model: &Model, speed: f64) -> (f64, f64) {
    let k = model.axial / (model.radius * model.radius);
    (speed * k / (model.friction * (1.0 + k)), speed / (1.0 + k))
}
