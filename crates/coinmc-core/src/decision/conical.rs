//! The decision on a coin with a conical edge.
//!
//! There are three wells and two barriers, D of the lower rim and D' of the upper one: a face is left with
//! D of its own rim at least, the edge with the lesser of both. What may be left out is less than for a
//! cylinder: a cone on its edge rolls in a circle, so its axis turns, and straight rolling does not last. On
//! its edge only the energy of motions is left out that friction does not couple to any other, with μ = 0.
//!
//! *Flat on a face* the integral of the module above is D sqrt(1 + μ²) − (h + μR). *Without friction* each
//! rim is a balance of its own: with c* = h/D and s* = R/D of the lower rim, −h'/D' and R'/D' of the upper
//! one, it takes D* + k_t(Ω_z − Ω_a c*)²/(2s*²).

use super::{DecisionRule, DecisionState};
use crate::{Body, LowerRim, Scene};
use coinmc_lanes::Lane;

/// The energies at the balances on both rims.
#[derive(Debug, Clone, Copy)]
pub(super) struct Barriers {
    /// D of the lower rim, and of the upper one.
    own: f64,
    other: f64,
    /// The lesser of both.
    edge: f64,
    upper: Body,
}

impl DecisionRule {
    /// The rule for a coin with a conical edge on this lower rim. Arguments as of [`new`](Self::new).
    pub fn on_lower_rim(scene: &Scene, rim: &LowerRim, tilting: bool, flat_sine: f64) -> Self {
        let rule = Self::new(scene, tilting, flat_sine);
        let (mu, body) = (scene.surface.friction(), rim.body);
        let own = rim.barrier();
        Self {
            body,
            flat_sine: if mu * body.half <= body.radius {
                flat_sine
            } else {
                0.0
            },
            flat_barrier: own * (1.0 + mu * mu).sqrt() - mu * body.radius,
            balance: rim.balance(),
            conical: Some(Barriers {
                own,
                other: rim.upper_barrier(),
                edge: rim.edge_barrier(),
                upper: rim.upper,
            }),
            ..rule
        }
    }

    /// [`is_decided`](Self::is_decided) with a conical edge.
    pub(super) fn is_decided_conical<L: Lane>(
        &self,
        barriers: &Barriers,
        state: &DecisionState<L>,
    ) -> L::Mask {
        let zero = L::splat(0.0);
        let side = self.on_side(state.cos);
        let sliding = L::splat(0.5) * (state.vx * state.vx + state.vy * state.vy);
        let energy = state.energy - if self.slides { sliding } else { zero };
        let barrier = L::select(side, L::splat(barriers.edge), L::splat(barriers.own));
        let mut decided = energy.lt(barrier);
        let spinning = L::splat(0.5 * self.body.ka) * state.axial * state.axial;
        if self.tilting {
            let lies = !side & state.sin.lt(L::splat(self.flat_sine));
            let (flat, turning) = if self.slides {
                (spinning, spinning)
            } else {
                (spinning + sliding, zero)
            };
            let left_out = L::select(side, turning, L::select(lies, flat, zero));
            let barrier = L::select(lies, L::splat(self.flat_barrier), barrier);
            decided = decided | (energy - left_out).lt(barrier);
        }
        if self.traps {
            decided = decided | self.is_trapped_conical(barriers, state, energy - spinning, side);
        }
        decided
    }

    /// [`is_trapped`](Self::is_trapped) with a conical edge.
    fn is_trapped_conical<L: Lane>(
        &self,
        barriers: &Barriers,
        state: &DecisionState<L>,
        free: L,
        side: L::Mask,
    ) -> L::Mask {
        let axial = L::splat(self.axial_factor) * state.axial;
        let kt = self.body.kt;
        let below = |distance: f64, cos: f64, sin: f64| {
            let turn = (state.vertical - axial * L::splat(cos)) / L::splat(sin);
            free.lt(L::splat(distance) + L::splat(0.5 * kt) * turn * turn)
        };
        let (own, other, upper) = (barriers.own, barriers.other, &barriers.upper);
        below(own, self.balance, self.body.radius / own)
            & (!side | below(other, -upper.half / other, upper.radius / other))
    }
}

#[cfg(test)]
mod tests;
