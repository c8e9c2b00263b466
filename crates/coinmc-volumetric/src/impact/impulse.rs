//! The impulse of an impact, and what it changes.

use super::contact_point::ContactPoint;
use super::friction_moments::RimRates;
use crate::body::Body;
use coinmc_lanes::{Lane, Mask};

/// An impulse per unit mass, in sqrt(g D); `contour` and `pivoting` are moments, in D sqrt(g D).
#[derive(Debug, Clone, Copy)]
pub struct Impulse<L> {
    /// x part.
    pub x: L,
    /// y part.
    pub y: L,
    /// Normal part, not negative.
    pub z: L,
    /// J_c, of contour (rolling) friction.
    pub contour: L,
    /// J_p, of pivoting friction.
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

    /// The impulse with one lane replaced.
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

    /// The change of velocities by the impulse.
    #[inline(always)]
    pub fn velocity_jump(self, body: &Body, point: &ContactPoint<L>) -> VelocityJump<L> {
        let (inverse_kt, inverse_ka) = (L::splat(1.0 / body.kt), L::splat(1.0 / body.ka));
        let (radius, half) = point.levers(body);
        // J_c/s first: as J_c <= ρ_c p_z, this quotient stays finite as s → 0
        let rim = self.contour / point.sin;
        VelocityJump {
            vx: self.x,
            vy: self.y,
            vz: self.z,
            omega_y: (point.rz * self.x - point.rx * self.z) * inverse_kt,
            spin: (radius * self.y - self.contour - point.cos * self.pivoting) * inverse_ka,
            turn: (half * self.y - point.cos * rim + point.sin * self.pivoting) * inverse_kt,
        }
    }

    /// The energy that the impulse adds: Σ ½ p·(rate before + rate after) over its five parts.
    #[inline(always)]
    pub fn work(self, body: &Body, point: &ContactPoint<L>) -> L {
        let k = point.matrix(body);
        let two = L::splat(2.0);
        let mut slip_y = two * point.slip_y + k.yy * self.y;
        let mut moment_work = L::splat(0.0);
        let moments = self.contour.abs() + self.pivoting.abs();
        if L::splat(0.0).lt(moments).any() {
            let rates = RimRates::rates(body, point);
            let (contour, pivoting) = (self.contour / point.sin, self.pivoting);
            slip_y -= rates.slip_y(contour, pivoting);
            moment_work = rates.work(self.y, contour, pivoting);
        }
        let slip_x = two * point.slip_x + k.xx * self.x + k.xz * self.z;
        let normal = two * point.approach + k.xz * self.x + k.zz * self.z;
        L::splat(0.5) * (self.x * slip_x + self.y * slip_y + self.z * normal + moment_work)
    }
}

/// The change of motion by an impulse: velocities in sqrt(g D), angular velocities in sqrt(g/D).
#[derive(Debug, Clone, Copy)]
pub struct VelocityJump<L> {
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
