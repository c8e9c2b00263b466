//! How a coin that ends on its side came to lie there.
//!
//! The motion at the beginning of sustained contact with the coin leaning towards its side, not to
//! leave it again, tells what follows. (The motion at the decision does not: `tilting` may decide a
//! rolling coin at any time until it rests, and every rule decides a spinning one only when most of
//! its spin is gone.)
//!
//! * *Rolling*. Tangential impulses at the contact keep Λ = v_y − (k_a/R) ω_a (`coinmc_core`'s
//!   decision), so once the coin rolls its speed is |Λ|/(1 + k_a/R²); how far it then rolls follows
//!   in closed form from contour friction and drag ([`RollingStop`]).
//! * *Spinning*. Pivoting friction and drag alone stop ω_z after the angle ½ k_t ω_z²/ρ_p, or less
//!   by drag.

use crate::contact::{RollingStop, way_to_rest};
use crate::model::Model;
use crate::toss::Toss;
use coinmc_core::{Ended, Face, OntoSide, SideEnding};
use std::f64::consts::TAU;

/// The motion of a coin that comes onto its side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SideArrival {
    /// Speed of straight rolling, in sqrt(gD).
    rolling: f64,
    /// |ω_z|, in sqrt(g/D).
    turning: f64,
}

impl<L> Model<L> {
    /// Notes that sustained contact begins, or goes on: the first time that the coin leans towards
    /// its side counts, unless it leaves the side again.
    #[inline]
    pub(crate) fn note_contact(&self, toss: &mut Toss) {
        if self.rule.on_side(toss.motion.cos.abs()) {
            if toss.side_arrival.is_none() {
                toss.side_arrival = Some(self.side_arrival(toss));
            }
        } else {
            toss.side_arrival = None;
        }
    }

    fn side_arrival(&self, toss: &Toss) -> SideArrival {
        let (body, m, spin) = (&self.dynamics.body, &toss.motion, &toss.spin);
        let lasting = (m.vy - body.ka / body.outer_radius() * spin.axial).abs();
        SideArrival {
            rolling: lasting / (1.0 + body.ka / body.outer_radius().powi(2)),
            turning: m.turning(spin).abs(),
        }
    }

    /// How a toss that ended like this came to end on its side; `None` if it did not.
    pub(crate) fn side_ending(&self, toss: &Toss, ended: Ended) -> Option<SideEnding> {
        if ended != Ended::Decided(Face::Side) {
            return None;
        }
        if self.adhesive || self.dynamics.friction.mu == 0.0 {
            // it sticks, or slides as it landed: nothing makes it roll
            return Some(SideEnding::RESTED);
        }
        let arrival = toss.side_arrival.unwrap_or_else(|| self.side_arrival(toss));
        let onto_side = self.onto_side(arrival);
        Some(SideEnding::new(
            &onto_side,
            self.dynamics.body.outer_radius() * self.units.length_m,
        ))
    }

    fn onto_side(&self, arrival: SideArrival) -> OntoSide {
        let SideArrival { rolling, turning } = arrival;
        let (body, friction) = (&self.dynamics.body, &self.dynamics.friction);
        // a creep, which without friction lengths never ends, is no motion
        let creep = self.contact_rules().stick_speed;
        let distance = if rolling > creep {
            RollingStop::new(&self.dynamics, rolling).distance()
        } else {
            0.0
        };
        let angle = if turning > creep {
            way_to_rest(
                friction.pivoting / body.kt,
                self.dynamics.drag.angular,
                turning,
            )
        } else {
            0.0
        };
        let r2 = body.outer_radius().powi(2);
        let energies = [
            (1.0 + body.ka / r2) * rolling * rolling,
            body.kt * turning * turning,
        ];
        OntoSide {
            rolls_m: distance * self.units.length_m,
            turns: angle / TAU,
            turning_prevails: energies[1] > energies[0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toss::tests::model;
    use coinmc_testkit::Dice;

    /// A wheel that rolls keeps its speed; one that slides without spin is left with 1/(1 + k_a/R²) of it, and one
    /// that spins without moving with k_a/R² of what its rim had, divided by the same: 2/3 and 1/3 for a
    /// uniform cylinder.
    #[test]
    fn a_coin_on_its_side_will_roll_with_what_friction_leaves_it() {
        let model = model();
        let radius = model.dynamics.body.outer_radius();
        for number in 0..100 {
            let mut dice = Dice::new(518, number);
            let mut toss = Toss::still();
            toss.motion.lay_on_side();
            let (speed, rim) = (dice.between(-2.0, 2.0), dice.between(-2.0, 2.0));
            toss.motion.vy = speed;
            toss.spin.axial = rim / radius;
            let rolling = model.side_arrival(&toss).rolling;
            // the point that touches moves at v_y + R ω_a
            assert!((rolling - (2.0 * speed - rim).abs() / 3.0).abs() < 1e-14);
            toss.spin.axial = -speed / radius;
            assert!((model.side_arrival(&toss).rolling - speed.abs()).abs() < 1e-14);
        }
    }
}
