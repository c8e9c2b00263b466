//! The end of an impact.

use super::equations::{CORNERS, Grip, Place};
use super::impact_state::ImpactState;

/// How an impact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Release {
    /// No corner touches.
    Apart,
    /// The corners that touch have too little energy to leave.
    Bound,
    /// Out of steps, or not finite.
    GivenUp,
}

impl ImpactState {
    /// The end of the impact, if it is over after a step. Records the force.
    pub(super) fn release(&mut self) -> Option<Release> {
        let down = self.body.corners.map(|corner| corner.grip != Grip::Apart);
        let (mut bound, mut force, mut stored) = (true, 0.0, 0.0);
        for which in (0..CORNERS).filter(|which| down[*which]) {
            let at = self.body.place(&self.y, which);
            force += self.body.normal(which, &at);
            stored += self.body.stored(&at);
            bound &= self.is_bound(&at);
        }
        self.record.peak_force = self.record.peak_force.max(force);
        if down == [false; CORNERS] {
            Some(Release::Apart)
        } else {
            (bound || self.lies_on_edge(down, stored)).then_some(Release::Bound)
        }
    }

    /// Whether the normal motion of a corner, a mass on a spring under gravity, has too little
    /// energy to come back to the surface. Damping can only take more.
    fn is_bound(&self, at: &Place) -> bool {
        let press = 1.0 + self.y[5] * self.y[5] * at.rz;
        let energy = self.body.mass(at) * (0.5 * at.rate * at.rate - press * at.depth)
            + self.body.stored(at);
        // at a depth, that is only where the corner is pressed down
        at.depth > 0.0 && energy < 0.0
    }

    /// Whether the coin as a whole has too little energy to leave the surface: without the energy
    /// of sliding, less than a coin has that lies flat on the edge between the touching corners.
    /// (Two corners that share the weight exchange energy, so that neither is bound by itself.)
    /// Friction may still make the coin trip, also the rigid coin in the contact that follows.
    fn lies_on_edge(&self, down: [bool; CORNERS], stored: f64) -> bool {
        let corners = &self.body.corners;
        let edge = |(i, j): (usize, usize)| {
            let (x, z) = (corners[i].x + corners[j].x, corners[i].z + corners[j].z);
            0.5 * (x * x + z * z).sqrt()
        };
        let edges = [(0, 1), (0, 2), (3, 1), (3, 2)];
        let both = edges.into_iter().find(|&(i, j)| down[i] && down[j]);
        let flat = both.map_or_else(|| edge(edges[0]).min(edge(edges[1])), edge);
        let [_, z, _, _, vz, omega, ..] = self.y;
        let moving = 0.5 * (vz * vz + self.body.inertia * omega * omega);
        // the centre is above the first corner by its own height at the touch
        moving + stored + (z - corners[0].z) < flat
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::line_contact::equations::tests::body;

    /// A coin that turns at `omega`, with its lowest corner under the centre.
    fn state(omega: f64) -> ImpactState {
        let corners = [(0.0, -1.0), (-1.0, 0.0), (1.0, 0.0), (0.0, 1.0)];
        let body = body(0.0, corners, 0.0, Grip::Smooth);
        ImpactState::new(body, [0.0, -1.0, omega], (1.0, 1.0), (0.0, 0.8), 1e-6)
    }

    /// A corner at a depth comes back if it is fast enough to climb against the force that presses it down, 1 less
    /// the centre's acceleration ω² |r_z|; what its spring stores helps. The mass that moves is 1/(1 + r_x²/k).
    #[test]
    fn a_corner_is_bound_if_it_cannot_climb_out() {
        let resting = libm::pow(1e-6, 0.9);
        for omega in [0.0, 0.5] {
            let state = state(omega);
            let depth = 0.1 * resting;
            let place = |rate: f64, depth: f64| Place {
                rx: 0.6,
                rz: -0.8,
                depth,
                rate,
                slip: 0.0,
            };
            let mass = 0.3 / (0.3 + 0.36);
            let exponent = 19.0 / 9.0;
            let stored = 1e6 * libm::pow(depth, exponent) / exponent;
            let climb = (1.0 - 0.8 * omega * omega) * depth - stored / mass;
            let fastest = (2.0 * climb).sqrt();
            for sign in [1.0, -1.0] {
                assert!(state.is_bound(&place(sign * 0.999 * fastest, depth)));
                assert!(!state.is_bound(&place(sign * 1.001 * fastest, depth)));
            }
            assert!(!state.is_bound(&place(0.0, -depth)));
        }
        // one that turns so fast that nothing presses it down is never bound
        let place = Place {
            rx: 0.6,
            rz: -1.0,
            depth: 0.1 * resting,
            ..Place::default()
        };
        assert!(!state(1.01).is_bound(&place));
    }
}
