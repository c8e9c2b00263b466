//! The gap between the lowest point of the coin and the surface, along a flight.

use super::orbit::Orbit;
use super::profile::Profile;
use crate::motion::LEAST_SIN;
use coinmc_lanes::Lane;

/// The gap f = z − (height of the centre at which the lowest point touches), with everything that
/// the search for its root needs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gap<L> {
    pub(crate) z: L,
    pub(crate) vz: L,
    /// Horizontal and vertical parts of u.
    pub(crate) sin: L,
    pub(crate) uz: L,
    /// Rate of change of `uz`.
    pub(crate) uz_rate: L,
    /// Horizontal part of u as a vector, and its rate of change.
    pub(crate) across: [L; 2],
    pub(crate) across_rate: [L; 2],
    /// Rate of change of `sin`, the length of that vector.
    pub(crate) sin_rate: L,
    /// f, f' and f''.
    pub(crate) height: L,
    pub(crate) slope: L,
    pub(crate) curvature: L,
}

impl<L: Lane> Orbit<L> {
    /// The gap at time `t`.
    #[inline(always)]
    pub(crate) fn gap(&self, body: &impl Profile, t: L) -> Gap<L> {
        self.gap_at(body, self.phase(t), self.fall(t))
    }

    /// The gap at t = 0, where the phase is known to be 0.
    #[inline(always)]
    pub(crate) fn first_gap(&self, body: &impl Profile) -> Gap<L> {
        let phase = (L::splat(0.0), L::splat(1.0), self.state.rate);
        self.gap_at(body, phase, (self.state.z, self.state.vz))
    }

    #[inline(always)]
    fn gap_at(&self, body: &impl Profile, (s, c, rate): (L, L, L), (z, vz): (L, L)) -> Gap<L> {
        let at = |i: usize| self.state.a[i] + (self.state.b[i] * c + self.state.d[i] * s);
        let (ux, uy, uz) = (at(0), at(1), at(2));
        let sin = (ux * ux + uy * uy).sqrt().max(L::splat(LEAST_SIN));
        let uz_rate = rate * (self.state.d[2] * c - self.state.b[2] * s);
        let mut uz_curve = -(rate * rate) * (uz - self.state.a[2]);
        let mut fall_curve = L::splat(-1.0);
        if self.drag.acts() {
            uz_curve -= L::splat(self.drag.angular) * uz_rate;
            fall_curve -= L::splat(self.drag.linear) * vz;
        }
        let radius = L::splat(body.radius());
        // h = half|uz| + radius·sin; only this form of sin' keeps its digits near sin = 0
        let inverse = L::splat(1.0) / sin;
        let across_rate = [
            rate * (self.state.d[0] * c - self.state.b[0] * s),
            rate * (self.state.d[1] * c - self.state.b[1] * s),
        ];
        let sin_rate = (ux * across_rate[0] + uy * across_rate[1]) * inverse;
        // and sin'' = −(uz uz'' + uz'²/sin²)/sin
        let lever = body.lever(uz) - radius * uz * inverse;
        let bend = radius * uz_rate * uz_rate * (inverse * inverse * inverse);
        Gap {
            z,
            vz,
            sin,
            uz,
            uz_rate,
            across: [ux, uy],
            across_rate,
            sin_rate,
            height: z - (body.lift(uz) + radius * sin),
            slope: vz - (body.lever(uz) * uz_rate + radius * sin_rate),
            curvature: fall_curve - uz_curve * lever + bend,
        }
    }
}
