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
mod jam;
mod moreau;
mod stronge;
mod twist;

pub use chatterjee_ruina::ChatterjeeRuina;
pub(crate) use jam::jam;
pub use moreau::Moreau;
pub use stronge::Stronge;

use crate::body::{Body, Friction};
use coinmc_lanes::{Lane, Mask};
use twist::Twist;

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

/// The contact at constant normal velocity.
#[derive(Clone, Copy)]
pub(crate) struct Condensed<L> {
    /// 1/K_zz.
    pub(crate) mass_z: L,
    /// K_xz/K_zz: p_x takes −coupling·p_x of normal impulse along.
    pub(crate) coupling: L,
    /// α = K_xx − K_xz²/K_zz, the inverse mass along x.
    pub(crate) alpha: L,
}

impl<L: Lane> ContactMatrix<L> {
    /// K is the unit matrix and a rank-one part in the xz plane, so its determinant there is
    /// K_xx + K_zz − 1: nothing cancels.
    #[inline(always)]
    pub(crate) fn condensed(&self) -> Condensed<L> {
        let mass_z = L::splat(1.0) / self.zz;
        Condensed {
            mass_z,
            coupling: self.xz * mass_z,
            alpha: (self.xx + self.zz - L::splat(1.0)) * mass_z,
        }
    }
}

/// A coin that touches, just before the impact: lengths in D = sqrt(R² + H²/4), times in
/// sqrt(D/g), in the frame whose z points up and whose x along the horizontal part of the axis u.
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

impl<L: Lane> Touch<L> {
    /// The inverse mass of this contact.
    #[inline(always)]
    pub fn matrix(&self, body: &Body) -> ContactMatrix<L> {
        let one = L::splat(1.0);
        let inverse_kt = L::splat(1.0 / body.kt);
        let (x, z) = (self.rx * inverse_kt, self.rz * inverse_kt);
        ContactMatrix {
            xx: one + self.rz * z,
            xz: -(self.rx * z),
            yy: L::splat(
                1.0 + body.half * body.half / body.kt + body.radius * body.radius / body.ka,
            ),
            zz: one + self.rx * x,
        }
    }

    /// The touch in one lane.
    #[inline(always)]
    pub(crate) fn lane(&self, index: usize) -> Touch<f64> {
        Touch {
            sin: self.sin.lane(index),
            cos: self.cos.lane(index),
            rx: self.rx.lane(index),
            rz: self.rz.lane(index),
            slip_x: self.slip_x.lane(index),
            slip_y: self.slip_y.lane(index),
            approach: self.approach.lane(index),
            spin: self.spin.lane(index),
            turn: self.turn.lane(index),
        }
    }
}

/// An impulse per unit mass, in sqrt(g D); contour and pivoting are moments, in D sqrt(g D).
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

impl<L: Lane> Impulse<L> {
    /// `yes` where the mask is set, else `no`.
    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self {
            x: L::select(mask, yes.x, no.x),
            y: L::select(mask, yes.y, no.y),
            z: L::select(mask, yes.z, no.z),
            contour: L::select(mask, yes.contour, no.contour),
            pivoting: L::select(mask, yes.pivoting, no.pivoting),
        }
    }

    /// The same but for one lane.
    #[inline(always)]
    pub(crate) fn with_lane(self, index: usize, one: Impulse<f64>) -> Self {
        Self {
            x: self.x.with_lane(index, one.x),
            y: self.y.with_lane(index, one.y),
            z: self.z.with_lane(index, one.z),
            contour: self.contour.with_lane(index, one.contour),
            pivoting: self.pivoting.with_lane(index, one.pivoting),
        }
    }

    /// No impulse.
    #[inline(always)]
    pub(crate) fn none() -> Self {
        let zero = L::splat(0.0);
        Self {
            x: zero,
            y: zero,
            z: zero,
            contour: zero,
            pivoting: zero,
        }
    }

    /// What the impulse changes.
    #[inline(always)]
    pub fn kick(self, body: &Body, touch: &Touch<L>) -> Kick<L> {
        let (inverse_kt, inverse_ka) = (L::splat(1.0 / body.kt), L::splat(1.0 / body.ka));
        // J_c/s first: with J_c <= ρ_c p_z the quotient is what stays finite as s → 0
        let rim = self.contour / touch.sin;
        Kick {
            vx: self.x,
            vy: self.y,
            vz: self.z,
            omega_y: (touch.rz * self.x - touch.rx * self.z) * inverse_kt,
            spin: (L::splat(body.radius) * self.y - self.contour - touch.cos * self.pivoting)
                * inverse_ka,
            turn: (L::splat(body.half) * self.y - touch.cos * rim + touch.sin * self.pivoting)
                * inverse_kt,
        }
    }

    /// The energy that the impulse adds: Σ ½ p·(rate before + rate after) over its five parts.
    #[inline(always)]
    pub fn work(self, body: &Body, touch: &Touch<L>) -> L {
        let k = touch.matrix(body);
        let two = L::splat(2.0);
        let mut slip_y = two * touch.slip_y + k.yy * self.y;
        let mut twist = L::splat(0.0);
        let idle = self.contour.abs() + self.pivoting.abs();
        if L::splat(0.0).lt(idle).any() {
            let rates = Twist::rates(body, touch);
            let (contour, pivoting) = (self.contour / touch.sin, self.pivoting);
            let back = rates.slip_y(contour, pivoting);
            slip_y -= back;
            twist = rates.work(self.y, contour, pivoting);
        }
        let slip_x = two * touch.slip_x + k.xx * self.x + k.xz * self.z;
        let normal = two * touch.approach + k.xz * self.x + k.zz * self.z;
        L::splat(0.5) * (self.x * slip_x + self.y * slip_y + self.z * normal + twist)
    }
}

/// The change of motion by an impulse: velocities in sqrt(g D), rates in sqrt(g/D).
#[derive(Debug, Clone, Copy)]
pub struct Kick<L> {
    /// Of the centre's velocity, x.
    pub vx: L,
    /// Of the centre's velocity, y.
    pub vy: L,
    /// Of the centre's velocity, z.
    pub vz: L,
    /// Of the angular velocity about y.
    pub omega_y: L,
    /// Of the angular velocity about u.
    pub spin: L,
    /// Of the angular velocity about e_θ.
    pub turn: L,
}

/// A law of impact.
///
/// A law is an own type with its citation and the argument why it never gains energy. To add one:
/// implement this trait, add a variant to [`Law`](crate::Law) and an arm where the engine is built.
pub trait ImpactLaw: Copy + Sync {
    /// Whether the engine does impacts side by side; the results are the same one after the other.
    /// `false` suits a law whose impacts each take their own path through many cases.
    const SIDE_BY_SIDE: bool = true;

    /// The impulse of an impact with coefficient of restitution `e`, 0 to 1, of a contact that does
    /// not leave (`touch.approach` <= 0). It adds no energy: [`Impulse::work`] <= 0 but for
    /// rounding.
    fn impulse<L: Lane>(
        &self,
        body: &Body,
        friction: &Friction,
        touch: &Touch<L>,
        e: L,
    ) -> Impulse<L>;
}
