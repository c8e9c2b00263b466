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
    use crate::motion::{Motion, Spin};
    use crate::settings::Settings;
    use crate::toss::tests::{generic_scene, model, model_of, stops_plainly};
    use coinmc_core::{Coin, Landing, Scene, SideMotion, Surface};
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

    /// How far a coin rolls and turns is what its equation of motion says, in short steps: contour friction and drag
    /// slow down its rolling, pivoting friction and drag its turning. What has more energy names it, and a creep is
    /// no motion.
    #[test]
    fn a_coin_on_its_side_rolls_and_turns_as_far_as_friction_and_drag_let_it() {
        let scene = generic_scene(|plane| plane);
        let model = model_of(&scene, &Settings::default());
        let (body, drag) = (&model.dynamics.body, &model.dynamics.drag);
        let friction = &model.dynamics.friction;
        let (radius, creep) = (body.outer_radius(), Settings::default().stick_speed);
        let (mut rolls, mut spins) = (0, 0);
        for number in 0..8 {
            let mut dice = Dice::new(542, number);
            let [rolling, turning] = [0.0; 2].map(|_| dice.between(0.1, 0.9));
            let found = model.onto_side(SideArrival { rolling, turning });
            let share = body.ka / (radius * radius);
            let (way, _) = stops_plainly(
                |v| {
                    let dry = friction.contour / radius;
                    (dry + drag.linear * v + drag.angular * share * v) / (1.0 + share)
                },
                rolling,
            );
            let metres = way * scene.coin.rim_distance_m();
            assert!((found.rolls_m / metres - 1.0).abs() < 1e-5);
            let (angle, _) =
                stops_plainly(|w| friction.pivoting / body.kt + drag.angular * w, turning);
            assert!((found.turns / (angle / std::f64::consts::TAU) - 1.0).abs() < 1e-5);

            let mut rolls_on = Motion::still();
            rolls_on.vy = rolling;
            let wheel = Spin {
                axial: -rolling / radius,
                ..Spin::still()
            };
            let top = Spin {
                turn: turning,
                ..Spin::still()
            };
            let more = Motion::still().kinetic(body, &top) > rolls_on.kinetic(body, &wheel);
            assert_eq!(found.turning_prevails, more);
            if more {
                spins += 1;
            } else {
                rolls += 1;
            }

            let creeps = model.onto_side(SideArrival {
                rolling: 0.99 * creep,
                turning: 0.99 * creep,
            });
            assert_eq!((creeps.rolls_m, creeps.turns), (0.0, 0.0));
        }
        assert!(rolls > 0 && spins > 0, "{rolls} {spins}");
    }

    /// The first sustained contact on the side counts, until the coin leaves the side again: not a later one, and
    /// none with the coin leaning towards its face.
    #[test]
    fn the_first_contact_on_the_side_counts() {
        let model = model();
        let balance = model.dynamics.body.half;
        let mut toss = Toss::still();
        let leans = |toss: &mut Toss, cos: f64, speed: f64| {
            toss.motion.set_tilt((1.0 - cos * cos).sqrt(), cos);
            toss.motion.vy = speed;
            model.note_contact(toss);
            toss.side_arrival.map(|arrival| arrival.rolling)
        };
        assert_eq!(leans(&mut toss, 1.01 * balance, 0.3), None);
        let first = leans(&mut toss, 0.99 * balance, 0.6).expect("on its side");
        assert!((first - 0.4).abs() < 1e-14);
        assert_eq!(leans(&mut toss, 0.0, 0.9), Some(first));
        assert_eq!(leans(&mut toss, 1.01 * balance, 0.9), None);
        let second = leans(&mut toss, 0.5 * balance, -0.9).expect("on its side again");
        assert!((second - 0.6).abs() < 1e-14);
    }

    /// A coin that sticks where it lands, or on which no friction acts, does not begin to roll.
    #[test]
    fn without_friction_a_coin_on_its_side_rests_or_slides() {
        let on_side = Ended::Decided(Face::Side);
        let ending = |surface: Surface| {
            let coin = Coin::cylinder(0.7, 0.013).expect("a valid coin");
            let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
            let mut toss = Toss::still();
            toss.motion.lay_on_side();
            toss.motion.vy = 0.5;
            let model = model_of(&scene, &Settings::default());
            assert_eq!(model.side_ending(&toss, Ended::Decided(Face::Heads)), None);
            model
                .side_ending(&toss, on_side)
                .expect("on its side")
                .motion
        };
        let plane = |friction| Surface::new(0.5, friction).expect("a valid surface");
        assert_eq!(ending(plane(0.3)), SideMotion::Rolled);
        assert_eq!(ending(plane(0.0)), SideMotion::Rested);
        let sticky = plane(0.3)
            .with_landing(Landing::Adhesive)
            .expect("a level surface");
        assert_eq!(ending(sticky), SideMotion::Rested);
    }
}
