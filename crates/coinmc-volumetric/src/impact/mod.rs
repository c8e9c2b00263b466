//! Impact of the lowest rim point: from the motion before to the impulse.
//!
//! Everything is per unit mass, in the frame (x, y, z): z up, x along the horizontal projection of
//! u, y = z × x. The contact point lies at r = (rx, 0, rz) from the centre. An impulse
//! p = (px, py, pz) at it, a contour impulse J_c and a pivoting impulse J_p change the motion by
//!
//! v += p,  ω_y += (rz px − rx pz)/kt,
//! ω_a += (R py − J_c − c J_p)/ka,  ω_θ += (h py − J_c c/s + s J_p)/kt     (h = H/2)
//!
//! where ω = ω_a u + ω_θ e_θ + ω_y y, u = (s, 0, c), e_θ = (c, 0, −s).

mod chatterjee_ruina;
mod moreau;
mod stronge;

pub use chatterjee_ruina::ChatterjeeRuina;
pub use moreau::Moreau;
pub use stronge::Stronge;

use crate::body::{Body, Friction};
use crate::lane::Lane;

/// The inverse mass of the contact point: its velocity changes by K p.
#[derive(Debug, Clone, Copy)]
pub struct ContactMatrix<L> {
    /// 1 + rz²/kt.
    pub xx: L,
    /// −rx rz/kt.
    pub xz: L,
    /// 1 + h²/kt + R²/ka.
    pub yy: L,
    /// 1 + rx²/kt.
    pub zz: L,
}

/// A coin that touches, just before the impact.
#[derive(Debug, Clone, Copy)]
pub struct Touch<L> {
    /// s = sin of the tilt of u from the vertical, > 0.
    pub sin: L,
    /// c = cos of that tilt, >= 0: the frame is chosen so that u points up.
    pub cos: L,
    /// Contact point from the centre, x: c R − s h.
    pub rx: L,
    /// Contact point from the centre, z: −c h − s R.
    pub rz: L,
    /// Velocity of the contact point, x.
    pub slip_x: L,
    /// Velocity of the contact point, y.
    pub slip_y: L,
    /// Velocity of the contact point, z: negative when it approaches.
    pub approach: L,
    /// Angular velocity about u.
    pub spin: L,
    /// Angular velocity about e_θ.
    pub turn: L,
}

/// An impulse per unit mass.
#[derive(Debug, Clone, Copy)]
pub struct Impulse<L> {
    /// x part.
    pub x: L,
    /// y part.
    pub y: L,
    /// Normal part, not negative.
    pub z: L,
    /// J_c, contour friction's.
    pub contour: L,
    /// J_p, pivoting friction's.
    pub pivoting: L,
}

/// A law of impact.
///
/// A law is an own type with its citation and the argument why it never gains energy. To add one:
/// implement this trait, add a variant to [`Law`](crate::Law) and an arm where the engine is built.
pub trait ImpactLaw: Copy + Sync {
    /// The impulse of an impact with coefficient of restitution `e`.
    fn impulse<L: Lane>(
        &self,
        body: &Body,
        friction: &Friction,
        touch: &Touch<L>,
        e: L,
    ) -> Impulse<L>;
}
