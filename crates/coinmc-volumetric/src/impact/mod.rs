//! Impact of the lowest rim point: from the motion before to the impulse.
//!
//! All quantities are per unit mass, in the frame (x, y, z): z up, x along the horizontal
//! projection of u, y = z × x. The contact point lies at r = (rx, 0, rz) from the centre. An
//! impulse p = (px, py, pz) at this point, a contour friction impulse J_c and a pivoting friction
//! impulse J_p change the motion by
//!
//! v += p,  ω_y += (rz px − rx pz)/kt,
//! ω_a += (R py − J_c − c J_p)/ka,  ω_θ += (h py − J_c c/s + s J_p)/kt     (h = H/2)
//!
//! where ω = ω_a u + ω_θ e_θ + ω_y y, u = (s, 0, c), e_θ = (c, 0, −s).
//!
//! Contour friction opposes the rolling of the contact point along the rim, pivoting friction
//! opposes the rotation about the vertical.

pub(crate) mod contact_point;
pub(crate) mod friction_moments;
mod impulse;
mod jam;
mod law;

pub use contact_point::{ContactMatrix, ContactPoint};
pub use impulse::{Impulse, VelocityJump};
pub(crate) use jam::jam_impulse;
pub use law::ImpactLaw;
