//! When the face of a coin on rough ground is decided.
//!
//! The energy above the ground under a rim must reach 1 (in m g D) to carry the coin over that rim.
//! On rough ground two more things can help: the ground is not as high where the coin will be, and a
//! coin that rolls is kicked by bumps.
//!
//! * *A face*: decided once the energy above the own rim's ground is below 1 − 3σ.
//! * *The side, by energy*: decided once the energy, above the ground of either rim, is below 1 less
//!   what the ground can still change: 3σ, or in proportion less if contour friction stops the coin
//!   within ℓ.
//! * *The side, of a coin that rolls, spins or hops on* (decision `tilting`): where no kick to be
//!   expected can topple the coin. Slopes under the two rims that differ by s_d, passed at speed w,
//!   make it lean at the rate w s_d/2h, and heights that differ by σ_d lean it by σ_d/2h at rest.
//!   With the correlation ρ of the ground over the coin's thickness, s_d² = 2s²(1 − ρ), σ_d² = 2σ²(1
//!   − ρ). A kick adds to the velocities that the coin already rocks and hops with, so the rule asks
//!   that sqrt(E) + sqrt(E_kick) < sqrt(well): E is the energy above rest that may become tilt, by
//!   the rule for a plane, and E_kick that of so many standard deviations of both as were measured
//!   to be enough ([`Kicks`](super::ground::Kicks)).

use super::ground::SPREAD;
use super::tracks::rim_points;
use super::walk::{Touch, Walk};
use crate::impact::ImpactLaw;
use crate::motion::Motion;
use coinmc_core::{Decided, Observer};

/// A coin rests whose kinetic energy has been below this share of its well's depth for this time,
/// in sqrt(D/g): one that turns round on a slope is slow only for a moment.
const REST: f64 = 1e-3;
const REST_TIME: f64 = 5.0;

impl<I: ImpactLaw, O: Observer> Walk<'_, I, O> {
    /// The face, if it is decided.
    pub(super) fn decide(&mut self, touch: Touch) -> Option<Decided> {
        let (motion, body) = (&self.toss.motion, self.body());
        if self.model.rule.awaits_rest() {
            return self.decide_at_rest();
        }
        let (own, other) = (self.tracks.own.height, self.tracks.other.height);
        let kinetic = motion.kinetic(body, &self.toss.spin);
        let energy = kinetic + motion.z;
        let sigma = self.ground.height;
        if !self.model.rule.on_side(motion.cos.abs()) {
            return self.keeps_face(energy - own).then_some(Decided::Face);
        }
        if touch != Touch::Both {
            self.at_rest_since = None;
            // a coin that rocks is decided once both rims are down, or it has toppled
            let low = own.min(other);
            let decided = energy - low < 1.0 - SPREAD * sigma || self.is_safe();
            return decided.then_some(Decided::Side);
        }
        let highest = energy - own.min(other);
        let friction = self.model.dynamics.friction.contour / body.outer_radius();
        let ahead = (kinetic / (friction * self.ground.length).max(f64::MIN_POSITIVE)).min(1.0);
        let slow = kinetic < REST * (1.0 - body.radius);
        let rests = self.rests(slow);
        let decided = highest < 1.0 - SPREAD * sigma * ahead || rests || self.is_safe();
        decided.then_some(Decided::Side)
    }

    /// Whether the face of a coin that rebounds from its landing is decided. In flight no energy is gained,
    /// and the next landing is judged by the same rule.
    pub(super) fn lies_on_face(&self) -> bool {
        let rule = &self.model.rule;
        !rule.awaits_rest()
            && !rule.on_side(self.toss.motion.cos)
            && self.keeps_face(self.energy() - self.tracks.own.height)
    }

    /// Whether a coin in the well of a face, with this energy above the ground under its own rim, stays there.
    fn keeps_face(&self, energy: f64) -> bool {
        energy < 1.0 - self.ground.face_margin
    }

    /// The face of a coin that has come to rest, on a table with an edge, whatever touches: a coin at
    /// rest on a slope may go on to leave and to touch it with either rim.
    fn decide_at_rest(&mut self) -> Option<Decided> {
        let kinetic = self.toss.motion.kinetic(self.body(), &self.toss.spin);
        let well = self.model.rule.well(self.toss.motion.cos.abs());
        self.rests(kinetic < REST * (1.0 - self.body().radius))
            .then_some(well)
    }

    /// Whether a coin, slow or not, has been slow for so long that it rests.
    fn rests(&mut self, slow: bool) -> bool {
        if !slow {
            self.at_rest_since = None;
            return false;
        }
        let now = self.usage.time;
        now - *self.at_rest_since.get_or_insert(now) >= REST_TIME
    }

    /// Whether a coin that leans towards its side will stay on it although it rolls, spins or hops on.
    fn is_safe(&self) -> bool {
        let rule = &self.model.rule;
        let (body, ground) = (self.body(), self.ground);
        let mean = 0.5 * (self.tracks.own.height + self.tracks.other.height);
        let motion = Motion {
            z: self.toss.motion.z - mean,
            ..self.toss.motion
        };
        if !rule.is_tilting() {
            return false;
        }
        let state = motion.decision_state(body, &self.toss.spin);
        let loose = (rule.loose_energy(&state) - body.radius).max(0.0);
        let thickness = 2.0 * body.half;
        let points = rim_points(body, &motion, &self.toss.spin);
        let speed = points[0].speed().max(points[1].speed());
        // and what it may gain by rolling down to the deepest place
        let drop = (mean + SPREAD * ground.height).max(0.0);
        let speed = (speed * speed + 2.0 * drop).sqrt();
        let rate = ground.kicks.rates * speed * ground.slope() * ground.contrast / thickness;
        let brim = ground.kicks.brim;
        let well = (1.0 - body.radius) * brim * brim;
        let inertia = body.kt + body.outer_radius().powi(2);
        brim > 0.0 && loose.sqrt() + (0.5 * inertia).sqrt() * rate < well.sqrt()
    }
}

#[cfg(test)]
mod tests;
